//! What each effort gives for its time, compared with meshoptimizer's main optimizer, one thread, all
//! in one run, as Markdown.
//!
//! ```text
//! cargo run --release --bin search -- [--target TARGET]... [--effort EFFORT]... [mesh files]
//! ```
//!
//! Targets are written as for `meshweft optimize --cache`; the default is all that the README shows.
//! Five meshes of the test data by default.

use std::path::PathBuf;
use std::process::ExitCode;

use compare::rivals::Meshopt;
use meshweft::order::{Effort, Optimizer, Target};
use meshweft::{CacheModel, Mesh};

const EFFORTS: [(&str, Effort); 3] = [
    ("fast", Effort::Fast),
    ("best", Effort::Best),
    ("max", Effort::Max),
];

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut targets, mut efforts, mut files) = (Vec::new(), Vec::new(), Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--target" => {
                let target: Target = value()?.parse().map_err(|e| format!("{e}"))?;
                targets.push(target);
            }
            "--effort" => {
                let name = value()?;
                let known = EFFORTS.iter().find(|(effort, _)| *effort == name);
                efforts.push(*known.ok_or(format!("{name} is not an effort: fast, best or max"))?);
            }
            _ => files.push(PathBuf::from(argument)),
        }
    }
    if targets.is_empty() {
        targets = [12, 16, 32].map(|k| CacheModel::fifo(k).into()).to_vec();
        targets.push(CacheModel::controllable(12).into());
        targets.extend([CacheModel::Nvidia, CacheModel::AMD, CacheModel::INTEL].map(Target::from));
        targets.push(Target::Universal);
    }
    if efforts.is_empty() {
        efforts = EFFORTS.to_vec();
    }
    let files = compare::files_or(files, compare::default_mesh_files)?;
    let meshes = compare::read_meshes(&files)?;
    for target in targets {
        table(target, &efforts, &meshes);
    }
    println!("ACMR of FIFO and controllable caches, ATVR of GPUs. Times as multiples of");
    println!("`meshopt_optimizeVertexCache`'s on the same mesh in the same run.");
    Ok(())
}

fn table(target: Target, efforts: &[(&str, Effort)], meshes: &[(String, Mesh)]) {
    let names = meshes.iter().map(|(name, _)| format!(" {name} |"));
    println!("| {target} |{} mean |", names.collect::<String>());
    println!("|---|{}", "--:|".repeat(meshes.len() + 1));
    let mut meshopt_seconds = Vec::new();
    let rows = meshes.iter().map(|(_, mesh)| {
        let (seconds, figures) = timed(target, || Meshopt::VertexCache.ordered(mesh));
        meshopt_seconds.push(seconds);
        figures
    });
    print_row("meshopt", &rows.collect::<Vec<_>>(), None);
    for &(name, effort) in efforts {
        let optimizer = Optimizer {
            target,
            effort,
            ..Optimizer::default()
        };
        let mut ratios = Vec::new();
        let rows = meshes
            .iter()
            .zip(&meshopt_seconds)
            .map(|((_, mesh), meshopt)| {
                let order = || optimizer.face_order(mesh).apply(mesh.faces());
                let (seconds, figures) = timed(target, order);
                ratios.push(seconds / meshopt);
                figures
            });
        let rows: Vec<_> = rows.collect();
        print_row(name, &rows, Some(&ratios));
    }
    println!();
}

/// Seconds of an order, and its figures.
fn timed(target: Target, order: impl FnMut() -> Vec<[u32; 3]>) -> (f64, Vec<f64>) {
    let (seconds, faces) = compare::timing::timed(order);
    let figure = |&model: &CacheModel| compare::figure(&faces, model);
    (seconds, target.models().iter().map(figure).collect())
}

fn print_row(name: &str, rows: &[Vec<f64>], ratios: Option<&[f64]>) {
    let count = rows[0].len();
    let text = |figures: &[f64]| {
        let figures: Vec<String> = figures.iter().map(|f| format!("{f:.4}")).collect();
        figures.join(" ")
    };
    print!("| {name} |");
    for (i, figures) in rows.iter().enumerate() {
        let time = ratios.map_or(String::new(), |ratios| format!(", {:.1}x", ratios[i]));
        print!(" {}{time} |", text(figures));
    }
    let mean = |i: usize| rows.iter().map(|row| row[i]).sum::<f64>() / rows.len() as f64;
    let means: Vec<f64> = (0..count).map(mean).collect();
    let time = ratios.map_or(String::new(), |ratios| {
        format!(", {:.1}x", ratios.iter().sum::<f64>() / ratios.len() as f64)
    });
    println!(" {}{time} |", text(&means));
}
