//! What a run does to other files of the disk: nothing, but it brings along what a scene names.

use std::fs;

use serde_json::json;

use crate::Folder;

/// A scene of a strip in a bad order, its data in a buffer of this name.
pub(crate) fn scene(folder: &Folder, name: &str, buffer: &str, seed: u32) {
    let positions: Vec<u8> = (0..60_u16)
        .flat_map(|i| [f32::from(i / 2), f32::from(i % 2), seed as f32])
        .flat_map(f32::to_le_bytes)
        .collect();
    let corners = (0..58_u16)
        .map(|i| i * 23 % 58)
        .flat_map(|first| [first, first + 1, first + 2]);
    let corners: Vec<u8> = corners.flat_map(u16::to_le_bytes).collect();
    let text = json!({
        "asset": {"version": "2.0"},
        "images": [{"uri": "maps/red.png"}, {"uri": "blue.png"}],
        "buffers": [{"uri": buffer, "byteLength": positions.len() + corners.len()}],
        "bufferViews": [{"buffer": 0, "byteLength": positions.len()},
            {"buffer": 0, "byteOffset": positions.len(), "byteLength": corners.len()}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 60},
            {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 174}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    });
    let path = folder.0.join(name);
    fs::create_dir_all(path.with_file_name("maps")).unwrap();
    fs::write(path.with_file_name("maps/red.png"), "red").unwrap();
    fs::write(path.with_file_name("blue.png"), "blue").unwrap();
    fs::write(path.with_file_name(buffer), [positions, corners].concat()).unwrap();
    fs::write(path, text.to_string()).unwrap();
}

#[test]
fn images_come_along_and_are_counted() {
    let folder = Folder::new("images");
    scene(&folder, "in/scene.gltf", "scene.bin", 0);
    let run = folder.run(&["optimize", "in/scene.gltf", "-o", "out/scene.gltf"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.out().contains("\n  copied 2 files that it names\n"),
        "{}",
        run.out()
    );
    assert_eq!(folder.read("out/maps/red.png"), b"red");

    // In another order of things: one is there, one is another file's.
    folder.write("out/blue.png", "mine");
    let run = folder.run(&[
        "optimize",
        "in/scene.gltf",
        "-o",
        "out/scene.gltf",
        "--json",
    ]);
    let report = run.json();
    assert_eq!(report["copied"], 1);
    let notes = report["notes"].to_string();
    assert!(
        notes.contains("blue.png is not copied: another file of this name is there"),
        "{notes}"
    );
    assert!(
        run.err()
            .contains("note: in/scene.gltf: blue.png is not copied"),
        "{}",
        run.err()
    );
    assert_eq!(folder.read("out/blue.png"), b"mine");

    for arguments in [
        &[
            "optimize",
            "in/scene.gltf",
            "-o",
            "bare/scene.gltf",
            "--no-copy",
            "--json",
        ][..],
        &["optimize", "in/scene.gltf", "--in-place", "--json"],
    ] {
        assert_eq!(folder.run(arguments).json()["copied"], 0);
    }
    assert!(!folder.0.join("bare/blue.png").exists());

    // A folder of scenes: each image once.
    let run = folder.run(&["optimize", "in", "-o", "all", "--json", "--jobs", "2"]);
    assert_eq!(run.json()["copied"], 2);
}

#[test]
fn a_backup_beside_keeps_nothing_from_being_ordered_elsewhere() {
    let folder = Folder::new("backup");
    scene(&folder, "in/scene.gltf", "scene.bin", 0);
    fs::copy(
        folder.0.join("in/scene.gltf"),
        folder.0.join("in/backup.gltf"),
    )
    .unwrap();
    let before = folder.read("in/scene.bin");
    let run = folder.run(&[
        "optimize",
        "in/scene.gltf",
        "-o",
        "out/scene.gltf",
        "--json",
    ]);
    let report = run.json();
    assert!(report["meshes"][0]["changed"] == true, "{report}");
    assert!(
        !report["notes"].to_string().contains("other files read"),
        "{report}"
    );

    // In place it does.
    let run = folder.run(&["optimize", "in/scene.gltf", "--in-place", "--json"]);
    assert!(
        run.json()["notes"]
            .to_string()
            .contains("other files read its buffer too")
    );
    assert_eq!(folder.read("in/scene.bin"), before);
}

#[test]
fn a_refused_output_leaves_no_folder() {
    let folder = Folder::new("no-folder");
    scene(&folder, "scene.gltf", "scene.bin", 0);
    let run = folder.run(&["optimize", "scene.gltf", "-o", "new/below/scene.glb"]);
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("a glTF file stays one"), "{}", run.err());
    assert!(!folder.0.join("new").exists());
}

