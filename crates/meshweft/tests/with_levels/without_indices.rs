//! Levels of a mesh without an index list: copies of its vertices, with all that is stored with them.

use std::collections::BTreeSet;

use meshweft::attribute::AttributeInfo;
use meshweft::files::{Document, Edit, FileErrorKind, NewLevel, NewLevels};
use meshweft::operations::{Options, levels, optimize};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U8, glb};
use crate::made::open;
use crate::written::{assert_in_bands, assert_whole, json_of, options, with_levels};

const SIDE: usize = 12;

/// The corners of a sheet's faces, each as its column and row.
fn corners() -> Vec<[usize; 2]> {
    let squares = (0..SIDE * SIDE).map(|square| [square % SIDE, square / SIDE]);
    let corners = squares.flat_map(|[x, y]| {
        let [right, above, both] = [[x + 1, y], [x, y + 1], [x + 1, y + 1]];
        [[x, y], right, above, right, both, above]
    });
    corners.collect()
}

/// A sheet without indices: positions, colours of three bytes, and three morph targets, of which two are the same. `add` may add
/// attributes.
fn sheet(add: impl FnOnce(&mut Builder, &mut Value, usize)) -> Vec<u8> {
    let corners = corners();
    let count = corners.len();
    let mut builder = Builder::default();
    let floats = |of_corner: &dyn Fn(f32, f32) -> [f32; 3]| -> Vec<u8> {
        let all = corners
            .iter()
            .flat_map(|&[x, y]| of_corner(x as f32, y as f32));
        all.flat_map(f32::to_le_bytes).collect()
    };
    let vec3 = |builder: &mut Builder, bytes: &[u8]| {
        let view = builder.view(bytes, None);
        builder.accessor(view, 0, F32, count, "VEC3")
    };

    let bytes = floats(&|x, y| [x, y, (0.9 * x).sin() * (0.4 * y).cos()]);
    let position = vec3(&mut builder, &bytes);
    builder.accessors[position]["min"] = json!([0, 0, -1]);
    builder.accessors[position]["max"] = json!([SIDE, SIDE, 1]);
    let colours = corners
        .iter()
        .flat_map(|&[x, y]| [[x, y, x + y], [0; 3]])
        .flatten()
        .map(|byte| u8::try_from(byte).unwrap());
    let view = builder.view(&colours.collect::<Vec<u8>>(), Some(6));
    let colour = builder.accessor(view, 0, U8, count, "VEC3");
    builder.accessors[colour]["normalized"] = json!(true);
    let bytes = floats(&|x, y| [0.0, 0.125 * x, 0.25 * y]);
    let moved = vec3(&mut builder, &bytes);

    let mut attributes = json!({"POSITION": position, "COLOR_0": colour});
    add(&mut builder, &mut attributes, count);

    let primitive = json!({
        "attributes": attributes,
        "targets": [{"POSITION": moved}, {}, {"POSITION": moved}],
    });
    let meshes = json!([{"name": "sheet", "primitives": [primitive], "weights": [0.5, 0, 0.25]}]);
    let others = json!({"nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]});
    glb(
        &builder.json(&meshes, &others).to_string(),
        Some(&builder.binary),
    )
}

fn whole(value: &Value) -> usize {
    usize::try_from(value.as_u64().unwrap()).unwrap()
}

/// What is stored with each vertex of a mesh, as text: the values of its attributes.
fn vertices(document: &Document, mesh: usize, infos: &[AttributeInfo]) -> Vec<String> {
    let mut texts = vec![String::new(); document.meshes()[mesh].mesh.vertex_count()];
    for info in infos {
        let values = document.attribute(mesh, info).unwrap().to_f32();
        for (text, element) in texts.iter_mut().zip(values.chunks(info.components)) {
            *text += &format!("{element:?}");
        }
    }
    texts
}

#[test]
fn levels_have_copies_of_vertices_with_all_that_is_stored() {
    let bytes = sheet(|_, _, _| {});
    let source = open(&bytes);
    let (written, report) = with_levels(&bytes, &options(&[0.5, 0.2]));
    let mut document = open(&written);
    assert_eq!(document.meshes().len(), 3);
    assert_whole(&document, SIDE as f32);

    // The same is stored with each copy.
    let infos = source.attributes(0);
    assert_eq!(infos.len(), 4);
    let stored = vertices(&source, 0, &infos);
    let stored: BTreeSet<&String> = stored.iter().collect();
    let json = json_of(&written);
    for mesh in 1..3 {
        assert_eq!(document.attributes(mesh), infos);
        let copies = vertices(&document, mesh, &infos);
        assert!(copies.iter().all(|vertex| stored.contains(vertex)));
        let distinct: BTreeSet<&String> = copies.iter().collect();
        assert_eq!(distinct.len(), copies.len(), "none is there twice");
        assert!(copies.len() < (SIDE + 1).pow(2));

        // Whether it is bounded, and has targets, is as it was; bounds are its own.
        let primitive = &json["meshes"][mesh]["primitives"][0];
        let targets = &primitive["targets"];
        assert_eq!((&targets[1], &targets[2]), (&json!({}), &targets[0]));
        let accessor = whole(&primitive["attributes"]["POSITION"]);
        let positions = document.positions(mesh).unwrap().unwrap();
        let largest = positions.iter().map(|it| it[2]).fold(f32::MIN, f32::max);
        let said = &json["accessors"][accessor]["max"];
        let said = [0, 1, 2].map(|axis| said[axis].as_f64().unwrap());
        assert_eq!(said[..2], [SIDE as f64; 2]);
        assert!((said[2] - f64::from(largest)).abs() < 1e-12);
        let colour = &json["accessors"][whole(&primitive["attributes"]["COLOR_0"])];
        assert_eq!(
            (&colour["normalized"], &colour["max"]),
            (&json!(true), &Value::Null)
        );
        let view = whole(&colour["bufferView"]);
        assert_eq!(json["bufferViews"][view]["byteStride"], json!(4));
    }

    // The report counts copies, and says so.
    let copied = document.meshes()[1].mesh.vertex_count();
    assert_eq!(report.levels[1].counts.used_vertices, copied);
    assert!(report.levels[1].counts.overfetch < 1.2);
    let said = format!(
        "sheet: it has no index list, so its levels have copies of {copied} of its 864 vertices"
    );
    assert!(report.of_file.notes.iter().any(|note| note.text == said));
    let said = |mesh: usize| {
        let level = &json["meshes"][mesh]["extras"]["MESHWEFT_level"];
        whole(&level["vertices"][0])
    };
    assert_eq!(
        [said(1), said(2)],
        [1, 2].map(|level| report.levels[level].counts.used_vertices)
    );

    // Ordered, they stay levels.
    optimize(&mut document, &Options::default(), &()).unwrap();
    assert_in_bands(&document);
    assert_whole(&document, SIDE as f32);
}

#[test]
fn what_cannot_be_copied_stays_as_it_is() {
    let bytes = sheet(|builder, attributes, count| {
        let view = builder.view(&vec![0; 64 * count], None);
        attributes["_FRAME"] = builder.accessor(view, 0, F32, count, "MAT4").into();
    });
    let mut document = open(&bytes);
    let refused = levels(&mut document, &options(&[0.5]), &()).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "sheet.glb: no mesh gets coarser: sheet: it has no index list, and its vertices cannot be copied"
    );
    assert_eq!(document.to_main_bytes().unwrap(), bytes);
}

#[test]
fn vertices_that_are_to_stay_are_copied() {
    let mut options = options(&[0.5]);
    options.keep_vertex_order = true;
    let (written, report) = with_levels(&sheet(|_, _, _| {}), &options);
    let copied = open(&written).meshes()[1].mesh.vertex_count();
    assert_eq!(copied, report.levels[1].counts.used_vertices);
}

#[test]
fn copies_that_do_not_fit_are_refused() {
    let bytes = sheet(|_, _, _| {});
    let refused = |copies: &[u32]| {
        let mut document = open(&bytes);
        let level = NewLevel {
            faces: Some(vec![[0, 1, 2]]),
            vertices: 3,
            error: 1.0,
        };
        let meshes = [NewLevels {
            mesh: 0,
            copies: copies.to_vec(),
            levels: vec![level],
            radius: 1.0,
        }];
        let edited = document.edit(Edit::Levels { meshes: &meshes });
        let is_same = document.to_main_bytes().unwrap() == bytes;
        edited.map_err(|error| (error.kind, is_same))
    };
    refused(&[2, 0, 1]).unwrap();
    let not_all = "its copies of vertices are each to be of another one";
    let none = "it has no index list, so its levels need copies";
    for (copies, expected) in [
        (&[0, 1][..], not_all),
        (&[0, 1, 1, 2], not_all),
        (&[0, 1, 2, 864], not_all),
        (&[], none),
    ] {
        let (kind, is_same) = refused(copies).unwrap_err();
        let says =
            matches!(kind, FileErrorKind::Unsupported { feature } if feature.starts_with(expected));
        assert!(says && is_same, "{copies:?}");
    }
}
