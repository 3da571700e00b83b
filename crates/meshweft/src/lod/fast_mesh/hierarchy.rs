//! The vertex hierarchy: what is known of each vertex before there is a camera.

use super::full_detail::FullDetail;
use super::links::Edge;
use super::missing::MissingBlocks;
use super::rows::VertexRows;
use crate::geometry::Ball;
use crate::index::index32;
use crate::lod::cone::PackedCone;
use crate::lod::view::DetailBound;
use crate::topology::half_edges::{HalfEdges, NONE};

/// All resolutions of a mesh, for a [`Front`](super::Front): made by [`FastMesh::build`](super::FastMesh::build).
///
/// A *point* is a place of the mesh; at seams it has several vertices. Points are numbered from coarse to fine by octaves of
/// their errors: first the roots, which never leave, then those that may, each with one or two faces. The first vertex of a point has its number, others come
/// after all points. Roots are points where the surface is not a manifold, points whose coordinates are not finite, their neighbours, and
/// what nothing is coarser than. 92 bytes a vertex, 4 more in a front, and those of
/// [attributes](Self::with_attributes).
#[derive(Debug, Clone)]
pub struct VertexHierarchy {
    /// One entry a point.
    pub(super) nodes: Vec<HierarchyNode>,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) roots: u32,
    /// The point of each vertex that is not the first one there, ascending.
    pub(super) side_points: Vec<u32>,
    /// How many faces there are as long as only the roots are active.
    pub(super) root_faces: u32,
    /// Of the coarsest mesh, with what every face had when it left.
    pub(super) edges: HalfEdges,
    /// Of each point: four bits for [`Edge::split`], and sixteen times the number of active points that need it, none here.
    pub(super) needs: Vec<u32>,
    pub(super) missing: MissingBlocks,
    /// The vertex of the input for each.
    pub(super) source_vertices: Vec<u32>,
    /// Faces of the input with two corners at one point.
    pub(super) flat_faces: Vec<u32>,
    /// How many points stay because the surface is not a manifold there.
    pub(super) cut_points: usize,
    /// What else is stored with each vertex.
    pub(super) rows: VertexRows,
    /// That of the mesh.
    pub(super) name: String,
    pub(super) full: FullDetail,
}

/// What is known of the collapse of a point, and what of those into it.
#[derive(Debug, Clone, Copy)]
pub(super) struct HierarchyNode {
    /// How far the surface without the point is from the input's vertices; of all below too.
    pub(super) error: f32,
    /// Around the parent's position: everything that there is below is within.
    pub(super) radius: f32,
    pub(super) cone: PackedCone,
    /// The point that takes its corners.
    pub(super) parent: u32,
    /// The point that went into this one last.
    pub(super) first_child: u32,
    /// The point that went into the parent before this one did.
    pub(super) next_sibling: u32,
}

impl HierarchyNode {
    /// Of a root without children.
    pub(super) const ROOT: Self = Self {
        error: f32::INFINITY,
        radius: f32::INFINITY,
        cone: PackedCone::ALL,
        parent: NONE,
        first_child: NONE,
        next_sibling: NONE,
    };
}

