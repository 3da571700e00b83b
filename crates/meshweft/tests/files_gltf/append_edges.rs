//! Meshes added to files that are unusual, damaged, or written where others stand.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{
    Document, Edit, FileError, Format, NewMesh, NewValue, NewVertices, ReadOptions, Surroundings,
};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U16, faces, glb};
use crate::data::scenes_below;
use crate::data_folder::folder;
use crate::random_orders;
use crate::reader::Reader;

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// Adds the faces of the first mesh once more, and a triangle.
fn append(document: &mut Document) -> Result<(), FileError> {
    let first = document.meshes().first();
    let faces = first.map_or(Vec::new(), |first| first.mesh.faces().to_vec());
    let attributes = [Attribute::of_vertices(Semantic::Position, &CORNERS)];
    let mut meshes = vec![NewMesh::new(
        "triangle",
        NewVertices::Stored(&attributes),
        &[[0, 1, 2]],
    )];
    if !faces.is_empty() {
        meshes.insert(0, NewMesh::new("again", NewVertices::Shared(0), &faces));
    }
    document.edit(Edit::append(&meshes))
}

/// Every file of the document, read again: what is seen is what the document says.
fn reopened(document: &Document) -> Document {
    let name = document.path();
    let mut files: BTreeMap<PathBuf, Vec<u8>> =
        document.to_bytes(name).unwrap().into_iter().collect();
    let main = files.remove(Path::new(name.file_name().unwrap())).unwrap();
    let format = document.format();
    let beside = Surroundings::Memory(&files);
    let again = Document::from_bytes_in(main, format, name, beside, Limits::default());
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.meshes(), document.meshes(), "{}", name.display());
    for mesh in 0..again.meshes().len() {
        assert_eq!(again.positions(mesh).ok(), document.positions(mesh).ok());
    }
    again
}

