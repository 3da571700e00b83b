//! Bytes that a walk sends, against a hierarchy of clusters.

use compare::clusters::{self, LodCluster};
use meshweft::lod::Camera;
use meshweft::operations::{LodWalkOptions, WalkQuantity, WalkRecorder};

use crate::pixel_error::{Picture, Seen, summary};
use crate::scene::Scene;
use crate::{FRAMES, PATHS};

/// Tolerance in pixels, and bytes of a vertex.
const TOLERANCE: f64 = 1.5;
const VERTEX_SIZE: usize = 36;
/// Frames of a path whose errors are measured.
const LOOKS: usize = 6;

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "Kilobytes (1,000 bytes) sent in {FRAMES} frames at {TOLERANCE} pixels, the first frame with all that it draws: vertices of \
         {VERTEX_SIZE} bytes, and faces whose indices change. Clusters: as meshoptimizer makes a hierarchy of them, each sent once \
         when it is first drawn, its vertices and 3 bytes a face; those outside of the picture or turned away are not sent. p99.9 \
         is the true error over {LOOKS} frames, in pixels.\n"
    );
    println!(
        "| mesh | path | mean active | first frame | vertices | indices | all | p99.9 | clusters | p99.9 | ours / clusters |"
    );
    println!("|---|---|{}", "--:|".repeat(9));
    for scene in scenes {
        let recorder = WalkRecorder::new(&scene.document, &|| 0.0);
        let recorder = recorder.map_err(|it| it.to_string())?;
        let clusters = clusters::hierarchy(&scene.for_rivals);
        for (letter, path) in &PATHS {
            // Ours.
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
            let all = vertices + indices;

            // Theirs, and the errors of both.
            let theirs = sent(&clusters, scene.cameras(path, FRAMES));
            let (mut our_errors, mut their_errors) = (Vec::new(), Vec::new());
            let mut front = scene.front();
            for camera in scene.cameras(path, LOOKS) {
                let seen = Seen::by(&camera, scene);
                let view = camera.view(TOLERANCE).map_err(|it| it.to_string())?;
                front.update(&view, 1.0);
                our_errors.extend(seen.errors(&scene.full, scene, &Scene::drawn(&front)));
                // All that is in the cut: what is not in the picture may be nearest too.
                let scale = Picture::of(&camera).scale;
                let cut = clusters.iter();
                let cut = cut.filter(|it| it.is_in_cut(camera.eye, scale, TOLERANCE));
                let faces: Vec<[u32; 3]> = cut.flat_map(|it| it.faces.clone()).collect();
                their_errors.extend(seen.errors(&scene.for_rivals, scene, &faces));
            }
            println!(
                "| {} | {letter} | {active:.0} | {first:.0} | {vertices:.0} | {indices:.0} | {all:.0} | {:.3} | {theirs:.0} | {:.3} | {:.3} |",
                scene.name,
                summary(our_errors)[0],
                summary(their_errors)[0],
                all / theirs
            );
        }
    }
    Ok(())
}

/// Kilobytes of all clusters that are drawn in any frame.
fn sent(clusters: &[LodCluster], cameras: impl Iterator<Item = Camera>) -> f64 {
    let mut is_sent = vec![false; clusters.len()];
    for camera in cameras {
        let picture = Picture::of(&camera);
        let sides = picture.sides();
        for (cluster, is_sent) in clusters.iter().zip(&mut is_sent) {
            *is_sent = *is_sent
                || cluster.is_in_cut(camera.eye, picture.scale, TOLERANCE)
                    && cluster.may_be_seen(camera.eye, &sides);
        }
    }
    let bytes = clusters.iter().zip(is_sent).filter(|(_, is_sent)| *is_sent);
    let bytes = bytes.map(|(it, _)| VERTEX_SIZE * it.vertex_count + 3 * it.faces.len());
    bytes.sum::<usize>() as f64 / 1e3
}
