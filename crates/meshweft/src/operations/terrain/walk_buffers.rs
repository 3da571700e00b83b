//! The buffers of a renderer of terrain.

use super::numbered_surface::NumberedSurface;
use super::walk_options::TerrainWalkOptions;
use crate::lod::geometry_cache::{FrameMode, GeometryCache, GeometryCacheError, IndexSlots};
use crate::operations::walks::{WalkFrame, draw_passes};

/// A vertex buffer of slots and the index buffer of its faces, which follow the surfaces of a walk.
pub(super) struct TerrainBuffers {
    pub(super) cache: GeometryCache,
    pub(super) indices: IndexSlots,
    vertex_size: usize,
}

impl TerrainBuffers {
    pub(super) fn new(options: &TerrainWalkOptions) -> Result<Self, GeometryCacheError> {
        let cache = GeometryCache::new(options.slots, Vec::new(), options.policy)?;
        Ok(Self {
            cache: match options.passes {
                true => cache.with_passes(),
                false => cache,
            },
            indices: IndexSlots::new(0),
            vertex_size: options.vertex_size,
        })
    }

    /// The next surface. What it took to find that is not known here.
    pub(super) fn frame(
        &mut self,
        surface: &NumberedSurface,
        clock: &dyn Fn() -> f64,
    ) -> Result<WalkFrame, GeometryCacheError> {
        // Slots for vertices.
        let start = clock();
        self.cache.grow(&surface.new_errors)?;
        let upload = self.cache.set_active(&surface.active)?;
        let (mode, statistics) = (upload.mode(), upload.statistics());
        let cached = clock();

        // Indices of faces.
        self.indices.grow(surface.new_faces);
        let patch = self.indices.set_living(&self.cache, &surface.living);
        let patch = patch.expect("all corners are active").statistics();
        let indexed = clock();

        let mut frame = WalkFrame {
            vertices: statistics.active,
            faces: surface.living.len(),
            added: statistics.added,
            removed: statistics.removed,
            cache_milliseconds: 1e3 * (cached - start),
            index_milliseconds: 1e3 * (indexed - cached),
            ..WalkFrame::default()
        }
        .with_sent(mode, statistics, patch, self.vertex_size);
        if mode == FrameMode::Passes {
            draw_passes(
                &mut self.cache,
                self.indices.corners(),
                self.vertex_size,
                clock,
                &mut frame,
            )?;
        }
        Ok(frame)
    }
}
