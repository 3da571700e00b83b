//! What a walk cost.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::options::LodWalkOptions;
use crate::files::Note;
use crate::operations::json;
use crate::operations::walks::{
    WalkFrame, WalkOptimum, WalkQuantity, WalkSummary, counted, overfull_frames,
};

/// What [`lod_walk`](super::lod_walk) counted.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LodWalkReport {
    /// The file.
    pub file: PathBuf,
    /// What was asked for.
    pub options: LodWalkOptions,
    /// What was walked around.
    pub mesh: WalkedMesh,
    /// The size of a `.mwl` file; `None` if the levels of detail were made here.
    pub file_bytes: Option<u64>,
    /// Each frame.
    pub frames: Vec<WalkFrame>,
    /// What nobody can beat, if asked for.
    pub optimum: Option<WalkOptimum>,
    /// How long it took to make the hierarchy, or to begin with one.
    pub build_seconds: f64,
    /// Whether the caller stopped it before the last frame.
    pub is_stopped: bool,
    /// What the reader of the file leaves as it is, and why.
    pub notes: Vec<Note>,
}

/// A mesh with all its levels of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct WalkedMesh {
    /// Vertices at full detail: those of equal positions count once.
    pub vertices: usize,
    /// Faces at full detail.
    pub faces: usize,
    /// Vertices that are always active.
    pub roots: usize,
}

impl LodWalkReport {
    /// A figure over all frames.
    #[must_use]
    pub fn summary(&self, quantity: WalkQuantity) -> WalkSummary {
        WalkSummary::of(&self.frames, quantity)
    }

    /// How many frames had all their vertices streamed, or were drawn in passes.
    #[must_use]
    pub fn overfull_frames(&self) -> [usize; 2] {
        overfull_frames(&self.frames)
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let options = &self.options;
        let mut report = json::head("lod walk");
        let members = [
            ("file", json!(self.file.display().to_string())),
            ("file_bytes", json!(self.file_bytes)),
            ("path", json!(options.path.name())),
            ("camera_file", json::name(options.camera_file.as_deref())),
            ("size", json!(options.size)),
            ("tolerance", json!(options.tolerance)),
            ("hysteresis", json!(options.hysteresis)),
            ("slots", json!(options.slots)),
            ("policy", json!(options.policy.to_string())),
            ("passes", json!(options.passes)),
            ("vertex_size", json!(options.vertex_size)),
            ("mesh", self.mesh.json()),
            ("build_seconds", json!(self.build_seconds)),
            ("stopped", json!(self.is_stopped)),
        ];
        let more = [("frames", Value::Null), ("notes", json::notes(&self.notes))];
        let counted = counted(&self.frames, self.optimum);
        let members = members.into_iter().chain(counted).chain(more);
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        json::with_list(&report, "frames", self.frames.iter().map(WalkFrame::json))
    }
}

impl WalkedMesh {
    pub(super) fn json(self) -> Value {
        json!({"vertices": self.vertices, "faces": self.faces, "roots": self.roots})
    }
}
