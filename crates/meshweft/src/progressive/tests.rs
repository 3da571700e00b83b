//! What holds for every progressive mesh: checked level by level, by brute force.

use std::collections::{BTreeMap, BTreeSet};

use super::made::{grid, hills, somewhere, sphere};
use super::{Collapses, ProgressiveMesh, StopReason, Walk};
use crate::Mesh;
use crate::attribute::{Attribute, Semantic};
use crate::order::Effort;
use crate::random::SplitMix64;

pub(super) const EFFORTS: [Effort; 2] = [Effort::Fast, Effort::Best];

pub(super) fn vertex_count(faces: &[[u32; 3]]) -> usize {
    faces
        .as_flattened()
        .iter()
        .max()
        .map_or(0, |&last| last as usize + 1)
}

/// Edges by how many faces have them in one and in the other direction.
pub(super) fn edges(faces: &[[u32; 3]]) -> BTreeMap<[u32; 2], [u32; 2]> {
    let mut edges: BTreeMap<_, [u32; 2]> = BTreeMap::new();
    for &[a, b, c] in faces {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            edges.entry([from.min(to), from.max(to)]).or_default()[usize::from(from > to)] += 1;
        }
    }
    edges
}

/// Vertices − edges + faces, and the number of open edges' loops that the border has.
pub(super) fn topology(faces: &[[u32; 3]]) -> (i64, bool) {
    let vertices: BTreeSet<u32> = faces.as_flattened().iter().copied().collect();
    let edges = edges(faces);
    let is_manifold = edges.values().all(|&[there, back]| there <= 1 && back <= 1);
    (
        vertices.len() as i64 - edges.len() as i64 + faces.len() as i64,
        is_manifold,
    )
}

/// Calls `check` with the faces of each level.
pub(super) fn at_each_level(mesh: &ProgressiveMesh, mut check: impl FnMut(usize, &[[u32; 3]])) {
    let mut walk = Walk::new(mesh);
    let mut faces = Vec::new();
    for level in 0..=mesh.last_level() {
        walk.go_to(level);
        walk.emit(&mut faces);
        check(level, &faces);
    }
}

/// The faces of the last level.
pub(super) fn coarsest(mesh: &ProgressiveMesh) -> Vec<[u32; 3]> {
    let mut walk = Walk::new(mesh);
    walk.go_to(mesh.last_level());
    let mut faces = Vec::new();
    walk.emit(&mut faces);
    faces
}

#[test]
fn manifolds_stay_manifolds_of_the_same_topology() {
    for (faces, seed) in [
        (grid(9, 7), 1),
        (sphere(3), 2),
        (grid(30, 1), 3),
        (sphere(0), 4),
    ] {
        let count = vertex_count(&faces);
        let mesh = Mesh::new(somewhere(count, seed), faces.clone()).unwrap();
        for effort in EFFORTS {
            let progressive = Collapses {
                effort,
                ..Collapses::default()
            }
            .build(&mesh, &[])
            .unwrap();
            let (euler, _) = topology(&faces);
            at_each_level(&progressive, |level, faces| {
                assert_eq!(topology(faces), (euler, true), "level {level}");
                assert_eq!(faces.len(), progressive.face_count(level));
                let sorted = |mut face: [u32; 3]| {
                    face.sort_unstable();
                    face
                };
                let distinct: BTreeSet<_> = faces.iter().map(|&face| sorted(face)).collect();
                assert_eq!(distinct.len(), faces.len(), "a face twice at level {level}");
            });
        }
    }
}

/// Every record is one that a history takes, and both have the same faces.
pub(super) fn agrees_with_its_history(progressive: &ProgressiveMesh) {
    let history = progressive.history().unwrap();
    assert_eq!(history.len(), progressive.last_level());
    at_each_level(progressive, |level, faces| {
        if level % 7 == 0 || level == progressive.last_level() {
            let numbers = history.faces_at(level);
            let mut expected: Vec<_> = numbers.iter().map(|&number| history.face(number)).collect();
            let mut faces = faces.to_vec();
            expected.sort_unstable();
            faces.sort_unstable();
            assert_eq!(faces, expected, "level {level}");
        }
    });
}

