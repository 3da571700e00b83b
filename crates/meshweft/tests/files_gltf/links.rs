//! One buffer under several names, and links that lead elsewhere.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Edit, FileErrorKind, WriteOptions};

use crate::Random;
use crate::output::{Folder, external, named_after, ordered};
use crate::reader::Reader;

#[test]
fn a_buffer_that_another_scene_names_through_a_link_is_not_replaced() {
    for alias in ["link.bin", "here/a.bin"] {
        let folder = Folder::new("alias");
        let source = external(&folder, "a.bin", "a.bin");
        symlink("a.bin", folder.0.join("link.bin")).unwrap();
        symlink(".", folder.0.join("here")).unwrap();
        let other = folder.0.join("other.gltf");
        let text = fs::read_to_string(&source).unwrap();
        fs::write(&other, text.replace("a.bin", alias)).unwrap();
        let before = Reader::of_file(&other, None);

        ordered(&source).write(&source).unwrap();
        let after = Reader::of_file(&other, None);
        assert!(before.buffers == after.buffers, "{alias}");
        assert_eq!(named_after(&folder, "scene").len(), 1);
        assert!(before.triangles() == Reader::of_file(&source, None).triangles());

        // Nor is one that was made here removed.
        let made = named_after(&folder, "scene").remove(0);
        fs::remove_file(folder.0.join("link.bin")).unwrap();
        symlink(&made, folder.0.join("link.bin")).unwrap();
        let name = alias.replace("a.bin", &made);
        fs::write(&other, text.replace("a.bin", &name)).unwrap();
        let before = Reader::of_file(&other, None);
        ordered(&source).write(&source).unwrap();
        assert!(
            before.buffers == Reader::of_file(&other, None).buffers,
            "{alias}"
        );
        assert_eq!(named_after(&folder, "scene").len(), 2);
    }
}

#[test]
fn a_file_with_two_names_in_one_scene_stays() {
    let folder = Folder::new("named-twice");
    let source = external(&folder, "a.bin", "a.bin");
    let text = fs::read_to_string(&source).unwrap();
    symlink("a.bin", folder.0.join("b.bin")).unwrap();
    let end = text.find("} ]").unwrap();
    let more = r#"},{"uri":"b.bin","byteLength":4} ]"#;
    fs::write(&source, [&text[..end], more, &text[end + 3..]].concat()).unwrap();
    let document = Document::open(&source, Limits::default()).unwrap();
    assert!(document.meshes().is_empty());
    let note = &document.notes()[0].text;
    assert!(
        note.contains("its buffer is named twice, through a link"),
        "{note}"
    );
}

