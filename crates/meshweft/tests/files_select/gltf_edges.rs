//! glTF: what is refused, and data that something else reads.

use meshweft::Limits;
use meshweft::files::{Document, Format, SelectedFace};
use serde_json::json;

use crate::builder::{Builder, F32, U8, U16, faces};
use crate::choice::Choice;
use crate::gltf::{assert_sound, parts, scene, text};
use crate::random::Random;
use crate::selection;
use crate::{assert_read_again, error, open, select, written};

fn document(builder: &Builder, meshes: &serde_json::Value, others: &serde_json::Value) -> Document {
    open(&builder.glb(meshes, others), Format::Glb)
}

#[test]
fn vertices_of_others_are_told() {
    let (builder, meshes, others) = scene();
    let mut scene = document(&builder, &meshes, &others);
    let choice = Choice::of_faces(&scene.meshes()[0], [0]).with_used();
    let found = error(&mut scene, &[(0, choice)]);
    assert!(
        found.contains("primitive 1") && found.contains("which is left out"),
        "{found}"
    );

    // Lines over the same vertices.
    let choice = Choice::of_faces(&scene.meshes()[2], [0]).with_used();
    let found = error(&mut scene, &[(2, choice)]);
    assert!(
        found.contains("lines, strips, points or an outline name it"),
        "{found}"
    );
}

#[test]
fn one_sparse_element_stays() {
    let (builder, meshes, others) = scene();
    let mut scene = document(&builder, &meshes, &others);
    // None of the faces that are left has a vertex with a sparse element.
    let sparse = [0, 3, 9, 10, 20, 24];
    let lists = [0, 1].map(|mesh| {
        let faces = (0..).zip(scene.meshes()[mesh].mesh.faces());
        let free = faces.filter(|(_, face)| face.iter().all(|v| !sparse.contains(v)));
        let free: Vec<u32> = free.map(|(face, _)| face).collect();
        Choice::of_faces(&scene.meshes()[mesh], free)
    });
    let [mut first, second] = lists;
    let mut kept = [first.used(), second.used()].concat();
    kept.sort_unstable();
    kept.dedup();
    let before = scene.attributes(0);
    let info = before.iter().filter(|info| info.morph_target.is_some());
    let values = |scene: &Document| {
        let read = info
            .clone()
            .map(|info| scene.attribute(0, info).unwrap().to_f32());
        read.collect::<Vec<Vec<f32>>>()
    };
    let old = values(&scene);
    first.vertices = Some(kept.clone());
    select(&mut scene, &[(0, first), (1, second)]).unwrap();
    assert_read_again(&scene);
    let (json, binary) = parts(&scene);
    assert_sound(&json, &binary);
    for (old, new) in old.iter().zip(values(&scene)) {
        for (vertex, &kept) in kept.iter().enumerate() {
            assert_eq!(new[3 * vertex..][..3], old[3 * kept as usize..][..3]);
        }
    }
    let counts = json["accessors"].as_array().unwrap().iter();
    let counts = counts.filter_map(|accessor| accessor.get("sparse")?["count"].as_u64());
    assert_eq!(counts.collect::<Vec<u64>>(), [1, 1]);
}

#[test]
fn bytes_that_an_unknown_extension_may_name_stay() {
    for place in ["bufferViews", "buffers"] {
        let (mut builder, meshes, mut others) = scene();
        let extension = json!({"ACME_places": {"byteOffset": 900}});
        match place {
            "bufferViews" => {
                let last = builder.views.len() - 1;
                builder.views[last]["extensions"] = extension;
            }
            _ => {
                let length = builder.binary.len();
                others["buffers"] = json!([{"byteLength": length, "extensions": extension}]);
            }
        }
        let mut scene = document(&builder, &meshes, &others);
        let (_, before) = parts(&scene);
        let mesh = scene
            .meshes()
            .iter()
            .position(|entry| entry.name.starts_with("alone"));
        let Some(mesh) = mesh else {
            panic!("{:?}", scene.notes())
        };
        let choice = Choice::of_faces(&scene.meshes()[mesh], [0, 2]);
        select(&mut scene, &[(mesh, choice)]).unwrap();
        assert_read_again(&scene);
        let (json, after) = parts(&scene);
        assert_sound(&json, &after);
        assert_eq!(before.len(), after.len(), "{place}");
    }
}

#[test]
fn what_cannot_be_stored_is_refused() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 300);
    let indices = builder.indices(U8, &faces(20, 60));
    let meshes =
        json!([{"primitives": [{"attributes": {"POSITION": position}, "indices": indices}]}]);
    let mut scene = document(&builder, &meshes, &json!({}));
    let choice = Choice {
        faces: vec![SelectedFace {
            face: 3,
            corners: [0, 1, 299],
        }],
        vertices: None,
    };
    let found = error(&mut scene, &[(0, choice)]);
    assert!(
        found.contains("stored in 8 bits, which cannot name vertex 299"),
        "{found}"
    );
    // The vertices of such a mesh stay, for a reason that is told.
    let choice = Choice::of_faces(&scene.meshes()[0], [3]).with_used();
    let found = error(&mut scene, &[(0, choice)]);
    assert!(
        found.contains("no vertex can be left out: 8-bit indices do not reach"),
        "{found}"
    );

    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 30);
    let indices = builder.indices(U16, &faces(20, 30));
    let meshes = json!([{"extensions": {"EXT_mesh_manifold": {}},
                         "primitives": [{"attributes": {"POSITION": position}, "indices": indices}]}]);
    let mut scene = document(&builder, &meshes, &json!({}));
    let choice = Choice::of_faces(&scene.meshes()[0], [3]);
    let found = error(&mut scene, &[(0, choice)]);
    assert!(found.contains("EXT_mesh_manifold"), "{found}");
}

