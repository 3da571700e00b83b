//! What holds where several vertices stand at one point.

use std::collections::{BTreeMap, BTreeSet};

use crate::Mesh;
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::progressive::made::{boxed, grid, hills, somewhere, sphere};
use crate::progressive::tests::{
    EFFORTS, agrees_with_its_history, at_each_level, coarsest, edges, topology, vertex_count,
};
use crate::progressive::{Collapses, ProgressiveMesh, Walk};
use crate::random::SplitMix64;

type Point = [u32; 3];

fn point(mesh: &Mesh, vertex: u32) -> Point {
    mesh.positions()[vertex as usize].map(|x| (x + 0.0).to_bits())
}

/// The same surface with a vertex for each corner, numbered by `side`, which may give corners of one vertex
/// the same number.
fn split(mesh: &Mesh, mut side: impl FnMut(usize) -> u32) -> (Mesh, Vec<u32>) {
    let mut numbers = BTreeMap::new();
    let (mut positions, mut sides) = (Vec::new(), Vec::new());
    let mut corner = 0;
    let faces: Vec<[u32; 3]> = mesh
        .faces()
        .iter()
        .map(|face| {
            face.map(|vertex| {
                let key = (vertex, side(corner));
                corner += 1;
                *numbers.entry(key).or_insert_with(|| {
                    positions.push(mesh.positions()[vertex as usize]);
                    sides.push(key.1);
                    u32::try_from(positions.len() - 1).unwrap()
                })
            })
        })
        .collect();
    (Mesh::new(positions, faces).unwrap(), sides)
}

/// Edges without an opposite one, by position.
fn open_edges(mesh: &Mesh, faces: &[[u32; 3]]) -> BTreeSet<[Point; 2]> {
    let mut open = BTreeMap::new();
    for face in faces {
        let [a, b, c] = face.map(|vertex| point(mesh, vertex));
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let sign = if from < to { 1 } else { -1 };
            *open.entry([from.min(to), from.max(to)]).or_insert(0) += sign;
        }
    }
    open.retain(|_, count| *count != 0);
    open.into_keys().collect()
}

/// Vertices at one point stay at one point, none is there twice or left without a place, and no edge opens.
fn does_not_tear(mesh: &Mesh, progressive: &ProgressiveMesh) {
    let used: BTreeSet<u32> = mesh.faces().as_flattened().iter().copied().collect();
    let border = open_edges(mesh, mesh.faces());
    let on_border: BTreeSet<Point> = border.iter().flatten().copied().collect();
    at_each_level(progressive, |level, faces| {
        let open = open_edges(mesh, faces);
        assert!(open.len() <= border.len(), "level {level}");
        assert!(open.iter().flatten().all(|end| on_border.contains(end)));

        let here: BTreeSet<u32> = faces.as_flattened().iter().copied().collect();
        let mut places = BTreeMap::new();
        let coarse = progressive.fine_to_coarse(level);
        for &vertex in &used {
            let to = coarse[vertex as usize].expect("no part leaves");
            assert!(here.contains(&to), "{vertex} is {to} at level {level}");
            let place = places.entry(point(mesh, vertex));
            assert_eq!(*place.or_insert(point(mesh, to)), point(mesh, to));
        }
    });
    let order = progressive.removal_order();
    let distinct: BTreeSet<u32> = order.iter().copied().collect();
    assert_eq!(distinct.len(), order.len(), "a vertex leaves twice");
}

/// Random walks come back to the faces of each level, each face in its place.
fn walks_come_back(progressive: &ProgressiveMesh, random: &mut SplitMix64) {
    let mut levels = Vec::new();
    at_each_level(progressive, |_, faces| levels.push(faces.to_vec()));
    let mut walk = Walk::new(progressive);
    let mut faces = Vec::new();
    for _ in 0..20 {
        let level = random.below(levels.len());
        walk.go_to(level);
        walk.emit(&mut faces);
        assert_eq!(faces, levels[level]);
    }
    walk.go_to(0);
    walk.emit(&mut faces);
    assert_eq!(faces, progressive.faces());
}

