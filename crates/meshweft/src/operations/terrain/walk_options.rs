//! The options of a walk over a terrain.

use std::path::PathBuf;

use super::error::TerrainError;
use super::paths::TerrainPath;
use super::source::TerrainFacts;
use crate::lod::CameraView;
use crate::lod::geometry_cache::EvictionPolicy;
use crate::operations::walks::{WalkNumbers, WalkOptionError};

/// How a terrain is walked over.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TerrainWalkOptions {
    /// Where the eye goes.
    pub path: TerrainPath,
    /// The file that the cameras of a given path are from, for the report.
    pub camera_file: Option<PathBuf>,
    /// How many frames: 3000, or all cameras that are given, if not said.
    pub frames: Option<usize>,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// How many pixels the surface may be off.
    pub tolerance: f64,
    /// How many vertices a frame may have; the tolerance is not kept where it needs more. Those of borders and holes are always there.
    pub limit: Option<usize>,
    /// How many slots the vertex buffer has.
    pub slots: usize,
    /// Which slot the next vertex takes.
    pub policy: EvictionPolicy,
    /// Draw a frame of more vertices than slots in passes; it is streamed otherwise.
    pub passes: bool,
    /// How many bytes a vertex has.
    pub vertex_size: usize,
    /// Find the fewest inserts that any policy needs.
    pub optimum: bool,
}

impl Default for TerrainWalkOptions {
    /// As in the paper: a picture of 1024 by 768, 1 pixel, 65,536 slots, 32 bytes a vertex; the finest detail leaves first.
    fn default() -> Self {
        Self {
            path: TerrainPath::default(),
            camera_file: None,
            frames: None,
            size: [1024, 768],
            tolerance: 1.0,
            limit: None,
            slots: 65_536,
            policy: EvictionPolicy::default(),
            passes: false,
            vertex_size: 32,
            optimum: false,
        }
    }
}

impl TerrainWalkOptions {
    /// What the camera of a frame of `count` sees.
    pub(super) fn view(
        &self,
        terrain: &TerrainFacts,
        frame: usize,
        count: usize,
    ) -> Result<CameraView, TerrainError> {
        let camera = self.path.camera(terrain, frame, count, self.size);
        let view = camera.view(self.tolerance);
        view.map_err(|error| TerrainError::View { frame, error })
    }

    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), WalkOptionError> {
        let numbers = WalkNumbers {
            frames: self.frames,
            cameras: self.path.given_count(),
            size: self.size,
            tolerance: self.tolerance,
            slots: self.slots,
            policy: self.policy,
            passes: self.passes,
            vertex_size: self.vertex_size,
        };
        numbers.check()?;
        match self.limit {
            Some(limit) if limit < 3 => Err(WalkOptionError {
                option: "limit",
                found: limit.to_string(),
                allowed: "3 vertices, which a face needs, or more".to_owned(),
            }),
            _ => Ok(()),
        }
    }
}
