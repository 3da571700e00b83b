//! What `levels` writes: nothing that was there is lost, vertices in bands, no cracks, nodes that stand in.

use std::collections::{BTreeMap, BTreeSet};

use meshweft::files::{Document, Edit};
use meshweft::operations::{
    CullOptions, LevelGoals, LevelsError, LevelsOptions, LevelsReport, Options, compare,
    cull_build, inspect, levels, levels_apart, optimize,
};
use meshweft::{Permutation, VertexOrder};
use serde_json::{Value, json};

use crate::MODELS;
use crate::builder::{Builder, F32, U16, glb};
use crate::made::{Sheet, open, two_primitives};

pub(crate) fn options(ratios: &[f64]) -> LevelsOptions {
    let mut options = LevelsOptions::default();
    options.goals = LevelGoals::Ratios(ratios.to_vec());
    options.samples = 300;
    options
}

/// The file with levels, read again, after all that holds for every file was checked.
pub(crate) fn with_levels(bytes: &[u8], options: &LevelsOptions) -> (Vec<u8>, LevelsReport) {
    let source = open(bytes);
    let mut document = open(bytes);
    let report = levels(&mut document, options, &()).unwrap();
    let written = document.to_main_bytes().unwrap();
    let again = open(&written);
    for (a, b) in document.meshes().iter().zip(again.meshes()) {
        assert_eq!((&a.mesh, &a.level), (&b.mesh, &b.level));
    }

    // All that was there is there, and the same is drawn.
    let [before, after] = [bytes, &written].map(json_of);
    assert_is_kept(&before, &after, "");
    let compared = compare(&source, &again, &MODELS).unwrap();
    assert!(compared.is_same());
    assert_in_bands(&again);

    // A part of the work on another thread gives the same.
    let mut twice = open(bytes);
    levels(&mut twice, options, &()).unwrap();
    assert_eq!(twice.to_main_bytes().unwrap(), written);
    (written, report)
}

pub(crate) fn json_of(glb: &[u8]) -> Value {
    let length = u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&glb[20..20 + length]).unwrap()
}

/// Whether all values of one JSON stand at the same places of another.
fn assert_is_kept(before: &Value, after: &Value, pointer: &str) {
    match (before, after) {
        (Value::Object(before), Value::Object(after)) => {
            for (name, value) in before {
                let pointer = format!("{pointer}/{name}");
                assert!(after.contains_key(name), "{pointer}");
                assert_is_kept(value, &after[name], &pointer);
            }
        }
        (Value::Array(before), Value::Array(after)) => {
            assert!(after.len() >= before.len(), "{pointer}");
            for (number, (before, after)) in before.iter().zip(after).enumerate() {
                assert_is_kept(before, after, &format!("{pointer}/{number}"));
            }
        }
        _ if pointer == "/buffers/0/byteLength" => {}
        _ => assert_eq!(before, after, "{pointer}"),
    }
}

/// The vertices of each level, by group, come before all that finer levels add.
pub(crate) fn assert_in_bands(document: &Document) {
    let entries = document.meshes();
    let deepest = entries.iter().filter_map(|it| Some(it.level?.number)).max();
    let mut used: BTreeMap<(usize, usize), BTreeSet<u32>> = BTreeMap::new();
    for (mesh, entry) in entries.iter().enumerate() {
        let full = entry.level.map_or(mesh, |level| level.of);
        let own = entry.level.map_or(0, |level| level.number);
        // A mesh is drawn as it is down to its next level.
        let coarser = entries.iter().filter_map(|other| other.level);
        let coarser = coarser.filter(|level| level.of == full && level.number > own);
        let next = coarser.map(|level| level.number).min();
        let last = next.map_or(deepest.unwrap(), |next| next - 1);
        for level in own..=last {
            let all = used.entry((entry.vertex_group, level)).or_default();
            all.extend(entry.mesh.faces().as_flattened());
        }
    }
    for ((group, level), vertices) in &used {
        if let Some(coarser) = used.get(&(*group, level + 1)) {
            assert!(coarser.is_subset(vertices), "level {level}");
        }
        let largest = vertices.last().map_or(0, |&last| last as usize + 1);
        assert_eq!(
            largest,
            vertices.len(),
            "level {level} is not the first vertices"
        );
    }
}

