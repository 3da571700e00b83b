//! Figures 7 and 8 as numbers.

use meshweft::operations::{LodWalkReport, WalkFrame, WalkQuantity};
use serde_json::{Value, json};

use super::tables::named;
use super::walked::{NAMES, PathWalk, Walked};
use crate::paper::figure::{Figure, head};

/// The parts of a frame's time, as the paper divides it; the rendering is not measured.
const STAGES: [(&str, WalkQuantity); 3] = [
    ("level of detail", WalkQuantity::UpdateMilliseconds),
    ("slots", WalkQuantity::CacheMilliseconds),
    ("indices", WalkQuantity::IndexMilliseconds),
];

/// Parts of a path, of as many frames each.
const PARTS: usize = 5;

/// Times of a frame.
pub(super) fn fig_7(walked: &[Walked]) -> Figure {
    let mut rows = vec![head(&["", "px", "path", "policy"])];
    for (name, _) in STAGES {
        rows[0].extend([format!("{name}: first"), "median".into(), "worst".into()]);
    }
    let mut json = Vec::new();
    for (it, walk) in all(walked) {
        for (name, report) in NAMES.into_iter().zip(&walk.reports) {
            let summaries = STAGES.map(|(_, quantity)| report.summary(quantity));
            let mut row = vec![
                it.name.clone(),
                walk.tolerance.to_string(),
                format!("{}*", walk.letter()),
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
                "mesh": it.name, "tolerance": walk.tolerance, "path": walk.letter(), "policy": name,
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
pub(super) fn fig_8(walked: &[Walked]) -> Figure {
    let mut rows = vec![head(&["", "px", "path", "policy", "first frame"])];
    rows[0].extend((1..=PARTS).map(|part| format!("{part}/{PARTS}")));
    let mut json = Vec::new();
    for (it, walk) in all(walked) {
        let parts: Vec<[u64; 1 + PARTS]> = walk.reports.iter().map(inserts_by_part).collect();
        for (name, parts) in NAMES.into_iter().zip(&parts) {
            let mut row = vec![
                it.name.clone(),
                walk.tolerance.to_string(),
                format!("{}*", walk.letter()),
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
            "mesh": it.name, "tolerance": walk.tolerance, "path": walk.letter(),
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
fn inserts_by_part(report: &LodWalkReport) -> [u64; 1 + PARTS] {
    let mut sums = [0; 1 + PARTS];
    let later = report.frames.len().saturating_sub(1).max(1);
    for (number, WalkFrame { inserts, .. }) in report.frames.iter().enumerate() {
        let part = match number.checked_sub(1) {
            None => 0,
            Some(number) => 1 + number * PARTS / later,
        };
        sums[part] += *inserts as u64;
    }
    sums
}

/// Every walk with its mesh.
fn all(walked: &[Walked]) -> impl Iterator<Item = (&Walked, &PathWalk)> {
    walked
        .iter()
        .flat_map(|it| it.walks.iter().map(move |walk| (it, walk)))
}
