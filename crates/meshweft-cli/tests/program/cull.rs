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
fn clusters_are_made_for_eyes_and_caches() {
    let folder = Folder::new("cull-eyes");
    folder.write("ball.off", ball_off());
    folder.write("cameras.json", "[[0, 0, 3], [0.5, 0, 3],\n [0, 0, 1, 0]]");
    let build = |flags: &[&str], to: &str| {
        let arguments = [&["cull", "build", "ball.off", "--json", "-o", to], flags].concat();
        let run = folder.run(&arguments);
        assert_eq!(run.code(), 0, "{}", run.err());
        run.json()
    };
    // Faces drawn from 1.5 radii, draws of an orthographic view.
    let looked_at = |file: &str| {
        let report = folder.run(&["cull", "stats", file, "--json"]).json();
        let views = report["total"]["views"].as_array().unwrap().clone();
        for view in &views {
            assert_eq!(view["front_faces_rejected"], 0, "{file}: {view}");
        }
        [&views[0]["drawn"], &views[4]["draws"]].map(|figure| figure.as_f64().unwrap())
    };

    // Who looks from near draws fewer faces if clusters are made for that, an orthographic view takes fewer draws.
    let near = build(&["--eyes", "near"], "near.glb");
    assert_eq!(near["eyes"][0]["distance"], 1.25);
    let far = build(&["--eyes", "orthographic"], "far.glb");
    let all = serde_json::json!([{"distance": null, "count": 256}]);
    assert_eq!(far["eyes"], all);
    let [near, far] = ["near.glb", "far.glb"].map(looked_at);
    assert!(near[0] < far[0] && far[1] < near[1], "{near:?} {far:?}");

    // Cameras on one side: the other side is not worth a draw.
    let report = build(&["--eyes", "cameras.json"], "cameras.glb");
    assert_eq!(report["eyes"].as_array().unwrap().len(), 3);
    assert_eq!(report["eyes"][1], serde_json::json!([0.5, 0.0, 3.0, 1.0]));
    let everywhere = build(&[], "usual.glb");
    assert_eq!(everywhere["eyes"].as_array().unwrap().len(), 4);
    assert_ne!(folder.read("cameras.glb"), folder.read("usual.glb"));
    looked_at("cameras.glb");

    // Faces that cost more are fewer, so clusters are more.
    let clusters = |cost: &str| {
        let report = build(&["--face-cost", cost], "cost.glb");
        assert_eq!(report["face_cost"], cost.parse::<f64>().unwrap());
        report["total"]["clusters"].as_u64().unwrap()
    };
    assert!(clusters("50") > clusters("0"));

    // The order inside is for a cache, by the names that optimize has.
    let misses = |cache: &str| {
        let flags = ["--cache", cache, "--draw-cost", "1000"];
        let report = build(&flags, "cache.glb");
        assert_eq!(report["cache"], cache);
        let run = folder.run(&["inspect", "cache.glb", "--json", "--cache", "fifo:8"]);
        run.json()["total"]["misses"]["fifo:8"].as_u64().unwrap()
    };
    assert!(misses("fifo:8") < misses("fifo:64"));
    misses("universal");
    misses("batch:32/0/126");
}

#[test]
fn stripes_may_take_the_place_of_clusters() {
    let folder = Folder::new("cull-stripes");
    folder.write("ball.off", ball_off());
    let flags = ["cull", "build", "ball.off", "--json"];
    let built = |stripes: &str, cache: &str, to: &str| {
        let more = ["--stripes", stripes, "--cache", cache, "-o", to];
        let run = folder.run(&[&flags[..], &more].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        let report = run.json();
        assert_eq!(report["stripes"], stripes.parse::<u32>().unwrap());
        assert_eq!(report["total"]["in_clusters"]["faces"], 512);
        let stats = folder.run(&["cull", "stats", to, "--json"]).json();
        assert_eq!(stats["total"]["clusters"], report["total"]["clusters"]);
        stats
    };
    let views = built("8", "fifo:16", "stripes.glb");
    let views = views["total"]["views"].as_array().unwrap();
    let drawn = views.iter().map(|view| view["drawn"].as_f64().unwrap());
    assert!(drawn.clone().all(|drawn| drawn < 0.8), "{views:?}");
    let run = folder.run(&["compare", "ball.off", "stripes.glb"]);
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    built("1", "universal", "one.glb");

    for (more, expected) in [
        (["--stripes", "0"], "0 stripes: give 1 to 4096"),
        (["--stripes", "4097"], "4097 stripes: give 1 to 4096"),
        (["--stripes=8", "--draw-cost=1"], "cannot be used with"),
        (["--stripes=8", "--eyes=near"], "cannot be used with"),
    ] {
        let run = folder.run(&[&flags[..], &more, &["-o", "no.glb"]].concat());
        assert_eq!(run.code(), 2, "{}", run.err());
        assert!(run.err().contains(expected), "{}", run.err());
        assert!(!folder.0.join("no.glb").exists());
    }
}

#[test]
fn eyes_and_caches_that_are_none_are_refused() {
    let folder = Folder::new("cull-no-eyes");
    folder.write("ball.off", ball_off());
    let refused = |flags: &[&str], expected: &str| {
        let arguments = [&["cull", "build", "ball.off", "-o", "ball.glb"], flags].concat();
        let run = folder.run(&arguments);
        assert_eq!(run.code(), 2, "{}", run.err());
        assert!(run.err().contains(expected), "{}", run.err());
        assert!(!folder.0.join("ball.glb").exists());
    };
    refused(
        &["--eyes", "nera"],
        "--eyes nera: neither near, far, orthographic nor a file of eyes: ",
    );
    for (text, expected) in [
        ("[[0, 0, 3],\n [0, true]]", "line 2 column "),
        ("[[0, 0, 3], [0, 1]]", "entry 2 is not three numbers"),
        ("[]", "it lists 0 eyes: give 1 to 448"),
        ("near", "such as [[0, 1.5, 4], [2, 1.5, 0]]"),
    ] {
        folder.write("eyes.json", text);
        refused(&["--eyes", "eyes.json"], "--eyes eyes.json: ");
        refused(&["--eyes", "eyes.json"], expected);
    }
    folder.write("eyes.json", " ".repeat(1 << 20));
    refused(
        &["--eyes", "eyes.json"],
        "the file has 1048576 bytes or more",
    );
    refused(&["--face-cost=-1"], "a number from 0 on");
    refused(&["--cache", "fifo:1025"], "caches of 3 to 1024 vertices");
    refused(&["--cache", "lru"], "--cache <MODEL>");
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
    for expected in [
        "error: wrong.glb: /meshes/0/primitives/0: ",
        "its culling table does not match its faces",
        "front faces are left out. Build tables from the source",
    ] {
        assert!(run.err().contains(expected), "{}", run.err());
    }

    // A plane whose normal is longer than 1: no eye can be judged by it.
    let mut bytes = folder.read("ball.glb");
    bytes[end - 16..end - 12].copy_from_slice(&9.0_f32.to_le_bytes());
    folder.write("damaged.glb", bytes);
    let run = folder.run(&["cull", "stats", "damaged.glb", "--json"]);
    assert_eq!(run.code(), 1);
    let expected = "its culling table is out of range: the planes of cluster ";
    assert!(run.err().contains(expected), "{}", run.err());
    let report: serde_json::Value = serde_json::from_str(&run.out()).unwrap();
    assert_eq!(report["without_table"], 1);
    let wrong = &report["wrong_tables"][0];
    assert_eq!(wrong["place"], "/meshes/0/primitives/0");
    assert!(wrong["text"].as_str().unwrap().contains(expected));
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
