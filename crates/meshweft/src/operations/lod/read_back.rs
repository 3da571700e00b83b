//! Whether a file gives back what it was made of.

use std::collections::HashMap;

use crate::index::index32;
use crate::limits::Limits;
use crate::lod::fast_mesh::{Front, VertexHierarchy};
use crate::mesh::Mesh;

/// How many vertices the coarsest mesh of some bytes has, if their full detail is this mesh, bit for bit: each face once, its corners
/// in turn from any of them on, and no vertex that no face uses. −0 is 0; faces with two corners at one place are left out.
pub(super) fn roots_if_same(mesh: &Mesh, bytes: &[u8]) -> Option<usize> {
    let hierarchy = VertexHierarchy::from_bytes(bytes, Limits::default()).ok()?;
    let mut front = Front::new(hierarchy);
    let roots = front.vertex_count();
    front.refine_fully();
    is_same(mesh, &front).then_some(roots)
}

fn is_same(mesh: &Mesh, front: &Front) -> bool {
    // A number for all vertices that agree.
    let mut known = HashMap::new();
    let mut number = |position: [f32; 3]| {
        let next = index32(known.len());
        *known.entry(key(position)).or_insert(next)
    };
    let numbers: Vec<u32> = mesh.positions().iter().map(|&it| number(it)).collect();

    // The faces of both by these.
    let hierarchy = front.hierarchy();
    let sources = hierarchy.source_vertices();
    let own = |vertex: u32| {
        let source = sources[vertex as usize] as usize;
        let position = *mesh.positions().get(source)?;
        let is_its = key(hierarchy.position(vertex)) == key(position);
        is_its.then(|| numbers[source])
    };
    let mut found = Vec::with_capacity(front.face_count());
    for (_, [a, b, c]) in front.faces() {
        let (Some(a), Some(b), Some(c)) = (own(a), own(b), own(c)) else {
            return false;
        };
        found.push(turned([a, b, c]));
    }
    let is_flat = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let faces = mesh.faces().iter();
    let faces = faces.map(|face| face.map(|vertex| numbers[vertex as usize]));
    let mut expected: Vec<[u32; 3]> = faces.filter(|&face| !is_flat(face)).map(turned).collect();
    found.sort_unstable();
    expected.sort_unstable();
    found == expected
}

/// The bits of a position, −0 taken for 0.
fn key(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

/// A face from its least corner on.
fn turned([a, b, c]: [u32; 3]) -> [u32; 3] {
    [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .min()
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::fast_mesh::FastMesh;

    /// Waves over a square of 9 by 9 cells.
    fn waves() -> Mesh {
        let place = |i: u16| {
            let [x, y] = [i % 10, i / 10].map(f32::from);
            [x, y, (x * 0.7).sin() * (y * 0.9).cos()]
        };
        let cell = |i: u32| [[i, i + 1, i + 10], [i + 10, i + 1, i + 11]];
        let cells = (0..90).filter(|i| i % 10 != 9);
        let faces: Vec<_> = cells.flat_map(cell).collect();
        Mesh::new((0..100).map(place).collect::<Vec<_>>(), faces).unwrap()
    }

    #[test]
    fn every_bit_counts() {
        let mesh = waves();
        let hierarchy = FastMesh::default().build(&mesh, &[]).unwrap();
        let bytes = hierarchy.to_bytes();
        let roots = Front::new(hierarchy).vertex_count();
        assert_eq!(roots_if_same(&mesh, &bytes), Some(roots));

        let (positions, faces) = (mesh.positions(), mesh.faces());
        let other = |positions: Vec<[f32; 3]>, faces: Vec<[u32; 3]>| {
            roots_if_same(&Mesh::new(positions, faces).unwrap(), &bytes)
        };
        let changed = |change: &dyn Fn(&mut [u32; 3])| {
            let mut faces = faces.to_vec();
            change(&mut faces[70]);
            other(positions.to_vec(), faces)
        };
        assert_eq!(changed(&|face| face.rotate_left(1)), Some(roots));
        assert_eq!(changed(&|face| face.swap(0, 1)), None);
        assert_eq!(changed(&|face| face[0] = 0), None);
        assert_eq!(other(positions.to_vec(), faces[1..].to_vec()), None);
        let twice = [faces, &faces[..1]].concat();
        assert_eq!(other(positions.to_vec(), twice), None);
        let with_flat = [faces, &[[3, 3, 4]]].concat();
        assert_eq!(other(positions.to_vec(), with_flat), Some(roots));
        let mut moved = positions.to_vec();
        moved[50][2] = f32::from_bits(moved[50][2].to_bits() + 1);
        assert_eq!(other(moved, faces.to_vec()), None);
        assert_eq!(roots_if_same(&mesh, &bytes[1..]), None);
    }
}
