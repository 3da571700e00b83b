//! What a walk over a terrain cost.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::build::notes;
use super::source::TerrainFacts;
use super::walk_options::TerrainWalkOptions;
use crate::files::Note;
use crate::operations::json;
use crate::operations::walks::{
    WalkFrame, WalkOptimum, WalkQuantity, WalkSummary, counted, overfull_frames,
};

/// What [`terrain_walk`](super::terrain_walk) counted.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TerrainWalkReport {
    /// The file.
    pub file: PathBuf,
    /// What was asked for.
    pub options: TerrainWalkOptions,
    /// What was walked over.
    pub terrain: TerrainFacts,
    /// The size of a `.mwt` file; `None` if the levels of detail were made here.
    pub file_bytes: Option<u64>,
    /// Each frame.
    pub frames: Vec<WalkFrame>,
    /// What nobody can beat, if asked for.
    pub optimum: Option<WalkOptimum>,
    /// Vertices and faces that are drawn at some time: what memory is in proportion to.
    pub distinct: [usize; 2],
    /// Whether the caller stopped it before the last frame.
    pub is_stopped: bool,
    /// What the readers say, each with its file.
    pub notes: Vec<(PathBuf, Note)>,
}

impl TerrainWalkReport {
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
        let mut report = json::head("terrain walk");
        let members = [
            ("file", json!(self.file.display().to_string())),
            ("file_bytes", json!(self.file_bytes)),
            ("path", json!(options.path.name())),
            ("camera_file", json::name(options.camera_file.as_deref())),
            ("size", json!(options.size)),
            ("tolerance", json!(options.tolerance)),
            ("limit", json!(options.limit)),
            ("slots", json!(options.slots)),
            ("policy", json!(options.policy.to_string())),
            ("passes", json!(options.passes)),
            ("vertex_size", json!(options.vertex_size)),
            ("terrain", self.terrain.json()),
            ("distinct_vertices", json!(self.distinct[0])),
            ("distinct_faces", json!(self.distinct[1])),
            ("stopped", json!(self.is_stopped)),
        ];
        let more = [("frames", Value::Null), ("notes", notes(&self.notes))];
        let counted = counted(&self.frames, self.optimum);
        let members = members.into_iter().chain(counted).chain(more);
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        json::with_list(&report, "frames", self.frames.iter().map(WalkFrame::json))
    }
}
