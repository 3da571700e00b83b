//! What two threads gain on a large mesh, and how time and memory grow, as Markdown.
//!
//! ```text
//! cargo run --release --bin threads -- [mesh file]   the Stanford dragon of the test data by default
//! cargo run --release --bin threads -- --growth      1 and 10 million faces
//! ```

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use compare::counting::{Counting, with_peak};
use meshweft::order::bogomjakov_gotsman::RecursiveCut;
use meshweft::order::{Effort, Optimizer, Target};
use meshweft::{FaceOrder, Mesh, cache};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let argument = std::env::args().nth(1);
    if argument.as_deref() == Some("--growth") {
        return growth();
    }
    let file = argument.map(PathBuf::from).into_iter().collect();
    let files = compare::files_or(file, |data| {
        compare::named_mesh_files(data, &["dragon.ply.gz"])
    })?;
    let mesh = compare::oracle::read(&files[0]).map_err(|error| error.to_string())?;
    println!("| order | seconds, one thread | two threads | gain | same output |");
    println!("|---|--:|--:|--:|---|");
    for (name, order) in orders() {
        let [one, two] = [1, 2].map(|threads| timed(threads, &*order, &mesh));
        let [one, two] = [one?, two?];
        println!(
            "| {name} | {:.2} | {:.2} | {:.2}x | {} |",
            one.seconds,
            two.seconds,
            one.seconds / two.seconds,
            if one.order == two.order { "yes" } else { "NO" },
        );
    }
    Ok(())
}

type Order = Box<dyn Fn(&Mesh) -> FaceOrder + Sync>;

fn orders() -> Vec<(String, Order)> {
    let mut orders: Vec<(String, Order)> = Vec::new();
    for (target, effort) in [
        ("universal", Effort::Fast),
        ("universal", Effort::Best),
        ("fifo:12", Effort::Best),
        ("nvidia", Effort::Best),
    ] {
        let optimizer = Optimizer {
            target: target.parse().expect("a target"),
            effort,
            ..Optimizer::default()
        };
        let name = format!("{target}, {effort:?}").to_lowercase();
        orders.push((name, Box::new(move |mesh| optimizer.face_order(mesh))));
    }
    let cut = RecursiveCut::default();
    orders.push((
        "recursive cut".to_owned(),
        Box::new(move |mesh| cut.face_order(mesh)),
    ));
    orders
}

struct Timed {
    seconds: f64,
    order: FaceOrder,
    peak: usize,
}

/// The median of three runs.
fn timed(
    threads: usize,
    order: &(dyn Fn(&Mesh) -> FaceOrder + Sync),
    mesh: &Mesh,
) -> Result<Timed, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| error.to_string())?;
    let mut seconds = Vec::new();
    loop {
        let start = Instant::now();
        let (order, peak) = with_peak(|| pool.install(|| order(mesh)));
        seconds.push(start.elapsed().as_secs_f64());
        if seconds.len() == 3 {
            let seconds = compare::timing::median(seconds);
            return Ok(Timed {
                seconds,
                order,
                peak,
            });
        }
    }
}

fn growth() -> Result<(), String> {
    println!("The universal order, fast, on two threads: a square grid in blocks, the diagonal of");
    println!("each quad at random.\n");
    println!(
        "| faces | nanoseconds a face | bytes a face at once, result and input included | mean ACMR |"
    );
    println!("|--:|--:|--:|--:|");
    for side in [707, 2236] {
        let mesh = compare::irregular_grid(side);
        let optimizer = Optimizer::default();
        let found = timed(2, &|mesh: &Mesh| optimizer.face_order(mesh), &mesh)?;
        let faces = mesh.face_count() as f64;
        let input = 12.0 + 12.0 * mesh.vertex_count() as f64 / faces;
        let ordered = found.order.apply(mesh.faces());
        let acmr = Target::UNIVERSAL[..6]
            .iter()
            .map(|&model| cache::acmr(&ordered, model));
        println!(
            "| {} | {:.0} | {:.1} | {:.4} |",
            mesh.face_count(),
            found.seconds * 1e9 / faces,
            found.peak as f64 / faces + input,
            acmr.sum::<f64>() / 6.0,
        );
    }
    Ok(())
}
