//! `terrain`: files and surfaces of heights, walks over them, and how far these are off.

use crate::{Folder, data_folder};

/// Waves over 65 by 49 places as a grey image, with a place without a height if wanted.
pub(crate) fn waves_pgm(has_void: bool) -> String {
    let height = |i: u32| {
        let [x, y] = [i % 65, i / 65].map(f64::from);
        let height = 1000.0 + 300.0 * (0.21 * x).sin() * (0.17 * y).cos() + 40.0 * (0.9 * x).sin();
        match has_void && (30..34).contains(&(i % 65)) && i / 65 == 20 {
            true => 0,
            #[expect(clippy::cast_possible_truncation, reason = "below 2000")]
            #[expect(clippy::cast_sign_loss, reason = "above 0")]
            false => height as u32,
        }
    };
    let heights: String = (0..65 * 49).map(|i| format!("{}\n", height(i))).collect();
    format!("P2\n65 49\n65535\n{heights}")
}

#[test]
fn heights_become_a_file_and_a_mesh() {
    let folder = Folder::new("terrain-build");
    folder.write("waves.pgm", waves_pgm(false));
    let build = |flags: &[&str]| {
        let verb = ["terrain", "build", "waves.pgm", "--spacing", "30,20"];
        folder.run(&[&verb[..], flags].concat())
    };
    let run = build(&["-o", "waves.mwt"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "waves.pgm: 65 columns, 49 rows, 30.000 by 20.000 m apart; heights ",
        "; faces 6144\n",
        "; read back and compared",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    let bytes = folder.read("waves.mwt");
    assert!(bytes.starts_with(b"MWTN"));
    let report = build(&["-o", "waves.mwt", "--json"]).json();
    assert_eq!(report["command"], "terrain build");
    assert_eq!(report["bytes"]["after"], bytes.len());
    assert_eq!(report["terrain"]["faces"], 6144);
    assert_eq!(folder.read("waves.mwt"), bytes);
    assert_eq!(build(&["--dry-run", "-o", "no.mwt"]).code(), 0);
    assert!(!folder.0.join("no.mwt").exists());

    // A surface of the file is that of the heights.
    let extract = |input: &str, flags: &[&str]| {
        let spacing: &[&str] = match input {
            "waves.pgm" => &["--spacing", "30,20", "--quiet"],
            _ => &[],
        };
        folder.run(&[&["terrain", "extract", input], spacing, flags].concat())
    };
    let run = extract("waves.mwt", &["--error", "5", "-o", "five.ply"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "waves.mwt -> five.ply: vertices ",
        " of 6144; no height farther than ",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    assert_eq!(
        extract("waves.pgm", &["--error", "5", "-o", "own.ply"]).code(),
        0
    );
    assert_eq!(folder.read("own.ply"), folder.read("five.ply"));
    let all = extract("waves.mwt", &["--error", "0", "-o", "all.obj", "--json"]).json();
    assert_eq!(
        (&all["vertices"], &all["faces"], &all["error"]),
        (&3185.into(), &6144.into(), &0.0.into())
    );
    let few = extract("waves.mwt", &["--faces", "300", "-o", "few.glb", "--json"]).json();
    assert!(few["faces"].as_u64().unwrap() <= 300);
    folder.write(
        "eyes.json",
        r#"{"frames": [{"eye": [0, 2000, 0], "target": [900, 900, 0]}]}"#,
    );
    let seen = [
        "--camera",
        "eyes.json",
        "--tolerance",
        "4",
        "-o",
        "seen.glb",
        "--json",
    ];
    let seen = extract("waves.mwt", &seen).json();
    assert!(seen["faces"].as_u64().unwrap() < 6144);
}

#[test]
fn what_is_wrong_with_a_terrain_is_said_before_the_work() {
    let folder = Folder::new("terrain-refused");
    folder.write("waves.pgm", waves_pgm(true));
    folder.write("note.txt", "not heights");
    folder.write("other.mwt", "mine");
    let refused = |arguments: &[&str], code: i32, expected: &str| {
        let run = folder.run(&[&["terrain"], arguments].concat());
        assert_eq!(run.code(), code, "{}", run.err());
        assert!(run.err().contains(expected), "{}", run.err());
    };
    refused(
        &["build", "waves.pgm", "-o", "waves.ply"],
        2,
        "give the output the ending .mwt",
    );
    refused(
        &["build", "waves.pgm", "-o", "other.mwt"],
        2,
        "this file is not one that --output writes",
    );
    assert_eq!(folder.read("other.mwt"), b"mine");
    refused(
        &["build", "note.txt", "-o", "new.mwt"],
        1,
        "note.txt: this is neither a height map, nor points or a mesh, nor a .mwt file",
    );
    refused(&["build", "none.hgt", "-o", "new.mwt"], 1, "none.hgt");
    refused(
        &["build", "waves.pgm", "waves.pgm", "-o", "new.mwt"],
        1,
        "does not say where it lies",
    );
    refused(
        &["extract", "waves.pgm", "--error", "-1", "-o", "new.ply"],
        2,
        "--error -1: give a number of metres",
    );
    refused(
        &["extract", "none.mwt", "--error", "1", "-o", "new.txt"],
        1,
        "the name of a new file says its format",
    );
    refused(
        &["extract", "waves.pgm", "--error", "1", "-o", "waves.pgm"],
        2,
        "choose another name",
    );
    folder.write("there.ply", "mine");
    refused(
        &["extract", "none.mwt", "--error", "1", "-o", "there.ply"],
        1,
        "there.ply",
    );
    assert_eq!(folder.read("there.ply"), b"mine");
    refused(
        &["extract", "waves.pgm", "--faces", "5", "-o", "new.ply"],
        1,
        "there is no surface of 5 faces or fewer",
    );
    assert!(!folder.0.join("new.mwt").exists() && !folder.0.join("new.ply").exists());

    // A place without a height is a hole, or filled.
    let build = |flags: &[&str]| {
        let verb = [
            "terrain",
            "build",
            "waves.pgm",
            "--no-data",
            "0",
            "--json",
            "-o",
            "w.mwt",
        ];
        folder.run(&[&verb[..], flags].concat()).json()
    };
    let (holes, filled) = (build(&[]), build(&["--fill"]));
    assert_eq!((&holes["voids"], &holes["filled"]), (&4.into(), &0.into()));
    assert_eq!(
        (&filled["voids"], &filled["filled"]),
        (&4.into(), &4.into())
    );
    assert!(holes["terrain"]["faces"].as_u64() < filled["terrain"]["faces"].as_u64());
    refused(
        &["build", "w.mwt", "-o", "x.mwt"],
        1,
        "w.mwt: this is a terrain that was built already",
    );
}

#[test]
fn tiles_are_joined() {
    let Some(data) = data_folder("tiles_are_joined") else {
        return;
    };
    let folder = Folder::new("terrain-tiles");
    let tile = |name: &str| data.join("terrain").join(name).display().to_string();
    let tiles = ["N47W123.hgt.gz", "N47W122.hgt.gz"].map(tile);
    let verb = ["terrain", "build", &tiles[0], &tiles[1], "-o", "two.mwt"];
    let run = folder.run(&verb);
    assert_eq!(run.code(), 0, "{}", run.err());
    let told = run.out();
    assert!(
        told.contains(" and 1 more: 2401 columns, 1201 rows, "),
        "{told}"
    );
    assert!(
        told.contains("places at which two heights disagree: "),
        "{told}"
    );
}

#[test]
fn a_walk_over_a_terrain_is_counted_plotted_and_measured() {
    let folder = Folder::new("terrain-walk");
    folder.write("waves.pgm", waves_pgm(false));
    let build = [
        "terrain",
        "build",
        "waves.pgm",
        "--spacing",
        "30,20",
        "-o",
        "waves.mwt",
    ];
    assert_eq!(folder.run(&build).code(), 0);
    let walk = |flags: &[&str]| {
        let verb = ["terrain", "walk", "waves.mwt", "--frames", "50"];
        folder.run(&[&verb[..], flags].concat())
    };
    let run = walk(&["--path", "fly", "--optimum", "--plot", "frames.svg"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "waves.mwt: 65 columns, 49 rows, ",
        "fly, frames 50 of 1024 x 768, tolerance 1 px; slots 65536, finest first\n",
        "active vertices ",
        "ms, level of detail ",
        "bytes of the file: ",
        "; inserts: 1.000 times that, 1.000 times the fewest possible, ",
        "drawn at some time: vertices ",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    let svg = String::from_utf8(folder.read("frames.svg")).unwrap();
    assert_eq!(svg.matches("<polyline").count(), 7);
    let report = walk(&["--json", "--path", "straight"]).json();
    assert_eq!(report["command"], "terrain walk");
    assert_eq!(report["frames"].as_array().unwrap().len(), 50);
    let limited = walk(&["--json", "--limit", "500", "--path", "straight"]).json();
    assert!(limited["summary"]["vertices"]["worst"].as_u64().unwrap() <= 500);
    let run = walk(&["--path", "zoom"]);
    assert_eq!(run.code(), 2);
    assert!(
        run.err()
            .contains("give circle, rotate, straight, fly, or a file"),
        "{}",
        run.err()
    );

    let verify = |flags: &[&str]| {
        let verb = ["terrain", "verify", "waves.mwt"];
        folder.run(&[&verb[..], flags].concat())
    };
    let source = ["waves.pgm", "--spacing", "30,20"];
    let run = verify(&[&source[..], &["--path", "circle", "--frames", "5"]].concat());
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(run.out().contains(" 100.0000 "), "{}", run.out());
    let report = verify(&["--error", "4", "--json"]).json();
    assert_eq!(
        (&report["command"], &report["failures"]),
        (&"terrain verify".into(), &serde_json::json!([]))
    );
    assert!(report["worst_metres"].as_f64().unwrap() <= 4.0);
    assert_eq!(verify(&["--error", "4", "--path", "fly"]).code(), 2);

    // Heights that are others, and those of another grid.
    folder.write("other.pgm", waves_pgm(true).replace("\n0\n", "\n900\n"));
    let other = ["other.pgm", "--spacing", "30,20", "--error", "4"];
    let run = verify(&other);
    assert_eq!(run.code(), 1);
    assert!(
        run.err()
            .contains("heights farther off than the tolerance: "),
        "{}",
        run.err()
    );
    let run = verify(&["waves.pgm", "--error", "4"]);
    assert_eq!(run.code(), 1);
    assert!(
        run.err()
            .contains("the heights to compare with 65 by 49, 1 by 1 metres apart"),
        "{}",
        run.err()
    );
}

#[test]
fn vertices_of_a_mesh_become_a_terrain() {
    let folder = Folder::new("terrain-points");
    // z up: the corners of a square, and a point 3 above its middle.
    folder.write(
        "hill.obj",
        "v 0 0 1\nv 4 0 1\nv 0 4 1\nv 4 4 1\nv 2 2 4\nf 1 2 3\n",
    );
    let build = [
        "terrain", "build", "hill.obj", "-o", "hill.mwt", "--up", "z", "--json",
    ];
    let report = folder.run(&build).json();
    assert_eq!(report["points"]["points"], 5);
    assert_eq!(report["terrain"]["faces"], 4);
    assert_eq!(report["terrain"]["heights"], serde_json::json!([1.0, 4.0]));
    let extract = [
        "terrain", "extract", "hill.mwt", "--error", "0", "-o", "all.obj", "--json",
    ];
    assert_eq!(folder.run(&extract).json()["vertices"], 5);
    let all = String::from_utf8(folder.read("all.obj")).unwrap();
    assert!(all.contains("v 2 4 -2"), "{all}");
    let walk = ["terrain", "walk", "hill.mwt", "--frames", "5", "--json"];
    assert_eq!(folder.run(&walk).json()["frame_count"], 5);

    // Compared with its own points and with those of the file, in metres and on a path.
    let verify = |flags: &[&str]| {
        let verb = ["terrain", "verify", "hill.mwt"];
        folder.run(&[&verb[..], flags].concat())
    };
    let run = verify(&["--error", "1"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let told = "compared with its own 5 vertices that are points";
    assert!(run.out().contains(told), "{}", run.out());
    let run = verify(&["hill.obj", "--up", "z", "--frames", "3"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let told = "compared with 5 heights of hill.obj";
    assert!(run.out().contains(told), "{}", run.out());
    folder.write("high.obj", "v 1 0 1\nv 4 0 1\nv 3 1 9\nf 1 2 3\n");
    let run = verify(&["high.obj", "--up", "z", "--error", "1"]);
    assert_eq!(run.code(), 1, "{}", run.out());
    let told = "compared with 3 heights of high.obj";
    assert!(run.out().contains(told), "{}", run.out());
    let told = "heights farther off than the tolerance: 1, by ";
    assert!(run.err().contains(told), "{}", run.err());
    folder.write("flat.pgm", "P2 2 2 9 1 1 1 1");
    let run = verify(&["flat.pgm", "--spacing", "1"]);
    let told = "this terrain is over points, and the heights to compare with are height maps";
    assert!(run.code() == 1 && run.err().contains(told), "{}", run.err());

    // Points without faces are points, in any of three formats and together; what has neither is refused.
    folder.write("alone.obj", "v 0 0 1\nv 4 0 1\nv 0 4 1\n");
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n\
               property uchar red\nend_header\n4 4 1 7\n2 2 3.5 9\n";
    folder.write("alone.ply", ply);
    folder.write("alone.off", "OFF\n1 0 0\n1 3 1\n");
    let alone = ["alone.obj", "alone.ply", "alone.off", "--up", "z", "-o"];
    let build = ["terrain", "build"].into_iter().chain(alone);
    let build: Vec<_> = build.chain(["alone.mwt", "--json"]).collect();
    let run = folder.run(&build);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(!run.err().contains("order"), "{}", run.err());
    assert_eq!(run.json()["points"]["points"], 6);
    let heights = serde_json::json!([1.0, 3.5]);
    assert_eq!(run.json()["terrain"]["heights"], heights);
    folder.write("none.obj", "# no vertices either\n");
    let run = folder.run(&["terrain", "build", "none.obj", "-o", "none.mwt"]);
    let told = "points without faces are read from .ply, .obj and .off files";
    assert!(run.code() == 1 && run.err().contains(told), "{}", run.err());

    // Points far from 0.
    let far = "v 500000.1 1 5200000.1\nv 500010 1 5200000\nv 500000.1 2 5200000.2\nf 1 2 3\nv 500005 3 5200009\n";
    folder.write("far.obj", far);
    let run = folder.run(&["terrain", "build", "far.obj", "-o", "far.mwt"]);
    let told = "which are 0.5 apart there, and that is the grid that the points are on; points at the place of another one: 1.";
    assert!(run.code() == 0 && run.err().contains(told), "{}", run.err());

    // y is up otherwise, and these points are on a line then.
    folder.write("line.obj", "v 0 0 1\nv 4 0 1\nv 8 4 1\nf 1 2 3\n");
    let run = folder.run(&["terrain", "build", "line.obj", "-o", "line.mwt"]);
    assert!(
        run.err().contains("all points are on one line"),
        "{}",
        run.err()
    );
}
