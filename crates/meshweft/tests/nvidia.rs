//! The model of an NVIDIA card against what cards counted, where their counts are at hand, and
//! against the rules carried out literally.
#![cfg(feature = "files")]

#[path = "data/folder.rs"]
mod folder;

use std::io::Read;

use folder::folder;
use meshweft::cache::nvidia::{self, Draw, DrawCounts, PrimitiveTopology};
use meshweft::files::Document;
use meshweft::{CacheModel, Limits, cache};
use proptest::prelude::*;
use serde_json::Value;

/// The lines of a gzipped file of JSON.
fn lines(name: &str) -> Option<Vec<Value>> {
    let file = std::fs::File::open(folder()?.join("nvidia").join(name)).unwrap();
    let mut text = String::new();
    flate2::read::GzDecoder::new(file)
        .read_to_string(&mut text)
        .unwrap();
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
    Some(lines.collect())
}

fn indices(line: &Value) -> Vec<u32> {
    let indices = line["indices"].as_array().unwrap().iter();
    indices
        .map(|v| u32::try_from(v.as_u64().unwrap()).unwrap())
        .collect()
}

#[test]
fn every_list_that_a_card_drew_counts_the_same() {
    let Some(lines) = lines("list-draws.jsonl.gz") else {
        return;
    };
    assert!(lines.len() > 600);
    for line in &lines {
        let indices = indices(line);
        let draw = Draw {
            vertex_offset: line["vertex_offset"]
                .as_i64()
                .unwrap_or(0)
                .try_into()
                .unwrap(),
            instances: line["instances"].as_u64().unwrap().try_into().unwrap(),
            ..Draw::new(&indices)
        };
        let counts = draw.counts();
        let counted = ["invocations", "warps"].map(|key| line[key].as_u64().unwrap());
        assert_eq!(
            [counts.invocations, counts.warps],
            counted,
            "{}",
            line["name"]
        );
    }
}

#[test]
fn setup_cycles_are_those_that_a_card_took() {
    let Some(lines) = lines("setup-cycles.jsonl.gz") else {
        return;
    };
    assert!(lines.len() > 300);
    let mut worst: f64 = 0.0;
    for line in &lines {
        let cycles = Draw::new(&indices(line)).counts().setup_cycles as f64;
        let difference = (cycles - line["cycles"].as_f64().unwrap()).abs();
        assert!(
            difference <= 0.3,
            "{}: {cycles} for {}",
            line["name"],
            line["cycles"]
        );
        worst = worst.max(difference);
    }
    assert!(worst < 0.1, "{worst}");
}

#[test]
fn the_bunny_in_file_order() {
    let Some(folder) = folder() else { return };
    let path = folder.join("meshes/bunny.ply.gz");
    let document = Document::open(&path, Limits::default()).unwrap();
    let bunny = &document.meshes()[0].mesh;
    let report = cache::report(bunny, CacheModel::Nvidia);
    assert_eq!(format!("{:.3}", report.atvr()), "4.226");
    assert_eq!(nvidia::counts(bunny).invocations, report.misses);
}

