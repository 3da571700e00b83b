//! The hierarchy over points: 36 bytes a vertex, and which point it is.
//!
//! The paper cuts each diamond at a point of the input near the middle of its side, so that the quadtree stays restricted and its
//! vertices are the points themselves.
//!
//! # Where the paper leaves room
//! - **Which point.** Of the *kernel* of a diamond, the places around which four triangles are counter-clockwise, the unused point
//!   nearest to the middle of the common side. No bound on shapes: it would multiply the vertices that are no points.
//! - **Where there is none.** A *Steiner point* in the middle, at the height of the side. A triangle without points is not cut, unless
//!   one beside it has to be. So over a grid of 2^k + 1 points a side there is no Steiner point, and the hierarchy is the regular one.
//! - **Where points are looked for.** Each triangle has the list of those inside, and all lists of a level stand one after the other:
//!   triangles are cut level by level, so no other level has points.
//! - **Numbers.** Signs are exact (`geometry::signs`), places are `f32`. Near the last bits of these a diamond may have no place inside, so
//!   a triangle is kept wider than two numbers as long as that is possible. What cannot be cut keeps its points, which
//!   are counted as left out, with their distance from the surface.
//! - **Errors.** Those of all input points in the triangle that covers them, never below the true ones (`point_distance`).
//!
//! Read `point_build` first, then `point_places`.

use super::point_input::PointCounts;
use super::triangle::{BisectionTree, Detail, NONE, NodeBound, TinTriangle};

/// A vertex of a hierarchy over points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PointNode {
    pub(super) position: [f32; 3],
    /// The largest vertical distance of an input point below to the surface without this vertex, or without one below.
    pub(super) error: f32,
    /// Around the vertex, all that there is below.
    pub(super) radius: f32,
    /// Where the four triangles around it are cut, at 2 × side + half: twice the vertex, and which side of its diamond the triangle is.
    pub(super) children: [u32; 4],
}

impl PointNode {
    pub(super) const EMPTY: Self = Self {
        position: [0.0; 3],
        error: 0.0,
        radius: 0.0,
        children: [NONE; 4],
    };
}

/// All levels of detail of a terrain over points at any places: a restricted quadtree whose vertices are the points.
///
/// Each vertex knows how far any input point below it may be from the surface without it, vertically, and never less. Vertices that
/// are no points of the input, *Steiner points*, are there where no point was at a place to cut at, and at the corners.
///
/// Vertices are numbered as they were made, from coarse to fine. The first four are the corners of the rectangle around all
/// points; the fifth, if there is one, cuts the two triangles of the rectangle.
///
/// ```
/// use meshweft::lod::CameraView;
/// use meshweft::lod::quad_tin::{PointHierarchy, TinSurface};
/// // x east, y up, z south.
/// let points = [[0.0, 5.0, 0.0], [9.0, 5.0, 0.0], [0.0, 5.0, 9.0], [9.0, 5.0, 9.0], [4.0, 7.0, 3.0]];
/// let terrain = PointHierarchy::over(&points)?;
/// assert_eq!((terrain.vertex_count(), terrain.counts().steiner), (5, 0));
///
/// let mut surface = TinSurface::default();
/// terrain.draw(&CameraView::of_errors_above(1.0)?, &mut surface);
/// assert_eq!(surface.faces().len(), 4);
/// terrain.draw(&CameraView::of_errors_above(2.1)?, &mut surface);
/// assert_eq!(surface.faces().len(), 2);
/// assert!(surface.largest_error() >= 2.0 && surface.largest_error() < 2.001);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct PointHierarchy {
    pub(super) nodes: Vec<PointNode>,
    /// The input point that each vertex is; [`NONE`] for a Steiner point. Empty if it was read from a file.
    pub(super) sources: Vec<u32>,
    /// Whether each vertex is no point of the input.
    pub(super) is_steiner: Vec<bool>,
    pub(super) counts: PointCounts,
    /// What of a file was not read yet.
    pub(super) unread: UnreadPoints,
}

/// Which vertices of a file were not read yet. Empty if all are there.
#[derive(Debug, Clone, Default)]
pub(super) struct UnreadPoints {
    /// Of each block.
    pub(super) blocks: Vec<bool>,
    /// Of each side of each vertex, whether it is where a triangle is cut: no two are, or they would be cut without end.
    pub(super) is_used: Vec<bool>,
}

/// How many vertices a block of a file has.
pub(super) const BLOCK_VERTICES: usize = 512;

/// How many corners the rectangle has.
pub(super) const CORNERS: u32 = 4;

/// Apex, left and right of the coarsest triangles, of which the corners are numbered row by row from north-west.
pub(super) const ROOTS: [[u32; 3]; 2] = [[1, 0, 3], [2, 3, 0]];

impl BisectionTree for PointHierarchy {
    fn roots(&self) -> [TinTriangle; 2] {
        let split = match self.nodes.len() > CORNERS as usize {
            true => CORNERS,
            false => NONE,
        };
        [0, 1].map(|side| {
            let [apex, left, right] = ROOTS[usize::from(side)];
            TinTriangle {
                apex,
                left,
                right,
                split,
                side,
                id: 4 * apex,
            }
        })
    }

    fn halves(&self, triangle: &TinTriangle) -> [TinTriangle; 2] {
        let apex = triangle.split;
        let node = &self.nodes[apex as usize];
        let ends = [
            [triangle.apex, triangle.left],
            [triangle.right, triangle.apex],
        ];
        [0, 1].map(|half| {
            let place = 2 * u32::from(triangle.side) + half;
            let child = node.children[place as usize];
            let [left, right] = ends[half as usize];
            let [split, side] = match child {
                NONE => [NONE, 0],
                _ => [child >> 1, child & 1],
            };
            TinTriangle {
                apex,
                left,
                right,
                split,
                side: u8::from(side == 1),
                id: 4 * apex + place,
            }
        })
    }

    fn is_inside(&self, _: &TinTriangle) -> bool {
        true
    }

    fn detail(&self, triangle: &TinTriangle) -> Detail {
        if triangle.split == NONE {
            return Detail::Finest;
        }
        let block = triangle.split as usize / BLOCK_VERTICES;
        if self.unread.blocks.get(block).is_some_and(|&it| it) {
            return Detail::Missing(block);
        }
        let node = &self.nodes[triangle.split as usize];
        Detail::Inside(NodeBound {
            position: node.position,
            error: node.error,
            radius: node.radius,
            surface: [true; 2],
        })
    }

    fn is_surface(&self, _: &TinTriangle) -> bool {
        true
    }

    fn number(&self, vertex: u32) -> u32 {
        vertex
    }
}
