//! The hierarchy of a grid: eight bytes a vertex, in blocks.

use super::grid_square::{self, GridSquare};
use super::rounded::{INFINITE, LengthScale};
use super::triangle::{BisectionTree, Detail, NONE, NodeBound, TinTriangle};
use crate::height_grid::horizontal;
use crate::index::index32;

/// A vertex of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GridNode {
    /// NaN where the grid is void.
    pub(super) height: f32,
    /// The code of the error; the highest bit says that its first triangle is void.
    pub(super) error: u16,
    /// That of the radius; the second triangle.
    pub(super) radius: u16,
}

/// Of the codes of a node: a triangle is void.
pub(super) const VOID: u16 = 1 << 15;

impl GridNode {
    pub(super) const EMPTY: Self = Self {
        height: f32::NAN,
        error: 0,
        radius: 0,
    };
}

/// Vertices a side of a block, those of higher levels counted: these are not in it.
const BLOCK_SIDE: u32 = 64;
/// Vertices of a block.
pub(super) const BLOCK_NODES: usize = 3 * (BLOCK_SIDE * BLOCK_SIDE / 4) as usize;

/// Where the blocks of a grid are: those of the finest level first, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct GridBlocks {
    pub(super) square: GridSquare,
    /// Of each level its first block, and how many there are from west to east.
    levels: Vec<[u32; 2]>,
    pub(super) count: usize,
}

impl GridBlocks {
    pub(super) fn new(size: [u32; 2]) -> Self {
        let square = GridSquare::new(size);
        let mut count = 0;
        let levels = (0..=square.levels()).map(|level| {
            let [across, down] = size.map(|it| (((it - 1) >> level) + 1).div_ceil(BLOCK_SIDE));
            let first = count;
            count += across * down;
            [first, across]
        });
        Self {
            square,
            levels: levels.collect(),
            count: count as usize,
        }
    }

    /// The block of a vertex, and its place there.
    #[inline]
    pub(super) fn at(&self, place: [u32; 2]) -> (usize, usize) {
        let level = self.square.level(place);
        let [first, across] = self.levels[level as usize];
        let [column, row] = place.map(|it| it >> level);
        let block = first + row / BLOCK_SIDE * across + column / BLOCK_SIDE;
        let [column, row] = [column, row].map(|it| it % BLOCK_SIDE);
        // Where both are even there is a vertex of a higher level; in the end there is none.
        let is_highest = level == self.square.levels();
        let inside = match (is_highest, row % 2) {
            (true, _) => 2 * row + column,
            (_, 0) => row / 2 * (3 * BLOCK_SIDE / 2) + column / 2,
            _ => row / 2 * (3 * BLOCK_SIDE / 2) + BLOCK_SIDE / 2 + column,
        };
        (block as usize, inside as usize)
    }

    /// The vertices of a block in their order, with their places in it.
    pub(super) fn vertices(&self, block: usize) -> impl Iterator<Item = (usize, u32)> + '_ {
        let is_after = |&[first, _]: &[u32; 2]| first as usize <= block;
        let level = self.levels.partition_point(is_after) - 1;
        let [first, across] = self.levels[level];
        let block = index32(block) - first;
        let origin = [block % across, block / across].map(|it| it * BLOCK_SIDE);
        let is_highest = level == self.levels.len() - 1;
        let [columns, rows] =
            [0, 1].map(|axis| ((self.square.size[axis] - 1) >> level) + 1 - origin[axis]);
        (0..rows.min(BLOCK_SIDE)).flat_map(move |row| {
            let step = if row % 2 == 0 && !is_highest { 2 } else { 1 };
            let columns = (step - 1..columns.min(BLOCK_SIDE)).step_by(step as usize);
            columns.map(move |column| {
                let place = [origin[0] + column, origin[1] + row].map(|it| it << level);
                (self.at(place).1, grid_square::vertex(place[0], place[1]))
            })
        })
    }
}

