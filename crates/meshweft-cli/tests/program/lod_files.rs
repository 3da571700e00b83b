//! `lod build` and what is read of its files.

use crate::Folder;
use crate::basics::grid_obj;

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
         o b\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 5 6 7\nf 5 5 6\n",
    );
    let build = |flags: &[&str]| {
        folder.run(&[&["lod", "build", "two.obj", "-o", "two.mwl"], flags].concat())
    };
    let run = build(&[]);
    assert_eq!(run.code(), 1);
    for expected in [
        "two.obj: a .mwl file has positions and faces, and ",
        "texture coordinates (vt), materials (usemtl), several objects (o), ",
        "polygons, which become triangles",
        "drop_attributes",
    ] {
        assert!(run.err().contains(expected), "{}", run.err());
    }
    assert!(!folder.0.join("two.mwl").exists());
    let run = build(&["--drop-attributes"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "vertices 7, faces 3; ",
        "faces with two corners at one place, left out: 1",
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
            "points.off: there are no faces with three corners apart",
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
