//! What the numbers of a walk may be.

use std::fmt;

use super::camera_file::MOST_FRAMES;
use crate::lod::geometry_cache::{EvictionPolicy, GeometryCacheError};

/// An option that is out of its range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WalkOptionError {
    /// Its name, with a dash between words.
    pub option: &'static str,
    /// What it is.
    pub found: String,
    /// What it may be.
    pub allowed: String,
}

impl fmt::Display for WalkOptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: give {}", self.option, self.found, self.allowed)
    }
}

impl std::error::Error for WalkOptionError {}

/// The numbers of a walk with any level of detail.
#[derive(Debug, Clone, Copy)]
pub(in crate::operations) struct WalkNumbers {
    pub(in crate::operations) frames: Option<usize>,
    /// How many cameras the path is given by, if it is.
    pub(in crate::operations) cameras: Option<usize>,
    pub(in crate::operations) size: [u32; 2],
    pub(in crate::operations) tolerance: f64,
    pub(in crate::operations) slots: usize,
    pub(in crate::operations) policy: EvictionPolicy,
    pub(in crate::operations) passes: bool,
    pub(in crate::operations) vertex_size: usize,
}

/// Largest side of a picture, and largest size of a vertex.
const MOST: usize = 65_535;

impl WalkNumbers {
    /// Whether every number is in its range.
    pub(in crate::operations) fn check(&self) -> Result<(), WalkOptionError> {
        let is_count = |number: usize, least: usize, most: usize| (least..=most).contains(&number);
        let error = |option, found: String, allowed: String| {
            Err(WalkOptionError {
                option,
                found,
                allowed,
            })
        };
        if let Some(frames) = self
            .frames
            .filter(|&frames| !is_count(frames, 1, MOST_FRAMES))
        {
            return error("frames", frames.to_string(), format!("1 to {MOST_FRAMES}"));
        }
        if let Some(cameras) = self.cameras.filter(|&it| !is_count(it, 1, MOST_FRAMES)) {
            let found = format!("of {cameras} cameras");
            return error("path", found, format!("1 to {MOST_FRAMES}"));
        }
        let [width, height] = self.size;
        if !self
            .size
            .iter()
            .all(|&side| is_count(side as usize, 1, MOST))
        {
            let allowed = format!("1 to {MOST} pixels for width and height, such as 800x600");
            return error("size", format!("{width}x{height}"), allowed);
        }
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            let allowed = "a number of pixels above 0".to_owned();
            return error("tolerance", self.tolerance.to_string(), allowed);
        }
        let most = GeometryCacheError::MOST_SLOTS;
        if !is_count(self.slots, 3, most) {
            let allowed = format!("3, which a face needs, to {most}");
            return error("slots", self.slots.to_string(), allowed);
        }
        if self.passes && self.policy == EvictionPolicy::Nothing {
            let allowed = "a policy that keeps vertices in slots: without one all are streamed";
            let found = "with the policy none".to_owned();
            return error("passes", found, allowed.to_owned());
        }
        if !is_count(self.vertex_size, 1, MOST) {
            let allowed = format!("1 to {MOST} bytes");
            return error("vertex-size", self.vertex_size.to_string(), allowed);
        }
        Ok(())
    }
}
