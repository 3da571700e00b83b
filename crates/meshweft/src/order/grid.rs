//! Orders for regular grids, such as terrain.
//!
//! The best orders of a grid need no search. *Snake* goes along the rows, there and back; it is
//! good only where the cache holds three rows. *Hilbert* follows D. Hilbert's curve (1891), which
//! Bogomjakov & Gotsman took as the model of sequences that are good for every cache: it fills one
//! quarter after the other, each in the same way. *Primed rows* are for one FIFO cache of `K`
//! vertices: strips so narrow that each row finds all vertices of the row above in the cache.
//!
//! A strip cannot start at full width: its first row pushes vertices of two rows in turn, half of
//! them are gone when the next row needs them, and so on in all rows. M. Wloka and I. Castaño
//! (*Optimal Grid Rendering*, 2009) *prime* the cache: a row of faces without area pushes only the
//! upper vertices, then `K − 2` cells fit ([`Grid::primed_faces`]). Where no face may be added
//! ([`Grid::primed_rows`]), a strip of `K − 3` cells starts half as wide, which fits in the cache,
//! and gains a cell a row from the third on. The cells that this leaves out are drawn before it, in
//! rows that get shorter.

use crate::permutation::Permutation;

/// A grid of cells, each cut in two faces.
///
/// Vertices are numbered row by row, `columns + 1` a row. The cell in column `x` of row `y` has two
/// faces: `2 · (y · columns + x)`, at the first corner of the cell, and the next one, at the last
/// corner; see [`faces`](Self::faces).
///
/// ```
/// use meshweft::{CacheModel, cache, order::Grid};
/// let grid = Grid { columns: 200, rows: 200 };
/// let acmr = |order: meshweft::Permutation| {
///     cache::acmr(&order.apply(&grid.faces()), CacheModel::fifo(12))
/// };
/// assert!(acmr(grid.snake()) > 0.9);
/// assert!(acmr(grid.hilbert()) < 0.8);
/// assert!(acmr(grid.primed_rows(12)) < 0.565);
/// assert!(cache::acmr(&grid.primed_faces(12), CacheModel::fifo(12)) < 0.555);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    /// Cells in a row.
    pub columns: u32,
    /// Rows of cells.
    pub rows: u32,
}

impl Grid {
    /// How many faces it has.
    ///
    /// # Panics
    /// If there are more than 2³² − 1.
    #[must_use]
    pub fn face_count(&self) -> usize {
        let faces = u64::from(self.columns) * u64::from(self.rows) * 2;
        usize::try_from(faces)
            .ok()
            .filter(|&faces| u32::try_from(faces).is_ok())
            .unwrap_or_else(|| panic!("{faces} faces are more than 32 bits count"))
    }

    /// Its faces, row by row.
    ///
    /// # Panics
    /// If there are more than 2³² − 1.
    #[must_use]
    pub fn faces(&self) -> Vec<[u32; 3]> {
        let mut faces = Vec::with_capacity(self.face_count());
        for y in 0..self.rows {
            for x in 0..self.columns {
                let a = y * (self.columns + 1) + x;
                let c = a + self.columns + 1;
                faces.extend([[a, a + 1, c], [a + 1, c + 1, c]]);
            }
        }
        faces
    }

    /// The faces along the rows, there and back.
    ///
    /// # Panics
    /// If there are more than 2³² − 1 faces.
    #[must_use]
    pub fn snake(&self) -> Permutation {
        let mut sequence = self.start();
        for y in 0..self.rows {
            match y % 2 {
                0 => sequence.row(y, 0..self.columns),
                _ => sequence.row_back(y, 0..self.columns),
            }
        }
        sequence.done()
    }

