//! A hierarchy over a grid, or over points.

use std::io::{self, Write};

use super::descent::{TinSurface, draw};
use super::extent::TinExtent;
use super::grid::GridTin;
use super::limited::{TinLimit, draw_within};
use super::points::PointHierarchy;
use super::stored_tree::{self, StoredTree};
use crate::lod::view::CameraView;

/// A hierarchy of either kind.
#[derive(Debug, Clone)]
pub(super) enum TinTree {
    Grid(GridTin),
    Points(PointHierarchy),
}

/// Does the same with either kind.
macro_rules! with_tree {
    ($self:expr, $tree:ident => $done:expr) => {
        match $self {
            TinTree::Grid($tree) => $done,
            TinTree::Points($tree) => $done,
        }
    };
}

impl TinTree {
    pub(super) fn draw(&self, view: &CameraView, surface: &mut TinSurface) {
        with_tree!(self, tree => draw(tree, view, surface));
    }

    pub(super) fn draw_within(&self, limit: TinLimit, view: &CameraView, surface: &mut TinSurface) {
        with_tree!(self, tree => draw_within(tree, view, limit, surface));
    }

    pub(super) fn vertex_count(&self) -> usize {
        with_tree!(self, tree => StoredTree::vertex_count(tree))
    }

    pub(super) fn block_count(&self) -> usize {
        with_tree!(self, tree => tree.block_count())
    }

    pub(super) fn corner_block(&self) -> usize {
        with_tree!(self, tree => tree.corner_block())
    }

    pub(super) fn has_block(&self, block: usize) -> bool {
        with_tree!(self, tree => tree.has_block(block))
    }

    pub(super) fn write(
        &self,
        extent: TinExtent,
        name: &str,
        sink: &mut dyn Write,
    ) -> io::Result<()> {
        with_tree!(self, tree => stored_tree::write(tree, extent, name, sink))
    }
}
