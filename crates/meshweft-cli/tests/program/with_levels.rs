//! Files with levels of detail, as the program shows them.

use serde_json::json;

use crate::Folder;

/// A square as a glTF: two faces, one face of them as level 1 if that is wanted.
fn square(has_level: bool) -> String {
    let primitive = |indices: usize| json!([{"attributes": {"POSITION": 0}, "indices": indices}]);
    let mut nodes = json!([{"mesh": 0}, {"mesh": 1}]);
    let mut meshes = json!([
        {"name": "square", "primitives": primitive(1)},
        {
            "name": "half", "primitives": primitive(2),
            "extras": {"MESHWEFT_level": {"level": 1, "error": 0.5}},
        },
    ]);
    nodes[0]["extensions"] = json!({"MSFT_lod": {"ids": [1]}});
    if !has_level {
        for list in [&mut nodes, &mut meshes] {
            list.as_array_mut().unwrap().truncate(1);
        }
    }
    let json = json!({
        "asset": {"version": "2.0"}, "extensionsUsed": ["MSFT_lod"],
        "buffers": [{"byteLength": 57, "uri": "square.bin"}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 6},
            {"buffer": 0, "byteOffset": 54, "byteLength": 3},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5121, "count": 3, "type": "SCALAR"},
        ],
        "meshes": meshes, "nodes": nodes, "scenes": [{"nodes": [0]}], "scene": 0,
    });
    json.to_string()
}

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    let positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0_u8]];
    let numbers = positions.as_flattened().iter();
    let mut binary: Vec<u8> = numbers.flat_map(|&x| f32::from(x).to_le_bytes()).collect();
    binary.extend([0, 1, 2, 2, 1, 3, 0, 1, 2]);
    folder.write("square.bin", binary);
    folder.write("levels.gltf", square(true));
    folder.write("plain.gltf", square(false));
    folder
}

#[test]
fn inspect_lists_levels_below_their_mesh() {
    let folder = folder("inspect-with-levels");
    let run = folder.run(&["inspect", "levels.gltf", "--cache", "fifo:12"]);
    let expected = "levels.gltf\n\
                    mesh                  faces  vertices  used  ACMR fifo:12   ATVR\n\
                    square                    2         4     4         2.000  1.000\n  \
                      level 1, error 0.5      1         4     3         3.000  1.000\n";
    assert_eq!((run.code(), run.out()), (0, expected.to_owned()));
    let json = folder.run(&["inspect", "levels.gltf", "--json"]).json();
    assert_eq!(json["meshes"][0]["levels"][0]["error"], 0.5);
    assert_eq!(json["total"]["faces"], 2);
}

#[test]
fn compare_says_that_a_file_only_has_levels_more() {
    let folder = folder("compare-with-levels");
    let run = folder.run(&["compare", "plain.gltf", "levels.gltf"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let expected = "b: levels.gltf\nthe same triangles\nlevels of detail: 0 in a, 1 in b\n  level 1: only in b, faces: 1\n";
    assert!(run.out().contains(expected), "{}", run.out());
    let run = folder.run(&["compare", "levels.gltf", "levels.gltf"]);
    let expected = "the same triangles\nlevels of detail: 1 in both\n  level 1: the same triangles, faces: 1\n";
    assert!(run.out().contains(expected), "{}", run.out());
}

#[test]
fn what_has_levels_is_not_simplified() {
    let folder = folder("simplify-with-levels");
    let run = folder.run(&[
        "simplify",
        "levels.gltf",
        "--ratio",
        "0.5",
        "-o",
        "out.gltf",
    ]);
    assert_eq!(run.code(), 1);
    let expected = "levels.gltf: square has levels of detail already: simplify the file that they were made from";
    assert!(run.err().contains(expected), "{}", run.err());
    assert!(!folder.0.join("out.gltf").exists());
}