impl VertexHierarchy {
    /// How many vertices there are: at most as many as the input has, without those that no face uses and those that agree
    /// with another in everything.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.source_vertices.len()
    }

    /// The vertex of the input for each.
    #[must_use]
    pub fn source_vertices(&self) -> &[u32] {
        &self.source_vertices
    }

    /// The smallest ball that has all vertices in it; `None` if there is no vertex with finite coordinates. It is known before the
    /// vertices of a file are read.
    #[must_use]
    pub fn ball(&self) -> Option<Ball> {
        self.full.ball
    }

    /// How many faces there are at full detail: those of the input without the [flat](Self::flat_faces) ones.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.full.face_count as usize
    }

    /// How many points there are, and how many of them never leave.
    #[must_use]
    pub fn point_counts(&self) -> [usize; 2] {
        [self.nodes.len(), self.roots as usize]
    }

    /// How many numbers of faces there are, used or not: a point at a border has one face and two numbers.
    #[must_use]
    pub fn face_slot_count(&self) -> usize {
        self.edges.len() / 3
    }

    /// The faces of the input that are left out, as two of their corners are at one point: they draw nothing.
    #[must_use]
    pub fn flat_faces(&self) -> &[u32] {
        &self.flat_faces
    }

    /// How many points stay because the faces there are not one fan: the surface is cut at them.
    #[must_use]
    pub fn cut_points(&self) -> usize {
        self.cut_points
    }

    /// The point of a vertex.
    #[inline]
    pub(crate) fn point_of(&self, vertex: u32) -> u32 {
        match (vertex as usize).checked_sub(self.nodes.len()) {
            None => vertex,
            Some(place) => self.side_points[place],
        }
    }

    /// Where a vertex is. Of a vertex that was not read yet, the origin.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn position(&self, vertex: u32) -> [f32; 3] {
        self.positions[self.point_of(vertex) as usize]
    }

    /// The error of a vertex: how far the surface is from the input's vertices where its point has left, in units of the positions;
    /// infinite for roots. The coarser the detail, the larger. Attributes do not count.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn error(&self, vertex: u32) -> f32 {
        self.nodes[self.point_of(vertex) as usize].error
    }

    /// How many collapses are one after the other at most.
    #[must_use]
    pub fn depth(&self) -> usize {
        // A node is just below the point whose first child it is, or below the sibling before it.
        let mut deepest = 0;
        let mut stack: Vec<(u32, usize)> = (0..self.roots).map(|root| (root, 0)).collect();
        // No more steps than points: someone may have made it up.
        for _ in 0..self.nodes.len() {
            let Some((point, depth)) = stack.pop() else {
                break;
            };
            deepest = deepest.max(depth);
            let node = self.nodes[point as usize];
            let below = [node.first_child, node.next_sibling];
            stack.extend(
                below
                    .into_iter()
                    .filter(|&it| it != NONE)
                    .map(|it| (it, depth + 1)),
            );
        }
        deepest
    }

    /// The vertices at a point.
    #[inline]
    pub(super) fn vertices_of(&self, point: u32) -> impl Iterator<Item = u32> + use<> {
        let others = match self.side_points.is_empty() {
            true => [0; 2],
            false => [point, point + 1].map(|it| self.side_points.partition_point(|&at| at < it)),
        };
        let number = |place: usize| index32(self.nodes.len() + place);
        std::iter::once(point).chain(number(others[0])..number(others[1]))
    }

    /// Whether a point may leave.
    pub(super) fn may_leave(&self, point: u32) -> bool {
        point >= self.roots
    }

    /// The edge along which a point leaves.
    #[inline]
    pub(super) fn edge(&self, point: u32) -> Edge {
        let first = 3 * (self.root_faces + 2 * (point - self.roots));
        let there = |half_edge: u32| match self.edges.start(half_edge) {
            NONE => NONE,
            _ => half_edge,
        };
        Edge {
            forth: there(first),
            back: there(first + 3),
        }
    }

    /// Makes places for the faces with which a point leaves, that of the edge forth and that of the edge back, if they are there.
    pub(super) fn put_edge(&mut self, point: u32, are_there: [bool; 2]) {
        let first = 3 * (self.root_faces + 2 * (point - self.roots));
        let firsts = [first, first + 3];
        for ((here, other), is_there) in firsts.into_iter().zip([first + 3, first]).zip(are_there) {
            for half_edge in here..here + 3 {
                let start = if is_there { point } else { NONE };
                self.edges.set_start(half_edge, start);
                self.edges.set_twin(half_edge, NONE);
            }
            if are_there == [true; 2] {
                self.edges.set_twin(here, other);
            }
        }
    }

    /// The point with which a face leaves; `None` if it never does.
    #[inline]
    pub(super) fn point_of_face(&self, face: u32) -> Option<u32> {
        let place = face.checked_sub(self.root_faces)?;
        Some(self.roots + place / 2)
    }

    /// The points that have to be active where this one is, as long as it is not, or no other needs it: some may be named
    /// more than once, roots are not.
    pub(super) fn needed_by(&self, point: u32) -> impl Iterator<Item = u32> {
        let around = self.edge(point).faces_around(&self.edges);
        let around = around.filter_map(|face| self.point_of_face(face));
        let parent = self.nodes[point as usize].parent;
        around.chain(Some(parent).filter(|&it| self.may_leave(it)))
    }

    /// What decides whether a point has to be active.
    pub(super) fn bound(&self, point: u32) -> DetailBound {
        let node = &self.nodes[point as usize];
        DetailBound {
            center: self.positions[node.parent as usize],
            radius: node.radius,
            error: node.error,
            cone: node.cone.unpacked(),
        }
    }

    /// The same of a point just below another one that was not read yet, as far as that is known: it may ask for too much.
    pub(super) fn bound_below(&self, above: u32, largest_error: f32) -> DetailBound {
        if self.may_leave(above) {
            let bound = self.bound(above);
            return DetailBound {
                error: bound.error.min(largest_error),
                ..bound
            };
        }
        DetailBound {
            center: self.positions[above as usize],
            radius: f32::INFINITY,
            error: largest_error,
            cone: PackedCone::ALL.unpacked(),
        }
    }

    /// All points that may leave.
    pub(super) fn leaving_points(&self) -> std::ops::Range<u32> {
        self.roots..index32(self.nodes.len())
    }
}
