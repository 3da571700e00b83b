//! Writing a glTF loses nothing: neither its own buffers nor files of others.

use std::fs;
use std::path::PathBuf;

use meshweft::Limits;
use meshweft::files::Document;
use serde_json::{Value, json};

use crate::builder::glb;
use crate::output::{Folder, builder, external, named_after, ordered, text};
use crate::random_orders;
use crate::reader::Reader;

/// A glTF whose vertices and faces are in two buffers.
fn two_buffers(folder: &Folder, name: &str) -> PathBuf {
    let mut builder = builder();
    builder.views[1]["buffer"] = json!(1);
    let length = builder.binary.len();
    let buffers = format!(
        "[{{\"uri\":\"a.bin\",\"byteLength\":{length}}},{{\"uri\":\"b.bin\",\"byteLength\":{length}}}]"
    );
    let source = folder.0.join(name);
    fs::create_dir_all(source.parent().unwrap()).unwrap();
    fs::write(&source, text(&builder, &buffers)).unwrap();
    for buffer in ["a.bin", "b.bin"] {
        fs::write(source.with_file_name(buffer), &builder.binary).unwrap();
    }
    source
}

#[test]
fn two_changed_buffers_get_new_names_and_the_text_is_the_commit() {
    let folder = Folder::new("two-in-place");
    let source = two_buffers(&folder, "scene.gltf");
    let before = Reader::of_file(&source, None);
    let written = ordered(&source).write(&source).unwrap();
    let names = named_after(&folder, "scene");
    assert_eq!(names.len(), 2);
    // The old ones are the user's: nobody knows who else reads them.
    let with = |names: &[String]| {
        let old = ["a.bin", "b.bin", "scene.gltf"].map(str::to_owned);
        let mut files = [&old[..], names].concat();
        files.sort();
        files
    };
    assert_eq!(folder.files(), with(&names));
    assert_eq!(written.files.last().unwrap(), &source);
    assert_eq!(written.files.len(), 3);
    let after = Reader::of_file(&source, None);
    assert!(before.triangles() == after.triangles() && before.buffers != after.buffers);

    // The same content has the same names: nothing changes any more.
    let again = Document::open(&source, Limits::default()).unwrap();
    let text = fs::read(&source).unwrap();
    again.write(&source).unwrap();
    assert_eq!(named_after(&folder, "scene"), names);
    assert_eq!(fs::read(&source).unwrap(), text);

    // Another order gives others, and those that were made before go.
    ordered(&source).write(&source).unwrap();
    let others = named_after(&folder, "scene");
    assert_eq!(folder.files(), with(&others));
    assert!(others.iter().all(|name| !names.contains(name)));

    // Unless somebody may need them: who names them, or cannot be read.
    for text in [fs::read(&source).unwrap(), b"{,".to_vec()] {
        let other = folder.0.join("other.gltf");
        fs::write(&other, text).unwrap();
        let names = named_after(&folder, "scene");
        ordered(&source).write(&source).unwrap();
        assert!(names.iter().all(|name| folder.0.join(name).exists()));
        fs::remove_file(other).unwrap();
    }
    assert!(before.triangles() == Reader::of_file(&source, None).triangles());
}

#[test]
fn old_buffers_stay_where_another_scene_names_them() {
    let folder = Folder::new("two-and-another");
    let source = two_buffers(&folder, "scene.gltf");
    let other = folder.0.join("other.gltf");
    fs::copy(&source, &other).unwrap();
    let before = Reader::of_file(&other, None);
    ordered(&source).write(&source).unwrap();
    assert_eq!(named_after(&folder, "scene").len(), 2);
    assert!(before.buffers == Reader::of_file(&other, None).buffers);
}

