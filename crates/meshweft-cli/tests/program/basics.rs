//! Verbs, flags, exit codes.

use std::fs;

use serde_json::Value;

use crate::Folder;

/// A grid of 20 × 20 quads as OBJ, its faces alternating between both ends.
pub(crate) fn grid_obj() -> String {
    let mut text = String::from("# a grid\nmtllib none.mtl\no grid\n");
    for y in 0..21 {
        for x in 0..21 {
            text += &format!("v {x} {y} 0.5\n");
        }
    }
    let mut faces = Vec::new();
    for y in 0..20 {
        for x in 0..20 {
            let v = y * 21 + x + 1;
            faces.push(format!("f {} {} {}\n", v, v + 1, v + 21));
            faces.push(format!("f {} {} {}\n", v + 21, v + 1, v + 22));
        }
    }
    for i in 0..400 {
        text += &faces[i];
        text += &faces[799 - i];
    }
    text
}

#[test]
fn optimize_improves_keeps_the_triangles_and_settles() {
    let folder = Folder::new("optimize");
    folder.write("grid.obj", grid_obj());
    let report = folder
        .run(&[
            "optimize", "grid.obj", "-o", "out.obj", "--cache", "fifo:12", "--json",
        ])
        .json();
    let acmr = &report["total"]["acmr"];
    let [before, after] = ["before", "after"].map(|when| acmr[when]["fifo:12"].as_f64().unwrap());
    assert!(before > 1.0 && after < 0.65, "{before} {after}");
    assert_eq!(report["cache"], "fifo:12");
    assert_eq!(
        folder.read("grid.obj"),
        grid_obj().into_bytes(),
        "the input is untouched"
    );

    let compared = folder.run(&[
        "compare", "grid.obj", "out.obj", "--cache", "fifo:12", "--json",
    ]);
    let compared = compared.json();
    assert_eq!(compared["same_triangles"], true);
    assert_eq!(compared["better"], "b");

    let again = folder.run(&[
        "optimize",
        "out.obj",
        "-o",
        "again.obj",
        "--cache",
        "fifo:12",
    ]);
    assert!(
        again.out().contains("nothing to improve"),
        "{}",
        again.out()
    );
    assert_eq!(folder.read("again.obj"), folder.read("out.obj"));
    // What is neither face nor vertex stays in its place.
    let head = |bytes: Vec<u8>| {
        String::from_utf8(bytes)
            .unwrap()
            .lines()
            .next()
            .map(str::to_owned)
    };
    assert_eq!(head(folder.read("out.obj")), Some("# a grid".into()));
}

#[test]
fn what_inspect_prints_is_what_optimize_promised() {
    let folder = Folder::new("inspect");
    folder.write("grid.obj", grid_obj());
    for cache in ["fifo:12", "fifo:3", "fifo:1024", "controllable:12"] {
        let flags = [
            "optimize", "grid.obj", "-o", "out.obj", "--cache", cache, "--json",
        ];
        let promised = folder.run(&flags).json();
        let flags = [
            "inspect", "out.obj", "--cache", cache, "--cache", "nvidia", "--json",
        ];
        let inspected = folder.run(&flags).json();
        let total = &inspected["total"];
        assert_eq!(
            total["acmr"][cache],
            promised["total"]["acmr"]["after"][cache]
        );
        assert_eq!(
            total["atvr"]["nvidia"],
            promised["total"]["atvr"]["after"]["nvidia"]
        );
        assert_eq!(inspected["schema"], 1);
        assert_eq!(inspected["meshes"][0]["faces"], 800);
        assert_eq!(inspected["meshes"][0]["vertices"], 441);
        assert_eq!(inspected["meshes"][0]["used_vertices"], 441);
        if cache.starts_with("controllable") {
            let scheduled = promised["meshes"][0]["scheduled"].as_f64().unwrap();
            assert!(scheduled >= total["acmr"][cache].as_f64().unwrap());
        }
    }
}

/// The vertices and faces of an OBJ without texture coordinates, as text and numbers.
fn parse(obj: &[u8]) -> (Vec<String>, Vec<Vec<usize>>) {
    let text = std::str::from_utf8(obj).unwrap();
    let of = |kind: &'static str| text.lines().filter_map(move |line| line.strip_prefix(kind));
    let numbers = |line: &str| {
        line.split(' ')
            .map(|n| n.parse::<usize>().unwrap() - 1)
            .collect()
    };
    (
        of("v ").map(str::to_owned).collect(),
        of("f ").map(numbers).collect(),
    )
}