/// What is said of how many vertices each level needs holds.
fn assert_said_is_true(document: &Document) {
    let json = json_of(&document.to_main_bytes().unwrap());
    let meshes = json["meshes"].as_array().unwrap().iter();
    let said = meshes.flat_map(|mesh| {
        let said = &mesh["extras"]["MESHWEFT_level"]["vertices"];
        let primitives = mesh["primitives"].as_array().unwrap().len();
        (0..primitives).map(move |primitive| said[primitive].as_u64())
    });
    let said: Vec<Option<u64>> = said.collect();
    assert_eq!(said.len(), document.meshes().len());
    for (entry, said) in document.meshes().iter().zip(said) {
        assert_eq!(said.is_some(), entry.level.is_some());
        let largest = entry.mesh.faces().as_flattened().iter().max();
        assert!(said.is_none_or(|said| u64::from(*largest.unwrap()) < said));
    }
}

/// The area of a sheet's levels seen from above, and that no edge inside it has one face.
pub(crate) fn assert_whole(document: &Document, side: f32) {
    let numbers = document
        .meshes()
        .iter()
        .map(|it| it.level.map_or(0, |it| it.number));
    for number in numbers.collect::<BTreeSet<usize>>() {
        let mut area = 0.0;
        let mut edges: BTreeMap<[[u32; 3]; 2], usize> = BTreeMap::new();
        for (mesh, entry) in document.meshes().iter().enumerate() {
            if entry.level.map_or(0, |it| it.number) != number {
                continue;
            }
            let positions = document.positions(mesh).unwrap().unwrap();
            for face in entry.mesh.faces() {
                let [a, b, c] = face.map(|vertex| positions[vertex as usize]);
                let [x, y] = [0, 1].map(|axis| [b[axis] - a[axis], c[axis] - a[axis]]);
                area += (x[0] * y[1] - x[1] * y[0]) / 2.0;
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    let mut ends = [from, to].map(|end| end.map(f32::to_bits));
                    ends.sort_unstable();
                    *edges.entry(ends).or_default() += 1;
                }
            }
        }
        assert_eq!(area, side * side, "level {number}");
        let open = edges.iter().filter(|(_, count)| **count == 1);
        for (ends, _) in open {
            let [a, b] = ends.map(|end| end.map(f32::from_bits));
            let is_border = |axis: usize, at: f32| a[axis] == at && b[axis] == at;
            let is_outside = [0, 1]
                .iter()
                .any(|&axis| is_border(axis, 0.0) || is_border(axis, side));
            assert!(is_outside, "level {number}: {a:?} to {b:?} is open");
        }
    }
}

#[test]
fn every_level_is_whole_and_its_vertices_are_the_first() {
    for sheet in [Sheet::default(), two_primitives()] {
        for seed in 0..4 {
            let sheet = Sheet {
                level_count: 0,
                seed,
                ..sheet.clone()
            };
            let bytes = sheet.bytes();
            let (written, report) = with_levels(&bytes, &options(&[0.5, 0.2, 0.05]));
            let document = open(&written);
            assert_whole(&document, 16.0);
            let faces: Vec<usize> = report.levels.iter().map(|it| it.counts.faces).collect();
            assert_eq!(faces[0], 512);
            assert!(
                faces[1] <= 256 && faces[2] <= 102 && faces[3] <= 25,
                "{faces:?}"
            );
            assert!(faces[1] >= 250 && faces[2] >= 98, "{faces:?}");
            let errors = report.levels.iter().map(|level| level.error);
            assert!(errors.is_sorted());
            assert!(report.floor.is_none());

            // What inspect says of the file is what was said of it.
            let inspected = inspect(&document, &MODELS);
            assert_eq!(inspected.total.faces, 512);
        }
    }
}

