//! Files beside a `.gltf` from a map in memory: the same as from a folder of the disk.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use meshweft::files::{Document, FileError, FileErrorKind, Format, ReadOptions, Surroundings};
use meshweft::{Limits, operations};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U16, faces};
use crate::data::scenes_below;
use crate::data_folder;
use crate::output::Folder;
use crate::random_orders;

/// The files of a folder and below, by their paths from there.
type Files = BTreeMap<PathBuf, Vec<u8>>;

const NAME: &str = "scene.gltf";

fn files_below(folder: &Path) -> Files {
    let mut files = Files::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(below) = folders.pop() {
        for entry in fs::read_dir(below).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => {
                    let relative = path.strip_prefix(folder).unwrap().to_owned();
                    files.insert(relative, fs::read(path).unwrap());
                }
            }
        }
    }
    files
}

fn write_below(folder: &Path, files: &Files) {
    for (relative, bytes) in files {
        let path = folder.join(relative);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

fn in_memory(
    files: &Files,
    name: &Path,
    options: impl Into<ReadOptions>,
) -> Result<Document, FileError> {
    let beside = Surroundings::Memory(files);
    Document::from_bytes_in(files[name].clone(), Format::Gltf, name, beside, options)
}

fn read(files: &Files) -> Document {
    in_memory(files, Path::new(NAME), Limits::default()).unwrap()
}

fn as_map(document: &Document, name: &str) -> Files {
    document
        .to_bytes(Path::new(name))
        .unwrap()
        .into_iter()
        .collect()
}

/// A scene of two buffers beside it and one in it: positions, indices, positions again.
fn scene() -> Files {
    let (mut positions, mut indices) = (Builder::default(), Builder::default());
    positions.data(F32, "VEC3", 20);
    indices.indices(U16, &faces(12, 20));
    let (positions, indices) = (positions.binary, indices.binary);

    let data = "data:application/octet-stream;base64,";
    let zeros = "A".repeat(20 * 12 * 4 / 3);
    let uris = [
        "buffers/a%20b.bin".into(),
        "./i.bin".into(),
        data.to_owned() + &zeros,
    ];
    let lengths = [positions.len(), indices.len(), 240];
    let buffers = uris.iter().zip(lengths);
    let buffers: Value = buffers
        .map(|(uri, length)| json!({ "uri": uri, "byteLength": length }))
        .collect();
    let views: Value = (0..3)
        .map(|buffer| json!({ "buffer": buffer, "byteLength": lengths[buffer] }))
        .collect();
    let vertices =
        |view| json!({ "bufferView": view, "componentType": F32, "type": "VEC3", "count": 20 });
    let primitive = json!({ "attributes": { "POSITION": 0, "NORMAL": 2 }, "indices": 1 });
    let json = json!({
        "asset": { "version": "2.0" },
        "buffers": buffers,
        "bufferViews": views,
        "accessors": [
            vertices(0),
            { "bufferView": 1, "componentType": U16, "type": "SCALAR", "count": 36 },
            vertices(2),
        ],
        "meshes": [{ "primitives": [primitive] }],
    });
    Files::from([
        (NAME.into(), json.to_string().into_bytes()),
        ("buffers/a b.bin".into(), positions),
        ("i.bin".into(), indices),
    ])
}

/// The same from a map and from a folder, whatever is done with it.
fn assert_same_from_both(files: &Files, name: &str, folder: &Folder) {
    let source = folder.0.join("source");
    write_below(&source, files);
    let path = source.join(name);
    let mut on_disk = Document::open(&path, Limits::default()).unwrap();
    let mut in_memory = in_memory(files, Path::new(name), Limits::default()).unwrap();
    assert_eq!(on_disk.meshes(), in_memory.meshes(), "{name}");
    assert_eq!(on_disk.notes(), in_memory.notes(), "{name}");
    assert_eq!(on_disk.source_bytes(), in_memory.source_bytes(), "{name}");

    random_orders(&mut on_disk, 5);
    random_orders(&mut in_memory, 5);
    assert_eq!(on_disk.meshes(), in_memory.meshes(), "{name}");

    // Under the same name elsewhere, and so written over the source.
    let files_of = |document: &Document, name: &Path| document.to_bytes(name).unwrap();
    let new = files_of(&in_memory, Path::new(name));
    assert!(new == files_of(&on_disk, &path), "{name}");
    assert_eq!(new.last().unwrap().0, Path::new(name));
    assert_eq!(new.last().unwrap().1, in_memory.to_main_bytes().unwrap());
    let new: Files = new.into_iter().collect();
    for (document, output) in [(&on_disk, "from disk"), (&in_memory, "from memory")] {
        let output = folder.0.join(output);
        fs::create_dir_all(&output).unwrap();
        document.write(&output.join(name)).unwrap();
        assert!(new == files_below(&output), "{name}: {}", output.display());
    }
    let again = self::in_memory(&new, Path::new(name), Limits::default()).unwrap();
    assert_eq!(again.meshes(), in_memory.meshes(), "{name}");

    // Under another name beside the source, whose files stay.
    let other = as_map(&in_memory, "other.gltf");
    assert!(
        other
            .keys()
            .all(|path| !files.contains_key(path) || other[path] == files[path])
    );
    on_disk.write(&source.join("other.gltf")).unwrap();
    let mut beside = files.clone();
    beside.extend(other);
    assert!(beside == files_below(&source), "{name}");
    let again = self::in_memory(&beside, Path::new("other.gltf"), Limits::default()).unwrap();
    assert_eq!(again.meshes(), in_memory.meshes(), "{name}");
}

#[test]
fn a_scene_is_the_same_from_a_map_and_from_a_folder() {
    let (files, folder) = (scene(), Folder::new("map-and-folder"));
    assert_same_from_both(&files, NAME, &folder);

    let mut document = read(&files);
    random_orders(&mut document, 5);
    let new = as_map(&document, NAME);
    assert_eq!(new.len(), 3);
    assert!(
        new.iter()
            .all(|(path, bytes)| *bytes != files[path] || path == Path::new(NAME))
    );
    let names = as_map(&document, "other.gltf");
    let names: Vec<_> = names.keys().map(|path| path.to_str().unwrap()).collect();
    let [first, second, "other.gltf"] = names[..] else {
        panic!("{names:?}");
    };
    for name in [first, second] {
        assert!(
            name.starts_with("other.") && name.ends_with(".bin") && name.len() == 18,
            "{name}"
        );
    }
}

#[test]
fn real_scenes_are_the_same_from_a_map_and_from_a_folder() {
    let Some(data) = data_folder::folder() else {
        return;
    };
    let mut count = 0;
    for path in scenes_below(&data.join("gltf")) {
        if Format::of_path(&path) != Some(Format::Gltf) {
            continue;
        }
        let name = path.file_name().unwrap().to_str().unwrap();
        let mut files = Files::from([(name.into(), fs::read(&path).unwrap())]);
        for buffer in meshweft::files::external_buffers(&path, &Limits::default()).unwrap() {
            let relative = buffer.strip_prefix(path.parent().unwrap()).unwrap();
            files.insert(relative.to_owned(), fs::read(&buffer).unwrap());
        }
        assert_same_from_both(&files, name, &Folder::new("real-map-and-folder"));
        count += 1;
    }
    assert!(count > 0);
    println!("{count} scenes");
}

#[test]
fn every_file_is_given_back_unchanged_ones_too() {
    let files = scene();
    let document = read(&files);
    assert!(as_map(&document, NAME) == files);
    assert!(as_map(&document, "a folder/scene.gltf") == files);
    let sizes = files.values().map(|bytes| bytes.len() as u64);
    assert_eq!(document.source_bytes(), sizes.sum::<u64>());

    // Beside the source nothing needs a new name.
    let mut other = files.clone();
    let main = other.remove(Path::new(NAME)).unwrap();
    other.insert("other.gltf".into(), main);
    assert!(as_map(&document, "other.gltf") == other);
}

#[test]
fn a_missing_file_is_the_same_fault_everywhere() {
    let mut files = scene();
    files.remove(Path::new("i.bin"));
    let folder = Folder::new("missing");
    write_below(&folder.0, &files);
    let name = Path::new(NAME);
    let main = || files[name].clone();
    let errors = [
        (
            Document::open(&folder.0.join(NAME), Limits::default()),
            std::io::Error::from_raw_os_error(2).to_string(),
        ),
        (
            in_memory(&files, name, Limits::default()),
            "it is not among the files in memory".into(),
        ),
        (
            // The files of the disk are those of the folder that was named, and of no other.
            Document::from_bytes(
                main(),
                Format::Gltf,
                &folder.0.join(NAME),
                Limits::default(),
            ),
            "the document was given without surroundings".into(),
        ),
    ];
    for (read, why) in errors {
        let error = read.unwrap_err();
        let FileErrorKind::Io(found) = &error.kind else {
            panic!("{error}");
        };
        assert_eq!(found.kind(), std::io::ErrorKind::NotFound);
        // Alone, the first buffer is missed first.
        let text = error.to_string().replace("buffers/0", "buffers/1");
        let text = text.replace("buffers/a b.bin", "i.bin");
        let expected =
            format!("/buffers/1/uri: i.bin cannot be read ({why}). Put it beside the glTF");
        assert!(text.ends_with(&expected), "{text}");
    }
}

#[test]
fn a_missing_file_that_no_mesh_needs_is_the_same_note_everywhere() {
    let mut files = scene();
    let name = Path::new(NAME);
    let mut json: Value = serde_json::from_slice(&files[name]).unwrap();
    let buffers = json["buffers"].as_array_mut().unwrap();
    buffers.push(json!({ "uri": "lost.bin", "byteLength": 4 }));
    files.insert(NAME.into(), json.to_string().into_bytes());
    let folder = Folder::new("missing-note");
    write_below(&folder.0, &files);

    let on_disk = Document::open(&folder.0.join(NAME), Limits::default()).unwrap();
    let in_memory = read(&files);
    let notes = |document: &Document| -> Vec<_> {
        let notes = document.notes().iter();
        notes.map(|note| (note.place.clone(), note.more)).collect()
    };
    assert_eq!(notes(&on_disk), notes(&in_memory));
    assert_eq!(as_map(&in_memory, NAME).len(), 3);
}

#[test]
fn limits_hold_for_each_file() {
    let files = scene();
    let (name, longest) = (Path::new(NAME), files[Path::new(NAME)].len() as u64);
    let reads = |limit| {
        let mut limits = Limits::default();
        limits.file_bytes = limit;
        in_memory(&files, name, limits)
    };
    assert_eq!(reads(longest).unwrap().meshes(), read(&files).meshes());
    let error = reads(longest - 1).unwrap_err().to_string();
    let limit = longest - 1;
    assert!(
        error.contains(&format!("{longest} bytes: more than the limit of {limit}")),
        "{error}"
    );

    // Now the longest is beside the main file.
    let mut files = files;
    let buffer = files.get_mut(Path::new("buffers/a b.bin")).unwrap();
    buffer.resize(5000, 0);
    let mut limits = Limits::default();
    limits.file_bytes = 5000;
    in_memory(&files, name, limits).unwrap();
    limits.file_bytes = 4999;
    let error = in_memory(&files, name, limits).unwrap_err();
    let FileErrorKind::OverLimit {
        found: 5000,
        limit: 4999,
        ..
    } = error.kind
    else {
        panic!("{error}");
    };
    assert!(
        error.to_string().contains("/buffers/0/uri: 5000 bytes"),
        "{error}"
    );
}

#[test]
fn names_stay_below_the_folder() {
    let mut files = scene();
    let text = String::from_utf8(files[Path::new(NAME)].clone()).unwrap();
    files.insert("../i.bin".into(), files[Path::new("i.bin")].clone());
    files.insert("/i.bin".into(), files[Path::new("i.bin")].clone());
    for uri in ["../i.bin", "/i.bin", "%2e%2e/i.bin"] {
        files.insert(NAME.into(), text.replace("./i.bin", uri).into_bytes());
        let error = in_memory(&files, Path::new(NAME), Limits::default()).unwrap_err();
        assert!(
            matches!(error.kind, FileErrorKind::Malformed { .. }),
            "{error}"
        );
    }
}

#[test]
fn buffers_that_other_files_read_stay() {
    let files = scene();
    let mut options = ReadOptions::default();
    options.keep_buffers.push("buffers/a b.bin".into());
    let document = in_memory(&files, Path::new(NAME), options).unwrap();
    assert!(document.meshes().is_empty());
    let note = &document.notes()[0].text;
    assert!(note.contains("other files read its buffer too"), "{note}");
}

#[test]
fn what_is_in_memory_is_not_compressed_whatever_its_name() {
    let mut files = scene();
    let text = String::from_utf8(files[Path::new(NAME)].clone()).unwrap();
    files.insert(
        NAME.into(),
        text.replace("./i.bin", "i.bin.gz").into_bytes(),
    );
    let indices = files.remove(Path::new("i.bin")).unwrap();
    files.insert("i.bin.gz".into(), indices);
    assert_eq!(read(&files).meshes(), read(&scene()).meshes());
    let folder = Folder::new("map-gz");
    read(&files).write(&folder.0.join(NAME)).unwrap();
    let again = Document::open(&folder.0.join(NAME), Limits::default()).unwrap();
    assert_eq!(again.meshes(), read(&files).meshes());
}

#[test]
fn a_folder_of_the_disk_need_not_be_that_of_the_name() {
    let (files, folder) = (scene(), Folder::new("another-surroundings"));
    write_below(&folder.0, &files);
    let (main, beside) = (
        files[Path::new(NAME)].clone(),
        Surroundings::Folder(&folder.0),
    );
    let read = Document::from_bytes_in(
        main,
        Format::Gltf,
        Path::new(NAME),
        beside,
        Limits::default(),
    );
    let mut document = read.unwrap();
    random_orders(&mut document, 5);
    // It knows that the source stands there.
    document.write(&folder.0.join("other.gltf")).unwrap();
    let mut now = files_below(&folder.0);
    now.retain(|path, _| !path.to_str().unwrap().starts_with("other"));
    assert!(now == files);
}

#[test]
fn the_disk_is_neither_read_nor_written() {
    // A scene with other buffers stands where the name of the document says.
    let (files, folder) = (scene(), Folder::new("no-disk"));
    let mut decoys = files.clone();
    decoys.values_mut().for_each(|bytes| bytes.fill(0));
    write_below(&folder.0, &decoys);
    let path = folder.0.join(NAME);
    let (main, beside) = (files[Path::new(NAME)].clone(), Surroundings::Memory(&files));
    let read = Document::from_bytes_in(main, Format::Gltf, &path, beside, Limits::default());
    let mut document = read.unwrap();
    assert_eq!(document.meshes(), self::read(&files).meshes());
    operations::optimize(&mut document, &operations::Options::default(), &()).unwrap();
    for name in [NAME, "other.gltf"] {
        let new = document.to_bytes(&folder.0.join(name)).unwrap();
        assert_eq!(new.len(), 3);
    }
    assert!(files_below(&folder.0) == decoys);
}

#[test]
fn debug_output_lists_sizes_and_not_bytes() {
    let files = scene();
    let text = format!("{:?}", Surroundings::Memory(&files));
    assert!(text.contains("\"i.bin\": 80"), "{text}");
    assert!(text.len() < 200, "{text}");
    let folder = Surroundings::Folder(Path::new("a"));
    assert_eq!(
        format!("{folder:?} {:?}", Surroundings::default()),
        "Folder(\"a\") Nothing"
    );
}
