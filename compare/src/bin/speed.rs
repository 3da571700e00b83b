//! Times the fast mode against meshoptimizer, one thread, all in one run, as Markdown.
//!
//! ```text
//! cargo run --release --bin speed -- [mesh files]   five meshes of the test data by default
//!   --all      every mesh of the test data, and the smallest ratios
//!   --growth   nanoseconds per face at 1 and 10 million faces
//!   --memory   scratch bytes per face
//! ```
//!
//! Each job goes from faces to newly allocated faces in another order. Repetitions are interleaved
//! and the median is taken. A small mesh that is ordered repeatedly flatters every program: the
//! processor learns its branches.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use compare::counting::{Counting, with_peak};
use compare::rivals::Meshopt;
use compare::timing;
use meshweft::order::{KCacheReorder, baselines};
use meshweft::{CacheModel, FaceOrder, Mesh, VertexOrder, cache};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const SIZES: [u32; 3] = [12, 16, 32];

fn main() -> ExitCode {
    let (flags, files): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|a| a.starts_with("--"));
    let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
    let known = ["--all", "--growth", "--memory"];
    if let Some(unknown) = flags.iter().find(|flag| !known.contains(flag)) {
        eprintln!("{unknown} is not one of {known:?}");
        return ExitCode::from(2);
    }
    if flags.contains(&"--growth") {
        growth();
        return ExitCode::SUCCESS;
    }
    let files = files.into_iter().map(PathBuf::from).collect();
    let default = match flags.contains(&"--all") {
        true => compare::mesh_files,
        false => compare::default_mesh_files,
    };
    let files = match compare::files_or(files, default) {
        Ok(files) => files,
        Err(error) => return compare::exit_code(Err(error)),
    };
    let (vrml, files): (Vec<_>, Vec<_>) =
        files.into_iter().partition(|file| compare::is_vrml(file));
    let result = match flags.contains(&"--memory") {
        true => memory(&files),
        false => speed(&files),
    };
    if !vrml.is_empty() {
        println!(
            "Left out, as VRML is not read here: {} mesh(es).",
            vrml.len()
        );
    }
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn fast(size: u32) -> KCacheReorder {
    KCacheReorder {
        cache: CacheModel::fifo(size),
        ..Default::default()
    }
}

/// The same surface with faces and vertices in a random order.
fn shuffled(mesh: &Mesh) -> Mesh {
    let vertices = VertexOrder::from(baselines::random(mesh.vertex_count(), 1));
    let faces = FaceOrder::from(baselines::random(mesh.face_count(), 2));
    mesh.with_vertex_order(&vertices).with_face_order(&faces)
}

/// One row of figures: ours, meshoptimizer's main optimizer, its Tipsify.
struct Row {
    label: String,
    acmr: [f64; 3],
    nanoseconds: [f64; 3],
    /// Ours without putting the faces into the order that was found.
    order_alone: f64,
}

impl Row {
    fn measure(label: String, mesh: &Mesh, size: u32, repetitions: usize) -> Self {
        let faces = mesh.faces();
        let algorithm = fast(size);
        let mut ours = || algorithm.face_order(mesh).apply(faces);
        let mut vertex_cache = || Meshopt::VertexCache.ordered(mesh);
        let mut tipsify = || Meshopt::Fifo(size).ordered(mesh);
        let mut order_alone = || {
            let _ = std::hint::black_box(algorithm.face_order(mesh));
            Vec::new()
        };
        let acmr = [ours(), vertex_cache(), tipsify()]
            .map(|ordered| cache::acmr(&ordered, CacheModel::fifo(size)));
        let seconds = timing::medians(
            repetitions,
            [&mut ours, &mut vertex_cache, &mut tipsify, &mut order_alone],
        );
        let [ours, vertex_cache, tipsify, order_alone] =
            seconds.map(|s| s * 1e9 / faces.len().max(1) as f64);
        Self {
            label,
            acmr,
            nanoseconds: [ours, vertex_cache, tipsify],
            order_alone,
        }
    }

    /// How many times longer meshoptimizer's main optimizer takes than ours.
    fn against_vertex_cache(&self) -> f64 {
        self.nanoseconds[1] / self.nanoseconds[0]
    }

    fn against_tipsify(&self) -> f64 {
        self.nanoseconds[2] / self.nanoseconds[0]
    }

    fn print(&self) {
        let [ours, vertex_cache, tipsify] = self.acmr;
        let [our_time, their_time, tipsify_time] = self.nanoseconds;
        println!(
            "| {} | {ours:.3} | {vertex_cache:.3} | {tipsify:.3} | {our_time:.0} | {:.0} | \
             {their_time:.0} | {tipsify_time:.0} | {:.2} | {:.2} |",
            self.label,
            self.order_alone,
            self.against_vertex_cache(),
            self.against_tipsify(),
        );
    }

    fn print_title() {
        println!(
            "| mesh | faces | K | ACMR ours | meshopt | Tipsify | ns per face ours | \
             for the order alone | meshopt | Tipsify | meshopt / ours | Tipsify / ours |"
        );
        println!("|---|{}", "--:|".repeat(11));
    }

