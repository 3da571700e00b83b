//! `lod walk` and `lod verify`: what the frames of a path cost, and how far they are off.

use meshweft::Mesh;
use meshweft::files::{Document, ReadOptions};
use meshweft::lod::fast_mesh::FastMesh;
use serde_json::Value;

use crate::Folder;

/// Waves over a square of 50 by 50 cells, as OFF.
pub(crate) fn waves_off() -> String {
    let side = 50;
    let place = |i: u32| {
        let [x, y] = [i % (side + 1), i / (side + 1)].map(|at| f64::from(at) / 4.0);
        format!("{x} {} {y}\n", (2.1 * x).sin() * (1.7 * y).cos())
    };
    let cell = |i: u32| {
        let corner = i / side * (side + 1) + i % side;
        let above = corner + side + 1;
        format!(
            "3 {corner} {above} {}\n3 {} {above} {}\n",
            corner + 1,
            corner + 1,
            above + 1
        )
    };
    let places: String = (0..(side + 1) * (side + 1)).map(place).collect();
    let cells: String = (0..side * side).map(cell).collect();
    format!(
        "OFF\n{} {} 0\n{places}{cells}",
        (side + 1) * (side + 1),
        2 * side * side
    )
}

fn sum(report: &Value, name: &str) -> u64 {
    let frames = report["frames"].as_array().unwrap();
    frames
        .iter()
        .map(|frame| frame[name].as_u64().unwrap())
        .sum()
}

