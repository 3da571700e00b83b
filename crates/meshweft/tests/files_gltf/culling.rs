//! Culling tables in a glTF: what is added, that it stays true, and what becomes of damaged ones.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::culling::{CullingTable, Eye, Ranges};
use meshweft::files::{
    Document, Edit, Format, ReadOptions, SelectedFace, SelectedFaces, StoredCulling,
};
use meshweft::operations::{
    CullError, CullOptions, CullOutcome, CullReport, CullStatsOptions, Options, cull_build,
    cull_stats, optimize,
};
use meshweft::{FaceOrder, Limits, Permutation};
use serde_json::{Value, json};

use crate::Random;
use crate::append::{is_inserted, is_kept};
use crate::builder::{Builder, F32, U16, U32};
use crate::data::scenes;
use crate::reader::Reader;

/// A grid of squares on a ball, two faces each, as positions and corners.
pub(crate) fn ball(rings: u32, sides: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let mut positions = Vec::new();
    for ring in 0..=rings {
        for side in 0..sides {
            let up = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
            let around = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
            let [x, y, z] = [up.sin() * around.cos(), up.sin() * around.sin(), up.cos()];
            #[expect(clippy::cast_possible_truncation, reason = "a ball of floats")]
            positions.push([3.0 + x as f32, y as f32 - 1.0, z as f32]);
        }
    }
    let mut corners = Vec::new();
    for ring in 0..rings {
        for side in 0..sides {
            let at = |ring: u32, side: u32| ring * sides + side % sides;
            let [a, b] = [at(ring, side), at(ring, side + 1)];
            let [c, d] = [at(ring + 1, side), at(ring + 1, side + 1)];
            corners.extend([a, c, b, b, c, d]);
        }
    }
    (positions, corners)
}

/// What a scene with a ball has: positions and their number, corners.
pub(crate) fn ball_builder() -> (Builder, usize, usize) {
    let (positions, corners) = ball(16, 24);
    let mut builder = Builder::default();
    let bytes = positions
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes());
    let view = builder.view(&bytes.collect::<Vec<u8>>(), None);
    let position = builder.accessor(view, 0, F32, positions.len(), "VEC3");
    let numbers: Vec<usize> = corners.iter().map(|&corner| corner as usize).collect();
    let indices = builder.indices(U16, &numbers);
    (builder, position, indices)
}

pub(crate) fn opened(bytes: Vec<u8>) -> Document {
    let options = ReadOptions::default();
    Document::from_bytes(bytes, Format::Glb, "test.glb".as_ref(), options).unwrap()
}

/// A ball as a GLB, its primitive with these members too.
pub(crate) fn ball_with(members: &Value, others: &Value) -> Document {
    let (builder, position, indices) = ball_builder();
    let mut primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
    for (name, value) in members.as_object().unwrap() {
        primitive[name] = value.clone();
    }
    opened(builder.glb(&json!([{"primitives": [primitive]}]), others))
}

pub(crate) fn build(document: &mut Document) -> CullReport {
    cull_build(document, &CullOptions::default(), &()).unwrap()
}

fn table_of(document: &Document, mesh: usize) -> CullingTable {
    let StoredCulling {
        center,
        reach,
        starts,
        planes,
    } = document.culling(mesh).unwrap();
    CullingTable::from_parts(center, reach, starts, &planes).unwrap()
}

/// For each cluster of each mesh, the faces by their corners' positions, in any order and turn.
fn clusters(document: &Document) -> Vec<Vec<[[u32; 3]; 3]>> {
    let mut clusters = Vec::new();
    for mesh in 0..document.meshes().len() {
        let Some(table) = document.culling(mesh) else {
            continue;
        };
        let positions = document.positions(mesh).unwrap().unwrap();
        let faces = document.meshes()[mesh].mesh.faces();
        for ends in table.starts.windows(2) {
            let faces = faces[ends[0] as usize..ends[1] as usize].iter();
            let face = |face: &[u32; 3]| {
                let mut corners = face.map(|v| positions[v as usize].map(f32::to_bits));
                let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
                corners.rotate_left(least);
                corners
            };
            let mut faces: Vec<_> = faces.map(face).collect();
            faces.sort_unstable();
            clusters.push(faces);
        }
    }
    clusters
}

