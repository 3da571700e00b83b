//! Faces and lines that must be drawn in their order, over vertices that move.

use std::path::Path;

use meshweft::Limits;
use meshweft::files::{Document, Edit, Format, ReadOptions};
use meshweft::{FaceOrder, Permutation};
use serde_json::{Value, json};

use super::builder::{Builder, F32, U8, U16, U32, faces};
use super::moves::{check, notes, one_mesh, open, reader, written};
use super::random_orders;

const TRANSPARENT: &str = "the faces stay where they are: its material is transparent (alphaMode BLEND), so \
                           each is drawn over those before it; reorder_transparent lets them move";

/// Triangles, and another primitive over the same vertices.
fn beside_triangles(mode: usize, component: usize, numbers: &[usize], more: &Value) -> Vec<u8> {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 30);
    let corners = builder.indices(U16, &faces(40, 30));
    let list = builder.indices(component, numbers);
    let mut other = json!({"attributes": {"POSITION": position}, "mode": mode, "indices": list});
    for (name, value) in more.as_object().unwrap() {
        other[name] = value.clone();
    }
    let triangles = json!({"attributes": {"POSITION": position}, "indices": corners});
    builder.glb(&json!([{"primitives": [other, triangles]}]), &json!({}))
}

#[test]
fn lines_and_strips_are_renumbered_with_the_vertices_of_faces() {
    let numbers: Vec<usize> = (0..24).map(|i| i * 11 % 30).collect();
    let strip = "it is a strip or fan, whose faces depend on those before; strips_to_lists makes a \
                 list of it";
    for (mode, why) in [
        (0, "it is drawn as points"),
        (1, "it is drawn as lines"),
        (3, "it is drawn as lines"),
        (5, strip),
        (6, strip),
    ] {
        for component in [U8, U16, U32] {
            let bytes = beside_triangles(mode, component, &numbers, &json!({}));
            let document = open(&bytes);
            let expected = [format!("/meshes/0/primitives/0: its order stays: {why}")];
            assert_eq!(notes(&document), expected);
            assert_eq!(document.meshes().len(), 1);
            assert!(document.meshes()[0].vertices_movable);
            check(&bytes);
        }
    }
}

#[test]
fn the_outline_of_a_strip_is_renumbered_too() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 30);
    let corners = builder.indices(U16, &faces(40, 30));
    let strip = builder.indices(U16, &faces(5, 30));
    let outline = builder.indices(U16, &[3, 4, 5, 6]);
    let primitives = json!([
        {"attributes": {"POSITION": position}, "indices": corners},
        {"attributes": {"POSITION": position}, "indices": strip, "mode": 5,
            "extensions": {"CESIUM_primitive_outline": {"indices": outline}}},
    ]);
    let bytes = builder.glb(&json!([{"primitives": primitives}]), &json!({}));
    assert!(open(&bytes).meshes()[0].vertices_movable);
    check(&bytes);
}

#[test]
fn vertices_stay_where_lines_cannot_be_renumbered() {
    let stay = "the vertices stay where they are";
    let cases: [(usize, &[usize], Value, String); 4] = [
        (
            U16,
            &[0, 30],
            json!({}),
            format!(
                "{stay}: what draws lines or strips over them names vertices that are not there"
            ),
        ),
        (
            U8,
            &[0, 1],
            json!({"extensions": {"FANCY_lines": {}}}),
            format!("{stay}: they share bytes with /meshes/0/primitives/0"),
        ),
        (
            U8,
            &[0, 1],
            json!({"attributes": {"POSITION": 7}}),
            String::new(),
        ),
        (
            F32,
            &[0, 1],
            json!({}),
            format!("{stay}: they share bytes with /meshes/0/primitives/0"),
        ),
    ];
    for (component, numbers, more, why) in cases {
        let bytes = beside_triangles(1, component, numbers, &more);
        let mut document = open(&bytes);
        let notes = notes(&document);
        assert_eq!(
            document.meshes()[0].vertices_movable,
            why.is_empty(),
            "{notes:?}"
        );
        assert!(
            why.is_empty() || notes.iter().any(|note| note.ends_with(&why)),
            "{notes:?}"
        );
        random_orders(&mut document, 1);
        let moved = reader(&written(&document)).triangles();
        assert!(moved == reader(&bytes).triangles());
    }
}

#[test]
fn lines_alone_are_no_mesh() {
    let bytes = one_mesh(|_, primitive, _| primitive["mode"] = json!(1));
    let document = open(&bytes);
    assert!(document.meshes().is_empty());
    let expected = ["/meshes/0/primitives/0: its order stays: it is drawn as lines"];
    assert_eq!(notes(&document), expected);
}

/// One mesh with these members of its primitive, and three materials, the second transparent.
fn with_material(more: Value) -> Vec<u8> {
    one_mesh(move |_, primitive, root| {
        root["materials"] = json!([{}, {"alphaMode": "BLEND"}, {"alphaMode": "MASK"}]);
        for (name, value) in more.as_object().unwrap() {
            primitive[name] = value.clone();
        }
    })
}

