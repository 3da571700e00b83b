//! `lod build` and what is read of its files.

use std::fs;

use crate::Folder;
use crate::basics::grid_obj;
use crate::lod::waves_off;

#[test]
fn a_mesh_becomes_a_file() {
    let folder = Folder::new("lod-build");
    folder.write("grid.obj", grid_obj());
    let run = folder.run(&["lod", "build", "grid.obj", "-o", "grid.mwl"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "grid.obj: vertices 441, faces 800; coarsest with vertices ",
        ", depth ",
        "; read back and compared",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    let bytes = folder.read("grid.mwl");
    assert!(bytes.starts_with(b"MWLD"));

    // Again, and the same; nothing is written where nothing should.
    let again = ["lod", "build", "grid.obj", "-o", "grid.mwl", "--json"];
    let report = folder.run(&again).json();
    assert_eq!(report["command"], "lod build");
    assert_eq!(report["bytes"]["after"], bytes.len());
    assert_eq!(
        (&report["vertices"], &report["faces"]),
        (&441.into(), &800.into())
    );
    assert_eq!(
        (&report["flat_faces"], &report["cut_points"]),
        (&0.into(), &0.into())
    );
    assert_eq!(folder.read("grid.mwl"), bytes);
    let run = folder.run(&["lod", "build", "grid.obj", "--dry-run", "-o", "no.mwl"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(!folder.0.join("no.mwl").exists());
}

#[test]
fn what_a_file_would_lose_is_named() {
    let folder = Folder::new("lod-build-lost");
    folder.write(
        "two.obj",
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 4/1 3/1\n\
         o b\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 9 9 9\nv 8 8 8\nf 5 6 7\nf 5 5 6\n",
    );
    let build = |flags: &[&str]| {
        folder.run(&[&["lod", "build", "two.obj", "-o", "two.mwl"], flags].concat())
    };
    let run = build(&[]);
    assert_eq!(run.code(), 1);
    for expected in [
        "two.obj: a .mwl file has positions, faces and attributes that all vertices have, and ",
        "texture coordinates (vt), materials (usemtl), several objects (o), ",
        "polygons, which become triangles",
        "--drop-attributes",
    ] {
        assert!(run.err().contains(expected), "{}", run.err());
    }
    folder.write(
        "chart.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
    );
    let run = folder.run(&["lod", "build", "chart.obj", "-o", "two.mwl"]);
    let expected = "also stores TEXCOORD_0 of corners. Leave them out";
    assert_eq!(run.code(), 1);
    assert!(run.err().contains(expected), "{}", run.err());
    assert!(!folder.0.join("two.mwl").exists());
    let run = build(&["--drop-attributes"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "vertices 7, faces 3; ",
        "faces with two corners at one place, left out: 1",
        "vertices that no face uses, left out: 2",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
}

#[test]
fn no_file_of_others_is_written_over() {
    let folder = Folder::new("lod-build-safe");
    folder.write("grid.obj", grid_obj());
    folder.write("other.mwl", "somebody's notes");
    folder.write("points.off", "OFF\n2 0 0\n0 0 0\n1 1 1\n");
    let cases = [
        (
            &["grid.obj", "-o", "other.mwl"][..],
            2,
            "not one that --output writes",
        ),
        (
            &["grid.obj", "-o", "grid.obj"],
            2,
            "give the output the ending .mwl",
        ),
        (&["grid.obj"], 2, "--output"),
        (
            &["points.off", "-o", "a.mwl"],
            1,
            "points.off: no face has three different corners",
        ),
        (&["gone.obj", "-o", "a.mwl"], 1, "gone.obj"),
    ];
    for (flags, code, expected) in cases {
        let run = folder.run(&[&["lod", "build"], flags].concat());
        assert_eq!(run.code(), code, "{}", run.err());
        assert!(run.err().contains(expected), "{}", run.err());
    }
    assert_eq!(folder.read("other.mwl"), b"somebody's notes");
    let forced = ["lod", "build", "grid.obj", "-o", "other.mwl", "--force"];
    assert_eq!(folder.run(&forced).code(), 0);
}

#[test]
fn a_mesh_is_taken_from_a_file() {
    let folder = Folder::new("lod-extract");
    folder.write("waves.off", waves_off());
    let build = ["lod", "build", "waves.off", "-o", "waves.mwl"];
    assert_eq!(folder.run(&build).code(), 0);
    let extract = |flags: &[&str]| folder.run(&[&["lod", "extract", "waves.mwl"], flags].concat());

    // All of it, in every format.
    for name in [
        "all.glb", "all.gltf", "all.ply", "all.obj", "all.off", "all.stl",
    ] {
        let run = extract(&["--error", "0", "-o", name]);
        assert_eq!(run.code(), 0, "{}", run.err());
        let expected = format!("waves.mwl -> {name}: vertices 2601 of 2601, faces 5000\nread ");
        assert!(run.out().contains(&expected), "{}", run.out());
        let run = folder.run(&["compare", "waves.off", name]);
        assert_eq!(run.code(), 0, "{name}: {}{}", run.out(), run.err());
    }

    // Less of it.
    let json = |flags: &[&str]| {
        let run = extract(&[flags, &["-o", "some.ply", "--force", "--json"]].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        run.json()
    };
    let number = |report: &serde_json::Value, name: &str| report[name].as_f64().unwrap();
    let coarse = json(&["--error", ".2"]);
    assert_eq!(coarse["command"], "lod extract");
    assert!(number(&coarse, "error") <= 0.2);
    assert!(number(&coarse, "faces") < 2500.0);
    assert!(number(&coarse, "bytes_read") < coarse["bytes"]["before"].as_f64().unwrap());
    assert_eq!(folder.read("some.ply").len(), coarse["bytes"]["after"]);
    let few = json(&["--vertices", "500"]);
    assert!(number(&few, "vertices") <= 500.0 && number(&few, "vertices") > 450.0);

    // What a camera sees.
    folder.write(
        "cameras.json",
        r#"{"frames": [{"eye": [0, 9, 6], "target": [6, 0, 6]}, {"eye": [0, 900, 6], "target": [6, 0, 6]}]}"#,
    );
    let near = json(&[
        "--camera",
        "cameras.json",
        "--tolerance",
        "3",
        "--size",
        "400x300",
    ]);
    let far = json(&["--camera", "cameras.json", "--frame", "1"]);
    let walk = [
        "lod",
        "walk",
        "waves.off",
        "--path",
        "cameras.json",
        "--tolerance",
        "3",
        "--json",
    ];
    let walk = folder
        .run(&[&walk[..], &["--size", "400x300"]].concat())
        .json();
    assert_eq!(walk["frames"][0]["faces"], near["faces"]);
    assert!(number(&far, "faces") < number(&near, "faces"));
}

#[test]
fn what_cannot_be_extracted_is_told() {
    let folder = Folder::new("lod-extract-errors");
    folder.write("waves.off", waves_off());
    folder.write(
        "cameras.json",
        r#"{"frames": [{"eye": [0, 9, 6], "target": [6, 0, 6]}]}"#,
    );
    let build = ["lod", "build", "waves.off", "-o", "waves.mwl"];
    assert_eq!(folder.run(&build).code(), 0);
    let mut damaged = folder.read("waves.mwl");
    let last = damaged.len() - 1;
    damaged[last] ^= 1;
    folder.write("damaged.mwl", &damaged);
    folder.write("cut.mwl", &damaged[..last]);
    folder.write("there.ply", "mine");
    let all = ["--error", "0", "-o", "a.ply"];
    let cases = [
        (
            &["waves.mwl", "-o", "a.ply"][..],
            2,
            "--error <LENGTH>|--vertices <N>|--camera",
        ),
        (
            &[
                "waves.mwl",
                "--error",
                "1",
                "--vertices",
                "9",
                "-o",
                "a.ply",
            ],
            2,
            "cannot be used with",
        ),
        (
            &["waves.mwl", "--error", "1", "--frame", "0", "-o", "a.ply"],
            2,
            "cannot be used with",
        ),
        (
            &["waves.mwl", "--error=-1", "-o", "a.ply"],
            2,
            "--error -1: give a length",
        ),
        (
            &[
                "waves.mwl",
                "--camera",
                "cameras.json",
                "--frame",
                "1",
                "-o",
                "a.ply",
            ],
            2,
            "--frame 1: cameras.json has the frames 0 to 0",
        ),
        (
            &[
                "waves.mwl",
                "--camera",
                "cameras.json",
                "--tolerance",
                "0",
                "-o",
                "a.ply",
            ],
            2,
            "--tolerance 0: give a number of pixels above 0",
        ),
        (
            &["waves.mwl", "--vertices", "2", "-o", "a.ply"],
            1,
            "there is no mesh of 2 vertices or fewer: the coarsest has ",
        ),
        (&["waves.mwl", "--error", "0", "-o", "a.xyz"], 1, "a.xyz"),
        (
            &["waves.mwl", "--error", "0", "-o", "there.ply"],
            1,
            "--force",
        ),
        (
            &[&["waves.off"], &all[..]].concat(),
            1,
            "waves.off: byte 0: this is not a .mwl file",
        ),
        (
            &[&["damaged.mwl"], &all[..]].concat(),
            1,
            "damaged.mwl: byte ",
        ),
        (&[&["damaged.mwl"], &all[..]].concat(), 1, "build it again"),
        (&[&["cut.mwl"], &all[..]].concat(), 1, "cut.mwl: byte "),
        (&[&["gone.mwl"], &all[..]].concat(), 1, "gone.mwl"),
        (
            &[&["waves.mwl", "--max-bytes", "1K"], &all[..]].concat(),
            1,
            "more than the limit of 1024",
        ),
    ];
    for (flags, code, expected) in cases {
        let run = folder.run(&[&["lod", "extract"], flags].concat());
        assert_eq!(run.code(), code, "{flags:?} {}", run.err());
        assert!(run.err().contains(expected), "{flags:?} {}", run.err());
    }
    assert!(!folder.0.join("a.ply").exists());
    assert_eq!(folder.read("there.ply"), b"mine");

    // No flag lets it write over its own input.
    let input = folder.read("waves.mwl");
    fs::hard_link(folder.0.join("waves.mwl"), folder.0.join("again.svg")).unwrap();
    let run = folder.run(&[
        "lod",
        "extract",
        "waves.mwl",
        "--error",
        "0",
        "-o",
        "waves.mwl",
        "--force",
    ]);
    assert_eq!(run.code(), 2, "{}", run.err());
    let flags = ["--plot", "again.svg", "--force", "--frames", "2"];
    folder.run(&[&["lod", "walk", "waves.mwl"], &flags[..]].concat());
    assert!(folder.read("waves.mwl") == input);
}

#[test]
fn what_vertices_store_goes_along() {
    let folder = Folder::new("lod-attributes");
    let mut text = String::from(
        "ply\nformat ascii 1.0\nelement vertex 441\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n\
         property uchar blue\nelement face 800\nproperty list uchar int vertex_indices\nend_header\n",
    );
    for i in 0..441 {
        let (x, y) = (i % 21, i / 21);
        text += &format!("{x} {y} 0.5 0 0 1 {} {} 0\n", 12 * x, 10 * y);
    }
    for i in (0..420).filter(|i| i % 21 != 20) {
        text += &format!(
            "3 {i} {} {}\n3 {} {} {}\n",
            i + 1,
            i + 21,
            i + 21,
            i + 1,
            i + 22
        );
    }
    folder.write("grid.ply", text);
    let run = folder.run(&["lod", "build", "grid.ply", "-o", "grid.mwl"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.out().contains("with each vertex: NORMAL, COLOR_0\n"),
        "{}",
        run.out()
    );
    let extract = |flags: &[&str]| folder.run(&[&["lod", "extract", "grid.mwl"], flags].concat());
    let run = extract(&["--error", "0", "-o", "back.ply"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let head = String::from_utf8_lossy(&folder.read("back.ply")).into_owned();
    for property in ["float nx", "uchar blue"] {
        assert!(head.contains(&format!("property {property}")), "{head}");
    }
    let run = folder.run(&["compare", "grid.ply", "back.ply"]);
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());

    // Where a format has no room for that.
    let run = extract(&["--error", "0", "-o", "back.obj"]);
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("leave NORMAL out"), "{}", run.err());
    let run = extract(&["--error", "0", "--positions-only", "-o", "back.obj"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let plain = [
        "lod",
        "build",
        "grid.ply",
        "-o",
        "plain.mwl",
        "--positions-only",
    ];
    assert!(!folder.run(&plain).out().contains("with each vertex"));
    assert!(folder.read("plain.mwl").len() < folder.read("grid.mwl").len());
}
