//! Strips and fans that are made lists of triangles.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Format, ReadOptions, Surroundings};
use serde_json::{Value, json};

use super::builder::{Builder, F32, U8, U16, U32, faces};
use super::moves::{notes, open, reader, written};
use super::random_orders;
use super::reader::{Reader, Triangle};

/// Reads the file with its strips made lists.
fn with_lists(bytes: &[u8]) -> Document {
    let mut options = ReadOptions::from(Limits::default());
    options.strips_to_lists = true;
    let path = Path::new("scene.glb");
    Document::from_bytes(bytes.to_vec(), Format::Glb, path, &options).unwrap()
}

/// The triangles of strips and fans, as the format defines them, each corner by its position.
fn expected(file: &Reader, primitive: &Value) -> Vec<Triangle> {
    let positions = file.elements(&primitive["attributes"]["POSITION"]).unwrap();
    let numbers: Vec<usize> = match primitive.get("indices") {
        Some(list) => {
            let numbers = file.elements(list).unwrap();
            let numbers = numbers.iter().map(|bytes| {
                let mut whole = [0; 8];
                whole[..bytes.len()].copy_from_slice(bytes);
                usize::from_le_bytes(whole)
            });
            numbers.collect()
        }
        None => (0..positions.len()).collect(),
    };
    let mut triangles = Vec::new();
    for i in 0..numbers.len().saturating_sub(2) {
        let corners = match primitive["mode"].as_u64() {
            Some(5) => [i, i + 1 + i % 2, i + 2 - i % 2],
            _ => [i + 1, i + 2, 0],
        };
        let corners = corners.map(|corner| numbers[corner]);
        if corners[0] != corners[1] && corners[1] != corners[2] && corners[0] != corners[2] {
            let turned = (0..3).map(|r| [0, 1, 2].map(|i| positions[corners[(i + r) % 3]].clone()));
            triangles.push(turned.min().unwrap());
        }
    }
    triangles.sort();
    triangles
}

/// A file with one strip or fan, by indices of this type or without.
fn one_strip(mode: usize, component: Option<usize>) -> Vec<u8> {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 40);
    let mut primitive = json!({"attributes": {"POSITION": position}, "mode": mode, "material": 3});
    if let Some(component) = component {
        let mut numbers: Vec<usize> = (0..60).map(|i| i * 7 % 40).collect();
        numbers[20] = numbers[21];
        primitive["indices"] = json!(builder.indices(component, &numbers));
    }
    builder.glb(&json!([{"primitives": [primitive]}]), &json!({}))
}

#[test]
fn every_strip_and_fan_becomes_the_triangles_that_it_draws() {
    for mode in [5, 6] {
        for component in [None, Some(U8), Some(U16), Some(U32)] {
            let bytes = one_strip(mode, component);
            let file = reader(&bytes);
            let expected = expected(&file, &file.json["meshes"][0]["primitives"][0]);

            let mut document = with_lists(&bytes);
            let said =
                ["/meshes/0/primitives/0: it was a strip or fan, and is a list of triangles now"];
            assert_eq!(notes(&document), said);
            let entry = &document.meshes()[0];
            assert!(entry.faces_movable && entry.vertices_movable);
            assert_eq!(entry.mesh.face_count(), expected.len());
            for seed in 0..3 {
                let list = reader(&written(&document));
                assert!(list.triangles() == [expected.clone()]);
                let primitive = &list.json["meshes"][0]["primitives"][0];
                assert_eq!(
                    (&primitive["mode"], &primitive["material"]),
                    (&json!(4), &json!(3))
                );
                random_orders(&mut document, seed);
            }

            // What is written is a file like any other.
            let again = written(&document);
            assert_eq!(open(&again).meshes(), document.meshes());
            assert_eq!(written(&with_lists(&again)), again);
        }
    }
}

#[test]
fn restarts_part_strips() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 9);
    let list = builder.indices(U8, &[0, 1, 2, 3, 255, 4, 5, 6, 255, 7, 8]);
    let primitive = json!({"attributes": {"POSITION": position}, "indices": list, "mode": 5});
    let document = with_lists(&builder.glb(&json!([{"primitives": [primitive]}]), &json!({})));
    assert_eq!(
        document.meshes()[0].mesh.faces(),
        [[0, 1, 2], [1, 3, 2], [4, 5, 6]]
    );
}