#[test]
fn new_faces_are_listed_around_the_vertex() {
    for (faces, seed) in [(sphere(3), 1), (grid(12, 9), 2)] {
        let positions = somewhere(vertex_count(&faces), seed);
        let mesh = Mesh::new(positions, faces).unwrap();
        let progressive = Collapses::default().build(&mesh, &[]).unwrap();
        let history = progressive.history().unwrap();
        for record in history.records() {
            // Around the vertex: what follows each neighbour.
            let (vertex, into) = (record.removed_vertices[0], record.merges_into[0]);
            let sides = record.removed_faces.iter().map(|&number| {
                let face = history.face(number);
                let at = face.iter().position(|&corner| corner == vertex).unwrap();
                (face[(at + 1) % 3], face[(at + 2) % 3])
            });
            let sides: BTreeMap<u32, u32> = sides.collect();
            let is_new = |&(&from, &to): &(&u32, &u32)| from != into && to != into;
            let start = sides.iter().filter(is_new).map(|(&from, _)| from).min();

            // From the lowest on, then from the border on, if there is one.
            let is_end = |from: &&u32| !sides.values().any(|to| to == *from);
            let border = sides.keys().find(is_end).copied();
            let (mut expected, mut from) = (Vec::new(), start);
            while let Some(neighbour) = from {
                let to = sides.get(&neighbour).copied();
                if let Some(to) = to.filter(|&to| neighbour != into && to != into) {
                    expected.push([into, neighbour, to]);
                }
                from = to.or(border).filter(|&next| Some(next) != start);
            }

            let inserted = record.inserted_faces.map(|number| {
                let mut face = history.face(number);
                let at = face.iter().position(|&corner| corner == into).unwrap();
                face.rotate_left(at);
                face
            });
            assert_eq!(inserted.collect::<Vec<_>>(), expected);
        }
    }
}

#[test]
fn soups_give_records_that_a_history_takes() {
    let mut random = SplitMix64(5);
    for round in 0..1000 {
        let vertices = 1 + random.below(12);
        let faces: Vec<[u32; 3]> = (0..random.below(40))
            .map(|_| [(); 3].map(|()| u32::try_from(random.below(vertices)).unwrap()))
            .collect();
        // A few places only, so that vertices share points.
        let places = somewhere(1 + random.below(vertices), round);
        let positions: Vec<_> = (0..vertices)
            .map(|_| places[random.below(places.len())])
            .collect();
        let ids: Vec<[f32; 1]> = (0..vertices).map(|_| [random.below(2) as f32]).collect();
        let attributes = [Attribute::of_vertices(Semantic::TexCoord(0), &ids)];
        let mesh = Mesh::new(positions, faces).unwrap();
        let settings = Collapses {
            effort: EFFORTS[random.below(2)],
            drop_parts: random.below(2) == 0,
            lock_border: random.below(4) == 0,
            ..Collapses::default()
        };
        agrees_with_its_history(&settings.build(&mesh, &attributes).unwrap());
    }
}

#[test]
fn a_sheet_with_hills_gives_records_that_a_history_takes() {
    agrees_with_its_history(&Collapses::default().build(&hills(20, 20), &[]).unwrap());
}

#[test]
fn what_is_flat_goes_without_an_error() {
    let square = |i: u32| [(i % 13) as f32, (i / 13) as f32, 0.0];
    let positions: Vec<[f32; 3]> = (0..13 * 9).map(square).collect();
    let mesh = Mesh::new(positions, grid(12, 8)).unwrap();
    for effort in EFFORTS {
        let progressive = Collapses {
            effort,
            ..Collapses::default()
        }
        .build(&mesh, &[])
        .unwrap();
        assert_eq!(progressive.face_count(progressive.level_of_error(1e-6)), 2);
        // The last two are as they are: an ear would leave a corner of the square.
        assert_eq!(progressive.stop(), StopReason::NothingLeft);
        let limited = Collapses {
            effort,
            error: 1e-6,
            ..Collapses::default()
        }
        .build(&mesh, &[])
        .unwrap();
        assert_eq!(
            (limited.face_count(limited.last_level()), limited.stop()),
            (2, StopReason::Error)
        );
        let fewer = Collapses {
            effort,
            faces: 50,
            ..Collapses::default()
        }
        .build(&mesh, &[])
        .unwrap();
        assert_eq!(
            (fewer.face_count(fewer.last_level()), fewer.stop()),
            (50, StopReason::Faces)
        );
    }
}

