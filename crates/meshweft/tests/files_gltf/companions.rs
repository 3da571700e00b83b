//! Files that a glTF names beside its buffers come along to another folder, and replace nothing.

use std::fs;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Outputs, WriteOptions};

use crate::output::{Folder, external, ordered};
use crate::reader::Reader;

/// A scene of a folder of its own that names these URIs, in images and elsewhere.
fn scene(folder: &Folder) -> PathBuf {
    let source = external(folder, "a.bin", "a.bin");
    let text = fs::read_to_string(&source).unwrap();
    let named = r#""images":[{"uri":"maps/my%20red.png"},{"uri":"./blue.png"},{"uri":"blue.png"},
            {"uri":"data:image/png;base64,AAAA"},{"uri":"https://host/web.png"},{"bufferView":0},
            {"uri":"../up.png"},{"uri":"/etc/passwd"},{"uri":"lost/1.png"},{"uri":"lost/2.png"}],
        "extensionsUsed":["EXT_structural_metadata","KHR_audio"],
        "extensions":{"EXT_structural_metadata":{"schemaUri":"schema.json"},
            "KHR_audio":{"audio":[{"uri":"beep.mp3"}]}},
        "extras":{"uri":"notes.txt"},"asset""#;
    fs::write(&source, text.replacen("\"asset\"", named, 1)).unwrap();
    for (name, bytes) in [
        ("maps/my red.png", "red"),
        ("blue.png", "blue"),
        ("schema.json", "{}"),
        ("beep.mp3", "beep"),
        ("notes.txt", "private"),
    ] {
        let path = folder.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    source
}

const NAMED: [&str; 4] = ["beep.mp3", "blue.png", "maps/my red.png", "schema.json"];

fn notes(written: &meshweft::files::Written) -> Vec<String> {
    let notes = written.notes.iter();
    notes
        .map(|note| format!("{} (+{})", note.text, note.more))
        .collect()
}

#[test]
fn what_a_scene_names_comes_along() {
    let (folder, out) = (Folder::new("companions"), Folder::new("companions-out"));
    let source = scene(&folder);
    let document = ordered(&source);
    let names = document.companions();
    let names: Vec<&str> = names.iter().map(|path| path.to_str().unwrap()).collect();
    assert_eq!(names[..2], NAMED[..2]);
    assert_eq!(names[2..4], ["lost/1.png", "lost/2.png"]);
    assert_eq!(names[4..], NAMED[2..]);
    let refused: Vec<_> = document
        .notes()
        .iter()
        .map(|n| (n.text.as_str(), n.more))
        .collect();
    assert!(
        refused.iter().any(|(text, more)| *more == 1
            && text.starts_with("not copied to another folder: \"../up.png\" leaves the folder")),
        "{refused:?}"
    );

    let target = out.0.join("new/scene.gltf");
    let written = document.write(&target).unwrap();
    let copied: Vec<_> = NAMED
        .iter()
        .map(|name| target.with_file_name(name))
        .collect();
    assert_eq!(written.copied, copied);
    assert_eq!(
        notes(&written),
        ["lost/1.png is not copied: it does not exist (+1)"]
    );
    let inner = Folder(out.0.join("new"));
    assert_eq!(
        inner.files(),
        [
            "a.bin",
            "beep.mp3",
            "blue.png",
            "maps/my red.png",
            "scene.gltf",
            "schema.json"
        ]
    );
    for path in &written.copied {
        let relative = path.strip_prefix(&inner.0).unwrap();
        assert_eq!(
            fs::read(path).unwrap(),
            fs::read(folder.0.join(relative)).unwrap()
        );
    }
    let triangles = |path: &Path| Reader::of_file(path, None).triangles();
    assert!(triangles(&source) == triangles(&target));

    // Once more they are there; in its own folder there is nothing to do.
    let again = document.write(&target).unwrap();
    assert_eq!(again, written);
    let before = folder.files();
    let here = document.write(&source).unwrap();
    assert!(here.copied.is_empty() && here.notes.is_empty());
    assert_eq!(folder.files(), before);
    std::mem::forget(inner);
}

