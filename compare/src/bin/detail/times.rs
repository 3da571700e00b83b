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
        "\nMilliseconds of {FRAMES} frames but the first, one thread: front and indices together. Nanoseconds: front and indices \
         for each active vertex, slots for each vertex that came or left, means. Faces patched for each vertex that came or \
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
    let later = &report.frames[1..];
    let frame = |frame: &WalkFrame| frame.update_milliseconds + frame.index_milliseconds;
    let mut times: Vec<f64> = later.iter().map(frame).collect();
    times.sort_by(f64::total_cmp);
    let mean = |quantity| report.summary(quantity).mean;
    let time: f64 = times.iter().sum::<f64>() / times.len() as f64;
    let active = mean(WalkQuantity::Vertices);
    let changed = mean(WalkQuantity::Added) + mean(WalkQuantity::Removed);
    format!(
        " {active:.0} | {:.3} | {:.3} | {:.0} | {:.0} | {:.2} |",
        times[times.len() / 2],
        times[times.len() - 1],
        1e6 * time / active,
        1e6 * mean(WalkQuantity::CacheMilliseconds) / changed,
        mean(WalkQuantity::PatchedFaces) / changed
    )
}
