//! Half-edge collapses: a vertex leaves, and its corners go to a neighbour; none is invented.
//!
//! Each point that may leave waits in a queue by what its removal costs. The cost is made of how far a
//! neighbour is from the planes of the faces around the point (W. Schroeder, J. Zarge, W. Lorensen:
//! *Decimation of Triangle Meshes*, 1992, doi:10.1145/133994.134010; M. Garland, P. Heckbert: *Surface
//! Simplification Using Quadric Error Metrics*, 1997, doi:10.1145/258734.258849, without memory as by
//! P. Lindstrom, G. Turk: *Fast and Memory Efficient Polygonal Simplification*, 1998,
//! doi:10.1109/VISUAL.1998.745314), how far the point will be from the faces that stay, and how far the
//! surface there was moved before. A border, open or between two parts (materials, primitives), counts by how far it moves itself. Effort `best` also has *witnesses*: points that left stay with the
//! nearest face, and their distances count.
//!
//! Read `build` first, the loop. `remaining` is the mesh that gets smaller, `fan` what is around a point,
//! `link` what may leave, `queue` the order. Where positions are the same bit for bit, vertices are one
//! point (`points`), and a point's vertices go together to those of a neighbour (`sides`): each to its partner,
//! with which it shares a leaving face; or else, if seams may be crossed, to the one most like it, which costs at
//! least as much as a hundredth of the bounding box's diagonal.

mod attributes;
mod balance;
mod build;
mod costs;
mod fan;
mod link;
mod parts;
mod patch;
mod points;
mod queue;
mod remaining;
mod settings;
mod sides;
#[cfg(test)]
mod tests;
mod witnesses;

use crate::attribute::{Attribute, Domain};
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::progressive::progressive_mesh::{ProgressiveMesh, StopReason};
pub use attributes::AttributeWeights;
pub(crate) use balance::told_from_point;
use build::Builder;
use points::WeldedPoints;
use remaining::RemainingMesh;
pub use settings::Collapses;

impl Collapses {
    /// The mesh with all its resolutions; `attributes` are of its vertices (others are not looked at).
    ///
    /// Vertices that agree in position and every attribute, byte for byte (−0 is 0), count as one. Vertices
    /// at one point stay at one point, in every morph target and pose too: nothing tears. Points where the faces are not one fan stay, and so
    /// do those without finite coordinates. Give the mesh in the order in which it is to be drawn, with
    /// vertices numbered by first use: a face's place is kept, and near points are removed one after
    /// another.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if the mesh has faces and no positions, or an attribute of vertices
    /// has another number of elements.
    ///
    /// # Complexity
    /// Time O(faces), sorting apart; space about 90 bytes a face, 100 for `best`, and what the attributes take as `f32`.
    pub fn build(
        &self,
        mesh: &Mesh,
        attributes: &[Attribute],
    ) -> Result<ProgressiveMesh, MeshError> {
        let (mesh, _) = self.built(mesh, attributes, false, &())?;
        Ok(mesh)
    }

    /// The same with removals for a vertex hierarchy, and the point of each vertex: each removes one point, with one or two
    /// faces, but the first one if it only takes faces with two corners at one point. No removal is far above another, and the vertices of
    /// the faces that leave can be told from those around.
    ///
    /// Give it settings that neither cross seams nor drop parts. Stopped by `progress`, it has the removals so far.
    pub(crate) fn build_balanced(
        &self,
        mesh: &Mesh,
        attributes: &[Attribute],
        progress: &dyn Progress,
    ) -> Result<(ProgressiveMesh, Vec<u32>), MeshError> {
        debug_assert!(
            !self.cross_seams && !self.drop_parts,
            "one point, one or two faces"
        );
        self.built(mesh, attributes, true, progress)
    }

    /// The mesh with its removals, and the point of each vertex.
    fn built(
        &self,
        mesh: &Mesh,
        attributes: &[Attribute],
        is_balanced: bool,
        progress: &dyn Progress,
    ) -> Result<(ProgressiveMesh, Vec<u32>), MeshError> {
        let length = |what, found: usize| match found == mesh.vertex_count() {
            true => Ok(()),
            false => Err(MeshError::LengthMismatch {
                what,
                expected: mesh.vertex_count(),
                found,
            }),
        };
        let of_vertices = |attribute: &&Attribute| attribute.info.domain == Domain::Vertex;
        let attributes: Vec<&Attribute> = attributes.iter().filter(of_vertices).collect();
        length("positions", mesh.positions().len())?;
        for attribute in &attributes {
            length("attribute", attribute.len())?;
        }

        let positions = mesh.positions();
        let points = WeldedPoints::new(positions, &attributes);
        let same = |vertex: u32| points.same_as[vertex as usize];
        let faces: Vec<[u32; 3]> = mesh.faces().iter().map(|face| face.map(same)).collect();
        let rest = RemainingMesh::new(positions, &faces, &points.point_of);
        let WeldedPoints { same_as, point_of } = points;
        let mut builder = Builder::new(*self, rest, &attributes);
        if is_balanced {
            builder = builder.for_hierarchy();
        }
        let (records, is_limited) = builder.run(progress);
        let left = faces.len() - records.left_after(records.len());
        let stop = match (left <= self.faces, is_limited) {
            (true, _) => StopReason::Faces,
            (false, true) => StopReason::Error,
            (false, false) => StopReason::NothingLeft,
        };
        let progressive = ProgressiveMesh::new(faces, same_as, records, stop);
        Ok((progressive, point_of))
    }
}
