//! How far the heights of a grid are from a triangle over three of its places.

use crate::height_grid::HeightGrid;

/// The heights of a grid, to be compared with planes.
pub(super) struct HeightPlanes<'a> {
    heights: &'a [f32],
    columns: usize,
    /// How far a place may be from where it should be, in cells: positions are rounded.
    shift: [f64; 2],
}

impl<'a> HeightPlanes<'a> {
    pub(super) fn new(grid: &'a HeightGrid) -> Self {
        let size = grid.size();
        let spacing = grid.spacing();
        let shift = |axis: usize| {
            let middle = 0.5 * f64::from(size[axis] - 1);
            let shifts = (0..size[axis]).map(|at| {
                let place = [[at, 0], [0, at]][axis];
                let rounded = f64::from(grid.horizontal(place[0], place[1])[axis]);
                (rounded / spacing[axis] + middle - f64::from(at)).abs()
            });
            shifts.fold(0.0, f64::max)
        };
        Self {
            heights: grid.heights(),
            columns: size[0] as usize,
            // A corner's own, and as much for a place between corners; the quotient has its rounding.
            shift: [0, 1].map(|axis| match shift(axis) {
                0.0 => 0.0,
                shift => 3.0 * shift + 1e-12 * f64::from(size[axis]),
            }),
        }
    }

    /// The largest vertical distance of a height to a triangle above or below it; corners are columns and rows, the first
    /// one that of the right angle.
    pub(super) fn largest_error(&self, corners: [[u32; 2]; 3]) -> f64 {
        let heights = corners.map(|it| f64::from(self.heights[self.number(it)]));
        let corners = corners.map(|it| it.map(u32::cast_signed));

        // The plane's slopes, by a division by a power of two.
        let [apex, left, right] = corners;
        let [x, y] = [0, 1].map(|axis| [left[axis] - apex[axis], right[axis] - apex[axis]]);
        let area = f64::from(x[0] * y[1] - x[1] * y[0]);
        let rise = [heights[1] - heights[0], heights[2] - heights[0]];
        let slopes = [
            (rise[0] * f64::from(y[1]) - rise[1] * f64::from(y[0])) / area,
            (rise[1] * f64::from(x[0]) - rise[0] * f64::from(x[1])) / area,
        ];

        // Row by row.
        let mut largest = 0.0_f64;
        let rows = corners.map(|it| it[1]);
        let first = rows[0].min(rows[1]).min(rows[2]);
        let last = rows[0].max(rows[1]).max(rows[2]);
        for row in first..=last {
            let [from, to] = columns_of(corners, row);
            let start = heights[0]
                + slopes[1] * f64::from(row - apex[1])
                + slopes[0] * f64::from(from - apex[0]);
            let at = self.number([from, row].map(i32::cast_unsigned));
            let count = (to - from + 1).cast_unsigned() as usize;
            let found = farthest(&self.heights[at..at + count], start, slopes[0]);
            largest = largest.max(found);
        }
        let moved = slopes[0].abs() * self.shift[0] + slopes[1].abs() * self.shift[1];
        largest + moved
    }

    fn number(&self, [column, row]: [u32; 2]) -> usize {
        row as usize * self.columns + column as usize
    }
}

/// The first and the last column of a row of a triangle whose sides go along rows, columns or diagonals.
fn columns_of([apex, left, right]: [[i32; 2]; 3], row: i32) -> [i32; 2] {
    let down = (row - apex[1]).abs();
    if left[0] == right[0] {
        // From the side that goes down, towards the apex.
        let inner = apex[0] + (left[0] - apex[0]).signum() * down;
        return [inner.min(left[0]), inner.max(left[0])];
    }
    if left[1] == right[1] {
        return [apex[0] - down, apex[0] + down];
    }
    // One leg along the row, one along the column.
    let along = if left[1] == apex[1] { left } else { right };
    let length = (along[0] - apex[0]).abs();
    let end = apex[0] + (along[0] - apex[0]).signum() * (length - down);
    [apex[0].min(end), apex[0].max(end)]
}

/// The largest distance of heights to a line.
#[inline]
fn farthest(heights: &[f32], start: f64, slope: f64) -> f64 {
    const LANES: usize = 4;
    let mut largest = [0.0_f64; LANES];
    let (chunks, rest) = heights.as_chunks::<LANES>();
    let mut at = 0.0;
    for chunk in chunks {
        for lane in 0..LANES {
            let line = start + slope * (at + lane as f64);
            let distance = (f64::from(chunk[lane]) - line).abs();
            largest[lane] = if distance > largest[lane] {
                distance
            } else {
                largest[lane]
            };
        }
        at += LANES as f64;
    }
    let mut most = largest.iter().fold(0.0, |most, &it| f64::max(most, it));
    for (lane, &height) in rest.iter().enumerate() {
        let line = start + slope * (at + lane as f64);
        most = most.max((f64::from(height) - line).abs());
    }
    most
}