    /// The faces along Hilbert's curve, through a row of squares along the longer side. The side of
    /// a square is the shorter side of the grid, rounded up to a power of two.
    ///
    /// # Panics
    /// If there are more than 2³² − 1 faces.
    ///
    /// # Complexity
    /// Time O(faces · log faces).
    #[must_use]
    pub fn hilbert(&self) -> Permutation {
        let mut sequence = self.start();
        if self.face_count() == 0 {
            return sequence.done();
        }

        let side = u64::from(self.columns.min(self.rows)).next_power_of_two();
        let is_wide = self.columns >= self.rows;
        let longer = u64::from(self.columns.max(self.rows));

        let mut last = [0, 0];
        for square in 0..longer.div_ceil(side) {
            for step in 0..side * side {
                let [along, across] = hilbert_cell(side, step);
                let along = along + square * side;
                let [x, y] = match is_wide {
                    true => [along, across],
                    false => [across, along],
                };
                if x >= u64::from(self.columns) || y >= u64::from(self.rows) {
                    continue;
                }

                // The face on the side that the walk comes from is first.
                let [x, y] = [x, y].map(index32_of);
                sequence.cell(x, y, last[0] > x || last[1] > y);
                last = [x, y];
            }
        }
        sequence.done()
    }

    /// The faces in strips for a FIFO cache of `cache_size` vertices, at least 5.
    ///
    /// Misses per face are about (K − 2) / (2K − 6): .556 at 12.
    ///
    /// # Panics
    /// If the cache is smaller, or there are more than 2³² − 1 faces.
    #[must_use]
    pub fn primed_rows(&self, cache_size: u32) -> Permutation {
        assert!(
            cache_size >= 5,
            "such a strip needs a cache of five vertices"
        );

        let mut sequence = self.start();
        let width = cache_size - 3;
        // A row of this many cells leaves all its vertices in the cache, whatever was there before.
        let narrow = cache_size / 2 - 1;
        for left in (0..self.columns).step_by(width as usize) {
            let right = self.columns.min(left.saturating_add(width));

            // A row gains a cell at its start, so that the vertex that it pushes above the cell is
            // the first to leave.
            let start = |y: u32| {
                let cells = narrow.saturating_add(y.saturating_sub(1));
                right.saturating_sub(cells).max(left)
            };

            // What the widening strip leaves out, then the strip.
            for y in 0..self.rows.min(width - narrow + 1) {
                sequence.row(y, left..start(y));
            }
            for y in 0..self.rows {
                sequence.row(y, start(y)..right);
            }
        }
        sequence.done()
    }

    /// The faces in strips for a FIFO cache of `cache_size` vertices, at least 4, each strip after
    /// faces without area that name its uppermost vertices.
    ///
    /// Misses per face are about (K − 1) / (2K − 4): .55 at 12.
    ///
    /// # Panics
    /// If the cache is smaller, or there are more than 2³² − 1 faces.
    #[must_use]
    pub fn primed_faces(&self, cache_size: u32) -> Vec<[u32; 3]> {
        assert!(cache_size >= 4, "a strip needs a cache of four vertices");
        let faces = self.faces();
        let mut drawn = Vec::with_capacity(faces.len());
        for left in (0..self.columns).step_by(cache_size as usize - 2) {
            let right = self.columns.min(left.saturating_add(cache_size - 2));
            let upper: Vec<u32> = (left..=right).collect();
            for pair in upper.chunks(2) {
                drawn.push([pair[0], pair[0], pair[pair.len() - 1]]);
            }
            for y in 0..self.rows {
                let row = [left, right].map(|x| 2 * (y * self.columns + x) as usize);
                drawn.extend_from_slice(&faces[row[0]..row[1]]);
            }
        }
        drawn
    }

    fn start(&self) -> CellSequence {
        CellSequence {
            columns: self.columns,
            faces: Vec::with_capacity(self.face_count()),
        }
    }
}

/// Faces drawn so far.
struct CellSequence {
    columns: u32,
    faces: Vec<u32>,
}

impl CellSequence {
    fn cell(&mut self, x: u32, y: u32, is_last_corner_first: bool) {
        let face = 2 * (y * self.columns + x);
        let turn = u32::from(is_last_corner_first);
        self.faces.extend([face + turn, face + 1 - turn]);
    }

    fn row(&mut self, y: u32, columns: std::ops::Range<u32>) {
        columns.for_each(|x| self.cell(x, y, false));
    }

    fn row_back(&mut self, y: u32, columns: std::ops::Range<u32>) {
        columns.rev().for_each(|x| self.cell(x, y, true));
    }

    fn done(self) -> Permutation {
        debug_assert_eq!(self.faces.len(), self.faces.capacity());
        Permutation::from_algorithm(self.faces)
    }
}

