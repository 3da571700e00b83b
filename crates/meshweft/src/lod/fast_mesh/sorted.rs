//! A mesh in which what is near in space is near in memory.

use crate::attribute::{Attribute, Domain, Values};
use crate::geometry::morton::MortonCells;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::permutation::{FaceOrder, Permutation, VertexOrder};

/// A mesh and the attributes of its vertices along Morton's curve, with the old numbers.
#[derive(Debug)]
pub(super) struct SortedMesh {
    pub(super) mesh: Mesh,
    pub(super) attributes: Vec<Attribute>,
    vertices: Permutation,
    faces: Permutation,
}

impl SortedMesh {
    /// `None` if there are not as many positions, or elements of an attribute of vertices, as vertices.
    pub(super) fn new(mesh: &Mesh, attributes: &[Attribute]) -> Option<Self> {
        let count = mesh.vertex_count();
        let attributes = || {
            let all = attributes.iter();
            all.filter(|it| it.info.domain == Domain::Vertex)
        };
        if mesh.positions().len() != count || attributes().any(|it| it.len() != count) {
            return None;
        }

        // Vertices at one place stay in the order of their numbers.
        let cells = MortonCells::around(mesh.positions());
        let place = |vertex: &u32| cells.number(mesh.positions()[*vertex as usize]);
        let vertices = sorted(count, place);
        let values = |attribute: &Attribute| {
            let info = &attribute.info;
            let mut values = Values::zeros(info.component_type, attribute.values.len());
            let order = vertices.new_to_old().iter().copied();
            values.put(0, &attribute.values, info.components, order);
            Attribute::new(info.clone(), values)
        };
        let attributes = attributes().map(values).collect();
        let mesh = mesh.with_vertex_order(&VertexOrder::from(vertices.clone()));

        // Each face is where its first vertex is.
        let first = |face: &u32| mesh.faces()[*face as usize].into_iter().min();
        let faces = sorted(mesh.face_count(), first);
        let mesh = mesh.with_face_order(&FaceOrder::from(faces.clone()));
        Some(Self {
            mesh,
            attributes,
            vertices,
            faces,
        })
    }

    /// The old number of a vertex.
    pub(super) fn old_vertex(&self, vertex: u32) -> u32 {
        self.vertices.new_to_old()[vertex as usize]
    }

    /// The old number of a face.
    pub(super) fn old_face(&self, face: u32) -> u32 {
        self.faces.new_to_old()[face as usize]
    }
}

/// The numbers below `count`, those of equal keys in their order.
fn sorted<K: Ord>(count: usize, key: impl Fn(&u32) -> K) -> Permutation {
    let mut numbers: Vec<u32> = (0..index32(count)).collect();
    numbers.sort_by_cached_key(key);
    Permutation::from_algorithm(numbers)
}