/// The hierarchy over a grid.
#[derive(Debug, Clone)]
pub(super) struct GridTin {
    pub(super) blocks: GridBlocks,
    pub(super) spacing: [f64; 2],
    pub(super) errors: LengthScale,
    pub(super) radii: LengthScale,
    /// `None`: not read yet.
    pub(super) nodes: Vec<Option<Box<[GridNode]>>>,
}

impl GridTin {
    /// One without any block.
    pub(super) fn new(size: [u32; 2], spacing: [f64; 2], scales: [LengthScale; 2]) -> Self {
        let blocks = GridBlocks::new(size);
        Self {
            nodes: vec![None; blocks.count],
            blocks,
            spacing,
            errors: scales[0],
            radii: scales[1],
        }
    }

    /// A vertex, if its block was read.
    #[inline]
    pub(super) fn node(&self, place: [u32; 2]) -> Result<&GridNode, usize> {
        let (block, inside) = self.blocks.at(place);
        match &self.nodes[block] {
            Some(nodes) => Ok(&nodes[inside]),
            None => Err(block),
        }
    }

    pub(super) fn node_mut(&mut self, place: [u32; 2]) -> Option<&mut GridNode> {
        let (block, inside) = self.blocks.at(place);
        self.nodes[block].as_mut().map(|nodes| &mut nodes[inside])
    }

    /// Where a vertex is. The height is 0 where it is void or was not read.
    pub(super) fn position(&self, place: [u32; 2]) -> [f32; 3] {
        let height = self.node(place).map_or(f32::NAN, |it| it.height);
        self.raised(place, height)
    }

    /// The place with a number.
    pub(super) fn place(&self, number: u32) -> [u32; 2] {
        grid_square::place(self.blocks.square.vertex_of(number))
    }

    fn raised(&self, place: [u32; 2], height: f32) -> [f32; 3] {
        let [x, z] = horizontal(self.blocks.square.size, self.spacing, place[0], place[1]);
        let height = if height.is_nan() { 0.0 } else { height };
        [x, height, z]
    }

    /// The error of a vertex, 0 for the corners and for what was not read.
    pub(super) fn error(&self, place: [u32; 2]) -> f32 {
        let code = self.node(place).map_or(0, |it| it.error & !VOID);
        self.errors.length(code)
    }
}

impl BisectionTree for GridTin {
    fn roots(&self) -> [TinTriangle; 2] {
        self.blocks.square.roots()
    }

    fn halves(&self, triangle: &TinTriangle) -> [TinTriangle; 2] {
        self.blocks.square.halves(triangle)
    }

    #[inline]
    fn is_inside(&self, triangle: &TinTriangle) -> bool {
        self.blocks.square.is_inside(triangle)
    }

    #[inline]
    fn detail(&self, triangle: &TinTriangle) -> Detail {
        let square = &self.blocks.square;
        let is_inside = square.is_inside(triangle);
        if !is_inside && square.is_outside(triangle) {
            return Detail::Outside;
        }
        if triangle.split == NONE {
            return Detail::Finest;
        }
        if !square.has(triangle.split) {
            return Detail::Crossing;
        }
        let place = grid_square::place(triangle.split);
        match self.node(place) {
            Err(block) => Detail::Missing(block),
            Ok(node) if node.error & !VOID == INFINITE => Detail::Crossing,
            // A file that someone made up may have any error there.
            Ok(_) if !is_inside => Detail::Crossing,
            Ok(node) => Detail::Inside(NodeBound {
                position: self.raised(place, node.height),
                error: self.errors.length(node.error & !VOID),
                radius: self.radii.length(node.radius & !VOID),
                surface: [node.error, node.radius].map(|flags| flags & VOID == 0),
            }),
        }
    }

    fn is_surface(&self, triangle: &TinTriangle) -> bool {
        let corners = [triangle.apex, triangle.left, triangle.right];
        // Each is where a triangle above was cut, or a corner of the square: all were read.
        corners.into_iter().all(|it| {
            let height = |it| self.node(grid_square::place(it)).map(|node| node.height);
            self.blocks.square.has(it) && height(it).is_ok_and(|it| !it.is_nan())
        })
    }

    fn number(&self, vertex: u32) -> u32 {
        self.blocks.square.number(vertex)
    }
}