#[test]
fn the_permutation_leads_from_the_input_to_the_output() {
    let folder = Folder::new("permutation");
    folder.write("grid.obj", grid_obj());
    for more in [
        &[][..],
        &["--keep-corners"],
        &["--mode", "faithful", "--cache", "fifo:12"],
        &["--effort", "best"],
        &["--keep-vertex-order"],
    ] {
        let mut flags = vec![
            "optimize",
            "grid.obj",
            "-o",
            "out.obj",
            "--write-permutation",
            "p.json",
        ];
        flags.extend(more);
        assert_eq!(folder.run(&flags).code(), 0);
        let file: Value = serde_json::from_slice(&folder.read("p.json")).unwrap();
        let mesh = &file["meshes"][0];
        let list = |key: &str| -> Option<Vec<usize>> {
            let list = mesh[key].as_array()?.iter();
            Some(
                list.map(|n| usize::try_from(n.as_u64().unwrap()).unwrap())
                    .collect(),
            )
        };
        let (vertices, faces) = parse(grid_obj().as_bytes());
        let (moved_vertices, moved_faces) = parse(&folder.read("out.obj"));
        let vertex_order =
            list("vertex_new_to_old").unwrap_or_else(|| (0..vertices.len()).collect());
        let in_new_order: Vec<_> = vertex_order
            .iter()
            .map(|&old| vertices[old].clone())
            .collect();
        assert_eq!(moved_vertices, in_new_order);
        let orders = list("face_new_to_old").unwrap().into_iter();
        let rotations = list("corner_rotations").unwrap();
        for (new, old) in orders.enumerate() {
            let corner = |j: usize| faces[old][(j + rotations[new]) % 3];
            let through = moved_faces[new].iter().map(|&v| vertex_order[v]);
            assert_eq!(through.collect::<Vec<_>>(), [0, 1, 2].map(corner));
        }
        if more == ["--keep-corners"] || more == ["--mode", "faithful"] {
            assert!(rotations.iter().all(|&r| r == 0));
        }
        assert_eq!(
            list("vertex_new_to_old").is_none(),
            more == ["--keep-vertex-order"]
        );
    }
}

#[test]
fn in_place_replaces_and_dry_run_does_not() {
    let folder = Folder::new("in-place");
    folder.write("grid.obj", grid_obj());
    assert_eq!(folder.run(&["optimize", "grid.obj", "--dry-run"]).code(), 0);
    assert_eq!(folder.read("grid.obj"), grid_obj().into_bytes());
    assert_eq!(
        folder.run(&["optimize", "grid.obj", "--in-place"]).code(),
        0
    );
    let ordered = folder.read("grid.obj");
    assert_ne!(ordered, grid_obj().into_bytes());
    let again = folder.run(&["optimize", "grid.obj", "--in-place"]);
    assert!(again.out().contains("left as it is"), "{}", again.out());
    assert_eq!(folder.read("grid.obj"), ordered);
    let names: Vec<_> = fs::read_dir(&folder.0).unwrap().collect();
    assert_eq!(names.len(), 1, "no temporary file is left: {names:?}");
}

#[test]
fn gzip_is_read_and_written() {
    let folder = Folder::new("gzip");
    folder.write("grid.obj", grid_obj());
    assert_eq!(
        folder
            .run(&["optimize", "grid.obj", "-o", "a.obj.gz"])
            .code(),
        0
    );
    assert_eq!(
        folder.run(&["optimize", "grid.obj", "-o", "b.obj"]).code(),
        0
    );
    let compared = folder
        .run(&["compare", "a.obj.gz", "b.obj", "--json"])
        .json();
    assert_eq!(compared["same_triangles"], true);
    assert_eq!(compared["better"], "equal");
    assert_eq!(folder.read("a.obj.gz")[..2], [0x1f, 0x8b]);
}

