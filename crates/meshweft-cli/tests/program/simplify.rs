//! `simplify`: fewer faces.

use std::fs;

use serde_json::Value;

use crate::Folder;
use crate::basics::grid_obj;

/// The grid of the other tests, bent, so that a removal has an error.
fn bent_obj() -> String {
    let lines = grid_obj();
    let bend = |line: &str| match line.strip_prefix("v ") {
        Some(rest) => {
            let mut numbers = rest.split(' ').map(|n| n.parse::<f64>().unwrap());
            let [x, y] = [0, 1].map(|_| numbers.next().unwrap());
            format!("v {x} {y} {}\n", (x * 0.4).sin() + (y * 0.3).cos())
        }
        None => format!("{line}\n"),
    };
    lines.lines().map(bend).collect()
}

/// The same as OFF, which is ASCII too.
fn bent_off() -> String {
    let obj = bent_obj();
    let of = |kind: &'static str| obj.lines().filter_map(move |line| line.strip_prefix(kind));
    let vertices: String = of("v ").map(|rest| format!("{rest}\n")).collect();
    let faces: String = of("f ")
        .map(|rest| {
            let numbers = rest.split(' ').map(|n| n.parse::<u32>().unwrap() - 1);
            let numbers: Vec<String> = numbers.map(|n| n.to_string()).collect();
            format!("3 {}\n", numbers.join(" "))
        })
        .collect();
    format!("OFF\n441 800 0\n{vertices}{faces}")
}

fn faces(report: &Value) -> [u64; 2] {
    ["before", "after"].map(|when| report["total"]["faces"][when].as_u64().unwrap())
}

