//! What was measured of a terrain, and whether that is what is promised.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::build::notes;
use super::source::TerrainFacts;
use super::verify_options::TerrainVerifyOptions;
use crate::files::Note;
use crate::operations::json;
use crate::operations::walks::PixelErrors;

/// What [`terrain_verify`](super::terrain_verify) measured.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TerrainVerifyReport {
    /// The terrain.
    pub file: PathBuf,
    /// The files of the heights that it was compared with; none if these are its own.
    pub compared: Vec<PathBuf>,
    /// Whether the heights that it was compared with are its own: over points, those of its vertices that are points.
    pub is_own: bool,
    /// How many heights it was compared with: over points, the first finite one of each place.
    pub heights: usize,
    /// What was asked for.
    pub options: TerrainVerifyOptions,
    /// What was looked at.
    pub terrain: TerrainFacts,
    /// Each surface: one a frame, or the only one.
    pub surfaces: Vec<VerifiedSurface>,
    /// The errors of all heights that are seen, in all frames, in tolerances; without a path, of all heights, in parts of the error that was
    /// asked for.
    pub errors: PixelErrors,
    /// Whether the caller stopped it before the last frame.
    pub is_stopped: bool,
    /// What the readers say, each with its file.
    pub notes: Vec<(PathBuf, Note)>,
}

/// A surface that was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct VerifiedSurface {
    /// Which frame it is on the path; 0 without one.
    pub number: usize,
    /// Vertices that are drawn.
    pub vertices: usize,
    /// Faces that are drawn.
    pub faces: usize,
    /// The errors of the heights that are seen.
    pub errors: PixelErrors,
    /// How far any height is from the surface, vertically, in metres, seen or not.
    pub worst_metres: f64,
    /// How far that may be, by what the surface says of itself.
    pub stated_metres: f64,
    /// Places of full detail that no face covers.
    pub uncovered: usize,
    /// Places without a height that a face covers.
    pub covered_voids: usize,
    /// Heights inside of a face that are in another one as well, or at its side.
    pub overlaps: usize,
    /// Faces that are clockwise seen from above, or have no area.
    pub turned: usize,
    /// Sides of faces with more than two of them, or with one where full detail goes on.
    pub cracks: usize,
    /// Whether the faces have the area of those of full detail.
    pub has_full_area: bool,
}

impl VerifiedSurface {
    fn json(&self) -> Value {
        json!({
            "frame": self.number,
            "vertices": self.vertices,
            "faces": self.faces,
            "errors": self.errors.json(),
            "worst_metres": self.worst_metres,
            "stated_metres": self.stated_metres,
            "uncovered": self.uncovered,
            "covered_voids": self.covered_voids,
            "overlaps": self.overlaps,
            "turned": self.turned,
            "cracks": self.cracks,
            "full_area": self.has_full_area,
        })
    }
}

impl TerrainVerifyReport {
    /// How far any height is from any of the surfaces, in metres.
    #[must_use]
    pub fn worst_metres(&self) -> f64 {
        let each = self.surfaces.iter().map(|it| it.worst_metres);
        each.fold(0.0, f64::max)
    }

    /// What is promised and does not hold, in words.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        let beyond = self.errors.seen - self.errors.within;
        if beyond > 0 {
            failures.push(format!(
                "heights farther off than the tolerance: {beyond}, by {:.4} times it at most",
                self.errors.worst
            ));
        }
        let sum = |count: fn(&VerifiedSurface) -> usize| self.surfaces.iter().map(count).sum();
        let counts: [(usize, &str); 7] = [
            (sum(|it| it.uncovered), "places that no face covers"),
            (sum(|it| it.covered_voids), "voids that a face covers"),
            (sum(|it| it.overlaps), "heights that two faces cover"),
            (sum(|it| it.turned), "faces that are turned over"),
            (sum(|it| it.cracks), "sides of faces with a crack"),
            (
                sum(|it| usize::from(!it.has_full_area)),
                "surfaces of another area than full detail",
            ),
            (
                sum(|it| usize::from(it.worst_metres > it.stated_metres)),
                "surfaces that are farther off than they say",
            ),
        ];
        let wrong = counts.into_iter().filter(|&(count, _)| count > 0);
        failures.extend(wrong.map(|(count, what)| format!("{what}: {count}")));
        failures
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let options = &self.options;
        let compared = self.compared.iter().map(|it| it.display().to_string());
        let is_path = options.error.is_none();
        let mut report = json::head("terrain verify");
        let members = [
            ("file", json!(self.file.display().to_string())),
            ("compared", compared.collect()),
            ("own", json!(self.is_own)),
            ("heights", json!(self.heights)),
            ("error", json!(options.error)),
            ("path", json!(is_path.then(|| options.path.name()))),
            ("camera_file", json::name(options.camera_file.as_deref())),
            ("size", json!(options.size)),
            ("tolerance", json!(options.tolerance)),
            ("terrain", self.terrain.json()),
            ("stopped", json!(self.is_stopped)),
            ("frame_count", json!(self.surfaces.len())),
            ("errors", self.errors.json()),
            ("worst_metres", json!(self.worst_metres())),
            ("failures", json!(self.failures())),
            ("frames", Value::Null),
            ("notes", notes(&self.notes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        let surfaces = self.surfaces.iter().map(VerifiedSurface::json);
        json::with_list(&report, "frames", surfaces)
    }
}
