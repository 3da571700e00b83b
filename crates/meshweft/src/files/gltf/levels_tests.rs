//! Levels of made files: `MSFT_lod` in all ways that nodes may name each other.

use std::path::Path;

use serde_json::{Value, json};

use super::base64;
use crate::files::{Document, Format, MeshLevel, ReadOptions};

/// The numbers of the faces' corners of a primitive.
type Indices = &'static [u8];

/// A glTF of these meshes, each with the lists of its primitives, over nine vertices. Lists that are equal are one.
fn document(meshes: &[&[Indices]], nodes: &Value) -> Document {
    let with_extras: Vec<_> = meshes.iter().map(|&mesh| (mesh, json!(null))).collect();
    with_errors(&with_extras, nodes)
}

/// The same, each mesh with the error in its extras.
fn with_errors(meshes: &[(&[Indices], Value)], nodes: &Value) -> Document {
    // Positions, then all lists.
    let mut binary: Vec<u8> = (0..27_u8)
        .flat_map(|i| f32::from(i).to_le_bytes())
        .collect();
    let mut lists: Vec<Indices> = Vec::new();
    let mut accessors = vec![json!({
        "bufferView": 0, "componentType": 5126, "count": 9, "type": "VEC3",
        "min": [0, 1, 2], "max": [24, 25, 26],
    })];
    let mut primitive = |indices: Indices| {
        let known = lists.iter().position(|&list| list == indices);
        let number = known.unwrap_or_else(|| {
            accessors.push(json!({
                "bufferView": 1, "byteOffset": binary.len() - 108, "componentType": 5121,
                "count": indices.len(), "type": "SCALAR",
            }));
            binary.extend_from_slice(indices);
            lists.push(indices);
            lists.len() - 1
        });
        json!({"attributes": {"POSITION": 0}, "indices": number + 1})
    };
    let meshes: Vec<Value> = meshes
        .iter()
        .map(|(lists, error)| {
            let primitives: Vec<Value> = lists.iter().map(|&list| primitive(list)).collect();
            json!({"primitives": primitives, "extras": {"MESHWEFT_level": {"error": error}}})
        })
        .collect();

    let uri = format!("data:;base64,{}", base64::encode(&binary));
    let text = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": binary.len(), "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 108},
            {"buffer": 0, "byteOffset": 108, "byteLength": binary.len() - 108},
        ],
        "accessors": accessors, "meshes": meshes, "nodes": nodes,
    });
    read(&text)
}

fn read(json: &Value) -> Document {
    let (bytes, name) = (json.to_string().into_bytes(), Path::new("made.gltf"));
    Document::from_bytes(bytes, Format::Gltf, name, ReadOptions::default()).unwrap()
}

/// The level of each entry: its number, and of which entry.
fn levels(document: &Document) -> Vec<Option<(usize, usize)>> {
    let of = |level: MeshLevel| (level.number, level.of);
    let entries = document.meshes().iter();
    entries.map(|entry| entry.level.map(of)).collect()
}

/// A node that draws a mesh, with these levels.
fn node(mesh: usize, ids: &[usize]) -> Value {
    json!({"mesh": mesh, "extensions": {"MSFT_lod": {"ids": ids}}})
}

fn plain(mesh: usize) -> Value {
    json!({"mesh": mesh})
}

const A: Indices = &[0, 1, 2, 3, 4, 5];
const B: Indices = &[0, 1, 2];
const C: Indices = &[1, 2, 3];
const D: Indices = &[2, 3, 4];

#[test]
fn levels_are_found_with_their_errors() {
    let meshes: [(&[Indices], Value); 4] = [
        (&[A], json!(null)),
        (&[B], json!(0.25)),
        (&[C], json!(1)),
        (&[D], json!(-1)),
    ];
    let nodes = json!([node(0, &[1, 2, 3]), plain(1), plain(2), plain(3)]);
    let document = with_errors(&meshes, &nodes);
    let of = |number, error| {
        Some(MeshLevel {
            number,
            of: 0,
            error,
        })
    };
    let found: Vec<_> = document.meshes().iter().map(|it| it.level).collect();
    let expected = [None, of(1, Some(0.25)), of(2, Some(1.0)), of(3, None)];
    assert_eq!(found, expected, "a distance is not negative");

    for no_error in [json!("0.5"), json!(1e39), json!([]), json!({})] {
        let meshes: [(&[Indices], Value); 2] = [(&[A], json!(null)), (&[B], no_error)];
        let document = with_errors(&meshes, &json!([node(0, &[1]), plain(1)]));
        assert_eq!(document.meshes()[1].level, of(1, None));
    }
}

#[test]
fn primitives_are_levels_of_those_at_their_place() {
    let nodes = json!([node(0, &[1]), plain(1)]);
    let two = document(&[&[A, B], &[C, D]], &nodes);
    assert_eq!(levels(&two), [None, None, Some((1, 0)), Some((1, 1))]);

    // One that is the same list is at full resolution.
    let copied = document(&[&[A, B], &[C, B]], &nodes);
    assert_eq!(levels(&copied), [None, None, Some((1, 0))]);

    // A list that stands elsewhere at full resolution.
    let elsewhere = document(&[&[A, B], &[B, D]], &nodes);
    assert_eq!(levels(&elsewhere), [None, None, Some((1, 1))]);

    let unequal = document(&[&[A, B], &[C]], &nodes);
    assert_eq!(levels(&unequal), [None, None, None]);
}

