//! Which buffers other scenes name is found near a scene, and no more is read for it than a limit.

use std::fs;
use std::io::Write;

use meshweft::files::shared_buffers;

use crate::output::{Folder, external, named_after, ordered};
use crate::reader::Reader;

#[test]
fn buffers_are_shared_across_folders() {
    let folder = Folder::new("shared");
    let inner = Folder(folder.0.join("inner"));
    fs::create_dir_all(&inner.0).unwrap();
    let source = external(&inner, "data/sub/a.bin", "data/sub/a.bin");
    let text = fs::read_to_string(&source).unwrap();
    let shared = || shared_buffers([source.as_path()]);
    assert!(shared().is_empty());
    let buffer = source.with_file_name("data/sub/a.bin");
    for (place, uri) in [
        ("other.gltf", "data/sub/a.bin"),
        ("data/other.gltf", "sub/a.bin"),
        ("data/sub/other.gltf", "./a.bin"),
        ("../other.gltf", "inner/data/sub/a.bin"),
        ("lod/other.gltf", "../data/sub/a.bin"),
    ] {
        let other = inner.0.join(place);
        fs::create_dir_all(other.parent().unwrap()).unwrap();
        fs::write(&other, text.replace("data/sub/a.bin", uri)).unwrap();
        assert_eq!(shared(), std::slice::from_ref(&buffer), "{place}");
        // Both of a run are told.
        let both = shared_buffers([source.as_path(), &other]);
        assert!(both.contains(&buffer), "{place}");

        // Written in place, the other keeps what it reads.
        let before = Reader::of_file(&other, None);
        let bytes = fs::read(&source).unwrap();
        ordered(&source).write(&source).unwrap();
        assert!(
            before.buffers == Reader::of_file(&other, None).buffers,
            "{place}"
        );
        for made in named_after(&inner, "scene") {
            fs::remove_file(inner.0.join(made)).unwrap();
        }
        fs::write(&source, bytes).unwrap();
        fs::remove_file(&other).unwrap();
    }
    // Files elsewhere, and files that are no glTF, do not matter.
    fs::write(inner.0.join("notes.txt"), &text).unwrap();
    fs::create_dir_all(inner.0.join("aside.gltf")).unwrap();
    assert!(shared().is_empty());
    std::mem::forget(inner);
}

#[test]
fn what_cannot_be_told_is_on_the_safe_side() {
    let spaces = vec![b' '; 1 << 20];
    for case in ["no JSON", "too long", "bomb", "cut"] {
        let folder = Folder::new("untold");
        let source = external(&folder, "a.bin", "a.bin");
        let before = Reader::of_file(&source, None);
        match case {
            "no JSON" => fs::write(folder.0.join("other.gltf"), "{,").unwrap(),
            "cut" => fs::write(folder.0.join("other.glb"), b"glTF\x02\0\0\0").unwrap(),
            "too long" => {
                let file = fs::File::create(folder.0.join("other.gltf")).unwrap();
                file.set_len(1 << 40).unwrap();
            }
            _ => {
                let file = fs::File::create(folder.0.join("other.gltf.gz")).unwrap();
                let fast = flate2::Compression::fast();
                let mut file = flate2::write::GzEncoder::new(file, fast);
                (0..40).for_each(|_| file.write_all(&spaces).unwrap());
                file.write_all(b"{}").unwrap();
                file.finish().unwrap();
            }
        }
        // A run is not kept from ordering, but it gets a buffer of its own.
        assert!(shared_buffers([source.as_path()]).is_empty());
        let written = ordered(&source).write(&source).unwrap();
        assert!(
            before.buffers == [Some(fs::read(folder.0.join("a.bin")).unwrap())],
            "{case}"
        );
        assert_eq!(named_after(&folder, "scene").len(), 1, "{case}");
        let note = &written.notes[0].text;
        assert!(
            note.starts_with("whether ")
                && note.contains("/other.gl")
                && note.contains("cannot be told"),
            "{note}"
        );
        assert!(before.triangles() == Reader::of_file(&source, None).triangles());
    }
}

#[test]
fn of_a_large_glb_the_json_is_read() {
    let folder = Folder::new("large-glb");
    let source = external(&folder, "a.bin", "a.bin");
    let json = br#"{"buffers":[{"uri":"a.bin"}]}   "#;
    let mut bytes = b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec();
    bytes.extend(u32::try_from(json.len()).unwrap().to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json);
    fs::write(folder.0.join("other.glb"), bytes).unwrap();
    let file = fs::File::options()
        .append(true)
        .open(folder.0.join("other.glb"));
    file.unwrap().set_len(1 << 40).unwrap();
    assert_eq!(shared_buffers([source.as_path()]), [folder.0.join("a.bin")]);
}