#[test]
fn seams_do_not_tear() {
    let (mesh, attributes) = boxed(6);
    for effort in EFFORTS {
        let progressive = Collapses {
            effort,
            cross_seams: true,
            ..Collapses::default()
        }
        .build(&mesh, &attributes)
        .unwrap();
        does_not_tear(&mesh, &progressive);
        at_each_level(&progressive, |level, faces| {
            // Closed at every level, by position.
            let mut points = BTreeMap::new();
            let mut number = |vertex: u32| {
                let next = u32::try_from(points.len()).unwrap();
                *points.entry(point(&mesh, vertex)).or_insert(next)
            };
            let faces: Vec<_> = faces.iter().map(|face| face.map(&mut number)).collect();
            assert_eq!(topology(&faces), (2, true), "level {level}");
            assert!(
                edges(&faces).values().all(|&both| both == [1, 1]),
                "level {level} is open"
            );
        });
        assert_eq!(progressive.face_count(progressive.level_of_error(1e-6)), 12);

        // Beyond the box, corners without partners go at a price.
        assert_eq!(progressive.face_count(progressive.last_level()), 4);
        let before = progressive.level_of_error(0.009 * 6.0 * 3.0_f32.sqrt());
        assert_eq!(progressive.face_count(before), 12);
    }
}

#[test]
fn surfaces_of_any_seams_keep_the_laws() {
    let mut random = SplitMix64(11);
    for round in 0..120 {
        let faces = match random.below(3) {
            0 => grid(5, 4),
            1 => sphere(2),
            _ => grid(9, 1),
        };
        let whole = Mesh::new(somewhere(vertex_count(&faces), round), faces).unwrap();
        let kinds = 1 + random.below(4);
        let (mesh, sides) = split(&whole, |_| u32::try_from(random.below(kinds)).unwrap());
        let values: Vec<[f32; 1]> = sides.iter().map(|&side| [side as f32]).collect();
        // Seams of attributes that count, and of others.
        let semantic = match random.below(3) {
            0 => Semantic::TexCoord(0),
            1 => Semantic::Other("_ID".to_owned()),
            _ => Semantic::Joints(0),
        };
        let attributes = [Attribute::of_vertices(semantic, &values)];
        let settings = Collapses {
            effort: EFFORTS[random.below(2)],
            lock_border: random.below(4) == 0,
            cross_seams: random.below(2) == 0,
            ..Collapses::default()
        };
        let progressive = settings.build(&mesh, &attributes).unwrap();
        does_not_tear(&mesh, &progressive);
        agrees_with_its_history(&progressive);
        walks_come_back(&progressive, &mut random);
    }
}

#[test]
fn seams_everywhere_do_not_stop_a_surface() {
    // A vertex a corner, each with a record of its own.
    let faces = sphere(2);
    let whole = Mesh::new(somewhere(vertex_count(&faces), 3), faces).unwrap();
    let (mesh, sides) = split(&whole, |corner| u32::try_from(corner).unwrap());
    let values: Vec<[f32; 1]> = sides.iter().map(|&side| [side as f32]).collect();
    let attributes = [Attribute::of_vertices(
        Semantic::Other("_ID".to_owned()),
        &values,
    )];
    let whole = Collapses::default().build(&whole, &[]).unwrap();
    let across = Collapses {
        cross_seams: true,
        ..Collapses::default()
    };
    let progressive = across.build(&mesh, &attributes).unwrap();
    does_not_tear(&mesh, &progressive);
    let left = |mesh: &ProgressiveMesh| mesh.face_count(mesh.last_level());
    assert!(left(&progressive) <= left(&whole) + 4);
}

#[test]
fn what_moves_apart_is_not_joined() {
    // A sheet cut along its middle: closed as it is, open in a morph target or another pose.
    let sheet = hills(8, 8);
    let (mesh, sides) = split(&sheet, |corner| u32::from(corner >= 3 * 64));
    let apart: Vec<[f32; 3]> = sides
        .iter()
        .map(|&side| [0.0, 0.0, side as f32 - 0.5])
        .collect();
    let mut morph = Attribute::of_vertices(Semantic::Position, &apart);
    morph.info.morph_target = Some(0);
    let joints = Attribute::of_vertices(Semantic::Joints(0), &apart);
    for attribute in [morph, joints] {
        let across = Collapses {
            cross_seams: true,
            ..Collapses::default()
        };
        let progressive = across
            .build(&mesh, std::slice::from_ref(&attribute))
            .unwrap();
        does_not_tear(&mesh, &progressive);
        let faces = coarsest(&progressive);
        assert!(faces.len() <= 8, "{}", faces.len());
        for face in faces {
            let [a, b, c] = face.map(|vertex| sides[vertex as usize]);
            assert!(a == b && b == c, "a face between both halves");
        }
    }
}