#[test]
fn a_link_to_nothing_is_neither_followed_nor_replaced() {
    let (folder, elsewhere) = (Folder::new("dangling"), Folder::new("dangling-elsewhere"));
    let source = external(&folder, "a.bin", "a.bin");
    let document = ordered(&source);
    let out = folder.0.join("out");
    fs::create_dir_all(&out).unwrap();

    // The output.
    let target = elsewhere.0.join("new.gltf");
    symlink(&target, out.join("scene.gltf")).unwrap();
    let error = document
        .write(&out.join("scene.gltf"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("it is a link"), "{error}");
    assert!(!target.exists());
    assert!(fs::read_link(out.join("scene.gltf")).unwrap() == target);
    fs::remove_file(out.join("scene.gltf")).unwrap();

    // The name of a buffer: it gets another.
    symlink(elsewhere.0.join("new.bin"), out.join("a.bin")).unwrap();
    let written = document.write(&out.join("scene.gltf")).unwrap();
    assert_eq!(written.renamed, [("a.bin".into(), "scene.bin".to_owned())]);
    assert_eq!(elsewhere.files(), Vec::<String>::new());

    // The folder of a buffer.
    let inner = Folder::new("dangling-inner");
    let source = external(&inner, "sub/a.bin", "sub/a.bin");
    for target in [elsewhere.0.clone(), elsewhere.0.join("not-there")] {
        let out = Folder::new("dangling-out");
        symlink(target, out.0.join("sub")).unwrap();
        let error = ordered(&source)
            .write(&out.0.join("scene.gltf"))
            .unwrap_err();
        let text = error.to_string();
        assert!(text.contains("it is a link"), "{text}");
        assert_eq!(elsewhere.files(), Vec::<String>::new());
    }

    // One that is read.
    fs::remove_file(folder.0.join("a.bin")).unwrap();
    symlink("not-there", folder.0.join("a.bin")).unwrap();
    let error = Document::open(&folder.0.join("scene.gltf"), Limits::default()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("a.bin cannot be read (it is a link to not-there, which does not exist"),
        "{text}"
    );
}

#[test]
fn an_output_that_is_a_link_into_another_folder_is_refused() {
    let folder = Folder::new("link-below");
    let source = external(&folder, "a.bin", "a.bin");
    let below = folder.0.join("below");
    fs::create_dir_all(&below).unwrap();
    for name in ["scene.gltf", "a.bin"] {
        fs::copy(folder.0.join(name), below.join(name)).unwrap();
    }
    let before = Reader::of_file(&below.join("scene.gltf"), None);
    symlink("below/scene.gltf", folder.0.join("out.gltf")).unwrap();
    let error = ordered(&source)
        .write(&folder.0.join("out.gltf"))
        .unwrap_err();
    let text = error.to_string();
    assert!(text.contains("it is a link into another folder"), "{text}");
    let after = Reader::of_file(&below.join("scene.gltf"), None);
    assert!(before.buffers == after.buffers && before.json == after.json);

    // In its own folder a link is followed, and stays one.
    symlink("other.gltf", folder.0.join("link.gltf")).unwrap();
    fs::copy(&source, folder.0.join("other.gltf")).unwrap();
    ordered(&source).write(&folder.0.join("link.gltf")).unwrap();
    assert!(folder.0.join("link.gltf").is_symlink());
    let triangles = |path: &Path| Reader::of_file(path, None).triangles();
    assert!(triangles(&source) == triangles(&folder.0.join("other.gltf")));
}

#[test]
fn other_names_of_a_file_are_told() {
    let folder = Folder::new("hard-links");
    let source = external(&folder, "a.bin", "a.bin");
    fs::hard_link(folder.0.join("a.bin"), folder.0.join("b.bin")).unwrap();
    let before = fs::read(folder.0.join("b.bin")).unwrap();
    let written = ordered(&source).write(&source).unwrap();
    let note = &written.notes[0].text;
    assert!(
        note.ends_with("a.bin had 1 more name (hard links): what they name stays as it was"),
        "{note}"
    );
    assert_eq!(fs::read(folder.0.join("b.bin")).unwrap(), before);
    assert_ne!(fs::read(folder.0.join("a.bin")).unwrap(), before);
}

#[test]
fn read_only_buffers_are_replaced_if_that_is_allowed() {
    let folder = Folder::new("read-only-buffer");
    let source = external(&folder, "a.bin", "a.bin");
    let buffer = folder.0.join("a.bin");
    let before = fs::read(&buffer).unwrap();
    let mut permissions = fs::metadata(&buffer).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&buffer, permissions).unwrap();

    let error = ordered(&source).write(&source).unwrap_err();
    assert!(matches!(error.kind, FileErrorKind::ReadOnly), "{error}");
    assert_eq!(error.path, buffer);
    assert_eq!(fs::read(&buffer).unwrap(), before);

    let mut options = WriteOptions::default();
    options.replace_read_only = true;
    ordered(&source).write_with(&source, &options).unwrap();
    assert_ne!(fs::read(&buffer).unwrap(), before);
}

#[test]
fn equal_buffers_with_new_names_stay_two() {
    let folder = Folder::new("equal-buffers");
    let source = external(&folder, "a.bin", "a.bin");
    let text = fs::read_to_string(&source).unwrap();
    // Two scenes in one: each mesh with a buffer of its own, both of the same bytes.
    let mut json: serde_json::Value = serde_json::from_str(&text).unwrap();
    fs::copy(folder.0.join("a.bin"), folder.0.join("b.bin")).unwrap();
    for (list, member, by) in [
        ("buffers", "", 0),
        ("bufferViews", "buffer", 1),
        ("accessors", "bufferView", 2),
    ] {
        let list = json[list].as_array_mut().unwrap();
        let mut more = list.clone();
        for value in more.iter_mut().filter(|_| by > 0) {
            let number = value[member].as_u64().unwrap_or(0);
            value[member] = (number + by).into();
        }
        list.append(&mut more);
    }
    json["buffers"][1]["uri"] = "b.bin".into();
    let mut mesh = json["meshes"][0].clone();
    mesh["primitives"][0]["attributes"]["POSITION"] = 2.into();
    mesh["primitives"][0]["indices"] = 3.into();
    json["meshes"].as_array_mut().unwrap().push(mesh);
    fs::write(&source, json.to_string()).unwrap();

    let mut document = Document::open(&source, Limits::default()).unwrap();
    assert_eq!(document.meshes().len(), 2);
    let before = Reader::of_file(&source, None);
    for mesh in 0..2 {
        let faces = Random(7).face_order(document.meshes()[mesh].record_count());
        document.edit(Edit::order(mesh, &faces, None)).unwrap();
    }
    document.write(&source).unwrap();
    let after = Reader::of_file(&source, None);
    assert!(after.buffers[0] == after.buffers[1] && before.buffers[0] != after.buffers[0]);
    let uri = |number: usize| after.json["buffers"][number]["uri"].as_str().unwrap();
    assert_ne!(uri(0), uri(1));
    assert!(before.triangles() == after.triangles());

    // They are found again, and nothing changes.
    let files = folder.files();
    let again = Document::open(&source, Limits::default()).unwrap();
    assert_eq!(again.meshes().len(), 2);
    again.write(&source).unwrap();
    assert_eq!(folder.files(), files);
}
