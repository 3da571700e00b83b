//! Voids filled from their surroundings.
//!
//! A pyramid of grids, each half as wide and as high, holds the means of known heights (Gortler et al., *The
//! Lumigraph*, 1996, fill images so). From its top down, a place that is void in a grid first takes what the coarser one
//! has there, and then a few sweeps move it to the mean of its neighbours. So wide voids get the shape of a membrane
//! that is fixed where heights are known, at a cost that does not depend on how wide they are.

use super::HeightGrid;

/// Sweeps over the voids of each grid, there and back.
const SWEEPS: usize = 8;

impl HeightGrid {
    /// Fills voids smoothly from their surroundings, and says how many. Heights that are known stay bit for bit. A grid
    /// without any height stays as it is.
    ///
    /// ```
    /// use meshweft::HeightGrid;
    /// let mut grid = HeightGrid::new([3, 2], [1.0, 1.0], vec![1.0, f32::NAN, 1.0, 1.0, 1.0, 1.0])?;
    /// assert_eq!((grid.fill_voids(), grid.height(1, 0)), (1, Some(1.0)));
    /// # Ok::<(), meshweft::HeightGridError>(())
    /// ```
    ///
    /// # Complexity
    /// Time O(places), space 2 bytes a place and 5 a void.
    pub fn fill_voids(&mut self) -> usize {
        let size = self.size.map(|it| it as usize);
        let count = self.void_count();
        if count == 0 || count == self.heights.len() {
            return 0;
        }
        fill(size, &mut self.heights);
        count
    }
}

/// Fills a level, with the help of the coarser ones; there is a height in it.
fn fill(size: [usize; 2], heights: &mut [f32]) {
    let voids = heights.iter().enumerate().filter(|(_, it)| it.is_nan());
    let voids: Vec<u32> = voids.map(|(at, _)| crate::index::index32(at)).collect();
    if voids.is_empty() {
        return;
    }
    let (coarse_size, mut coarse) = halved(size, heights);
    fill(coarse_size, &mut coarse);

    // What the coarser grid has there.
    for &at in &voids {
        let [column, row] = [at as usize % size[0], at as usize / size[0]];
        heights[at as usize] = between(coarse_size, &coarse, [column, row]);
    }
    drop(coarse);

    // The mean of the neighbours, each from what is there now.
    for _ in 0..SWEEPS {
        for &at in &voids {
            heights[at as usize] = mean_around(size, heights, at as usize);
        }
        for &at in voids.iter().rev() {
            heights[at as usize] = mean_around(size, heights, at as usize);
        }
    }
}

/// A grid of half the columns and rows: means of the heights that are known in four places.
fn halved([columns, rows]: [usize; 2], heights: &[f32]) -> ([usize; 2], Vec<f32>) {
    let size = [columns.div_ceil(2), rows.div_ceil(2)];
    let mut coarse = Vec::with_capacity(size[0] * size[1]);
    for row in (0..rows).step_by(2) {
        for column in (0..columns).step_by(2) {
            let (mut sum, mut count) = (0.0, 0.0);
            for row in row..rows.min(row + 2) {
                let start = row * columns;
                for &height in &heights[start + column..start + columns.min(column + 2)] {
                    if !height.is_nan() {
                        sum += f64::from(height);
                        count += 1.0;
                    }
                }
            }
            coarse.push(if count > 0.0 {
                single(sum / count)
            } else {
                f32::NAN
            });
        }
    }
    (size, coarse)
}

/// What a coarser grid has at a place of a finer one, between its four places around.
fn between(size: [usize; 2], coarse: &[f32], place: [usize; 2]) -> f32 {
    // A coarse place lies in the middle of four fine ones: the nearest has three parts of four.
    let [near, far] = [0, 1].map(|axis| {
        let near = place[axis] / 2;
        let far = match place[axis] % 2 {
            0 => near.saturating_sub(1),
            _ => (near + 1).min(size[axis] - 1),
        };
        (near, far)
    });
    let at = |column: usize, row: usize| f64::from(coarse[row * size[0] + column]);
    let along = |row: usize| 0.75 * at(near.0, row) + 0.25 * at(near.1, row);
    single(0.75 * along(far.0) + 0.25 * along(far.1))
}

/// The mean of the places to the left and right, above and below, as far as they are in the grid.
fn mean_around([columns, rows]: [usize; 2], heights: &[f32], at: usize) -> f32 {
    let (column, row) = (at % columns, at / columns);
    let neighbours = [
        (column > 0).then(|| at - 1),
        (column + 1 < columns).then(|| at + 1),
        (row > 0).then(|| at - columns),
        (row + 1 < rows).then(|| at + columns),
    ];
    let (mut sum, mut count) = (0.0, 0.0);
    for at in neighbours.into_iter().flatten() {
        sum += f64::from(heights[at]);
        count += 1.0;
    }
    if count > 0.0 {
        single(sum / count)
    } else {
        heights[at]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "means of single precision")]
fn single(number: f64) -> f32 {
    number as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Heights by a rule, void where it says so.
    fn grid(size: [u32; 2], height: impl Fn(f32, f32) -> f32) -> HeightGrid {
        let places = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (column, row)));
        let heights = places.map(|(column, row)| height(column as f32, row as f32));
        HeightGrid::new(size, [1.0, 1.0], heights.collect()).unwrap()
    }

    #[test]
    fn a_hole_in_a_slope_is_filled_with_the_slope() {
        let slope = |x: f32, y: f32| 3.0 * x - 2.0 * y + 100.0;
        let is_hole = |x: f32, y: f32| (x - 40.0).powi(2) + (y - 31.0).powi(2) < 400.0;
        let mut holed = grid(
            [90, 70],
            |x, y| if is_hole(x, y) { f32::NAN } else { slope(x, y) },
        );
        let (whole, before) = (grid([90, 70], slope), holed.clone());
        let voids = before.void_count();
        assert!(voids > 1200);
        assert_eq!((holed.fill_voids(), holed.void_count()), (voids, 0));

        // 120 metres across the hole.
        let places = holed.heights().iter().zip(whole.heights());
        let furthest = places
            .map(|(it, exact)| (it - exact).abs())
            .fold(0.0, f32::max);
        assert!(furthest < 3.0, "{furthest}");
        for (after, before) in holed.heights().iter().zip(before.heights()) {
            assert!(before.is_nan() || after.to_bits() == before.to_bits());
        }
        assert_eq!(holed.fill_voids(), 0);
    }

    #[test]
    fn what_is_filled_stays_between_what_is_known() {
        // One height in a corner, and two in far corners of odd sizes.
        for size in [[2, 2], [3, 2], [17, 5], [64, 33]] {
            let mut one = grid(size, |x, y| if x + y == 0.0 { -7.5 } else { f32::NAN });
            assert_eq!(one.fill_voids(), (size[0] * size[1] - 1) as usize);
            assert!(one.heights().iter().all(|it| *it == -7.5), "{size:?}");

            let last = (size[0] - 1) as f32;
            let mut two = grid(size, |x, y| match (x, y) {
                (0.0, 0.0) => 0.0,
                (x, 1.0) if x == last => 10.0,
                _ => f32::NAN,
            });
            two.fill_voids();
            assert!(two.heights().iter().all(|it| (0.0..=10.0).contains(it)));
        }
    }

    #[test]
    fn a_grid_without_heights_stays_void() {
        let mut void = grid([4, 3], |_, _| f32::NAN);
        assert_eq!((void.fill_voids(), void.void_count()), (0, 12));
    }
}