/// The cell that Hilbert's curve through a square of `side` cells, a power of two, reaches after
/// `step` steps. The curve starts at the origin and ends at the other end of the first axis.
fn hilbert_cell(side: u64, step: u64) -> [u64; 2] {
    let [mut x, mut y] = [0, 0];
    let mut rest = step;
    let mut half = 1;
    while half < side {
        let right = rest / 2 % 2;
        let up = (rest ^ right) % 2;
        if up == 0 {
            if right == 1 {
                [x, y] = [half - 1 - x, half - 1 - y];
            }
            [x, y] = [y, x];
        }
        x += half * right;
        y += half * up;
        rest /= 4;
        half *= 2;
    }
    [x, y]
}

fn index32_of(n: u64) -> u32 {
    u32::try_from(n).expect("below the number of cells in a row or column")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cache::{self, CacheModel};

    fn acmr(grid: Grid, order: &Permutation, size: u32) -> f64 {
        cache::acmr(&order.apply(&grid.faces()), CacheModel::fifo(size))
    }

    #[test]
    fn all_orders_are_permutations() {
        for columns in 0..12 {
            for rows in 0..12 {
                let grid = Grid { columns, rows };
                let mut orders = vec![grid.snake(), grid.hilbert()];
                orders.extend((5..20).map(|size| grid.primed_rows(size)));
                for order in orders {
                    let new_to_old = order.new_to_old().to_vec();
                    assert_eq!(new_to_old.len(), grid.face_count());
                    Permutation::new(new_to_old).unwrap();
                }
            }
        }
    }

    #[test]
    fn hilbert_goes_from_neighbour_to_neighbour() {
        for side in [1, 2, 8, 32] {
            let cells: Vec<_> = (0..side * side).map(|d| hilbert_cell(side, d)).collect();
            for pair in cells.windows(2) {
                let distance = |axis: usize| pair[0][axis].abs_diff(pair[1][axis]);
                assert_eq!(distance(0) + distance(1), 1);
            }
            assert_eq!(cells[0], [0, 0]);
            assert_eq!(cells[cells.len() - 1], [side - 1, 0]);
        }
    }

    #[test]
    fn a_snake_misses_each_vertex_once_where_three_rows_fit() {
        let grid = Grid {
            columns: 10,
            rows: 30,
        };
        let misses = cache::misses(&grid.snake().apply(&grid.faces()), CacheModel::fifo(33));
        assert_eq!(misses, 11 * 31);
    }

    #[test]
    fn primed_strips_miss_nothing_but_their_first_column_again() {
        let grid = Grid {
            columns: 200,
            rows: 200,
        };
        for size in [5, 6, 7, 8, 9, 10, 12, 16, 24, 32] {
            let found = acmr(grid, &grid.primed_rows(size), size);
            let ideal = f64::from(size - 2) / f64::from(2 * size - 6);
            // Vertices of the first rows, and of what the strips leave out, are missed twice.
            assert!(found < ideal * 1.05, "{size}: {found}, {ideal}");
        }
    }

    #[test]
    fn primed_faces_are_all_faces_and_some_without_area() {
        let grid = Grid {
            columns: 200,
            rows: 100,
        };
        for size in [4, 5, 8, 12, 16, 33] {
            let faces = grid.primed_faces(size);
            let misses = cache::misses(&faces, CacheModel::fifo(size));
            // Each strip misses its vertices once: only the column between two strips counts twice.
            let strips = u64::from(grid.columns.div_ceil(size - 2));
            assert_eq!(misses, (201 + strips - 1) * 101);
            let mut proper: Vec<_> = faces.into_iter().filter(|f| f[0] != f[1]).collect();
            proper.sort_unstable();
            let mut all = grid.faces();
            all.sort_unstable();
            assert_eq!(proper, all);
        }
    }

    #[test]
    fn hilbert_is_good_for_every_cache() {
        let grid = Grid {
            columns: 64,
            rows: 64,
        };
        let figures = [12, 16, 32, 64].map(|size| acmr(grid, &grid.hilbert(), size));
        let snake = [12, 16, 32, 64].map(|size| acmr(grid, &grid.snake(), size));
        assert!(
            figures.iter().zip(snake).all(|(&h, s)| h < s),
            "{figures:?} {snake:?}"
        );
    }
}
