//! What a terrain is in all.

use crate::height_grid::HeightGrid;

/// What is known of a terrain without its vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TinExtent {
    /// The lowest and the highest height.
    pub(super) heights: [f32; 2],
    /// Faces at full detail.
    pub(super) faces: u64,
}

impl TinExtent {
    /// That of a grid; `None` if it has no face.
    pub(super) fn of(grid: &HeightGrid) -> Option<Self> {
        let columns = grid.size()[0] as usize;
        let (mut rows, mut faces) = (grid.heights().chunks_exact(columns), 0);
        let mut north = rows.next()?;
        for (row, south) in rows.enumerate() {
            for column in 1..columns {
                // The diagonal of a cell joins the places of which both column and row are even, or both odd.
                let [a, b] = [&north[column - 1..=column], &south[column - 1..=column]];
                let is_even = (row + column) % 2 == 1;
                let halves = match is_even {
                    true => [[a[0], b[1], a[1]], [a[0], b[1], b[0]]],
                    false => [[a[1], b[0], a[0]], [a[1], b[0], b[1]]],
                };
                let is_face = |half: &[f32; 3]| half.iter().all(|it| !it.is_nan());
                faces += halves.iter().filter(|it| is_face(it)).count() as u64;
            }
            north = south;
        }
        let heights = grid.height_range().filter(|_| faces > 0)?;
        Some(Self { heights, faces })
    }
}