    /// The mean of each figure of the rows, ratios of the mean times included.
    fn mean(label: String, rows: &[Self]) -> Self {
        let mean = |figure: &dyn Fn(&Self) -> f64| {
            rows.iter().map(figure).sum::<f64>() / rows.len().max(1) as f64
        };
        Self {
            label,
            acmr: [0, 1, 2].map(|i| mean(&|row| row.acmr[i])),
            nanoseconds: [0, 1, 2].map(|i| mean(&|row| row.nanoseconds[i])),
            order_alone: mean(&|row| row.order_alone),
        }
    }
}

fn speed(files: &[PathBuf]) -> Result<(), String> {
    for arrangement in ["in file order", "shuffled"] {
        println!("### Faces and vertices {arrangement}\n");
        Row::print_title();
        let mut rows = SIZES.map(|size| (size, Vec::new()));
        for file in files {
            let mut mesh = compare::oracle::read(file)?;
            if arrangement == "shuffled" {
                mesh = shuffled(&mesh);
            }
            for (size, rows) in &mut rows {
                let row = measured(file, &mesh, *size);
                row.print();
                rows.push(row);
            }
        }
        for (size, rows) in &rows {
            Row::mean(format!("mean of {} | | {size}", rows.len()), rows).print();
        }
        println!();
        for (size, rows) in &rows {
            let ratios = |ratio: fn(&Row) -> f64| rows.iter().map(ratio);
            let least = |ratio: fn(&Row) -> f64| ratios(ratio).fold(f64::INFINITY, f64::min);
            println!(
                "K={size}: median of the ratios meshopt / ours {:.2}, Tipsify / ours {:.2}; \
                 smallest {:.2} and {:.2}; ACMR above meshopt's on {} of {}.",
                timing::median(ratios(Row::against_vertex_cache).collect()),
                timing::median(ratios(Row::against_tipsify).collect()),
                least(Row::against_vertex_cache),
                least(Row::against_tipsify),
                rows.iter().filter(|row| row.acmr[0] > row.acmr[1]).count(),
                rows.len(),
            );
        }
        println!();
    }
    Ok(())
}

fn measured(file: &Path, mesh: &Mesh, size: u32) -> Row {
    let name = compare::mesh_name(file);
    let label = format!("{name} | {} | {size}", mesh.face_count());
    // A few million faces in all: enough for a median, and the largest mesh five times.
    let repetitions = (1_500_000 / mesh.face_count().max(1)).clamp(5, 25) | 1;
    Row::measure(label, mesh, size, repetitions)
}

fn memory(files: &[PathBuf]) -> Result<(), String> {
    println!("| mesh | faces | vertices | K | scratch bytes per face |");
    println!("|---|--:|--:|--:|--:|");
    for file in files {
        let mesh = compare::oracle::read(file)?;
        for (cache, size) in SIZES.map(|size| (CacheModel::fifo(size), size)) {
            let algorithm = KCacheReorder {
                cache,
                ..Default::default()
            };
            println!(
                "| {} | {} | {} | {size} | {:.2} |",
                compare::mesh_name(file),
                mesh.face_count(),
                mesh.vertex_count(),
                scratch_bytes_per_face(&algorithm, &mesh),
            );
        }
    }
    println!(
        "\nThe most in use at once, less the result: 4 bytes a face for the permutation and 1"
    );
    println!("for the rotation.");
    Ok(())
}

fn scratch_bytes_per_face(algorithm: &KCacheReorder, mesh: &Mesh) -> f64 {
    let (order, peak) = with_peak(|| algorithm.face_order(mesh));
    let result = order.new_to_old().len() * 4 + order.rotations().len();
    (peak - result) as f64 / mesh.face_count().max(1) as f64
}

fn growth() {
    println!("A square grid, the diagonal of each quad at random.\n");
    Row::print_title();
    let mut rows = Vec::new();
    for arrangement in ["in blocks", "shuffled"] {
        for side in [707, 2236] {
            let mut mesh = compare::irregular_grid(side);
            if arrangement == "shuffled" {
                mesh = shuffled(&mesh);
            }
            let label = format!("{arrangement} | {} | 12", mesh.face_count());
            let row = Row::measure(label, &mesh, 12, 3);
            row.print();
            rows.push(row);
        }
    }
    println!();
    for (arrangement, rows) in ["in blocks", "shuffled"].iter().zip(rows.chunks(2)) {
        let ratio = |i: usize| rows[1].nanoseconds[i] / rows[0].nanoseconds[i];
        println!(
            "{arrangement}: nanoseconds per face at 10 million over 1 million faces: \
             ours {:.2}, meshopt {:.2}, Tipsify {:.2}.",
            ratio(0),
            ratio(1),
            ratio(2),
        );
    }
    let mesh = compare::irregular_grid(2236);
    let scratch = scratch_bytes_per_face(&fast(12), &mesh);
    println!("Scratch at 10 million faces: {scratch:.2} bytes per face.");
}
