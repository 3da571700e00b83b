//! What of a terrain is measured.

use std::path::PathBuf;

use super::paths::TerrainPath;
use super::source::TerrainFacts;
use super::walk_options::TerrainWalkOptions;
use crate::lod::Camera;
use crate::operations::walks::WalkOptionError;

/// How a terrain is measured: in pixels on a path, or in metres.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TerrainVerifyOptions {
    /// Measure the surface of this error, in metres; no path then.
    pub error: Option<f64>,
    /// Where the eye goes.
    pub path: TerrainPath,
    /// The file that the cameras of a given path are from, for the report.
    pub camera_file: Option<PathBuf>,
    /// How many frames, evenly on the path: 40, or all cameras that are given if they are fewer, if not said.
    pub frames: Option<usize>,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// How many pixels the surface may be off.
    pub tolerance: f64,
}

impl Default for TerrainVerifyOptions {
    /// Forty frames of the circle, in a picture of 1024 by 768, at 1 pixel.
    fn default() -> Self {
        let walk = TerrainWalkOptions::default();
        Self {
            error: None,
            path: walk.path,
            camera_file: None,
            frames: None,
            size: walk.size,
            tolerance: walk.tolerance,
        }
    }
}

/// Frames that are measured if nothing else is said.
const USUAL_FRAMES: usize = 40;

impl TerrainVerifyOptions {
    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), WalkOptionError> {
        let walk = TerrainWalkOptions {
            path: self.path.clone(),
            frames: self.frames,
            size: self.size,
            tolerance: self.tolerance,
            ..TerrainWalkOptions::default()
        };
        walk.check()?;
        match self.error {
            Some(length) if !(length >= 0.0 && length.is_finite()) => Err(WalkOptionError {
                option: "error",
                found: length.to_string(),
                allowed: "a number of metres, 0 for all heights".to_owned(),
            }),
            _ => Ok(()),
        }
    }

    /// The cameras of the frames that are measured, each with its number on the path.
    pub(super) fn cameras(&self, terrain: &TerrainFacts) -> Vec<(usize, Camera)> {
        let frames = self.frames.unwrap_or(USUAL_FRAMES);
        let all = self.path.given_count().unwrap_or(frames);
        let frames = frames.min(all);
        let numbers = (0..frames).map(|frame| frame * all / frames);
        let camera = |number| (number, self.path.camera(terrain, number, all, self.size));
        numbers.map(camera).collect()
    }
}
