//! How long a frame takes, how long a hierarchy is made, and its memory.

use std::time::Instant;

use compare::counting::with_peak;
use meshweft::operations::{LodWalkOptions, LodWalkReport, WalkFrame, WalkQuantity, WalkRecorder};

use crate::scene::Scene;
use crate::{FRAMES, PATHS};

const TOLERANCES: [f64; 2] = [1.5, 0.12];

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "| mesh | vertices | build, s | bytes a vertex | in a front | depth | depth / log2 V |"
    );
    println!("|---|{}", "--:|".repeat(6));
    let mut recorders = Vec::new();
    for scene in scenes {
        // The second build of the file; the shorter one counts.
        let start = Instant::now();
        let clock = || start.elapsed().as_secs_f64();
        let recorder = WalkRecorder::new(&scene.document, &clock);
        let recorder = recorder.map_err(|it| it.to_string())?;
        let seconds = clock().min(scene.build_seconds);
        recorders.push(recorder);

        let (copy, bytes) = with_peak(|| scene.hierarchy.clone());
        drop(copy);
        let (front, in_front) = with_peak(|| scene.front());
        drop(front);
        let vertices = scene.hierarchy.vertex_count() as f64;
        let depth = scene.hierarchy.depth();
        println!(
            "| {} | {vertices} | {seconds:.2} | {:.1} | {:.1} | {depth} | {:.2} |",
            scene.name,
            bytes as f64 / vertices,
            in_front as f64 / vertices,
            depth as f64 / vertices.log2()
        );
    }

    println!(
        "\nMilliseconds of {FRAMES} frames but the first, one thread: front and indices together. Nanoseconds: the median for \
         each active vertex; of slots the mean of 99 % of the frames for each vertex that came or left. Faces patched for each vertex that came or \
         left.\n"
    );
    println!(
        "| mesh | path | tolerance | mean active | median, ms | worst, ms | ns an active vertex | slots, ns a changed vertex | \
         faces a changed vertex |"
    );
    println!("|---|---|{}", "--:|".repeat(7));
    for (scene, recorder) in scenes.iter().zip(&recorders) {
        for tolerance in TOLERANCES {
            for (letter, path) in &PATHS {
                let mut options = LodWalkOptions::default();
                options.path = path.clone();
                options.frames = Some(FRAMES);
                options.tolerance = tolerance;
                let start = Instant::now();
                let clock = || start.elapsed().as_secs_f64();
                let walk = recorder.record(&options, &clock, &());
                let report = walk.and_then(|walk| walk.replay(options.policy, &clock));
                let report = report.map_err(|it| it.to_string())?;
                println!(
                    "| {} | {letter} | {tolerance} |{}",
                    scene.name,
                    row(&report)
                );
            }
        }
    }
    Ok(())
}

/// The figures of a walk.
fn row(report: &LodWalkReport) -> String {
    let sorted = |time: fn(&WalkFrame) -> f64| {
        let mut times: Vec<f64> = report.frames[1..].iter().map(time).collect();
        times.sort_by(f64::total_cmp);
        times
    };
    let times = sorted(|frame| frame.update_milliseconds + frame.index_milliseconds);
    let of_slots = sorted(|frame| frame.cache_milliseconds);
    // Without the slowest hundredth, in which the machine did something else.
    let usual = &of_slots[..of_slots.len() - of_slots.len() / 100];
    let mean = |quantity| report.summary(quantity).mean;
    let changed = mean(WalkQuantity::Added) + mean(WalkQuantity::Removed);
    let (median, active) = (times[times.len() / 2], mean(WalkQuantity::Vertices));
    format!(
        " {active:.0} | {median:.3} | {:.3} | {:.0} | {:.0} | {:.2} |",
        times[times.len() - 1],
        1e6 * median / active,
        1e6 * usual.iter().sum::<f64>() / usual.len() as f64 / changed,
        mean(WalkQuantity::PatchedFaces) / changed
    )
}
