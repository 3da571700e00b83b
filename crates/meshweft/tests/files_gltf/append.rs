//! What is added to a glTF, and that all that was there keeps its bytes and its number.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::attribute::{Attribute, Semantic};
use meshweft::files::{Document, Edit, Format, NewMesh, NewValue, NewVertices};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U16, faces, glb};
use crate::data::scenes;
use crate::random_orders;
use crate::reader::Reader;

type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Every other face of mesh `mesh`, over its vertices.
fn half(document: &Document, mesh: usize) -> Vec<[u32; 3]> {
    let faces = document.meshes()[mesh].mesh.faces();
    faces.iter().copied().step_by(2).collect()
}

fn append(document: &mut Document, meshes: &[NewMesh<'_>], values: &[NewValue<'_>]) {
    document.edit(Edit::Append { meshes, values }).unwrap();
}

/// Whether all of `old` is in `new` at its place; the lengths of buffers may have grown.
pub(crate) fn is_kept(old: &Value, new: &Value, pointer: &str) -> bool {
    match (old, new) {
        (Value::Array(old), Value::Array(new)) => {
            let pairs = old.iter().zip(new).enumerate();
            old.len() <= new.len()
                && pairs
                    .into_iter()
                    .all(|(i, (old, new))| is_kept(old, new, &format!("{pointer}/{i}")))
        }
        (Value::Object(old), Value::Object(new)) => old.iter().all(|(name, old)| {
            let new = new.get(name);
            new.is_some_and(|new| is_kept(old, new, &format!("{pointer}/{name}")))
        }),
        _ if pointer.starts_with("/buffers/") && pointer.ends_with("/byteLength") => {
            old.as_u64() <= new.as_u64()
        }
        // The data of a buffer in the text grows with it.
        (Value::String(old), Value::String(new)) if pointer.ends_with("/uri") => {
            let whole = old.trim_end_matches('=').len() / 4 * 4;
            new.starts_with(&old[..whole])
        }
        _ => old == new,
    }
}

/// The text without what was added: every byte of the old one comes, in its order.
pub(crate) fn is_inserted(old: &[u8], new: &[u8]) -> bool {
    let mut left = old.iter().filter(|byte| !byte.is_ascii_digit()).peekable();
    for byte in new {
        left.next_if_eq(&byte);
    }
    left.all(u8::is_ascii_whitespace)
}

#[test]
fn scenes_keep_their_bytes_and_draw_one_mesh_more() {
    let (mut ran, mut left) = (0, 0);
    for path in scenes() {
        let name = path.display();
        let mut document = Document::open(&path, Limits::default()).unwrap();
        if document.meshes().is_empty() {
            left += 1;
            continue;
        }
        ran += 1;
        let file_name = Path::new(path.file_name().unwrap());
        let before: Files = document.to_bytes(file_name).unwrap().into_iter().collect();

        let faces = half(&document, 0);
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let attributes = [Attribute::of_vertices(Semantic::Position, &corners)];
        let meshes = [
            NewMesh::new("half", NewVertices::Shared(0), &faces),
            NewMesh::new("triangle", NewVertices::Stored(&attributes), &[[0, 1, 2]]),
        ];
        append(&mut document, &meshes, &[]);
        let after: Files = document.to_bytes(file_name).unwrap().into_iter().collect();

        // The text, and the buffers.
        let folder = std::env::temp_dir().join(format!("meshweft-append-{}", std::process::id()));
        let [old, new] = [("old", &before), ("new", &after)].map(|(sub, files)| {
            for (relative, bytes) in files {
                let target = folder.join(sub).join(relative);
                std::fs::create_dir_all(target.parent().unwrap()).unwrap();
                std::fs::write(target, bytes).unwrap();
            }
            Reader::of_file(&folder.join(sub).join(file_name), None)
        });
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(is_kept(&old.json, &new.json, ""), "{name}");
        let is_embedded = old.json_text.windows(6).any(|text| text == b"\"data:");
        assert!(
            is_embedded || is_inserted(&old.json_text, &new.json_text),
            "{name}"
        );
        for (old, new) in old.buffers.iter().zip(&new.buffers) {
            let (Some(old), Some(new)) = (old, new) else {
                continue;
            };
            assert!(new.starts_with(old), "{name}");
        }
        for (relative, bytes) in &before {
            assert!(
                Path::new(relative) == file_name || after[relative].starts_with(bytes),
                "{name}"
            );
        }

        // The triangles.
        let (old, new) = (old.triangles(), new.triangles());
        assert!(new.starts_with(&old), "{name}");
        assert_eq!(new.len(), old.len() + 2, "{name}");
        assert_eq!(new[old.len()].len(), faces.len(), "{name}");

        // The document is what a reader of the new file sees, and can be ordered.
        let main = after[file_name].clone();
        let reopened = |main: Vec<u8>, after: &Files| {
            let beside = meshweft::files::Surroundings::Memory(after);
            let format = document.format();
            Document::from_bytes_in(main, format, file_name, beside, Limits::default()).unwrap()
        };
        assert_eq!(reopened(main, &after).meshes(), document.meshes(), "{name}");
        random_orders(&mut document, 5);
        assert_eq!(document.meshes().last().unwrap().mesh.face_count(), 1);
    }
    println!("ran {ran} scenes; skipped {left} without a mesh that can be shared");
}

