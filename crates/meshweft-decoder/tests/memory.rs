//! How much memory a decoder needs beyond what it gives, as Markdown: fails where that is above 64 KiB and 256 bytes for
//! each vertex of the buffer that minimum-time rendering needs.
//!
//! A mesh arrives in pieces, and what is complete is taken after each. Vertices and faces that wait to be taken are
//! output, by their number; what a decoder reserves for more of them is not. The piece itself is the caller's. Pieces are
//! small, as one that holds several blocks brings the output of all at once, and arrays that grow by it.

use std::path::PathBuf;
use std::process::ExitCode;

use counting::{Counting, in_use, with_peak};
use meshweft::compression::{CodeOptions, MeshCode, MeshDecoder, PositionCoding, Tier};
use meshweft::connectivity::{FirstVertex, MinimumTimeRendering};
use meshweft::files::{Document, ReadOptions};
use meshweft::geometry::Lattice;
use meshweft::{Limits, Mesh};

#[expect(unreachable_pub, reason = "what `compare` counts with, as it is")]
#[path = "../../../compare/src/counting.rs"]
mod counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that arrive at once.
const PIECE: usize = 512;
/// Closed surfaces, one with borders, many parts, and edges of many faces.
const FILES: [&str; 6] = [
    "fandisk.off.gz",
    "bunny_clean.obj.gz",
    "horse.obj.gz",
    "nefertiti.obj.gz",
    "cow_poly.obj.gz",
    "sextant.wrl.gz",
];

fn main() -> ExitCode {
    println!(
        "| mesh | faces | tier | positions | b | beyond the output | allowed | bytes for each of b |"
    );
    println!("|---|--:|---|---|--:|--:|--:|--:|");
    let mut meshes = vec![("grid of 700 x 700".to_owned(), grid(700))];
    match data_folder() {
        Some(folder) => {
            for name in FILES {
                let document = Document::open(&folder.join(name), ReadOptions::default());
                let document = document.expect("the test data can be read");
                let largest = document.meshes().iter().enumerate();
                let largest = largest.max_by_key(|(_, entry)| entry.mesh.face_count());
                let (number, entry) = largest.expect("a mesh");
                let positions = document.positions(number).expect("positions that are read");
                let positions = positions.expect("a mesh with positions");
                let mesh = Mesh::new(positions, entry.mesh.faces().to_vec());
                meshes.push((name.to_owned(), mesh.expect("as it was read")));
            }
        }
        None => println!("SKIPPED: real meshes, as there is no test data"),
    }

    let (mut count, mut above) = (0, 0);
    for (name, mesh) in &meshes {
        let lattice = Lattice::of_bits(mesh.positions().to_vec(), 14).expect("14 bits");
        for &tier in Tier::ALL {
            for positions in [PositionCoding::Lossless, PositionCoding::OnLattice(lattice)] {
                count += 1;
                above += usize::from(!is_within(name, mesh, tier, positions));
            }
        }
    }
    println!("memory: {count} streams decoded, {above} need more than is allowed");
    match above {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}

/// Decodes a mesh and prints its row; whether it needs no more than is allowed.
fn is_within(name: &str, mesh: &Mesh, tier: Tier, positions: PositionCoding) -> bool {
    let options = CodeOptions {
        tier,
        positions,
        first_vertex: FirstVertex::MinBuffer.choose(mesh).expect("a small mesh"),
        ..CodeOptions::default()
    };
    let code = MeshCode::new(mesh, &options).expect("finite positions");
    let decoded = MeshCode::decode(code.bytes(), Limits::default()).expect("what was written");
    let buffer = MinimumTimeRendering::new(&decoded).buffer_size();

    // What is allocated, but for the output.
    let before = in_use();
    let mut decoder = MeshDecoder::new(Limits::default());
    let (mut most, mut face_count) = (0, 0);
    for piece in code.bytes().chunks(PIECE) {
        let kept = in_use() - before;
        let (used, more) = with_peak(|| decoder.push(piece));
        used.expect("what was written");
        let (positions, faces) = (decoder.take_positions(), decoder.take_faces());
        let output = size_of_val(&positions[..]) + size_of_val(&faces[..]);
        most = most.max((kept + more).saturating_sub(output));
        face_count += faces.len();
    }
    decoder.finish().expect("what was written");
    assert_eq!(face_count, mesh.face_count());

    let allowed = (64 << 10) + 256 * buffer;
    let coding = match positions {
        PositionCoding::Lossless => "lossless",
        _ => "14 bits",
    };
    println!(
        "| {name} | {face_count} | {tier:?} | {coding} | {buffer} | {most} | {allowed} | {:.0} |",
        most as f64 / buffer as f64
    );
    most <= allowed
}

/// Hills on a square.
fn grid(width: u32) -> Mesh {
    let height = |x: u32, y: u32| ((x * x + 3 * y) % 17) as f32 / 8.0;
    let positions = (0..width * width).map(|i| {
        let (x, y) = (i % width, i / width);
        [x as f32, y as f32, height(x, y)]
    });
    let squares = (0..width * (width - 1)).filter(|i| i % width < width - 1);
    let faces = squares.flat_map(|a| [[a, a + 1, a + width + 1], [a, a + width + 1, a + width]]);
    Mesh::new(positions.collect::<Vec<_>>(), faces.collect::<Vec<_>>()).expect("a grid")
}

/// `MESHWEFT_DATA`, else beside the checkout.
fn data_folder() -> Option<PathBuf> {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MESHWEFT_DATA").map_or(beside, PathBuf::from);
    let folder = folder.join("meshes");
    let is_required = std::env::var_os("MESHWEFT_REQUIRE_DATA").is_some();
    assert!(folder.is_dir() || !is_required, "no test data");
    folder.is_dir().then_some(folder)
}