#[test]
fn a_strip_that_something_keeps_stays_one() {
    let why = "it is a strip or fan, whose faces depend on those before; strips_to_lists makes a list of it";
    let cases: [fn(&mut Value); 4] = [
        |p| p["extensions"] = json!({"FANCY": {}}),
        |p| p["extensions"] = json!({"KHR_mesh_primitive_restart": {}}),
        |p| p["indices"] = json!(0),
        |p| p["attributes"] = json!({"NORMAL": 0}),
    ];
    for change in cases {
        let mut builder = Builder::default();
        let position = builder.data(F32, "VEC3", 9);
        let list = builder.indices(U8, &[0, 1, 2, 3]);
        let mut strip = json!({"attributes": {"POSITION": position}, "indices": list, "mode": 5});
        change(&mut strip);
        let bytes = builder.glb(&json!([{"primitives": [strip]}]), &json!({}));
        let document = with_lists(&bytes);
        assert_eq!(
            notes(&document),
            [format!("/meshes/0/primitives/0: left as it is: {why}")]
        );
        assert_eq!(written(&document), bytes);
    }
    // One that names a vertex that is not there.
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 3);
    let list = builder.indices(U8, &[0, 1, 2, 3]);
    let strip = json!({"attributes": {"POSITION": position}, "indices": list, "mode": 5});
    let bytes = builder.glb(&json!([{"primitives": [strip]}]), &json!({}));
    let document = with_lists(&bytes);
    assert_eq!(
        notes(&document),
        [format!("/meshes/0/primitives/0: its order stays: {why}")]
    );
    assert_eq!(written(&document), bytes);
}

#[test]
fn lists_are_shared_as_strips_were_and_other_primitives_stay() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 30);
    let strip = builder.indices(U16, &faces(5, 30));
    let list = builder.indices(U16, &faces(40, 30));
    let drawn = |mode: usize, indices: usize| json!({"attributes": {"POSITION": position}, "mode": mode, "indices": indices});
    let meshes = json!([{"primitives": [drawn(5, strip), drawn(4, list), drawn(6, strip)]},
        {"primitives": [drawn(1, strip), drawn(5, strip)]}]);
    let bytes = builder.glb(&meshes, &json!({}));
    let mut document = with_lists(&bytes);
    // The strip twice, the fan, and what was a list; the lines are renumbered.
    assert_eq!(document.meshes().len(), 3);
    assert_eq!(document.notes()[0].more, 2);
    let before = reader(&written(&document));
    random_orders(&mut document, 1);
    let after = reader(&written(&document));
    assert!(before.triangles() == after.triangles());
    let is_line = |primitive: &Value| primitive["mode"] == 1;
    assert!(before.drawn_in_order(is_line) == reader(&bytes).drawn_in_order(is_line));
    assert!(before.drawn_in_order(is_line) == after.drawn_in_order(is_line));
}

#[test]
fn the_buffer_beside_a_text_grows() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 9);
    let strip = json!({"attributes": {"POSITION": position}, "mode": 5});
    let mut json = builder.json(&json!([{"primitives": [strip]}]), &json!({}));
    json["buffers"][0]["uri"] = json!("a.bin");
    let binary = builder.binary.clone();
    let files = BTreeMap::from([(PathBuf::from("a.bin"), binary.clone())]);
    let mut options = ReadOptions::from(Limits::default());
    options.strips_to_lists = true;
    let (name, beside) = (Path::new("scene.gltf"), Surroundings::Memory(&files));
    let read = |options: &ReadOptions| {
        let text = json.to_string().into_bytes();
        Document::from_bytes_in(text, Format::Gltf, name, beside, options).unwrap()
    };
    let written: BTreeMap<PathBuf, Vec<u8>> =
        read(&options).to_bytes(name).unwrap().into_iter().collect();
    assert_eq!(written.len(), 2);
    let [text, buffer] = ["scene.gltf", "a.bin"].map(|name| &written[Path::new(name)]);
    assert!(buffer.starts_with(&binary) && buffer.len() >= binary.len() + 7 * 3 * 2);
    let text: Value = serde_json::from_slice(text).unwrap();
    assert_eq!(text["buffers"][0]["byteLength"], buffer.len());

    // Another scene reads the buffer: the lists go elsewhere.
    options.keep_buffers = vec![PathBuf::from("a.bin")];
    let written: BTreeMap<PathBuf, Vec<u8>> =
        read(&options).to_bytes(name).unwrap().into_iter().collect();
    assert_eq!(written[Path::new("a.bin")], binary);
}
