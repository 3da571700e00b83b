//! Faces at equal true error, against one simplified mesh of meshoptimizer for all frames.

use std::collections::BTreeMap;

use compare::rivals;

use crate::pixel_error::{Seen, distances, summary};
use crate::scene::Scene;
use crate::{PATHS, mean, worst};

const TOLERANCES: [f64; 2] = [1.5, 0.5];
/// Frames of a path that are measured.
const LOOKS: usize = 6;
/// Simplified meshes have the errors of a series, in parts of the mesh's extent, in which each is that part of the one before.
const LARGEST_ERROR: f64 = 0.05;
const STEP: f64 = 1.0 / 1.05;
/// The steps of the series that is searched, and the stride of the first look.
const STEPS: usize = 200;
const STRIDE: usize = 5;

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "Faces of the front, means over {LOOKS} frames, and of the coarsest mesh of meshoptimizer's `simplify` at one error \
         for all whose p99.9 over the same frames is not larger. p99.9 is over all visible vertices of all frames, in \
         pixels.\n"
    );
    println!(
        "| mesh | path | tolerance | faces | p99.9 | worst | meshoptimizer's faces | p99.9 | worst | faces, ours / theirs |"
    );
    println!("|---|---|{}", "--:|".repeat(8));
    let mut ratios: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for scene in scenes {
        let mut rival = Simplified::new(scene);
        for (letter, path) in PATHS
            .iter()
            .filter(|(letter, _)| ["A", "C"].contains(letter))
        {
            let cameras: Vec<_> = scene.cameras(path, LOOKS).collect();
            let seen: Vec<Seen> = cameras.iter().map(|it| Seen::by(it, scene)).collect();
            for tolerance in TOLERANCES {
                let mut front = scene.front();
                let (mut errors, mut counts) = (Vec::new(), Vec::new());
                for (camera, seen) in cameras.iter().zip(&seen) {
                    let view = camera.view(tolerance).map_err(|it| it.to_string())?;
                    front.update(&view, 1.0);
                    counts.push(front.face_count() as f64);
                    errors.extend(seen.errors(&scene.full, scene, &Scene::drawn(&front)));
                }
                let [ours, our_worst] = summary(errors);
                let faces = mean(counts);
                let name = &scene.name;
                print!(
                    "| {name} | {letter} | {tolerance} | {faces:.0} | {ours:.3} | {our_worst:.3} |"
                );
                match rival.coarsest(&seen, ours) {
                    Some((their_faces, [theirs, their_worst])) => {
                        let ratio = faces / their_faces as f64;
                        ratios.entry(letter).or_default().push(ratio);
                        println!(" {their_faces} | {theirs:.3} | {their_worst:.3} | {ratio:.3} |");
                    }
                    None => println!(" none reaches it | – | – | – |"),
                }
            }
        }
    }

    println!("\n| path | mean of the ratios | worst |");
    println!("|---|--:|--:|");
    for (letter, ratios) in &ratios {
        let [mean, worst] = [mean(ratios.iter().copied()), worst(ratios.iter().copied())];
        println!("| {letter} | {mean:.3} | {worst:.3} |");
    }
    Ok(())
}

/// Meshes of meshoptimizer, made when they are asked for.
struct Simplified<'a> {
    scene: &'a Scene,
    /// By their place in the series: how many faces, and how far each vertex of the full mesh is.
    made: BTreeMap<usize, (usize, Vec<f32>)>,
}

impl<'a> Simplified<'a> {
    fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            made: BTreeMap::new(),
        }
    }

    /// The number of faces of the coarsest mesh that has at most this p99.9, with its p99.9 and its worst error.
    fn coarsest(&mut self, seen: &[Seen], most: f64) -> Option<(usize, [f64; 2])> {
        // A smaller error need not give a smaller p99.9, so the search begins with the coarsest.
        let mut look = |step: usize| {
            let found = self.summary(step, seen);
            (found.1[0] <= most).then_some(found)
        };
        let step = (0..STEPS)
            .step_by(STRIDE)
            .find(|&step| look(step).is_some())?;
        (step.saturating_sub(STRIDE - 1)..=step).find_map(look)
    }

    fn summary(&mut self, step: usize, seen: &[Seen]) -> (usize, [f64; 2]) {
        let scene = self.scene;
        let (faces, distances) = self.made.entry(step).or_insert_with(|| {
            let error = LARGEST_ERROR * STEP.powf(step as f64);
            #[expect(clippy::cast_possible_truncation, reason = "as exact as it takes them")]
            let faces = rivals::simplified_within(&scene.for_rivals, error as f32);
            #[expect(clippy::cast_possible_truncation, reason = "as exact as positions are")]
            let distances = distances(scene, &faces).into_iter().map(|it| it as f32);
            (faces.len(), distances.collect())
        });
        let distances: Vec<f64> = distances.iter().map(|&it| f64::from(it)).collect();
        let errors = seen.iter().flat_map(|seen| seen.errors_by(&distances));
        (*faces, summary(errors.collect()))
    }
}
