//! What a walk cost.

use std::path::PathBuf;

use serde_json::{Map, Value, json};

use super::frame::{WalkFrame, WalkQuantity};
use super::options::LodWalkOptions;
use crate::files::Note;
use crate::lod::geometry_cache::RecordedPath;
use crate::operations::json;

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

/// Bounds on the inserts of a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct WalkOptimum {
    /// How many vertices are active in any frame.
    pub distinct_vertices: usize,
    /// The fewest inserts with this number of slots, by whoever knows the whole path; `None` if a frame has more vertices.
    pub fewest_inserts: Option<u64>,
}

impl WalkOptimum {
    /// Those of a path with a number of slots.
    pub(super) fn of(path: &RecordedPath, slots: usize) -> Self {
        Self {
            distinct_vertices: path.distinct_vertices(),
            fewest_inserts: path.fewest_inserts(slots),
        }
    }
}

/// A figure over the frames of a walk. The first frame, which begins with nothing, is apart.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WalkSummary {
    /// In the first frame.
    pub first: f64,
    /// The mean over the others; 0 if there are none, as for the next two.
    pub mean: f64,
    /// Their median.
    pub median: f64,
    /// The largest of them.
    pub worst: f64,
    /// The sum over all frames.
    pub total: f64,
}

impl LodWalkReport {
    /// A figure over all frames.
    #[must_use]
    pub fn summary(&self, quantity: WalkQuantity) -> WalkSummary {
        let values = self.frames.iter().map(|frame| quantity.of(frame));
        let first = values.clone().next().unwrap_or_default();
        let mut later: Vec<f64> = values.skip(1).collect();
        later.sort_by(f64::total_cmp);
        // Not by `sum`, which has a sign where there is nothing.
        let sum = later.iter().fold(0.0, |sum, value| sum + value);
        let at = |place: usize| later.get(place).copied().unwrap_or_default();
        WalkSummary {
            first,
            mean: sum / later.len().max(1) as f64,
            median: 0.5 * (at(later.len().saturating_sub(1) / 2) + at(later.len() / 2)),
            worst: later.last().copied().unwrap_or_default(),
            total: first + sum,
        }
    }

    /// How many frames had all their vertices streamed, or were drawn in passes.
    #[must_use]
    pub fn overfull_frames(&self) -> [usize; 2] {
        let streamed = self.frames.iter().filter(|frame| frame.is_streamed);
        let in_passes = self.frames.iter().filter(|frame| frame.passes > 1);
        [streamed.count(), in_passes.count()]
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let options = &self.options;
        let [streamed, in_passes] = self.overfull_frames();
        let inserts = self.summary(WalkQuantity::Inserts).total;
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
            ("frame_count", json!(self.frames.len())),
            ("streamed_frames", json!(streamed)),
            ("frames_in_passes", json!(in_passes)),
            ("summary", self.summaries()),
            ("optimum", json!(self.optimum.map(|it| it.json(inserts)))),
            ("frames", Value::Null),
            ("notes", json::notes(&self.notes)),
        ];
        report.extend(members.map(|(name, value)| (name.to_owned(), value)));
        json::with_list(&report, "frames", self.frames.iter().map(WalkFrame::json))
    }

    fn summaries(&self) -> Value {
        let member = |&quantity: &WalkQuantity| {
            let summary = self.summary(quantity);
            let value = json!({
                "first": quantity.json(summary.first),
                "mean": summary.mean,
                "median": summary.median,
                "worst": quantity.json(summary.worst),
                "total": quantity.json(summary.total),
            });
            (quantity.name().to_owned(), value)
        };
        let members: Map<String, Value> = WalkQuantity::ALL.iter().map(member).collect();
        Value::Object(members)
    }
}

impl WalkedMesh {
    pub(super) fn json(self) -> Value {
        json!({"vertices": self.vertices, "faces": self.faces, "roots": self.roots})
    }
}

impl WalkOptimum {
    /// How many times as many inserts a walk has as there are different vertices, and as the fewest possible, if these are known.
    #[must_use]
    pub fn times(self, inserts: f64) -> (f64, Option<f64>) {
        let times = |least: f64| inserts / least.max(1.0);
        let fewest = self.fewest_inserts.map(|it| times(it as f64));
        (times(self.distinct_vertices as f64), fewest)
    }

    fn json(self, inserts: f64) -> Value {
        let (times_distinct, times_fewest) = self.times(inserts);
        json!({
            "distinct_vertices": self.distinct_vertices,
            "fewest_inserts": self.fewest_inserts,
            "times_distinct": times_distinct,
            "times_fewest": times_fewest,
        })
    }
}
