//! Misses of levels over those of a fresh order.

use meshweft::progressive::{CheckpointWalk, Checkpoints, ProgressiveMesh};
use meshweft::{CacheModel, Mesh, cache};

use crate::{MADE, SIZES, STORED, Way};

/// How many levels are compared, and how many faces each has of the one before.
const LEVELS: i32 = 59;
const STEP: f64 = 0.95;

/// ACMR over that of a fresh order.
struct Figures {
    checkpoints: usize,
    mean: f64,
    worst: f64,
    /// The percentage of the faces at which it is worst.
    worst_at: f64,
}

pub(crate) fn print(meshes: &[(String, Mesh)]) -> Result<(), String> {
    println!(
        "ACMR over that of a fresh K-Cache-Reorder, {LEVELS} levels from 100 to 5 % of the faces.\n"
    );
    println!("| mesh | faces | K | orders | checkpoints | mean | worst | at, % |");
    println!("|---|--:|--:|---|--:|--:|--:|--:|");
    let mut all = Vec::new();
    for way in [&STORED, &MADE] {
        let mut of_way = Vec::new();
        for (name, mesh) in meshes {
            for size in SIZES {
                let figures = compared(mesh, way, size)?;
                println!(
                    "| {name} | {} | {size} | {} | {} | {:.3} | {:.3} | {:.0} |",
                    mesh.face_count(),
                    way.name,
                    figures.checkpoints,
                    figures.mean,
                    figures.worst,
                    figures.worst_at,
                );
                of_way.push(figures);
            }
        }
        all.push((way.name, of_way));
    }

    println!("\n| orders | mean of all | greatest mean | worst of all |");
    println!("|---|--:|--:|--:|");
    for (name, figures) in &all {
        let greatest = |of: fn(&Figures) -> f64| figures.iter().map(of).fold(0.0, f64::max);
        let sum: f64 = figures.iter().map(|figures| figures.mean).sum();
        println!(
            "| {name} | {:.3} | {:.3} | {:.3} |",
            sum / figures.len() as f64,
            greatest(|figures| figures.mean),
            greatest(|figures| figures.worst),
        );
    }
    Ok(())
}

fn compared(mesh: &Mesh, way: &Way, size: u32) -> Result<Figures, String> {
    let progressive = way.progressive(mesh, size)?;
    let checkpoints = Checkpoints::optimized(&progressive, way.ratio, &way.optimizer(size));
    let mut walk = CheckpointWalk::new(&checkpoints);
    let mut faces = Vec::new();
    let mut figures = Figures {
        checkpoints: checkpoints.levels().len(),
        mean: 0.0,
        worst: 0.0,
        worst_at: 100.0,
    };
    for i in 0..LEVELS {
        let share = STEP.powi(i);
        walk.go_to(level_of(&progressive, share));
        walk.emit(&mut faces);

        let level = Mesh::connectivity_only(mesh.vertex_count(), faces.as_slice());
        let level = level.map_err(|error| error.to_string())?;
        let ordered = compare::greedy(size).face_order(&level).apply(&faces);
        let model = CacheModel::fifo(size);
        let ratio = cache::acmr(&faces, model) / cache::acmr(&ordered, model);
        figures.mean += ratio / f64::from(LEVELS);
        if ratio > figures.worst {
            (figures.worst, figures.worst_at) = (ratio, 100.0 * share);
        }
    }
    Ok(figures)
}

/// The level with this share of the faces.
pub(crate) fn level_of(mesh: &ProgressiveMesh, share: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "at most the number of faces"
    )]
    mesh.level_of_faces((mesh.faces().len() as f64 * share) as usize)
}
