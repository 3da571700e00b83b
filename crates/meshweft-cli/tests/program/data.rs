//! Every real mesh and every broken file through the program.

use meshweft::order::Target;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::{Folder, data_folder};

/// The endings of the mesh formats other than glTF.
const MESHES: &[&str] = &[".obj", ".ply", ".off", ".stl", ".wrl"];

/// The files below a folder with one of these endings (`.gz` aside), sorted.
pub(crate) fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            let name = name.strip_suffix(".gz").unwrap_or(name).to_owned();
            if path.is_dir() {
                folders.push(path);
            } else if endings.iter().any(|ending| name.ends_with(ending)) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Real meshes and scenes.
fn real_files(data: &Path) -> Vec<PathBuf> {
    let mut paths = files(&data.join("meshes"), MESHES);
    paths.extend(files(&data.join("gltf"), &[".glb", ".gltf"]));
    paths
}

#[test]
fn every_real_mesh_keeps_its_triangles_and_gets_no_worse() {
    let Some(data) = data_folder("real meshes") else {
        return;
    };
    let mut paths = real_files(&data);
    // The dragon alone would take most of the time in an unoptimised build.
    paths.retain(|path| !path.ends_with("dragon.ply.gz"));
    let (mut improved, mut with_strips) = (0, 0);
    for (i, input) in paths.iter().enumerate() {
        let folder = Folder::new(&format!("real-{i}"));
        let name = input.file_name().unwrap().to_str().unwrap();
        // Uncompressed output, to compare and to read fast.
        let name = name.strip_suffix(".gz").unwrap_or(name);
        let input = input.to_str().unwrap();
        let before = fs::read(input).unwrap();
        let report = folder
            .run(&["optimize", input, "-o", name, "--json"])
            .json();
        let acmr = &report["total"]["acmr"];
        // The universal order may lose on one cache what it gains on others.
        let universal: Vec<String> = Target::UNIVERSAL.iter().map(ToString::to_string).collect();
        let acmr_of = |when, model: &str| acmr[when][model].as_f64().unwrap();
        let [was, is] =
            ["before", "after"].map(|when| universal.iter().map(|m| acmr_of(when, m)).sum::<f64>());
        assert!(is <= was, "{name}: {was} to {is}");
        improved += usize::from(is < was);
        let compared = folder
            .run(&["compare", input, name, "--cache", "fifo:12", "--json"])
            .json();
        assert_eq!(compared["same_triangles"], true, "{name}");
        // The comparison counts strips too, as the triangles that they draw.
        if compared["b"]["faces"] == report["total"]["faces"] {
            assert_eq!(
                compared["b"]["acmr"]["fifo:12"].as_f64(),
                Some(acmr_of("after", "fifo:12")),
                "{name}"
            );
        } else {
            with_strips += 1;
        }
        // The program run on its own output finds nothing to do, in a folder of its own.
        let written = folder.read(name);
        fs::create_dir(folder.0.join("again")).unwrap();
        let again = format!("again/{name}");
        assert_eq!(
            folder.run(&["optimize", name, "-o", &again]).code(),
            0,
            "{name}"
        );
        assert_eq!(folder.read(&again), written, "{name}");
        assert_eq!(
            fs::read(input).unwrap(),
            before,
            "{name}: the input is untouched"
        );
    }
    eprintln!(
        "{} real files, {improved} improved, {with_strips} with strips, none skipped",
        paths.len()
    );
    assert!(improved > 50 && with_strips < 3);
}

/// Flags that change what is done, each of which must keep what has to be kept.
const FLAGS: [&[&str]; 12] = [
    &["--cache", "controllable:16"],
    &["--cache", "fifo:12", "--mode", "faithful"],
    &["--cache", "nvidia"],
    &["--cache", "amd", "--seed", "5", "--keep-corners"],
    &["--cache", "lru:20"],
    &["--keep-corners"],
    &["--keep-vertex-order"],
    &["--cache", "fifo:32", "--allow-worse"],
    &[
        "--cache", "fifo:14", "--k1", "0.7", "--k2", "1.5", "--k3", "0.2",
    ],
    &["--across-groups"],
    &["--assume-order-safe", "EXT_mesh_features"],
    &[
        "--cache",
        "controllable:7",
        "--mode",
        "faithful",
        "--keep-vertex-order",
    ],
];

#[test]
fn every_flag_keeps_the_triangles_on_any_number_of_threads() {
    let Some(data) = data_folder("flags on real meshes") else {
        return;
    };
    let mut paths = real_files(&data);
    // Each file with two of the sets, the larger ones left to the other test.
    paths.retain(|path| fs::metadata(path).unwrap().len() < 500_000);
    let folder = Folder::new("flags");
    for (i, input) in paths.iter().enumerate() {
        let name = input.file_name().unwrap().to_str().unwrap();
        let name = name.strip_suffix(".gz").unwrap_or(name);
        let input = input.to_str().unwrap();
        for flags in [FLAGS[i % FLAGS.len()], FLAGS[(i * 5 + 2) % FLAGS.len()]] {
            for threads in ["1", "2"] {
                let output = format!("{threads}/{name}");
                let mut arguments = vec!["optimize", input, "-o", &output, "--threads", threads];
                arguments.extend(flags);
                let run = folder.run(&arguments);
                assert_eq!(run.code(), 0, "{name} {flags:?}: {}", run.err());
            }
            let [one, two] = ["1", "2"].map(|threads| format!("{threads}/{name}"));
            assert!(folder.read(&one) == folder.read(&two), "{name} {flags:?}");
            let compared = folder.run(&["compare", input, &one, "--json"]).json();
            assert_eq!(compared["same_triangles"], true, "{name} {flags:?}");
        }
    }
    eprintln!(
        "{} real files with two sets of flags each, none skipped",
        paths.len()
    );
}

#[test]
fn every_broken_file_is_refused_or_read_in_time() {
    let Some(data) = data_folder("malformed files") else {
        return;
    };
    let folder = Folder::new("malformed");
    let paths = files(&data.join("malformed"), &[""]);
    let (mut refused, mut read) = (0, 0);
    for (i, input) in paths.iter().enumerate() {
        let before = fs::read(input).unwrap();
        let name = input.file_name().unwrap().to_str().unwrap();
        let output = folder.0.join(format!("{i}-{name}"));
        let mut child = Command::new(env!("CARGO_BIN_EXE_meshweft"))
            .arg("optimize")
            .arg(input)
            .arg("-o")
            .arg(&output)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Generous: the tests share the machine. A hang is what is looked for.
        let deadline = Instant::now() + Duration::from_secs(20);
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            assert!(Instant::now() < deadline, "{name} hangs");
            std::thread::sleep(Duration::from_millis(2));
        };
        let error = child.wait_with_output().unwrap().stderr;
        let error = String::from_utf8(error).unwrap();
        match status.code() {
            Some(0) => read += 1,
            Some(1) => {
                refused += 1;
                assert!(
                    error.contains("error: ") && error.contains(name),
                    "{name}: {error}"
                );
                assert!(!output.exists(), "{name}: refused, yet written");
            }
            other => panic!("{name}: {other:?} {error}"),
        }
        assert_eq!(
            fs::read(input).unwrap(),
            before,
            "{name}: the input is untouched"
        );
    }
    eprintln!(
        "{} broken files: {refused} refused, {read} read, none skipped",
        paths.len()
    );
    assert_eq!(refused + read, paths.len());
}
