//! Prints misses per face and per vertex of every order that can be compared, and the time each took,
//! as Markdown.
//!
//! ```text
//! cargo run --release --bin quality -- [--only TEXT]... [mesh files]
//! ```
//!
//! `--only` leaves out the orders whose name has none of the texts. Without files it takes five meshes
//! of the test data.

use std::path::PathBuf;
use std::process::ExitCode;

use compare::rivals::{self, Meshopt};
use compare::timing::timed;
use meshweft::order::bogomjakov_gotsman::{Cutter, RecursiveCut};
use meshweft::order::{Effort, KCacheReorder, Mode, Optimizer, Target, baselines};
use meshweft::{CacheModel, FaceOrder, Mesh};

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let (mut only, mut files) = (Vec::new(), Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--only" => only.push(arguments.next().ok_or("--only needs a text")?),
            _ => files.push(PathBuf::from(argument)),
        }
    }
    let files = compare::files_or(files, compare::default_mesh_files)?;
    println!(
        "| mesh | order | K=10 | 12 | 16 | 24 | 32 | 64 | NVIDIA | AMD | Intel | Mfaces/s | time |"
    );
    println!("|---|---|{}", "--:|".repeat(Target::UNIVERSAL.len() + 2));
    let orders = orders();
    let mut sums = vec![[0.0; Target::UNIVERSAL.len() + 1]; orders.len()];
    for file in &files {
        let mesh = compare::oracle::read(file).map_err(|error| error.to_string())?;
        let name = compare::mesh_name(file);
        let (meshopt, _) = timed(|| Meshopt::VertexCache.ordered(&mesh));
        for ((order, make), sums) in orders.iter().zip(&mut sums) {
            if !only.is_empty() && !only.iter().any(|text| order.contains(text)) {
                continue;
            }
            let (seconds, faces) = timed(|| make(&mesh));
            let figures = Target::UNIVERSAL.map(|model| compare::figure(&faces, model));
            let time = seconds / meshopt;
            for (sum, figure) in sums.iter_mut().zip(figures.into_iter().chain([time])) {
                *sum += figure / files.len() as f64;
            }
            let speed = mesh.face_count() as f64 / seconds / 1e6;
            println!(
                "| {name} | {order} | {} | {speed:.2} | {time:.2}x |",
                cells(&figures)
            );
        }
    }
    for ((order, _), means) in orders.iter().zip(&sums) {
        let [figures @ .., time] = means;
        if *time > 0.0 {
            println!("| **mean** | {order} | {} | | {time:.2}x |", cells(figures));
        }
    }
    println!();
    println!("K: misses per face (ACMR) of a FIFO cache. NVIDIA, AMD, Intel: misses per vertex");
    println!(
        "(ATVR): NVIDIA as probed on cards, the others as meshoptimizer's analyzer has them. Time on one"
    );
    println!("thread, as a multiple of `meshopt_optimizeVertexCache`'s on the same mesh.");
    Ok(())
}

fn cells(figures: &[f64]) -> String {
    let cells: Vec<String> = figures.iter().map(|f| format!("{f:.3}")).collect();
    cells.join(" | ")
}

type Make = Box<dyn Fn(&Mesh) -> Vec<[u32; 3]>>;

fn ours(order: impl Fn(&Mesh) -> FaceOrder + 'static) -> Make {
    Box::new(move |mesh| order(mesh).apply(mesh.faces()))
}

fn orders() -> Vec<(String, Make)> {
    let meshopt = |order: Meshopt| -> Make { Box::new(move |mesh| order.ordered(mesh)) };
    let mut orders: Vec<(String, Make)> = vec![
        (
            "as in the file".to_owned(),
            Box::new(|mesh| mesh.faces().to_vec()),
        ),
        (
            "random".to_owned(),
            ours(|mesh| baselines::random(mesh.face_count(), 1).into()),
        ),
        (
            "forsyth 1.0.1".to_owned(),
            Box::new(|mesh| rivals::forsyth(mesh.faces())),
        ),
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
        let name = format!("Tipsify, ours, K={size}");
        orders.push((name, ours(move |mesh| baselines::tipsify(mesh, size))));
    }
    orders.push((
        "linear-speed, ours".to_owned(),
        ours(|mesh| baselines::linear_speed(mesh)),
    ));
    for cutter in [Cutter::Metis, Cutter::Multilevel] {
        let algorithm = RecursiveCut {
            cutter,
            ..RecursiveCut::default()
        };
        let name = match cutter {
            Cutter::Multilevel => "**recursive cut**",
            _ => "recursive cut by METIS",
        };
        orders.push((
            name.to_owned(),
            ours(move |mesh| algorithm.face_order(mesh)),
        ));
    }
    for size in [10, 12, 16, 32] {
        for mode in [Mode::Fast, Mode::Faithful] {
            if mode == Mode::Faithful && ![12, 16].contains(&size) {
                continue;
            }
            let algorithm = KCacheReorder {
                cache: CacheModel::fifo(size),
                mode,
                ..KCacheReorder::default()
            };
            let name = match mode {
                Mode::Faithful => format!("K-Cache-Reorder, faithful, K={size}"),
                _ => format!("K-Cache-Reorder, K={size}"),
            };
            orders.push((name, ours(move |mesh| algorithm.face_order(mesh))));
        }
    }
    for target in ["universal", "fifo:12", "fifo:32", "nvidia", "amd", "intel"] {
        for (effort, word) in [(Effort::Fast, ""), (Effort::Best, ", best")] {
            let optimizer = Optimizer {
                target: target.parse().expect("a target"),
                effort,
                ..Optimizer::default()
            };
            let name = format!("**{target}{word}**");
            orders.push((name, ours(move |mesh| optimizer.face_order(mesh))));
        }
    }
    orders
}