#[test]
fn a_list_that_two_levels_have_is_one_of_the_first_mesh() {
    let nodes = json!([node(0, &[1, 2]), plain(2), plain(1)]);
    let document = document(&[&[A], &[B], &[B]], &nodes);
    assert_eq!(levels(&document), [None, Some((2, 0))]);
}

#[test]
fn what_is_drawn_at_full_resolution_is_no_level() {
    // By a node without the extension, and by one that has levels itself.
    for other in [plain(1), node(1, &[2])] {
        let nodes = json!([node(0, &[1, 2]), plain(1), plain(2), other]);
        let document = document(&[&[A], &[B], &[C]], &nodes);
        assert_eq!(levels(&document), [None, None, Some((2, 0))]);
    }

    // What stands below a level is drawn only in its place.
    let below = json!([
        node(0, &[1]),
        {"mesh": 1, "children": [2]},
        node(1, &[3]),
        plain(2),
    ]);
    let document = document(&[&[A], &[B], &[C]], &below);
    assert_eq!(levels(&document), [None, Some((1, 0)), None]);
}

#[test]
fn the_first_node_that_names_a_mesh_decides() {
    let nodes = json!([
        node(0, &[2, 3]),
        node(1, &[3, 2, 4]),
        plain(2),
        plain(3),
        plain(4)
    ]);
    let of_two = document(&[&[A], &[B], &[C], &[D], &[&[5, 6, 7]]], &nodes);
    let expected = [None, None, Some((1, 0)), Some((2, 0)), Some((3, 1))];
    assert_eq!(levels(&of_two), expected);

    // One mesh that two nodes draw with different levels has them all.
    let nodes = json!([node(0, &[2]), node(0, &[3, 2]), plain(1), plain(2)]);
    let twice = document(&[&[A], &[B], &[C]], &nodes);
    assert_eq!(levels(&twice), [None, Some((1, 0)), Some((1, 0))]);
}

#[test]
fn what_is_not_sound_says_nothing() {
    let of = |nodes: Value| levels(&document(&[&[A], &[B], &[C]], &nodes));
    let none = [None, None, None];

    // Numbers that are not there; those after keep their places.
    let far = json!([node(0, &[7, 1, usize::MAX]), plain(1)]);
    assert_eq!(of(far), [None, Some((2, 0)), None]);
    let no_numbers = json!([
        {"mesh": 0, "extensions": {"MSFT_lod": {"ids": ["x", -1, 1.5, {}, 1]}}}, plain(1),
    ]);
    assert_eq!(of(no_numbers), [None, Some((5, 0)), None]);
    let no_mesh = json!([node(0, &[1, 2]), {"children": [2]}, plain(1), node(9, &[4]), plain(2)]);
    assert_eq!(of(no_mesh), [None, Some((2, 0)), None]);
    for ids in [json!(1), json!({"a": 1}), json!(null)] {
        let nodes = json!([{"mesh": 0, "extensions": {"MSFT_lod": {"ids": ids}}}, plain(1)]);
        assert_eq!(of(nodes), none);
    }
    for extensions in [json!([]), json!({"MSFT_lod": [1]}), json!("MSFT_lod")] {
        assert_eq!(of(json!([{"mesh": 0, "extensions": extensions}])), none);
    }

    // In the place of itself, in a circle, below itself.
    assert_eq!(of(json!([node(0, &[0]), plain(1)])), none);
    assert_eq!(of(json!([node(0, &[1]), node(1, &[0])])), none);
    let own_child = json!([node(0, &[1]), {"mesh": 1, "children": [1, 2]}, {"children": [1]}]);
    assert_eq!(of(own_child), [None, Some((1, 0)), None]);

    // A level has no levels.
    let nested = json!([node(0, &[1]), node(1, &[2]), plain(2)]);
    assert_eq!(of(nested), [None, Some((1, 0)), None]);
    // The mesh itself is not one of its levels.
    assert_eq!(of(json!([node(0, &[1]), plain(0)])), none);
}

/// In time proportional to the square this takes hours.
#[test]
fn many_nodes_may_name_many_levels() {
    let count = 100_000;
    let lists: Vec<Indices> = vec![B; 2000];
    let full: Vec<Indices> = vec![A; 2000];
    let every: Vec<usize> = (count..2 * count).collect();
    let head = |i: usize| match i {
        0 => node(0, &every),
        _ => node(0, &[count + i, count]),
    };
    let below = |i: usize| json!({"mesh": 1, "children": [(i + 1).min(count - 1) + count, i]});
    let nodes: Vec<Value> = (0..count).map(head).chain((0..count).map(below)).collect();

    // A child of a level is drawn in its place, so the heads are at full resolution no longer.
    let document = document(&[&full, &lists], &json!(nodes));
    assert_eq!(levels(&document), [None, None]);

    let leaves = (0..count).map(|_| plain(1));
    let nodes: Vec<Value> = (0..count).map(head).chain(leaves).collect();
    let document = self::document(&[&full, &lists], &json!(nodes));
    assert_eq!(levels(&document), [None, Some((1, 0))]);
}

#[test]
fn an_edit_finds_the_levels_anew() {
    let nodes = json!([node(0, &[1]), plain(1)]);
    let mut document = document(&[&[A], &[B]], &nodes);
    let values = [crate::files::NewValue {
        pointer: "/nodes/-",
        json: r#"{"mesh":1}"#,
    }];
    let edit = crate::files::Edit::Append {
        meshes: &[],
        values: &values,
    };
    document.edit(edit).unwrap();
    assert_eq!(levels(&document), [None, None]);
}