#[test]
fn half_of_the_faces_with_report_and_error() {
    let folder = Folder::new("simplify");
    folder.write("grid.obj", bent_obj());
    let run = folder.run(&["simplify", "grid.obj", "--ratio", "0.5", "-o", "half.obj"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    for expected in [
        "grid.obj\n  800 -> 400 faces, 441 -> ",
        "error (of the diagonal): greatest ",
        "misses per face: fifo:10 ",
        "written to half.obj",
    ] {
        assert!(run.out().contains(expected), "{}", run.out());
    }
    assert!(!run.out().contains("stopped"), "{}", run.out());
    assert_eq!(folder.read("grid.obj"), bent_obj().into_bytes());
    // Nothing but vertices and faces is gone.
    let half = String::from_utf8(folder.read("half.obj")).unwrap();
    assert!(
        half.starts_with("# a grid\nmtllib none.mtl\no grid\nv "),
        "{half}"
    );

    let report = folder
        .run(&[
            "simplify", "half.obj", "--faces", "100", "-o", "more.obj", "--json",
        ])
        .json();
    assert_eq!(
        (report["schema"].as_u64(), &report["command"]),
        (Some(1), &"simplify".into())
    );
    assert_eq!(faces(&report)[0], 400);
    assert!((98..=100).contains(&faces(&report)[1]), "{report}");
    let object = &report["objects"][0];
    assert_eq!(object["stop"], "faces");
    assert_eq!(object["goal"], 100);
    let greatest = object["distances"]["max"].as_f64().unwrap();
    assert!(greatest > 0.0 && greatest < 2.0, "{greatest}");
    assert!(object["distances"]["max_of_diagonal"].as_f64().unwrap() < 0.1);
    let inspected = folder.run(&["inspect", "more.obj", "--json"]).json();
    assert_eq!(
        inspected["total"]["faces"].as_u64().unwrap(),
        faces(&report)[1]
    );
}

#[test]
fn an_error_is_a_length_or_a_share_of_the_diagonal() {
    let folder = Folder::new("simplify-error");
    folder.write("grid.off", bent_off());
    let after = |error: &str| {
        let flags = [
            "simplify",
            "grid.off",
            "--error",
            error,
            "--dry-run",
            "--json",
        ];
        let report = folder.run(&flags).json();
        assert_eq!(report["objects"][0]["stop"], "error", "{report}");
        faces(&report)[1]
    };
    let diagonal = folder
        .run(&[
            "simplify",
            "grid.off",
            "--ratio",
            "1",
            "--dry-run",
            "--json",
        ])
        .json()["objects"][0]["diagonal"]
        .as_f64()
        .unwrap();
    assert_eq!(after(".5%"), after(&format!("{}", diagonal * 0.005)));
    assert!(after("1%") < after(".5%"));
    assert_eq!(
        fs::read_dir(&folder.0).unwrap().count(),
        1,
        "a dry run writes nothing"
    );

    // Whichever comes first.
    let flags = [
        "simplify",
        "grid.off",
        "--error",
        ".5%",
        "--ratio",
        ".9",
        "--dry-run",
        "--json",
    ];
    let report = folder.run(&flags).json();
    assert_eq!(
        (faces(&report)[1], &report["objects"][0]["stop"]),
        (720, &"faces".into())
    );
}

#[test]
fn what_was_asked_for_has_to_make_sense() {
    let folder = Folder::new("simplify-usage");
    folder.write("grid.off", bent_off());
    for (flags, expected) in [
        ("", "how far? Give --ratio, --faces or --error"),
        ("--ratio=2", "the ratio out of range: 0 to 1 is allowed"),
        ("--error=-1", "the error out of range"),
        (
            "--error=1mm",
            "a length such as 0.01, or a share of the diagonal such as 1%",
        ),
        ("--ratio=.5 --uv-weight=-1", "weights out of range"),
        ("--ratio=.5 --cache=fifo:2000", "3 to 1024 vertices"),
    ] {
        let mut all = vec!["simplify", "grid.off", "--dry-run"];
        all.extend(flags.split_whitespace());
        let run = folder.run(&all);
        assert_eq!(run.code(), 2, "{all:?}: {}", run.err());
        assert!(run.err().contains(expected), "{all:?}: {}", run.err());
    }
    let run = folder.run(&["simplify", "grid.off", "--ratio", ".5"]);
    assert!(run.err().contains("where to?"), "{}", run.err());
    folder.write("cut.off", &bent_off()[..4000]);
    let run = folder.run(&["simplify", "cut.off", "--ratio", ".5", "-o", "out.off"]);
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("cut.off: line"), "{}", run.err());
    assert!(!folder.0.join("out.off").exists());
}

#[test]
fn in_place_nothing_is_written_where_nothing_leaves() {
    let folder = Folder::new("simplify-in-place");
    let path = folder.write("grid.off", bent_off());
    let flags = ["simplify", "grid.off", "--in-place", "--ratio", "1"];
    let written = fs::metadata(&path).unwrap().modified().unwrap();
    let run = folder.run(&flags);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.out().contains("nothing left: the file stays as it is"),
        "{}",
        run.out()
    );
    assert_eq!(fs::metadata(&path).unwrap().modified().unwrap(), written);

    let run = folder.run(&["simplify", "grid.off", "--in-place", "--ratio", ".25"]);
    assert!(run.out().contains("800 -> 200 faces"), "{}", run.out());
    let quarter = folder.read("grid.off");
    assert!(quarter.len() < bent_off().len() / 2);
    folder.run(&flags);
    assert_eq!(folder.read("grid.off"), quarter);
    // With another name it is copied.
    let run = folder.run(&["simplify", "grid.off", "-o", "copy.off", "--ratio", "1"]);
    assert!(
        run.out().contains("nothing left: copied to copy.off"),
        "{}",
        run.out()
    );
    assert_eq!(folder.read("copy.off"), quarter);
}

