//! Folders, patterns, jobs, shards, and runs that are cut off.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::Folder;
use crate::basics::grid_obj;

/// The files below a folder, as paths relative to it, sorted.
fn files(folder: &Path) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(current) = folders.pop() {
        for entry in fs::read_dir(current).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let relative = path.strip_prefix(folder).unwrap();
                found.insert(relative.to_str().unwrap().to_owned());
            }
        }
    }
    found
}

fn lines(text: &[u8]) -> Vec<Value> {
    let text = std::str::from_utf8(text).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
    lines.collect()
}

/// A folder `in` with meshes in it and below, and with what is not to be touched.
fn tree(name: &str) -> Folder {
    let folder = Folder::new(name);
    for below in ["in/a", "in/b/c", "in/.hidden"] {
        fs::create_dir_all(folder.0.join(below)).unwrap();
    }
    for file in [
        "in/1.obj",
        "in/a/1.obj",
        "in/b/c/2.obj",
        "in/b/3.obj",
        "in/.hidden/4.obj",
    ] {
        folder.write(file, grid_obj());
    }
    folder.write("in/readme.txt", "no mesh");
    folder.write("in/a/.5.obj", "hidden");
    folder
}

fn set(files: &[&str]) -> BTreeSet<String> {
    files.iter().map(|&file| file.to_owned()).collect()
}

