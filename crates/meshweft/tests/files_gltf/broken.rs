//! What is wrong with a file, word for word.

use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Format};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U8, U16, glb};
use crate::errors::error_of;

fn error(name: &str, bytes: Vec<u8>) -> String {
    error_of(&bytes, name, Limits::default())
}

/// The JSON and binary chunk of a mesh with 4 vertices and 2 faces.
fn sound() -> (Value, Vec<u8>) {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 4);
    let indices = builder.indices(U16, &[0, 1, 2, 2, 1, 3]);
    let primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
    let json = builder.json(&json!([{"primitives": [primitive]}]), &json!({}));
    (json, builder.binary)
}

#[test]
fn the_json_says_something_impossible() {
    type Change = fn(&mut Value);
    let cases: [(&str, Change); 20] = [
        (
            "/accessors/0/count: expected a whole number from 0 on, found -4",
            |j| {
                j["accessors"][0]["count"] = json!(-4);
            },
        ),
        (
            "/accessors/0/count: expected a whole number from 0 on, found 1.5",
            |j| {
                j["accessors"][0]["count"] = json!(1.5);
            },
        ),
        (
            "/accessors/0: 18446744073709551615 elements of 12 bytes from byte 0 on reach past \
             the 48 bytes of buffer view 0",
            |j| j["accessors"][0]["count"] = json!(u64::MAX),
        ),
        (
            "/accessors/0: 4 elements of 12 bytes from byte 4 on reach past the 48 bytes of \
             buffer view 0",
            |j| j["accessors"][0]["byteOffset"] = json!(4),
        ),
        (
            "/bufferViews/0: 48 bytes from byte 1000 on reach past the 76 bytes of buffer 0",
            |j| j["bufferViews"][0]["byteOffset"] = json!(1000),
        ),
        (
            "/buffers/0: byteLength is 77, but only 76 bytes are there: the buffer is cut off",
            |j| j["buffers"][0]["byteLength"] = json!(77),
        ),
        (
            "/bufferViews/0: byteStride 8 is less than the 12 bytes of an element of /accessors/0",
            |j| j["bufferViews"][0]["byteStride"] = json!(8),
        ),
        (
            "/bufferViews/1: there is no buffer 9: the file has 1",
            |j| {
                j["bufferViews"][1]["buffer"] = json!(9);
            },
        ),
        (
            "/accessors/1: there is no buffer view 2: the file has 2",
            |j| {
                j["accessors"][1]["bufferView"] = json!(2);
            },
        ),
        (
            "/meshes/0/primitives/0/attributes/POSITION: there is no accessor 7: the file has 2",
            |j| j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(7),
        ),
        (
            "/meshes/0/primitives/0/attributes/_A~1B: /accessors/1 has 6 elements, but POSITION \
             has 4",
            |j| j["meshes"][0]["primitives"][0]["attributes"]["_A/B"] = json!(1),
        ),
        (
            "/meshes/0/primitives/0/targets/0/NORMAL: /accessors/1 has 6 elements, but POSITION \
             has 4",
            |j| j["meshes"][0]["primitives"][0]["targets"] = json!([{"NORMAL": 1}]),
        ),
        ("/meshes/0/primitives/0: attributes is missing", |j| {
            j["meshes"][0]["primitives"][0] = json!({});
        }),
        ("/meshes/0/primitives/0: there is no mode 7", |j| {
            j["meshes"][0]["primitives"][0]["mode"] = json!(7);
        }),
        ("/accessors/1: there is no component type 4", |j| {
            j["accessors"][1]["componentType"] = json!(4);
        }),
        ("/accessors/1: there is no type \"VEC9\"", |j| {
            j["accessors"][1]["type"] = json!("VEC9");
        }),
        (
            "/meshes/0/primitives/0/indices: indices must be single unsigned bytes, shorts or \
             ints: /accessors/1 has component type 5122",
            |j| j["accessors"][1]["componentType"] = json!(5122),
        ),
        ("/meshes: expected an array, found an object", |j| {
            j["meshes"] = json!({});
        }),
        ("/buffers/0/uri: expected a string, found null", |j| {
            j["buffers"][0]["uri"] = json!(null);
        }),
        (
            "/asset/version: glTF version 1.0: only version 2 is read, re-export it",
            |j| j["asset"]["version"] = json!("1.0"),
        ),
    ];
    let (json, binary) = sound();
    for (expected, change) in cases {
        let mut json = json.clone();
        change(&mut json);
        let found = error("scene.glb", glb(&json.to_string(), Some(&binary)));
        assert_eq!(found, format!("scene.glb: {expected}"));
    }
}

