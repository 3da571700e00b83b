//! Files of more than 65,536 vertices: put in blocks, ordered, and not changed by a second run.
#![cfg(feature = "files")]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use meshweft::cache::nvidia;
use meshweft::files::{Document, Format, ReadOptions};
use meshweft::operations::{self, IndexOptions, Options, optimize_indices};
use meshweft::{Faces, Permutation, VertexOrder};

const SIDE: u32 = 262;
const VERTEX_COUNT: u32 = (SIDE + 1) * (SIDE + 1);

/// A grid of squares of which some faces are missing, the faces of both halves and all vertices shuffled,
/// and the place of each vertex. Few enough faces for an order of them to be checked.
fn grid() -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
    let square = |i: u32| {
        let corner = i / SIDE * (SIDE + 1) + i % SIDE;
        let above = corner + SIDE + 1;
        [[corner, corner + 1, above], [corner + 1, above + 1, above]]
    };
    let half = |squares: std::ops::Range<u32>| {
        let faces: Vec<_> = squares.flat_map(square).collect();
        let shuffled = Permutation::random(faces.len(), 1).apply(&faces);
        shuffled[..faces.len() * 9 / 10].to_vec()
    };
    let middle = SIDE * SIDE / 2;
    let faces = [half(0..middle), half(middle..SIDE * SIDE)].concat();
    let vertices = VertexOrder::from(Permutation::random(VERTEX_COUNT as usize, 2));
    let faces = vertices.renumber(&faces);
    let place = |&v: &u32| [(v % (SIDE + 1)) as f32, (v / (SIDE + 1)) as f32, 0.0];
    (faces, vertices.new_to_old().iter().map(place).collect())
}

