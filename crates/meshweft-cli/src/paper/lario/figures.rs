//! Figures 7 and 8, and those like them of terrain, 10 and 11, as numbers.

use meshweft::operations::{WalkFrame, WalkQuantity, WalkSummary};
use serde_json::{Value, json};

use super::tables::{all, named};
use super::walked::{NAMES, Walked};
use crate::paper::figure::{Figure, head};

/// The parts of a frame's time, as the paper divides it; the rendering is not measured.
const STAGES: [(&str, WalkQuantity); 3] = [
    ("level of detail", WalkQuantity::UpdateMilliseconds),
    ("slots", WalkQuantity::CacheMilliseconds),
    ("indices", WalkQuantity::IndexMilliseconds),
];

/// Parts of a path, of as many frames each.
const PARTS: usize = 5;

/// Times of a frame. `kind` is what it is that is walked around or over.
pub(super) fn times(kind: &str, walked: &[&Walked]) -> Figure {
    let mut rows = vec![head(&["", "px", "path", "policy"])];
    for (name, _) in STAGES {
        rows[0].extend([format!("{name}: first"), "median".into(), "worst".into()]);
    }
    let mut json = Vec::new();
    for (it, walk) in all(walked) {
        for (name, frames) in NAMES.into_iter().zip(&walk.frames) {
            let summaries = STAGES.map(|(_, quantity)| WalkSummary::of(frames, quantity));
            let mut row = vec![
                it.name.clone(),
                walk.tolerance.to_string(),
                format!("{}*", walk.letter),
                name.to_owned(),
            ];
            for summary in summaries {
                let times = [summary.first, summary.median, summary.worst];
                row.extend(times.map(|milliseconds| format!("{milliseconds:.3}")));
            }
            rows.push(row);
            let stages = STAGES.iter().zip(&summaries).map(|((stage, _), it)| {
                let times = json!({"first": it.first, "median": it.median, "worst": it.worst});
                ((*stage).to_owned(), times)
            });
            json.push(json!({
                kind: it.name, "tolerance": walk.tolerance, "path": walk.letter, "policy": name,
                "milliseconds": Value::Object(stages.collect()),
            }));
        }
    }
    Figure {
        title: "Milliseconds of a frame on this machine, one thread: the first frame, and median and worst of the others. The \
                level of\ndetail is the same for all policies: each path is walked once. Drawn over the frames with --pictures."
            .to_owned(),
        rows,
        json: json!(json),
    }
}

/// Vertices that are inserted, along the path.
pub(super) fn along_the_path(kind: &str, walked: &[&Walked]) -> Figure {
    let mut rows = vec![head(&["", "px", "path", "policy", "first frame"])];
    rows[0].extend((1..=PARTS).map(|part| format!("{part}/{PARTS}")));
    let mut json = Vec::new();
    for (it, walk) in all(walked) {
        let parts: Vec<[u64; 1 + PARTS]> = walk
            .frames
            .iter()
            .map(|frames| inserts_by_part(frames))
            .collect();
        for (name, parts) in NAMES.into_iter().zip(&parts) {
            let mut row = vec![
                it.name.clone(),
                walk.tolerance.to_string(),
                format!("{}*", walk.letter),
                name.to_owned(),
            ];
            row.extend(parts.iter().map(u64::to_string));
            rows.push(row);
        }
        let of_part = (0..=PARTS).map(|part| {
            let values: Vec<u64> = parts.iter().map(|parts| parts[part]).collect();
            named(&values)
        });
        json.push(json!({
            kind: it.name, "tolerance": walk.tolerance, "path": walk.letter,
            "first_frame_and_parts": of_part.collect::<Vec<_>>(),
        }));
    }
    Figure {
        title: format!(
            "Vertices inserted: in the first frame, which begins with nothing, and in each of {PARTS} parts of the others. Drawn \
             over the\nframes with --pictures."
        ),
        rows,
        json: json!({"parts": PARTS, "rows": json}),
    }
}

/// In the first frame, and in each part of the others.
fn inserts_by_part(frames: &[WalkFrame]) -> [u64; 1 + PARTS] {
    let mut sums = [0; 1 + PARTS];
    let later = frames.len().saturating_sub(1).max(1);
    for (number, WalkFrame { inserts, .. }) in frames.iter().enumerate() {
        let part = match number.checked_sub(1) {
            None => 0,
            Some(number) => 1 + number * PARTS / later,
        };
        sums[part] += *inserts as u64;
    }
    sums
}
