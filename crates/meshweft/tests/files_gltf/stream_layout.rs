//! Buffers laid out for streaming: views change places, and nothing else does.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Edit, Format, ReadOptions, Surroundings};
use serde_json::{Value, json};

use crate::append::is_inserted;
use crate::builder::{Builder, F32, U8, U16, faces, glb};
use crate::data::scenes;
use crate::levelled::{all, made};
use crate::reader::Reader;

const NAME: &str = "made.glb";

fn open(bytes: Vec<u8>) -> Document {
    Document::from_bytes(bytes, Format::Glb, NAME.as_ref(), Limits::default()).unwrap()
}

fn laid_out(bytes: Vec<u8>) -> Document {
    let mut document = open(bytes);
    document.edit(Edit::StreamLayout).unwrap();
    document
}

fn reader(bytes: Vec<u8>) -> Reader {
    Reader::of_file(NAME.as_ref(), Some(bytes))
}

fn number(value: &Value) -> usize {
    usize::try_from(value.as_u64().unwrap_or(0)).unwrap()
}

/// Each view and what it is compressed from, with its place: a path below it.
fn places(json: &Value) -> Vec<(usize, &'static str, &Value)> {
    let views = json["bufferViews"].as_array().into_iter().flatten();
    let mut places = Vec::new();
    for (view, value) in views.enumerate() {
        places.push((view, "", value));
        for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
            let source = value.get("extensions").and_then(|all| all.get(name));
            places.extend(source.map(|source| (view, name, source)));
        }
    }
    places
}

/// The bytes of each of them that has some.
fn view_bytes(reader: &Reader) -> Vec<Option<&[u8]>> {
    let places = places(&reader.json).into_iter();
    let bytes = places.map(|(_, _, value)| {
        let buffer = reader.buffers[number(&value["buffer"])].as_ref()?;
        Some(&buffer[number(&value["byteOffset"])..][..number(&value["byteLength"])])
    });
    bytes.collect()
}

/// The JSON without where views stand, how long buffers are, and what is in them.
fn without_places(json: &Value) -> Value {
    let mut json = json.clone();
    let mut remove = |pointer: String, name: &str| {
        let object = json.pointer_mut(&pointer).and_then(Value::as_object_mut);
        object.map(|object| object.remove(name))
    };
    for view in 0.. {
        let pointer = format!("/bufferViews/{view}");
        for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
            remove(format!("{pointer}/extensions/{name}"), "byteOffset");
        }
        if remove(pointer, "byteOffset").is_none() {
            break;
        }
    }
    for buffer in 0.. {
        let pointer = format!("/buffers/{buffer}");
        remove(pointer.clone(), "uri");
        if remove(pointer, "byteLength").is_none() {
            break;
        }
    }
    json
}

/// How often each byte but 0 is in the buffers.
fn byte_counts(reader: &Reader) -> Vec<usize> {
    let mut counts = vec![0; 256];
    for byte in reader.buffers.iter().flatten().flatten() {
        counts[usize::from(*byte)] += 1;
    }
    counts[0] = 0;
    counts
}

/// Nothing but the places of views has changed, and these are aligned as they were.
fn assert_same(old: &Reader, new: &Reader, name: &str) {
    assert_eq!(
        without_places(&old.json),
        without_places(&new.json),
        "{name}"
    );
    assert!(view_bytes(old) == view_bytes(new), "{name}");
    assert_eq!(byte_counts(old), byte_counts(new), "{name}");
    for ((_, _, old), (_, _, new)) in places(&old.json).into_iter().zip(places(&new.json)) {
        let [old, new] = [old, new].map(|view| number(&view["byteOffset"]));
        let alignment = if old % 8 == 0 { 8 } else { 4 };
        assert_eq!(old % alignment, new % alignment, "{name}");
    }
    assert!(old.triangles() == new.triangles(), "{name}");
}

#[test]
fn views_stand_in_the_order_in_which_they_are_wanted() {
    for kind in all() {
        let name = &format!("{kind:?}");
        let made = made(kind);
        let old = made.glb();
        let document = laid_out(old.clone());
        let new = document.to_main_bytes().unwrap();

        // The order, and all that stays.
        let (before, after) = (reader(old.clone()), reader(new.clone()));
        let views = after.json["bufferViews"].as_array().unwrap();
        let mut order: Vec<usize> = (0..views.len()).collect();
        order.sort_by_key(|&view| number(&views[view]["byteOffset"]));
        assert_eq!(order, made.wanted, "{name}");
        assert_same(&before, &after, name);
        assert!(is_inserted(&before.json_text, &after.json_text), "{name}");
        assert!(new.ends_with(b"ODD\0\x01\x02\x03\x04behind"), "{name}");
        assert!(before.json_text != after.json_text, "{name}");

        // The document is what is read again, and a second time changes nothing.
        assert_eq!(document.meshes(), open(old).meshes(), "{name}");
        let mut again = open(new.clone());
        assert_eq!(again.meshes(), document.meshes(), "{name}");
        again.edit(Edit::StreamLayout).unwrap();
        assert!(again.to_main_bytes().unwrap() == new, "{name}");
    }
}

