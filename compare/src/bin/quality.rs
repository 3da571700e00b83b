//! Prints misses per face and per vertex of every order there is to compare, as Markdown.
//!
//! `cargo run --release --bin quality -- [mesh files]`; without files five meshes of the test data.

use std::path::PathBuf;
use std::process::ExitCode;

use compare::rivals::{self, Meshopt};
use meshweft::order::{KCacheReorder, Mode, baselines};
use meshweft::{CacheModel, Mesh, cache};

const SIZES: [u32; 6] = [10, 12, 16, 24, 32, 64];
const GPUS: [CacheModel; 3] = [CacheModel::NVIDIA, CacheModel::AMD, CacheModel::INTEL];

fn main() -> ExitCode {
    let mut files: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if files.is_empty() {
        let Some(data) = compare::data_folder() else {
            eprintln!("name mesh files, or set MESHWEFT_DATA to the folder of test data");
            return ExitCode::from(2);
        };
        files = compare::default_mesh_files(&data);
    }
    let sizes = SIZES.map(|size| format!("K={size}")).join(" | ");
    println!("| mesh | order | {sizes} | NVIDIA | AMD | Intel |");
    println!("|---|---|{}", "--:|".repeat(SIZES.len() + GPUS.len()));
    for file in files {
        let mesh = match compare::oracle::read(&file) {
            Ok(mesh) => mesh,
            Err(error) => {
                eprintln!("{error}");
                return ExitCode::FAILURE;
            }
        };
        let name = compare::mesh_name(&file);
        for (order, faces) in orders(&mesh) {
            let acmr = SIZES.map(|size| cache::acmr(&faces, CacheModel::fifo(size)));
            let atvr = GPUS.map(|gpu| cache::atvr(&faces, gpu));
            let figures: Vec<f64> = acmr.into_iter().chain(atvr).collect();
            let cells: Vec<String> = figures.iter().map(|f| format!("{f:.3}")).collect();
            println!("| {name} | {order} | {} |", cells.join(" | "));
        }
    }
    println!();
    println!("K: misses per face (ACMR) of a FIFO cache. NVIDIA, AMD, Intel: misses per vertex");
    println!("(ATVR) of the batch models that meshoptimizer's analyzer is run with.");
    ExitCode::SUCCESS
}

fn orders(mesh: &Mesh) -> Vec<(String, Vec<[u32; 3]>)> {
    let faces = mesh.faces();
    let meshopt = |order: Meshopt| order.ordered(mesh);
    let k_cache_reorder = |mode, size| {
        let algorithm = KCacheReorder {
            cache: CacheModel::fifo(size),
            mode,
            ..Default::default()
        };
        algorithm.face_order(mesh).apply(faces)
    };
    let mut orders = vec![
        ("as in the file".to_owned(), faces.to_vec()),
        (
            "random".to_owned(),
            baselines::random(faces.len(), 1).apply(faces),
        ),
        ("forsyth 1.0.1".to_owned(), rivals::forsyth(faces)),
        (
            "meshopt VertexCache".to_owned(),
            meshopt(Meshopt::VertexCache),
        ),
        ("meshopt Strip".to_owned(), meshopt(Meshopt::Strip)),
    ];
    for size in [12, 16, 32] {
        let name = format!("meshopt Fifo({size})");
        orders.push((name, meshopt(Meshopt::Fifo(size))));
    }
    for size in [12, 16, 32] {
        let tipsify = baselines::tipsify(mesh, size).apply(faces);
        orders.push((format!("Tipsify, ours, K={size}"), tipsify));
    }
    for size in [10, 12, 16, 32] {
        orders.push((
            format!("**fast, K={size}**"),
            k_cache_reorder(Mode::Fast, size),
        ));
    }
    for size in [12, 16] {
        let name = format!("faithful, K={size}");
        orders.push((name, k_cache_reorder(Mode::Faithful, size)));
    }
    orders
}
