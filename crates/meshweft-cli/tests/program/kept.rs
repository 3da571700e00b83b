//! `compress` keeps all of a file, or says what it does not: every file at hand, looked at as plain text here.

mod contents;

use std::fs;
use std::path::Path;

use crate::data::files;
use crate::{Folder, data_folder};
use contents::{Contents, contents};

/// What the program says where it refuses a file for what is in it, but for other things than meshes.
const OTHER_REFUSALS: &[&str] = &[
    "no mesh to compress",
    "has faces that cannot be read",
    "have more bits than a 32-bit float",
];

#[derive(Debug, Default)]
struct Outcomes {
    kept: usize,
    named: usize,
    otherwise: usize,
    unreadable: usize,
}

#[test]
fn every_file_is_kept_whole_or_refused_by_name() {
    let Some(data) = data_folder("files to compress") else {
        return;
    };
    let endings = &[
        ".obj", ".ply", ".off", ".stl", ".wrl", ".glb", ".gltf", ".vrm",
    ];
    let mut outcomes = Outcomes::default();
    for path in files(&data, endings) {
        // The largest take minutes without optimisation, and are like others.
        if fs::metadata(&path).unwrap().len() < 1_100_000 {
            look(&path, &mut outcomes);
        }
    }
    println!("{outcomes:?}");
    assert!(outcomes.kept > 60 && outcomes.named > 50, "{outcomes:?}");
}

/// Compresses a file and looks at what comes back, or at why it does not.
fn look(path: &Path, outcomes: &mut Outcomes) {
    let folder = Folder::new("kept");
    let shown = path.display();
    let name = path.file_name().unwrap().to_str().unwrap();
    let name = name.strip_suffix(".gz").unwrap_or(name);
    let compress = ["compress", path.to_str().unwrap(), "-o", "some.mwz"];
    let flags = ["--tier", "fast", "--root", "0", "--keep-order", "both"];
    let mut run = folder.run(&[&compress[..], &flags].concat());
    if run.err().contains("--triangles") {
        run = folder.run(&[&compress[..], &flags, &["--triangles"]].concat());
        if run.code() == 0 {
            outcomes.otherwise += 1;
            return;
        }
    }
    let error = run.err();

    // Refused: everything is named.
    if run.code() != 0 {
        assert_eq!(run.code(), 1, "{shown}: {error}");
        let Some((_, named)) = error.split_once("positions and faces are compressed, and ") else {
            match OTHER_REFUSALS.iter().any(|text| error.contains(text)) {
                true => outcomes.otherwise += 1,
                false => outcomes.unreadable += 1,
            }
            return;
        };
        outcomes.named += 1;
        assert!(named.contains("--drop-attributes"), "{shown}: {error}");
        if let Some(Contents { others, .. }) = contents(path) {
            assert!(!others.is_empty(), "{shown} has nothing else: {error}");
            for (what, names) in &others {
                let is_named = names.iter().any(|name| named.contains(name));
                assert!(is_named, "{shown}: {what} is not named: {error}");
            }
        }
        return;
    }

    // Taken: all of it comes back, but for polygons that are said to be triangles now.
    outcomes.kept += 1;
    let is_cut = [run.out(), run.err()].concat().contains("stored as");
    let back = name.replace(".gltf", ".glb").replace(".wrl", ".glb");
    let run = folder.run(&["decompress", "some.mwz", "-o", &back]);
    if run
        .err()
        .contains("is not finite, which OBJ files have no number for")
    {
        return;
    }
    assert_eq!(run.code(), 0, "{shown}: {}", run.err());
    match [path, &folder.0.join(&back)].map(contents) {
        [Some(source), Some(mut result)] if !is_cut => {
            // What had no name gets one.
            if source.name.is_empty() {
                result.name.clear();
            }
            assert!(source.others.is_empty(), "{shown} lost {:?}", source.others);
            assert!(source == result, "{shown} came back as something else");
        }
        _ => {
            let run = folder.run(&["compare", path.to_str().unwrap(), &back, "--json"]);
            assert_eq!(run.json()["same_triangles"], true, "{shown}");
        }
    }
}

