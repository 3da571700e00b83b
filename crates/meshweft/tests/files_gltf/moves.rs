//! Orders applied to built files: the same triangles, and the same bytes everywhere else.

use std::path::Path;

use meshweft::files::{Document, Edit, FileErrorKind, Format, Place, ReadOptions};
use meshweft::{FaceOrder, Limits, VertexOrder};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U8, U16, U32, faces};
use crate::reader::Reader;
use crate::{Random, random_orders};

pub(crate) fn open(bytes: &[u8]) -> Document {
    let path = Path::new("scene.glb");
    Document::from_bytes(bytes.to_vec(), Format::Glb, path, Limits::default()).unwrap()
}

pub(crate) fn reader(bytes: &[u8]) -> Reader {
    Reader::of_file(Path::new("scene.glb"), Some(bytes.to_vec()))
}

pub(crate) fn written(document: &Document) -> Vec<u8> {
    document.to_main_bytes().unwrap()
}

/// Every note as its pointer and text.
pub(crate) fn notes(document: &Document) -> Vec<String> {
    let notes = document.notes().iter();
    notes
        .map(|note| match &note.place {
            Place::Json(pointer) => format!("{pointer}: {}", note.text),
            place => panic!("{place:?}"),
        })
        .collect()
}

/// Applies random orders several times and compares all that must not change.
pub(crate) fn check(bytes: &[u8]) {
    let before = reader(bytes);
    let mut document = open(bytes);
    assert_eq!(written(&document), bytes);
    for seed in 0..5 {
        random_orders(&mut document, seed);
        let moved = written(&document);
        let after = reader(&moved);
        assert!(before.triangles() == after.triangles(), "seed {seed}");
        assert_eq!(before.json_text, after.json_text);
        assert_eq!(before.outlines(), after.outlines());
        let is_other = |primitive: &Value| primitive["mode"].as_u64().unwrap_or(4) != 4;
        assert!(before.drawn_in_order(is_other) == after.drawn_in_order(is_other));
        let is_record = before.record_bytes();
        let start = 12 + 8 + before.json_text.len() + 8;
        assert_eq!(moved.len(), bytes.len());
        let mut changed = 0;
        for (position, (old, new)) in bytes.iter().zip(&moved).enumerate() {
            let in_binary = position.checked_sub(start).and_then(|i| is_record.get(i));
            match in_binary {
                Some(true) => changed += usize::from(old != new),
                _ => assert_eq!(old, new, "byte {position}"),
            }
        }
        assert!(changed > 0);
        let again = open(&moved);
        assert_eq!(again.meshes(), document.meshes());
        assert_eq!(again.notes(), document.notes());
    }
}

#[test]
fn everything_that_hangs_on_a_vertex_moves_with_it() {
    let count = 50;
    let mut builder = Builder::default();
    // Positions, normals, joints and weights interleaved, with four bytes of nobody's between.
    let bytes: Vec<u8> = (0..count * 40)
        .map(|i| u8::try_from((i * 31 + i / 40) % 119).unwrap())
        .collect();
    let view = builder.view(&bytes, Some(40));
    let position = builder.accessor(view, 0, F32, count, "VEC3");
    let normal = builder.accessor(view, 12, 5120, count, "VEC3");
    let joints = builder.accessor(view, 20, U8, count, "VEC4");
    let weights = builder.accessor(view, 24, F32, count, "VEC4");
    let custom = builder.data(U16, "SCALAR", count);
    let first_target = builder.data(F32, "VEC3", count);
    let second_target = builder.data(5120, "VEC3", count);
    let numbers = faces(80, count);
    let indices = builder.indices(U16, &numbers);
    builder.accessors[indices]["min"] = json!([0]);
    builder.accessors[indices]["max"] = json!([count - 1]);
    let edges: Vec<usize> = (0..60).map(|i| i * 11 % count).collect();
    let outline = builder.indices(U32, &edges);
    let matrices = builder.data(F32, "VEC4", 4);
    builder.accessors[matrices]["count"] = json!(1);
    builder.accessors[matrices]["type"] = json!("MAT4");
    // A morph target that moves nothing has no bytes.
    builder
        .accessors
        .push(json!({"componentType": F32, "count": count, "type": "VEC3"}));
    let zeros = builder.accessors.len() - 1;
    let bytes = builder.glb(
        &json!([{
            "name": "figure", "weights": [0.50, 1e-3], "extras": {"targetNames": ["a", "b"]},
            "primitives": [{
                "attributes": {"POSITION": position, "NORMAL": normal, "JOINTS_0": joints,
                    "WEIGHTS_0": weights, "_CUSTOM": custom},
                "targets": [{"POSITION": first_target, "NORMAL": second_target},
                    {"POSITION": zeros}],
                "indices": indices, "extras": {"a": 1.0},
                "extensions": {"CESIUM_primitive_outline": {"indices": outline},
                    "KHR_materials_variants": {"mappings": []}},
            }],
        }]),
        &json!({"skins": [{"joints": [0], "inverseBindMatrices": matrices}],
            "nodes": [{"mesh": 0, "skin": 0}], "extensionsUsed": ["CESIUM_primitive_outline"]}),
    );
    let document = open(&bytes);
    let entry = &document.meshes()[0];
    assert_eq!(entry.name, "figure");
    assert_eq!(
        (entry.mesh.vertex_count(), entry.mesh.face_count()),
        (50, 80)
    );
    assert_eq!(document.positions(0).unwrap().unwrap().len(), 50);
    assert!(entry.vertices_movable && entry.corners_turnable);
    assert_eq!(notes(&document), [""; 0]);
    check(&bytes);
}

