//! glTF and GLB: records leave the buffers, counts and places follow, and nothing of others changes.

use meshweft::attribute::Semantic;
use meshweft::files::{Document, Format};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U8, U16, U32, faces};
use crate::choice::Choice;
use crate::random::Random;
use crate::{assert_read_again, assert_selected, attributes, open, select, written};

/// What stands behind the meshes of [`scene`]: the pixels of an image.
const IMAGE: &[u8] = b"\x89PNG not really, but nobody looks";

fn floats(count: usize, scale: f32) -> Vec<u8> {
    let value = |i: usize| ((i * 37) % 101) as f32 * scale - 3.5;
    (0..count).flat_map(|i| value(i).to_le_bytes()).collect()
}

/// Accessors with and without sparse elements, alone in a view and interleaved; two primitives that share
/// vertices, lines over those of another, one without indices, one to leave alone, an image, an animation.
pub(crate) fn scene() -> (Builder, Value, Value) {
    let mut b = Builder::default();
    let bound = |b: &mut Builder, accessor: usize, min: Value, max: Value| {
        b.accessors[accessor]["min"] = min;
        b.accessors[accessor]["max"] = max;
        accessor
    };

    // The shared vertices, and their morph targets.
    let positions = floats(75, 0.25);
    let view = b.view(&positions, None);
    let position = b.accessor(view, 0, F32, 25, "VEC3");
    let extreme = |of: fn(f32, f32) -> f32| {
        let values = positions.as_chunks::<4>().0.iter();
        let values: Vec<f32> = values.map(|&bytes| f32::from_le_bytes(bytes)).collect();
        let of_axis = |axis: usize| values.iter().skip(axis).step_by(3).copied().reduce(of);
        json!([of_axis(0), of_axis(1), of_axis(2)])
    };
    let position = bound(&mut b, position, extreme(f32::min), extreme(f32::max));
    let view = b.view(&[7; 25 * 4], Some(4));
    let color = b.accessor(view, 0, U8, 25, "VEC3");
    let (uv, joints) = (b.data(U16, "VEC2", 25), b.data(U8, "VEC4", 25));
    let (weights, base) = (b.data(F32, "VEC4", 25), b.data(F32, "VEC3", 25));
    let places = b.view(&[0, 0, 3, 0, 9, 0, 10, 0, 20, 0, 24, 0], None);
    let values = b.view(&floats(18, 2.0), None);
    let sparse = json!({"count": 6, "indices": {"bufferView": places, "componentType": U16},
                        "values": {"bufferView": values}});
    b.accessors[base]["sparse"] = sparse.clone();
    let mut sparse = sparse;
    sparse["values"]["bufferView"] = b.view(&floats(18, 0.5), None).into();
    b.accessors
        .push(json!({"componentType": F32, "count": 25, "type": "VEC3", "sparse": sparse}));
    let zeros = b.accessors.len() - 1;
    let indices = [faces(16, 25), faces(9, 25)].map(|faces| b.indices(U16, &faces));
    bound(&mut b, indices[0], json!([0]), json!([24]));

    // Interleaved, with bytes between that nothing names, and lines.
    let view = b.view(&floats(20 * 7, 0.5), Some(28));
    let inner = [0, 12].map(|offset| b.accessor(view, offset, F32, 20, "VEC3"));
    let small = b.indices(U8, &faces(14, 20));
    let lines = b.indices(U8, &[0, 19, 3, 4]);

    // Without indices, and one to leave alone.
    let view = b.view(&floats(24 * 3 + 30, 1.5), None);
    let soup = [0, 24 * 12].map(|offset| {
        let count = if offset == 0 { 24 } else { 10 };
        b.accessor(view, offset, F32, count, "VEC3")
    });
    let soup_color = b.data(U8, "VEC4", 24);
    let alone = b.indices(U32, &faces(6, 10));
    let (input, output) = (b.data(F32, "SCALAR", 3), b.data(F32, "VEC3", 3));
    let image = b.view(IMAGE, None);

    let shared = json!({"POSITION": position, "COLOR_0": color, "TEXCOORD_0": uv, "JOINTS_0": joints,
                        "WEIGHTS_0": weights});
    let targets = json!([{"POSITION": base}, {"POSITION": zeros}]);
    let rows = json!({"POSITION": inner[0], "NORMAL": inner[1]});
    let meshes = json!([
        {"name": "shared", "extras": {"kept": 1.50}, "primitives": [
            {"attributes": shared, "targets": targets, "indices": indices[0], "material": 0},
            {"attributes": shared, "targets": targets, "indices": indices[1]}]},
        {"name": "rows", "primitives": [
            {"attributes": rows, "indices": small}, {"attributes": rows, "indices": lines, "mode": 1}]},
        {"name": "soup", "primitives": [{"attributes": {"POSITION": soup[0], "COLOR_0": soup_color}}]},
        {"name": "alone", "primitives": [{"attributes": {"POSITION": soup[1]}, "indices": alone}]},
    ]);
    let others = json!({
        "images": [{"bufferView": image, "mimeType": "image/png"}],
        "materials": [{"name": "red"}],
        "animations": [{"channels": [], "samplers": [{"input": input, "output": output}]}],
        "extras": {"order": ["b", "a", 1e3]},
    });
    (b, meshes, others)
}