/// The rules carried out one by one, with the whole batch looked through at each corner.
fn literally(primitives: &[Vec<(u32, u32)>]) -> [u64; 5] {
    let mut batches: Vec<Vec<Vec<(u32, u32, usize)>>> = Vec::new();
    let mut seen: Vec<(usize, (u32, u32), usize)> = Vec::new();
    let (mut at, mut run, mut previous) = (0, 0, None);
    let mut lanes = 0;
    for corners in primitives {
        for is_retry in [false, true] {
            let (saved_run, saved_previous, saved_seen) = (run, previous, seen.clone());
            let batch = batches.len();
            let mut drawn = Vec::new();
            let mut misses = 0;
            for (i, &(vertex, instance)) in corners.iter().enumerate() {
                let now = at + i;
                if previous != Some((vertex >> 16, instance)) {
                    run = now;
                    previous = Some((vertex >> 16, instance));
                }
                let used = seen.iter().rev().find(|(_, v, _)| *v == (vertex, instance));
                let lane = match used {
                    Some(&(q, _, lane)) if now - q <= 42 && q >= run => lane,
                    _ => {
                        misses += 1;
                        lanes + misses - 1
                    }
                };
                seen.push((now, (vertex, instance), lane));
                drawn.push((vertex, instance, lane));
            }
            let is_full = batch == 0 || batches[batch - 1].len() == 32 || lanes + misses > 32;
            if is_full && !is_retry {
                batches.push(Vec::new());
                (run, previous, seen) = (saved_run, saved_previous, saved_seen);
                (lanes, _) = (0, seen.clear());
                continue;
            }
            lanes += misses;
            batches.last_mut().unwrap().push(drawn);
            break;
        }
        at += corners.len();
    }

    let mut totals = [0, 0, batches.len() as u64, 0, 0];
    for batch in &batches {
        let corners: Vec<_> = batch.iter().flatten().collect();
        let mut vertices: Vec<_> = corners.iter().map(|c| (c.0, c.1)).collect();
        let mut lanes: Vec<_> = corners.iter().map(|c| c.2).collect();
        vertices.sort_unstable();
        vertices.dedup();
        lanes.sort_unstable();
        lanes.dedup();
        totals[0] += batch.len() as u64;
        totals[1] += lanes.len() as u64;
        totals[3] += vertices.len() as u64;
        totals[4] += setup_literally(batch);
    }
    totals
}

fn setup_literally(batch: &[Vec<(u32, u32, usize)>]) -> u64 {
    let (mut slots, mut hand, mut cycles) = ([None; 9], 0, 1);
    for triangle in batch.iter().filter(|corners| corners.len() == 3) {
        let own: Vec<usize> = triangle.iter().map(|c| c.2).collect();
        let mut misses = 0;
        for &lane in &own {
            if slots.contains(&Some(lane)) {
                continue;
            }
            misses += 1;
            while slots[hand].is_some_and(|lane| own.contains(&lane)) {
                hand = (hand + 1) % 9;
            }
            slots[hand] = Some(lane);
            hand = (hand + 1) % 9;
        }
        cycles += misses.max(1);
    }
    cycles
}