#[test]
fn a_copy_replaces_nothing() {
    let (folder, out) = (
        Folder::new("companions-taken"),
        Folder::new("companions-taken-out"),
    );
    let document = ordered(&scene(&folder));
    fs::write(out.0.join("blue.png"), "mine").unwrap();
    fs::write(out.0.join("beep.mp3"), "beep").unwrap();
    fs::create_dir_all(out.0.join("schema.json")).unwrap();
    let red = out.0.join("maps/my red.png");
    let outputs = Outputs::of([(red.as_path(), red.as_path())]);
    let mut options = WriteOptions::default();
    options.outputs = Some(&outputs);
    let written = document
        .write_with(&out.0.join("scene.gltf"), &options)
        .unwrap();
    assert_eq!(written.copied, [out.0.join("beep.mp3")]);
    assert_eq!(
        notes(&written),
        [
            "blue.png is not copied: another file of this name is there (+1)",
            "maps/my red.png is not copied: another output of this run has its name (+0)",
            "lost/1.png is not copied: it does not exist (+1)",
        ]
    );
    assert_eq!(out.files(), ["a.bin", "beep.mp3", "blue.png", "scene.gltf"]);
    assert_eq!(fs::read(out.0.join("blue.png")).unwrap(), b"mine");

    // Not at all, where that is not wanted.
    let other = Folder::new("companions-none");
    options.copy_companions = false;
    let written = document
        .write_with(&other.0.join("scene.gltf"), &options)
        .unwrap();
    assert!(written.copied.is_empty() && written.notes.is_empty());
    assert_eq!(other.files(), ["a.bin", "scene.gltf"]);
}

#[test]
fn a_companion_with_the_name_of_the_output_or_of_a_buffer_harms_neither() {
    let (folder, out) = (
        Folder::new("companions-name"),
        Folder::new("companions-name-out"),
    );
    let source = scene(&folder);
    let text = fs::read_to_string(&source).unwrap();
    let text = text
        .replace("./blue.png", "a.bin")
        .replace("beep.mp3", "out.gltf");
    fs::write(&source, text).unwrap();
    fs::write(folder.0.join("out.gltf"), "mine").unwrap();
    let before = fs::read(folder.0.join("a.bin")).unwrap();
    let target = out.0.join("out.gltf");
    let written = ordered(&source).write(&target).unwrap();
    assert!(
        notes(&written)[0].starts_with("out.gltf is not copied: another output of this run"),
        "{:?}",
        notes(&written)
    );
    // The image has the bytes that it had; the buffer has another name.
    assert_eq!(fs::read(out.0.join("a.bin")).unwrap(), before);
    assert_eq!(written.renamed, [("a.bin".into(), "out.bin".to_owned())]);
    let triangles = |path: &Path| Reader::of_file(path, None).triangles();
    assert!(triangles(&source) == triangles(&target));
}

#[test]
fn a_document_from_memory_copies_nothing() {
    let folder = Folder::new("companions-memory");
    let source = scene(&folder);
    let out = Folder::new("companions-memory-out");
    let glb = meshweft::files::Format::Gltf;
    let (bytes, name) = (fs::read(&source).unwrap(), &source);
    let files = [(
        PathBuf::from("a.bin"),
        fs::read(folder.0.join("a.bin")).unwrap(),
    )]
    .into();
    let beside = meshweft::files::Surroundings::Memory(&files);
    let document = Document::from_bytes_in(bytes, glb, name, beside, Limits::default()).unwrap();
    let written = document.write(&out.0.join("scene.gltf")).unwrap();
    assert!(written.copied.is_empty());
    assert_eq!(out.files(), ["a.bin", "scene.gltf"]);
    assert_eq!(document.companions().len(), 6);
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_not_copied() {
    use std::os::unix::fs::symlink;

    let (folder, out) = (
        Folder::new("companions-links"),
        Folder::new("companions-links-out"),
    );
    let source = scene(&folder);
    for name in ["blue.png", "beep.mp3", "schema.json"] {
        fs::remove_file(folder.0.join(name)).unwrap();
    }
    symlink("/etc/hostname", folder.0.join("blue.png")).unwrap();
    symlink("nowhere", folder.0.join("beep.mp3")).unwrap();
    let status = std::process::Command::new("mkfifo")
        .arg(folder.0.join("schema.json"))
        .status();
    assert!(status.unwrap().success());
    // A folder of the output that is elsewhere.
    let elsewhere = Folder::new("companions-links-elsewhere");
    symlink(&elsewhere.0, out.0.join("maps")).unwrap();

    let written = ordered(&source).write(&out.0.join("scene.gltf")).unwrap();
    assert_eq!(written.copied, Vec::<PathBuf>::new());
    let all = notes(&written).join("\n");
    for part in [
        "blue.png is not copied: it is a link out of the folder, to /",
        "beep.mp3 is not copied: it is a link to nowhere, which does not exist",
        "schema.json is not copied: it is not a file",
        "maps/my red.png is not copied: at its place, it is a link out of the folder",
    ] {
        assert!(all.contains(part), "{part}: {all}");
    }
    assert_eq!(elsewhere.files(), Vec::<String>::new());
}
