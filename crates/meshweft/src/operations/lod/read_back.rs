//! Whether a file gives back what it was made of.

use std::collections::HashMap;

use crate::attribute::{Attribute, Values};
use crate::index::index32;
use crate::limits::Limits;
use crate::lod::fast_mesh::{Front, VertexHierarchy};
use crate::mesh::Mesh;

/// How many vertices the coarsest mesh of some bytes has, if their full detail is this mesh with its attributes, bit for bit: each face
/// once, its corners in turn from any of them on, and no vertex that no face uses. Vertices that differ in −0 and 0 alone are one, and
/// faces with two corners at one place are left out.
pub(super) fn roots_if_same(mesh: &Mesh, attributes: &[Attribute], bytes: &[u8]) -> Option<usize> {
    let hierarchy = VertexHierarchy::from_bytes(bytes, Limits::default()).ok()?;
    let mut front = Front::new(hierarchy);
    let roots = front.vertex_count();
    front.refine_fully();
    let is_same = are_vertices_same(mesh, attributes, front.hierarchy())
        && are_faces_same(mesh, attributes, &front);
    is_same.then_some(roots)
}

/// Whether each vertex has what its source has.
fn are_vertices_same(mesh: &Mesh, attributes: &[Attribute], hierarchy: &VertexHierarchy) -> bool {
    let sources = hierarchy.source_vertices();
    let infos = attributes.iter().map(|it| &it.info);
    if !infos.eq(hierarchy.attributes()) {
        return false;
    }
    let is_at_its_place = |(vertex, &source): (u32, &u32)| {
        let position = mesh.positions().get(source as usize);
        position.is_some_and(|&it| key(it) == key(hierarchy.position(vertex)))
    };
    let mut vertices = (0..).zip(sources);
    if !vertices.all(is_at_its_place) {
        return false;
    }

    let all: Vec<u32> = (0..index32(sources.len())).collect();
    attributes.iter().enumerate().all(|(number, attribute)| {
        let found = hierarchy.attribute(number, &all).values.to_le_bytes();
        let expected = attribute.values.to_le_bytes();
        let size = expected.len() / attribute.len().max(1);
        let mut rows = found.chunks_exact(size.max(1)).zip(sources);
        rows.all(|(row, &source)| {
            expected
                .get(source as usize * size..)
                .is_some_and(|it| it.starts_with(row))
        })
    })
}

/// Whether the faces are those of the mesh, by numbers that agree where vertices do.
fn are_faces_same(mesh: &Mesh, attributes: &[Attribute], front: &Front) -> bool {
    let mut points = HashMap::new();
    let mut point = |position: [f32; 3]| {
        let next = index32(points.len());
        *points.entry(key(position)).or_insert(next)
    };
    let points: Vec<u32> = mesh.positions().iter().map(|&it| point(it)).collect();
    let columns: Vec<Vec<u8>> = attributes.iter().map(bytes_of).collect();
    let mut known = HashMap::new();
    let mut number = |vertex: usize| {
        let mut row = points[vertex].to_le_bytes().to_vec();
        for column in &columns {
            let size = column.len() / points.len();
            row.extend_from_slice(&column[vertex * size..][..size]);
        }
        let next = index32(known.len());
        *known.entry(row).or_insert(next)
    };
    let numbers: Vec<u32> = match columns.is_empty() {
        true => points.clone(),
        false => (0..points.len()).map(&mut number).collect(),
    };

    let sources = front.hierarchy().source_vertices();
    let own = |vertex: u32| numbers[sources[vertex as usize] as usize];
    let mut found: Vec<[u32; 3]> = front
        .faces()
        .map(|(_, face)| turned(face.map(own)))
        .collect();
    let is_flat = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|vertex| points[vertex as usize]);
        a == b || b == c || c == a
    };
    let faces = mesh.faces().iter().filter(|face| !is_flat(face));
    let faces = faces.map(|face| turned(face.map(|vertex| numbers[vertex as usize])));
    let mut expected: Vec<[u32; 3]> = faces.collect();
    found.sort_unstable();
    expected.sort_unstable();
    found == expected
}

/// The bytes of an attribute, −0 taken for 0.
fn bytes_of(attribute: &Attribute) -> Vec<u8> {
    let values = match &attribute.values {
        Values::F32(values) => Values::F32(values.iter().map(|x| x + 0.0).collect()),
        Values::F64(values) => Values::F64(values.iter().map(|x| x + 0.0).collect()),
        other => other.clone(),
    };
    values.to_le_bytes()
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
    use crate::attribute::Semantic;
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
        assert_eq!(roots_if_same(&mesh, &[], &bytes), Some(roots));

        let (positions, faces) = (mesh.positions(), mesh.faces());
        let other = |positions: Vec<[f32; 3]>, faces: Vec<[u32; 3]>| {
            roots_if_same(&Mesh::new(positions, faces).unwrap(), &[], &bytes)
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
        assert_eq!(roots_if_same(&mesh, &[], &bytes[1..]), None);
    }

    #[test]
    fn every_bit_of_an_attribute_counts() {
        let mesh = waves();
        let chart = mesh.positions().iter().map(|&[x, y, _]| [x / 9.0, -y]);
        let chart: Vec<[f32; 2]> = chart.collect();
        let attribute = |chart: &[[f32; 2]]| [Attribute::of_vertices(Semantic::TexCoord(0), chart)];
        let attributes = attribute(&chart);
        let hierarchy = FastMesh::default().build(&mesh, &attributes).unwrap();
        let hierarchy = hierarchy.with_attributes(&attributes).unwrap();
        let bytes = hierarchy.to_bytes();
        assert!(roots_if_same(&mesh, &attributes, &bytes).is_some());
        assert!(roots_if_same(&mesh, &[], &bytes).is_none());
        let mut other = chart;
        other[37][1] = f32::from_bits(other[37][1].to_bits() ^ 1);
        assert!(roots_if_same(&mesh, &attribute(&other), &bytes).is_none());
    }
}