fn totals(counts: DrawCounts) -> [u64; 5] {
    let DrawCounts {
        primitives,
        invocations,
        warps,
        distinct_vertices,
        setup_cycles,
        ..
    } = counts;
    [
        primitives,
        invocations,
        warps,
        distinct_vertices,
        setup_cycles,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn soups_count_as_the_rules_say(
        span in 3_u32..120,
        drift in 0_u32..3,
        offset in prop::sample::select(vec![0, 65_500, 131_000]),
        instances in 1_u32..4,
        numbers in prop::collection::vec(any::<u32>(), 3..600),
    ) {
        let indices: Vec<u32> = (0..).zip(&numbers).map(|(i, n)| n % span + i * drift / 2).collect();
        let draw = Draw { vertex_offset: offset, instances, ..Draw::new(&indices) };
        let primitives: Vec<Vec<(u32, u32)>> = (0..instances)
            .flat_map(|instance| indices.chunks_exact(3).map(move |face| (instance, face)))
            .map(|(instance, face)| {
                face.iter().map(|v| (v.wrapping_add_signed(offset), instance)).collect()
            })
            .collect();
        prop_assert_eq!(totals(draw.counts()), literally(&primitives));
    }
}

#[test]
fn strips_fans_and_lines_are_the_lists_that_they_stand_for() {
    let indices: Vec<u32> = (0..90).map(|i| i * 7 % 41).collect();
    let part = |from: usize, to: usize| &indices[from..to];
    let restart = Some(u32::MAX);
    let with_restart = [part(0, 30), &[u32::MAX], part(30, 90)].concat();

    let strip = |part: &[u32]| -> Vec<u32> {
        let triangles = part.windows(3).enumerate();
        let turned = triangles.map(|(i, t)| {
            if i % 2 == 0 {
                [t[0], t[1], t[2]]
            } else {
                [t[0], t[2], t[1]]
            }
        });
        turned.flatten().collect()
    };
    let fan = |part: &[u32]| -> Vec<u32> {
        part[1..]
            .windows(2)
            .flat_map(|pair| [pair[0], pair[1], part[0]])
            .collect()
    };
    for (topology, list) in [
        (
            PrimitiveTopology::TriangleStrip,
            [strip(part(0, 30)), strip(part(30, 90))].concat(),
        ),
        (
            PrimitiveTopology::TriangleFan,
            [fan(part(0, 30)), fan(part(30, 90))].concat(),
        ),
    ] {
        let draw = Draw {
            topology,
            restart,
            ..Draw::new(&with_restart)
        };
        assert_eq!(draw.counts(), Draw::new(&list).counts(), "{topology:?}");
    }

    let line_strip = Draw {
        topology: PrimitiveTopology::LineStrip,
        ..Draw::new(part(0, 30))
    };
    let lines: Vec<u32> = part(0, 30).windows(2).flatten().copied().collect();
    let line_list = Draw {
        topology: PrimitiveTopology::LineList,
        ..Draw::new(&lines)
    };
    assert_eq!(line_strip.counts(), line_list.counts());
    assert_eq!(line_list.counts().primitives, 29);
}

/// Cases small enough to be counted by hand.
#[test]
fn a_batch_ends_where_it_should() {
    let count = |indices: &[u32]| {
        let counts = Draw::new(indices).counts();
        (
            counts.invocations,
            counts.warps,
            counts.distinct_vertices,
            counts.setup_cycles,
        )
    };
    // One triangle again and again: 32 in a batch.
    assert_eq!(count(&[0, 1, 2].repeat(32)), (3, 1, 3, 35));
    assert_eq!(count(&[0, 1, 2].repeat(33)), (6, 2, 6, 39));
    // Triangles apart: ten have 30 vertices, the eleventh does not fit.
    let apart: Vec<u32> = (0..33).collect();
    assert_eq!(count(&apart), (33, 2, 33, 35));
    // A vertex is found 42 corners later, not 43: a second lane, but the same vertex to load.
    let away = |corners: usize| [&[9, 1, 2][..], &[3, 4, 5].repeat(20)[..corners - 1]].concat();
    let back = |corners: usize| [away(corners), vec![9, 3, 4]].concat();
    assert_eq!(count(&back(40)), (6, 1, 6, 4 + 3 + 13));
    assert_eq!(count(&back(43)), (7, 1, 6, 4 + 3 + 14));
    // A line takes its second vertex first; 32 lines in a batch, no setup of triangles.
    let lines: Vec<u32> = (0..20).flat_map(|i| [i, i + 1]).collect();
    let draw = Draw {
        topology: PrimitiveTopology::LineList,
        ..Draw::new(&lines)
    };
    assert_eq!(
        (draw.counts().invocations, draw.counts().setup_cycles),
        (21, 1)
    );
    // No primitive, no warp.
    assert_eq!(Draw::new(&[1, 2]).counts(), DrawCounts::default());
}

#[test]
fn a_change_of_block_or_instance_forgets_all() {
    let faces = [0, 1, 65_536, 0, 1, 65_536];
    assert_eq!(Draw::new(&faces).counts().invocations, 6);
    assert_eq!(Draw::new(&faces).counts().distinct_vertices, 3);
    let twice = Draw {
        instances: 2,
        ..Draw::new(&[0, 1, 2])
    };
    assert_eq!((twice.counts().invocations, twice.counts().warps), (6, 1));
    let alike = Draw {
        reads_instance: false,
        ..twice
    };
    assert_eq!((alike.counts().invocations, alike.counts().warps), (3, 1));
}