/// Whether no face that surely faces a random eye is left out; how many were left out of all.
fn left_out(document: &Document, mesh: usize, random: &mut Random) -> [usize; 2] {
    let table = table_of(document, mesh);
    let positions = document.positions(mesh).unwrap().unwrap();
    let faces = document.meshes()[mesh].mesh.faces();
    let reach = f64::from(table.reach());
    let center = table.center().map(f64::from);
    let mut counts = [0; 2];
    for view in 0..40 {
        let mut number = || 2.0 * random.below(1 << 20) as f64 / f64::from(1 << 20) - 1.0;
        let way = [number(), number(), number()];
        let far = if view % 2 == 0 { 1.5 } else { 6.0 } * reach;
        #[expect(clippy::cast_possible_truncation, reason = "any eye will do")]
        let eye = [0, 1, 2].map(|i| (center[i] + far * way[i]) as f32);
        let mut ranges = Ranges::default();
        let drawn = table.visible_ranges(Eye::at(eye), &mut ranges);
        let mut is_drawn = vec![false; faces.len()];
        for range in drawn.as_slice() {
            is_drawn[range.start as usize..range.end as usize].fill(true);
        }
        for (face, is_drawn) in faces.iter().zip(is_drawn) {
            let [a, b, c] = face.map(|v| positions[v as usize].map(f64::from));
            let sub = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|i| p[i] - q[i]);
            let ([u, v], w) = ([sub(b, a), sub(c, a)], sub(eye.map(f64::from), a));
            let terms = [
                u[1] * v[2] * w[0],
                -u[2] * v[1] * w[0],
                u[2] * v[0] * w[1],
                -u[0] * v[2] * w[1],
                u[0] * v[1] * w[2],
                -u[1] * v[0] * w[2],
            ];
            let volume: f64 = terms.iter().sum();
            let rounding = 1e-14 * terms.iter().map(|x| x.abs()).sum::<f64>();
            assert!(is_drawn || volume <= rounding, "a front face is left out");
            counts[usize::from(is_drawn)] += 1;
        }
    }
    counts
}

#[test]
fn real_scenes_get_tables_at_their_ends_and_these_stay_true() {
    let (mut in_clusters, mut always, mut left) = (0, 0, 0);
    let mut random = Random(3);
    let mut rejected = [0; 2];
    for path in scenes() {
        let name = path.display();
        let mut document = Document::open(&path, Limits::default()).unwrap();
        let mut ordered = Document::open(&path, Limits::default()).unwrap();
        let report = build(&mut document);
        in_clusters += report.count(|it| *it == CullOutcome::Clusters)[0];
        always += report.count(|it| matches!(it, CullOutcome::AlwaysDrawn(_)))[0];
        left += report.count(|it| matches!(it, CullOutcome::Left(_)))[0];
        let is_told = report.meshes.len() == ordered.meshes().len()
            && (!report.meshes.is_empty() || !report.of_file.notes.is_empty());
        assert!(is_told, "{name}");

        // But for the order of faces, all of it is as it was, and the rest is after it.
        for (mesh, culled) in report.meshes.iter().enumerate() {
            ordered
                .edit(Edit::order(mesh, &culled.faces, None))
                .unwrap();
        }
        let main = Path::new(path.file_name().unwrap());
        let files = |document: &Document| -> BTreeMap<PathBuf, Vec<u8>> {
            document.to_bytes(main).unwrap().into_iter().collect()
        };
        let (before, after) = (files(&ordered), files(&document));
        assert_eq!(before.len(), after.len(), "{name}");
        for (file, bytes) in &before {
            let is_kept = match file == main {
                true => is_longer(main, bytes, &after[file]),
                false => after[file].starts_with(bytes),
            };
            assert!(is_kept, "{name}: {}", file.display());
        }
        let beside = meshweft::files::Surroundings::Memory(&after);
        let main_bytes = after[main].clone();
        let format = document.format();
        let again =
            Document::from_bytes_in(main_bytes, format, main, beside, Limits::default()).unwrap();
        assert_eq!(again.meshes(), document.meshes(), "{name}");

        // Nothing that is seen is left out; and an order keeps all of it.
        for mesh in 0..document.meshes().len() {
            if document.culling(mesh).is_some() && document.meshes()[mesh].mesh.face_count() < 4000
            {
                let counts = left_out(&document, mesh, &mut random);
                rejected = [0, 1].map(|i| rejected[i] + counts[i]);
            }
        }
        let tables = |document: &Document| -> Vec<_> {
            (0..document.meshes().len())
                .map(|mesh| document.culling(mesh))
                .collect()
        };
        let (clusters_before, tables_before) = (clusters(&document), tables(&document));
        let options = Options {
            effort: meshweft::order::Effort::Fast,
            allow_worse: true,
            ..Options::default()
        };
        optimize(&mut document, &options, &()).unwrap();
        assert_eq!(clusters(&document), clusters_before, "{name}");
        assert_eq!(tables(&document), tables_before, "{name}");
    }
    println!(
        "{in_clusters} meshes in clusters, {always} always drawn, {left} left; {rejected:?} faces left out and drawn"
    );
    if in_clusters > 0 {
        assert!(always > 0 && left > 0 && rejected[0] > 0);
    }
}

