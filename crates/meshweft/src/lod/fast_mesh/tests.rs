//! The front against what follows from the hierarchy alone.

use std::collections::{BTreeMap, BTreeSet};

use super::*;
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::index::index32;
use crate::lod::{Camera, CameraView};
use crate::mesh::Mesh;
use crate::progressive::made::{grid, sphere};
use crate::random::{SplitMix64, from_environment};
use crate::topology::half_edges::{NONE, next};

/// The points that have to be active for a view, from the hierarchy as it is without a front.
pub(crate) fn closure(hierarchy: &VertexHierarchy, view: &CameraView) -> BTreeSet<u32> {
    let needs = |&point: &u32| view.needs(&hierarchy.bound(point));
    let mut stack: Vec<u32> = hierarchy.leaving_points().filter(needs).collect();
    let mut found = BTreeSet::new();
    while let Some(point) = stack.pop() {
        if found.insert(point) {
            stack.extend(hierarchy.needed_by(point));
        }
    }
    found
}

/// How many points a view needs by itself, without those that these need.
#[cfg(feature = "files")]
pub(crate) fn failing(hierarchy: &VertexHierarchy, view: &CameraView) -> usize {
    let needs = |&point: &u32| view.needs(&hierarchy.bound(point));
    hierarchy.leaving_points().filter(needs).count()
}

/// The points of a front that may leave.
pub(crate) fn active(front: &Front) -> BTreeSet<u32> {
    let [points, _] = front.hierarchy().point_counts();
    let may_leave =
        |vertex: &u32| front.hierarchy().may_leave(*vertex) && *vertex < index32(points);
    front.vertices().filter(may_leave).collect()
}

fn faces(front: &Front) -> BTreeMap<u32, [u32; 3]> {
    front.faces().collect()
}

/// Corners and links are those of a surface whose vertices are active.
fn check_surface(front: &Front) {
    let hierarchy = front.hierarchy();
    let edges = &hierarchy.edges;
    let there = faces(front);
    let vertices: BTreeSet<u32> = front.vertices().collect();
    assert_eq!(there.len(), front.face_count());
    assert_eq!(vertices.len(), front.vertex_count());
    let point = |vertex: u32| {
        let sides = vertex.checked_sub(index32(hierarchy.nodes.len()));
        sides.map_or(vertex, |place| hierarchy.side_points[place as usize])
    };
    let mut directed = BTreeSet::new();
    for (&face, corners) in &there {
        assert!(
            corners.iter().all(|vertex| vertices.contains(vertex)),
            "{corners:?}"
        );
        for half_edge in 3 * face..3 * face + 3 {
            let ends = [half_edge, next(half_edge)].map(|it| point(edges.start(it)));
            assert_ne!(ends[0], ends[1]);
            let is_new = directed.insert(ends);
            assert!(is_new || hierarchy.cut_points() > 0, "{ends:?} twice");
            let twin = edges.twin(half_edge);
            if twin == NONE {
                continue;
            }
            assert!(there.contains_key(&(twin / 3)), "a twin that is not there");
            assert_eq!(edges.twin(twin), half_edge);
            let across = [next(twin), twin].map(|it| point(edges.start(it)));
            assert_eq!(ends, across, "the same edge");
        }
    }
}

/// Vertices, edges and faces of the surface, as an alternating sum, and how many half-edges are at a border.
fn euler(front: &Front) -> i64 {
    let edges = &front.hierarchy().edges;
    let there = faces(front);
    let mut count = index32(there.len()) as i64;
    let mut points = BTreeSet::new();
    for &face in there.keys() {
        for half_edge in 3 * face..3 * face + 3 {
            let twin = edges.twin(half_edge);
            count -= i64::from(twin == NONE || twin > half_edge);
            // A fan by its half-edge of the least number.
            let mut least = half_edge;
            let mut at = twin;
            let mut is_open = at == NONE;
            while !is_open && next(at) != half_edge {
                least = least.min(next(at));
                at = edges.twin(next(at));
                is_open = at == NONE;
            }
            if is_open {
                let mut at = half_edge;
                while at != NONE {
                    least = least.min(at);
                    at = edges.twin(crate::topology::half_edges::previous(at));
                }
            }
            points.insert(least);
        }
    }
    count + index32(points.len()) as i64
}