#[test]
fn what_other_jobs_do_leaves_levels_true() {
    let sheet = Sheet {
        level_count: 0,
        ..two_primitives()
    };
    let (written, made) = with_levels(&sheet.bytes(), &options(&[0.5, 0.2]));

    // Ordered, with tables, again: each keeps what the others wrote.
    let mut document = open(&written);
    assert_said_is_true(&document);
    optimize(&mut document, &Options::default(), &()).unwrap();
    assert_in_bands(&document);
    assert_said_is_true(&document);
    assert_whole(&document, 16.0);
    let report = cull_build(&mut document, &CullOptions::default(), &()).unwrap();
    assert!(report.is_changed());
    assert_in_bands(&document);
    assert_said_is_true(&document);
    assert_whole(&document, 16.0);
    optimize(&mut document, &Options::default(), &()).unwrap();
    assert_said_is_true(&document);
    assert_whole(&document, 16.0);

    // What moves vertices inside their bands leaves what is said of them true.
    let mut document = open(&written);
    let vertex_count = document.meshes()[0].mesh.vertex_count();
    let used = made.levels.iter().map(|it| it.counts.used_vertices);
    let ends: BTreeSet<usize> = used.chain([0, vertex_count]).collect();
    let ends: Vec<usize> = ends.into_iter().collect();
    let reversed = ends.windows(2).flat_map(|band| (band[0]..band[1]).rev());
    let reversed = reversed.map(|vertex| u32::try_from(vertex).unwrap());
    let reversed: VertexOrder = Permutation::new(reversed.collect()).unwrap().into();
    document.edit(Edit::order(0, None, &reversed)).unwrap();
    assert_in_bands(&document);
    assert_said_is_true(&document);

    // Tables first.
    let mut document = open(&sheet.bytes());
    cull_build(&mut document, &CullOptions::default(), &()).unwrap();
    let culled = document.to_main_bytes().unwrap();
    let (written, _) = with_levels(&culled, &options(&[0.5, 0.2]));
    let document = open(&written);
    assert!(document.culling(0).is_some() && document.culling(2).is_none());
    assert_whole(&document, 16.0);

    // Levels twice.
    let mut again = open(&written);
    let refused = levels(&mut again, &options(&[0.5]), &()).unwrap_err();
    assert!(
        matches!(refused, LevelsError::HasLevels { .. }),
        "{refused}"
    );
    assert_eq!(again.to_main_bytes().unwrap(), written);
}

#[test]
fn levels_apart_are_those_of_one_file() {
    let sheet = Sheet {
        level_count: 0,
        ..two_primitives()
    };
    let bytes = sheet.bytes();
    let source = open(&bytes);
    let options = options(&[0.5, 0.2]);
    let (_, together) = with_levels(&bytes, &options);
    let (apart, report) = levels_apart(&source, &mut || Ok(open(&bytes)), &options, &()).unwrap();
    for (level, said) in apart.iter().zip(&report.levels[1..]) {
        let faces = level.meshes().iter().map(|entry| entry.mesh.face_count());
        assert_eq!(faces.sum::<usize>(), said.counts.faces);
        assert_whole(level, 16.0);
        // Two vertices were never used, and stay, but are not needed.
        assert_eq!(said.counts.vertices, said.counts.used_vertices);
        assert_eq!(
            level.meshes()[0].mesh.vertex_count(),
            said.counts.vertices + 2
        );
    }
    let of_report = |report: &LevelsReport| -> Vec<(usize, f64)> {
        let levels = report.levels.iter();
        levels.map(|it| (it.counts.faces, it.error)).collect()
    };
    assert_eq!(of_report(&together), of_report(&report));
}

/// Two sheets, one on a node below that of the other, moved by an animation and by a pointer to the node.
fn scene() -> Vec<u8> {
    let side = 8_usize;
    let mut builder = Builder::default();
    let grid = (0..side * side).map(|v| [v % side, v / side]);
    let positions = grid.flat_map(|[x, y]| [x as f32, y as f32, (x as f32 * 0.7).sin()]);
    let bytes: Vec<u8> = positions.flat_map(f32::to_le_bytes).collect();
    let view = builder.view(&bytes, None);
    let position = builder.accessor(view, 0, F32, side * side, "VEC3");
    let corners = (0..side * (side - 1)).filter(|v| v % side != side - 1);
    let corners = corners.flat_map(|v| [v, v + 1, v + side, v + 1, v + side + 1, v + side]);
    let indices = builder.indices(U16, &corners.collect::<Vec<_>>());
    let times = builder.data(F32, "SCALAR", 2);
    let places = builder.data(F32, "VEC3", 2);
    let primitive = json!({"attributes": {"POSITION": position}, "indices": indices, "extras": 7});
    let meshes = json!([
        {"name": "sheet", "primitives": [primitive.clone()], "extras": {"targetNames": ["a"]}},
    ]);
    let others = json!({
        "nodes": [
            {"name": "car", "mesh": 0, "children": [1, 2], "scale": [2, 2, 2], "extras": {"kept": true}},
            {"name": "wheel", "mesh": 0, "translation": [1, 2, 3]},
            {"name": "empty"},
        ],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
        "extensionsUsed": ["KHR_animation_pointer"],
        "animations": [{
            "samplers": [{"input": times, "output": places}],
            "channels": [
                {"sampler": 0, "target": {"node": 1, "path": "translation"}},
                {"sampler": 0, "target": {"path": "pointer", "extensions": {
                    "KHR_animation_pointer": {"pointer": "/nodes/0/scale"}}}},
            ],
        }],
    });
    let json = builder.json(&meshes, &others);
    glb(&json.to_string(), Some(&builder.binary))
}