#[test]
fn every_index_type_stays_what_it_is() {
    for component in [U8, U16, U32] {
        let mut builder = Builder::default();
        let position = builder.data(F32, "VEC3", 30);
        let indices = builder.indices(component, &faces(40, 30));
        let primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
        check(&builder.glb(&json!([{"primitives": [primitive]}]), &json!({})));
    }
}

#[test]
fn faces_without_indices_move_their_vertices() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 30);
    let color = builder.data(U8, "VEC4", 30);
    let primitive = json!({"attributes": {"POSITION": position, "COLOR_0": color}, "mode": 4});
    let meshes = json!([{"primitives": [primitive, primitive]}]);
    let bytes = builder.glb(&meshes, &json!({}));
    check(&bytes);
    let mut document = open(&bytes);
    assert_eq!(document.meshes().len(), 1);
    let entry = &document.meshes()[0];
    assert_eq!(entry.name, "mesh 0, primitive 0");
    assert!(!entry.vertices_movable);
    assert_eq!(entry.mesh.faces()[1], [3, 4, 5]);
    let positions = document.positions(0).unwrap().unwrap();
    let order = Random(1).face_order(10);
    document.edit(Edit::order(0, &order, None)).unwrap();
    assert_eq!(document.meshes()[0].mesh.faces()[1], [3, 4, 5]);
    let moved = document.positions(0).unwrap().unwrap();
    let rotation = usize::from(order.rotation(0));
    let from = 3 * order.new_to_old()[0] as usize;
    assert_eq!(moved[0], positions[from + rotation]);
}

#[test]
fn primitives_that_share_data_are_one_group() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 20);
    let first_normal = builder.data(F32, "VEC3", 20);
    let second_normal = builder.data(F32, "VEC3", 20);
    let other = builder.data(F32, "VEC3", 20);
    let shared = builder.indices(U16, &faces(12, 20));
    let own = builder.indices(U8, &faces(5, 20));
    let lonely = builder.indices(U8, &faces(5, 20));
    // The same bytes under another number are the same data.
    let mut twin = builder.accessors[position].clone();
    twin["name"] = json!("twin");
    builder.accessors.push(twin);
    let twin = builder.accessors.len() - 1;
    let bytes = builder.glb(
        &json!([
            {"primitives": [
                {"attributes": {"POSITION": position, "NORMAL": first_normal}, "indices": shared},
                {"attributes": {"POSITION": twin, "NORMAL": second_normal}, "indices": shared},
            ]},
            {"name": "b", "primitives": [{"attributes": {"POSITION": position}, "indices": own}]},
            {"name": "c", "primitives": [{"attributes": {"POSITION": other}, "indices": lonely}]},
        ]),
        &json!({}),
    );
    let document = open(&bytes);
    let meshes = document.meshes();
    let names: Vec<&str> = meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    assert_eq!(names, ["mesh 0, primitive 0", "b", "c"]);
    let groups: Vec<usize> = meshes.iter().map(|mesh| mesh.vertex_group).collect();
    assert_eq!(groups, [0, 0, 1]);
    assert!(meshes.iter().all(|mesh| mesh.vertices_movable));
    check(&bytes);
}