/// Faces by the vertices of the input, each beginning with its least vertex.
fn of_input(faces: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 3]> {
    let mut all: Vec<[u32; 3]> = faces
        .map(|face| {
            let first = (0..3).min_by_key(|&slot| face[slot]).unwrap();
            [0, 1, 2].map(|slot| face[(first + slot) % 3])
        })
        .collect();
    all.sort_unstable();
    all
}

pub(super) fn camera(random: &mut SplitMix64, extent: f64) -> CameraView {
    let mut at = |size: f64| [(); 3].map(|()| (random.below(2001) as f64 / 1000.0 - 1.0) * size);
    let (eye, target, up) = (at(2.0 * extent), at(0.3 * extent), at(1.0));
    let camera = Camera {
        eye,
        target,
        up,
        field_of_view: 45.0,
        size: [800, 800],
    };
    let tolerance = [0.5, 2.0, 8.0, 30.0][random.below(4)];
    let view = camera.view(tolerance);
    let view = view.unwrap_or_else(|_| {
        let camera = Camera {
            target: [eye[0] + 1.0, eye[1], eye[2]],
            up: [0.0, 1.0, 0.0],
            ..camera
        };
        camera.view(tolerance).unwrap()
    });
    match random.below(3) {
        0 => view.all_around(),
        1 => view.with_back_faces(),
        _ => view,
    }
}

/// A bumpy surface over the vertices of a grid.
fn hills(columns: u32, rows: u32) -> Vec<[f32; 3]> {
    let height = |x: f32, y: f32| (0.7 * x).sin() + (0.9 * y).cos() + 0.3 * (2.1 * x + y).sin();
    let vertices = (0..(columns + 1) * (rows + 1)).map(|v| [v % (columns + 1), v / (columns + 1)]);
    vertices
        .map(|[x, y]| [x as f32, y as f32, height(x as f32, y as f32)])
        .collect()
}

/// A sphere of radius 10 with bumps.
fn bumps(cuts: u32) -> Mesh {
    let faces = sphere(cuts);
    let count = faces.as_flattened().iter().max().unwrap() + 1;
    let mut positions = vec![[0.0_f32; 3]; count as usize];
    let corners = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
    ];
    positions[..6].copy_from_slice(&corners);
    // Middles have the numbers that `sphere` gives them.
    let mut coarse = sphere(0);
    let mut vertices = 6;
    for _ in 0..cuts {
        let mut middles = BTreeMap::new();
        let mut next = Vec::new();
        for &[a, b, c] in &coarse {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let sum =
                        [0, 1, 2].map(|i| positions[a as usize][i] + positions[b as usize][i]);
                    positions[vertices as usize] = crate::geometry::normalized(sum);
                    vertices += 1;
                    vertices - 1
                })
            };
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            next.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        coarse = next;
    }
    assert_eq!(coarse, faces);
    let bump = |[x, y, z]: [f32; 3]| {
        let radius = 10.0 + (3.0 * x).sin() + 0.5 * (7.0 * y + 2.0 * z).cos();
        [x * radius, y * radius, z * radius]
    };
    Mesh::new(positions.into_iter().map(bump).collect::<Vec<_>>(), faces).unwrap()
}

/// A grid with texture coordinates that have a seam every few columns, where each point has two vertices.
fn patched(columns: u32, rows: u32) -> (Mesh, Vec<Attribute>) {
    let mut positions = hills(columns, rows);
    // The vertices of the grid itself are not used.
    let mut chart: Vec<f32> = vec![-1.0; positions.len()];
    let mut faces = grid(columns, rows);
    let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for face in &mut faces {
        let column = face.iter().map(|v| v % (columns + 1)).min().unwrap();
        let part = column / 5;
        for corner in face {
            let count = index32(positions.len());
            let side = *sides.entry((*corner, part)).or_insert_with(|| count);
            if side == count {
                positions.push(positions[*corner as usize]);
                chart.push(part as f32);
            }
            *corner = side;
        }
    }
    let (semantic, domain) = (Semantic::TexCoord(0), Domain::Vertex);
    let info = AttributeInfo::new(semantic, domain, 1, ComponentType::F32);
    let values = Values::F32(chart);
    let attribute = Attribute { info, values };
    (Mesh::new(positions, faces).unwrap(), vec![attribute])
}

