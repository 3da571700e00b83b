//! Meshlets: the faces of a mesh in small groups, each with few vertices, as mesh shaders take them.
//!
//! A meshlet has its own list of vertices, and faces that name them by 8 bits. What it costs follows from what it holds: on
//! an H100 and an H200 a shader that computes much runs as ⌈vertices / 32⌉ warps, one that loads much takes as long as there
//! are vertices, and primitive setup takes [`meshlet_setup_cycles`](crate::cache::nvidia::meshlet_setup_cycles()). So
//! meshlets should be full in both limits, share few vertices with others, and have their faces in a good order.
//!
//! Read `growth` first: a meshlet takes vertex by vertex, with the faces that then have all of theirs in it. `remaining` finds
//! where to go on if none of its neighbours is left. `inner_order` moves the faces inside, `cones` says from where none of
//! them can be seen.

mod cones;
mod growth;
mod inner_order;
mod remaining;
mod settings;
#[cfg(test)]
mod tests;
mod tour;

pub use cones::NormalCone;
pub use inner_order::order_meshlet;
pub use settings::Meshlets;

use super::eye::Eye;
use super::ranges::Ranges;
use crate::index::index32;
use crate::mesh::Mesh;
use crate::permutation::{FaceOrder, Permutation};
use growth::MeshletGrowth;
use inner_order::InnerOrder;
use tour::tour;

impl Meshlets {
    /// The meshlets of a mesh: every face in exactly one, its corners as they were.
    ///
    /// # Panics
    /// If the mesh has faces but no positions, or a limit is out of its range.
    ///
    /// # Complexity
    /// Time O(faces · log faces) if a bounded number of faces is at each vertex; space about 120 bytes a face.
    #[must_use]
    pub fn build(&self, mesh: &Mesh) -> MeshletMesh {
        let (positions, faces) = (mesh.positions(), mesh.faces());
        assert!(faces.is_empty() || !positions.is_empty(), "no positions");
        assert!((3..=256).contains(&self.vertex_limit), "3 to 256 vertices");
        assert!((1..=512).contains(&self.face_limit), "1 to 512 faces");

        let mut growth = MeshletGrowth::new(*self, mesh);
        let mut numbers = LocalNumbers::new(mesh.vertex_count());
        let mut inner = InnerOrder::default();
        let mut made = MeshletMesh::default();
        let mut new_to_old = Vec::with_capacity(faces.len());
        let mut local = Vec::new();
        while let Some(taken) = growth.next() {
            // Its faces in numbers of its own.
            let first_vertex = made.vertices.len();
            local.clear();
            for &face in taken {
                let corners = faces[face as usize];
                local.push(
                    corners.map(|vertex| numbers.of(vertex, &mut made.vertices, first_vertex)),
                );
            }
            numbers.forget(&made.vertices[first_vertex..]);

            // In their order.
            let order = inner.improve(&mut made.vertices[first_vertex..], &mut local);
            let start = new_to_old.len();
            new_to_old.extend(order.iter().map(|&face| taken[face as usize]));
            made.local_faces.extend_from_slice(&local);
            made.starts.push(index32(new_to_old.len()));
            made.vertex_starts.push(index32(made.vertices.len()));

            let corners =
                |&face: &u32| faces[face as usize].map(|vertex| positions[vertex as usize]);
            made.cones
                .push(NormalCone::around(new_to_old[start..].iter().map(corners)));
        }
        made.order = Permutation::from_algorithm(new_to_old).into();
        made
    }
}

/// Numbers of vertices in a meshlet.
struct LocalNumbers(Vec<u16>);

impl LocalNumbers {
    fn new(vertex_count: usize) -> Self {
        Self(vec![u16::MAX; vertex_count])
    }

    #[expect(clippy::cast_possible_truncation, reason = "below 256")]
    fn of(&mut self, vertex: u32, vertices: &mut Vec<u32>, first: usize) -> u8 {
        let number = &mut self.0[vertex as usize];
        if *number == u16::MAX {
            *number = (vertices.len() - first) as u16;
            vertices.push(vertex);
        }
        *number as u8
    }