#[test]
fn an_order_that_is_not_better_is_not_written() {
    let folder = Folder::new("never-worse");
    // One fan: three misses, then one a face, in any cache that holds the middle.
    let mut fan = String::from("OFF\n12 10 0\n");
    fan += &(0..12).map(|i| format!("{i} 0 0\n")).collect::<String>();
    fan += &(0..10)
        .map(|i| format!("3 0 {} {}\n", i + 1, i + 2))
        .collect::<String>();
    folder.write("fan.off", &fan);
    let report = folder
        .run(&["optimize", "fan.off", "-o", "out.off", "--json"])
        .json();
    assert_eq!(report["meshes"][0]["changed"], false);
    assert_eq!(folder.read("out.off"), fan.as_bytes());
}

#[test]
fn different_triangles_are_told_apart() {
    let folder = Folder::new("compare");
    let off = |faces: &str, count: usize| {
        format!("OFF\n4 {count} 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n{faces}")
    };
    folder.write("a.off", off("3 0 1 2\n3 2 1 3\n", 2));
    folder.write("turned.off", off("3 1 3 2\n3 1 2 0\n", 2));
    folder.write("flipped.off", off("3 0 1 2\n3 1 2 3\n", 2));
    folder.write("fewer.off", off("3 0 1 2\n", 1));
    let same = |b: &str| folder.run(&["compare", "a.off", b, "--json"]).json();
    assert_eq!(same("turned.off")["same_triangles"], true);
    let flipped = same("flipped.off");
    assert_eq!(flipped["same_triangles"], false);
    assert_eq!([&flipped["only_in_a"], &flipped["only_in_b"]], [1, 1]);
    let fewer = same("fewer.off");
    assert_eq!([&fewer["only_in_a"], &fewer["only_in_b"]], [1, 0]);
}

#[test]
fn every_target_and_effort_keeps_the_triangles_and_settles() {
    let folder = Folder::new("targets");
    folder.write("grid.obj", grid_obj());
    let targets = [
        "universal",
        "fifo:12",
        "lru:24",
        "controllable:10",
        "nvidia",
        "amd",
        "intel",
    ];
    for target in targets {
        let mut fast = f64::INFINITY;
        for effort in ["fast", "best"] {
            let run = |input, output, more: &[&str]| {
                let flags = [
                    "optimize", input, "-o", output, "--cache", target, "--effort", effort,
                ];
                folder.run(&[&flags, more].concat())
            };
            let report = run("grid.obj", "out.obj", &["--json", "--threads", "1"]).json();
            assert_eq!(report["cache"], target);
            assert_eq!(report["effort"], effort);
            let model = match target {
                "universal" => "fifo:16",
                one => one,
            };
            let after = report["total"]["acmr"]["after"][model].as_f64().unwrap();
            assert!(after < 1.0 && after < fast * 1.05, "{target} {effort}");
            fast = after;
            let compared = folder.run(&["compare", "grid.obj", "out.obj", "--json"]);
            assert_eq!(compared.json()["same_triangles"], true);
            assert_eq!(
                run("grid.obj", "two.obj", &["--threads", "2"]).code(),
                0,
                "{target} {effort}"
            );
            assert_eq!(folder.read("out.obj"), folder.read("two.obj"));
            let again = run("out.obj", "again.obj", &[]);
            assert!(
                again.out().contains("nothing to improve"),
                "{target} {effort}: {}",
                again.out()
            );
        }
    }
    let timed = ["optimize", "grid.obj", "-o", "out.obj", "--time-budget"];
    let run = folder.run(&[&timed[..], &["100ms", "--json"]].concat());
    assert!(run.json()["total"]["acmr"]["after"]["fifo:16"].as_f64() < Some(0.7));
}

#[test]
fn inspect_plots_a_curve_for_each_file_and_method() {
    let folder = Folder::new("plot");
    folder.write("a.obj", grid_obj());
    folder.write("b.obj", grid_obj());
    let flags = ["inspect", "a.obj", "b.obj", "--plot", "two.svg", "--quiet"];
    assert_eq!(folder.run(&flags).code(), 0);
    let svg = String::from_utf8(folder.read("two.svg")).unwrap();
    assert_eq!(svg.matches("<polyline").count(), 2);
    assert!(svg.contains(">a.obj<") && svg.contains(">b.obj<"));
    let flags = ["inspect", "a.obj", "--plot", "all.svg", "--methods"];
    assert_eq!(folder.run(&flags).code(), 0);
    let svg = String::from_utf8(folder.read("all.svg")).unwrap();
    assert!(svg.matches("<polyline").count() > 8);
    assert!(svg.contains("a.obj, recursive cut"));
    assert_eq!(folder.run(&["inspect", "a.obj", "--methods"]).code(), 2);
    let flags = ["inspect", "a.obj", "--plot", "no/such/folder.svg"];
    let failed = folder.run(&flags);
    assert!(
        failed.err().contains("no/such/folder.svg"),
        "{}",
        failed.err()
    );
    assert_eq!(failed.code(), 1);
}