#[test]
fn real_scenes_keep_everything_but_the_places_of_views() {
    let (mut ran, mut moved, mut refused) = (0, 0, 0);
    for path in scenes() {
        let name = &path.display().to_string();
        let file_name = Path::new(path.file_name().unwrap());
        let mut document = Document::open(&path, Limits::default()).unwrap();
        let meshes = document.meshes().to_vec();
        let old: BTreeMap<PathBuf, Vec<u8>> =
            document.to_bytes(file_name).unwrap().into_iter().collect();
        ran += 1;
        if let Err(error) = document.edit(Edit::StreamLayout) {
            println!("{error}");
            refused += 1;
            let new = document.to_bytes(file_name).unwrap();
            assert!(old == new.into_iter().collect(), "{name}");
            continue;
        }
        assert_eq!(document.meshes(), meshes, "{name}");

        // As files, with those beside them.
        let folder = std::env::temp_dir().join(format!("meshweft-stream-{}", std::process::id()));
        let target = folder.join(file_name);
        for relative in old.keys() {
            std::fs::create_dir_all(folder.join(relative).parent().unwrap()).unwrap();
        }
        document.write(&target).unwrap();
        let (before, after) = (Reader::of_file(&path, None), Reader::of_file(&target, None));
        assert_same(&before, &after, name);
        moved += usize::from(before.json != after.json);

        // Images are last.
        let views = after.json["bufferViews"].as_array();
        let images = after.json["images"].as_array().into_iter().flatten();
        let images: Vec<usize> = images
            .filter_map(|image| Some(number(image.get("bufferView")?)))
            .collect();
        for (view, value) in views.into_iter().flatten().enumerate() {
            let start = number(&value["byteOffset"]);
            for &image in images.iter().filter(|_| !images.contains(&view)) {
                let image = &after.json["bufferViews"][image];
                let is_other = value["buffer"] != image["buffer"];
                assert!(is_other || start < number(&image["byteOffset"]), "{name}");
            }
        }

        let mut again = Document::open(&target, Limits::default()).unwrap();
        assert_eq!(again.meshes(), meshes, "{name}");
        let written = again.to_bytes(file_name).unwrap();
        again.edit(Edit::StreamLayout).unwrap();
        assert!(written == again.to_bytes(file_name).unwrap(), "{name}");
        std::fs::remove_dir_all(&folder).unwrap();
    }
    println!("ran {ran} scenes: {moved} changed, {refused} refused");
    assert!(ran == 0 || moved > 0);
}

/// A mesh behind an image: its views change places with it.
fn behind_an_image() -> (Builder, Value, Value) {
    let mut builder = Builder::default();
    let image = builder.view(&[7; 33], None);
    let positions = builder.data(F32, "VEC3", 9);
    let indices = builder.indices(U16, &faces(8, 9));
    let meshes =
        json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    let others = json!({"images": [{"bufferView": image}]});
    (builder, meshes, others)
}

#[test]
fn views_that_share_bytes_move_together() {
    let (mut builder, meshes, mut others) = behind_an_image();
    // One within the positions, one over the end of these and the indices, one that only touches.
    let start = number(&builder.views[1]["byteOffset"]);
    let list = builder.views[2].clone();
    let end = number(&list["byteOffset"]) + number(&list["byteLength"]);
    builder
        .views
        .push(json!({"buffer": 0, "byteOffset": start + 4, "byteLength": 8}));
    builder
        .views
        .push(json!({"buffer": 0, "byteOffset": start + 100, "byteLength": end - 4 - start - 100}));
    builder
        .views
        .push(json!({"buffer": 0, "byteOffset": end, "byteLength": 4}));
    others["images"] = json!([{"bufferView": 0}, {"bufferView": 5}]);
    let old = builder.glb(&meshes, &others);
    let new = laid_out(old.clone()).to_main_bytes().unwrap();
    let (before, after) = (reader(old), reader(new));
    assert_same(&before, &after, "overlap");
    let at = |reader: &Reader, view: usize| number(&reader.json["bufferViews"][view]["byteOffset"]);
    for view in 2..5 {
        let [old, new] = [&before, &after].map(|reader| at(reader, view) - at(reader, 1));
        assert_eq!(old, new);
    }
    assert_eq!(at(&after, 1) / 8, 0, "it comes first");
    assert!(at(&after, 5) > at(&after, 0), "images keep their order");
}

