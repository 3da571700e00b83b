//! Misses of our orders over those of other orders on every mesh of the test data, as Markdown: means,
//! the worst mesh beside each, and in how many cells (a mesh and a cache) ours is worse.
//!
//! ```text
//! cargo run --release --bin every_mesh -- [--target TARGET]... [--effort EFFORT]... [--scenes] [--time] [mesh files]
//! ```
//!
//! The universal target is held against meshoptimizer's main optimizer in each of its nine caches, and in
//! the setup cycles of NVIDIA cards; any other target against the least, for it, of meshoptimizer's three
//! optimizers, the order in the file and our universal order of the same effort. Without `--target` it takes
//! the universal one, without `--effort` fast and best.
//!
//! `--scenes` takes each primitive of the glTF scenes and each mesh of VRML files as a mesh too. `--time` also times each order of meshes of over
//! 1,000 faces on one thread as a multiple of `meshopt_optimizeVertexCache`'s in the same run; without it all
//! processors count misses.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use compare::rivals::Meshopt;
use compare::timing;
use meshweft::cache::nvidia;
use meshweft::files::Document;
use meshweft::order::{Effort, Optimizer, Target};
use meshweft::{CacheModel, Limits, Mesh, cache};
use rayon::prelude::*;

/// A cell is worse if it has more misses than this share of the rival's.
const WORSE: f64 = 1.001;

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut targets, mut efforts, mut files) = (Vec::new(), Vec::new(), Vec::new());
    let (mut scenes, mut is_timed) = (false, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--target" => {
                let target: Target = value()?.parse().map_err(|e| format!("{e}"))?;
                targets.push(target);
            }
            "--effort" => efforts.push(effort(&value()?)?),
            "--scenes" => scenes = true,
            "--time" => is_timed = true,
            _ => files.push(PathBuf::from(argument)),
        }
    }
    if targets.is_empty() {
        targets.push(Target::Universal);
    }
    if efforts.is_empty() {
        efforts = vec![Effort::Fast, Effort::Best];
    }
    if is_timed {
        compare::one_thread();
    }

    let files = compare::files_or(files, compare::mesh_files)?;
    let meshes = read(&files, scenes)?;
    for effort in efforts {
        for &target in &targets {
            let optimizer = Optimizer {
                target,
                effort,
                ..Optimizer::default()
            };
            table(&optimizer, &meshes, is_timed);
        }
    }
    Ok(())
}

fn effort(name: &str) -> Result<Effort, String> {
    let efforts = [Effort::Fast, Effort::Best, Effort::Max];
    let named = efforts
        .into_iter()
        .find(|effort| effort.to_string() == name);
    named.ok_or(format!("{name} is not an effort: fast, best or max"))
}

/// The meshes of files, and with `scenes` those of the glTF scenes.
fn read(files: &[PathBuf], scenes: bool) -> Result<Vec<(String, Mesh)>, String> {
    let (vrml, plain): (Vec<_>, Vec<_>) = files
        .iter()
        .cloned()
        .partition(|file| compare::is_vrml(file));
    let mut meshes = compare::read_meshes(&plain)?;
    let mut documents = Vec::new();
    if scenes {
        documents = vrml;
        let folder = compare::needed_data_folder()?.join("gltf");
        let entries = std::fs::read_dir(folder).map_err(|error| error.to_string())?;
        documents.extend(entries.filter_map(|entry| entry.ok().map(|entry| entry.path())));
    }
    documents.sort();
    for file in &documents {
        meshes.extend(meshes_of(file));
    }
    Ok(meshes)
}

/// The meshes of a document that the library reads; none of a compressed one.
fn meshes_of(file: &Path) -> Vec<(String, Mesh)> {
    let Ok(document) = Document::open(file, Limits::default()) else {
        return Vec::new();
    };
    let named = |entry: &meshweft::files::MeshEntry| {
        let name = format!("{} {}", compare::mesh_name(file), entry.name);
        (name, entry.mesh.clone())
    };
    document.meshes().iter().map(named).collect()
}

/// What one mesh says.
struct Row<'a> {
    name: &'a str,
    /// By column: our misses over the rival's.
    cells: Vec<f64>,
    /// Our time over that of meshoptimizer's main optimizer.
    time: Option<f64>,
}

