//! How fast files are read, changed and written, and how much memory that takes.
//!
//!   cargo run --release --bin files [SIDE [FORMAT]]
//!
//! Makes a grid of SIDE × SIDE vertices (default 1000), its faces in rows, as GLB, binary PLY, binary
//! STL, OBJ and OFF, and puts each in the order that K-Cache-Reorder finds, on one thread. Prints
//! the medians of five interleaved rounds: megabytes of file per second for reading, for moving
//! records, for writing, and for all three; and the most memory in use at once over the size of the
//! file. The order itself is found before the clock runs.

use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use compare::counting::{Counting, with_peak};
use compare::timing;
use meshweft::files::{Document, Edit, Format, NewMesh};
use meshweft::order::{KCacheReorder, vertex_fetch};
use meshweft::{CacheModel, FaceOrder, Limits, VertexOrder};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const ROUNDS: usize = 5;

fn main() -> ExitCode {
    let side = std::env::args()
        .nth(1)
        .map_or(Ok(1000), |side| side.parse());
    let Ok(side) = side else {
        eprintln!("usage: files [SIDE [FORMAT]]");
        return ExitCode::from(2);
    };
    let folder = std::env::temp_dir().join(format!("meshweft-files-{}", std::process::id()));
    let done = std::fs::create_dir_all(&folder)
        .map_err(|error| error.to_string())
        .and_then(|()| measure(side, &folder));
    // A measurement that failed is what to report, not the folder it leaves.
    let _ = std::fs::remove_dir_all(&folder);
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn measure(side: u32, folder: &Path) -> Result<(), String> {
    println!("| format | MB | read MB/s | move MB/s | write MB/s | all MB/s | peak / file |");
    println!("|---|--:|--:|--:|--:|--:|--:|");
    let grid = Grid::new(side);
    for (name, bytes) in [
        ("glb", grid.glb()),
        ("ply", grid.made(Format::Ply)),
        ("stl", grid.made(Format::Stl)),
        ("obj", grid.obj()),
        ("off", grid.off()),
    ] {
        let path = folder.join(format!("grid.{name}"));
        let only = std::env::args().nth(2);
        if Format::of_path(&path).is_none() || only.is_some_and(|only| only != name) {
            continue;
        }
        std::fs::write(&path, &bytes).map_err(|error| error.to_string())?;
        row(name, bytes.len(), &path)?;
    }
    println!(
        "\nMedians of {ROUNDS} rounds; {} faces. Written to new files, so that\nnothing waits for the disk.",
        grid.faces.len()
    );
    Ok(())
}

fn row(name: &str, size: usize, path: &Path) -> Result<(), String> {
    let output = path.with_file_name(format!("ordered.{name}"));
    let open = || Document::open(path, Limits::default()).map_err(|error| error.to_string());
    let (faces, vertices) = orders(&open()?);
    let mut phases: [Vec<f64>; 4] = Default::default();
    let mut peak = 0;
    for _ in 0..ROUNDS {
        let run = || -> Result<[f64; 3], String> {
            let mut start = Instant::now();
            let mut lap = || {
                std::mem::replace(&mut start, Instant::now())
                    .elapsed()
                    .as_secs_f64()
            };
            let mut document = open()?;
            let read = lap();
            let applied = document.edit(Edit::order(0, &faces, vertices.as_ref()));
            applied.map_err(|error| error.to_string())?;
            let moved = lap();
            document.write(&output).map_err(|error| error.to_string())?;
            Ok([read, moved, lap()])
        };
        // A file that is replaced would be waited for until it is on the disk.
        let _ = std::fs::remove_file(&output);
        let (seconds, used) = with_peak(run);
        let seconds = seconds?;
        peak = peak.max(used);
        for (phase, seconds) in phases.iter_mut().zip(seconds) {
            phase.push(seconds);
        }
        phases[3].push(seconds.iter().sum());
    }
    let megabytes = size as f64 / 1e6;
    let mut text = format!("| {name} | {megabytes:.0} |");
    for phase in phases {
        let _ = write!(text, " {:.0} |", megabytes / timing::median(phase));
    }
    println!("{text} {:.2} |", peak as f64 / size as f64);
    Ok(())
}

fn orders(document: &Document) -> (FaceOrder, Option<VertexOrder>) {
    let entry = &document.meshes()[0];
    let algorithm = KCacheReorder {
        cache: CacheModel::fifo(12),
        ..Default::default()
    };
    let faces = entry.record_order(|mesh, polygons| match polygons {
        Some(starts) => algorithm.polygon_order(mesh, starts),
        None => algorithm.face_order(mesh),
    });
    let vertices = entry.vertices_movable.then(|| {
        let mesh = entry.mesh.with_face_order(&faces);
        vertex_fetch(&mesh)
    });
    (faces, vertices)
}

struct Grid {
    vertices: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
}

impl Grid {
    fn new(side: u32) -> Self {
        let at = |i: u32| i as f32 / side as f32;
        // A hill with ripples: coordinates with all their digits.
        let height = |x: f32, y: f32| ((x * 17.3).sin() + (y * 23.1).cos()) * 0.07;
        let vertices = (0..side * side)
            .map(|i| (at(i % side), at(i / side)))
            .map(|(x, y)| [x, y, height(x, y)])
            .collect();
        let faces = (0..side - 1)
            .flat_map(|y| (0..side - 1).map(move |x| y * side + x))
            .flat_map(|v| [[v, v + 1, v + side], [v + side, v + 1, v + side + 1]])
            .collect();
        Self { vertices, faces }
    }

    /// Positions, normals, texture coordinates; 32-bit indices.
    fn glb(&self) -> Vec<u8> {
        let (vertices, faces) = (self.vertices.len(), self.faces.len());
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[
            {{"buffer":0,"byteLength":{},"byteStride":32}},
            {{"buffer":0,"byteOffset":{},"byteLength":{}}}],"accessors":[
            {{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3"}},
            {{"bufferView":0,"byteOffset":12,"componentType":5126,"count":{vertices},"type":"VEC3"}},
            {{"bufferView":0,"byteOffset":24,"componentType":5126,"count":{vertices},"type":"VEC2"}},
            {{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}],
            "meshes":[{{"primitives":[{{"attributes":
            {{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}]}}"#,
            vertices * 32 + faces * 12,
            vertices * 32,
            vertices * 32,
            faces * 12,
            faces * 3,
        );
        let mut json = json.into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut data = Vec::new();
        for [x, y, z] in &self.vertices {
            let record = [x, y, z, &0.0, &0.0, &1.0, x, y];
            data.extend(record.iter().flat_map(|value| value.to_le_bytes()));
        }
        data.extend(self.faces.iter().flatten().flat_map(|v| v.to_le_bytes()));
        let word = |n: usize| {
            u32::try_from(n)
                .expect("a grid of less than 4 GiB")
                .to_le_bytes()
        };
        let parts: [&[u8]; 8] = [
            b"glTF\x02\0\0\0",
            &word(28 + json.len() + data.len()),
            &word(json.len()),
            b"JSON",
            &json,
            &word(data.len()),
            b"BIN\0",
            &data,
        ];
        parts.concat()
    }

    /// Positions and faces, as the library writes them.
    fn made(&self, format: Format) -> Vec<u8> {
        let grid = NewMesh::plain("", &self.vertices, &self.faces);
        let document = Document::create(format, Path::new("grid"), &[grid]);
        let bytes = document.and_then(|document| document.to_main_bytes());
        bytes.expect("a sound grid")
    }

    /// Text with six places, as most programs write it.
    fn obj(&self) -> Vec<u8> {
        let mut text = String::new();
        for [x, y, z] in &self.vertices {
            let _ = writeln!(text, "v {x:.6} {y:.6} {z:.6}");
        }
        for [a, b, c] in self.faces.iter().map(|face| face.map(|v| v + 1)) {
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        text.into_bytes()
    }

    fn off(&self) -> Vec<u8> {
        let mut text = format!("OFF\n{} {} 0\n", self.vertices.len(), self.faces.len());
        for [x, y, z] in &self.vertices {
            let _ = writeln!(text, "{x:.6} {y:.6} {z:.6}");
        }
        for [a, b, c] in &self.faces {
            let _ = writeln!(text, "3 {a} {b} {c}");
        }
        text.into_bytes()
    }
}
