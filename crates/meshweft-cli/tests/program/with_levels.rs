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

/// A wavy sheet of 16 by 16 squares as an OFF file.
fn sheet() -> String {
    let mut text = "OFF\n289 512 0\n".to_owned();
    for v in 0..289 {
        let (x, y) = (v % 17, v / 17);
        let height = (f64::from(x) * 0.4).sin() + (f64::from(y) * 0.3).cos();
        text += &format!("{x} {y} {height:.4}\n");
    }
    for square in 0..256 {
        let corner = square / 16 * 17 + square % 16;
        let above = corner + 17;
        text += &format!("3 {corner} {} {above}\n", corner + 1);
        text += &format!("3 {} {} {above}\n", corner + 1, above + 1);
    }
    text
}

#[test]
fn levels_of_any_format_are_one_glb_or_a_file_each() {
    let folder = Folder::new("levels-written");
    folder.write("sheet.off", sheet());
    let run = folder.run(&[
        "levels",
        "sheet.off",
        "--ratios",
        ".5,.2",
        "-o",
        "sheet.glb",
    ]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let out = run.out();
    let mut lines = out.lines();
    assert_eq!(lines.next(), Some("sheet.off"));
    let faces = [
        "level 0: 512 faces (100.0 %)",
        "level 1: 256 faces (50.0 %)",
        "level 2: 102 faces (19.9 %)",
    ];
    for expected in faces {
        assert!(lines.next().unwrap().contains(expected), "{}", run.out());
    }
    assert_eq!(lines.next(), Some("  written to sheet.glb"));

    // In JSON; levels are not added twice.
    let run = folder.run(&[
        "levels",
        "sheet.off",
        "--faces",
        "200",
        "--dry-run",
        "--json",
    ]);
    let report = run.json();
    assert_eq!(
        (&report["command"], &report["faces"]),
        (&json!("levels"), &json!([200]))
    );
    // A vertex that leaves takes one face or two with it.
    assert_eq!(report["levels"][1]["faces"], json!(199));
    let run = folder.run(&["levels", "sheet.glb", "-o", "again.glb"]);
    assert_eq!(run.code(), 1);
    assert_eq!(
        run.err(),
        "error: sheet.glb: mesh has levels of detail already (MSFT_lod): start from the file that they were made from\n"
    );

    // What a client fetches: half of the levels is less than half of the bytes.
    let streamed = [
        "levels",
        "sheet.off",
        "--layout",
        "stream",
        "-o",
        "streamed.glb",
    ];
    assert_eq!(folder.run(&streamed).code(), 0);
    let run = folder.run(&["levels", "--ranges", "streamed.glb", "--json"]);
    let report = run.json();
    assert_eq!(report["command"], json!("levels ranges"));
    let levels = report["levels"].as_array().unwrap();
    assert_eq!(levels[0]["level"], json!(3));
    assert!(levels[0]["share"].as_f64().unwrap() < 0.2, "{}", run.out());

    // A file each.
    let run = folder.run(&[
        "levels",
        "sheet.off",
        "--ratios",
        ".5,.2",
        "--separate",
        "-o",
        "apart.off",
    ]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.out()
            .ends_with("  written to apart_LOD1.off, apart_LOD2.off\n"),
        "{}",
        run.out()
    );
    let run = folder.run(&["inspect", "apart_LOD2.off", "--json"]);
    let report = run.json();
    let faces = report["total"]["faces"].as_u64().unwrap();
    assert!((100..=102).contains(&faces), "{faces}");
}

#[test]
fn levels_that_make_no_sense_are_bad_usage() {
    let folder = Folder::new("levels-refused");
    folder.write("sheet.off", sheet());
    folder.write("sheet_LOD1.off", sheet());
    for (flags, expected) in [
        (
            &["--ratios", ".2,.5", "-o", "a.glb"][..],
            "error: each level must be coarser than the one before it",
        ),
        (
            &["-o", "a.ply"],
            "error: sheet.off: a .glb is made of it: give the output that ending, not a.ply",
        ),
        (
            &["--ratios", ".5", "--faces", "9", "-o", "a.glb"],
            "error: the argument '--ratios <R,…>' cannot be used with",
        ),
        (
            &["sheet_LOD1.off", "--separate", "-o", "."],
            "error: ./sheet_LOD1.off would be written over by sheet.off, and is an input too",
        ),
    ] {
        let run = folder.run(&[&["levels", "sheet.off"], flags].concat());
        assert_eq!(run.code(), 2, "{}", run.err());
        assert!(run.err().starts_with(expected), "{}", run.err());
    }
    assert_eq!(folder.read("sheet_LOD1.off"), sheet().into_bytes());
}