#[test]
fn an_order_and_its_inverse_give_the_first_bytes() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 20);
    let indices = builder.indices(U16, &faces(12, 20));
    let primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
    let bytes = builder.glb(&json!([{"primitives": [primitive]}]), &json!({}));
    let mut document = open(&bytes);
    let mut random = Random(4);
    let (faces, vertices) = (random.permutation(12), random.permutation(20));
    let (back, inverse) = (faces.inverse(), vertices.inverse());
    let orders = [(faces, vertices), (back, inverse)];
    for (faces, vertices) in orders {
        let vertices = VertexOrder::from(vertices);
        document
            .edit(Edit::order(0, &FaceOrder::from(faces), &vertices))
            .unwrap();
    }
    assert_eq!(written(&document), bytes);
}

/// A scene of 20 vertices and 12 faces whose primitive and root are changed by the caller.
pub(crate) fn one_mesh(change: impl FnOnce(&mut Builder, &mut Value, &mut Value)) -> Vec<u8> {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 20);
    let indices = builder.indices(U16, &faces(12, 20));
    let mut primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
    let mut root = json!({});
    change(&mut builder, &mut primitive, &mut root);
    let mut primitives = vec![primitive];
    if let Some(more) = root.as_object_mut().unwrap().remove("more") {
        primitives.push(more);
    }
    builder.glb(&json!([{"primitives": primitives}]), &root)
}