#[test]
fn jobs_with_one_buffer_name_get_the_same_names_whoever_is_first() {
    let folder = Folder::new("colliding");
    for (number, name) in (0..).zip(["a/one.gltf", "b/two.gltf", "c/three.gltf"]) {
        fs::create_dir_all(folder.0.join(name).parent().unwrap()).unwrap();
        scene(&folder, name, "scene.bin", number);
    }
    // The one before last wants the name that the last would be given.
    scene(&folder, "c/three.gltf", "two.bin", 3);
    let mut seen = Vec::new();
    for jobs in ["1", "3", "3", "3", "1"] {
        let inputs = ["a/one.gltf", "b/two.gltf", "c/three.gltf"];
        let run =
            folder.run(&[&["optimize"], &inputs[..], &["-o", "out/", "--jobs", jobs]].concat());
        assert_eq!(run.code(), 0, "{}", run.err());
        let mut names: Vec<_> = fs::read_dir(folder.0.join("out"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        seen.push(names);
        for input in inputs {
            let name = input.split_once('/').unwrap().1;
            let run = folder.run(&["compare", input, &format!("out/{name}"), "--json"]);
            assert_eq!(run.json()["same_triangles"], true, "{name}");
        }
        fs::remove_dir_all(folder.0.join("out")).unwrap();
    }
    assert!(seen.iter().all(|names| *names == seen[0]), "{seen:?}");
    assert!(seen[0].contains(&"scene.bin".into()) && seen[0].contains(&"two.bin".into()));

    // Two scenes over one buffer: each is ordered, with a buffer of its own.
    fs::copy(folder.0.join("a/one.gltf"), folder.0.join("a/copy.gltf")).unwrap();
    for jobs in ["1", "2"] {
        let run = folder.run(&["optimize", "a", "-o", "out", "--jobs", jobs]);
        assert_eq!(run.code(), 0, "{}", run.err());
        for name in ["copy.bin", "one.bin"] {
            assert!(folder.0.join("out").join(name).exists(), "{name}");
        }
        assert!(!folder.0.join("out/scene.bin").exists());
        fs::remove_dir_all(folder.0.join("out")).unwrap();
    }
}

#[test]
fn a_dry_run_writes_no_order_and_one_file_is_not_two() {
    let folder = Folder::new("dry-order");
    scene(&folder, "scene.gltf", "scene.bin", 0);
    let optimize = ["optimize", "scene.gltf"];
    let run = folder.run(
        &[
            &optimize[..],
            &["--dry-run", "--write-permutation", "order.json"],
        ]
        .concat(),
    );
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(!folder.0.join("order.json").exists());

    let both = [
        "-o",
        "out.gltf",
        "--manifest",
        "list",
        "--write-permutation",
        "./list",
    ];
    let run = folder.run(&[&optimize[..], &both].concat());
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("this is the file of --manifest"),
        "{}",
        run.err()
    );
    assert!(!folder.0.join("list").exists() && !folder.0.join("out.gltf").exists());
}

#[test]
fn every_line_of_a_list_is_looked_at() {
    let folder = Folder::new("whole-list");
    scene(&folder, "scene.gltf", "scene.bin", 0);
    let optimize = [
        "optimize",
        "scene.gltf",
        "-o",
        "out/scene.gltf",
        "--manifest",
        "list",
    ];
    assert_eq!(folder.run(&optimize).code(), 0);
    let list = folder.read("list");
    for more in [&b"mine\n"[..], b"{\"schema\":1}\n", b"mine"] {
        // Also where it is far down.
        let many = list.repeat(1 + (1 << 17) / list.len());
        for start in [&list, &many] {
            let text = [start, more].concat();
            folder.write("list", &text);
            let run = folder.run(&optimize);
            assert_eq!(run.code(), 2, "{}", run.err());
            assert!(run.err().contains("not every line"), "{}", run.err());
            assert_eq!(folder.read("list"), text);
        }
    }
    // A run that was killed, and the one after it.
    let cut = [&list[..], &list[..20], b"\n", &list[..9]].concat();
    folder.write("list", cut);
    assert_eq!(folder.run(&optimize).code(), 0);
}

#[test]
fn the_flag_for_a_larger_file_is_named() {
    let folder = Folder::new("max-bytes");
    scene(&folder, "scene.gltf", "scene.bin", 0);
    for verb in [
        &["inspect"][..],
        &["optimize", "--dry-run"],
        &["compare", "scene.gltf"],
    ] {
        let verb = [verb, &["scene.gltf", "--max-bytes", "100"]].concat();
        let run = folder.run(&verb);
        assert_eq!(run.code(), 1, "{verb:?}");
        assert!(
            run.err().contains(
                "more than the limit of 100. Split the file, or allow more with --max-bytes"
            ),
            "{}",
            run.err()
        );
        let larger = [&verb[..verb.len() - 1], &["1M"]].concat();
        assert_eq!(folder.run(&larger).code(), 0);
    }
}

#[cfg(unix)]
#[test]
fn names_that_are_not_utf_8_are_not_passed_over() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let folder = Folder::new("not-utf-8");
    scene(&folder, "in/scene.gltf", "scene.bin", 0);
    let odd = [b"in/\xff.gltf", b"in/\xfe.gltf"].map(|name| folder.0.join(OsStr::from_bytes(name)));
    for path in &odd {
        if fs::copy(folder.0.join("in/scene.gltf"), path).is_err() {
            eprintln!("SKIPPED: this file system has UTF-8 names only");
            return;
        }
    }
    for pattern in ["in", "in/*.gltf", "**/*.gltf", "./in/*[!x].gltf"] {
        let run = folder.run(&["optimize", pattern, "-o", "out", "--manifest", "list"]);
        assert_eq!(run.code(), 0, "{pattern}: {}", run.err());
        let mut count = 0;
        let mut folders = vec![folder.0.join("out")];
        while let Some(below) = folders.pop() {
            for entry in fs::read_dir(below).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    false => count += u32::from(path.extension() == Some(OsStr::new("gltf"))),
                }
            }
        }
        assert_eq!(count, 3, "{pattern}");
        fs::remove_dir_all(folder.0.join("out")).unwrap();
    }
}