/// Whether a main file has all of another at its place, and bytes and values at the ends.
fn is_longer(main: &Path, old: &[u8], new: &[u8]) -> bool {
    if Format::of_path(main) != Some(Format::Glb) {
        let [old, new] = [old, new].map(|text| serde_json::from_slice(text).unwrap());
        return is_kept(&old, &new, "");
    }
    let [old, new] = [old, new].map(|bytes| Reader::of_file(main, Some(bytes.to_vec())));
    let mut buffers = old.buffers.iter().zip(&new.buffers);
    let is_prefix = |(old, new): (&Option<Vec<u8>>, &Option<Vec<u8>>)| match (old, new) {
        (Some(old), Some(new)) => new.starts_with(old),
        (old, new) => old == new,
    };
    is_kept(&old.json, &new.json, "")
        && is_inserted(&old.json_text, &new.json_text)
        && buffers.all(is_prefix)
}

#[test]
fn a_ball_is_culled_by_a_table_that_comes_back() {
    let mut document = ball_with(&json!({}), &json!({"nodes": [{"mesh": 0}, {"mesh": 0}]}));
    let report = build(&mut document);
    assert_eq!(report.meshes[0].outcome, CullOutcome::Clusters);
    let bytes = document.to_main_bytes().unwrap();
    let mut again = opened(bytes.clone());
    assert_eq!(again.culling(0), document.culling(0));
    assert_eq!(again.meshes(), document.meshes());
    let runs = &again.meshes()[0].runs;
    assert_eq!(runs.len(), report.meshes[0].clusters);
    assert!(runs.len() > 1);
    let counts = left_out(&again, 0, &mut Random(1));
    assert!(counts[0] > 0 && counts[1] > 0, "{counts:?}");

    let stats = cull_stats(&again, &CullStatsOptions::default()).unwrap();
    assert!(stats.is_true() && stats.without == 0);
    let far = stats.total.views.last().unwrap();
    assert!(far.back_rejected > 0 && far.back_rejected <= far.back);
    assert_eq!(far.faces, 40 * 768);

    // A second table is refused, and changes nothing.
    let refused = cull_build(&mut again, &CullOptions::default(), &()).unwrap_err();
    assert!(matches!(refused, CullError::HasTable { .. }), "{refused}");
    let table = document.culling(0).unwrap();
    again
        .edit(Edit::Cull {
            tables: &[(0, &table)],
        })
        .unwrap_err();
    assert_eq!(again.to_main_bytes().unwrap(), bytes);

    // No face leaves its cluster or the file.
    let last = u32::try_from(again.meshes()[0].mesh.face_count()).unwrap();
    let reversed = Permutation::new((0..last).rev().collect::<Vec<u32>>()).unwrap();
    again
        .edit(Edit::order(0, &FaceOrder::from(reversed), None))
        .unwrap_err();
    let corners = again.meshes()[0].mesh.faces()[0];
    let one = [SelectedFace { face: 0, corners }];
    let refused = again.edit(Edit::select(&[SelectedFaces::new(0, &one)], &[]));
    let refused = refused.unwrap_err().to_string();
    assert!(
        refused.contains("MESHWEFT_culling has ranges of them"),
        "{refused}"
    );
    assert_eq!(again.to_main_bytes().unwrap(), bytes);
}

