//! The mesh of a budget against the one of a tolerance with as many vertices.

use meshweft::lod::Camera;
use meshweft::lod::fast_mesh::{FrameBudget, Front};

use crate::pixel_error::{Seen, summary};
use crate::scene::Scene;
use crate::{PATHS, mean, worst};

/// Numbers of vertices, as parts of those of the full mesh.
const PARTS: [f64; 3] = [0.01, 0.03, 0.1];
/// The tolerance under the budget, in pixels: it is never reached.
const TOLERANCE: f64 = 0.001;
/// Frames of a path that are walked, and how many there are for each that is measured.
const WALKED: usize = 48;
const EVERY: usize = 12;

pub(crate) fn print(scenes: &[Scene]) -> Result<(), String> {
    println!(
        "Fronts of at most N vertices, walked with a budget at {TOLERANCE} pixels, and fronts of the largest number up to N that a \
         tolerance gives for the same view; true errors in pixels, over {} of {WALKED} frames. over N: frames that have \
         more.\n",
        WALKED / EVERY
    );
    println!(
        "| mesh | path | N | vertices | by tolerance | over N | p99.9 | by tolerance | ratio | worst | by tolerance | ratio |"
    );
    println!("|---|---|{}", "--:|".repeat(10));
    let (mut ratios, mut over) = ([Vec::new(), Vec::new()], 0);
    for scene in scenes {
        for (letter, path) in &PATHS {
            let cameras: Vec<Camera> = scene.cameras(path, WALKED).collect();
            for part in PARTS {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a number of vertices"
                )]
                let most = (part * scene.full.vertex_count() as f64) as usize;
                let found = Compared::of(scene, &cameras, most)?;
                let [quantile, largest] =
                    [0, 1].map(|i| found.within[i] / found.by_tolerance[i].max(f64::MIN_POSITIVE));
                println!(
                    "| {} | {letter} | {most} | {:.0} | {:.0} | {} | {:.3} | {:.3} | {quantile:.3} | {:.3} | {:.3} | {largest:.3} |",
                    scene.name,
                    found.vertices[0],
                    found.vertices[1],
                    found.over,
                    found.within[0],
                    found.by_tolerance[0],
                    found.within[1],
                    found.by_tolerance[1],
                );
                ratios[0].push(quantile);
                ratios[1].push(largest);
                over += found.over;
            }
        }
    }
    println!("\n| ratio of | mean | worst |\n|---|--:|--:|");
    for (name, ratios) in ["p99.9", "worst"].into_iter().zip(&ratios) {
        let [mean, worst] = [mean(ratios.iter().copied()), worst(ratios.iter().copied())];
        println!("| {name} | {mean:.3} | {worst:.3} |");
    }
    println!("\nFrames of more than N vertices: {over}.");
    Ok(())
}

/// Of a budget first, of a tolerance second.
struct Compared {
    vertices: [f64; 2],
    over: usize,
    /// p99.9 and the worst.
    within: [f64; 2],
    by_tolerance: [f64; 2],
}

impl Compared {
    fn of(scene: &Scene, cameras: &[Camera], most: usize) -> Result<Self, String> {
        let budget = FrameBudget {
            vertices: most,
            ..FrameBudget::default()
        };
        let mut limited = scene.front();
        let mut free = scene.front();
        let roots = limited.vertex_count();
        let mut vertices = [Vec::new(), Vec::new()];
        let mut errors = [Vec::new(), Vec::new()];
        let mut over = 0;
        for (number, camera) in cameras.iter().enumerate() {
            let view = camera.view(TOLERANCE).map_err(|it| it.to_string())?;
            limited.update_within(&view, 1.0, budget);
            over += usize::from(limited.vertex_count() > most.max(roots));
            if number % EVERY != 0 {
                continue;
            }
            fill(&mut free, camera, most)?;
            let seen = Seen::by(camera, scene);
            for (i, front) in [&limited, &free].into_iter().enumerate() {
                vertices[i].push(front.vertex_count() as f64);
                errors[i].extend(seen.errors(&scene.full, scene, &Scene::drawn(front)));
            }
        }
        let [within, by_tolerance] = errors.map(summary);
        Ok(Self {
            vertices: vertices.map(mean),
            over,
            within,
            by_tolerance,
        })
    }
}

/// Gives a front the most vertices up to a number that a tolerance gives.
fn fill(front: &mut Front, camera: &Camera, most: usize) -> Result<(), String> {
    let mut with = |tolerance: f64| {
        let view = camera.view(tolerance).map_err(|it| it.to_string())?;
        front.update(&view, 1.0);
        Ok::<_, String>(front.vertex_count())
    };
    // By the logarithm of the tolerance.
    let (mut low, mut high) = (1e-3_f64.ln(), 1e4_f64.ln());
    while high - low > 1e-3 {
        let middle = 0.5 * (low + high);
        match with(middle.exp())? <= most {
            true => high = middle,
            false => low = middle,
        }
    }
    with(high.exp()).map(|_| ())
}
