//! The numbers of a hierarchy, from coarse to fine.

use std::cmp::Reverse;

use super::full_detail::FullDetail;
use super::hierarchy::{HierarchyNode, VertexHierarchy};
use super::missing::MissingBlocks;
use super::replay::{Made, Replay};
use super::rows::VertexRows;
use crate::geometry::morton::MortonCells;
use crate::index::index32;
use crate::topology::half_edges::{HalfEdge, HalfEdges, NONE};

/// The finished hierarchy.
pub(super) fn finish(mut replay: Replay<'_>) -> VertexHierarchy {
    let positions = replay.positions;
    let nodes = &replay.nodes;
    let cells = MortonCells::around(positions);
    replay.made.sort_by_cached_key(|it| {
        let octave = nodes[it.point as usize].error.to_bits() >> 23;
        (
            Reverse(octave),
            cells.number(positions[it.point as usize]),
            it.point,
        )
    });

    let (roots, old_points) = points(&replay);
    let mut new_points = vec![NONE; positions.len()];
    for (new, &old) in (0..).zip(&old_points) {
        new_points[old as usize] = new;
    }
    let (source_vertices, new_vertices) = vertices(&replay, &new_points, old_points.len());
    let sides = source_vertices[old_points.len()..].iter();
    let point = |&old: &u32| new_points[replay.point_of[old as usize] as usize];
    let side_points = sides.map(point).collect();

    let renamed = |point: u32| new_points.get(point as usize).copied().unwrap_or(NONE);
    let node = |&old: &u32| {
        let node = replay.nodes[old as usize];
        HierarchyNode {
            parent: renamed(node.parent),
            first_child: renamed(node.first_child),
            next_sibling: renamed(node.next_sibling),
            ..node
        }
    };
    let (edges, root_faces) = edges(&replay, &new_vertices);
    let flags = replay.made.iter().map(|it| it.flags);
    let positions: Vec<[f32; 3]> = old_points
        .iter()
        .map(|&old| positions[old as usize])
        .collect();
    VertexHierarchy {
        nodes: old_points.iter().map(node).collect(),
        full: FullDetail::new(&positions, replay.edges.len() / 3),
        positions,
        roots,
        side_points,
        root_faces,
        edges,
        needs: std::iter::repeat_n(0, roots as usize)
            .chain(flags)
            .collect(),
        missing: MissingBlocks::default(),
        source_vertices,
        flat_faces: replay.flat_faces,
        cut_points: replay.cut_points,
        rows: VertexRows::default(),
        name: String::new(),
    }
}

/// How many points stay, and the points in their new order: those that stay, then those that leave.
fn points(replay: &Replay<'_>) -> (u32, Vec<u32>) {
    let mut is_root = vec![false; replay.positions.len()];
    for half_edge in 0..index32(replay.edges.len()) {
        let vertex = replay.edges.start(half_edge);
        is_root[replay.point_of[vertex as usize] as usize] = true;
    }
    for it in &replay.made {
        is_root[it.point as usize] = false;
    }
    let all = 0..index32(replay.positions.len());
    let mut points: Vec<u32> = all.filter(|&point| is_root[point as usize]).collect();
    let roots = index32(points.len());
    points.extend(replay.made.iter().map(|it| it.point));
    (roots, points)
}

/// The old number of each new vertex and the new number of each old one: a point's first vertex has its number.
fn vertices(replay: &Replay<'_>, new_points: &[u32], point_count: usize) -> (Vec<u32>, Vec<u32>) {
    let count = replay.positions.len();
    let mut is_used = vec![false; count];
    for half_edge in 0..index32(replay.edges.len()) {
        is_used[replay.edges.start(half_edge) as usize] = true;
    }
    let point = |vertex: u32| new_points[replay.point_of[vertex as usize] as usize];
    let mut old_vertices = vec![NONE; point_count];
    let mut others = Vec::new();
    for vertex in (0..index32(count)).filter(|&vertex| is_used[vertex as usize]) {
        match &mut old_vertices[point(vertex) as usize] {
            first if *first == NONE => *first = vertex,
            _ => others.push(vertex),
        }
    }
    others.sort_by_key(|&vertex| point(vertex));
    old_vertices.append(&mut others);

    let mut new_vertices = vec![NONE; count];
    for (new, &old) in (0..).zip(&old_vertices) {
        new_vertices[old as usize] = new;
    }
    (old_vertices, new_vertices)
}

/// The half-edges with new numbers: faces that stay come first, then two places for each point that leaves. How many stay.
fn edges(replay: &Replay<'_>, new_vertices: &[u32]) -> (HalfEdges, u32) {
    // The half-edge of each face that gets the first place of its new number.
    let old = &replay.edges;
    let face_count = old.len() / 3;
    let mut firsts: Vec<u32> = (0..index32(face_count)).map(|face| 3 * face).collect();
    let mut new_faces = vec![NONE; face_count];
    for &Made { edge, .. } in &replay.made {
        for half_edge in [edge.forth, edge.back].into_iter().filter(|&it| it != NONE) {
            firsts[half_edge as usize / 3] = NONE;
        }
    }
    let mut root_faces = 0;
    for (face, &first) in new_faces.iter_mut().zip(&firsts) {
        if first != NONE {
            *face = root_faces;
            root_faces += 1;
        }
    }
    for (place, &Made { edge, .. }) in (0..).zip(&replay.made) {
        for (side, half_edge) in [(0, edge.forth), (1, edge.back)] {
            if half_edge != NONE {
                firsts[half_edge as usize / 3] = half_edge;
                new_faces[half_edge as usize / 3] = root_faces + 2 * place + side;
            }
        }
    }

    let renamed = |half_edge: u32| {
        if half_edge == NONE {
            return NONE;
        }
        let face = half_edge as usize / 3;
        3 * new_faces[face] + (half_edge + 3 - firsts[face]) % 3
    };
    let empty = HalfEdge {
        start: NONE,
        twin: NONE,
    };
    let slots = root_faces as usize + 2 * replay.made.len();
    let mut edges = vec![empty; 3 * slots];
    for half_edge in 0..index32(old.len()) {
        edges[renamed(half_edge) as usize] = HalfEdge {
            start: new_vertices[old.start(half_edge) as usize],
            twin: renamed(old.twin(half_edge)),
        };
    }
    (HalfEdges::from_edges(edges), root_faces)
}