#[test]
fn an_animation_that_reads_the_vertices_keeps_them() {
    let mut builder = Builder::default();
    let position = builder.data(F32, "VEC3", 30);
    let indices = builder.indices(U16, &faces(20, 30));
    let meshes =
        json!([{"primitives": [{"attributes": {"POSITION": position}, "indices": indices}]}]);
    let others =
        json!({"animations": [{"channels": [], "samplers": [{"input": 1, "output": position}]}]});
    let mut scene = document(&builder, &meshes, &others);
    // Its indices are read by the animation too.
    assert!(scene.meshes().is_empty());
    let others = json!({"animations": [{"channels": [], "samplers": [{"output": position}]}]});
    let mut named = document(&builder, &meshes, &others);
    let choice = Choice::of_faces(&named.meshes()[0], [3]).with_used();
    let found = error(&mut named, &[(0, choice.clone())]);
    assert!(
        found.contains("no vertex can be left out: they share bytes with /animations/0"),
        "{found}"
    );
    let choice = Choice {
        vertices: None,
        ..choice
    };
    select(&mut named, &[(0, choice)]).unwrap();
    assert_read_again(&named);
    assert!(written(&scene).len() > written(&named).len());
    scene.edit(meshweft::files::Edit::select(&[], &[])).unwrap();
}

#[test]
fn buffers_beside_the_text_follow() {
    let folder = std::env::temp_dir().join(format!("meshweft-select-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (builder, meshes, others) = scene();
    let mut json = builder.json(&meshes, &others);
    json["buffers"][0]["uri"] = "a.bin".into();
    let source = folder.join("scene.gltf");
    std::fs::write(&source, serde_json::to_string_pretty(&json).unwrap()).unwrap();
    std::fs::write(folder.join("a.bin"), &builder.binary).unwrap();

    let mut scene = Document::open(&source, Limits::default()).unwrap();
    let choice = Choice::of_faces(&scene.meshes()[4], [0, 1, 5]).with_used();
    select(&mut scene, &[(4, choice)]).unwrap();
    scene.write(&source).unwrap();
    let again = Document::open(&source, Limits::default()).unwrap();
    assert_eq!(scene.meshes(), again.meshes());
    let text: serde_json::Value = serde_json::from_slice(&std::fs::read(&source).unwrap()).unwrap();
    let uri = text["buffers"][0]["uri"].as_str().unwrap();
    let binary = std::fs::read(folder.join(uri)).unwrap();
    assert!(binary.len() < builder.binary.len());
    assert_sound(&text, &binary);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_damaged_scene_is_answered() {
    let text = text();
    // The data is long, and damage to it tells nothing.
    let data = text.find("base64,").unwrap();
    let end = data + text[data..].find('"').unwrap();
    let short = [&text[..data + 7], &text[end..]].concat();
    let pieces = [
        "0",
        "1",
        "9",
        "25",
        "5121",
        "5123",
        "5126",
        "\"VEC3\"",
        "\"SCALAR\"",
        "[]",
        "{}",
        "null",
        "1e2",
        "{\"a\":",
    ];
    let mut random = Random(9);
    let mut read = 0;
    for _ in 0..4000 {
        let spoilt = random.spoilt(short.as_bytes(), &pieces, 3);
        let spoilt = String::from_utf8(spoilt).unwrap();
        let whole = spoilt.replacen("base64,", &text[data..end], 1);
        let name = crate::name_of(Format::Gltf);
        let limits = Limits::default();
        if let Ok(mut document) = Document::from_bytes(whole.into(), Format::Gltf, name, limits) {
            selection::check(&mut document);
            read += 1;
        }
    }
    println!("{read} of 4000 damaged scenes were read");
    assert!(read > 100);
}

#[test]
fn text_that_is_padded_with_zeros_is_padded_with_blanks() {
    let (builder, meshes, others) = scene();
    let mut glb = builder.glb(&meshes, &others);
    // The blanks at the end of the text; there is always one more member to make some.
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    let end = 20 + length;
    let blanks = glb[..end]
        .iter()
        .rev()
        .take_while(|&&byte| byte == b' ')
        .count();
    let padding = [0; 8];
    glb.splice(end - blanks..end, padding);
    let new = length - blanks + 8;
    let (more, total) = (new.next_multiple_of(4) - new, glb.len() - b"behind".len());
    glb.splice(end - blanks + 8..end - blanks + 8, vec![0; more]);
    glb[12..16].copy_from_slice(&((new + more) as u32).to_le_bytes());
    glb[8..12].copy_from_slice(&((total + more) as u32).to_le_bytes());

    let mut scene = open(&glb, Format::Glb);
    for last in (1..6).rev() {
        let choice = Choice::of_faces(&scene.meshes()[4], 0..last).with_used();
        select(&mut scene, &[(4, choice)]).unwrap();
        assert_read_again(&scene);
        let (json, binary) = parts(&scene);
        assert_sound(&json, &binary);
    }
}