pub(super) fn examples() -> Vec<(&'static str, Mesh, Vec<Attribute>)> {
    let (with_seams, attributes) = patched(30, 25);
    let hills_mesh = Mesh::new(hills(30, 30), grid(30, 30)).unwrap();
    // Holes, and two parts that meet at a vertex only.
    let mut holes = grid(24, 24);
    let mut place = 0;
    holes.retain(|_| {
        place += 1;
        place % 97 > 3 && place % 61 > 1
    });
    let mut fins = grid(20, 20);
    fins.extend([
        [100, 101, 441],
        [200, 201, 442],
        [201, 200, 443],
        [300, 300, 301],
    ]);
    let mut fin_positions = hills(20, 20);
    fin_positions.extend([[3.0, 4.0, 9.0], [5.0, 9.0, 9.0], [5.0, 9.0, -9.0]]);
    vec![
        ("hills", hills_mesh, vec![]),
        ("sphere", bumps(4), vec![]),
        ("holes", Mesh::new(hills(24, 24), holes).unwrap(), vec![]),
        ("fins", Mesh::new(fin_positions, fins).unwrap(), vec![]),
        ("seams", with_seams, attributes),
    ]
}

#[test]
fn a_front_follows_from_the_view_alone() {
    let cases = from_environment("MESHWEFT_CASES", 30);
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 1));
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let mut walked = Front::new(hierarchy.clone());
        let character = euler(&walked);
        let mut sizes = BTreeSet::new();
        for case in 0..cases {
            let view = camera(&mut random, 25.0);
            let (before, vertices_before) = (faces(&walked), walked.vertices().collect());
            walked.update(&view, 1.0);
            let expected = closure(&hierarchy, &view);
            assert!(active(&walked) == expected, "{name} {case}");
            check_surface(&walked);
            assert_eq!(euler(&walked), character, "{name} {case}");
            check_changes(&walked, &before, &vertices_before);
            sizes.insert(expected.len());

            let mut jumped = Front::new(hierarchy.clone());
            jumped.update(&view, 1.0);
            let waiting = |front: &Front| front.waiting.points().collect::<BTreeSet<u32>>();
            assert!(waiting(&jumped) == waiting(&walked), "{name} {case}");
            assert!(faces(&jumped) == faces(&walked), "{name} {case}");
        }
        assert!(index32(sizes.len()) as u64 > cases / 4, "{name}: {sizes:?}");
    }
}

fn check_changes(front: &Front, before: &BTreeMap<u32, [u32; 3]>, vertices_before: &BTreeSet<u32>) {
    let changes = front.changes();
    let now = faces(front);
    let vertices: BTreeSet<u32> = front.vertices().collect();
    let set = |list: &[u32]| {
        let set: BTreeSet<u32> = list.iter().copied().collect();
        assert_eq!(set.len(), list.len(), "each once");
        set
    };
    let added = set(&changes.added_vertices);
    let removed = set(&changes.removed_vertices);
    assert_eq!(added, &vertices - vertices_before);
    assert_eq!(removed, vertices_before - &vertices);
    let keys = |faces: &BTreeMap<u32, [u32; 3]>| faces.keys().copied().collect::<BTreeSet<u32>>();
    assert_eq!(set(&changes.added_faces), &keys(&now) - &keys(before));
    assert_eq!(set(&changes.removed_faces), &keys(before) - &keys(&now));
    let changed = set(&changes.changed_faces);
    for (face, corners) in &now {
        let is_same = before.get(face).is_none_or(|it| it == corners);
        assert!(is_same || changed.contains(face), "face {face}");
    }
}

#[test]
fn full_refinement_is_the_input() {
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let [points, roots] = hierarchy.point_counts();
        assert!(roots * 3 < points, "{name}: {roots} of {points} are roots");
        let mut front = Front::new(hierarchy);
        front.refine_fully();
        let sources = front.hierarchy().source_vertices().to_vec();
        let found = front
            .faces()
            .map(|(_, face)| face.map(|v| sources[v as usize]));
        let flat = front.hierarchy().flat_faces();
        let kept = (0..)
            .zip(mesh.faces())
            .filter(|(number, _)| !flat.contains(number));
        let expected = of_input(kept.map(|(_, &face)| face));
        assert!(of_input(found) == expected, "{name}");
        check_surface(&front);
    }
}

