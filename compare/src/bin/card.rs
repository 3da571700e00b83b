//! Prints what an NVIDIA card counts for the orders of each mesh, and other caches beside it, as
//! Markdown: by the model of `meshweft::cache::nvidia`, no card is used.
//!
//! ```text
//! cargo run --release --bin card -- [--effort fast|best|max]... [mesh files]
//! ```
//!
//! Without files it takes five meshes of the test data and a grid. `--effort`: up to which effort
//! meshweft's orders are made (default best).

use std::path::PathBuf;
use std::process::ExitCode;

use compare::rivals::Meshopt;
use compare::timing::timed;
use meshweft::cache::nvidia;
use meshweft::order::{Effort, InBatches, Optimizer, Target};
use meshweft::{CacheModel, FaceOrder, Mesh};

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

/// The other caches that an order is looked at in: those of the universal target, with meshoptimizer's
/// model of NVIDIA for the card's own.
fn other_caches() -> [CacheModel; OTHERS] {
    Target::UNIVERSAL.map(|model| match model {
        CacheModel::Nvidia => CacheModel::MESHOPT_NVIDIA,
        model => model,
    })
}

/// The meshes of the test data that are taken where no files are named.
const MESHES: [&str; 5] = [
    "fandisk.off.gz",
    "bunny.ply.gz",
    "horse.obj.gz",
    "nefertiti.obj.gz",
    "armadillo.obj.gz",
];
const OTHERS: usize = Target::UNIVERSAL.len();
/// Figures of the card.
const CARD: usize = 4;

fn run() -> Result<(), String> {
    // What is asked for.
    let (mut most, mut files) = (Effort::Best, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match (argument.as_str(), arguments.len()) {
            ("--effort", 1..) => {
                most = match arguments.next().as_deref() {
                    Some("fast") => Effort::Fast,
                    Some("best") => Effort::Best,
                    Some("max") => Effort::Max,
                    _ => return Err("--effort needs fast, best or max".to_owned()),
                }
            }
            _ => files.push(PathBuf::from(argument)),
        }
    }
    let is_default = files.is_empty();
    let files = compare::files_or(files, |data| compare::named_mesh_files(data, &MESHES))?;
    let mut meshes = compare::read_meshes(&files)?;
    if is_default {
        meshes.push(("grid 200 x 200".to_owned(), grid(200)));
    }

    println!(
        "| mesh | order | invocations a vertex | warps over floor | distinct a vertex | cycles a face | 10 | 12 | 16 | 24 | 32 | 64 | meshopt's NVIDIA | AMD | Intel | time |"
    );
    println!("|---|---|{}", "--:|".repeat(CARD + OTHERS + 1));
    let orders = orders(most);
    let mut logs = vec![[0.0; CARD + OTHERS + 1]; orders.len()];
    for (name, mesh) in &meshes {
        let (meshopt, vcache) = timed(|| Meshopt::VertexCache.ordered(mesh));
        let vcache =
            Mesh::connectivity_only(mesh.vertex_count(), vcache).map_err(|e| e.to_string())?;
        for ((order, make), logs) in orders.iter().zip(&mut logs) {
            let (seconds, faces) = timed(|| make(mesh, &vcache));
            let row = row(mesh.vertex_count(), &faces, seconds / meshopt);
            print(name, order, &row);
            for (log, figure) in logs.iter_mut().zip(row) {
                *log += figure.max(1e-9).ln();
            }
        }
    }
    for ((order, _), logs) in orders.iter().zip(&logs) {
        print(
            "**geometric mean**",
            order,
            &logs.map(|log| (log / meshes.len() as f64).exp()),
        );
    }
    Ok(())
}

fn row(vertex_count: usize, faces: &[[u32; 3]], time: f64) -> [f64; CARD + OTHERS + 1] {
    let mesh = Mesh::connectivity_only(vertex_count, faces.to_vec()).expect("indices in range");
    let counts = nvidia::counts(&mesh);
    let report = meshweft::cache::report(&mesh, CacheModel::Nvidia);
    let mut row = [0.0; CARD + OTHERS + 1];
    row[0] = report.atvr();
    row[1] = counts.warps_over_floor();
    row[2] = counts.distinct_vertices as f64 / report.used_vertices as f64;
    row[3] = counts.setup_cycles as f64 / faces.len() as f64;
    for (cell, model) in row[CARD..].iter_mut().zip(other_caches()) {
        *cell = compare::figure(faces, model);
    }
    row[CARD + OTHERS] = time;
    row
}

fn print(mesh: &str, order: &str, row: &[f64]) {
    let cells: Vec<String> = row.iter().map(|figure| format!("{figure:.4}")).collect();
    println!("| {mesh} | {order} | {} |", cells.join(" | "));
}

type Make = Box<dyn Fn(&Mesh, &Mesh) -> Vec<[u32; 3]>>;

fn orders(most: Effort) -> Vec<(String, Make)> {
    let mut orders: Vec<(String, Make)> = vec![
        (
            "as in the file".to_owned(),
            Box::new(|mesh, _| mesh.faces().to_vec()),
        ),
        (
            "meshopt VertexCache".to_owned(),
            Box::new(|mesh, _| Meshopt::VertexCache.ordered(mesh)),
        ),
    ];
    // Its time is that of the pass alone.
    orders.push((
        "the same, faces moved inside batches".to_owned(),
        Box::new(|_, vcache| {
            let order = FaceOrder::identity(vcache.face_count());
            InBatches::ALONE
                .follow(vcache, &order)
                .apply(vcache.faces())
        }),
    ));
    for target in [Target::Universal, CacheModel::Nvidia.into()] {
        for effort in [Effort::Fast, Effort::Best, Effort::Max] {
            if effort <= most {
                let optimizer = Optimizer {
                    target,
                    effort,
                    ..Optimizer::default()
                };
                orders.push((
                    format!("**{target} {effort}**"),
                    Box::new(move |mesh, _| optimizer.face_order(mesh).apply(mesh.faces())),
                ));
            }
        }
    }
    orders
}

/// A regular grid of so many vertices a side, row by row.
fn grid(side: u32) -> Mesh {
    let square = |i: u32| {
        let corner = i / (side - 1) * side + i % (side - 1);
        let above = corner + side;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    let faces: Vec<[u32; 3]> = (0..(side - 1) * (side - 1)).flat_map(square).collect();
    Mesh::connectivity_only((side * side) as usize, faces).expect("indices in range")
}