#[test]
fn a_file_of_another_document_is_never_replaced() {
    let folder = Folder::new("foreign");
    let sources = ["one", "two"].map(|name| {
        let inner = Folder(folder.0.join(name));
        fs::create_dir_all(&inner.0).unwrap();
        let source = external(&inner, "scene.bin", "scene.bin");
        std::mem::forget(inner);
        source
    });
    let out = folder.0.join("out");
    fs::create_dir_all(&out).unwrap();
    let before = Reader::of_file(&sources[0], None);
    for (seed, (name, source)) in (1..).zip(["one.gltf", "two.gltf"].iter().zip(&sources)) {
        let mut document = Document::open(source, Limits::default()).unwrap();
        random_orders(&mut document, seed);
        document.write(&out.join(name)).unwrap();
    }
    let files = || {
        let names = fs::read_dir(&out).unwrap();
        let mut names: Vec<String> = names
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    assert_eq!(files(), ["one.gltf", "scene.bin", "two.bin", "two.gltf"]);
    let after = [0, 1].map(|i| Reader::of_file(&out.join(["one.gltf", "two.gltf"][i]), None));
    assert!(
        after
            .iter()
            .all(|after| before.triangles() == after.triangles())
    );
    assert!(after[0].buffers != after[1].buffers);

    // Written again they keep their names; with other content the name says what is in it.
    for (seed, count) in [(2, 4), (3, 5)] {
        let mut document = Document::open(&sources[1], Limits::default()).unwrap();
        random_orders(&mut document, seed);
        document.write(&out.join("two.gltf")).unwrap();
        assert_eq!(files().len(), count, "{:?}", files());
        let two = Reader::of_file(&out.join("two.gltf"), None);
        assert!(before.triangles() == two.triangles());
        assert!(after[0].buffers == Reader::of_file(&out.join("one.gltf"), None).buffers);
    }

    // A file that no document names is not replaced either.
    fs::write(out.join("three.bin"), "mine").unwrap();
    fs::write(out.join("scene.bin"), "mine").unwrap();
    ordered(&sources[0]).write(&out.join("three.gltf")).unwrap();
    assert_eq!(fs::read(out.join("three.bin")).unwrap(), b"mine");
    assert_eq!(fs::read(out.join("scene.bin")).unwrap(), b"mine");
    let three = Reader::of_file(&out.join("three.gltf"), None);
    assert!(before.triangles() == three.triangles());
}

#[test]
fn a_glb_says_how_long_it_is_when_a_buffer_has_another_name() {
    for has_chunk in [false, true] {
        let folder = Folder::new(&format!("glb-renamed-{has_chunk}"));
        let builder = builder();
        let mut json: Value =
            serde_json::from_str(&text(&builder, r#"[{"uri": "s.bin", "byteLength": 0}]"#))
                .unwrap();
        json["buffers"][0]["byteLength"] = builder.binary.len().into();
        if has_chunk {
            let more = json!({"byteLength": 4});
            let buffers = json["buffers"].as_array_mut().unwrap();
            buffers.insert(0, more);
            for view in json["bufferViews"].as_array_mut().unwrap() {
                view["buffer"] = 1.into();
            }
        }
        fs::write(folder.0.join("s.bin"), &builder.binary).unwrap();
        let source = folder.0.join("a.glb");
        let chunk = has_chunk.then_some(&[1, 2, 3, 4][..]);
        fs::write(&source, glb(&json.to_string(), chunk)).unwrap();

        // Names of other lengths than the old one.
        let out = folder.0.join("out");
        fs::create_dir_all(&out).unwrap();
        fs::write(out.join("s.bin"), "mine").unwrap();
        for name in ["b.glb", "much longer.glb"] {
            let target = out.join(name);
            let written = Document::open(&source, Limits::default()).unwrap();
            let written = written.write(&target).unwrap();
            assert_eq!(written.renamed.len(), 1);
            let again = Document::open(&target, Limits::default()).unwrap();
            let [before, after] = [&source, &target].map(|path| Reader::of_file(path, None));
            assert!(before.buffers == after.buffers && before.triangles() == after.triangles());
            assert_eq!(again.notes().len(), 1, "{:?}", again.notes());
        }
    }
}

#[test]
fn a_buffer_that_another_scene_names_is_not_replaced() {
    let folder = Folder::new("shared-output");
    let source = external(&folder, "scene.bin", "scene.bin");
    let out = folder.0.join("out");
    fs::create_dir_all(&out).unwrap();
    for name in ["one.gltf", "two.gltf"] {
        // The same content: they share a buffer.
        ordered(&source).write(&out.join(name)).unwrap();
    }
    let two = Reader::of_file(&out.join("two.gltf"), None);
    let mut document = Document::open(&source, Limits::default()).unwrap();
    random_orders(&mut document, 9);
    document.write(&out.join("one.gltf")).unwrap();
    assert!(two.buffers == Reader::of_file(&out.join("two.gltf"), None).buffers);
    let one = Reader::of_file(&out.join("one.gltf"), None);
    assert!(one.triangles() == two.triangles() && one.buffers != two.buffers);
}

#[test]
fn the_buffer_of_the_source_stays_whatever_the_output_named() {
    let folder = Folder::new("names-source");
    let source = external(&folder, "scene.bin", "scene.bin");
    let before = Reader::of_file(&source, None);

    // An old output that reads the source's own buffer.
    let elsewhere = folder.0.join("up.gltf");
    let inner = folder.0.join("inner");
    fs::create_dir_all(&inner).unwrap();
    let moved = inner.join("scene.gltf");
    fs::rename(&source, &moved).unwrap();
    fs::rename(folder.0.join("scene.bin"), inner.join("scene.bin")).unwrap();
    let text = fs::read_to_string(&moved).unwrap();
    fs::write(&elsewhere, text.replace("scene.bin", "inner/scene.bin")).unwrap();
    ordered(&moved).write(&elsewhere).unwrap();
    assert!(before.buffers == Reader::of_file(&moved, None).buffers);
    assert!(before.triangles() == Reader::of_file(&elsewhere, None).triangles());

    // An output that has the name of the buffer.
    let named = inner.join("x.gltf");
    fs::copy(inner.join("scene.bin"), &named).unwrap();
    let other = inner.join("other.gltf");
    fs::write(&other, text.replace("scene.bin", "x.gltf")).unwrap();
    let error = ordered(&other).write(&named).unwrap_err().to_string();
    assert!(
        error.contains("is the name of a buffer of the file"),
        "{error}"
    );
    assert!(before.buffers == Reader::of_file(&other, None).buffers);
}

#[test]
fn one_changed_buffer_is_one_rename() {
    let folder = Folder::new("one-rename");
    let source = external(&folder, "a.bin", "a.bin");
    let written = || fs::metadata(&source).unwrap().modified().unwrap();
    let time = std::time::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    let file = fs::File::options().write(true).open(&source).unwrap();
    file.set_modified(time).unwrap();
    ordered(&source).write(&source).unwrap();
    // The text does not change, and is not written.
    assert_eq!(written(), time);
    assert_eq!(folder.files(), ["a.bin", "scene.gltf"]);
}

#[cfg(unix)]
#[test]
fn links_are_followed_within_the_folder_only() {
    use std::os::unix::fs::symlink;

    // A buffer elsewhere, behind a link.
    let (folder, elsewhere) = (Folder::new("links"), Folder::new("links-elsewhere"));
    let source = external(&folder, "a.bin", "a.bin");
    let before = fs::read(folder.0.join("a.bin")).unwrap();
    let foreign = elsewhere.0.join("a.bin");
    fs::rename(folder.0.join("a.bin"), &foreign).unwrap();
    symlink(&foreign, folder.0.join("a.bin")).unwrap();
    let error = Document::open(&source, Limits::default()).unwrap_err();
    assert!(
        error.to_string().contains("a link out of the folder"),
        "{error}"
    );
    assert_eq!(fs::read(&foreign).unwrap(), before);

    // An output elsewhere, behind a link.
    let inside = external(&elsewhere, "a.bin", "a.bin");
    symlink(&inside, folder.0.join("out.gltf")).unwrap();
    let text = fs::read(&inside).unwrap();
    let error = ordered(&inside)
        .write(&folder.0.join("out.gltf"))
        .unwrap_err();
    assert!(
        error.to_string().contains("a link out of the folder"),
        "{error}"
    );
    assert_eq!(fs::read(&inside).unwrap(), text);

    // Links that stay are followed, and stay links.
    let folder = Folder::new("links-inside");
    let source = external(&folder, "a.bin", "b.bin");
    symlink("b.bin", folder.0.join("a.bin")).unwrap();
    let triangles = Reader::of_file(&source, None).triangles();
    ordered(&source).write(&source).unwrap();
    assert!(
        fs::symlink_metadata(folder.0.join("a.bin"))
            .unwrap()
            .is_symlink()
    );
    assert_ne!(fs::read(folder.0.join("b.bin")).unwrap(), before);
    assert!(triangles == Reader::of_file(&source, None).triangles());

    // A device is not a file.
    let folder = Folder::new("links-device");
    let source = external(&folder, "a.bin", "a.bin");
    fs::remove_file(folder.0.join("a.bin")).unwrap();
    let status = std::process::Command::new("mkfifo")
        .arg(folder.0.join("a.bin"))
        .status();
    assert!(status.unwrap().success());
    let error = Document::open(&source, Limits::default()).unwrap_err();
    assert!(error.to_string().contains("it is not a file"), "{error}");
}

#[test]
fn a_file_that_somebody_has_changed_since_is_not_replaced() {
    for changed in ["scene.gltf", "a.bin"] {
        let folder = Folder::new("changed-since");
        let source = external(&folder, "a.bin", "a.bin");
        let document = ordered(&source);
        let path = folder.0.join(changed);
        let mut bytes = fs::read(&path).unwrap();
        bytes.extend_from_slice(b"  ");
        fs::write(&path, &bytes).unwrap();
        let error = document.write(&source).unwrap_err();
        assert_eq!(error.path, path);
        assert!(
            error
                .to_string()
                .contains("it has changed since it was read"),
            "{error}"
        );
        assert_eq!(fs::read(&path).unwrap(), bytes);

        // Elsewhere it does not matter, and what it has written itself it may replace.
        let output = folder.0.join("out/scene.gltf");
        document.write(&output).unwrap();
        let mut again = ordered(&output);
        for seed in 5..8 {
            random_orders(&mut again, seed);
            again.write(&output).unwrap();
        }
        assert!(
            Reader::of_file(&output, None).triangles()
                == Reader::of_file(&source, None).triangles()
        );
    }
}
