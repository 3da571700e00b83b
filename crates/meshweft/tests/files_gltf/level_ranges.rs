//! The byte ranges of each level: with these alone, a level is drawn right.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use meshweft::Limits;
use meshweft::files::{Document, Edit, Format, Surroundings};
use meshweft::operations::{FileRange, LevelRangesOptions, LevelRangesReport, level_ranges};
use serde_json::{Value, json};

use crate::builder::{U16, glb};
use crate::data::scenes;
use crate::levelled::{Levelled, PREFIXES, all, made};
use crate::reader::{Reader, Triangle};

const NAME: &str = "made.glb";

fn open(bytes: Vec<u8>) -> Document {
    Document::from_bytes(bytes, Format::Glb, NAME.as_ref(), Limits::default()).unwrap()
}

fn ranges(document: &Document, gap: u64) -> LevelRangesReport {
    let mut options = LevelRangesOptions::default();
    options.gap = gap;
    options.most_waste = f64::INFINITY;
    level_ranges(document, &options).unwrap()
}

/// A file as a client has it. Every byte that was not fetched is wrong.
struct Client<'a> {
    whole: &'a [u8],
    file: Option<&'a Path>,
    bytes: Vec<u8>,
}

impl<'a> Client<'a> {
    fn new(whole: &'a [u8], file: Option<&'a Path>) -> Self {
        let bytes = whole.iter().map(|byte| !byte).collect();
        Self { whole, file, bytes }
    }

    fn fetch(&mut self, ranges: &[FileRange]) {
        for range in ranges
            .iter()
            .filter(|range| range.file.as_deref() == self.file)
        {
            let [start, length] = [range.start, range.length].map(|n| usize::try_from(n).unwrap());
            self.bytes[start..start + length].copy_from_slice(&self.whole[start..start + length]);
        }
    }

    fn fetch_head(&mut self, report: &LevelRangesReport) {
        let head = usize::try_from(report.head_bytes).unwrap();
        self.bytes[..head].copy_from_slice(&self.whole[..head]);
    }
}

/// The primitives of the mesh without levels, and of that of a level.
fn primitives(reader: &Reader, level: usize) -> Vec<&Value> {
    let meshes = [&reader.json["meshes"][0], &reader.json["meshes"][1 + level]];
    let lists = meshes.map(|mesh| mesh["primitives"].as_array().unwrap());
    lists.into_iter().flatten().collect()
}

/// The triangles of these.
fn drawn(reader: &Reader, level: usize) -> Vec<Option<Vec<Triangle>>> {
    let triangles = primitives(reader, level).into_iter();
    let triangles = triangles.map(|primitive| reader.triangles_of(primitive));
    triangles.collect()
}

/// The matrices of joints.
fn matrices(reader: &Reader) -> Option<Vec<Vec<u8>>> {
    let skin = reader.json["skins"].get(0);
    skin.and_then(|skin| reader.elements(&skin["inverseBindMatrices"]))
}

/// The index lists of a level.
fn lists(reader: &Reader, level: usize) -> Vec<Option<Vec<Vec<u8>>>> {
    let of_level = primitives(reader, level).split_off(1);
    let lists = of_level
        .into_iter()
        .map(|primitive| reader.elements(&primitive["indices"]));
    lists.collect()
}

#[test]
fn the_ranges_of_a_level_have_all_that_it_draws() {
    for kind in all() {
        for (gap, is_laid_out) in [
            (0, false),
            (0, true),
            (64, true),
            (4096, true),
            (4096, false),
        ] {
            let name = &format!("{kind:?} {gap} {is_laid_out}");
            let mut document = open(made(kind).glb());
            if is_laid_out {
                document.edit(Edit::StreamLayout).unwrap();
            }
            let whole = document.to_main_bytes().unwrap();
            let expected = Reader::of_file(NAME.as_ref(), Some(whole.clone()));
            let report = ranges(&document, gap);
            assert_eq!(report.levels.len(), 3, "{name}");

            let mut client = Client::new(&whole, None);
            client.fetch_head(&report);
            for (level, found) in (0..3).rev().zip(&report.levels) {
                assert_eq!(found.level, level, "{name}");
                client.fetch(&found.ranges);
                let bytes: u64 = found.ranges.iter().map(|range| range.length).sum();
                assert_eq!(found.bytes, bytes, "{name}");
                let has = Reader::of_file(NAME.as_ref(), Some(client.bytes.clone()));
                assert!(drawn(&has, level) == drawn(&expected, level), "{name}");
                assert!(matrices(&has) == matrices(&expected), "{name}");
                // The finer ones are not there yet.
                for finer in 0..level {
                    let is_there = lists(&has, finer) == lists(&expected, finer);
                    assert!(!is_there || gap > 0, "{name}");
                }
            }
        }
    }
}

