//! Prints misses and time of our linear-speed optimisation over those of meshoptimizer's
//! `optimizeVertexCache`, whose order it is, one thread, as Markdown.
//!
//! ```text
//! cargo run --release --bin linear_speed -- [mesh files]   every mesh of the test data by default
//! ```
//!
//! Each job goes from faces to newly allocated faces in another order. Repetitions are interleaved and the
//! median is taken.

use std::path::PathBuf;
use std::process::ExitCode;

use compare::rivals::Meshopt;
use compare::timing;
use meshweft::order::{Target, baselines};
use meshweft::{Mesh, cache};

fn main() -> ExitCode {
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let files = std::env::args().skip(1).map(PathBuf::from).collect();
    let files = compare::files_or(files, compare::mesh_files)?;
    let (vrml, files): (Vec<_>, Vec<_>) =
        files.into_iter().partition(|file| compare::is_vrml(file));
    println!(
        "| mesh | faces | most at a vertex | misses over meshoptimizer's: mean of nine caches | worst | \
         same order | ns a face | meshoptimizer | time over meshoptimizer's |"
    );
    println!("|---|{}", "--:|".repeat(8));

    let mut rows = Vec::new();
    for file in &files {
        let mesh = compare::oracle::read(file)?;
        rows.push(Row::measure(&compare::mesh_name(file), &mesh));
    }
    let times = || rows.iter().map(Row::time_over_theirs);
    let [in_mean, worst] = [
        rows.iter().map(|row| row.mean).sum::<f64>() / rows.len().max(1) as f64,
        rows.iter().map(|row| row.worst).fold(0.0, f64::max),
    ];
    let same = rows.iter().filter(|row| row.is_same_order).count();
    for (name, mesh) in extremes() {
        Row::measure(name, &mesh);
    }

    println!(
        "\n{} meshes: misses over meshoptimizer's {in_mean:.3} in the mean, {worst:.3} at worst; the same order \
         for {same}.\nTime over meshoptimizer's: median {:.2}x, greatest {:.2}x.",
        rows.len(),
        timing::median(times().collect()),
        times().fold(0.0, f64::max),
    );
    if !vrml.is_empty() {
        println!(
            "Left out, as VRML is not read here: {} mesh(es).",
            vrml.len()
        );
    }
    Ok(())
}

/// What is known of a mesh.
struct Row {
    mean: f64,
    worst: f64,
    is_same_order: bool,
    nanoseconds: [f64; 2],
}

impl Row {
    /// Measures and prints it.
    fn measure(name: &str, mesh: &Mesh) -> Self {
        let mut ours = || baselines::linear_speed(mesh).apply(mesh.faces());
        let mut theirs = || Meshopt::VertexCache.ordered(mesh);
        let ordered = [ours(), theirs()];
        let over = Target::UNIVERSAL.map(|model| {
            let [ours, theirs] =
                [&ordered[0], &ordered[1]].map(|faces| cache::misses(faces, model));
            ours as f64 / theirs as f64
        });

        // A few million faces in all: enough for a median.
        let face_count = mesh.face_count().max(1);
        let repetitions = (1_500_000 / face_count).clamp(3, 25) | 1;
        let seconds = timing::medians(repetitions, [&mut ours, &mut theirs]);
        let row = Self {
            mean: over.iter().sum::<f64>() / over.len() as f64,
            worst: over.into_iter().fold(0.0, f64::max),
            is_same_order: ordered[0] == ordered[1],
            nanoseconds: seconds.map(|seconds| seconds * 1e9 / face_count as f64),
        };
        let [our_time, their_time] = row.nanoseconds;
        println!(
            "| {name} | {} | {} | {:.3} | {:.3} | {} | {our_time:.0} | {their_time:.0} | {:.2}x |",
            mesh.face_count(),
            most_faces_at_a_vertex(mesh),
            row.mean,
            row.worst,
            if row.is_same_order { "yes" } else { "no" },
            row.time_over_theirs(),
        );
        row
    }

    fn time_over_theirs(&self) -> f64 {
        self.nanoseconds[0] / self.nanoseconds[1]
    }
}

fn most_faces_at_a_vertex(mesh: &Mesh) -> u32 {
    let mut counts = vec![0_u32; mesh.vertex_count()];
    for &vertex in mesh.faces().as_flattened() {
        counts[vertex as usize] += 1;
    }
    counts.into_iter().max().unwrap_or_default()
}

/// Meshes whose vertices have very many faces, where meshoptimizer's time grows with the square.
fn extremes() -> [(&'static str, Mesh); 5] {
    let fan = |count: u32| (0..count).map(move |i| [0, 1 + i, 1 + (i + 1) % count]);
    let mesh = |vertex_count: usize, faces: Vec<[u32; 3]>| {
        Mesh::connectivity_only(vertex_count, faces).expect("it names its own vertices")
    };
    let draws = baselines::random(60_000, 1);
    let soup = draws.new_to_old().as_chunks().0;
    let soup = soup
        .iter()
        .map(|face: &[u32; 3]| face.map(|vertex| vertex % 60));
    [
        ("fan", mesh(10_001, fan(10_000).collect())),
        ("fan", mesh(100_001, fan(100_000).collect())),
        ("one face repeated", mesh(3, vec![[0, 1, 2]; 20_000])),
        ("one point repeated", mesh(1, vec![[0, 0, 0]; 20_000])),
        ("soup", mesh(60, soup.collect())),
    ]
}