#[test]
fn a_walk_is_counted_and_plotted() {
    let folder = Folder::new("lod-walk");
    folder.write("waves.off", waves_off());
    let walk = |flags: &[&str]| {
        folder.run(&[&["lod", "walk", "waves.off", "--frames", "80"], flags].concat())
    };
    let run = walk(&["--path", "fly", "--optimum", "--plot", "frames.svg"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "waves.off: vertices 2601, faces 5000; coarsest with vertices ",
        "fly, frames 80 of 800 x 800, tolerance 1.5 px; slots 65536, finest first\n",
        "active vertices ",
        "inserts ",
        "faces patched ",
        "ms, indices ",
        "; inserts: 1.000 times that, 1.000 times the fewest possible, ",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    let svg = String::from_utf8(folder.read("frames.svg")).unwrap();
    assert_eq!(svg.matches("<polyline").count(), 7);
    // Its own plots may be replaced, others not.
    assert_eq!(walk(&["--plot", "frames.svg"]).code(), 0);
    folder.write("other.svg", "<svg>");
    assert_eq!(walk(&["--plot", "other.svg"]).code(), 2);
    assert_eq!(walk(&["--plot", "other.svg", "--force"]).code(), 0);

    let report = |flags: &[&str]| walk(&[&["--json", "--path", "fly"], flags].concat()).json();
    let all = report(&["--optimum"]);
    assert_eq!(
        (&all["command"], &all["path"]),
        (&"lod walk".into(), &"fly".into())
    );
    let distinct = all["optimum"]["distinct_vertices"].as_u64().unwrap();
    assert_eq!(sum(&all, "inserts"), distinct);
    assert_eq!(all["optimum"]["times_distinct"], 1.0);
    assert_eq!(sum(&all, "vertex_bytes"), 36 * distinct);
    let none = report(&["--policy", "none", "--vertex-size", "20"]);
    assert_eq!(sum(&none, "inserts"), sum(&all, "vertices"));
    assert_eq!(sum(&none, "vertex_bytes"), 20 * sum(&all, "vertices"));
    assert_eq!(none["optimum"], Value::Null);

    // With fewer slots each policy draws the same frames, and with far too few too.
    let most = all["summary"]["vertices"]["worst"].as_u64().unwrap();
    let few = (most + most / 8).to_string();
    for policy in ["finest", "lru", "queue", "first"] {
        let found = report(&["--policy", policy, "--slots", &few, "--optimum"]);
        assert_eq!(sum(&found, "faces"), sum(&all, "faces"));
        let fewest = found["optimum"]["fewest_inserts"].as_u64().unwrap();
        assert!(
            distinct <= fewest && fewest <= sum(&found, "inserts"),
            "{policy}"
        );
    }
    let passes = report(&["--slots", "100", "--passes"]);
    assert_eq!(
        (&passes["passes"], &all["passes"]),
        (&true.into(), &false.into())
    );
    assert_eq!(
        (&passes["frames_in_passes"], &passes["streamed_frames"]),
        (&80.into(), &0.into())
    );
    assert_eq!(sum(&passes, "faces"), sum(&all, "faces"));
    assert!(sum(&passes, "passes") > 80);
    let run = walk(&["--slots", "100", "--optimum"]);
    assert!(
        run.out().contains("frames of more vertices than slots: "),
        "{}",
        run.out()
    );
    assert!(
        run.out().contains("the fewest possible is not known"),
        "{}",
        run.out()
    );
    let coarse = report(&[
        "--tolerance",
        "9",
        "--size",
        "400x300",
        "--hysteresis",
        ".7",
    ]);
    assert!(sum(&coarse, "faces") < sum(&all, "faces"));
}

#[test]
fn cameras_come_from_a_file() {
    let folder = Folder::new("lod-cameras");
    folder.write("waves.off", waves_off());
    let frame = |x: u32| format!("{{\"eye\": [{x}, 9, 6], \"target\": [6, 0, 6]}}");
    let frames = |frames: &[String]| format!("{{\"fov\": 60, \"frames\": [{}]}}", frames.join(","));
    folder.write("path.json", frames(&[0, 1, 2, 3, 4].map(frame)));
    let walk = |flags: &[&str]| {
        folder.run(&[&["lod", "walk", "waves.off", "--json", "--path"], flags].concat())
    };
    let report = walk(&["path.json"]).json();
    assert_eq!(
        (&report["path"], &report["frame_count"]),
        (&"given".into(), &5.into())
    );
    assert_eq!(report["camera_file"], "path.json");
    let first = walk(&["path.json", "--frames", "2"]).json();
    assert_eq!(first["frame_count"], 2);
    let run = folder.run(&["lod", "walk", "waves.off", "--frames", "1"]);
    assert_eq!(run.out().lines().count(), 3 + 13, "{}", run.out());
    assert_eq!(run.out().matches(" -  ").count(), 3 * 13, "{}", run.out());
    for name in ["vertices", "faces", "inserts"] {
        assert_eq!(first["frames"][1][name], report["frames"][1][name]);
    }

    // What is wrong, where.
    folder.write(
        "bad.json",
        frames(&[frame(1), frame(2).replace("eye", "eyes")]),
    );
    let cases = [
        (
            &["bad.json"][..],
            1,
            "bad.json: /frames/1: member \"eyes\" is not known here; known are eye, target, up.",
        ),
        (&["none.json"], 1, "none.json: "),
        (
            &["path.json", "--max-bytes", "20"],
            1,
            "allow more with --max-bytes",
        ),
        (
            &["spiral"],
            2,
            "--path spiral: give circle, rotate, zoom, fly, or a file of cameras (.json)",
        ),
        (
            &["fly", "--frames", "0"],
            2,
            "--frames 0: give 1 to 1000000",
        ),
        (
            &["fly", "--slots", "2"],
            2,
            "--slots 2: give 3, which a face needs, to 1073741824",
        ),
        (
            &["fly", "--tolerance", "0"],
            2,
            "--tolerance 0: give a number of pixels above 0",
        ),
        (
            &["fly", "--passes", "--policy", "none"],
            2,
            "--passes with the policy none: give a policy that keeps vertices in slots",
        ),
        (
            &["fly", "--hysteresis", "2"],
            2,
            "--hysteresis 2: give a part of the tolerance",
        ),
        (
            &["fly", "--size", "800"],
            2,
            "give 1 to 65535 pixels for width and height, such as 800x600",
        ),
        (
            &["fly", "--size", "0x9"],
            2,
            "give 1 to 65535 pixels for width and height",
        ),
        (
            &["path.json", "--plot", "path.json"],
            2,
            "--plot path.json: this is the file of --path: choose another name",
        ),
    ];
    for (flags, code, expected) in cases {
        let run = walk(flags);
        assert_eq!(run.code(), code, "{flags:?} {}", run.err());
        assert!(run.err().contains(expected), "{flags:?} {}", run.err());
    }
    folder.write("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
    let run = folder.run(&["lod", "walk", "points.off"]);
    assert_eq!(run.code(), 1);
    assert!(
        run.err()
            .contains("points.off: no face has three different corners"),
        "{}",
        run.err()
    );
}

/// The waves as a .mwl file.
fn waves_mwl(folder: &Folder) -> Vec<u8> {
    let path = folder.write("waves.off", waves_off());
    let document = Document::open(&path, ReadOptions::default()).unwrap();
    let positions = document.positions(0).unwrap().unwrap();
    let faces = document.meshes()[0].mesh.faces().to_vec();
    let mesh = Mesh::new(positions, faces).unwrap();
    FastMesh::default().build(&mesh, &[]).unwrap().to_bytes()
}

#[test]
fn a_stored_mesh_is_walked_around_as_it_was() {
    let folder = Folder::new("lod-stored");
    let bytes = waves_mwl(&folder);
    folder.write("waves.mwl", &bytes);
    let walk = |name: &str, flags: &[&str]| {
        folder.run(
            &[
                &["lod", "walk", name, "--frames", "40", "--path", "zoom"],
                flags,
            ]
            .concat(),
        )
    };
    let report = |name: &str| {
        let run = walk(name, &["--json", "--slots", "900", "--optimum"]);
        assert_eq!(run.code(), 0, "{}", run.err());
        run.json()
    };
    let (mesh, stored) = (report("waves.off"), report("waves.mwl"));
    for name in ["vertices", "inserts", "vertex_ranges", "index_bytes"] {
        assert_eq!(sum(&mesh, name), sum(&stored, name), "{name}");
    }
    assert_eq!(mesh["mesh"], stored["mesh"]);
    assert_eq!(mesh["optimum"], stored["optimum"]);
    assert_eq!(
        (&mesh["file_bytes"], &stored["file_bytes"]),
        (&Value::Null, &bytes.len().into())
    );
    let read = sum(&stored, "read_bytes");
    assert!(0 < read && read <= bytes.len() as u64);
    let run = walk("waves.mwl", &["--tolerance", "9"]);
    let expected = format!("bytes of the file: {}; read: ", bytes.len());
    assert!(run.out().contains(&expected), "{}", run.out());
    assert!(run.out().contains("file bytes read "), "{}", run.out());

    // The name does not matter; damage is told with its place.
    folder.write("waves.ply", &bytes);
    assert_eq!(walk("waves.ply", &[]).code(), 0);
    let mut damaged = bytes.clone();
    let last = damaged.len() - 1;
    damaged[last] ^= 1;
    folder.write("bad.mwl", &damaged);
    let run = walk("bad.mwl", &["--tolerance", ".0001"]);
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("error: bad.mwl: frame 0: byte "),
        "{}",
        run.err()
    );
    let run = walk("waves.mwl", &["--max-bytes", "1K"]);
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("allow more with --max-bytes"),
        "{}",
        run.err()
    );
    folder.write("text.mwl", "OFF\n");
    let run = walk("text.mwl", &[]);
    assert!(
        run.err()
            .contains("text.mwl: byte 0: this is not a .mwl file"),
        "{}",
        run.err()
    );
}

#[test]
fn what_is_drawn_is_measured() {
    let folder = Folder::new("lod-verify");
    let bytes = waves_mwl(&folder);
    folder.write("waves.mwl", bytes);
    let verify = |name: &str, flags: &[&str]| {
        folder.run(&[&["lod", "verify", name, "--path", "fly"], flags].concat())
    };
    let run = verify("waves.off", &["--tolerance", "3"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "waves.off: vertices 2601, faces 5000; coarsest with vertices ",
        "fly, frames 9 of 800 x 800, tolerance 3 px; errors in tolerances\n",
        "within, %",
        "\nall ",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    assert_eq!(run.out().lines().count(), 2 + 1 + 9 + 1, "{}", run.out());

    let coarse = ["--tolerance", "30", "--frames", "3", "--json"];
    let [mesh, stored] = ["waves.off", "waves.mwl"].map(|name| verify(name, &coarse).json());
    assert_eq!(mesh["errors"], stored["errors"]);
    assert_eq!(mesh["frames"], stored["frames"]);
    assert_eq!(mesh["frames"].as_array().unwrap().len(), 3);
    let worst = mesh["errors"]["worst"].as_f64().unwrap();
    assert!(worst > 0.0 && mesh["errors"]["seen"].as_u64().unwrap() > 100);

    // Checks.
    let less = (worst * 0.9).to_string();
    let more = (worst * 1.1).to_string();
    let check = |flags: &[&str]| verify("waves.mwl", &[&coarse[..4], flags].concat());
    assert_eq!(check(&["--max-error", &more, "--min-share", "1"]).code(), 0);
    let run = check(&["--max-error", &less]);
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("waves.mwl: the worst vertex is "),
        "{}",
        run.err()
    );
    assert!(
        run.out().contains("\nall "),
        "the table is printed all the same"
    );
    let run = check(&["--min-share", "100.5"]);
    assert_eq!(run.code(), 2);
    assert!(
        run.err()
            .contains("--min-share 100.5: give a part of the vertices"),
        "{}",
        run.err()
    );
}
