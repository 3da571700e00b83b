//! Where the vertices of a grid are, and which triangles are cut at which.
//!
//! A grid lies in a square of 2^k + 1 places a side, in its corner of column and row 0. A vertex is its column and its row in
//! one number, column above. Its *level* is how often both can be halved: the vertices of a level and those above it are a grid
//! of cells 2^level wide.

use super::triangle::{NONE, TinTriangle};

/// A square of places that has a grid in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct GridSquare {
    /// Columns and rows of the grid.
    pub(super) size: [u32; 2],
    /// Cells of the square, a power of two.
    pub(super) cells: u32,
}

/// The two triangles that are cut at a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Diamond {
    /// The ends of the side that they share; the first has the smaller number.
    pub(super) ends: [u32; 2],
    /// The apexes; `None` outside of the square.
    pub(super) apexes: [Option<u32>; 2],
}

pub(super) fn vertex(column: u32, row: u32) -> u32 {
    column << 16 | row
}

/// Column and row.
pub(super) fn place(vertex: u32) -> [u32; 2] {
    [vertex >> 16, vertex & 0xFFFF]
}

impl GridSquare {
    pub(super) fn new(size: [u32; 2]) -> Self {
        let cells = size[0].max(size[1]) - 1;
        Self {
            size,
            cells: cells.next_power_of_two().max(2),
        }
    }

    /// How often the square can be halved: the level of its corners.
    pub(super) fn levels(&self) -> u32 {
        self.cells.trailing_zeros()
    }

    #[inline]
    pub(super) fn level(&self, [column, row]: [u32; 2]) -> u32 {
        (column | row).trailing_zeros().min(self.levels())
    }

    /// Whether a vertex is one of the grid's.
    #[inline]
    pub(super) fn has(&self, vertex: u32) -> bool {
        let [column, row] = place(vertex);
        column < self.size[0] && row < self.size[1]
    }

    /// Whether a triangle has nothing of the grid's rectangle inside.
    pub(super) fn is_outside(&self, triangle: &TinTriangle) -> bool {
        let corners = [triangle.apex, triangle.left, triangle.right].map(place);
        let [last_column, last_row] = self.size.map(|it| it - 1);
        let is_beyond = |far: fn(&[u32; 2]) -> u32, last| corners.iter().all(|it| far(it) >= last);
        is_beyond(|it| it[0], last_column)
            || is_beyond(|it| it[1], last_row)
            || is_beyond(|it| it[0] + it[1], last_column + last_row)
    }

    /// Whether a triangle is in the grid's rectangle.
    #[inline]
    pub(super) fn is_inside(&self, triangle: &TinTriangle) -> bool {
        [triangle.apex, triangle.left, triangle.right]
            .iter()
            .all(|&it| self.has(it))
    }

    pub(super) fn roots(&self) -> [TinTriangle; 2] {
        let [first, last] = [vertex(0, 0), vertex(self.cells, self.cells)];
        [
            (vertex(self.cells, 0), [first, last]),
            (vertex(0, self.cells), [last, first]),
        ]
        .map(|(apex, ends)| self.triangle(apex, ends, 0))
    }

    /// A triangle, whose number ends with `kind`.
    fn triangle(&self, apex: u32, [left, right]: [u32; 2], kind: u32) -> TinTriangle {
        TinTriangle {
            apex,
            left,
            right,
            split: middle(left, right),
            side: u8::from(left > right),
            id: match self.has(apex) {
                true => 4 * self.number(apex) + kind,
                false => NONE,
            },
        }
    }

    #[inline]
    pub(super) fn halves(&self, triangle: &TinTriangle) -> [TinTriangle; 2] {
        let TinTriangle {
            apex,
            left,
            right,
            split,
            side,
            ..
        } = *triangle;
        let kind = 2 * u32::from(side);
        [
            self.triangle(split, [apex, left], kind),
            self.triangle(split, [right, apex], kind + 1),
        ]
    }

    /// What is cut at a vertex other than the corners of the square.
    pub(super) fn diamond(&self, middle: u32) -> Diamond {
        let [column, row] = place(middle);
        let level = self.level([column, row]);
        let step = 1 << level;
        let is_odd = [column, row].map(|at| at >> level & 1 == 1);
        let [west, north] = [column.wrapping_sub(step), row.wrapping_sub(step)];
        let [east, south] = [column + step, row + step];
        let inside = |column: u32, row: u32| {
            let is_inside = column <= self.cells && row <= self.cells;
            is_inside.then(|| vertex(column, row))
        };
        match is_odd {
            // In the middle of a cell, whose diagonal joins two vertices of the next level but one.
            [true, true] => match (west ^ north) >> (level + 1) & 1 == 0 {
                true => Diamond {
                    ends: [vertex(west, north), vertex(east, south)],
                    apexes: [inside(east, north), inside(west, south)],
                },
                false => Diamond {
                    ends: [vertex(west, south), vertex(east, north)],
                    apexes: [inside(west, north), inside(east, south)],
                },
            },
            [true, false] => Diamond {
                ends: [vertex(west, row), vertex(east, row)],
                apexes: [inside(column, north), inside(column, south)],
            },
            _ => Diamond {
                ends: [vertex(column, north), vertex(column, south)],
                apexes: [inside(east, row), inside(west, row)],
            },
        }
    }

    /// The triangles that are cut at a vertex, as far as the square has them.
    pub(super) fn sides(&self, middle: u32) -> [Option<TinTriangle>; 2] {
        let Diamond {
            ends: [first, last],
            apexes: [one, other],
        } = self.diamond(middle);
        [(one, [first, last]), (other, [last, first])]
            .map(|(apex, ends)| apex.map(|apex| self.triangle(apex, ends, 0)))
    }

    /// The number of a vertex of the grid, row by row.
    pub(super) fn number(&self, vertex: u32) -> u32 {
        let [column, row] = place(vertex);
        row * self.size[0] + column
    }

    /// The vertex with a number.
    pub(super) fn vertex_of(&self, number: u32) -> u32 {
        vertex(number % self.size[0], number / self.size[0])
    }
}

/// The vertex between two, if there is one.
fn middle(left: u32, right: u32) -> u32 {
    // Both differences are even, or both are odd.
    let has_middle = (left ^ right) & 0x0001_0001 == 0;
    match has_middle {
        true => left.midpoint(right),
        false => NONE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_from_above_are_those_around_each_vertex() {
        for size in [[2, 2], [5, 5], [9, 6], [17, 17], [12, 31]] {
            let square = GridSquare::new(size);
            let mut triangles = square.roots().to_vec();
            let mut area = 0;
            while let Some(triangle) = triangles.pop() {
                // Counter-clockwise from above, and of a right angle.
                let [a, b, c] = [triangle.apex, triangle.left, triangle.right]
                    .map(|it| place(it).map(u32::cast_signed));
                let [x, y] = [0, 1].map(|axis| [b[axis] - a[axis], c[axis] - a[axis]]);
                assert_eq!(x[0] * x[1] + y[0] * y[1], 0);
                let doubled = x[1] * y[0] - x[0] * y[1];
                assert!(doubled > 0);
                if triangle.split == NONE {
                    area += doubled;
                    assert_eq!(doubled, 1);
                    continue;
                }
                let side = square.sides(triangle.split)[usize::from(triangle.side)];
                let same = |it: TinTriangle| [it.apex, it.left, it.right, it.split];
                assert_eq!(side.map(same), Some(same(triangle)));
                triangles.extend(square.halves(&triangle));
            }
            assert_eq!(area, 2 * (square.cells * square.cells).cast_signed());
        }
    }
}
