//! Memory and processor time a face, as meshes get larger.

use std::path::PathBuf;

use compare::counting::with_peak;
use compare::process;
use meshweft::Mesh;
use meshweft::order::Effort;
use meshweft::progressive::Collapses;

/// Cells a side: 1 and 10 million faces.
const SIDES: [u32; 2] = [707, 2236];
const EFFORTS: [(&str, Effort); 2] = [("fast", Effort::Fast), ("best", Effort::Best)];

/// Prints a row an effort and mesh: made ones of 1 and 10 million faces, or those that are named.
pub(crate) fn print(files: &[PathBuf]) -> Result<(), String> {
    println!("| mesh | faces | effort | faces left | bytes a face | microseconds a face |");
    println!("|---|--:|---|--:|--:|--:|");
    for file in files {
        let mesh = compare::in_greedy_order(&compare::read_as_one(file)?, 11);
        for (name, effort) in EFFORTS {
            row(&compare::mesh_name(file), &mesh, name, effort)?;
        }
    }
    if !files.is_empty() {
        return Ok(());
    }
    let mut times = [[0.0; 2]; 2];
    for (side, times) in SIDES.into_iter().zip(&mut times) {
        let mesh = hills(side);
        for ((name, effort), time) in EFFORTS.into_iter().zip(times) {
            *time = row("hills", &mesh, name, effort)?;
        }
    }
    println!();
    for (i, (name, _)) in EFFORTS.into_iter().enumerate() {
        let ratio = times[1][i] / times[0][i];
        println!("{name}: time a face at 10 million over 1 million faces {ratio:.2}.");
    }
    Ok(())
}

/// Builds a mesh as far as it goes; returns the time a face.
fn row(name: &str, mesh: &Mesh, effort_name: &str, effort: Effort) -> Result<f64, String> {
    let settings = Collapses {
        effort,
        ..Collapses::default()
    };
    let start = process::own_seconds();
    let (built, peak) = with_peak(|| settings.build(mesh, &[]));
    let seconds = process::own_seconds() - start;
    let built = built.map_err(|error| error.to_string())?;
    let faces = mesh.face_count();
    let [bytes, seconds] = [peak as f64, seconds].map(|figure| figure / faces.max(1) as f64);
    println!(
        "| {name} | {faces} | {effort_name} | {} | {bytes:.1} | {:.2} |",
        built.face_count(built.last_level()),
        seconds * 1e6,
    );
    Ok(seconds * 1e6)
}

/// A square of cells with hills of several sizes, each cell cut along one diagonal or the other, in the
/// order for a cache.
fn hills(side: u32) -> Mesh {
    let columns = side + 1;
    let position = |vertex: u32| {
        let [x, y] = [vertex % columns, vertex / columns].map(|i| i as f32);
        let wave = |length: f32, height: f32| {
            height * (x / length).sin() * (y / length + x / (3.0 * length)).cos()
        };
        [x, y, wave(97.0, 30.0) + wave(11.0, 3.0) + wave(1.3, 0.3)]
    };
    let positions: Vec<[f32; 3]> = (0..columns * columns).map(position).collect();
    let cell = |at: u32| {
        let [x, y] = [at % side, at / side];
        let a = y * columns + x;
        let [b, c, d] = [a + 1, a + columns, a + columns + 1];
        match at.wrapping_mul(0x9e37_79b9) >> 31 {
            0 => [[a, b, d], [a, d, c]],
            _ => [[a, b, c], [c, b, d]],
        }
    };
    let faces: Vec<[u32; 3]> = (0..side * side).flat_map(cell).collect();
    compare::in_greedy_order(
        &Mesh::new(positions, faces).expect("a grid is in range"),
        11,
    )
}
