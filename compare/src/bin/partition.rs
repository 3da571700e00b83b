//! Edge cuts compared with METIS', both balanced to 3 %, as Markdown.
//!
//! ```text
//! cargo run --release --bin partition -- [mesh files]
//! ```
//!
//! The dual graphs of ten meshes of the test data by default. METIS is run both ways, by recursive
//! bisection and directly k-way, and the better of its cuts that keep the balance counts.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use meshweft::partition::{Graph, Metis, MetisError, Multilevel, edge_cut, imbalance};

const IMBALANCE: f64 = 1.03;
const PARTS: [u32; 6] = [2, 4, 8, 16, 32, 64];
const MESHES: [&str; 10] = [
    "fandisk.off.gz",
    "bunny.ply.gz",
    "horse.obj.gz",
    "nefertiti.obj.gz",
    "cow.off.gz",
    "spot.obj.gz",
    "lion_statue.obj.gz",
    "dragon_res2.ply.gz",
    "armadillo.obj.gz",
    "dragon.ply.gz",
];

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let files = std::env::args().skip(1).map(PathBuf::from).collect();
    let files = compare::files_or(files, |data| compare::named_mesh_files(data, &MESHES))?;
    println!(
        "| mesh | faces |{} time |",
        PARTS.map(|k| format!(" {k} |")).concat()
    );
    println!("|---|--:|{}--:|", "--:|".repeat(PARTS.len()));
    let (mut logarithms, mut count) = (0.0, 0);
    for file in files {
        let mesh = compare::oracle::read(&file).map_err(|error| error.to_string())?;
        let graph = Graph::dual(&mesh);
        let mut cells = String::new();
        let (mut seconds, mut metis_seconds) = (0.0, 0.0);
        for parts in PARTS {
            let start = Instant::now();
            let ours = Multilevel {
                parts,
                imbalance: IMBALANCE,
                ..Multilevel::default()
            }
            .partition(&graph);
            seconds += start.elapsed().as_secs_f64();
            let start = Instant::now();
            let theirs = metis_cut(&graph, parts).map_err(|error| error.to_string())?;
            metis_seconds += start.elapsed().as_secs_f64();
            // With few faces the mean is not a whole number.
            let least = graph.vertex_count().div_ceil(parts as usize) * parts as usize;
            let most = IMBALANCE.max(least as f64 / graph.vertex_count() as f64);
            let weight = imbalance(&graph, &ours, parts);
            if weight > most + 1e-9 {
                return Err(format!("{}: {weight} times the mean", file.display()));
            }
            let ratio = edge_cut(&graph, &ours) as f64 / theirs as f64;
            if theirs > 0 {
                logarithms += ratio.ln();
                count += 1;
            }
            cells += &format!(" {ratio:.3} ({theirs}) |");
        }
        let time = seconds / metis_seconds;
        println!(
            "| {} | {} |{cells} {time:.2}x |",
            compare::mesh_name(&file),
            mesh.face_count()
        );
    }
    let mean = (logarithms / f64::from(count)).exp();
    println!("\nOur cut over METIS' (in brackets); geometric mean {mean:.4}. Time over that of");
    println!("METIS' two calls together, one thread each.");
    Ok(())
}

/// The better of METIS' two cuts, of those balanced to [`IMBALANCE`] (of both if none is).
fn metis_cut(graph: &Graph, parts: u32) -> Result<u64, MetisError> {
    let mut cuts = Vec::new();
    for is_recursive in [true, false] {
        let metis = Metis {
            parts,
            imbalance: IMBALANCE,
            is_recursive,
            ..Metis::default()
        };
        let found = metis.partition(graph)?;
        let is_balanced = imbalance(graph, &found, parts) <= IMBALANCE + 1e-9;
        cuts.push((!is_balanced, edge_cut(graph, &found)));
    }
    let (_, cut) = cuts.into_iter().min().expect("two cuts");
    Ok(cut)
}
