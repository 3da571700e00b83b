//! Surfaces over points, as over a grid.

use super::descent::{Descent, TinSurface, draw};
use super::extent::TinExtent;
use super::limited::{TinLimit, draw_within};
use super::point_input::PointCounts;
use super::points::PointHierarchy;
use super::triangle::{NONE, NodeBound};
use crate::lod::view::CameraView;

impl PointHierarchy {
    /// What became of the points of the input.
    #[must_use]
    pub fn counts(&self) -> &PointCounts {
        &self.counts
    }

    /// What it is in all.
    pub(super) fn extent(&self) -> TinExtent {
        let mut surface = TinSurface::default();
        let needs = |_, _: &NodeBound| true;
        Descent::new(self, needs, &mut surface).run();
        let heights = self.nodes.iter().map(|it| it.position[1]);
        let range = [f32::INFINITY, f32::NEG_INFINITY];
        TinExtent {
            heights: heights.fold(range, |[low, high], it| [low.min(it), high.max(it)]),
            faces: surface.faces.len() as u64,
        }
    }

    /// How many vertices there are at full detail.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.nodes.len()
    }

    /// Where a vertex is.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        self.nodes[vertex as usize].position
    }

    /// The error that keeps a vertex in the surface, if it is above it. Corners are always drawn.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn error(&self, vertex: u32) -> f32 {
        self.nodes[vertex as usize].error
    }

    /// Which point of the input a vertex is; `None` for a Steiner point.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn source(&self, vertex: u32) -> Option<u32> {
        let source = self.sources[vertex as usize];
        (source != NONE).then_some(source)
    }

    /// The coarsest surface that a view does not need finer. It has no cracks, whatever the view.
    ///
    /// # Complexity
    /// Time and space O(faces).
    pub fn draw(&self, view: &CameraView, surface: &mut TinSurface) {
        draw(self, view, surface);
    }

    /// The surface of limited size that a view needs most: what it sees worst is cut first.
    ///
    /// # Complexity
    /// Time O(n log n), space O(n) for n faces.
    pub fn draw_within(&self, limit: TinLimit, view: &CameraView, surface: &mut TinSurface) {
        draw_within(self, view, limit, surface);
    }
}
