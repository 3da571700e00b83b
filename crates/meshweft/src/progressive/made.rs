//! Histories for tests: collapses by brute force, and records that no simplifier makes.

use super::history::{History, HistoryBuilder, NewRecord};
use crate::attribute::{Attribute, Semantic};
use crate::faces::Faces;
use crate::mesh::Mesh;
use crate::random::SplitMix64;

/// A rectangle of squares, each cut in two: a manifold with a border.
pub(crate) fn grid(columns: u32, rows: u32) -> Vec<[u32; 3]> {
    let square = |at: u32| {
        let a = at / columns * (columns + 1) + at % columns;
        let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
        match (at / columns + at) % 2 {
            0 => [[a, b, d], [a, d, c]],
            _ => [[a, b, c], [c, b, d]],
        }
    };
    (0..columns * rows).flat_map(square).collect()
}

/// A closed surface: an octahedron, each face cut in four a few times.
pub(crate) fn sphere(cuts: u32) -> Vec<[u32; 3]> {
    let side = |i: u32| [1 + i % 4, 1 + (i + 1) % 4];
    let caps = (0..4).map(side).flat_map(|[a, b]| [[0, a, b], [5, b, a]]);
    let mut faces: Vec<[u32; 3]> = caps.collect();
    let mut vertices = 6;
    for _ in 0..cuts {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices += 1;
                vertices - 1
            })
        };
        let cut = |&[a, b, c]: &[u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.iter().flat_map(cut).collect();
    }
    faces
}

/// Faces of a mesh that is being simplified, with their numbers.
type Present = Vec<(u32, [u32; 3])>;

/// Half-edge collapses of random edges until none is possible: a vertex moves to a neighbour unless
/// two faces would then have the same vertices.
pub(crate) fn collapses(faces: &[[u32; 3]], seed: u64) -> History {
    let mut random = SplitMix64(seed);
    let mut builder = HistoryBuilder::new(faces);
    let mut present: Present = (0..).zip(faces.iter().copied()).collect();
    let mut next = u32::try_from(faces.len()).unwrap();
    let mut failed = 0;
    while failed < 200 && !present.is_empty() {
        let (_, face) = present[random.below(present.len())];
        let corner = random.below(3);
        let (from, to) = (face[corner], face[(corner + 1) % 3]);
        let Some((removed, inserted)) = collapsed(&present, from, to) else {
            failed += 1;
            continue;
        };
        failed = 0;
        present.retain(|(_, face)| !face.contains(&from));
        present.extend((next..).zip(inserted.iter().copied()));
        next += u32::try_from(inserted.len()).unwrap();
        let record = NewRecord {
            removed_vertices: &[from],
            merges_into: &[to],
            removed_faces: &removed,
            inserted_faces: &inserted,
            error: builder.history().len() as f32 / 4.0,
        };
        builder.push(&record).expect("a collapse is a record");
    }
    builder.finish()
}

/// The faces that leave and come if `from` moves to `to`, unless the surface would fold.
fn collapsed(present: &Present, from: u32, to: u32) -> Option<(Vec<u32>, Vec<[u32; 3]>)> {
    let sorted = |mut face: [u32; 3]| {
        face.sort_unstable();
        face
    };
    let (leaving, staying): (Present, Present) =
        (present.iter()).partition(|(_, face)| face.contains(&from));
    let moved = leaving.iter().filter(|(_, face)| !face.contains(&to));
    let moved = moved.map(|(_, face)| face.map(|v| if v == from { to } else { v }));
    let inserted: Vec<[u32; 3]> = moved.collect();
    let mut after: Vec<[u32; 3]> = staying.iter().map(|(_, face)| sorted(*face)).collect();
    after.extend(inserted.iter().map(|&face| sorted(face)));
    let count = after.len();
    after.sort_unstable();
    after.dedup();
    let numbers = leaving.iter().map(|(number, _)| *number).collect();
    (after.len() == count).then_some((numbers, inserted))
}