/// What the levels of a made file need, coarsest first.
fn needed(kind: Levelled) -> [u64; 3] {
    let width = if kind.indices == U16 { 2 } else { 4 };
    let sum = |level: usize| {
        PREFIXES
            .iter()
            .map(|prefixes| prefixes[level] as u64)
            .sum::<u64>()
    };
    // Positions, normals, coordinates; and a morph target.
    let vertex = 12 + 12 + 8 + 12;
    // Vertices that are interleaved have four bytes more, after each but the last of a range.
    let padding = |level: usize| {
        if kind.is_interleaved {
            4 * (sum(level) - 2)
        } else {
            0
        }
    };
    let lists = [1200, 400, 77].map(|faces| 2 * 3 * faces * width);
    let up_to = |level: usize| vertex * sum(level) + padding(level);
    let plain = 30 * 3 + 20 * 12;
    let matrices = if kind.has_skin { 128 } else { 0 };
    [
        lists[2] + up_to(2) + plain + matrices,
        lists[1] + up_to(1) - up_to(2),
        lists[0] + up_to(0) - up_to(1),
    ]
}

#[test]
fn nothing_is_fetched_that_is_not_needed() {
    for kind in all() {
        let name = &format!("{kind:?}");
        let mut document = open(made(kind).glb());
        document.edit(Edit::StreamLayout).unwrap();
        let exact = ranges(&document, 0);
        let bytes: Vec<u64> = exact.levels.iter().map(|level| level.bytes).collect();
        assert_eq!(bytes, needed(kind), "{name}");
        assert!(exact.levels.iter().all(|level| level.waste == 0), "{name}");
        let matrices = if kind.has_skin { 128 } else { 0 };
        assert_eq!(
            exact.geometry_bytes + matrices,
            bytes.iter().sum::<u64>(),
            "{name}"
        );

        // What a level draws.
        let sum = |level: usize| {
            PREFIXES
                .iter()
                .map(|prefixes| prefixes[level] as u64)
                .sum::<u64>()
        };
        let counts: Vec<(u64, u64)> = exact
            .levels
            .iter()
            .map(|it| (it.faces, it.vertices))
            .collect();
        let expected =
            [(77, 2), (400, 1), (1200, 0)].map(|(faces, level)| (2 * faces + 30, sum(level) + 20));
        assert_eq!(counts, expected, "{name}");
        assert_eq!(exact.image_bytes, 1501, "{name}");

        // With gaps there are fewer ranges, and the first request goes on behind the JSON.
        let joined = ranges(&document, 4096);
        let first = &joined.levels[0];
        assert!(first.ranges.len() < exact.levels[0].ranges.len(), "{name}");
        assert!(first.ranges[0].start < joined.head_bytes + 8, "{name}");
        assert_eq!(first.bytes - first.waste, needed(kind)[0], "{name}");
        let shares = joined.levels.iter().map(|level| level.share);
        assert!(
            shares.is_sorted() && joined.levels[2].share >= 1.0,
            "{name}"
        );
    }
}