/// Eight faces around a vertex, each with texture coordinates of its own: every edge is a seam.
#[test]
fn why_it_stopped_short_is_said() {
    let folder = Folder::new("simplify-stuck");
    let mut text = String::from("v 0 0 1\n");
    for i in 0..8 {
        let turn = f64::from(i) * std::f64::consts::FRAC_PI_4;
        text += &format!("v {} {} 0\n", turn.cos(), turn.sin());
    }
    for i in 0..24 {
        text += &format!("vt {i} 0\n");
    }
    for i in 0..8 {
        let t = 3 * i + 1;
        text += &format!(
            "f 1/{t} {}/{} {}/{}\n",
            i + 2,
            t + 1,
            (i + 1) % 8 + 2,
            t + 2
        );
    }
    folder.write("stuck.obj", &text);
    let run = folder.run(&["simplify", "stuck.obj", "--ratio", ".5", "-o", "out.obj"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let expected = "stopped: 100.0 % of the faces of mesh are left: no other vertex can go (seams, borders, \
                    topology)";
    assert!(run.out().contains(expected), "{}", run.out());
    assert_eq!(folder.read("out.obj"), text.into_bytes());
}

#[test]
fn levels_are_written_beside_and_replace_nothing_of_others() {
    let folder = Folder::new("simplify-levels");
    folder.write("grid.off", bent_off());
    folder.write("notes.json", "{}");
    let flags = |levels| {
        [
            "simplify",
            "grid.off",
            "--ratio",
            ".5",
            "-o",
            "half.off",
            "--write-levels",
            levels,
        ]
    };
    for (levels, expected) in [
        ("notes.json", "is not one that --write-levels writes"),
        ("grid.off", "this is a mesh of the run"),
        ("half.off", "this is a mesh of the run"),
    ] {
        let run = folder.run(&flags(levels));
        assert_eq!(run.code(), 2, "{}", run.out());
        assert!(run.err().contains(expected), "{}", run.err());
    }

    // Twice: its own file is replaced.
    for _ in 0..2 {
        let run = folder.run(&flags("levels.json"));
        assert_eq!(run.code(), 0, "{}", run.err());
    }
    let levels: Value = serde_json::from_slice(&folder.read("levels.json")).unwrap();
    let mesh = &levels["meshes"][0];
    assert_eq!(mesh["fine_to_coarse"].as_array().unwrap().len(), 441);
    let half = String::from_utf8(folder.read("half.off")).unwrap();
    let new_to_old = mesh["vertex_new_to_old"].as_array().unwrap();
    let source = bent_off();
    for (new, old) in new_to_old.iter().enumerate().take(20) {
        let line = |text: &str, vertex: usize| text.lines().nth(2 + vertex).map(str::to_owned);
        let old = usize::try_from(old.as_u64().unwrap()).unwrap();
        assert_eq!(line(&half, new), line(&source, old));
    }
    let removals = &levels["objects"][0]["removals"];
    let rows = removals["vertex"].as_array().unwrap().len();
    assert!(rows > 400, "down to the coarsest mesh: {rows}");
    for column in ["mesh", "into", "faces", "error"] {
        assert_eq!(removals[column].as_array().unwrap().len(), rows);
    }

    let plot = [
        "simplify",
        "grid.off",
        "--ratio",
        ".5",
        "-o",
        "half.off",
        "--plot",
        "levels.svg",
    ];
    let run = folder.run(&plot);
    assert_eq!(run.code(), 0, "{}", run.err());
    let picture = String::from_utf8(folder.read("levels.svg")).unwrap();
    assert_eq!(picture.matches("<polyline").count(), 5);
    assert!(picture.contains("fifo:12, edited in place") && !picture.contains("NaN"));
    assert_eq!(folder.run(&plot).code(), 0, "its own file is replaced");

    let run = folder.run(&[
        "simplify",
        "*.off",
        "--ratio",
        ".5",
        "-o",
        "out/",
        "--write-levels",
        "x.json",
    ]);
    assert!(
        run.err()
            .contains("--write-levels takes one file at a time"),
        "{}",
        run.err()
    );
}

#[test]
fn a_whole_folder_and_what_cannot_be_simplified() {
    let folder = Folder::new("simplify-many");
    fs::create_dir(folder.0.join("in")).unwrap();
    folder.write("in/a.obj", bent_obj());
    folder.write("in/b.off", bent_off());
    let wrl = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 1 1 0, \
               0 1 0, .5 .5 0] } coordIndex [0 1 4 -1 1 2 4 -1 2 3 4 -1 3 0 4 -1] } }\n";
    folder.write("in/c.wrl", wrl);
    let flags = [
        "simplify",
        "in",
        "-o",
        "out",
        "--ratio",
        ".1",
        "--manifest",
        "done.jsonl",
    ];
    let run = folder.run(&flags);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        run.out().matches("800 -> 80 faces").count(),
        2,
        "{}",
        run.out()
    );
    let expected = "not simplified: faces are not left out of files of this format: convert it to .ply or .glb first";
    assert!(run.err().contains(expected), "{}", run.err());
    assert_eq!(folder.read("out/c.wrl"), wrl.as_bytes());
    let again = folder.run(&flags);
    assert_eq!(
        again.out().matches("done before").count(),
        3,
        "{}",
        again.out()
    );
}