fn table(optimizer: &Optimizer, meshes: &[(String, Mesh)], is_timed: bool) {
    let rows: Vec<Row<'_>> = match is_timed {
        true => meshes
            .iter()
            .map(|mesh| row(optimizer, mesh, true))
            .collect(),
        false => meshes
            .par_iter()
            .map(|mesh| row(optimizer, mesh, false))
            .collect(),
    };
    let (target, effort) = (optimizer.target, optimizer.effort);
    let mut columns: Vec<String> = target.models().iter().map(CacheModel::to_string).collect();
    if target == Target::Universal {
        columns.push("setup cycles".to_owned());
    }

    println!("\n{target}, {effort}, {} meshes\n", rows.len());
    println!("| cache | mean | worst | mesh | meshes where ours is worse by more than .1 % |");
    println!("|---|--:|--:|---|--:|");
    for (i, column) in columns.iter().enumerate() {
        let cells = || rows.iter().map(|row| row.cells[i]);
        let worst = rows.iter().max_by(|a, b| a.cells[i].total_cmp(&b.cells[i]));
        let Some(worst) = worst else { return };
        println!(
            "| {column} | {:.4} | {:.4} | {} | {} |",
            cells().sum::<f64>() / rows.len() as f64,
            worst.cells[i],
            worst.name,
            cells().filter(|&cell| cell > WORSE).count(),
        );
    }
    for row in &rows {
        let worse = columns.iter().zip(&row.cells);
        let worse: Vec<_> = worse
            .filter(|&(_, &cell)| cell > WORSE)
            .map(|(column, cell)| format!("{column} {cell:.4}"))
            .collect();
        if !worse.is_empty() {
            println!("worse on {}: {}", row.name, worse.join(", "));
        }
    }
    let times: Vec<f64> = rows.iter().filter_map(|row| row.time).collect();
    if !times.is_empty() {
        let logarithms: f64 = times.iter().map(|time| time.ln()).sum();
        println!(
            "Time over meshoptimizer's main optimizer, {} meshes of over 1,000 faces: geometric mean {:.2}x, greatest {:.2}x.",
            times.len(),
            (logarithms / times.len() as f64).exp(),
            times.iter().copied().fold(0.0, f64::max),
        );
    }
}

fn row<'a>(optimizer: &Optimizer, (name, mesh): &'a (String, Mesh), is_timed: bool) -> Row<'a> {
    let ours = optimizer.face_order(mesh).apply(mesh.faces());
    let theirs = Meshopt::VertexCache.ordered(mesh);
    let cells = match optimizer.target {
        Target::Universal => {
            let [ours, theirs] = [&ours, &theirs].map(|faces| {
                let mut counts = cache::misses_of(faces, &Target::UNIVERSAL);
                counts.push(nvidia::counts(faces).setup_cycles);
                counts
            });
            ours.into_iter().zip(theirs).map(over).collect()
        }
        target => {
            let sizes = target.models().iter().filter(|model| !model.is_gpu());
            let sizes = sizes.map(CacheModel::size).filter(|size| *size >= 3);
            let fifos = [12, 16, 32].into_iter().chain(sizes).map(Meshopt::Fifo);
            let universal = Optimizer {
                target: Target::Universal,
                ..optimizer.clone()
            };
            let universal = universal.face_order(mesh).apply(mesh.faces());
            let mut others = vec![mesh.faces().to_vec(), universal, theirs];
            others.push(Meshopt::Strip.ordered(mesh));
            others.extend(fifos.map(|order| order.ordered(mesh)));
            let least = others.iter().map(|faces| target.misses(faces)).min();
            vec![over((target.misses(&ours), least.unwrap_or_default()))]
        }
    };
    let time = (is_timed && mesh.face_count() > 1000).then(|| {
        let repetitions = (300_000 / mesh.face_count()).clamp(1, 25) | 1;
        let [ours, theirs] = timing::medians(
            repetitions,
            [
                &mut || optimizer.face_order(mesh).apply(mesh.faces()),
                &mut || Meshopt::VertexCache.ordered(mesh),
            ],
        );
        ours / theirs
    });
    Row { name, cells, time }
}

/// The first over the second; 1 where both are 0.
fn over((ours, theirs): (u64, u64)) -> f64 {
    match theirs {
        0 => 1.0 + ours as f64,
        _ => ours as f64 / theirs as f64,
    }
}
