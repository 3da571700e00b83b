//! `cull build` and `cull stats`: tables of which faces need not be drawn.

use std::fs;

use crate::Folder;
use crate::basics::grid_obj;

/// The positions and faces of an octahedron whose faces are cut in four, three times, as OFF.
fn ball_off() -> String {
    let mut corners = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0_f64],
    ];
    let mut faces: Vec<[usize; 3]> = Vec::new();
    for [x, y, z] in [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]] {
        faces.extend([[x, y, z], [y, x, 5]]);
    }
    for _ in 0..3 {
        let cut = faces.iter().flat_map(|&[a, b, c]| {
            let mut between = |a: usize, b: usize| {
                let sum = [0, 1, 2].map(|i| corners[a][i] + corners[b][i]);
                let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                corners.push(sum.map(|x| x / length));
                corners.len() - 1
            };
            let [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        });
        faces = cut.collect();
    }
    let lines = corners.iter().map(|[x, y, z]| format!("{x} {y} {z}\n"));
    let records = faces.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n"));
    let (count, records): (usize, String) = (faces.len(), records.collect());
    let lines: String = lines.collect();
    format!("OFF\n{} {count} 0\n{lines}{records}", corners.len())
}

#[test]
fn a_table_is_built_counted_and_kept() {
    let folder = Folder::new("cull");
    folder.write("ball.off", ball_off());
    let run = folder.run(&["cull", "build", "ball.off", "-o", "ball.glb"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "ball.off\n  1 mesh with 512 faces in ",
        "written to ball.glb",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    let run = folder.run(&["compare", "ball.off", "ball.glb"]);
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());

    let run = folder.run(&["cull", "stats", "ball.glb", "--plot", "ball.svg"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "1 mesh with 512 faces in ",
        "orthographic ",
        "whole mesh ",
        "misses per face",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    let svg = String::from_utf8(folder.read("ball.svg")).unwrap();
    assert_eq!(svg.matches("<polyline").count(), 4);
    let stats = || folder.run(&["cull", "stats", "ball.glb", "--json"]).json();
    let before = stats();
    assert_eq!(before["command"], "cull stats");
    let views = before["total"]["views"].as_array().unwrap();
    assert_eq!(views.len(), 5);
    assert_eq!(
        (&views[0]["distance"], &views[4]["distance"]),
        (&1.5.into(), &().into())
    );
    for view in views {
        let number = |name: &str| view[name].as_f64().unwrap();
        assert_eq!(number("front_faces_rejected"), 0.0);
        assert!(
            number("drawn") < 1.0 && number("back_faces_rejected") > 0.0,
            "{view}"
        );
        assert!(number("draws") >= 1.0);
    }

    // The whole mesh can be ordered, inside the clusters; nothing else changes.
    let run = folder.run(&["optimize", "ball.glb", "--in-place", "--allow-worse"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for (before, after) in views
        .iter()
        .zip(stats()["total"]["views"].as_array().unwrap())
    {
        for name in [
            "drawn",
            "draws",
            "back_faces_rejected",
            "front_faces_rejected",
        ] {
            assert_eq!(before[name], after[name], "{name}");
        }
    }

    // A second table is refused, fewer faces are too.
    let ordered = folder.read("ball.glb");
    let run = folder.run(&["cull", "build", "ball.glb", "-o", "again.glb"]);
    assert_eq!(run.code(), 1);
    let expected =
        "has a culling table already (MESHWEFT_culling): start from the file that it was made of";
    assert!(run.err().contains(expected), "{}", run.err());
    let run = folder.run(&["simplify", "ball.glb", "--ratio", ".5", "--in-place"]);
    assert!(
        run.err().contains("MESHWEFT_culling has ranges of them"),
        "{}",
        run.err()
    );
    assert_eq!(folder.read("ball.glb"), ordered);
    assert!(!folder.0.join("again.glb").exists());
}

#[test]
fn a_table_of_other_faces_is_found_out() {
    let folder = Folder::new("cull-wrong");
    folder.write("ball.off", ball_off());
    let run = folder.run(&["cull", "build", "ball.off", "-o", "ball.glb"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    // The planes are at the end: each looks the other way.
    let mut bytes = folder.read("ball.glb");
    let end = bytes.len();
    for place in (end - 256..end).step_by(4) {
        bytes[place + 3] ^= 0x80;
    }
    folder.write("wrong.glb", bytes);
    let run = folder.run(&["cull", "stats", "wrong.glb"]);
    assert_eq!(run.code(), 1);
    let expected = "a culling table leaves out faces that are seen";
    assert!(run.err().contains(expected), "{}", run.err());
    assert!(
        run.err().contains("front faces are left out"),
        "{}",
        run.err()
    );
}

#[test]
fn what_would_be_lost_is_named() {
    let folder = Folder::new("cull-lost");
    folder.write("grid.obj", grid_obj() + "vt 0 0\nf 1/1 2/1 23/1\n");
    let build = |flags: &[&str]| {
        let arguments = [&["cull", "build", "grid.obj", "-o", "grid.glb"], flags].concat();
        folder.run(&arguments)
    };
    let run = build(&[]);
    assert_eq!(run.code(), 1);
    for expected in [
        "texture coordinates (vt)",
        "Leave it out with --drop-attributes",
    ] {
        assert!(run.err().contains(expected), "{}", run.err());
    }
    assert!(!folder.0.join("grid.glb").exists());

    let report = build(&["--drop-attributes", "--json"]).json();
    assert_eq!(report["command"], "cull build");
    assert_eq!(report["output"], "grid.glb");
    let lost = report["lost"].as_array().unwrap();
    assert!(
        lost.iter()
            .any(|what| what.as_str().unwrap().starts_with("texture coordinates")),
        "{report}"
    );
    assert_eq!(report["total"]["in_clusters"]["faces"], 801);
    assert_eq!(report["meshes"][0]["outcome"], "clusters");

    // Draws that cost more are fewer.
    folder.write("ball.off", ball_off());
    let clusters = |cost: &str| {
        let flags = [
            "--drop-attributes",
            "--dry-run",
            "--draw-cost",
            cost,
            "--json",
        ];
        let arguments = [&["cull", "build", "ball.off"], &flags[..]].concat();
        let report = folder.run(&arguments).json();
        assert_eq!(report["draw_cost"], cost.parse::<f64>().unwrap());
        report["total"]["clusters"].as_u64().unwrap()
    };
    assert!(clusters("0") > clusters("1000"));
    assert_eq!(build(&["--draw-cost", "-1"]).code(), 2);

    // Where it does not go, and what is not there.
    let run = folder.run(&[
        "cull",
        "build",
        "grid.obj",
        "-o",
        "out.obj",
        "--drop-attributes",
    ]);
    assert_eq!(run.code(), 2, "{}", run.err());
    assert!(run.err().contains("a .glb is made of it"), "{}", run.err());
    let run = folder.run(&["cull", "build", "grid.obj"]);
    assert_eq!(run.code(), 2, "{}", run.err());
    assert_eq!(folder.run(&["cull", "stats", "none.glb"]).code(), 1);
    assert_eq!(
        folder
            .run(&["cull", "stats", "grid.glb", "--eyes", "0"])
            .code(),
        2
    );
    let run = folder.run(&["cull", "stats", "grid.obj"]);
    assert_eq!(run.code(), 0);
    assert!(
        run.out().contains("no mesh has a culling table"),
        "{}",
        run.out()
    );
    let run = folder.run(&[
        "cull",
        "build",
        "grid.obj",
        "--dry-run",
        "--drop-attributes",
    ]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(run.out().contains("not written: dry run"), "{}", run.out());
    fs::remove_file(folder.0.join("grid.glb")).unwrap();
}