#[test]
fn what_may_not_be_culled_is_told() {
    let always = |document: &mut Document, why: &str| {
        let before = document.meshes()[0].mesh.clone();
        let report = build(document);
        let CullOutcome::AlwaysDrawn(told) = report.meshes[0].outcome else {
            panic!("{:?}", report.meshes[0].outcome);
        };
        assert!(told.contains(why), "{told}");
        assert_eq!(document.meshes()[0].mesh, before);
        assert_eq!(document.culling(0).unwrap().starts, [0, 768]);
        assert_eq!(left_out(document, 0, &mut Random(9))[0], 0);
    };
    let materials = json!({"materials": [{}, {"doubleSided": true}, {"alphaMode": "BLEND"}]});
    always(
        &mut ball_with(&json!({"material": 1}), &materials),
        "doubleSided",
    );
    always(&mut ball_with(&json!({"material": 2}), &materials), "BLEND");
    let variants = json!({"material": 0, "extensions": {"KHR_materials_variants": {
        "mappings": [{"material": 0, "variants": [0]}, {"material": 1, "variants": [1]}],
    }}});
    always(&mut ball_with(&variants, &materials), "doubleSided");

    // Outlines of VRM 1 and 0 are the back faces, drawn once more; VRM 0 says for itself which faces are left out.
    let toon =
        |members: Value| json!({"materials": [{"extensions": {"VRMC_materials_mtoon": members}}]});
    let vrm = |members: Value| {
        let properties = json!([{"floatProperties": members}]);
        json!({"materials": [{}], "extensions": {"VRM": {"materialProperties": properties}}})
    };
    let toon_with = |mode: &str| toon(json!({"outlineWidthMode": mode}));
    for others in [
        toon_with("worldCoordinates"),
        toon_with("screenCoordinates"),
        vrm(json!({"_OutlineWidthMode": 1})),
        vrm(json!({"_OutlineWidthMode": 2.0, "_CullMode": 2})),
        vrm(json!({"_CullMode": 0})),
    ] {
        let mut document = ball_with(&json!({"material": 0}), &others);
        always(&mut document, "an outline of VRM");
    }
    for others in [
        toon_with("none"),
        toon(json!({"outlineWidthFactor": 0.1})),
        vrm(json!({"_OutlineWidthMode": 0.0, "_CullMode": 2})),
        vrm(json!({"_OutlineWidth": 0.5})),
    ] {
        let report = build(&mut ball_with(&json!({"material": 0}), &others));
        assert_eq!(report.meshes[0].outcome, CullOutcome::Clusters, "{others}");
    }

    let left = |document: &mut Document, why: &str| {
        let bytes = document.to_main_bytes().unwrap();
        let report = build(document);
        let CullOutcome::Left(told) = &report.meshes[0].outcome else {
            panic!("{:?}", report.meshes[0].outcome);
        };
        assert!(told.contains(why), "{told}");
        assert!(!report.is_changed());
        assert_eq!(document.to_main_bytes().unwrap(), bytes);
    };
    let nodes = json!({"nodes": [{"mesh": 0, "skin": 0}, {"mesh": 0}], "skins": [{"joints": [1]}]});
    left(&mut ball_with(&json!({}), &nodes), "joints");
    left(
        &mut ball_with(&json!({"targets": [{"POSITION": 0}]}), &json!({})),
        "morph",
    );
}