#[test]
fn a_view_without_offset_gets_one() {
    let (mut builder, meshes, others) = behind_an_image();
    builder.views[0]
        .as_object_mut()
        .unwrap()
        .remove("byteOffset");
    let old = builder.glb(&meshes, &others);
    let new = laid_out(old.clone()).to_main_bytes().unwrap();
    let (before, after) = (reader(old), reader(new));
    assert_same(&before, &after, "no offset");
    assert!(number(&after.json["bufferViews"][0]["byteOffset"]) > 0);
    assert!(is_inserted(&before.json_text, &after.json_text));
}

#[test]
fn a_buffer_gets_longer_where_it_must() {
    // The list stands three bytes behind a multiple of four, and must do so again in front of the image.
    let mut binary = b"png\0\x01\x02\0\0".to_vec();
    binary.extend(1..37);
    let json = json!({
        "asset": {"version": "2.0"}, "buffers": [{"byteLength": 44}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 3},
            {"buffer": 0, "byteOffset": 3, "byteLength": 3},
            {"buffer": 0, "byteOffset": 8, "byteLength": 36},
        ],
        "accessors": [
            {"bufferView": 1, "componentType": U8, "count": 3, "type": "SCALAR"},
            {"bufferView": 2, "componentType": F32, "count": 3, "type": "VEC3"},
        ],
        "images": [{"bufferView": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
    });
    let old = glb(&json.to_string(), Some(&binary));
    let document = laid_out(old.clone());
    let new = document.to_main_bytes().unwrap();
    let (before, after) = (reader(old), reader(new.clone()));
    assert_same(&before, &after, "longer");
    let starts =
        [1, 2, 0].map(|view: usize| number(&after.json["bufferViews"][view]["byteOffset"]));
    assert_eq!(starts, [3, 8, 48]);
    assert_eq!(after.json["buffers"], json!([{"byteLength": 52}]));
    assert_eq!(after.buffers[0].as_ref().unwrap().len(), 52);
    assert_eq!(open(new).meshes(), document.meshes());
}

#[test]
fn data_in_the_text_and_beside_it_moves_too() {
    let (builder, meshes, others) = behind_an_image();
    let mut json = builder.json(&meshes, &others);
    let encoded = base64(&builder.binary);
    for uri in [
        &*format!("data:application/octet-stream;base64,{encoded}"),
        "it.bin",
    ] {
        json["buffers"][0]["uri"] = json!(uri);
        let name: PathBuf = "made.gltf".into();
        let files = BTreeMap::from([(PathBuf::from("it.bin"), builder.binary.clone())]);
        let beside = Surroundings::Memory(&files);
        let text = json.to_string().into_bytes();
        let mut document =
            Document::from_bytes_in(text.clone(), Format::Gltf, &name, beside, Limits::default())
                .unwrap();
        document.edit(Edit::StreamLayout).unwrap();
        let new: BTreeMap<PathBuf, Vec<u8>> =
            document.to_bytes(&name).unwrap().into_iter().collect();
        let folder =
            std::env::temp_dir().join(format!("meshweft-stream-data-{}", std::process::id()));
        let [before, after] = [("old", &text), ("new", &new[&name])].map(|(sub, text)| {
            let folder = folder.join(sub);
            std::fs::create_dir_all(&folder).unwrap();
            for (name, bytes) in files.iter().chain(&new) {
                let is_new = sub == "new" || files.contains_key(name) && !new.contains_key(name);
                let bytes = if is_new {
                    bytes
                } else {
                    files.get(name).unwrap_or(bytes)
                };
                std::fs::write(folder.join(name), bytes).unwrap();
            }
            std::fs::write(folder.join(&name), text).unwrap();
            Reader::of_file(&folder.join(&name), None)
        });
        std::fs::remove_dir_all(&folder).unwrap();
        assert_same(&before, &after, uri);
        let starts =
            [1, 2, 0].map(|view: usize| number(&after.json["bufferViews"][view]["byteOffset"]));
        assert!(starts.is_sorted() && starts[0] < 8, "{starts:?}");
    }
}

fn base64(bytes: &[u8]) -> String {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let word = (0..3).fold(0, |word, i| {
            word << 8 | usize::from(*chunk.get(i).unwrap_or(&0))
        });
        for digit in 0..=chunk.len() {
            text.push(char::from(letters[word >> (18 - 6 * digit) & 63]));
        }
    }
    while !text.len().is_multiple_of(4) {
        text.push('=');
    }
    text
}

