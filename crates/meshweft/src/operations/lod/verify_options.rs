//! Which frames are measured, and what has to hold.

use std::path::PathBuf;

use super::options::LodWalkOptions;
use super::paths::CameraPath;
use crate::geometry::Ball;
use crate::lod::Camera;
use crate::operations::walks::WalkOptionError;

/// How what is drawn is measured.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LodVerifyOptions {
    /// Where the eye goes.
    pub path: CameraPath,
    /// The file that the cameras of a given path are from, for the report.
    pub camera_file: Option<PathBuf>,
    /// How many frames, evenly on the path: 9, or all cameras that are given if they are fewer, if not said.
    pub frames: Option<usize>,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// How many pixels the surface may be off.
    pub tolerance: f64,
    /// A vertex stays until its error is this part of the tolerance: above 0, and 1 for never longer than needed.
    pub hysteresis: f64,
    /// How many of 100 vertices have to be within the tolerance, over all frames.
    pub min_share: Option<f64>,
    /// How many tolerances the worst vertex may be off.
    pub max_error: Option<f64>,
}

impl Default for LodVerifyOptions {
    /// Nine frames once around the mesh, in a picture of 800 by 800, at 1.5 pixels. Nothing has to hold.
    fn default() -> Self {
        let LodWalkOptions {
            path,
            size,
            tolerance,
            hysteresis,
            ..
        } = LodWalkOptions::default();
        Self {
            path,
            camera_file: None,
            frames: None,
            size,
            tolerance,
            hysteresis,
            min_share: None,
            max_error: None,
        }
    }
}

/// Frames that are measured if nothing else is said. Not a multiple of four: the eye turns to and fro four times on the path of small turns.
const USUAL_FRAMES: usize = 9;

impl LodVerifyOptions {
    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn check(&self) -> Result<(), WalkOptionError> {
        let walk = LodWalkOptions {
            path: self.path.clone(),
            frames: self.frames,
            size: self.size,
            tolerance: self.tolerance,
            hysteresis: self.hysteresis,
            ..LodWalkOptions::default()
        };
        walk.check()?;
        let error = |option, found: f64, allowed: &str| {
            Err(WalkOptionError {
                option,
                found: found.to_string(),
                allowed: allowed.to_owned(),
            })
        };
        if let Some(share) = self.min_share
            && !(0.0..=100.0).contains(&share)
        {
            return error(
                "min-share",
                share,
                "a part of the vertices in percent, 0 to 100",
            );
        }
        if let Some(times) = self.max_error
            && !(times > 0.0 && times.is_finite())
        {
            return error("max-error", times, "a number of tolerances above 0");
        }
        Ok(())
    }

    /// The cameras of the frames that are measured, around a ball, each with its number on the path.
    pub(super) fn cameras(&self, ball: Ball) -> Vec<(usize, Camera)> {
        let frames = self.frames.unwrap_or(USUAL_FRAMES);
        let (frames, all) = match &self.path {
            CameraPath::Given(cameras) => (frames.min(cameras.len()), cameras.len()),
            _ => (frames, frames),
        };
        let number = |frame: usize| frame * all / frames;
        let camera = |number: usize| self.path.camera(ball, number, all, self.size);
        let numbers = (0..frames).map(number);
        numbers.map(|number| (number, camera(number))).collect()
    }
}