#[test]
fn vertices_stay_where_something_else_counts_on_them() {
    type Change = fn(&mut Builder, &mut Value, &mut Value);
    let cases: [(&str, Change); 11] = [
        (
            "/accessors/1: the vertices stay where they are: the JSON states the smallest and \
             largest index, and they would change",
            |builder, primitive, _| {
                let position = builder.data(F32, "VEC3", 21);
                primitive["attributes"]["POSITION"] = json!(position);
                builder.accessors[1]["max"] = json!([19]);
            },
        ),
        (
            "/accessors/0: the vertices stay where they are: the numbers of its sparse elements do \
             not rise, or reach too far",
            |builder, _, _| {
                let view = builder.view(&[5, 0, 3, 0], None);
                let values = builder.view(&[7; 24], None);
                builder.accessors[0]["sparse"] = json!({"count": 2,
                    "indices": {"bufferView": view, "componentType": U16},
                    "values": {"bufferView": values}});
            },
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
             /animations/0",
            |_, _, root| root["animations"] = json!([{"samplers": [{"input": 0, "output": 0}]}]),
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
             /skins/0",
            |_, _, root| root["skins"] = json!([{"inverseBindMatrices": 0}]),
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
             /nodes/0",
            |_, _, root| {
                root["nodes"] = json!([{"extensions":
                    {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}]);
            },
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
             /images/0",
            |_, _, root| root["images"] = json!([{"bufferView": 0}]),
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
             /bufferViews/2",
            |builder, _, _| {
                let view = json!({"buffer": 0, "byteOffset": 100, "byteLength": 4});
                builder.views.push(view);
            },
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
             /accessors/2",
            |builder, _, _| {
                builder.accessor(0, 8, U8, 2, "SCALAR");
            },
        ),
        (
            "/accessors/0: the vertices stay where they are: the extension FANCY_numbers is not \
             known and may depend on their order",
            |builder, _, _| builder.views[0]["extensions"] = json!({"FANCY_numbers": {}}),
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: EXT_mesh_features \
             identifies features by their numbers",
            |_, primitive, _| {
                primitive["extensions"] =
                    json!({"EXT_mesh_features": {"featureIds": [{"featureCount": 20}]}});
            },
        ),
        (
            "/meshes/0/primitives/0: the vertices stay where they are: 8-bit indices do not \
             reach all 300 of them",
            |builder, primitive, _| {
                let position = builder.data(F32, "VEC3", 300);
                let indices = builder.indices(U8, &faces(12, 20));
                *primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
                builder.accessors.drain(..2);
                primitive["attributes"]["POSITION"] = json!(0);
                primitive["indices"] = json!(1);
            },
        ),
    ];
    for (expected, change) in cases {
        let bytes = one_mesh(change);
        let document = open(&bytes);
        assert_eq!(notes(&document), [expected]);
        assert!(!document.meshes()[0].vertices_movable);
        check(&bytes);
    }
}

#[test]
fn sparse_elements_follow_their_vertices() {
    let count = 40;
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", count);
    let mut sparse = |base: Option<usize>, indices: &[usize], view: Option<usize>| {
        let accessor = base.unwrap_or_else(|| {
            builder
                .accessors
                .push(json!({"componentType": F32, "count": count, "type": "VEC3"}));
            builder.accessors.len() - 1
        });
        let bytes: Vec<u8> = indices.iter().map(|&i| u8::try_from(i).unwrap()).collect();
        let view = view.unwrap_or_else(|| builder.view(&bytes, None));
        let values: Vec<u8> = (0..indices.len() * 12)
            .map(|i| u8::try_from(1 + (i + accessor * 17) % 110).unwrap())
            .collect();
        let values = builder.view(&values, None);
        builder.accessors[accessor]["sparse"] = json!({"count": indices.len(),
            "indices": {"bufferView": view, "componentType": U8},
            "values": {"bufferView": values}});
        (accessor, view)
    };
    // Over a base, over zeros, two with the same numbers, one with none.
    let (base, _) = sparse(Some(position), &[0, 3, 4, 39], None);
    let (zeros, numbers) = sparse(None, &[7, 8, 21, 30, 31], None);
    let (shared, _) = sparse(None, &[7, 8, 21, 30, 31], Some(numbers));
    let (empty, _) = sparse(None, &[], None);
    assert_eq!(base, position);
    let indices = builder.indices(U16, &faces(60, count));
    let other = builder.indices(U16, &faces(44, count));
    let targets = json!([{"POSITION": zeros, "NORMAL": shared}, {"POSITION": empty}]);
    let bytes = builder.glb(
        &json!([{"primitives": [
            {"attributes": {"POSITION": position}, "targets": targets, "indices": indices},
            {"attributes": {"POSITION": position}, "targets": targets, "indices": other},
        ]}]),
        &json!({"animations": [{"samplers": [], "channels": [{"sampler": 0, "target": {
            "path": "pointer",
            "extensions": {"KHR_animation_pointer": {"pointer": "/meshes/0/weights"}}}}]}]}),
    );
    let document = open(&bytes);
    assert_eq!(notes(&document), [""; 0]);
    assert!(document.meshes().iter().all(|mesh| mesh.vertices_movable));
    check(&bytes);
    // Each triangle has its sparse values with it: the reader puts them in, so equal triangles say
    // so, and the numbers rise.
    let mut document = open(&bytes);
    random_orders(&mut document, 7);
    let after = reader(&written(&document));
    let view = &after.json["bufferViews"][numbers];
    let start = usize::try_from(view["byteOffset"].as_u64().unwrap()).unwrap();
    let numbers = &after.buffers[0].as_ref().unwrap()[start..start + 5];
    assert!(numbers.is_sorted() && *numbers != [7, 8, 21, 30, 31]);
    // The positions of the mesh are those with the sparse ones put in.
    let positions = document.positions(0).unwrap().unwrap();
    let stored = after.elements(&json!(position)).unwrap();
    for (position, stored) in positions.iter().zip(stored) {
        let floats = stored
            .as_chunks::<4>()
            .0
            .iter()
            .map(|w| f32::from_le_bytes(*w));
        assert!(floats.eq(position.iter().copied()));
    }
}

#[test]
fn what_is_not_known_can_be_vouched_for_or_refused() {
    let on_primitive = one_mesh(|_, primitive, _| {
        primitive["extensions"] = json!({"FANCY_numbers": {}});
    });
    let on_view = one_mesh(|builder, _, _| {
        builder.views[0]["extensions"] = json!({"FANCY_numbers": {}});
    });
    // Another reason to stay does not hide the unknown.
    let hidden = one_mesh(|_, primitive, root| {
        primitive["extensions"] = json!({"FANCY_numbers": {}});
        root["skins"] = json!([{"inverseBindMatrices": 0}]);
    });
    for (bytes, pointer) in [
        (on_primitive, "/meshes/0/primitives/0"),
        (on_view, "/accessors/0"),
        (hidden, "/meshes/0/primitives/0"),
    ] {
        let mut options = ReadOptions::from(Limits::default());
        let read = |options: &ReadOptions| {
            let path = Path::new("scene.glb");
            Document::from_bytes(bytes.clone(), Format::Glb, path, options)
        };
        options.strict = true;
        let error = read(&options).unwrap_err();
        let FileErrorKind::Unknown { what, name } = &error.kind else {
            panic!("{error}");
        };
        assert_eq!((*what, name.as_str()), ("the extension", "FANCY_numbers"));
        assert_eq!(
            error.to_string(),
            format!(
                "scene.glb: {pointer}: the extension FANCY_numbers is not known and may depend on \
                 the order of vertices or faces"
            )
        );
        options.assume_order_safe = vec!["OTHER".into(), "FANCY_numbers".into()];
        let document = read(&options).unwrap();
        let is_pinned = document.notes().iter().any(|n| n.text.contains("/skins/0"));
        assert_eq!(document.meshes()[0].vertices_movable, !is_pinned);
    }
}

#[test]
fn primitives_are_left_where_faces_cannot_move() {
    type Change = fn(&mut Builder, &mut Value, &mut Value);
    let cases: [(&str, Change); 11] = [
        ("it has no POSITION", |_, primitive, _| {
            primitive["attributes"] = json!({"NORMAL": 0});
        }),
        (
            "it is compressed by KHR_draco_mesh_compression: decompress it first",
            |_, primitive, _| {
                primitive["extensions"] = json!({"KHR_draco_mesh_compression": {"bufferView": 0}});
            },
        ),
        (
            "FB_ngon_encoding stores polygons as runs of triangles",
            |_, primitive, _| primitive["extensions"] = json!({"FB_ngon_encoding": {}}),
        ),
        (
            "the extension FANCY_numbers is not known and may depend on the order of its faces or vertices: \
             if it does not, add it to assume_order_safe",
            |_, primitive, _| primitive["extensions"] = json!({"FANCY_numbers": {}}),
        ),
        ("its mode is not known", |_, primitive, _| {
            primitive["mode"] = json!(2_147_483_647);
            primitive["extensions"] = json!({"EXT_primitive_voxels": {"shape": 0}});
        }),
        (
            "its buffer has no uri, so its bytes are not in the file",
            |builder, _, root| {
                builder.views[0]["buffer"] = json!(1);
                let length = builder.binary.len();
                root["buffers"] = json!([{"byteLength": length}, {"byteLength": 1000}]);
            },
        ),
        ("35 indices are not three a face", |builder, _, _| {
            builder.accessors[1]["count"] = json!(35);
        }),
        (
            "its indices share bytes with /accessors/2",
            |builder, _, _| {
                builder.accessor(1, 6, U16, 6, "SCALAR");
            },
        ),
        ("its indices share bytes with /images/0", |_, _, root| {
            root["images"] = json!([{"bufferView": 1}]);
        }),
        ("its indices have no buffer view", |builder, _, _| {
            builder.accessors[1] = json!({"componentType": U32, "type": "SCALAR",
                "count": 3_000_000_000_000_u64});
        }),
        ("its POSITION has no buffer view", |builder, _, _| {
            builder.accessors[0] = json!({"componentType": F32, "type": "VEC3",
                "count": 3_000_000_000_000_u64});
        }),
    ];
    for (why, change) in cases {
        let document = open(&one_mesh(change));
        let expected = format!("/meshes/0/primitives/0: left as it is: {why}");
        assert_eq!(notes(&document), [expected]);
        assert_eq!(document.meshes().len(), 0);
    }
}

#[test]
fn what_is_left_holds_back_those_who_share_its_data() {
    // Triangles without indices over vertices that an indexed primitive reads too: neither may
    // move a vertex.
    let bytes = one_mesh(|builder, primitive, root| {
        let count = json!(18);
        builder.accessors[0]["count"] = count;
        let indices = builder.indices(U8, &faces(12, 18));
        primitive["indices"] = json!(indices);
        builder.accessors.swap_remove(1);
        primitive["indices"] = json!(1);
        root["more"] = json!({"attributes": primitive["attributes"]});
    });
    let expected = [
        "/meshes/0/primitives/0: the vertices stay where they are: they share bytes with \
         /meshes/0/primitives/1",
        "/meshes/0/primitives/1: left as it is: its vertices are also read by other primitives",
    ];
    assert_eq!(notes(&open(&bytes)), expected);
    check(&bytes);
    // Lines over the corners of triangles: the corners stay, and so do their vertices.
    let bytes = one_mesh(|_, primitive, root| {
        root["more"] = primitive.clone();
        root["more"]["mode"] = json!(1);
    });
    let expected = [
        "/meshes/0/primitives/0: left as it is: its indices are also read as something else",
        "/meshes/0/primitives/1: left as it is: it is drawn as lines",
    ];
    assert_eq!(notes(&open(&bytes)), expected);
}