fn obj(faces: &[[u32; 3]], places: &[[f32; 3]]) -> Vec<u8> {
    let mut text = String::new();
    for [x, y, z] in places {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for (i, face) in faces.iter().enumerate() {
        if i == faces.len() / 2 {
            writeln!(text, "usemtl other").unwrap();
        }
        let [a, b, c] = face.map(|v| v + 1);
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    text.into_bytes()
}

fn ply(faces: &[[u32; 3]], places: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\nelement face {}\n\
         property list uchar uint vertex_indices\nend_header\n",
        places.len(),
        faces.len()
    )
    .into_bytes();
    bytes.extend(places.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    for face in faces {
        bytes.push(3);
        bytes.extend(face.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

/// A mesh of `parts` primitives, which share their vertices.
fn glb(faces: &[[u32; 3]], places: &[[f32; 3]], parts: usize) -> Vec<u8> {
    let bytes_of_places = 12 * places.len();
    let (mut accessors, mut primitives) = (String::new(), String::new());
    let mut start = 0;
    for part in 0..parts {
        let end = faces.len() * (part + 1) / parts;
        write!(
            accessors,
            ",{{\"bufferView\":1,\"byteOffset\":{},\"componentType\":5125,\"count\":{},\"type\":\"SCALAR\"}}",
            12 * start,
            3 * (end - start)
        )
        .unwrap();
        let comma = if part == 0 { "" } else { "," };
        let indices = part + 1;
        write!(
            primitives,
            "{comma}{{\"attributes\":{{\"POSITION\":0}},\"indices\":{indices}}}"
        )
        .unwrap();
        start = end;
    }
    let mut json = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"meshes\":[{{\"primitives\":[{primitives}]}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":{},\"type\":\"VEC3\",\
         \"min\":[0,0,0],\"max\":[{SIDE},{SIDE},0]}}{accessors}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":{bytes_of_places}}},\
         {{\"buffer\":0,\"byteOffset\":{bytes_of_places},\"byteLength\":{}}}],\
         \"buffers\":[{{\"byteLength\":{}}}]}}",
        places.len(),
        12 * faces.len(),
        bytes_of_places + 12 * faces.len()
    );
    while json.len() % 4 != 0 {
        json.push(' ');
    }

    let numbers = |values: &[u32]| -> Vec<u8> {
        values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    };
    let length = |count: usize| u32::try_from(count).unwrap();
    let data = bytes_of_places + 12 * faces.len();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(numbers(&[
        2,
        length(28 + json.len() + data),
        length(json.len()),
    ]));
    bytes.extend(b"JSON");
    bytes.extend(json.into_bytes());
    bytes.extend(numbers(&[length(data)]));
    bytes.extend(b"BIN\0");
    bytes.extend(places.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend(numbers(faces.as_flattened()));
    bytes
}

fn open(bytes: &[u8], format: Format) -> Document {
    let name = Path::new("grid");
    Document::from_bytes(bytes.to_vec(), format, name, ReadOptions::default()).unwrap()
}

/// The faces of all meshes by the places of their corners, sorted, each from its least corner.
fn triangles(document: &Document) -> BTreeMap<[[u32; 2]; 3], u32> {
    let mut all = BTreeMap::new();
    for (i, entry) in document.meshes().iter().enumerate() {
        let places = document.positions(i).unwrap().unwrap();
        for face in entry.mesh.faces() {
            let mut corners = face.map(|v| {
                let [x, y, _] = places[v as usize];
                [x.to_bits(), y.to_bits()]
            });
            let least = (0..3).min_by_key(|&corner| corners[corner]);
            corners.rotate_left(least.unwrap());
            *all.entry(corners).or_default() += 1;
        }
    }
    all
}

#[test]
fn a_second_run_changes_no_byte() {
    let (faces, places) = grid();
    for (name, bytes, format) in [
        ("OBJ", obj(&faces, &places), Format::Obj),
        ("PLY", ply(&faces, &places), Format::Ply),
        ("GLB", glb(&faces, &places, 1), Format::Glb),
        ("GLB of two", glb(&faces, &places, 2), Format::Glb),
    ] {
        let triangles_before = triangles(&open(&bytes, format));
        for target in ["universal", "nvidia", "fifo:12"] {
            let options = Options {
                target: target.parse().unwrap(),
                ..Options::default()
            };
            let mut document = open(&bytes, format);
            let report = operations::optimize(&mut document, &options, &()).unwrap();
            assert!(report.is_changed(), "{name}, {target}");
            let written = document.to_main_bytes().unwrap();

            // The same triangles, in blocks, and counted as the file has them.
            let mut document = open(&written, format);
            assert!(triangles(&document) == triangles_before, "{name}, {target}");
            let mut counts = nvidia::DrawCounts::default();
            for entry in document.meshes() {
                counts.add(&nvidia::counts(&entry.mesh));
            }
            let most = if target == "fifo:12" { 1.06 } else { 1.02 };
            let warps = counts.warps_over_floor();
            assert!(warps < most, "{name}, {target}: {warps}");
            let models = options.target.models();
            let inspected = operations::inspect(&document, models);
            for (model, misses) in &inspected.total.misses {
                let reported = report.total.after.misses.iter().find(|(m, _)| m == model);
                assert_eq!(reported, Some(&(*model, *misses)), "{name}, {target}");
            }

            let again = operations::optimize(&mut document, &options, &()).unwrap();
            assert!(!again.is_changed(), "{name}, {target}");
            assert!(
                document.to_main_bytes().unwrap() == written,
                "{name}, {target}"
            );
        }
    }
}

#[test]
fn indices_are_put_in_blocks_where_vertices_may_move() {
    let (faces, _) = grid();
    for target in ["universal", "nvidia", "fifo:12"] {
        let options = IndexOptions {
            target: target.parse().unwrap(),
            renumber_vertices: true,
            ..IndexOptions::default()
        };
        let mut indices = faces.as_flattened().to_vec();
        let count = VERTEX_COUNT as usize;
        let orders = optimize_indices(&mut indices, count, &options).unwrap();
        let vertices = orders.vertices.unwrap();
        let expected = vertices.renumber(&orders.faces.apply(&faces));
        assert!(indices == expected.as_flattened(), "{target}");
        let now = Faces::from_indices(&indices, count).unwrap();
        assert!(nvidia::counts(now).warps_over_floor() < 1.06, "{target}");

        let again = optimize_indices(&mut indices, count, &options).unwrap();
        assert!(again.faces.is_identity(), "{target}");
        assert!(again.vertices.unwrap().is_identity(), "{target}");
        assert!(indices == expected.as_flattened(), "{target}");
    }
}