#[test]
fn what_may_name_bytes_is_refused() {
    let (builder, meshes, others) = behind_an_image();
    let json = builder.json(&meshes, &others);
    let with = |change: &dyn Fn(&mut Value)| {
        let mut json = json.clone();
        change(&mut json);
        glb(&json.to_string(), Some(&builder.binary))
    };
    let named = json!({"buffer": 0, "byteOffset": 4});
    let cases = [
        (
            with(&|json| json["bufferViews"][1]["extensions"] = json!({"X_a": {}})),
            "/bufferViews/1: its extension X_a is not known",
        ),
        (
            with(&|json| json["buffers"][0]["extensions"] = json!({"X_b": {}})),
            "/buffers/0: its extension X_b is not known",
        ),
        (
            with(&|json| json["extensions"] = json!({"X~/c": {"sounds": [1, named]}})),
            "/extensions/X~0~1c/sounds/1: it may name bytes",
        ),
        (
            with(&|json| json["meshes"][0]["extras"] = named.clone()),
            "/meshes/0/extras: it may name bytes",
        ),
        (
            with(&|json| json["bufferViews"][2]["byteLength"] = json!(1 << 20)),
            "reach past",
        ),
    ];
    for (old, expected) in cases {
        let mut document =
            match Document::from_bytes(old, Format::Glb, NAME.as_ref(), Limits::default()) {
                Ok(document) => document,
                // The reader itself may refuse it.
                Err(error) => {
                    assert!(error.to_string().contains(expected), "{error}");
                    continue;
                }
            };
        let before = document.to_main_bytes().unwrap();
        let error = document.edit(Edit::StreamLayout).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
        assert!(document.to_main_bytes().unwrap() == before);
    }

    // What the user vouches for, and names of other buffers.
    let mut options = ReadOptions::default();
    options.assume_order_safe = vec!["X_a".into()];
    let vouched = with(&|json| json["bufferViews"][1]["extensions"] = json!({"X_a": {}}));
    let elsewhere = with(&|json| json["extras"] = json!({"buffer": 1, "byteOffset": 4}));
    for old in [vouched, elsewhere] {
        let mut document =
            Document::from_bytes(old, Format::Glb, NAME.as_ref(), options.clone()).unwrap();
        let before = document.to_main_bytes().unwrap();
        document.edit(Edit::StreamLayout).unwrap();
        assert!(document.to_main_bytes().unwrap() != before);
    }
}

#[test]
fn buffers_that_may_not_change_are_refused() {
    let (builder, meshes, others) = behind_an_image();
    let mut json = builder.json(&meshes, &others);
    json["buffers"][0]["uri"] = json!("it.bin");
    let files = BTreeMap::from([(PathBuf::from("it.bin"), builder.binary.clone())]);
    let open = |json: &Value, format: Format, options: ReadOptions| {
        let bytes = match format {
            Format::Glb => glb(&json.to_string(), None),
            _ => json.to_string().into_bytes(),
        };
        let name: &Path = "folder/made.gltf".as_ref();
        Document::from_bytes_in(bytes, format, name, Surroundings::Memory(&files), options).unwrap()
    };
    let refused =
        |mut document: Document| document.edit(Edit::StreamLayout).unwrap_err().to_string();

    let beside_glb = refused(open(&json, Format::Glb, ReadOptions::default()));
    let expected =
        "/buffers/0: it cannot be laid out for streaming: its data is not in the binary chunk";
    assert!(beside_glb.contains(expected), "{beside_glb}");
    let mut options = ReadOptions::default();
    options.keep_buffers = vec!["folder/it.bin".into()];
    let shared = refused(open(&json, Format::Gltf, options));
    assert!(
        shared.contains("other files read its buffer too"),
        "{shared}"
    );

    json["buffers"] = json!([json["buffers"][0], json["buffers"][0]]);
    let twice = refused(open(&json, Format::Gltf, ReadOptions::default()));
    assert!(
        twice.contains("buffer 1 has the same bytes. Name them once"),
        "{twice}"
    );

    let text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec();
    let other = Document::from_bytes(text, Format::Off, "a.off".as_ref(), Limits::default());
    let other = refused(other.unwrap());
    assert!(
        other.contains("only buffers of .gltf and .glb files"),
        "{other}"
    );
}