#[test]
fn a_folder_is_repeated_in_the_output() {
    let folder = tree("many-folder");
    let run = folder.run(&["optimize", "in", "-o", "out", "--json", "--jobs", "2"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let all = ["1.obj", "a/1.obj", "b/3.obj", "b/c/2.obj"];
    assert_eq!(files(&folder.0.join("out")), set(&all));
    let reports = lines(run.out().as_bytes());
    let order: Vec<_> = reports
        .iter()
        .map(|r| r["file"].as_str().unwrap())
        .collect();
    assert_eq!(order, all.map(|file| format!("in/{file}")), "in order");
    // An output folder within the input is not taken as input.
    let run = folder.run(&["optimize", ".", "-o", "out", "--json"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(lines(run.out().as_bytes()).len(), 4);
    // One file into a folder that is there.
    let run = folder.run(&["optimize", "in/1.obj", "-o", "out/b"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.0.join("out/b/1.obj").exists());
}

#[test]
fn patterns_and_shards_part_the_work() {
    let folder = tree("many-patterns");
    let run = folder.run(&["optimize", "in/**/*.obj", "-o", "out"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let all = set(&["1.obj", "a/1.obj", "b/3.obj", "b/c/2.obj"]);
    assert_eq!(files(&folder.0.join("out")), all);
    // What is hidden is found by its dot.
    let run = folder.run(&["optimize", "in/.h*/*.obj", "-o", "hidden"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let hidden = files(&folder.0.join("hidden"));
    assert_eq!(hidden, set(&[".hidden/4.obj"]));
    for (shard, count) in [("1/3", 2), ("2/3", 1), ("3/3", 1)] {
        let output = format!("shard-{}", &shard[..1]);
        let run = folder.run(&["optimize", "in", "-o", &output, "--shard", shard]);
        assert_eq!(run.code(), 0, "{}", run.err());
        assert_eq!(files(&folder.0.join(output)).len(), count);
    }
    for (usage, says) in [
        (
            &["optimize", "in/*.ply", "-o", "x"][..],
            "no mesh file found",
        ),
        (&["optimize", "in", "-o", "x.obj"], "FOLDER/"),
        (&["optimize", "in", "-o", "x", "--shard", "3/2"], "I/N"),
        (
            &["optimize", "in/1.obj", "in/a/1.obj", "-o", "x"],
            "both be written to x/1.obj",
        ),
        (
            &["optimize", "in", "--in-place", "--write-permutation", "p"],
            "one file at a time",
        ),
    ] {
        let run = folder.run(usage);
        assert_eq!(run.code(), 2, "{}", run.err());
        assert!(run.err().contains(says), "{}", run.err());
        assert!(!folder.0.join("x").exists());
    }
}

#[test]
fn the_output_is_the_same_on_any_number_of_threads() {
    let folder = tree("many-threads");
    let mut outputs = Vec::new();
    for (jobs, threads) in [("1", "1"), ("1", "2"), ("2", "1"), ("3", "5")] {
        let run = folder.run(&[
            "optimize",
            "in",
            "-o",
            "out",
            "--json",
            "--jobs",
            jobs,
            "--threads",
            threads,
        ]);
        assert_eq!(run.code(), 0, "{}", run.err());
        let written = files(&folder.0.join("out"));
        let bytes: Vec<_> = written
            .iter()
            .map(|f| folder.read(&format!("out/{f}")))
            .collect();
        // All of the reports but the time that the work took.
        let reports: Vec<Value> = run
            .out()
            .lines()
            .map(|line| {
                let mut report: Value = serde_json::from_str(line).unwrap();
                assert!(report["seconds"].take().as_f64() > Some(0.0));
                report
            })
            .collect();
        outputs.push((reports, bytes));
    }
    assert!(outputs.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn more_threads_than_a_system_starts_are_refused() {
    let folder = tree("many-too-many");
    for flag in ["--threads", "--jobs"] {
        for count in ["1025", "100000", "99999999999999999999"] {
            let run = folder.run(&["optimize", "in", "-o", "out", flag, count]);
            assert_eq!(run.code(), 2, "{}", run.err());
            assert!(run.err().contains(count), "{}", run.err());
            assert!(!folder.0.join("out").exists());
        }
        let run = folder.run(&["optimize", "in", "-o", "out", flag, "1025"]);
        let says = format!("invalid value '1025' for '{flag} <N>': at most 1024 are allowed");
        assert!(run.err().contains(&says), "{}", run.err());
        let run = folder.run(&["optimize", "in/1.obj", "-o", "most.obj", flag, "1024"]);
        assert_eq!(run.code(), 0, "{}", run.err());
    }
    let both = ["--jobs", "2", "--threads", "1000"];
    let run = folder.run(&[&["optimize", "in", "-o", "out"], &both[..]].concat());
    assert_eq!(run.code(), 2, "{}", run.err());
    let says = "2 jobs of 1000 threads each are more than 1024 threads";
    assert!(run.err().contains(says), "{}", run.err());
}

#[test]
fn a_failure_stops_or_is_passed_over() {
    let folder = tree("many-failure");
    folder.write("in/a/0.off", "OFF\n");
    let run = folder.run(&["optimize", "in", "-o", "out", "--jobs", "1", "--json"]);
    assert_eq!(run.code(), 1);
    assert_eq!(files(&folder.0.join("out")), set(&["1.obj"]));
    let run = folder.run(&[
        "optimize",
        "in",
        "-o",
        "out",
        "--keep-going",
        "--json",
        "--manifest",
        "m",
    ]);
    assert_eq!(run.code(), 1);
    assert_eq!(files(&folder.0.join("out")).len(), 4);
    let reports = lines(run.out().as_bytes());
    assert_eq!(reports.len(), 5);
    assert!(
        reports[1]["error"]
            .as_str()
            .unwrap()
            .starts_with("in/a/0.off: line ")
    );
    // The list has what failed, and the next run tries just that again.
    let listed = lines(&folder.read("m"));
    assert_eq!(listed.iter().filter(|l| l["status"] == "failed").count(), 1);
    folder.write("in/a/0.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    let run = folder.run(&["optimize", "in", "-o", "out", "--json", "--manifest", "m"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    let again = lines(run.out().as_bytes());
    assert_eq!(again.iter().filter(|r| r["done_before"] == true).count(), 4);
    assert_eq!(lines(&folder.read("m")).len(), 6);
}

#[test]
fn a_run_that_is_killed_goes_on_where_it_was() {
    let folder = Folder::new("many-killed");
    fs::create_dir(folder.0.join("in")).unwrap();
    let count = 1000;
    for i in 0..count {
        folder.write(&format!("in/{i}.obj"), grid_obj() + &format!("# {i}\n"));
    }
    let flags = [
        "optimize",
        "in",
        "-o",
        "out",
        "--jobs",
        "2",
        "--manifest",
        "done.jsonl",
        "--quiet",
    ];
    let start = || {
        Command::new(env!("CARGO_BIN_EXE_meshweft"))
            .args(flags)
            .current_dir(&folder.0)
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    };
    let listed = || match fs::read(folder.0.join("done.jsonl")) {
        Ok(text) => text.iter().filter(|&&byte| byte == b'\n').count(),
        Err(_) => 0,
    };
    // Killed hard, a third and two thirds of the way.
    for part in [count / 3, 2 * count / 3] {
        let mut child = start();
        let deadline = Instant::now() + Duration::from_secs(120);
        while listed() < part {
            assert!(Instant::now() < deadline, "it does not get on");
            assert!(
                child.try_wait().unwrap().is_none(),
                "done before it was killed"
            );
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(start().wait().unwrap().success());
    // Every output whole and what a run without interruption writes; nothing else is left there.
    assert_eq!(
        folder
            .run(&["optimize", "in", "-o", "whole", "--quiet"])
            .code(),
        0
    );
    let names = files(&folder.0.join("whole"));
    assert_eq!(names.len(), count);
    assert_eq!(files(&folder.0.join("out")), names);
    for name in &names {
        assert_eq!(
            folder.read(&format!("out/{name}")),
            folder.read(&format!("whole/{name}"))
        );
    }
    // Each is listed once; a line that the kill cut off is no JSON.
    let text = String::from_utf8(folder.read("done.jsonl")).unwrap();
    let lines = text
        .lines()
        .filter_map(|l| serde_json::from_str::<Value>(l).ok());
    let done: Vec<_> = lines
        .map(|l| l["file"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(done.len(), count);
    assert_eq!(done.iter().collect::<BTreeSet<_>>().len(), count);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_whole_files_only() {
    let folder = Folder::new("many-interrupted");
    fs::create_dir(folder.0.join("in")).unwrap();
    for i in 0..400 {
        folder.write(&format!("in/{i}.obj"), grid_obj());
    }
    let mut child = Command::new(env!("CARGO_BIN_EXE_meshweft"))
        .args(["optimize", "in", "-o", "out", "--jobs", "2"])
        .current_dir(&folder.0)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let count = || fs::read_dir(folder.0.join("out")).map_or(0, Iterator::count);
    while count() < 20 {
        assert!(child.try_wait().unwrap().is_none(), "done too soon");
    }
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("interrupted"), "{error}");
    let expected = folder.run(&["optimize", "in/0.obj", "-o", "one.obj"]);
    assert_eq!(expected.code(), 0);
    let expected = folder.read("one.obj");
    let left = files(&folder.0.join("out"));
    assert!((20..400).contains(&left.len()), "{}", left.len());
    for name in left {
        assert!(name.ends_with(".obj"), "{name}");
        assert_eq!(folder.read(&format!("out/{name}")), expected);
    }
}

#[test]
fn a_buffer_that_two_files_read_stays() {
    let folder = Folder::new("many-shared");
    // A strip drawn in a poor order, its numbers in a file of their own.
    let faces: Vec<u16> = (0..60)
        .map(|i| i * 7 % 60)
        .flat_map(|i| [i, i + 1, i + 2])
        .collect();
    let mut data = vec![0_u8; 62 * 12];
    data.extend(faces.iter().flat_map(|n| n.to_le_bytes()));
    let gltf = |name: &str| {
        serde_json::json!({
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": data.len(), "uri": name}],
            "bufferViews": [{"buffer": 0, "byteLength": 744},
                {"buffer": 0, "byteOffset": 744, "byteLength": 360}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 62, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5123, "count": 180, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        })
        .to_string()
    };
    folder.write("data.bin", &data);
    folder.write("own.bin", &data);
    for (file, buffer) in [
        ("a.gltf", "data.bin"),
        ("b.gltf", "data.bin"),
        ("c.gltf", "own.bin"),
    ] {
        folder.write(file, gltf(buffer));
    }
    // The other reader need not be part of the run.
    let run = folder.run(&["optimize", "a.gltf", "c.gltf", "--in-place"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.err().contains("other files read its buffer too"),
        "{}",
        run.err()
    );
    assert!(folder.read("data.bin") == data);
    assert!(folder.read("own.bin") != data);
}

#[test]
fn the_unknown_is_kept_refused_or_vouched_for() {
    let folder = Folder::new("unknown");
    folder.write("a.obj", grid_obj() + "curv2 1 2 3\n");
    let run = |flags: &[&str]| {
        let mut arguments = vec!["optimize", "a.obj", "-o", "out.obj", "--json"];
        arguments.extend(flags);
        folder.run(&arguments)
    };
    let kept = run(&[]).json();
    assert_eq!(kept["meshes"][0]["vertices_moved"], false);
    let refused = run(&["--strict"]);
    assert_eq!(refused.code(), 1);
    assert!(
        refused.err().contains("the statement curv2 is not known"),
        "{}",
        refused.err()
    );
    let vouched = run(&["--strict", "--assume-order-safe", "curv2"]).json();
    assert_eq!(vouched["meshes"][0]["vertices_moved"], true);
}

#[test]
fn groups_are_crossed_only_if_asked() {
    let folder = Folder::new("groups");
    // Every face in a group of its own: within them nothing can move.
    let each = |statement: &str| {
        let text = grid_obj();
        let lines = text
            .lines()
            .enumerate()
            .map(|(number, line)| match line.starts_with("f ") {
                true => format!("{statement} part{number}\n{line}\n"),
                false => format!("{line}\n"),
            });
        lines.collect::<String>()
    };
    folder.write("a.obj", each("g"));
    let acmr = |flags: &[&str]| {
        let mut arguments = vec!["optimize", "a.obj", "-o", "out.obj", "--json"];
        arguments.extend(flags);
        let report = folder.run(&arguments).json();
        report["total"]["acmr"]["after"]["fifo:12"]
            .as_f64()
            .unwrap()
    };
    let within = acmr(&[]);
    let across = acmr(&["--across-groups"]);
    assert!(across < 0.7 && within > 1.0, "{within} {across}");
    let compared = folder
        .run(&["compare", "a.obj", "out.obj", "--json"])
        .json();
    assert_eq!(compared["same_triangles"], true);
    // A material is never crossed.
    folder.write("a.obj", each("usemtl"));
    assert!(acmr(&["--across-groups"]) > 1.0);
}