#[test]
fn what_only_some_of_a_file_has_is_named() {
    let folder = Folder::new("kept-some");
    let named = |name: &str, text: &[u8], expected: &[&str]| {
        folder.write(name, text);
        let arguments = ["compress", name, "-o", "some.mwz", "--force"];
        let run = folder.run(&arguments);
        assert_eq!(run.code(), 1, "{name}: {}", run.out());
        for expected in expected {
            assert!(run.err().contains(expected), "{expected}: {}", run.err());
        }
        let run = folder.run(&[&arguments[..], &["--drop-attributes"]].concat());
        assert_eq!(run.code(), 0, "{name}: {}", run.err());
        assert!(run.out().contains("nothing else"), "{}", run.out());
    };
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\ng wheel\nusemtl red\ns 1\nf 1/1 2/1 3/1\ns off\n\
        f 3 2 1\nl 1 2\n";
    let obj_names = ["(vt)", "(g)", "(usemtl)", "(s)", "(l)"];
    named("some.obj", obj.as_bytes(), &obj_names);
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nproperty list uchar int links\n\
        element edge 1\nproperty int vertex1\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 7\n0\n";
    named("some.ply", ply.as_bytes(), &["\"links\"", "\"edge\""]);
    let off = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n3 2 1 0\n";
    named("some.off", off.as_bytes(), &["colors of some faces"]);
    let off = "4OFF\n3 1 0\n0 0 0 2\n1 0 0 2\n0 1 0 2\n3 0 1 2\n";
    named("four.off", off.as_bytes(), &["more numbers of vertices"]);
    let stl = |name: &str| {
        format!(
            "solid {name}\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
             endfacet\nendsolid\n"
        )
    };
    let two = stl("a") + &stl("b");
    named("two.stl", two.as_bytes(), &["several solids"]);
    let turned = stl("a").replace("0 0 1", "0 1 0");
    named("turned.stl", turned.as_bytes(), &["NORMAL of faces"]);
    folder.write("one.stl", stl("a"));
    let run = folder.run(&["compress", "one.stl", "-o", "some.mwz", "--force"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let vrml = "#VRML V2.0 utf8\nTransform { children Shape { appearance Appearance { material Material { } } \
        geometry IndexedFaceSet { solid FALSE coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } \
        coordIndex [0 1 2 -1] } } }\n";
    let vrml_names = ["\"Transform\"", "\"Material\"", "(solid FALSE)"];
    named("some.wrl", vrml.as_bytes(), &vrml_names);

    let buffer = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let gltf = serde_json::json!({
        "asset": {"version": "2.0", "copyright": "somebody"},
        "buffers": [{"byteLength": 36, "uri": format!("data:application/octet-stream;base64,{buffer}")}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"name": "a", "primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0, "name": "a"}],
        "scenes": [{"nodes": [0]}],
        "scene": 0
    });
    folder.write("plain.gltf", gltf.to_string());
    let run = folder.run(&["compress", "plain.gltf", "-o", "some.mwz", "--force"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let with = |pointer: &str, key: &str, value: serde_json::Value| {
        let mut changed = gltf.clone();
        changed.pointer_mut(pointer).unwrap()[key] = value;
        changed.to_string()
    };
    for (pointer, key, value, expected) in [
        ("/nodes/0", "scale", "[2,2,2]", "scale of nodes"),
        ("/nodes/0", "name", "\"b\"", "names of nodes"),
        ("", "materials", "[{}]", "1 material."),
        ("", "animations", "[{}, {}]", "2 animations"),
        ("", "extras", "{}", "extras"),
        (
            "",
            "nodes",
            "[{\"mesh\":0},{\"mesh\":0}]",
            "several nodes draw",
        ),
        ("/meshes/0", "extras", "1", "extras of meshes"),
        (
            "/meshes/0/primitives/0",
            "extras",
            "1",
            "extras of primitives",
        ),
    ] {
        let value = serde_json::from_str(value).unwrap();
        named(
            "some.gltf",
            with(pointer, key, value).as_bytes(),
            &[expected],
        );
    }

    // Primitives with one list of faces are one mesh: its positions must be those of both.
    let mut changed = gltf.clone();
    let floats = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32];
    let positions = floats.map(f32::to_le_bytes).concat();
    folder.write(
        "some.bin",
        [&positions[..], &positions, &[0, 0, 1, 0, 2, 0]].concat(),
    );
    let float = |view| serde_json::json!({"bufferView": view, "componentType": 5126, "count": 3, "type": "VEC3"});
    changed["buffers"] = serde_json::json!([{"byteLength": 78, "uri": "some.bin"}]);
    changed["bufferViews"] = serde_json::json!([
        {"buffer": 0, "byteLength": 36},
        {"buffer": 0, "byteOffset": 36, "byteLength": 36},
        {"buffer": 0, "byteOffset": 72, "byteLength": 6}
    ]);
    changed["accessors"] = serde_json::json!([
        float(0), float(1), {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"}
    ]);
    let with_second = |position| {
        let mut changed = changed.clone();
        changed["meshes"][0]["primitives"] = serde_json::json!([
            {"attributes": {"POSITION": 0}, "indices": 2},
            {"attributes": {"POSITION": position}, "indices": 2}
        ]);
        changed.to_string()
    };
    let same = "primitives with the same faces";
    named("some.gltf", with_second(0).as_bytes(), &[same]);
    folder.write("other.gltf", with_second(1));
    let arguments = [
        "compress",
        "other.gltf",
        "-o",
        "some.mwz",
        "--force",
        "--drop-attributes",
    ];
    let run = folder.run(&arguments);
    assert_eq!(run.code(), 1, "{}", run.out());
    assert!(
        run.err().contains("mesh 0, primitive 1 has faces"),
        "{}",
        run.err()
    );
}