    fn forget(&mut self, vertices: &[u32]) {
        for &vertex in vertices {
            self.0[vertex as usize] = u16::MAX;
        }
    }
}

/// The meshlets of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshletMesh {
    order: FaceOrder,
    /// Where the faces of each meshlet begin, and the end.
    starts: Vec<u32>,
    vertex_starts: Vec<u32>,
    vertices: Vec<u32>,
    local_faces: Vec<[u8; 3]>,
    cones: Vec<NormalCone>,
}

impl Default for MeshletMesh {
    fn default() -> Self {
        Self {
            order: FaceOrder::identity(0),
            starts: vec![0],
            vertex_starts: vec![0],
            vertices: Vec::new(),
            local_faces: Vec::new(),
            cones: Vec::new(),
        }
    }
}

impl MeshletMesh {
    /// The faces, meshlet after meshlet.
    #[must_use]
    pub fn order(&self) -> &FaceOrder {
        &self.order
    }

    /// How many meshlets there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cones.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cones.is_empty()
    }

    /// Where the faces of each meshlet begin in the new order, and at last their number.
    #[must_use]
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// The vertices of a meshlet, by their numbers in the mesh, in the order of their first use.
    ///
    /// # Panics
    /// If there is no such meshlet.
    #[must_use]
    pub fn vertices(&self, meshlet: usize) -> &[u32] {
        &self.vertices
            [self.vertex_starts[meshlet] as usize..self.vertex_starts[meshlet + 1] as usize]
    }

    /// The faces of a meshlet, their corners by the places of their vertices in it.
    ///
    /// # Panics
    /// If there is no such meshlet.
    #[must_use]
    pub fn local_faces(&self, meshlet: usize) -> &[[u8; 3]] {
        &self.local_faces[self.starts[meshlet] as usize..self.starts[meshlet + 1] as usize]
    }

    /// The cone of each meshlet.
    #[must_use]
    pub fn cones(&self) -> &[NormalCone] {
        &self.cones
    }

    /// The same meshlets in another order: those that are seen from the same eyes stand side by side, so that what is drawn is
    /// fewer ranges. Neighbours in space do not any more.
    ///
    /// # Complexity
    /// Time O(meshlets · log meshlets + faces), mostly.
    #[must_use]
    pub fn by_visibility(&self) -> Self {
        let mut made = Self::default();
        let mut new_to_old = Vec::with_capacity(self.order.len());
        for meshlet in tour(&self.cones) {
            let meshlet = meshlet as usize;
            let faces = self.starts[meshlet] as usize..self.starts[meshlet + 1] as usize;
            new_to_old.extend_from_slice(&self.order.new_to_old()[faces]);
            made.vertices.extend_from_slice(self.vertices(meshlet));
            made.local_faces
                .extend_from_slice(self.local_faces(meshlet));
            made.starts.push(index32(new_to_old.len()));
            made.vertex_starts.push(index32(made.vertices.len()));
            made.cones.push(self.cones[meshlet]);
        }
        made.order = Permutation::from_algorithm(new_to_old).into();
        made
    }

    /// The meshlets that may have front faces, as ranges of the faces in their new order: all front faces are in them.
    ///
    /// # Complexity
    /// Time O(meshlets); memory only if the ranges have too little room.
    pub fn visible_ranges<'a>(&self, eye: Eye, ranges: &'a mut Ranges) -> &'a Ranges {
        ranges.clear();
        let Some((point, w)) = eye.parts() else {
            ranges.push_all(self.order.len());
            return ranges;
        };
        for (cone, ends) in self.cones.iter().zip(self.starts.windows(2)) {
            if !cone.hides(point, w) {
                ranges.push(ends[0]..ends[1]);
            }
        }
        ranges
    }
}
