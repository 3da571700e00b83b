//! Heights on a regular grid.

use std::fmt;

mod voids;

/// Heights above a regular grid, row by row; places without a height are *void*.
///
/// Heights are in metres, upwards. Rows go from north to south, columns from west to east. A void is NaN.
///
/// ```
/// use meshweft::HeightGrid;
/// let grid = HeightGrid::new([3, 2], [30.0, 30.0], vec![1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0])?;
/// assert_eq!(grid.height(2, 0), Some(3.0));
/// assert_eq!((grid.height(1, 1), grid.void_count()), (None, 1));
/// assert_eq!(grid.position(0, 1), [-30.0, 4.0, 15.0]); // x east, y up, z south
/// # Ok::<(), meshweft::HeightGridError>(())
/// ```
#[derive(Debug, Clone)]
pub struct HeightGrid {
    size: [u32; 2],
    spacing: [f64; 2],
    heights: Vec<f32>,
}

/// Why heights are not a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum HeightGridError {
    /// The number of heights is not columns times rows.
    #[non_exhaustive]
    Count {
        /// Columns and rows.
        size: [u32; 2],
        /// How many heights there are.
        heights: usize,
    },
    /// A grid has fewer than two or more than 32,769 columns or rows.
    #[non_exhaustive]
    Size {
        /// Columns and rows.
        size: [u32; 2],
    },
    /// The distance of columns or rows is not above 0, or so large that positions are not finite.
    #[non_exhaustive]
    Spacing {
        /// Of columns and of rows.
        spacing: [f64; 2],
    },
    /// A height is infinite.
    #[non_exhaustive]
    Infinite {
        /// Its column and row.
        place: [u32; 2],
    },
}

impl fmt::Display for HeightGridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count {
                size: [columns, rows],
                heights,
            } => write!(
                f,
                "{heights} heights for {columns} columns and {rows} rows: give one for each place, NaN where there is none"
            ),
            Self::Size {
                size: [columns, rows],
            } => write!(
                f,
                "a grid of {columns} columns and {rows} rows: give 2 to {} of each",
                HeightGrid::MOST
            ),
            Self::Spacing { spacing: [x, z] } => write!(
                f,
                "columns {x} and rows {z} metres apart: give distances above 0, with which positions fit in 32-bit numbers"
            ),
            Self::Infinite {
                place: [column, row],
            } => write!(
                f,
                "the height in column {column}, row {row} is infinite: give a finite one, or NaN where there is none"
            ),
        }
    }
}

impl std::error::Error for HeightGridError {}

impl HeightGrid {
    /// Most columns or rows.
    pub const MOST: u32 = (1 << 15) + 1;

    /// A grid of columns and rows, with distances between them in metres.
    ///
    /// # Errors
    /// [`HeightGridError`] if the sizes do not fit, or a number is infinite.
    pub fn new(
        size: [u32; 2],
        spacing: [f64; 2],
        heights: Vec<f32>,
    ) -> Result<Self, HeightGridError> {
        let [columns, rows] = size;
        if !size.iter().all(|it| (2..=Self::MOST).contains(it)) {
            return Err(HeightGridError::Size { size });
        }
        if !is_spacing(size, spacing) {
            return Err(HeightGridError::Spacing { spacing });
        }
        if heights.len() != columns as usize * rows as usize {
            let heights = heights.len();
            return Err(HeightGridError::Count { size, heights });
        }
        match heights.iter().position(|it| it.is_infinite()) {
            Some(at) => {
                let [column, row] = [at % columns as usize, at / columns as usize];
                let place = [column, row].map(crate::index::index32);
                Err(HeightGridError::Infinite { place })
            }
            None => Ok(Self {
                size,
                spacing,
                heights,
            }),
        }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// How far columns and rows are apart, in metres.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        self.spacing
    }

    /// All heights, row by row; NaN where there is none.
    #[must_use]
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The height of a place, unless it is void.
    ///
    /// # Panics
    /// If there is no such column or row.
    #[must_use]
    pub fn height(&self, column: u32, row: u32) -> Option<f32> {
        assert!(column < self.size[0], "no such column");
        let height = self.heights[row as usize * self.size[0] as usize + column as usize];
        (!height.is_nan()).then_some(height)
    }

    /// Where a place is: x east, y up, z south, from the middle of the grid. y is NaN where the place is void.
    ///
    /// # Panics
    /// If there is no such column or row.
    #[must_use]
    pub fn position(&self, column: u32, row: u32) -> [f32; 3] {
        let [x, z] = self.horizontal(column, row);
        [x, self.height(column, row).unwrap_or(f32::NAN), z]
    }

    /// x and z of a place, which may be outside of the grid.
    pub(crate) fn horizontal(&self, column: u32, row: u32) -> [f32; 2] {
        horizontal(self.size, self.spacing, column, row)
    }

    /// The lowest and the highest height; `None` if all places are void.
    #[must_use]
    pub fn height_range(&self) -> Option<[f32; 2]> {
        let heights = self.heights.iter().copied().filter(|it| !it.is_nan());
        heights.fold(None, |range, height| match range {
            None => Some([height; 2]),
            Some([low, high]) => Some([height.min(low), height.max(high)]),
        })
    }

    /// How many places are void.
    #[must_use]
    pub fn void_count(&self) -> usize {
        self.heights.iter().filter(|it| it.is_nan()).count()
    }
}

/// Whether distances of columns and rows are above 0, and all places of a grid of this size have finite positions.
pub(crate) fn is_spacing(size: [u32; 2], spacing: [f64; 2]) -> bool {
    let last = size.map(|it| it.max(1) - 1);
    let is_above_0 = spacing.iter().all(|&it| it > 0.0);
    is_above_0
        && horizontal(size, spacing, last[0], last[1])
            .iter()
            .all(|it| it.is_finite())
}

/// x and z of a place of a grid of this size and spacing.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to the nearest, as positions are"
)]
pub(crate) fn horizontal(size: [u32; 2], spacing: [f64; 2], column: u32, row: u32) -> [f32; 2] {
    let along = |axis: usize, at: u32| {
        let middle = 0.5 * f64::from(size[axis] - 1);
        ((f64::from(at) - middle) * spacing[axis]) as f32
    };
    [along(0, column), along(1, row)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_grid_is_said() {
        let error = |size, spacing, heights| HeightGrid::new(size, spacing, heights).unwrap_err();
        let metre = [1.0, 1.0];
        assert!(matches!(
            error([2, 2], metre, vec![0.0; 5]),
            HeightGridError::Count { heights: 5, .. }
        ));
        for size in [[1, 2], [2, 0], [32_770, 2]] {
            let found = error(size, metre, vec![0.0; 2]);
            assert_eq!(found, HeightGridError::Size { size });
        }
        for spacing in [[0.0, 1.0], [1.0, f64::INFINITY], [-1.0, 1.0], [1e39, 1.0]] {
            let found = error([2, 2], spacing, vec![0.0; 4]);
            assert_eq!(found, HeightGridError::Spacing { spacing });
        }
        let heights = vec![0.0, 1.0, f32::NAN, f32::NEG_INFINITY, 1.0, 2.0];
        assert_eq!(
            error([2, 3], metre, heights),
            HeightGridError::Infinite { place: [1, 1] }
        );
    }
}
