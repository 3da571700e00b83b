//! Vertices in blocks of 65,536 and faces ordered block by block, as Markdown.
//!
//! ```text
//! cargo run --release --bin blocks -- [mesh files]
//! ```
//!
//! Every mesh of the test data with more than 65,536 vertices by default, each as it is stored. The
//! first table is of the numbering, the second of the orders on it: warps and invocations of
//! NVIDIA's model, warps over the fewest there can be, and misses per face of a FIFO cache of 16,
//! beside the same orders of the numbering by first use alone, and meshoptimizer's. One thread.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use compare::rivals::Meshopt;
use compare::timing::timed;
use meshweft::cache::{self, nvidia};
use meshweft::order::{Effort, Optimizer, Target, vertex_blocks, vertex_fetch};
use meshweft::{CacheModel, Faces, Mesh, Permutation, VertexOrder};

/// Bytes of a vertex record.
const VERTEX_SIZE: usize = 32;
/// Vertices in a block.
const BLOCK: usize = 1 << 16;

fn main() -> ExitCode {
    compare::one_thread();
    compare::exit_code(run())
}

fn run() -> Result<(), String> {
    let files = std::env::args().skip(1).map(PathBuf::from).collect();
    let files = compare::files_or(files, |data| {
        let mut files = compare::mesh_files(data);
        // VRML is not read here, and of those no mesh is large.
        files.retain(|file| !compare::is_vrml(file));
        files
    })?;
    let mut meshes = compare::read_meshes(&files)?;
    meshes.retain(|(_, mesh)| mesh.vertex_count() > BLOCK);

    println!(
        "| mesh | faces | across, stored | across, blocks | overfetch, first use | overfetch, blocks | time of universal fast | of nvidia best |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    for (name, mesh) in &meshes {
        numbering(name, mesh);
    }
    println!(
        "\n| mesh | order | numbered | warps / least | invocations / vertex | FIFO-16 | overfetch |"
    );
    println!("|---|---|---|--:|--:|--:|--:|");
    for (name, mesh) in &meshes {
        orders(name, mesh);
    }
    Ok(())
}

fn optimizer(target: Target, effort: Effort) -> Optimizer {
    Optimizer {
        target,
        effort,
        ..Optimizer::default()
    }
}

/// A row of the numbering alone.
fn numbering(name: &str, mesh: &Mesh) {
    let (seconds, blocks) = timed(|| vertex_blocks(mesh));
    let in_blocks = renumbered(mesh, &blocks);
    let (fast, order) = timed(|| optimizer(Target::Universal, Effort::Fast).face_order(&in_blocks));
    let start = Instant::now();
    let best = optimizer(CacheModel::Nvidia.into(), Effort::Best).face_order(&in_blocks);
    let best = (start.elapsed().as_secs_f64(), best).0;

    let drawn = in_blocks.with_face_order(&order);
    let [plain, in_blocks_fetched] = [by_first_use(&drawn), vertex_fetch(&drawn)]
        .map(|order| cache::overfetch(&renumbered(&drawn, &order), VERTEX_SIZE));
    println!(
        "| {name} | {} | {:.2} % | {:.2} % | {plain:.3} | {in_blocks_fetched:.3} | {:.2}x | {:.3}x |",
        mesh.face_count(),
        across(mesh),
        across(&in_blocks),
        seconds / fast,
        seconds / best,
    );
}

/// Rows of the orders.
fn orders(name: &str, mesh: &Mesh) {
    let rows = [
        ("universal fast", optimizer(Target::Universal, Effort::Fast)),
        ("universal best", optimizer(Target::Universal, Effort::Best)),
        (
            "nvidia best",
            optimizer(CacheModel::Nvidia.into(), Effort::Best),
        ),
        (
            "fifo:12 fast",
            optimizer(CacheModel::fifo(12).into(), Effort::Fast),
        ),
    ];
    let rival = Mesh::connectivity_only(mesh.vertex_count(), Meshopt::VertexCache.ordered(mesh));
    let rival = rival.expect("the same faces");
    row(
        name,
        "meshoptimizer",
        "first use",
        &renumbered(&rival, &by_first_use(&rival)),
    );
    for (what, optimizer) in rows {
        // Scattered numbers are in no blocks, so the order does not keep to any.
        let random = Permutation::random(mesh.vertex_count(), 1).into();
        let scattered = renumbered(mesh, &random);
        let plain = scattered.with_face_order(&optimizer.face_order(&scattered));
        row(
            name,
            what,
            "first use",
            &renumbered(&plain, &by_first_use(&plain)),
        );

        let in_blocks = renumbered(mesh, &vertex_blocks(mesh));
        let drawn = in_blocks.with_face_order(&optimizer.face_order(&in_blocks));
        row(
            name,
            what,
            "blocks",
            &renumbered(&drawn, &vertex_fetch(&drawn)),
        );
    }
}

fn row(name: &str, what: &str, numbered: &str, mesh: &Mesh) {
    let counts = nvidia::counts(mesh);
    println!(
        "| {name} | {what} | {numbered} | {:.4} | {:.3} | {:.4} | {:.3} |",
        counts.warps_over_floor(),
        counts.invocations as f64 / mesh.vertex_count() as f64,
        cache::acmr(mesh, CacheModel::fifo(16)),
        cache::overfetch(mesh, VERTEX_SIZE),
    );
}

/// The share of faces with vertices of several blocks, in per cent.
fn across(mesh: &Mesh) -> f64 {
    let is_across = |face: &&[u32; 3]| face.iter().any(|v| v >> 16 != face[0] >> 16);
    let count = mesh.faces().iter().filter(is_across).count();
    100.0 * count as f64 / mesh.face_count() as f64
}

fn renumbered(mesh: &Mesh, order: &VertexOrder) -> Mesh {
    let faces = order.renumber(mesh.faces());
    Mesh::connectivity_only(mesh.vertex_count(), faces).expect("a permutation of the vertices")
}

/// First use alone, without blocks.
fn by_first_use(mesh: &Mesh) -> VertexOrder {
    let mut seen = vec![false; mesh.vertex_count()];
    let all = 0..u32::try_from(mesh.vertex_count()).expect("a mesh counts in 32 bits");
    let uses = Faces::from(mesh)
        .as_slice()
        .as_flattened()
        .iter()
        .copied()
        .chain(all);
    let new_to_old = uses.filter(|&vertex| !std::mem::replace(&mut seen[vertex as usize], true));
    Permutation::new(new_to_old.collect())
        .expect("each vertex once")
        .into()
}
