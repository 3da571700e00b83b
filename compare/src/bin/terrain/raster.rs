//! How far samples are from faces, by going over all of them.

/// Three places of a grid, column and row.
pub(crate) type Corners = [[usize; 2]; 3];

/// The largest vertical distance of a sample of a grid to the faces that cover it.
pub(crate) fn largest_error(
    heights: &[f32],
    columns: usize,
    faces: impl Iterator<Item = Corners>,
) -> f64 {
    let mut largest = 0.0_f64;
    for face in faces {
        let height = |[column, row]: [usize; 2]| f64::from(heights[row * columns + column]);
        let at = face.map(|it| it.map(|it| it as f64));
        let [a, b, c] = at;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if area == 0.0 {
            continue;
        }
        let rise = [
            height(face[1]) - height(face[0]),
            height(face[2]) - height(face[0]),
        ];
        let along = (rise[0] * (c[1] - a[1]) - rise[1] * (b[1] - a[1])) / area;
        let down = (rise[1] * (b[0] - a[0]) - rise[0] * (c[0] - a[0])) / area;

        let rows = face.map(|it| it[1]);
        let first = rows.iter().min().copied().unwrap_or(0);
        let last = rows.iter().max().copied().unwrap_or(0);
        for row in first..=last {
            // Where the sides meet the row.
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            for (i, &p) in at.iter().enumerate() {
                let q = at[(i + 1) % 3];
                let y = row as f64;
                if y < p[1].min(q[1]) || y > p[1].max(q[1]) {
                    continue;
                }
                let ends = match p[1] == q[1] {
                    true => [p[0], q[0]],
                    false => [p[0] + (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1]); 2],
                };
                from = from.min(ends[0].min(ends[1]));
                to = to.max(ends[0].max(ends[1]));
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "columns of the grid"
            )]
            let [from, to] = [(from - 1e-9).ceil() as usize, (to + 1e-9).floor() as usize];
            for column in from..=to {
                let surface =
                    height(face[0]) + along * (column as f64 - a[0]) + down * (row as f64 - a[1]);
                largest = largest.max((height([column, row]) - surface).abs());
            }
        }
    }
    largest
}
