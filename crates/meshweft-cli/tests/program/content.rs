//! What a file is, whatever it is called.

use std::fs;

use crate::Folder;

/// Faces whose order can be improved, as VRML.
fn wrl() -> String {
    let points: String = (0..60).map(|i| format!("{} {} 0,", i / 2, i % 2)).collect();
    let first = |i: u32| i * 23 % 58;
    let faces: String = (0..58)
        .map(|i| format!("{} {} {} -1 ", first(i), first(i) + 1, first(i) + 2))
        .collect();
    format!(
        "#VRML V2.0 utf8\nShape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [ {points} ] }} \
         coordIndex [ {faces} ] }} }}\n"
    )
}

#[test]
fn a_compressed_file_stays_so_under_its_name() {
    let folder = Folder::new("content-gzip");
    folder.write("plain.wrl", wrl());
    let packed = folder.run(&["optimize", "plain.wrl", "-o", "best.wrl.gz"]);
    assert_eq!(packed.code(), 0, "{}", packed.err());
    fs::rename(folder.0.join("best.wrl.gz"), folder.0.join("best.wrl")).unwrap();
    let best = folder.read("best.wrl");

    // Nothing to improve: the bytes stay as they are.
    let run = folder.run(&["optimize", "best.wrl", "-o", "copy.wrl"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(run.out().contains("nothing to improve"), "{}", run.out());
    assert_eq!(folder.read("copy.wrl"), best);

    // Something to improve: compressed again.
    let run = folder.run(&[
        "optimize",
        "best.wrl",
        "-o",
        "fifo.wrl",
        "--cache",
        "fifo:4",
        "--allow-worse",
    ]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.read("fifo.wrl").starts_with(b"\x1f\x8b"));
    let run = folder.run(&["compare", "plain.wrl", "fifo.wrl"]);
    assert!(run.out().contains("the same triangles"), "{}", run.out());
}

#[test]
fn a_vrm_is_a_glb() {
    let folder = Folder::new("content-vrm");
    let json = r#"{"asset":{"version":"2.0"}}"#;
    let json = format!("{json:<28}");
    let lengths = [48_u32, 28].map(u32::to_le_bytes);
    let glb = [
        b"glTF\x02\0\0\0",
        &lengths[0][..],
        &lengths[1],
        b"JSON",
        json.as_bytes(),
    ]
    .concat();
    fs::create_dir(folder.0.join("in")).unwrap();
    folder.write("in/avatar.vrm", &glb);
    let run = folder.run(&["optimize", "in", "-o", "out"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(folder.read("out/avatar.vrm"), glb);
    let run = folder.run(&["optimize", "in/avatar.vrm", "-o", "avatar.glb"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(folder.read("avatar.glb"), glb);
}

#[test]
fn what_is_no_mesh_or_not_there_is_said() {
    let folder = Folder::new("content-other");
    folder.write("page.obj", "<!DOCTYPE html>\n<html></html>\n");
    folder.write("text.obj", "Not Found\n");
    for (name, expected) in [
        ("page.obj", "this is an HTML page, and no mesh file"),
        ("text.obj", "no line is an OBJ statement"),
        ("missing.xyz", "No such file"),
        ("missing", "No such file"),
    ] {
        for verb in ["inspect", "optimize"] {
            let output = ["-o", "o.obj"];
            let output = if verb == "optimize" { &output[..] } else { &[] };
            let run = folder.run(&[&[verb, name][..], output].concat());
            assert_eq!(run.code(), 1, "{name}");
            assert!(run.err().contains(expected), "{}", run.err());
            assert!(!folder.0.join("o.obj").exists());
        }
    }
}