#[test]
fn a_needle_keeps_its_point() {
    // A square with a needle in the middle: planes say nothing about how long it is.
    let mut positions: Vec<[f32; 3]> = (0..81)
        .map(|i| [(i % 9) as f32, (i / 9) as f32, 0.0])
        .collect();
    positions[40] = [4.0, 4.0, 50.0];
    for near in [30, 31, 32, 39, 41, 48, 49, 50] {
        let toward = |axis: usize, of: [f32; 3]| 4.0 + (of[axis] - 4.0) * 0.01;
        positions[near] = [toward(0, positions[near]), toward(1, positions[near]), 0.0];
    }
    let mesh = Mesh::new(positions, grid(8, 8)).unwrap();
    for effort in EFFORTS {
        let progressive = Collapses {
            effort,
            faces: 20,
            ..Collapses::default()
        }
        .build(&mesh, &[])
        .unwrap();
        let faces = coarsest(&progressive);
        assert!(faces.as_flattened().contains(&40));
    }
}

#[test]
fn attributes_hold_vertices() {
    // Flat, but the texture coordinates have a fold in the middle.
    let positions: Vec<[f32; 3]> = (0..81)
        .map(|i| [(i % 9) as f32, (i / 9) as f32, 0.0])
        .collect();
    let folded: Vec<[f32; 2]> = positions
        .iter()
        .map(|&[x, y, _]| [(x - 4.0).abs(), y])
        .collect();
    let straight: Vec<[f32; 2]> = positions.iter().map(|&[x, y, _]| [3.0 * x, y]).collect();
    let mesh = Mesh::new(positions, grid(8, 8)).unwrap();
    let left = |coordinates: &[[f32; 2]]| {
        let attributes = [Attribute::of_vertices(Semantic::TexCoord(0), coordinates)];
        let progressive = Collapses::default().build(&mesh, &attributes).unwrap();
        progressive.face_count(progressive.level_of_error(1e-4))
    };
    assert_eq!((left(&straight), left(&folded)), (2, 4));
}

#[test]
fn vertices_of_the_same_record_count_as_one() {
    // Three vertices a face, as in a file without an index list.
    let sheet = hills(6, 6);
    let positions: Vec<_> = sheet
        .faces()
        .iter()
        .flatten()
        .map(|&v| sheet.positions()[v as usize])
        .collect();
    let faces: Vec<[u32; 3]> = (0..72)
        .map(|face| [3 * face, 3 * face + 1, 3 * face + 2])
        .collect();
    let mesh = Mesh::new(positions, faces).unwrap();
    let [split, whole] = [&mesh, &sheet].map(|mesh| Collapses::default().build(mesh, &[]).unwrap());
    assert_eq!(
        split.face_count(split.last_level()),
        whole.face_count(whole.last_level())
    );
    let coarse = split.fine_to_coarse(split.last_level());
    let faces = coarsest(&split);
    assert!(
        coarse
            .iter()
            .all(|to| faces.as_flattened().contains(&to.unwrap()))
    );
}