#[test]
fn transparent_faces_stay_and_their_vertices_move() {
    let variants = |material: usize| {
        json!({"material": 0, "extensions": {"KHR_materials_variants":
            {"mappings": [{"material": 0, "variants": [0]}, {"material": material, "variants": [1]}]}}})
    };
    for (more, is_transparent) in [
        (json!({"material": 1}), true),
        (variants(1), true),
        (json!({}), false),
        (json!({"material": 0}), false),
        (json!({"material": 2}), false),
        (json!({"material": 9}), false),
        (variants(2), false),
    ] {
        let bytes = with_material(more);
        let mut document = open(&bytes);
        let entry = &document.meshes()[0];
        assert!(entry.vertices_movable);
        assert_eq!(entry.faces_movable, !is_transparent);
        let expected = match is_transparent {
            true => vec![format!("/meshes/0/primitives/0: {TRANSPARENT}")],
            false => vec![],
        };
        assert_eq!(notes(&document), expected);
        check(&bytes);

        // Corner by corner in the same order.
        if is_transparent {
            let count = entry.record_count();
            let all = |_: &Value| true;
            random_orders(&mut document, 1);
            let moved = written(&document);
            assert_ne!(moved, bytes);
            assert!(reader(&moved).drawn_in_order(all) == reader(&bytes).drawn_in_order(all));

            let last_first = Permutation::new((0..u32::try_from(count).unwrap()).rev().collect());
            let order = FaceOrder::from(last_first.unwrap());
            let refused = document.edit(Edit::order(0, &order, None)).unwrap_err();
            let text = refused.to_string();
            assert!(
                text.ends_with("its faces must stay in their order"),
                "{text}"
            );
        }
    }
}

#[test]
fn transparent_faces_move_where_that_is_asked_for() {
    let bytes = with_material(json!({"material": 1}));
    let mut options = ReadOptions::from(Limits::default());
    options.reorder_transparent = true;
    let path = Path::new("scene.glb");
    let document = Document::from_bytes(bytes, Format::Glb, path, &options).unwrap();
    assert!(document.meshes()[0].faces_movable && document.notes().is_empty());
}

#[test]
fn faces_that_one_of_two_primitives_draws_transparent_stay() {
    for materials in [[1, 0], [0, 1]] {
        let mut builder = Builder::default();
        let position = builder.data(F32, "VEC3", 30);
        let corners = builder.indices(U16, &faces(40, 30));
        let primitives = materials.map(|material| {
            json!({"attributes": {"POSITION": position}, "indices": corners, "material": material})
        });
        let others = json!({"materials": [{}, {"alphaMode": "BLEND"}]});
        let bytes = builder.glb(&json!([{"primitives": primitives}]), &others);
        let document = open(&bytes);
        assert_eq!(document.meshes().len(), 1);
        assert!(!document.meshes()[0].faces_movable);
        check(&bytes);
    }
}

#[test]
fn transparent_faces_without_indices_stay_whole() {
    let bytes = one_mesh(|builder, primitive, root| {
        root["materials"] = json!([{"alphaMode": "BLEND"}]);
        builder.accessors[0]["count"] = json!(18);
        *primitive = json!({"attributes": primitive["attributes"], "material": 0});
        builder.accessors.truncate(1);
        builder.views.truncate(1);
    });
    let mut document = open(&bytes);
    assert!(!document.meshes()[0].faces_movable && !document.meshes()[0].vertices_movable);
    random_orders(&mut document, 1);
    assert_eq!(written(&document), bytes);
}

#[test]
fn metadata_of_features_names_no_vertex() {
    for (metadata, is_free) in [
        (json!({"propertyAttributes": [0]}), true),
        (
            json!({"propertyTextures": [0], "propertyAttributes": [1]}),
            true,
        ),
        (json!({"somethingNew": [0]}), false),
    ] {
        let bytes = one_mesh(|_, primitive, _| {
            primitive["extensions"] = json!({"EXT_structural_metadata": metadata});
        });
        let document = open(&bytes);
        assert_eq!(document.meshes()[0].vertices_movable, is_free);
        check(&bytes);
    }
}

#[test]
fn a_json_chunk_padded_with_zeros_is_read() {
    let mut bytes = one_mesh(|_, _, _| {});
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap());
    bytes.splice(20 + length as usize..20 + length as usize, [0; 4]);
    for (at, word) in [(8, None), (12, Some(length + 4))] {
        let old = u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let word = word.unwrap_or(old + 4).to_le_bytes();
        bytes[at..at + 4].copy_from_slice(&word);
    }
    let mut document = open(&bytes);
    random_orders(&mut document, 1);
    let moved = written(&document);
    assert_eq!(moved.len(), bytes.len());
    assert_eq!(moved[..24 + length as usize], bytes[..24 + length as usize]);
}
