//! How far a mesh with fewer faces is from the mesh itself, compared with meshoptimizer's `simplify`,
//! and how long both take, as Markdown.
//!
//! ```text
//! cargo run --release --bin simplify -- [--effort fast|best] [--samples N] [files]
//! ```
//!
//! Ten meshes of the test data by default, ordered for a cache before. At 50, 20, 5 and 1 % of the faces: meshoptimizer's result
//! first, at its defaults and with any error allowed, then ours at the number of faces that it
//! reached. Distances are two-sided, from all vertices and from N points a side, a million by default.
//! Times are of one thread, from the mesh to 1 % of its faces.
//!
//! ```text
//!   --floors   the fewest faces of either, by default of five scenes with seams, skins and morph targets
//!   --scenes   distances of glTF scenes with levels of detail, both efforts, against what gltfpack does
//!              (--percents 50,25,10,5: how coarse; --objects: a row of each object, too; --keep-parts: no part of ours
//!              leaves as a whole)
//!   --growth   memory and time a face at 1 and 10 million faces, or of the meshes that are named
//! ```

mod figures;
mod floors;
mod growth;
mod ours;
mod scenes;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use compare::counting::Counting;
use compare::rivals;
use compare::timing::median;
use meshweft::Mesh;
use meshweft::geometry::{Surface, deviation};
use meshweft::order::Effort;

use figures::{Row, Summary, print_head};
use ours::ours;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const MESHES: [&str; 10] = [
    "cow.off.gz",
    "mannequin.off.gz",
    "fandisk.off.gz",
    "bunny.ply.gz",
    "horse.obj.gz",
    "armadillo.obj.gz",
    "feline.off.gz",
    "david.ply.gz",
    "boat.obj.gz",
    "dragon.ply.gz",
];
/// Percent of the faces.
const LEVELS: [usize; 4] = [50, 20, 5, 1];
const SAMPLES: usize = 1_000_000;

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut effort, mut samples) = (Effort::Fast, SAMPLES);
    let (mut table, mut variants) = (None, scenes::Variants::default());
    let mut files = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--effort" => {
                effort = match value()?.as_str() {
                    "fast" => Effort::Fast,
                    "best" => Effort::Best,
                    other => return Err(format!("{other} is not an effort: fast or best")),
                };
            }
            "--samples" => {
                let text = value()?;
                let number = text.parse();
                samples = number.map_err(|_| format!("--samples {text}: not a number"))?;
            }
            "--floors" | "--growth" | "--scenes" => table = Some(argument),
            "--percents" => {
                let text = value()?;
                let percents = text.split(',').map(str::parse);
                let percents = percents.collect::<Result<_, _>>();
                variants.percents =
                    percents.map_err(|_| format!("--percents {text}: not numbers"))?;
            }
            "--objects" => variants.prints_objects = true,
            "--keep-parts" => variants.keeps_parts = true,
            flag if flag.starts_with("--") => return Err(format!("{flag} is not a flag")),
            _ => files.push(PathBuf::from(argument)),
        }
    }
    if table.as_deref() == Some("--growth") {
        return growth::print(&files);
    }
    if table.as_deref() == Some("--scenes") {
        let files = compare::files_or(files, scenes::files)?;
        return scenes::print(&files, samples, &variants);
    }
    if table.is_some() {
        let scenes = |data: &Path| {
            floors::SCENES
                .map(|name| data.join("gltf").join(name))
                .into()
        };
        return floors::print(&compare::files_or(files, scenes)?);
    }
    if files.is_empty() {
        let folder = compare::needed_data_folder()?.join("meshes");
        files = MESHES.map(|name| folder.join(name)).into();
    }

    let mut meshes = Vec::new();
    for file in &files {
        // Both simplify what a pipeline would give them.
        let mesh = compare::in_greedy_order(&compare::read_as_one(file)?, 11);
        meshes.push((compare::mesh_name(file), mesh));
    }
    println!("Two-sided distances in ten thousandths of the bounding box's diagonal.");
    let mut summary = Summary::default();
    for (name, mesh) in &meshes {
        summary.add(name, distances(name, mesh, effort, samples)?);
    }
    summary.print();
    times(&meshes, effort);
    Ok(())
}

/// The table of a mesh: a row a level.
fn distances(name: &str, mesh: &Mesh, effort: Effort, samples: usize) -> Result<Vec<Row>, String> {
    let asked = LEVELS.map(|percent| (percent, mesh.face_count() * percent / 100));
    let theirs = asked.map(|(_, count)| rivals::simplified(mesh, count));
    let reached = theirs.each_ref().map(Vec::len);
    let ours = ours(mesh, &reached, effort);

    println!("\n### {name}, {} faces\n", mesh.face_count());
    print_head();
    let scale = 1e4 / diagonal(mesh);
    let full = Surface::new(mesh.positions(), mesh.faces());
    let measured = |positions: &[[f32; 3]], faces: &[[u32; 3]]| {
        let found = deviation(&full, &Surface::new(positions, faces), samples).two_sided;
        [found.max, found.mean, found.rms].map(|figure| figure * scale)
    };
    let mut rows = Vec::new();
    for (((percent, _), theirs), ours) in asked.iter().zip(&theirs).zip(&ours) {
        let row = Row {
            percent: *percent,
            faces: theirs.len(),
            our_faces: ours.as_ref().map(Mesh::face_count),
            theirs: measured(mesh.positions(), theirs),
            ours: ours
                .as_ref()
                .map(|mesh| measured(mesh.positions(), mesh.faces())),
        };
        row.print();
        rows.push(row);
    }
    Ok(rows)
}

/// The diagonal of the box of all vertices in use.
fn diagonal(mesh: &Mesh) -> f64 {
    let used = mesh.faces().as_flattened().iter();
    let used = used.map(|&vertex| mesh.positions()[vertex as usize].map(f64::from));
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for position in used {
        for axis in 0..3 {
            low[axis] = low[axis].min(position[axis]);
            high[axis] = high[axis].max(position[axis]);
        }
    }
    let square: f64 = (0..3).map(|axis| (high[axis] - low[axis]).powi(2)).sum();
    square.sqrt()
}

/// The table of times: medians, and the median of the ratios of pairs that ran one after the other.
fn times(meshes: &[(String, Mesh)], effort: Effort) {
    println!("\n| mesh | faces | meshoptimizer, ms | ours, ms | ours / meshoptimizer |");
    println!("|---|--:|--:|--:|--:|");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.expect("a pool of one thread");
    for (name, mesh) in meshes {
        let count = mesh.face_count() / 100;
        let reached = rivals::simplified(mesh, count).len();
        let pairs = (1_000_000 / mesh.face_count().max(1)).clamp(3, 15) | 1;
        let (mut theirs, mut our, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..pairs {
            let start = Instant::now();
            std::hint::black_box(rivals::simplified(mesh, count));
            let their_seconds = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let made = pool.install(|| ours(mesh, &[reached], effort));
            let our_seconds = start.elapsed().as_secs_f64();
            theirs.push(their_seconds * 1e3);
            if made[0].is_some() {
                our.push(our_seconds * 1e3);
                ratios.push(our_seconds / their_seconds);
            }
        }
        let theirs = median(theirs);
        let faces = mesh.face_count();
        match ratios.is_empty() {
            true => println!("| {name} | {faces} | {theirs:.1} | – | – |"),
            false => println!(
                "| {name} | {faces} | {theirs:.1} | {:.1} | {:.2} |",
                median(our),
                median(ratios)
            ),
        }
    }
}
