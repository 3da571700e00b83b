//! How the hierarchy of a grid comes about: from the finest level up.

use super::grid::{BLOCK_NODES, GridNode, GridTin, VOID};
use super::grid_square;
use super::plane::HeightPlanes;
use super::rounded::{INFINITE, LengthScale};
use super::triangle::{NONE, TinTriangle};
use crate::geometry::double::{dot, sub, widened};
use crate::height_grid::HeightGrid;

/// What a triangle is of a grid with holes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Solidity {
    Surface,
    Void,
    Both,
}

impl GridTin {
    /// The hierarchy over a grid.
    ///
    /// # Complexity
    /// Time O(n log n) for n places, memory 12 bytes a place beside those of the heights.
    pub(super) fn over(grid: &HeightGrid) -> Self {
        let mut tin = Self::without_errors(grid);
        let planes = HeightPlanes::new(grid);
        let has_voids = grid.heights().iter().any(|it| it.is_nan());

        // The vertices between two of a higher level, then those in the middle of four.
        let [columns, rows] = grid.size();
        for level in 0..tin.blocks.square.levels() {
            let step = 1 << level;
            let odd = |limit: u32| (step..limit).step_by(2 * step as usize);
            let even = |limit: u32| (0..limit).step_by(2 * step as usize);
            for row in even(rows) {
                odd(columns).for_each(|column| tin.finish([column, row], &planes, has_voids));
            }
            for row in odd(rows) {
                even(columns).for_each(|column| tin.finish([column, row], &planes, has_voids));
            }
            for row in odd(rows) {
                odd(columns).for_each(|column| tin.finish([column, row], &planes, has_voids));
            }
        }
        tin
    }

    /// Vertices with their heights and nothing else.
    fn without_errors(grid: &HeightGrid) -> Self {
        let [low, high] = grid.height_range().unwrap_or([0.0; 2]).map(f64::from);
        let [across, down] = [0, 1].map(|i| grid.spacing()[i] * f64::from(grid.size()[i]));
        // Errors are below the range of heights, but for the rounding of places; a radius is a sum of distances that shrink.
        let diagonal = across + down + (high - low);
        let scales = [2.0 * (high - low), 16.0 * diagonal].map(LengthScale::up_to);
        let mut tin = Self::new(grid.size(), grid.spacing(), scales);
        for block in 0..tin.blocks.count {
            let mut nodes = vec![GridNode::EMPTY; BLOCK_NODES].into_boxed_slice();
            for (inside, vertex) in tin.blocks.vertices(block) {
                let number = tin.blocks.square.number(vertex);
                nodes[inside].height = grid.heights()[number as usize];
            }
            tin.nodes[block] = Some(nodes);
        }
        tin
    }

    /// Finds what a vertex has, of which all below are finished, and passes it on to those above.
    fn finish(&mut self, place: [u32; 2], planes: &HeightPlanes<'_>, has_voids: bool) {
        let vertex = grid_square::vertex(place[0], place[1]);
        let square = self.blocks.square;
        let Ok(&node) = self.node(place) else { return };

        // The two triangles that are cut here.
        let sides = square.sides(vertex);
        let mut error = 0.0_f64;
        let mut flags = [0; 2];
        for (side, flag) in sides.iter().zip(&mut flags) {
            let Some(triangle) = side.filter(|it| !square.is_outside(it)) else {
                continue;
            };
            let part = match square.is_inside(&triangle) {
                false => Solidity::Both,
                true if has_voids => self.part(&triangle),
                true => Solidity::Surface,
            };
            match part {
                Solidity::Both => error = f64::INFINITY,
                Solidity::Void => *flag = VOID,
                Solidity::Surface if error.is_finite() => {
                    let corners = [triangle.apex, triangle.left, triangle.right];
                    error = error.max(planes.largest_error(corners.map(grid_square::place)));
                }
                Solidity::Surface => {}
            }
        }
        let error = node.error.max(self.errors.code(error));
        let finished = GridNode {
            height: node.height,
            error: error | flags[0],
            radius: node.radius | flags[1],
        };
        if let Some(node) = self.node_mut(place) {
            *node = finished;
        }

        // Those above have at least its error, and its ball in theirs.
        let position = self.position(place);
        let radius = f64::from(self.radii.length(node.radius));
        let apexes = sides.into_iter().flatten().map(|it| it.apex);
        for above in apexes.filter(|&it| square.has(it)).map(grid_square::place) {
            let way = sub(widened(self.position(above)), widened(position));
            let radii = self.radii;
            let Some(above) = self.node_mut(above) else {
                continue;
            };
            above.error = above.error.max(error);
            // Where an error is infinite, the ball does not count, and what is void has no place.
            if error != INFINITE && !node.height.is_nan() {
                // A little more, so that no rounding of distances to an eye, even a far one, turns the order round.
                let reach = (dot(way, way).sqrt() + radius) * (1.0 + 1e-6);
                above.radius = above.radius.max(radii.code(reach));
            }
        }
    }

    /// What a triangle is, of which the halves are finished.
    fn part(&self, triangle: &TinTriangle) -> Solidity {
        let [one, other] = self.blocks.square.halves(triangle).map(|half| {
            let is_void = match half.split {
                NONE => [half.apex, half.left, half.right]
                    .iter()
                    .any(|&it| self.is_void(grid_square::place(it))),
                split => match self.node(grid_square::place(split)) {
                    Ok(node) if node.error & !VOID == INFINITE => return Solidity::Both,
                    Ok(node) => [node.error, node.radius][usize::from(half.side)] & VOID != 0,
                    Err(_) => true,
                },
            };
            if is_void {
                Solidity::Void
            } else {
                Solidity::Surface
            }
        });
        if one == other { one } else { Solidity::Both }
    }

    fn is_void(&self, place: [u32; 2]) -> bool {
        self.node(place).is_ok_and(|it| it.height.is_nan())
    }
}