#[test]
fn primitives_with_the_same_faces_have_the_same_table() {
    let (builder, position, indices) = ball_builder();
    let primitive = json!({"attributes": {"POSITION": position}, "indices": indices});
    let meshes = json!([{"primitives": [primitive, primitive]}, {"primitives": [primitive]}]);
    let mut document = opened(builder.glb(&meshes, &json!({})));
    let report = build(&mut document);
    assert_eq!(
        (report.meshes.len(), &report.meshes[0].outcome),
        (1, &CullOutcome::Clusters)
    );
    let json = json_of(&document);
    let table = |pointer: &str| json.pointer(&format!("{pointer}/extensions/MESHWEFT_culling"));
    let first = table("/meshes/0/primitives/0").unwrap();
    assert_eq!(table("/meshes/0/primitives/1"), Some(first));
    assert_eq!(table("/meshes/1/primitives/0"), Some(first));
    assert_eq!(json["extensionsUsed"], json!(["MESHWEFT_culling"]));
    assert!(json.get("extensionsRequired").is_none());

    // Of other positions, the faces are others.
    let (mut builder, position, indices) = ball_builder();
    let other = builder.data(F32, "VEC3", 17 * 24);
    let primitive =
        |position: usize| json!({"attributes": {"POSITION": position}, "indices": indices});
    let meshes = json!([{"primitives": [primitive(position), primitive(other)]}]);
    let report = build(&mut opened(builder.glb(&meshes, &json!({}))));
    let told = report.meshes[0].outcome.reason().unwrap();
    assert!(told.contains("different positions"), "{told}");
}

fn json_of(document: &Document) -> Value {
    let bytes = document.to_main_bytes().unwrap();
    Reader::of_file(document.path(), Some(bytes)).json
}

#[test]
fn a_damaged_table_keeps_its_primitive_with_a_note() {
    let (_, corners) = ball(16, 24);
    let face_count = corners.len() / 3;
    let opened_with = |starts: &[u32], change: &dyn Fn(&mut Value, &mut Builder)| {
        let (mut builder, position, indices) = ball_builder();
        let bytes = starts.iter().flat_map(|x| x.to_le_bytes());
        let view = builder.view(&bytes.collect::<Vec<u8>>(), None);
        let starts_accessor = builder.accessor(view, 0, U32, starts.len(), "SCALAR");
        let planes = builder.data(F32, "VEC4", 4 * starts.len().saturating_sub(1));
        let mut table = json!({
            "center": [3, -1, 0.5], "reach": 2.5, "starts": starts_accessor, "planes": planes,
        });
        change(&mut table, &mut builder);
        let primitive = json!({
            "attributes": {"POSITION": position}, "indices": indices,
            "extensions": {"MESHWEFT_culling": table},
        });
        opened(builder.glb(&json!([{"primitives": [primitive]}]), &json!({})))
    };
    let end = u32::try_from(face_count).unwrap();
    let sound = opened_with(&[0, 5, end], &|_, _| {});
    assert_eq!(sound.meshes()[0].runs, [0, 5]);
    assert!(sound.notes().is_empty(), "{:?}", sound.notes());

    let starts: [&[u32]; 7] = [
        &[],
        &[0],
        &[1, 5, end],
        &[0, 5, end - 1],
        &[0, 5, 5, end],
        &[0, end + 1, end],
        &[0, u32::MAX, end],
    ];
    let mut damaged: Vec<Document> = starts
        .iter()
        .map(|it| opened_with(it, &|_, _| {}))
        .collect();
    let set = |name: &'static str, value: Value| {
        opened_with(&[0, 5, end], &|table, _| match value.is_null() {
            true => drop(table.as_object_mut().unwrap().remove(name)),
            false => table[name] = value.clone(),
        })
    };
    for name in ["center", "reach", "starts", "planes"] {
        for value in [
            json!(null),
            json!("x"),
            json!({}),
            json!([]),
            json!(-1),
            json!(1e300),
            json!(99),
        ] {
            let is_number = name == "reach" && value == json!(99);
            if !is_number {
                damaged.push(set(name, value));
            }
        }
    }
    damaged.push(set("center", json!([1, 2])));
    damaged.push(set("center", json!([1, 2, 3, 4])));
    damaged.push(set("center", json!([1, 2, null])));
    // Positions and indices instead of planes and starts; too few planes; bytes that are not there.
    damaged.push(set("planes", json!(0)));
    damaged.push(set("starts", json!(1)));
    damaged.push(opened_with(&[0, 5, end], &|_, builder| {
        builder.accessors.last_mut().unwrap()["count"] = 7.into();
    }));
    damaged.push(opened_with(&[0, 5, end], &|_, builder| {
        builder.accessors.last_mut().unwrap()["count"] = 8000.into();
    }));
    damaged.push(opened_with(&[0, 5, end], &|table, _| *table = json!([])));

    for mut document in damaged {
        let bytes = document.to_main_bytes().unwrap();
        assert!(document.meshes().is_empty());
        let [note] = document.notes() else {
            panic!("{:?}", document.notes());
        };
        let text = "left as it is: its MESHWEFT_culling is not sound: ";
        assert!(note.text.starts_with(text), "{}", note.text);
        let report = build(&mut document);
        assert!(!report.is_changed() && report.of_file.notes.len() == 1);
        let stats = cull_stats(&document, &CullStatsOptions::default()).unwrap();
        assert!(stats.meshes.is_empty() && !stats.is_true());
        assert_eq!(document.to_main_bytes().unwrap(), bytes);
    }
}