#[test]
fn nodes_stand_in_with_what_is_below_them() {
    let (written, report) = with_levels(&scene(), &options(&[0.5, 0.12]));
    let json = json_of(&written);
    let nodes = json["nodes"].as_array().unwrap();

    // Two levels of the car with its wheel, two of the wheel alone; the empty node is not needed.
    assert_eq!(nodes.len(), 3 + 2 * 2 + 2);
    assert_eq!(nodes[0]["extensions"]["MSFT_lod"]["ids"], json!([3, 5]));
    assert_eq!(nodes[1]["extensions"]["MSFT_lod"]["ids"], json!([7, 8]));
    assert_eq!(
        nodes[3],
        json!({"name": "car_LOD1", "mesh": 1, "scale": [2, 2, 2], "children": [4]})
    );
    assert_eq!(
        nodes[4],
        json!({"name": "wheel_LOD1", "mesh": 1, "translation": [1, 2, 3]})
    );
    assert_eq!(nodes[6]["mesh"], json!(2));
    assert_eq!(json["scenes"], json!([{"nodes": [0]}]));

    // How much of a picture each covers at least.
    let coverage = nodes[0]["extras"]["MSFT_screencoverage"]
        .as_array()
        .unwrap();
    assert_eq!(coverage.len(), 3);
    let coverage: Vec<f64> = coverage.iter().map(|it| it.as_f64().unwrap()).collect();
    assert!(coverage.is_sorted_by(|a, b| a >= b) && coverage[2] == 0.0);
    let radius = 0.5_f64 * (7.0_f64 * 7.0 * 2.0 + 4.0).sqrt();
    let pixels = radius / report.objects[0].errors[1];
    let expected = std::f64::consts::PI * pixels * pixels / (1920.0 * 1080.0);
    assert!(
        (coverage[0] / expected.min(1.0) - 1.0).abs() < 0.05,
        "{coverage:?} {expected}"
    );
    assert_eq!(report.objects[0].scale, 2.0);
    assert_eq!(report.levels[1].error, 2.0 * report.objects[0].errors[1]);

    // What moves a node moves those that stand in for it.
    let channels = json["animations"][0]["channels"].as_array().unwrap();
    let target = |number: usize| channels[number]["target"].clone();
    let moved: Vec<Value> = (2..channels.len()).map(target).collect();
    let of_node = |node: usize| json!({"node": node, "path": "translation"});
    let of_pointer = |node: usize| {
        let pointer = format!("/nodes/{node}/scale");
        json!({"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}})
    };
    let expected = [
        of_node(4),
        of_node(6),
        of_node(7),
        of_node(8),
        of_pointer(3),
        of_pointer(5),
    ];
    assert_eq!(moved, expected);

    // What is said of the mesh.
    let mesh = &json["meshes"][1];
    assert_eq!(mesh["name"], json!("sheet_LOD1"));
    assert_eq!(mesh["extras"]["targetNames"], json!(["a"]));
    let said = &mesh["extras"]["MESHWEFT_level"];
    assert_eq!(said["level"], json!(1));
    assert_eq!(said["vertices"], json!([report.levels[1].counts.vertices]));
    assert_eq!(mesh["primitives"][0]["extras"], json!(7));
}

#[test]
fn what_makes_no_sense_is_refused_and_changes_nothing() {
    let sheet = Sheet {
        level_count: 0,
        side: 1,
        ..Sheet::default()
    };
    let bytes = sheet.bytes();
    let mut document = open(&bytes);
    let refused = levels(&mut document, &options(&[0.9]), &())
        .unwrap_err()
        .to_string();
    assert_eq!(
        refused,
        "sheet.glb: no mesh gets coarser: sheet: no vertex can go (seams, borders, topology)"
    );
    let refused = levels(&mut document, &options(&[0.1, 0.5]), &()).unwrap_err();
    assert!(
        refused
            .to_string()
            .starts_with("each level must be coarser")
    );
    assert_eq!(document.to_main_bytes().unwrap(), bytes);
}