/// A mesh at a node, its buffer a file of this name.
fn scene(uri: Option<&str>) -> (Builder, Value) {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 9);
    let indices = builder.indices(U16, &faces(8, 9));
    let primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
    let others = json!({"nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]});
    let mut json = builder.json(&json!([{"primitives": [primitive]}]), &others);
    if let Some(uri) = uri {
        json["buffers"][0]["uri"] = uri.into();
    }
    (builder, json)
}

#[test]
fn a_damaged_scene_takes_meshes_or_stays() {
    let Some(folder) = folder() else { return };
    let (mut taken, mut left) = (0, 0);
    for path in scenes_below(&folder.join("malformed")) {
        let Ok(mut document) = Document::open(&path, Limits::default()) else {
            left += 1;
            continue;
        };
        let before = document.to_main_bytes().unwrap();
        match append(&mut document) {
            Ok(()) => {
                reopened(&document);
                taken += 1;
            }
            Err(error) => {
                println!("{error}");
                assert_eq!(document.to_main_bytes().unwrap(), before);
                left += 1;
            }
        }
    }
    println!("{taken} damaged scenes took meshes, {left} did not");
}

#[test]
fn every_kind_of_text_keeps_what_is_around_it() {
    let (builder, json) = scene(None);
    let pretty = serde_json::to_string_pretty(&json)
        .unwrap()
        .replace('\n', "\r\n");
    let text = json.to_string();
    // The last of two members counts, and a name may be written with escapes.
    let twice = text.replacen('{', r#"{"nodes":7,"scenes":[],"buffers":null,"#, 1);
    let escaped = text.replace(r#""nodes":[{"#, r#""n\u006fdes":[{"#);
    assert!(escaped != text);
    for (what, text) in [
        ("mark", format!("\u{feff}{text}")),
        ("lines", pretty.clone()),
        ("both", format!("\u{feff}{pretty}\r\n")),
        ("twice", twice),
        ("escaped", escaped),
        ("blank", format!("{text}\n\t \n")),
    ] {
        for odd in 0..4 {
            let text = format!("{text}{}", " ".repeat(odd));
            let bytes = glb(&text, Some(&builder.binary));
            let open = |bytes: Vec<u8>| {
                Document::from_bytes(bytes, Format::Glb, "test.glb".as_ref(), Limits::default())
            };
            let mut document = open(bytes).unwrap();
            append(&mut document).unwrap();
            assert_eq!(document.meshes().len(), 3, "{what}");
            let written = document.to_main_bytes().unwrap();
            assert!(written.ends_with(b"\x04\0\0\0ODD\0\x01\x02\x03\x04behind"));
            let has_mark = written[20..].starts_with("\u{feff}".as_bytes());
            assert_eq!(has_mark, matches!(what, "mark" | "both"));
            let mut again = reopened(&document);
            append(&mut again).unwrap();
            assert_eq!(reopened(&again).meshes().len(), 5, "{what}");
        }
    }
}

#[test]
fn a_chunk_may_be_longer_than_its_buffer_or_of_an_odd_length() {
    let (builder, json) = scene(None);
    for more in 0..9 {
        let mut binary = builder.binary.clone();
        binary.resize(binary.len() + more, 0x77);
        let bytes = glb(&json.to_string(), Some(&binary));
        let name = Path::new("test.glb");
        let mut document =
            Document::from_bytes(bytes, Format::Glb, name, Limits::default()).unwrap();
        append(&mut document).unwrap();
        let reader = Reader::of_file(name, Some(document.to_main_bytes().unwrap()));
        let buffer = reader.buffers[0].as_ref().unwrap();
        assert!(buffer.starts_with(&binary), "{more}");
        assert_eq!(reader.json["buffers"][0]["byteLength"], buffer.len());
        reopened(&document);
    }
}

#[test]
fn a_chunk_may_stand_before_the_binary_one() {
    let (builder, json) = scene(None);
    let mut bytes = glb(&json.to_string(), None);
    bytes.truncate(bytes.len() - b"behind".len());
    bytes.extend_from_slice(&u32::try_from(builder.binary.len()).unwrap().to_le_bytes());
    bytes.extend_from_slice(b"BIN\0");
    bytes.extend_from_slice(&builder.binary);
    let length = u32::try_from(bytes.len()).unwrap().to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    let name = Path::new("test.glb");
    let mut document = Document::from_bytes(bytes, Format::Glb, name, Limits::default()).unwrap();
    append(&mut document).unwrap();
    let written = document.to_main_bytes().unwrap();
    assert_eq!(
        written[8..12],
        u32::try_from(written.len()).unwrap().to_le_bytes()
    );
    assert!(
        written
            .windows(12)
            .any(|w| w == b"\x04\0\0\0ODD\0\x01\x02\x03\x04")
    );
    reopened(&document);
}

#[test]
fn orders_and_new_meshes_take_turns() {
    let (builder, json) = scene(None);
    let bytes = glb(&json.to_string(), Some(&builder.binary));
    let name = Path::new("test.glb");
    let mut document = Document::from_bytes(bytes, Format::Glb, name, Limits::default()).unwrap();
    let triangles = |document: &Document| {
        let bytes = document.to_main_bytes().unwrap();
        Reader::of_file(name, Some(bytes)).triangles()
    };
    for seed in 0..4 {
        if seed > 0 {
            append(&mut document).unwrap();
        }
        let before = triangles(&document);
        random_orders(&mut document, seed);
        assert_eq!(triangles(&document), before);
        reopened(&document);
    }
    assert_eq!(document.meshes().len(), 7);
    let all = triangles(&document);
    assert_eq!([&all[1], &all[3], &all[5]], [&all[0]; 3]);
}

#[test]
fn buffers_beside_the_file_grow_where_they_may() {
    let root = std::env::temp_dir().join(format!("meshweft-append-edges-{}", std::process::id()));
    let (source, other) = (root.join("source"), root.join("other"));
    for folder in [&source, &other] {
        fs::create_dir_all(folder).unwrap();
    }
    let (builder, mut json) = scene(Some("data.bin"));
    // Two buffers over one file, which has bytes after both.
    let length = builder.binary.len();
    json["buffers"] = json!([
        {"uri": "data.bin", "byteLength": length},
        {"uri": "./data.bin", "byteLength": 4},
    ]);
    let data = [&builder.binary[..], b"behind"].concat();
    fs::write(source.join("data.bin"), &data).unwrap();
    let text = json.to_string();
    fs::write(source.join("scene.gltf"), &text).unwrap();

    let read = |path: &Path| Document::open(path, Limits::default()).unwrap();
    for target in [
        other.join("scene.gltf"),
        other.join("renamed.gltf"),
        source.join("renamed.gltf"),
    ] {
        let mut document = read(&source.join("scene.gltf"));
        append(&mut document).unwrap();
        document.write(&target).unwrap();
        assert_eq!(read(&target).meshes(), document.meshes());
        assert_eq!(fs::read(source.join("data.bin")).unwrap(), data);
        assert_eq!(fs::read_to_string(source.join("scene.gltf")).unwrap(), text);
    }
    let renamed = fs::read(source.join("renamed.bin")).unwrap();
    assert!(renamed.starts_with(&data) && renamed.len() > data.len());

    // Where another file reads the buffer too, new bytes go to one of their own.
    let mut options = ReadOptions::default();
    options.keep_buffers.push(source.join("data.bin"));
    let mut document = Document::open(&source.join("scene.gltf"), options).unwrap();
    for _ in 0..2 {
        append(&mut document).unwrap();
        document.write(&source.join("kept.gltf")).unwrap();
        assert_eq!(fs::read(source.join("data.bin")).unwrap(), data);
        let kept = Reader::of_file(&source.join("kept.gltf"), None);
        assert_eq!(kept.json["buffers"].as_array().unwrap().len(), 3);
        read(&source.join("kept.gltf"));
    }

    // Over the source itself.
    let mut document = read(&source.join("scene.gltf"));
    append(&mut document).unwrap();
    document.write(&source.join("scene.gltf")).unwrap();
    assert_eq!(read(&source.join("scene.gltf")).meshes(), document.meshes());
    // Text and buffer change together: the buffer has another name, and the text says which.
    let json = Reader::of_file(&source.join("scene.gltf"), None).json;
    let buffers = json["buffers"].as_array().unwrap().iter();
    let name = buffers
        .filter_map(|b| b["uri"].as_str())
        .find(|uri| uri.starts_with("scene."));
    let grown = fs::read(source.join(name.unwrap())).unwrap();
    assert!(grown.starts_with(&data) && grown.len() > data.len());
    fs::remove_dir_all(&root).unwrap();
}

#[test]
fn a_new_mesh_is_drawn_as_its_node_says() {
    let (builder, mut json) = scene(None);
    let instances = json!({"attributes": {"TRANSLATION": 0}});
    json["nodes"][0]["weights"] = json!([0.25, 1.50]);
    json["nodes"][0]["extensions"] =
        json!({"EXT_mesh_gpu_instancing": instances, "KHR_node_visibility": {"visible": true}});
    let bytes = glb(&json.to_string(), Some(&builder.binary));
    let name = Path::new("test.glb");
    let mut document = Document::from_bytes(bytes, Format::Glb, name, Limits::default()).unwrap();
    append(&mut document).unwrap();
    let json = Reader::of_file(name, Some(document.to_main_bytes().unwrap())).json;
    assert_eq!(
        json["nodes"][1],
        json!({
            "mesh": 1, "name": "again", "weights": [0.25, 1.5],
            "extensions": {"EXT_mesh_gpu_instancing": instances},
        })
    );
    assert_eq!(json["nodes"][2], json!({"mesh": 2, "name": "triangle"}));
}

#[test]
fn faces_without_indices_stay_when_their_vertices_are_numbered() {
    let (builder, mut json) = scene(None);
    let primitive = json["meshes"][0]["primitives"][0].as_object_mut().unwrap();
    primitive.remove("indices");
    let bytes = glb(&json.to_string(), Some(&builder.binary));
    let name = Path::new("test.glb");
    let mut document = Document::from_bytes(bytes, Format::Glb, name, Limits::default()).unwrap();
    assert_eq!(document.meshes().len(), 1);
    append(&mut document).unwrap();
    let names = document.meshes().iter().map(|entry| &entry.name);
    assert_eq!(names.collect::<Vec<_>>(), ["again", "triangle"]);
    let note = &document.notes()[0].text;
    assert!(note.contains("also read by other primitives"), "{note}");
    random_orders(&mut document, 2);
    let all = Reader::of_file(name, Some(document.to_main_bytes().unwrap())).triangles();
    assert_eq!(all[0], all[1]);
}

#[test]
fn values_do_not_say_what_buffers_hold_nor_change_the_version() {
    let (builder, mut json) = scene(None);
    json.as_object_mut().unwrap().remove("asset");
    let bytes = glb(&json.to_string(), Some(&builder.binary));
    let name = Path::new("test.glb");
    let mut document =
        Document::from_bytes(bytes.clone(), Format::Glb, name, Limits::default()).unwrap();
    for (pointer, json, expected) in [
        ("/buffers/-", "{}", "what a buffer holds"),
        ("/buffers/0/uri", "\"a.bin\"", "what a buffer holds"),
        ("/asset/version", "\"1.0\"", "glTF version 1.0"),
        ("/meshes/00/name", "1", "there are 1 elements here"),
    ] {
        let values = [NewValue { pointer, json }];
        let meshes = [];
        let refused = document
            .edit(Edit::Append {
                meshes: &meshes,
                values: &values,
            })
            .unwrap_err()
            .to_string();
        assert!(refused.contains(expected), "{refused}");
        assert_eq!(document.to_main_bytes().unwrap(), bytes);
    }
}