#[test]
fn borders_stay_and_parts_leave_on_request() {
    let mesh = hills(8, 8);
    let locked = Collapses {
        lock_border: true,
        ..Collapses::default()
    }
    .build(&mesh, &[])
    .unwrap();
    let is_border = |vertex: u32| [0, 8].contains(&(vertex % 9)) || !(9..72).contains(&vertex);
    assert!(
        locked
            .removal_order()
            .iter()
            .all(|&vertex| !is_border(vertex))
    );
    assert_eq!(locked.removal_order().len(), 49);

    // A tetrahedron beside cannot be simplified.
    let tip = u32::try_from(mesh.vertex_count()).unwrap();
    let mut positions = mesh.positions().to_vec();
    positions.extend([
        [9.0, 0.0, 0.0],
        [9.1, 0.0, 0.0],
        [9.0, 0.1, 0.0],
        [9.0, 0.0, 0.1],
    ]);
    let mut faces = mesh.faces().to_vec();
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    faces.extend(tetrahedron.map(|face| face.map(|vertex| vertex + tip)));
    let mesh = Mesh::new(positions, faces).unwrap();
    let kept = Collapses::default().build(&mesh, &[]).unwrap();
    assert!(kept.removal_order().iter().all(|&vertex| vertex < tip));
    let dropped = Collapses {
        drop_parts: true,
        ..Collapses::default()
    }
    .build(&mesh, &[])
    .unwrap();
    let left: Vec<_> = dropped
        .removal_order()
        .into_iter()
        .filter(|&vertex| vertex >= tip)
        .collect();
    assert_eq!(left, [tip, tip + 1, tip + 2, tip + 3]);
    assert_eq!(
        dropped.fine_to_coarse(dropped.last_level())[tip as usize],
        None
    );
    assert!(dropped.face_count(dropped.last_level()) > 0);
    agrees_with_its_history(&dropped);
}

#[test]
fn odd_meshes_are_left_as_far_as_they_must() {
    // Two sheets that cross in an edge: the edge stays.
    let positions = somewhere(5, 1);
    let mesh = Mesh::new(positions, [[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
    let progressive = Collapses::default().build(&mesh, &[]).unwrap();
    assert!(progressive.removal_order().iter().all(|&vertex| vertex > 1));

    // Coordinates that are nowhere stay, and faces with a corner twice leave first.
    let sheet = hills(4, 4);
    let mut positions = sheet.positions().to_vec();
    positions[12] = [f32::NAN, 0.0, 0.0];
    positions[6] = [f32::INFINITY; 3];
    let mut faces = sheet.faces().to_vec();
    faces.push([3, 3, 4]);
    let mesh = Mesh::new(positions, faces).unwrap();
    let progressive = Collapses::default().build(&mesh, &[]).unwrap();
    assert!(
        !progressive.removal_order().contains(&12) && !progressive.removal_order().contains(&6)
    );
    assert_eq!(progressive.collapse(0).leaving_faces(), [32]);

    let empty = Collapses::default().build(&Mesh::default(), &[]).unwrap();
    assert_eq!((empty.last_level(), empty.stop()), (0, StopReason::Faces));
    let blind = Mesh::connectivity_only(3, [[0, 1, 2]]).unwrap();
    assert_eq!(
        Collapses::default()
            .build(&blind, &[])
            .unwrap_err()
            .to_string(),
        "positions: expected 3 entries, found 0"
    );
}

#[test]
fn a_point_of_many_faces_takes_no_more_time() {
    // A cone of 20,000 faces: quadratic work would take minutes.
    let around = 20_000_u32;
    let mut positions = vec![[0.0, 0.0, 5.0]];
    positions.extend((0..around).map(|i| {
        let angle = i as f32 / around as f32 * std::f32::consts::TAU;
        [angle.cos(), angle.sin(), 0.0]
    }));
    let faces: Vec<[u32; 3]> = (0..around)
        .map(|i| [0, 1 + i, 1 + (i + 1) % around])
        .collect();
    let mesh = Mesh::new(positions, faces).unwrap();
    for effort in EFFORTS {
        let progressive = Collapses {
            effort,
            faces: 100,
            ..Collapses::default()
        }
        .build(&mesh, &[])
        .unwrap();
        assert_eq!(progressive.face_count(progressive.last_level()), 100);
        assert!(!progressive.removal_order().contains(&0));
    }
}