/// Records that no simplifier makes: any faces leave, any number of others come, over any vertices,
/// several or no vertices leave, parts go as a whole, some say what they are merged into.
pub(crate) fn any_records(
    faces: &[[u32; 3]],
    vertex_count: u32,
    count: usize,
    seed: u64,
) -> History {
    let mut random = SplitMix64(seed);
    let faces = Faces::new(faces, vertex_count as usize).unwrap();
    let mut builder = HistoryBuilder::new(faces);
    let mut vertices: Vec<u32> = (0..vertex_count).collect();
    for _ in 0..count {
        // One vertex, a few or none.
        let removed = [0, 1, 1, 1, 1, 2, 5][random.below(7)].min(vertices.len());
        let removed_vertices: Vec<u32> = (0..removed)
            .map(|_| vertices.swap_remove(random.below(vertices.len())))
            .collect();

        // All their faces, and some others; now and then in another order.
        let present = |face: &u32| builder.has_face(*face);
        let numbers = u32::try_from(builder.history().number_count()).unwrap();
        let mut removed_faces: Vec<u32> = (0..numbers).filter(present).collect();
        let others = random.below(4);
        removed_faces.retain(|&face| {
            let corners = builder.history().face(face);
            let leaves = corners.iter().any(|v| removed_vertices.contains(v));
            leaves || random.below(60) < others
        });
        if random.below(3) == 0 {
            removed_faces.reverse();
        }

        // Fewer faces, or more.
        let most = removed_faces.len() + [0, 0, 0, 4][random.below(4)];
        let inserted = if vertices.is_empty() {
            0
        } else {
            random.below(most + 1)
        };
        let any = |random: &mut SplitMix64| vertices[random.below(vertices.len())];
        let inserted_faces: Vec<[u32; 3]> = (0..inserted)
            .map(|_| [0; 3].map(|_| any(&mut random)))
            .collect();
        let merges_into: Vec<u32> = match vertices.is_empty() || random.below(2) == 0 {
            true => Vec::new(),
            false => removed_vertices.iter().map(|_| any(&mut random)).collect(),
        };
        let record = NewRecord {
            removed_vertices: &removed_vertices,
            merges_into: &merges_into,
            removed_faces: &removed_faces,
            inserted_faces: &inserted_faces,
            error: random.below(1000) as f32 / 999.0,
        };
        builder.push(&record).expect("it keeps to the rules");
    }
    builder.finish()
}

/// Positions that are not special in any way.
pub(crate) fn somewhere(vertices: usize, seed: u64) -> Vec<[f32; 3]> {
    let mut random = SplitMix64(seed);
    let mut coordinate = || random.below(1 << 20) as f32 / 1024.0;
    (0..vertices)
        .map(|_| [(); 3].map(|()| coordinate()))
        .collect()
}

/// A sheet with hills.
pub(crate) fn hills(columns: u32, rows: u32) -> Mesh {
    let at = |vertex: u32| {
        let [x, y] = [vertex % (columns + 1), vertex / (columns + 1)].map(|i| i as f32 * 0.25);
        [x, y, x.sin() * y.cos()]
    };
    let positions: Vec<_> = (0..(columns + 1) * (rows + 1)).map(at).collect();
    Mesh::new(positions, grid(columns, rows)).unwrap()
}

/// A box whose sides share no vertices: normals tell them apart.
pub(crate) fn boxed(cells: u32) -> (Mesh, Vec<Attribute>) {
    let (mut positions, mut normals, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for side in 0..6 {
        let (axis, is_far) = (side / 2, side % 2 == 0);
        let first = u32::try_from(positions.len()).unwrap();
        for vertex in 0..(cells + 1) * (cells + 1) {
            let [u, v] = [vertex % (cells + 1), vertex / (cells + 1)];
            let mut position = [0.0; 3];
            position[axis] = if is_far { cells as f32 } else { 0.0 };
            position[(axis + 1) % 3] = if is_far { u } else { cells - u } as f32;
            position[(axis + 2) % 3] = v as f32;
            positions.push(position);
            let mut normal = [0.0; 3];
            normal[axis] = if is_far { 1.0 } else { -1.0 };
            normals.push(normal);
        }
        faces.extend(
            grid(cells, cells)
                .iter()
                .map(|face| face.map(|vertex| vertex + first)),
        );
    }
    let normals = Attribute::of_vertices(Semantic::Normal, &normals);
    (Mesh::new(positions, faces).unwrap(), vec![normals])
}
