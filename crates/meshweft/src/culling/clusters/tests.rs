//! Clusters against what they are said to be.

use super::masks::{self, Mask};
use super::merge::{Merging, Price};
use super::{SampledEyes, Seen, ViewClusters, batches, face_cluster, moves};
use crate::cache::{CacheModel, nvidia};
use crate::culling::{Eye, Ranges};
use crate::faces::Faces;
use crate::index::{block_of, index32};
use crate::mesh::Mesh;
use crate::order::Optimizer;
use crate::random::SplitMix64;

/// A sheet of faces in rows, some of them left out, waved.
fn sheet(side: u32, random: &mut SplitMix64) -> Mesh {
    let at = |x: u32, y: u32| x + y * (side + 1);
    let positions = (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y)));
    let positions: Vec<[f32; 3]> = positions
        .map(|(x, y)| [x as f32, y as f32, random.below(8) as f32 / 4.0])
        .collect();
    let mut faces = Vec::new();
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        faces.push([at(x, y), at(x + 1, y), at(x, y + 1)]);
        if random.below(5) > 0 {
            faces.push([at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    Mesh::new(positions, faces).unwrap()
}

#[test]
fn no_two_clusters_are_left_that_save_something_as_one() {
    let mut random = SplitMix64(1);
    let mut merged = 0;
    for _ in 0..60 {
        let mesh = sheet(index32(2 + random.below(12)), &mut random);
        let face_count = mesh.face_count();
        let masks: Vec<Mask<1>> = (0..face_count)
            .map(|_| [random.next() | random.next() | 0xff << (8 * random.below(8))])
            .collect();
        let masks: Vec<Mask<1>> = masks
            .iter()
            .map(|[bits]| [bits & [u64::MAX, 0xffff, 0xff][random.below(3)]])
            .collect();
        let price = Price {
            vertex: 1.0,
            face: 0.5,
            draw: [0.0, 2.0][random.below(2)],
        };
        let apart = (0..index32(face_count)).collect();
        let first_of = Merging::new((&mesh).into(), &masks, apart, price, |_| false).run();

        // The clusters again, by their members.
        let members = |cluster: u32| {
            (0..face_count)
                .filter(|&face| first_of[face] == cluster)
                .collect::<Vec<_>>()
        };
        let firsts: Vec<u32> = (0..index32(face_count))
            .filter(|&face| first_of[face as usize] == face)
            .collect();
        let vertices = |members: &[usize]| {
            let corners = members.iter().flat_map(|&face| mesh.faces()[face]);
            corners.collect::<std::collections::BTreeSet<u32>>()
        };
        let cost = |members: &[usize]| {
            let mask = members
                .iter()
                .fold([0], |mask, &face| masks::union(&mask, &masks[face]));
            masks::count(&mask) as f32
                * price.weight(index32(vertices(members).len()), index32(members.len()))
        };
        for (number, &a) in firsts.iter().enumerate() {
            for &b in &firsts[..number] {
                let (a, b) = (members(a), members(b));
                let both: Vec<usize> = a.iter().chain(&b).copied().collect();
                if vertices(&a).intersection(&vertices(&b)).count() > 1 {
                    assert!(cost(&both) >= cost(&a) + cost(&b) - 1e-3);
                }
            }
        }
        merged += face_count - firsts.len();
    }
    assert!(merged > 500, "{merged} merges");
}

#[test]
fn moves_cost_less_and_know_what_they_cost() {
    let mut random = SplitMix64(5);
    let mut moved = 0;
    for _ in 0..60 {
        let mesh = sheet(index32(2 + random.below(12)), &mut random);
        let face_count = mesh.face_count();
        let any = |random: &mut SplitMix64| {
            [random.next() & random.next() & [u64::MAX, 0xffff, 0xff][random.below(3)]]
        };
        let masks: Vec<Mask<1>> = (0..face_count).map(|_| any(&mut random)).collect();
        let price = Price {
            vertex: 1.0,
            face: 0.5,
            draw: 2.0,
        };
        let cost = |first_of: &[u32]| {
            let firsts = (0..index32(face_count)).filter(|&face| first_of[face as usize] == face);
            let costs = firsts.map(|first| {
                let members = (0..face_count).filter(|&face| first_of[face] == first);
                let members: Vec<usize> = members.collect();
                let mask = members
                    .iter()
                    .fold([0], |mask, &face| masks::union(&mask, &masks[face]));
                let corners = members.iter().flat_map(|&face| mesh.faces()[face]);
                let vertices = corners.collect::<std::collections::BTreeSet<u32>>().len();
                masks::count(&mask) as f32 * price.weight(index32(vertices), index32(members.len()))
            });
            costs.sum::<f32>()
        };
        // Any clusters to begin with: strips of the sheet.
        let width = index32(1 + random.below(9));
        let mut first_of: Vec<u32> = (0..index32(face_count))
            .map(|face| face / width * width)
            .collect();
        let before = (cost(&first_of), first_of.clone());
        moves::improve((&mesh).into(), &masks, &mut first_of, price);
        let changed = first_of
            .iter()
            .zip(&before.1)
            .filter(|(a, b)| a != b)
            .count();
        assert!(
            cost(&first_of) <= before.0,
            "{} from {}",
            cost(&first_of),
            before.0
        );
        assert!(changed == 0 || cost(&first_of) < before.0);
        moved += changed;
    }
    assert!(moved > 500, "{moved} faces were moved");
}

#[test]
fn a_fan_of_many_faces_takes_no_time_by_the_square() {
    let count = 100_000_u32;
    let at = |i: u32| {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        [turn.cos(), turn.sin(), 0.0].map(crate::culling::planes::rounded)
    };
    let positions: Vec<[f32; 3]> = std::iter::once([0.0, 0.0, 1.0])
        .chain((0..count).map(at))
        .collect();
    let faces: Vec<[u32; 3]> = (0..count)
        .map(|i| [0, 1 + i, 1 + (i + 1) % count])
        .collect();
    let mesh = Mesh::new(positions, faces).unwrap();
    let clustered = ViewClusters::default().order(&mesh);
    assert!(clustered.table().cluster_count() < 10_000);
}

#[test]
fn bits_are_counted() {
    let mut random = SplitMix64(2);
    for _ in 0..100 {
        let mask: Mask<8> = std::array::from_fn(|_| random.next() | random.next());
        assert_eq!(
            masks::count(&mask),
            mask.iter().map(|word| word.count_ones()).sum::<u32>()
        );
    }
    assert_eq!(masks::count(&[u64::MAX; 8]), 512);
}

#[test]
fn each_face_is_in_one_cluster_whatever_the_mesh() {
    let far = [f32::MAX, 1.0, 2.0];
    type Arrays<'a> = (&'a [[f32; 3]], &'a [[u32; 3]]);
    let odd: [Arrays<'_>; 6] = [
        (&[], &[]),
        (&[[0.0; 3]], &[[0, 0, 0]]),
        (
            &[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
            &[[0, 1, 2], [0, 0, 1]],
        ),
        (
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, f32::NAN, 0.0]],
            &[[0, 1, 2]],
        ),
        (&[[0.0; 3], far, [0.0, f32::MAX, -f32::MAX]], &[[0, 1, 2]]),
        (
            &[[0.0; 3], [1e-42, 0.0, 0.0], [0.0, 1e-42, 0.0]],
            &[[0, 1, 2]],
        ),
    ];
    for (positions, faces) in odd {
        let mesh = Mesh::new(positions.to_vec(), faces.to_vec()).unwrap();
        for clusters in [ViewClusters::default(), for_card()] {
            let clustered = clusters.order(&mesh);
            assert_eq!(clustered.order().len(), faces.len());
            assert_eq!(
                *clustered.table().starts().last().unwrap() as usize,
                faces.len()
            );
            let mut ranges = Ranges::default();
            clustered
                .table()
                .visible_ranges(Eye::at([3.0, 2.0, 5.0]), &mut ranges);
            assert!(ranges.face_count() <= faces.len());
        }
    }
}

#[test]
fn faces_that_share_nothing_are_in_few_clusters() {
    let mut random = SplitMix64(3);
    let mut positions = Vec::new();
    for _ in 0..3000 {
        let corner = [(); 3].map(|()| random.below(1000) as f32);
        positions.push(corner);
        positions.push([corner[0] + 1.0, corner[1], corner[2]]);
        positions.push([
            corner[0],
            corner[1] + 1.0,
            corner[2] + random.below(3) as f32,
        ]);
    }
    let faces = Faces::from_indices(&(0..9000).collect::<Vec<u32>>(), 9000)
        .unwrap()
        .as_slice()
        .to_vec();
    let mesh = Mesh::new(positions, faces).unwrap();
    let clustered = ViewClusters::default().order(&mesh);
    assert!(
        clustered.table().cluster_count() < 300,
        "{}",
        clustered.table().cluster_count()
    );
}

#[test]
fn cameras_of_ones_own_are_what_is_made_for() {
    // Seen from above alone, all that faces up is one cluster.
    let mut random = SplitMix64(4);
    let mesh = sheet(40, &mut random);
    let above = (0..448)
        .map(|i| Eye::at([i as f32 / 64.0, 4.0, 1000.0]))
        .collect();
    let ours = ViewClusters {
        eyes: SampledEyes::These(above),
        ..ViewClusters::default()
    };
    let [ours, all_around] = [ours, ViewClusters::default()]
        .map(|clusters| clusters.order(&mesh).table().cluster_count());
    assert!(
        ours < all_around,
        "{ours} clusters, {all_around} for all around"
    );
}

fn for_card() -> ViewClusters {
    ViewClusters {
        optimizer: Optimizer::for_cache(CacheModel::Nvidia),
        ..ViewClusters::default()
    }
}

/// Each cluster drawn by itself, they take about the warps of all in one draw; other clusters take more.
#[test]
fn clusters_for_a_card_are_whole_batches() {
    let mut random = SplitMix64(8);
    let (mut alone, mut at_once, mut floor) = ([0, 0], [0, 0], 0);
    for side in [20, 40, 60] {
        let mesh = sheet(side, &mut random);
        floor += mesh.face_count().div_ceil(32) as u64;
        for (i, clusters) in [for_card(), ViewClusters::default()].iter().enumerate() {
            let clustered = clusters.order(&mesh);
            let faces = clustered.order().apply(mesh.faces());
            at_once[i] += nvidia::counts(&faces).warps;
            let ends = clustered.table().starts().windows(2);
            alone[i] += ends
                .map(|ends| nvidia::counts(&faces[ends[0] as usize..ends[1] as usize]).warps)
                .sum::<u64>();
        }
    }
    assert!(alone[0] * 100 <= at_once[0] * 102, "{alone:?}, {at_once:?}");
    assert!(at_once[0] * 100 <= floor * 110, "{at_once:?}, {floor}");
    assert!(alone[1] * 100 > at_once[1] * 104, "{alone:?}, {at_once:?}");
}

#[test]
fn batches_of_a_card_keep_to_blocks_of_vertices() {
    // The upper half of a sheet stands in the second block.
    let flat = sheet(70, &mut SplitMix64(9));
    let half = index32(flat.vertex_count() / 2);
    let moved = |vertex: u32| match vertex < half {
        true => vertex,
        false => (1 << 16) + vertex - half,
    };
    let mut positions = vec![[0.0; 3]; (1 << 16) + flat.vertex_count()];
    for (vertex, &position) in (0..).zip(flat.positions()) {
        positions[moved(vertex) as usize] = position;
    }
    let faces = flat.faces().iter().map(|face| face.map(moved));
    let mesh = Mesh::new(positions, faces.collect::<Vec<_>>()).unwrap();

    // All faces are one cluster, column by column: each column has faces of both blocks.
    let mut random = SplitMix64(10);
    let masks: Vec<Mask<1>> = (0..mesh.face_count()).map(|_| [random.next()]).collect();
    let all: Vec<u32> = (0..index32(mesh.face_count())).collect();
    let seen = Seen {
        mesh: &mesh,
        faces: &all,
        masks: &masks,
        directions: &[[1.0, 0.0, 0.0]; 64],
    };
    let column = |face: u32| mesh.positions()[mesh.faces()[face as usize][0] as usize][0];
    let mut by_column = all.clone();
    by_column.sort_by(|&a, &b| column(a).total_cmp(&column(b)));
    let one = face_cluster::gathered(&seen, [(&*by_column, 0)].into_iter());
    let made = batches::batches(&seen, one, |runs| runs);

    let mut drawn: Vec<u32> = made.concat();
    drawn.sort_unstable();
    assert_eq!(drawn, all);
    let mut blocks = [0, 0, 0];
    for batch in &made {
        let block = |&face: &u32| {
            let [a, b, c] = mesh.faces()[face as usize].map(block_of);
            if a == b && b == c { a } else { 2 }
        };
        assert!(batch.iter().all(|face| block(face) == block(&batch[0])));
        blocks[block(&batch[0]) as usize] += 1;
        let corners = batch.iter().flat_map(|&face| mesh.faces()[face as usize]);
        let vertices = corners.collect::<std::collections::BTreeSet<u32>>();
        assert!(batch.len() <= 32 && vertices.len() <= 32);
    }
    assert!(blocks.iter().all(|&count| count > 1), "{blocks:?}");
}