#[test]
fn as_json_a_range_has_a_file_a_start_and_a_length() {
    let kind = all()[0];
    let report = ranges(&open(made(kind).glb()), 0);
    let json: Value = serde_json::from_str(&report.to_json()).unwrap();
    assert_eq!(json["command"], "levels ranges");
    assert_eq!(json["head_bytes"], report.head_bytes);
    let [first, range] = [&json["levels"][0], &json["levels"][0]["ranges"][0]];
    assert_eq!((&first["level"], &first["faces"]), (&json!(2), &json!(184)));
    let expected = &report.levels[0].ranges[0];
    let expected = json!({"file": null, "start": expected.start, "length": expected.length});
    assert_eq!(range, &expected);
    assert_eq!(json["images"]["bytes"], 1501);
}

#[test]
fn data_beside_the_text_has_ranges_of_its_own_and_data_in_it_has_none() {
    let made = made(all()[0]);
    let mut json = made.builder.json(&made.meshes, &made.others);
    json["buffers"][0]["uri"] = json!("it.bin");
    let files = BTreeMap::from([(PathBuf::from("it.bin"), made.builder.binary.clone())]);
    let open = |text: String| {
        let beside = Surroundings::Memory(&files);
        let name = Path::new("made.gltf");
        let (text, limits) = (text.into_bytes(), Limits::default());
        Document::from_bytes_in(text, Format::Gltf, name, beside, limits).unwrap()
    };
    let text = json.to_string();
    let report = ranges(&open(text.clone()), 0);
    assert_eq!(report.head_bytes, text.len() as u64);
    let mut client = Client::new(&made.builder.binary, Some("it.bin".as_ref()));
    for level in &report.levels {
        assert!(
            level
                .ranges
                .iter()
                .all(|range| range.file.as_deref() == client.file)
        );
        client.fetch(&level.ranges);
    }
    json["buffers"][0].as_object_mut().unwrap().remove("uri");
    let beside = glb(&json.to_string(), Some(&client.bytes));
    let whole = Reader::of_file(NAME.as_ref(), Some(made.glb()));
    let has = Reader::of_file(NAME.as_ref(), Some(beside));
    assert!(has.triangles() == whole.triangles());

    // A triangle in the text.
    json["buffers"] =
        json!([{"byteLength": 36, "uri": format!("data:;base64,{}", "A".repeat(48))}]);
    json["bufferViews"] = json!([{"buffer": 0, "byteLength": 36}]);
    json["accessors"] =
        json!([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]);
    json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": 0}}]}]);
    for name in ["nodes", "images", "animations", "skins", "scenes"] {
        json.as_object_mut().unwrap().remove(name);
    }
    let report = ranges(&open(json.to_string()), 0);
    assert_eq!((report.levels.len(), report.geometry_bytes), (1, 0));
    assert_eq!((report.levels[0].faces, report.levels[0].bytes), (1, 0));
}

#[test]
fn files_without_ranges_are_refused() {
    let text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec();
    let other = Document::from_bytes(text, Format::Off, "a.off".as_ref(), Limits::default());
    let error = level_ranges(&other.unwrap(), &LevelRangesOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("only .gltf and .glb files"),
        "{error}"
    );
}

#[test]
fn real_scenes_are_drawn_from_their_ranges() {
    let mut ran = 0;
    for path in scenes() {
        let name = &path.display().to_string();
        let document = Document::open(&path, Limits::default()).unwrap();
        let report = ranges(&document, 4096);
        println!(
            "{name}: {} of {} bytes, {} ranges",
            report.geometry_bytes,
            report.bytes,
            report.levels[0].ranges.len()
        );
        let faces: usize = document
            .meshes()
            .iter()
            .map(|entry| entry.mesh.face_count())
            .sum();
        assert!(
            report.levels.len() == 1 && report.levels[0].faces >= faces as u64,
            "{name}"
        );
        if Format::of_path(&path) != Some(Format::Glb) {
            continue;
        }
        ran += 1;
        let whole = std::fs::read(&path).unwrap();
        let mut client = Client::new(&whole, None);
        client.fetch_head(&report);
        client.fetch(&report.levels[0].ranges);
        let has = Reader::of_file(&path, Some(client.bytes));
        assert!(
            has.triangles() == Reader::of_file(&path, None).triangles(),
            "{name}"
        );
    }
    println!("ran {ran} scenes");
}