/// A scene of one mesh at one node, with a buffer as `buffer` says.
fn scene(others: &Value) -> (Builder, Value) {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 9);
    let weights = builder.data(F32, "VEC3", 9);
    let indices = builder.indices(U16, &faces(8, 9));
    let outline = builder.indices(U16, &[0, 1, 1, 2]);
    let meshes = json!([{
        "primitives": [{
            "attributes": {"POSITION": position}, "targets": [{"POSITION": weights}],
            "indices": indices, "material": 3, "extras": 1,
            "extensions": {
                "KHR_materials_variants": {"mappings": []},
                "CESIUM_primitive_outline": {"indices": outline},
            },
        }],
        "weights": [0.5],
    }]);
    let json = builder.json(&meshes, others);
    (builder, json)
}

fn open(json: &Value, binary: Option<&[u8]>) -> Document {
    let bytes = glb(&json.to_string(), binary);
    Document::from_bytes(bytes, Format::Glb, "test.glb".as_ref(), Limits::default()).unwrap()
}

fn json_of(document: &Document) -> Value {
    let bytes = document.to_main_bytes().unwrap();
    Reader::of_file(document.path(), Some(bytes)).json
}

fn append_half(document: &mut Document) -> Value {
    let faces = half(document, 0);
    let mesh = NewMesh::new("half", NewVertices::Shared(0), &faces);
    append(document, &[mesh], &[]);
    json_of(document)
}

#[test]
fn shared_vertices_bring_their_material_and_their_place() {
    let others =
        json!({"nodes": [{}, {"mesh": 0}, {"children": [1]}], "scenes": [{}, {"nodes": [2]}]});
    let (builder, json) = scene(&others);
    let mut document = open(&json, Some(&builder.binary));
    let json = append_half(&mut document);
    assert_eq!(
        json["meshes"][1],
        json!({
            "name": "half", "weights": [0.5],
            "primitives": [{
                "attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}], "material": 3,
                "extensions": {"KHR_materials_variants": {"mappings": []}}, "indices": 4, "mode": 4,
            }],
        })
    );
    assert_eq!(json["nodes"][1], json!({"mesh": 0, "children": [3]}));
    assert_eq!(json["nodes"][3], json!({"mesh": 1, "name": "half"}));
    assert_eq!(
        document.meshes()[0].vertex_group,
        document.meshes()[1].vertex_group
    );
}