#[test]
fn errors_balls_and_cones_contain_those_below() {
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        for point in 0..index32(hierarchy.nodes.len()) {
            let node = hierarchy.nodes[point as usize];
            for below in [node.first_child, node.next_sibling] {
                if below == NONE || !hierarchy.may_leave(point) {
                    continue;
                }
                let (outer, inner) = (hierarchy.bound(point), hierarchy.bound(below));
                assert!(outer.error >= inner.error, "{name}");
                let way = [0, 1, 2].map(|i| f64::from(outer.center[i] - inner.center[i]));
                let distance = way.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!(
                    f64::from(outer.radius) >= distance + f64::from(inner.radius),
                    "{name}"
                );
                let [outer, inner] = [point, below].map(|it| hierarchy.nodes[it as usize].cone);
                assert!(outer.contains(inner), "{name}");
            }
        }
    }
}

#[test]
fn without_limits_a_budget_changes_nothing() {
    let mut random = SplitMix64(5);
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let mut walked = Front::new(hierarchy.clone());
        for case in 0..20 {
            let view = camera(&mut random, 25.0);
            let (_, is_done) = walked.update_within(&view, 1.0, FrameBudget::default());
            assert!(is_done);
            assert!(
                active(&walked) == closure(&hierarchy, &view),
                "{name} {case}"
            );
        }
    }
}

#[test]
fn few_changes_a_frame_come_to_the_same_in_the_end() {
    let mut random = SplitMix64(6);
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let mut walked = Front::new(hierarchy.clone());
        for case in 0..5 {
            let view = camera(&mut random, 25.0);
            let budget = FrameBudget {
                changes: 7,
                ..FrameBudget::default()
            };
            let mut frames = 0;
            while !walked.update_within(&view, 1.0, budget).1 {
                frames += 1;
                assert!(frames < 1000, "{name} {case}");
            }
            check_surface(&walked);
            assert!(
                active(&walked) == closure(&hierarchy, &view),
                "{name} {case}"
            );
        }
    }
}

/// The largest excess of a point that is not active, of those that a front could split next.
fn largest_left(front: &Front, hierarchy: &VertexHierarchy, view: &CameraView) -> f64 {
    let active = active(front);
    let left = hierarchy.leaving_points().filter(|it| !active.contains(it));
    left.map(|point| view.urgency(&hierarchy.bound(point)).excess())
        .fold(0.0, f64::max)
}

#[test]
fn a_budget_ends_where_places_are_not_numbers() {
    let mut random = SplitMix64(from_environment("MESHWEFT_SEED", 3));
    for (name, mesh, attributes) in examples() {
        let mut hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        for place in hierarchy.positions.iter_mut().step_by(5) {
            place[1] = f32::NAN;
        }
        let mut front = Front::new(hierarchy);
        let budget = FrameBudget {
            vertices: 2 * front.vertex_count() + 20,
            ..FrameBudget::default()
        };
        let everything = CameraView::of_errors_above(-1.0).unwrap();
        for view in [everything, camera(&mut random, 25.0)] {
            front.update_within(&view, 1.0, budget);
            assert!(front.vertex_count() <= budget.vertices, "{name}");
        }
    }
}

#[test]
fn a_budget_of_vertices_is_never_exceeded_and_spent_where_errors_are_seen_most() {
    let mut random = SplitMix64(7);
    for (name, mesh, attributes) in examples() {
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let roots = Front::new(hierarchy.clone()).vertex_count();
        let mut walked = Front::new(hierarchy.clone());
        for case in 0..30 {
            let view = camera(&mut random, 25.0);
            let vertices = roots + random.below(mesh.vertex_count() / 2);
            let budget = FrameBudget {
                vertices,
                ..FrameBudget::default()
            };
            assert!(walked.update_within(&view, 1.0, budget).1);
            check_surface(&walked);
            assert!(walked.vertex_count() <= vertices, "{name} {case}");

            let left = largest_left(&walked, &hierarchy, &view);
            if left <= 1.0 {
                assert!(
                    active(&walked) == closure(&hierarchy, &view),
                    "{name} {case}"
                );
                continue;
            }
            // A front with the point that is seen most of those left would have more vertices.
            let finer = view.with_tolerance(left * (1.0 - 1e-9));
            let needed = closure(&hierarchy, &finer);
            let vertices_of = |point: &u32| hierarchy.vertices_of(*point).count();
            let count = roots + needed.iter().map(vertices_of).sum::<usize>();
            assert!(
                left.is_infinite() || count > vertices,
                "{name} {case}: {left}"
            );
        }
    }
}
