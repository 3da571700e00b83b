//! Compact parts of a mesh, by connectivity alone.

use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::Permutation;
use crate::topology::{Adjacency, rows};

/// The faces sorted into `parts` parts of similar size, and where each part ends.
///
/// Cuts the mesh into slabs by the distance from its first face, and each slab into parts by the
/// distance from the slab's first face. There are about as many parts in a slab as slabs, so that a
/// part is about as long as wide. Inside a part faces keep their order; polygons stay whole:
/// `polygons` says where the polygon of each face begins and ends.
///
/// Time O(faces), space 36 bytes a face.
pub(super) fn compact_parts(
    faces: Faces<'_>,
    parts: usize,
    polygons: Option<&[[u32; 2]]>,
) -> (Permutation, Vec<usize>) {
    let mut slicing = Slicing {
        faces: faces.as_slice(),
        adjacency: Adjacency::new(faces),
        polygons,
        label: vec![0; faces.len()],
        last_walk: vec![0; faces.vertex_count()],
        queue: Vec::new(),
        next_label: 1,
    };

    // Slabs in proportion to the number of parts that each is cut into.
    let slabs = parts.isqrt().max(1);
    let parts_of_slab: Vec<usize> = (0..slabs)
        .map(|i| (i + 1) * parts / slabs - i * parts / slabs)
        .collect();
    let mut members: Vec<u32> = (0..index32(faces.len())).collect();
    let slab_ends = slicing.slice(&mut members, &parts_of_slab);

    // Parts of equal size in each slab.
    let mut ends = Vec::with_capacity(parts);
    let mut start = 0;
    for (end, parts) in slab_ends.into_iter().zip(parts_of_slab) {
        let inside = slicing.slice(&mut members[start..end], &vec![1; parts]);
        ends.extend(inside.into_iter().map(|inside| start + inside));
        start = end;
    }

    (Permutation::from_algorithm(members), ends)
}

/// Cuts sets of faces into slices. Labels tell apart what was cut and what a walk has reached.
struct Slicing<'a> {
    faces: &'a [[u32; 3]],
    adjacency: Adjacency,
    polygons: Option<&'a [[u32; 2]]>,
    /// The slice of each face, or the walk that has reached it.
    label: Vec<u32>,
    /// A label that was never given.
    next_label: u32,
    /// The walk that last visited the faces of each vertex.
    last_walk: Vec<u32>,
    /// Faces in the order in which the walk reached them.
    queue: Vec<u32>,
}

impl Slicing<'_> {
    /// Sorts the members, which all have one label that no other face has, into slices by their
    /// distance from the first one; returns where each slice ends. The sizes of the slices are in
    /// proportion to the shares.
    fn slice(&mut self, members: &mut [u32], shares: &[usize]) -> Vec<usize> {
        if shares.len() < 2 || members.is_empty() {
            return vec![members.len(); shares.len()];
        }

        // Each slice is a stretch of the walk.
        self.walk(members);
        let total: usize = shares.iter().sum();
        let first_label = self.next_label;
        let (mut start, mut sum) = (0, 0);
        for share in shares {
            sum += share;
            let end = members.len() * sum / total;
            for &face in &self.queue[start..end] {
                self.label[face as usize] = self.next_label;
            }
            self.next_label += 1;
            start = end;
        }

        // A polygon goes where its first face went.
        if let Some(polygons) = self.polygons {
            for &face in &*members {
                let [first, _] = polygons[face as usize];
                self.label[face as usize] = self.label[first as usize];
            }
        }

        // Sort by slice. A counting sort keeps the order of the members in each: what was near in
        // memory stays so.
        let slice_of = |face: u32| self.label[face as usize] - first_label;
        let mut starts = rows::starts(shares.len(), members.iter().map(|&face| slice_of(face)));
        self.queue.copy_from_slice(members);
        let items = self.queue.iter().map(|&face| (slice_of(face), face));
        rows::place(&mut starts, items, members);
        starts[1..].iter().map(|&end| end as usize).collect()
    }

    /// Lists the members in `queue` by their distance from the first, then those that are not
    /// connected with it, piece by piece.
    fn walk(&mut self, members: &[u32]) {
        let own_label = self.label[members[0] as usize];
        let reached = self.next_label;
        self.next_label += 1;
        self.queue.clear();

        for &first in members {
            if self.label[first as usize] == reached {
                continue;
            }

            // Breadth first through the piece of a face that was not reached.
            let mut next = self.queue.len();
            self.label[first as usize] = reached;
            self.queue.push(first);
            while let Some(&face) = self.queue.get(next) {
                next += 1;
                for vertex in self.faces[face as usize] {
                    // The faces of each vertex are visited once.
                    let last_walk = &mut self.last_walk[vertex as usize];
                    if std::mem::replace(last_walk, reached) == reached {
                        continue;
                    }
                    for &near in self.adjacency.faces_of(vertex) {
                        if self.label[near as usize] == own_label {
                            self.label[near as usize] = reached;
                            self.queue.push(near);
                        }
                    }
                }
            }
        }
        debug_assert_eq!(self.queue.len(), members.len());
    }
}