#[test]
fn the_indices_name_no_vertex() {
    let cases = [
        (U16, 4, "index 4 is past the last vertex (3)"),
        (U8, 200, "index 200 is past the last vertex (3)"),
        (
            U8,
            255,
            "index 255 restarts a strip and is not a vertex: store the indices in a wider type",
        ),
    ];
    for (component, number, expected) in cases {
        let mut builder = Builder::default();
        let position = builder.data(F32, "VEC3", 4);
        let indices = builder.indices(component, &[0, 1, 2, 2, 1, number]);
        let primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
        let bytes = builder.glb(&json!([{}, {"primitives": [primitive]}]), &json!({}));
        let expected = format!("scene.glb: /meshes/1/primitives/0: {expected}");
        assert_eq!(error("scene.glb", bytes), expected);
    }
}

#[test]
fn the_buffer_cannot_be_had() {
    let (json, _) = sound();
    let cases = [
        (
            json!({"uri": "no such file.bin"}),
            "/buffers/0/uri: no such file.bin cannot be read (the document was given without \
             surroundings). Put it beside the glTF",
        ),
        (
            json!({"uri": "https://example.org/a.bin"}),
            "/buffers/0/uri: \"https://example.org/a.bin\" has a scheme or a drive: only files in \
             the folder of the glTF or below are read",
        ),
        (
            json!({"uri": "/a.bin"}),
            "/buffers/0/uri: \"/a.bin\" is an absolute path: only files in the folder of the glTF \
             or below are read",
        ),
        (
            json!({"uri": "a/%2E./../b.bin"}),
            "/buffers/0/uri: \"a/%2E./../b.bin\" leaves the folder of the glTF: only files in the \
             folder of the glTF or below are read",
        ),
        (
            json!({"uri": "data:;base64,AAAA*AAA"}),
            "/buffers/0/uri: the base64 data is wrong at character 4 of 8",
        ),
        (
            json!({"uri": "data:text/plain,hello"}),
            "/buffers/0/uri: the data: URI is not base64: export it as base64 or as a file",
        ),
        (
            json!({"uri": "sub\\d.bin"}),
            "/buffers/0/uri: \"sub\\\\d.bin\" has a backslash, which separates no folders in a URI: write \
             \"sub/d.bin\"",
        ),
    ];
    for (buffer, expected) in cases {
        let mut json = json.clone();
        json["buffers"][0] = buffer;
        json["buffers"][0]["byteLength"] = json!(76);
        let found = error("scene.gltf", json.to_string().into_bytes());
        assert_eq!(found, format!("scene.gltf: {expected}"));
        // A buffer that nothing needs is no fault.
        json.as_object_mut().unwrap().remove("meshes");
        let path = Path::new("scene.gltf");
        let bytes = json.to_string().into_bytes();
        let document = Document::from_bytes(bytes, Format::Gltf, path, Limits::default());
        assert!(document.unwrap().meshes().is_empty());
    }
}

