//! No file of the user's is replaced but the one that was asked for.

use std::fs;

use crate::Folder;

/// Faces whose order can be improved.
fn strip() -> String {
    let mut text = String::new();
    for i in 0..60 {
        text += &format!("v {} {} 0\n", i / 2, i % 2);
    }
    for i in 0..58 {
        let first = i * 23 % 58 + 1;
        text += &format!("f {first} {} {}\n", first + 1, first + 2);
    }
    text
}

#[test]
fn lists_orders_and_plots_replace_nothing_else() {
    let folder = Folder::new("side-files");
    folder.write("mesh.obj", strip());
    folder.write("notes.md", "mine");
    let before = folder.read("mesh.obj");
    let optimize = ["optimize", "mesh.obj", "-o", "out.obj"];

    for (flag, verb) in [
        ("--write-permutation", &optimize[..]),
        ("--manifest", &optimize),
        ("--plot", &["inspect", "mesh.obj"]),
    ] {
        // A file of somebody else's.
        let run = folder.run(&[verb, &[flag, "notes.md"]].concat());
        assert_eq!(run.code(), 2, "{flag}");
        let expected = format!("{flag} notes.md: this file is not one that {flag} writes: choose");
        assert!(run.err().contains(&expected), "{}", run.err());
        assert_eq!(folder.read("notes.md"), b"mine");

        // A mesh of the run, by any of its names; no flag allows it.
        for name in ["mesh.obj", "./mesh.obj"] {
            let run = folder.run(&[verb, &[flag, name, "--force"]].concat());
            assert_eq!(run.code(), 2, "{flag} {name}");
            let expected = format!("{flag} {name}: this is a mesh of the run");
            assert!(run.err().contains(&expected), "{}", run.err());
        }
        assert_eq!(folder.read("mesh.obj"), before);
        assert!(
            !folder.0.join("out.obj").exists(),
            "{flag}: nothing is done"
        );

        // Its own file, again and again.
        for _ in 0..2 {
            let own = format!("own{flag}");
            assert_eq!(
                folder.run(&[verb, &[flag, &own]].concat()).code(),
                0,
                "{flag}"
            );
        }
        let _ = fs::remove_file(folder.0.join("out.obj"));
    }
    let run = folder.run(&[&optimize[..], &["--manifest", "out.obj"]].concat());
    assert!(
        run.err().contains("this is a mesh of the run"),
        "{}",
        run.err()
    );

    // With --force; but a list is only ever added to.
    let forced = [
        &optimize[..],
        &["--force", "--write-permutation", "notes.md"],
    ]
    .concat();
    assert_eq!(folder.run(&forced).code(), 0);
    assert!(folder.read("notes.md").starts_with(b"{\"schema\""));
    folder.write("notes.md", "mine");
    let listed = [&optimize[..], &["--force", "--manifest", "notes.md"]].concat();
    assert_eq!(folder.run(&listed).code(), 2);
    assert_eq!(folder.read("notes.md"), b"mine");
}

#[test]
fn no_job_writes_over_the_input_of_another() {
    let folder = Folder::new("other-input");
    fs::create_dir_all(folder.0.join("new")).unwrap();
    fs::create_dir_all(folder.0.join("old")).unwrap();
    folder.write("new/a.obj", strip());
    folder.write("old/a.obj", format!("{}f 1 2 4\n", strip()));
    let before = folder.read("old/a.obj");
    let run = folder.run(&["optimize", "new", "old/a.obj", "-o", "old"]);
    assert_eq!(run.code(), 2, "{}", run.err());
    assert_eq!(folder.read("old/a.obj"), before);
}

#[test]
fn a_dry_run_makes_no_list() {
    let folder = Folder::new("dry-list");
    folder.write("mesh.obj", strip());
    let run = folder.run(&["optimize", "mesh.obj", "--dry-run", "--manifest", "list"]);
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(!folder.0.join("list").exists());
}

#[test]
fn a_list_that_was_cut_off_is_continued() {
    let folder = Folder::new("cut-list");
    folder.write("mesh.obj", strip());
    for start in ["", "{", "{\"schema\":1,\"fi"] {
        folder.write("list", start);
        let run = folder.run(&[
            "optimize",
            "mesh.obj",
            "-o",
            "out.obj",
            "--manifest",
            "list",
        ]);
        assert_eq!(run.code(), 0, "{start:?}: {}", run.err());
        let list = String::from_utf8(folder.read("list")).unwrap();
        assert!(
            list.lines().last().unwrap().contains("\"status\":\"done\""),
            "{list}"
        );
    }
}

#[test]
fn a_read_only_file_is_replaced_with_force_only() {
    let folder = Folder::new("read-only");
    let path = folder.write("mesh.obj", strip());
    let before = folder.read("mesh.obj");
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();

    let run = folder.run(&["optimize", "mesh.obj", "--in-place"]);
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains(
            "mesh.obj: it is read-only, and is not replaced unasked. Give --force to replace it"
        ),
        "{}",
        run.err()
    );
    assert_eq!(folder.read("mesh.obj"), before);

    assert_eq!(
        folder
            .run(&["optimize", "mesh.obj", "--in-place", "--force"])
            .code(),
        0
    );
    assert_ne!(folder.read("mesh.obj"), before);
    assert!(fs::metadata(&path).unwrap().permissions().readonly());
}

#[test]
fn a_link_of_the_input_is_not_emptied() {
    let folder = Folder::new("hard-link");
    // Already in a good order, so that it is copied.
    folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(
        folder
            .run(&["optimize", "mesh.obj", "-o", "mesh.obj"])
            .code(),
        2
    );
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let gzip = {
        // Stored, not compressed: the program may not write it again.
        let bytes = text.as_bytes();
        let mut gzip = vec![0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3, 1];
        let length = u16::try_from(bytes.len()).unwrap();
        gzip.extend(length.to_le_bytes());
        gzip.extend((!length).to_le_bytes());
        gzip.extend(bytes);
        gzip.extend(crc32(bytes).to_le_bytes());
        gzip.extend(u32::from(length).to_le_bytes());
        gzip
    };
    let input = folder.write("mesh.obj.gz", &gzip);
    fs::hard_link(&input, folder.0.join("link.obj.gz")).unwrap();
    let run = folder.run(&["optimize", "mesh.obj.gz", "-o", "link.obj.gz"]);
    assert_eq!(folder.read("mesh.obj.gz"), gzip, "{}", run.err());
}

/// The check sum of gzip, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            let rest = if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
            sum >> 1 ^ rest
        })
    })
}

#[test]
fn two_scenes_with_one_buffer_name_keep_their_own() {
    let Some(data) = crate::data_folder("two scenes with one buffer name") else {
        return;
    };
    let data = data.join("reports/same-bin-name");
    let folder = Folder::new("same-bin-name");
    let source = |name: &str| data.join(name).join("scene.gltf").display().to_string();
    for name in ["one", "two"] {
        let output = format!("out/{name}.gltf");
        let run = folder.run(&["optimize", &source(name), "-o", &output]);
        assert_eq!(run.code(), 0, "{}", run.err());
        // It is said where a buffer has another name now.
        let is_told = run
            .err()
            .contains("its buffer scene.bin is now called two.bin");
        assert_eq!(is_told, name == "two", "{}", run.err());
    }
    for name in ["one", "two"] {
        let output = format!("out/{name}.gltf");
        let run = folder.run(&["compare", &source(name), &output]);
        assert_eq!(run.code(), 0, "{}", run.err());
    }
    let mut files: Vec<_> = fs::read_dir(folder.0.join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(files, ["one.gltf", "scene.bin", "two.bin", "two.gltf"]);
}