#[test]
fn every_report_begins_with_schema_and_command() {
    let folder = Folder::new("reports");
    for name in ["eight.obj", "face.obj"] {
        folder.write(name, grid_obj());
    }
    for flags in [
        &["optimize", "eight.obj", "--dry-run"][..],
        &["optimize", "missing.obj", "--dry-run"],
        &["inspect", "eight.obj"],
        &["compare", "eight.obj", "face.obj"],
        &["demo", "--faces", "500"],
        &["paper", "lin-yu", "--data", "."],
        &["paper", "bogomjakov-gotsman", "--data", "."],
    ] {
        let run = folder.run(&[flags, &["--json"]].concat());
        let begin = format!(r#"{{"schema":1,"command":"{}","#, flags[0]);
        assert!(run.out().starts_with(&begin), "{flags:?}: {}", run.out());
    }
}

#[test]
fn exit_codes_tell_files_from_usage() {
    let folder = Folder::new("exit");
    folder.write("grid.obj", grid_obj());
    folder.write("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n");
    folder.write("mesh.xyz", "?");
    let failed = folder.run(&["inspect", "bad.off"]);
    assert_eq!(failed.code(), 1);
    assert!(
        failed.err().starts_with("error: bad.off: line 6: "),
        "{}",
        failed.err()
    );
    assert!(
        failed.err().contains("index 9 is past the last vertex (2)"),
        "{}",
        failed.err()
    );
    let unknown = folder.run(&["inspect", "mesh.xyz"]);
    assert!(
        unknown.err().contains("unknown format"),
        "{}",
        unknown.err()
    );
    assert_eq!(unknown.code(), 1);
    assert_eq!(folder.run(&["inspect", "missing.obj"]).code(), 1);
    for usage in [
        &["optimize", "grid.obj"][..],
        &["optimize", "grid.obj", "-o", "x.obj", "--cache", "fifo:2"],
        &["optimize", "grid.obj", "-o", "x.obj", "--cache", "voodoo"],
        &["optimize", "grid.obj", "-o", "x.obj", "--mode", "faithful"],
        &["optimize", "grid.obj", "-o", "x.obj", "--time-budget", "5"],
        &[
            "optimize",
            "grid.obj",
            "-o",
            "x.obj",
            "--cache",
            "fifo:1025",
        ],
        &["optimize", "grid.obj", "-o", "grid.obj"],
        &["optimize", "grid.obj", "-o", "x.obj", "--in-place"],
        &["optimize", "grid.obj", "bad.off", "-o", "x.obj"],
        &["frobnicate"],
        &[],
    ] {
        let run = folder.run(usage);
        assert_eq!(run.code(), 2, "{usage:?}: {}", run.err());
        assert!(!run.err().is_empty());
    }
    let other_format = folder.run(&["optimize", "grid.obj", "-o", "x.ply"]);
    assert_eq!(other_format.code(), 1);
    assert!(
        other_format.err().contains("same ending"),
        "{}",
        other_format.err()
    );
    assert!(!folder.0.join("x.ply").exists());
}

#[test]
fn several_files_go_into_a_folder() {
    let folder = Folder::new("several");
    folder.write("a.obj", grid_obj());
    folder.write("b.obj", grid_obj());
    folder.write("bad.off", "OFF\n");
    let run = folder.run(&[
        "optimize",
        "a.obj",
        "bad.off",
        "b.obj",
        "-o",
        "out/",
        "--keep-going",
    ]);
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("bad.off"), "{}", run.err());
    assert_eq!(folder.read("out/a.obj"), folder.read("out/b.obj"));
}

#[test]
fn help_and_version_are_there() {
    let folder = Folder::new("help");
    for verb in ["optimize", "inspect", "compare", "demo", "paper"] {
        let help = folder.run(&[verb, "--help"]);
        assert_eq!(help.code(), 0);
        assert!(help.out().contains("Usage: meshweft"), "{}", help.out());
    }
    assert!(folder.run(&["--version"]).out().starts_with("meshweft 0."));
}