/// The JSON and the first buffer of a document in one file.
pub(crate) fn parts(document: &Document) -> (Value, Vec<u8>) {
    let bytes = written(document);
    if document.format() == Format::Gltf {
        let json: Value = serde_json::from_slice(&bytes).unwrap();
        let uri = json["buffers"][0]["uri"].as_str().unwrap().to_owned();
        let data = decode(uri.split_once(";base64,").unwrap().1);
        return (json, data);
    }
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(word(8) % 4, 0);
    let end = 20 + word(12);
    assert_eq!(&bytes[end + 4..end + 8], b"BIN\0");
    assert_eq!(word(end) % 4, 0);
    let json = serde_json::from_slice(&bytes[20..end]).unwrap();
    (json, bytes[end + 8..end + 8 + word(end)].to_vec())
}

fn decode(text: &str) -> Vec<u8> {
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bits, mut count, mut bytes) = (0_u32, 0, Vec::new());
    for byte in text.bytes().filter(|&byte| byte != b'=') {
        let digit = alphabet.iter().position(|&other| other == byte).unwrap();
        bits = bits << 6 | digit as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

fn number(value: &Value) -> usize {
    value.as_u64().unwrap_or(0) as usize
}

/// Asserts what a validator asks of counts, places and bounds.
pub(crate) fn assert_sound(json: &Value, binary: &[u8]) {
    let buffer = number(&json["buffers"][0]["byteLength"]);
    assert!(
        (buffer..buffer + 4).contains(&binary.len()),
        "{buffer} of {}",
        binary.len()
    );
    let views = json["bufferViews"].as_array().unwrap();
    for view in views {
        assert!(number(&view["byteLength"]) > 0);
        assert!(number(&view["byteOffset"]) + number(&view["byteLength"]) <= buffer);
    }
    for accessor in json["accessors"].as_array().unwrap() {
        let width = match number(&accessor["componentType"]) {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let components = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let count = number(&accessor["count"]);
        assert!(count > 0);
        let Some(view) = accessor.get("bufferView") else {
            continue;
        };
        let (view, offset) = (&views[number(view)], number(&accessor["byteOffset"]));
        let stride = view.get("byteStride").map_or(width * components, number);
        assert_eq!((number(&view["byteOffset"]) + offset) % width, 0);
        let end = offset + (count - 1) * stride + width * components;
        assert!(end <= number(&view["byteLength"]), "{accessor} {view}");
        if accessor.get("min").is_none() {
            continue;
        }
        let start = number(&view["byteOffset"]) + offset;
        let value = |element: usize, component: usize| {
            let at = start + element * stride + component * width;
            match width {
                2 => f64::from(u16::from_le_bytes(binary[at..at + 2].try_into().unwrap())),
                _ => f64::from(f32::from_le_bytes(binary[at..at + 4].try_into().unwrap())),
            }
        };
        for component in 0..components {
            let values = (0..count).map(|element| value(element, component));
            let least = values.clone().fold(f64::INFINITY, f64::min);
            assert_eq!(
                accessor["min"][component].as_f64(),
                Some(least),
                "{accessor}"
            );
            let most = values.fold(f64::NEG_INFINITY, f64::max);
            assert_eq!(accessor["max"][component].as_f64(), Some(most));
        }
    }
}

/// A choice for each of these meshes, which share their vertices, with what `also` names.
fn choices(
    document: &Document,
    meshes: &[usize],
    also: &[u32],
    random: &mut Random,
) -> Vec<(usize, Choice)> {
    let mut all: Vec<(usize, Choice)> = meshes
        .iter()
        .map(|&mesh| (mesh, Choice::random(&document.meshes()[mesh], random)))
        .collect();
    if all.iter().any(|(_, choice)| choice.vertices.is_none()) {
        for (_, choice) in &mut all {
            choice.vertices = None;
        }
        return all;
    }
    let mut kept: Vec<u32> = all[0].1.vertices.clone().unwrap();
    let used = all.iter().flat_map(|(_, choice)| choice.used());
    for vertex in used.chain(also.iter().copied()).collect::<Vec<u32>>() {
        if !kept.contains(&vertex) {
            kept.push(vertex);
        }
    }
    let is_movable = document.meshes()[meshes[0]].vertices_movable;
    if !is_movable {
        kept.sort_unstable();
    }
    for (_, choice) in &mut all {
        choice.vertices = Some(kept.clone());
    }
    all
}

fn check_random(bytes: &[u8], format: Format, seed: u64) {
    let mut random = Random(seed);
    let mut document = open(bytes, format);
    assert_eq!(document.meshes().len(), 5, "{:?}", document.notes());
    let all = [0, 1, 2, 3, 4].map(|mesh| (mesh, Choice::all(&document.meshes()[mesh])));
    let all = all.map(|(mesh, choice)| {
        let vertices = choice.vertices.filter(|_| mesh != 1);
        (mesh, Choice { vertices, ..choice })
    });
    select(&mut document, &all).unwrap();
    assert!(written(&document) == bytes, "everything is nothing to do");

    // What the lines name.
    let mut named: Vec<u32> = vec![0, 19, 3, 4];
    for _ in 0..5 {
        let before = open(&written(&document), format);
        let (old, old_binary) = parts(&before);
        let meshes: &[usize] = match random.below(4) {
            0 => &[0, 1],
            1 => &[2],
            2 => &[3],
            _ => &[4],
        };
        let also: &[u32] = if meshes == [2] { &named } else { &[] };
        let chosen = choices(&document, meshes, also, &mut random);
        let mut once = chosen.clone();
        for (_, choice) in once.iter_mut().skip(1) {
            choice.vertices = None;
        }
        select(&mut document, &once).unwrap();
        assert_read_again(&document);
        for (mesh, choice) in &chosen {
            assert_selected(&before, &document, *mesh, choice, *mesh != 3);
        }
        if let (2, Some(kept)) = (meshes[0], &chosen[0].1.vertices) {
            let new_of = |old: u32| kept.iter().position(|&vertex| vertex == old).unwrap() as u32;
            named = named.into_iter().map(new_of).collect();
        }
        for mesh in (0..5).filter(|mesh| !meshes.contains(mesh)) {
            assert!(attributes(&before, mesh) == attributes(&document, mesh));
            assert_eq!(
                before.meshes()[mesh].mesh.faces(),
                document.meshes()[mesh].mesh.faces()
            );
        }

        // What no mesh has stays.
        let (new, binary) = parts(&document);
        assert_sound(&new, &binary);
        assert!(binary.len() <= old_binary.len());
        for name in [
            "images",
            "materials",
            "animations",
            "extras",
            "meshes",
            "asset",
        ] {
            assert_eq!(new[name], old[name]);
        }
        let view = &new["bufferViews"][number(&new["images"][0]["bufferView"])];
        assert_eq!(&binary[number(&view["byteOffset"])..][..IMAGE.len()], IMAGE);
        let gaps = |bytes: &[u8]| bytes.iter().filter(|&&byte| byte == 0xA5).count();
        assert_eq!(
            gaps(&binary),
            gaps(&old_binary),
            "bytes that nothing names stay"
        );
    }
}

#[test]
fn random_selections_of_a_glb() {
    let (builder, meshes, others) = scene();
    let glb = builder.glb(&meshes, &others);
    for seed in 1..80 {
        check_random(&glb, Format::Glb, seed);
    }
}

/// The scene as text that holds its data.
pub(crate) fn text() -> String {
    let (builder, meshes, others) = scene();
    let mut json = builder.json(&meshes, &others);
    let mut text = String::new();
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for three in builder.binary.chunks(3) {
        let mut word = [0; 3];
        word[..three.len()].copy_from_slice(three);
        let bits = u32::from_be_bytes([0, word[0], word[1], word[2]]);
        for digit in 0..4 {
            let value = bits >> (18 - 6 * digit) & 63;
            text.push(match digit <= three.len() {
                true => char::from(alphabet[value as usize]),
                false => '=',
            });
        }
    }
    json["buffers"][0]["uri"] = format!("data:application/octet-stream;base64,{text}").into();
    json.to_string()
}

#[test]
fn random_selections_of_a_gltf_with_its_data_inside() {
    for seed in 1..20 {
        check_random(text().as_bytes(), Format::Gltf, seed);
    }
}

#[test]
fn bytes_that_leave_are_gone_and_bounds_are_those_of_the_rest() {
    let (builder, meshes, others) = scene();
    let glb = builder.glb(&meshes, &others);
    let mut document = open(&glb, Format::Glb);
    // 14 faces of bytes and 20 rows of 28 bytes become one face and five rows.
    let mut choice = Choice::of_faces(&document.meshes()[2], [0]);
    choice.vertices = Some(vec![0, 1, 2, 3, 4, 19]);
    let (_, before) = parts(&document);
    select(&mut document, &[(2, choice)]).unwrap();
    let (json, after) = parts(&document);
    assert_sound(&json, &after);
    let left = before.len() - after.len();
    let expected = 13 * 3 + 14 * 28;
    assert!(
        (expected - 20..=expected).contains(&left),
        "{left} of {expected}"
    );

    // The smallest and largest position that is left.
    let mut document = open(&glb, Format::Glb);
    let mut choice = Choice::of_faces(&document.meshes()[0], [0]);
    let rest = Choice::of_faces(&document.meshes()[1], [0]);
    let mut kept = [choice.used(), rest.used()].concat();
    kept.sort_unstable();
    kept.dedup();
    choice.vertices = Some(kept);
    select(&mut document, &[(0, choice), (1, rest)]).unwrap();
    let (json, binary) = parts(&document);
    assert_sound(&json, &binary);
    let info = document.attributes(0);
    assert_eq!(info[0].semantic, Semantic::Position);
    let positions = document.positions(0).unwrap().unwrap();
    let least = positions.iter().map(|p| p[0]).fold(f32::INFINITY, f32::min);
    assert_eq!(
        json["accessors"][0]["min"][0].as_f64(),
        Some(f64::from(least))
    );
}