#[test]
fn a_vertex_does_not_go_to_another_part() {
    // A vertex a corner, of one of two parts by number: no face gets corners of both.
    let sheet = hills(8, 8);
    let (mesh, sides) = split(&sheet, |corner| u32::try_from(corner / 3).unwrap());
    let part = |side: &u32| u32::from(side % 8 > 3);
    let info = AttributeInfo::new(
        Semantic::Other("part".to_owned()),
        Domain::Vertex,
        1,
        ComponentType::U32,
    );
    let parts = Attribute::new(info, Values::U32(sides.iter().map(part).collect()));
    let across = Collapses {
        cross_seams: true,
        ..Collapses::default()
    };
    let progressive = across.build(&mesh, &[parts]).unwrap();
    assert!(progressive.last_level() > 0);
    at_each_level(&progressive, |_, faces| {
        for face in faces {
            let [a, b, c] = face.map(|vertex| part(&sides[vertex as usize]));
            assert!(a == b && b == c, "a face of both parts");
        }
    });
}

/// A flat square of another part in the middle of a flat sheet keeps its outline as long as no error is allowed: in one
/// plane all surfaces are the same, and only the border between the parts tells them apart.
#[test]
fn a_part_in_the_plane_of_another_keeps_its_outline() {
    let places = (0_u8..81).map(|v| [f32::from(v % 9), f32::from(v / 9), 0.0]);
    let sheet = Mesh::new(places.collect::<Vec<_>>(), grid(8, 8)).unwrap();
    let is_inside = |corner: usize| {
        let face = sheet.faces()[corner / 3];
        let center = |axis: usize| {
            let at = face.map(|vertex| sheet.positions()[vertex as usize][axis]);
            at.iter().sum::<f32>() / 3.0
        };
        [0, 1]
            .iter()
            .all(|&axis| (2.0..6.0).contains(&center(axis)))
    };
    let (mesh, sides) = split(&sheet, |corner| u32::from(is_inside(corner)));
    let name = Semantic::Other("part".into());
    let info = AttributeInfo::new(name, Domain::Vertex, 1, ComponentType::U32);
    let parts = Attribute::new(info, Values::U32(sides.clone()));
    for effort in EFFORTS {
        let collapses = Collapses {
            effort,
            error: 1e-3,
            ..Collapses::default()
        };
        let progressive = collapses
            .build(&mesh, std::slice::from_ref(&parts))
            .unwrap();
        let faces = coarsest(&progressive);
        let area_of = |part: u32| -> f32 {
            let own = faces.iter().filter(|face| sides[face[0] as usize] == part);
            let areas = own.map(|face| {
                let [a, b, c] = face.map(|vertex| mesh.positions()[vertex as usize]);
                let [x, y] = [0, 1].map(|axis| [b[axis] - a[axis], c[axis] - a[axis]]);
                (x[0] * y[1] - x[1] * y[0]) / 2.0
            });
            areas.sum()
        };
        assert_eq!([area_of(0), area_of(1)], [48.0, 16.0], "{effort:?}");
        assert!(
            faces.len() <= 12,
            "{effort:?}: {} faces are left",
            faces.len()
        );
    }
}

/// A hole of a sheet closes where parts may leave, at an error that says so, and stays where all stays as it is connected.
#[test]
fn a_hole_closes_only_where_parts_may_leave() {
    let side = 12_u32;
    let sheet = hills(side, side);
    let cell = (5 * side + 6) as usize;
    let mut faces = sheet.faces().to_vec();
    let hole: BTreeSet<Point> = faces
        .drain(2 * cell..2 * cell + 2)
        .as_slice()
        .as_flattened()
        .iter()
        .map(|&vertex| point(&sheet, vertex))
        .collect();
    let mesh = Mesh::new(sheet.positions(), faces).unwrap();
    let at_hole = |faces: &[[u32; 3]]| {
        let open = open_edges(&mesh, faces).into_iter();
        open.filter(|edge| edge.iter().any(|end| hole.contains(end)))
            .count()
    };
    assert_eq!(at_hole(mesh.faces()), 4);
    let mut random = SplitMix64(5);
    for effort in EFFORTS {
        for drop_parts in [false, true] {
            let progressive = Collapses {
                effort,
                drop_parts,
                ..Collapses::default()
            }
            .build(&mesh, &[])
            .unwrap();
            at_each_level(&progressive, |level, faces| {
                assert!(
                    topology(faces).1,
                    "{effort:?}: level {level} is no manifold"
                );
                let open = at_hole(faces);
                match drop_parts {
                    true => assert!([0, 3, 4].contains(&open), "{effort:?}: {open} edges"),
                    false => assert!([3, 4].contains(&open), "{effort:?}: {open} edges"),
                }
            });
            assert_eq!(at_hole(&coarsest(&progressive)) == 0, drop_parts);
            does_not_tear(&mesh, &progressive);
            agrees_with_its_history(&progressive);
            walks_come_back(&progressive, &mut random);
        }
    }
}
