//! Bytes that a walk sends.

use meshweft::operations::{LodWalkOptions, WalkQuantity, WalkRecorder};

use crate::scene::Scene;
use crate::{FRAMES, PATHS};

/// Tolerance in pixels, and bytes of a vertex.
const TOLERANCE: f64 = 1.5;
const VERTEX_SIZE: usize = 36;

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "Kilobytes (1,000 bytes) sent in {FRAMES} frames at {TOLERANCE} pixels, the first frame with all that it draws: vertices of \
         {VERTEX_SIZE} bytes, and faces whose indices change.\n"
    );
    println!("| mesh | path | mean active | first frame | vertices | indices | all |");
    println!("|---|---|{}", "--:|".repeat(5));
    for scene in scenes {
        let recorder = WalkRecorder::new(&scene.document, &|| 0.0);
        let recorder = recorder.map_err(|it| it.to_string())?;
        for (letter, path) in &PATHS {
            let mut options = LodWalkOptions::default();
            options.path = path.clone();
            options.frames = Some(FRAMES);
            options.tolerance = TOLERANCE;
            options.vertex_size = VERTEX_SIZE;
            let walk = recorder.record(&options, &|| 0.0, &());
            let report = walk.and_then(|walk| walk.replay(options.policy, &|| 0.0));
            let report = report.map_err(|it| it.to_string())?;
            let active = report.summary(WalkQuantity::Vertices).total / FRAMES as f64;
            let sums = [WalkQuantity::VertexBytes, WalkQuantity::IndexBytes]
                .map(|quantity| report.summary(quantity));
            let [vertices, indices] = sums.map(|it| it.total / 1e3);
            let first: f64 = sums.iter().map(|it| it.first / 1e3).sum();
            println!(
                "| {} | {letter} | {active:.0} | {first:.0} | {vertices:.0} | {indices:.0} | {:.0} |",
                scene.name,
                vertices + indices
            );
        }
    }
    Ok(())
}
