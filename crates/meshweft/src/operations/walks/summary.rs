//! A figure over the frames of a walk, and what nobody can beat.

use serde_json::{Map, Value, json};

use super::frame::{WalkFrame, WalkQuantity};
use crate::lod::geometry_cache::RecordedPath;

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
    pub(in crate::operations) fn of(path: &RecordedPath, slots: usize) -> Self {
        Self {
            distinct_vertices: path.distinct_vertices(),
            fewest_inserts: path.fewest_inserts(slots),
        }
    }

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

impl WalkSummary {
    /// That of a figure over these frames.
    #[must_use]
    pub fn of(frames: &[WalkFrame], quantity: WalkQuantity) -> Self {
        let values = frames.iter().map(|frame| quantity.of(frame));
        let first = values.clone().next().unwrap_or_default();
        let mut later: Vec<f64> = values.skip(1).collect();
        later.sort_by(f64::total_cmp);
        // Not by `sum`, which has a sign where there is nothing.
        let sum = later.iter().fold(0.0, |sum, value| sum + value);
        let at = |place: usize| later.get(place).copied().unwrap_or_default();
        Self {
            first,
            mean: sum / later.len().max(1) as f64,
            median: 0.5 * (at(later.len().saturating_sub(1) / 2) + at(later.len() / 2)),
            worst: later.last().copied().unwrap_or_default(),
            total: first + sum,
        }
    }
}

/// How many frames had all their vertices streamed, or were drawn in passes.
pub(in crate::operations) fn overfull_frames(frames: &[WalkFrame]) -> [usize; 2] {
    let streamed = frames.iter().filter(|frame| frame.is_streamed);
    let in_passes = frames.iter().filter(|frame| frame.passes > 1);
    [streamed.count(), in_passes.count()]
}

/// What is counted of all frames together, as members of a report.
pub(in crate::operations) fn counted(
    frames: &[WalkFrame],
    optimum: Option<WalkOptimum>,
) -> [(&'static str, Value); 5] {
    let [streamed, in_passes] = overfull_frames(frames);
    let inserts = WalkSummary::of(frames, WalkQuantity::Inserts).total;
    [
        ("frame_count", json!(frames.len())),
        ("streamed_frames", json!(streamed)),
        ("frames_in_passes", json!(in_passes)),
        ("summary", summaries(frames)),
        ("optimum", json!(optimum.map(|it| it.json(inserts)))),
    ]
}

/// All figures over the frames, as JSON.
fn summaries(frames: &[WalkFrame]) -> Value {
    let member = |&quantity: &WalkQuantity| {
        let summary = WalkSummary::of(frames, quantity);
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