#[test]
fn any_bytes_as_a_table_do_no_harm() {
    let mut document = ball_with(&json!({}), &json!({}));
    build(&mut document);
    let bytes = document.to_main_bytes().unwrap();
    let json = json_of(&document);
    let start = json["bufferViews"]
        .as_array()
        .unwrap()
        .iter()
        .rev()
        .nth(1)
        .unwrap();
    let start = usize::try_from(start["byteOffset"].as_u64().unwrap()).unwrap();
    let binary = bytes.windows(4).position(|word| word == b"BIN\0").unwrap() + 4;
    let length = json["buffers"][0]["byteLength"].as_u64().unwrap();
    let table = binary + start..binary + usize::try_from(length).unwrap();
    let mut random = Random(5);
    let mut options = CullStatsOptions::default();
    options.eyes = 2;
    let (mut sound, mut wrong) = (0, 0);
    for _ in 0..300 {
        let mut damaged = bytes.clone();
        for _ in 0..=random.below(4) {
            damaged[table.start + random.below(table.len())] =
                u8::try_from(random.below(256)).unwrap();
        }
        let mut document = opened(damaged.clone());
        assert_eq!(document.to_main_bytes().unwrap(), damaged);
        let stats = cull_stats(&document, &options).unwrap();
        sound += stats.meshes.len();
        wrong += usize::from(!stats.is_true());
        optimize(&mut document, &Options::default(), &()).unwrap();
    }
    assert!(sound > 50 && wrong > 0, "{sound} {wrong}");
}

#[test]
fn a_table_with_other_parts_than_the_faces_is_refused() {
    let mut document = ball_with(&json!({}), &json!({}));
    let bytes = document.to_main_bytes().unwrap();
    let plane = [[0.0, 0.0, 1.0, 0.0]; 4];
    let sound = StoredCulling {
        center: [0.0; 3],
        reach: 1.0,
        starts: vec![0, 768],
        planes: vec![plane],
    };
    let with = |change: &dyn Fn(&mut StoredCulling)| {
        let mut table = sound.clone();
        change(&mut table);
        table
    };
    let refused = [
        with(&|it| it.starts = vec![0, 767]),
        with(&|it| it.starts = vec![]),
        with(&|it| it.starts = vec![0, 4, 4, 768]),
        with(&|it| it.planes.clear()),
        with(&|it| it.planes[0][3][1] = f32::NAN),
        with(&|it| it.center[2] = f32::INFINITY),
        with(&|it| it.reach = -1.0),
    ];
    for table in &refused {
        document
            .edit(Edit::Cull {
                tables: &[(0, table)],
            })
            .unwrap_err();
        assert_eq!(document.to_main_bytes().unwrap(), bytes);
    }
    document
        .edit(Edit::Cull {
            tables: &[(0, &sound)],
        })
        .unwrap();
    assert!(document.notes().is_empty(), "{:?}", document.notes());
    assert_eq!(document.culling(0), Some(sound));
}