#[test]
fn the_container_is_broken() {
    let cases: [(&[u8], &str); 5] = [
        (
            b"",
            "byte 0: the file ends inside the GLB header (12 bytes). Fetch it again or re-export \
             it: it is incomplete",
        ),
        (
            b"solid cube\n",
            "byte 0: a GLB starts with the letters glTF: this is another kind of file",
        ),
        (
            b"glTF\x01\0\0\0\x0C\0\0\0",
            "byte 4: GLB version 1: only version 2 is read, re-export it",
        ),
        (
            b"glTF\x02\0\0\0\x18\0\0\0\xFF\xFF\xFF\xFFJSON{}  ",
            "byte 12: the file ends inside a GLB chunk: 4294967295 bytes are promised, 4 are \
             there. Fetch it again or re-export it: it is incomplete",
        ),
        (
            b"glTF\x02\0\0\0\x18\0\0\0\x04\0\0\0JSON{]  ",
            "byte 20: the JSON cannot be read: key must be a string at line 1 column 2",
        ),
    ];
    for (bytes, expected) in cases {
        let found = error("scene.glb", bytes.to_vec());
        assert_eq!(found, format!("scene.glb: {expected}"));
    }
    let deep = format!("{}{}", "[".repeat(257), "]".repeat(257));
    assert_eq!(
        error("scene.gltf", deep.into_bytes()),
        "scene.gltf: 257 levels of JSON inside each other: more than the limit of 256"
    );
}

#[test]
fn the_limits_hold() {
    let (json, binary) = sound();
    let bytes = glb(&json.to_string(), Some(&binary));
    let mut few_vertices = Limits::default();
    few_vertices.vertices = 3;
    let mut few_faces = Limits::default();
    few_faces.faces = 1;
    for (limits, expected) in [
        (few_vertices, "4 vertices: more than the limit of 3"),
        (few_faces, "2 faces: more than the limit of 1"),
    ] {
        let expected = format!("scene.glb: /meshes/0/primitives/0: {expected}");
        assert_eq!(error_of(&bytes, "scene.glb", limits), expected);
    }
}

/// Bytes changed at random and files cut anywhere are an error or a result, never a panic.
#[test]
fn damage_never_panics() {
    let (json, binary) = sound();
    let bytes = glb(&json.to_string(), Some(&binary));
    let mut random = crate::Random(11);
    let path = Path::new("scene.glb");
    for _ in 0..20_000 {
        let mut damaged = bytes.clone();
        for _ in 0..=random.below(3) {
            let position = random.below(damaged.len());
            damaged[position] = match random.below(2) {
                0 => u8::try_from(random.below(256)).unwrap(),
                _ => b"0123456789-{}[],:\""[random.below(18)],
            };
        }
        if random.below(4) == 0 {
            damaged.truncate(random.below(damaged.len()));
        }
        let read = Document::from_bytes(damaged, Format::Glb, path, Limits::default());
        if let Ok(mut document) = read {
            crate::random_orders(&mut document, 5);
            document.to_main_bytes().unwrap();
        }
    }
}

/// What primitives share is looked at once, and what overlaps is left without comparing all pairs.
#[test]
fn files_made_to_waste_time_do_not() {
    let mut builder = Builder::default();
    let vertices = builder.data(F32, "VEC3", 60_000);
    let numbers: Vec<usize> = (0..300_000).map(|i| i % 60_000).collect();
    let indices = builder.indices(U16, &numbers);
    builder.accessors[indices]["max"] = json!([59_999]);
    let primitive = json!({"attributes": {"POSITION": vertices}, "indices": indices});
    let bytes = builder.glb(
        &json!([{"primitives": vec![primitive; 20_000]}]),
        &json!({}),
    );
    let path = Path::new("scene.glb");
    let read = |bytes| Document::from_bytes(bytes, Format::Glb, path, Limits::default());
    let document = read(bytes).unwrap();
    assert_eq!((document.meshes().len(), document.notes().len()), (1, 0));
    assert!(document.meshes()[0].vertices_movable);

    // Each of many accessors reads almost the same corners as all others.
    let mut primitives = Vec::new();
    for i in 0..10_000 {
        let indices = builder.accessor(1, 2 * i, U16, 240_000, "SCALAR");
        primitives.push(json!({"attributes": {"POSITION": vertices}, "indices": indices}));
    }
    let document = read(builder.glb(&json!([{"primitives": primitives}]), &json!({}))).unwrap();
    // Said once for each that another's bytes are shared with.
    let places: usize = document.notes().iter().map(|note| 1 + note.more).sum();
    assert_eq!((document.meshes().len(), places), (0, 10_000));
    assert!(document.notes().len() < 10);
}