#[test]
fn a_new_mesh_is_drawn_in_every_kind_of_scene() {
    for (others, expected) in [
        // Nothing is drawn at all.
        (
            json!({}),
            json!({"scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 1, "name": "half"}]}),
        ),
        // A node that no scene shows, and a scene that the file names.
        (
            json!({"scene": 1, "nodes": [{"mesh": 0}], "scenes": [{}, {"nodes": []}]}),
            json!({"scene": 1, "scenes": [{}, {"nodes": [1]}]}),
        ),
        // The default scene is asked first.
        (
            json!({"scene": 1, "nodes": [{"mesh": 0}, {"mesh": 0}], "scenes": [{"nodes": [0]}, {"nodes": [1]}]}),
            json!({"nodes": [{"mesh": 0}, {"mesh": 0, "children": [2]}, {"mesh": 1, "name": "half"}]}),
        ),
        // A skin takes the mesh along, and stands at the root.
        (
            json!({"nodes": [{"children": [1]}, {"mesh": 0, "skin": 4}], "scenes": [{"nodes": [0]}]}),
            json!({
                "scenes": [{"nodes": [0, 2]}],
                "nodes": [{"children": [1]}, {"mesh": 0, "skin": 4}, {"mesh": 1, "name": "half", "skin": 4}],
            }),
        ),
        // A node below itself.
        (
            json!({"nodes": [{"children": [0, 1]}, {"mesh": 0}], "scenes": [{"nodes": [0, 9]}]}),
            json!({"nodes": [{"children": [0, 1]}, {"mesh": 0, "children": [2]}, {"mesh": 1, "name": "half"}]}),
        ),
    ] {
        let (builder, json) = scene(&others);
        let json = append_half(&mut open(&json, Some(&builder.binary)));
        for (name, value) in expected.as_object().unwrap() {
            assert_eq!(&json[name], value, "{others}");
        }
    }
}

#[test]
fn new_bytes_find_a_buffer_in_every_kind_of_file() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let attributes = [Attribute::of_vertices(Semantic::Position, &corners)];
    let vertices = NewVertices::Stored(&attributes);
    let mesh = NewMesh::new("new", vertices, &[[0, 1, 2]]);
    let (builder, named) = scene(&json!({}));
    let without = json!({"asset": {"version": "2.0"}});
    let data = "data:;base64,AAAAAAA=";
    let embedded =
        json!({"asset": {"version": "2.0"}, "buffers": [{"uri": data, "byteLength": 5}]});
    for (json, binary, buffer, start) in [
        (
            &named,
            Some(&builder.binary[..]),
            json!({"byteLength": builder.binary.len() + 44}),
            builder.binary.len(),
        ),
        (&without, None, json!({"byteLength": 44}), 0),
        // A chunk that no buffer stands for.
        (
            &without,
            Some(&b"12345678"[..]),
            json!({"byteLength": 52}),
            8,
        ),
        (&embedded, None, json!(44), 0),
    ] {
        let mut document = open(json, binary);
        append(&mut document, &[mesh], &[]);
        let bytes = document.to_main_bytes().unwrap();
        let reader = Reader::of_file(document.path(), Some(bytes.clone()));
        match buffer.as_u64() {
            // A GLB does not change a buffer in its text: it gets one more.
            Some(length) => assert_eq!(reader.json["buffers"][1]["byteLength"], length),
            None => assert_eq!(reader.json["buffers"][0], buffer),
        }
        let views = reader.json["bufferViews"].as_array().unwrap();
        assert_eq!(views[views.len() - 2]["byteOffset"], start);
        let again = Document::from_bytes(bytes, Format::Glb, document.path(), Limits::default());
        let again = again.unwrap();
        let last = again.meshes().len().checked_sub(1);
        // What stands in the text of a GLB is not offered, and that is said.
        match last {
            Some(last) => assert_eq!(again.positions(last).unwrap().unwrap(), corners),
            None => assert!(
                again.notes()[0].text.contains("binary chunk"),
                "{:?}",
                again.notes()
            ),
        }
    }

    // Text: the last buffer grows.
    let text = embedded.to_string().into_bytes();
    let name = Path::new("test.gltf");
    let mut document = Document::from_bytes(text, Format::Gltf, name, Limits::default()).unwrap();
    append(&mut document, &[mesh], &[]);
    assert_eq!(document.positions(0).unwrap().unwrap(), corners);
    let reader = Reader::of_file(name, Some(document.to_main_bytes().unwrap()));
    assert_eq!(reader.json["buffers"].as_array().unwrap().len(), 1);
    assert_eq!(reader.json["buffers"][0]["byteLength"], 8 + 44);
    assert!(reader.buffers[0].as_ref().unwrap().starts_with(&[0; 8]));
}

#[test]
fn what_cannot_be_added_changes_nothing() {
    let (builder, json) = scene(&json!({}));
    let mut document = open(&json, Some(&builder.binary));
    let before = (document.to_main_bytes().unwrap(), document.notes().to_vec());
    let shared = |faces| NewMesh::new("new", NewVertices::Shared(0), faces);
    let broken = r#"{"primitives": [{"attributes": {"POSITION": 99}}]}"#;
    let meshes: [(&[NewMesh<'_>], &[NewValue<'_>], &str); 6] = [
        (
            &[shared(&[[0, 1, 9]])],
            &[],
            "face 0, corner 2: index 9 is past the last vertex (8)",
        ),
        (&[shared(&[])], &[], "mesh 0, \"new\": it has no faces"),
        (
            &[NewMesh::new("", NewVertices::Shared(1), &[[0, 1, 2]])],
            &[],
            "the vertices of mesh 1 cannot be shared",
        ),
        (
            &[NewMesh::new("", NewVertices::Stored(&[]), &[[0, 1, 2]])],
            &[],
            "POSITION",
        ),
        (
            &[shared(&[[0, 1, 2]])],
            &[NewValue {
                pointer: "/asset",
                json: "1",
            }],
            "/asset: there is a value",
        ),
        // Found only when the whole is looked at.
        (
            &[shared(&[[0, 1, 2]])],
            &[NewValue {
                pointer: "/meshes/-",
                json: broken,
            }],
            "there is no accessor 99",
        ),
    ];
    for (meshes, values, expected) in meshes {
        let error = document
            .edit(Edit::Append { meshes, values })
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(
            (document.to_main_bytes().unwrap(), document.notes().to_vec()),
            before
        );
        assert_eq!(document.meshes().len(), 1);
    }

    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec();
    let mut document =
        Document::from_bytes(obj, Format::Obj, "a.obj".as_ref(), Limits::default()).unwrap();
    let refused = document
        .edit(Edit::Append {
            meshes: &[],
            values: &[],
        })
        .unwrap_err();
    assert_eq!(
        refused.to_string(),
        "a.obj: meshes can be added to .gltf and .glb files only"
    );
}

#[test]
fn a_mesh_with_an_extension_of_our_own_stays_until_it_is_known() {
    let others = json!({"nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]});
    for pointer in [
        "/extensions/MESHWEFT_test",
        "/nodes/0/extensions/MESHWEFT_test",
        "/meshes/0/extensions/MESHWEFT_test",
        "/meshes/0/primitives/0/extensions/MESHWEFT_test",
        "/accessors/0/extensions/MESHWEFT_test",
        "/bufferViews/2/extensions/MESHWEFT_test",
        "/buffers/0/extensions/MESHWEFT_test",
    ] {
        let (builder, json) = scene(&others);
        let mut document = open(&json, Some(&builder.binary));
        let used = NewValue {
            pointer: "/extensionsUsed/-",
            json: "\"MESHWEFT_test\"",
        };
        append(
            &mut document,
            &[],
            &[
                NewValue {
                    pointer,
                    json: "{}",
                },
                used,
            ],
        );
        assert!(document.meshes().is_empty(), "{pointer}");
        let note = &document.notes()[0].text;
        assert!(
            note.starts_with("left as it is: the extension MESHWEFT_test goes with"),
            "{note}"
        );
        assert!(
            note.contains("use the version of meshweft that wrote it"),
            "{note}"
        );

        // The caller may vouch for it.
        let mut options = meshweft::files::ReadOptions::default();
        options.assume_order_safe.push("MESHWEFT_test".into());
        let bytes = document.to_main_bytes().unwrap();
        let vouched = Document::from_bytes(bytes, Format::Glb, document.path(), options).unwrap();
        assert_eq!(vouched.meshes().len(), 1, "{pointer}");
    }
}
