//! Compact parts of a mesh, by connectivity alone.

use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::Permutation;
use crate::topology::{Adjacency, rows};

/// The faces in parts of similar size, and where each part ends.
///
/// Cuts the mesh into slabs by the distance from its first face, and each slab into parts by the
/// distance from the slab's first face. There are about as many parts in a slab as slabs, so that a
/// part is about as long as wide. Inside a part faces keep their order; polygons stay whole.
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
        part: vec![0; faces.len()],
        fans: vec![0; faces.vertex_count()],
        queue: Vec::new(),
        parts: 1,
    };

    // Slabs in proportion to the number of parts that each is cut into.
    let mut members: Vec<u32> = (0..index32(faces.len())).collect();
    let slabs = parts.isqrt().max(1);
    let mut ends = Vec::new();
    let mut start = 0;
    let shares: Vec<usize> = (0..slabs)
        .map(|i| (i + 1) * parts / slabs - i * parts / slabs)
        .collect();

    for (end, share) in slicing.slice(&mut members, &shares).into_iter().zip(shares) {
        let inside = slicing.slice(&mut members[start..end], &vec![1; share]);
        ends.extend(inside.into_iter().map(|inside| start + inside));
        start = end;
    }

    (Permutation::from_algorithm(members), ends)
}

struct Slicing<'a> {
    faces: &'a [[u32; 3]],
    adjacency: Adjacency,
    polygons: Option<&'a [[u32; 2]]>,
    /// The part of each face.
    part: Vec<u32>,
    /// The number of the next part.
    parts: u32,
    /// The walk that last visited the faces of each vertex.
    fans: Vec<u32>,
    /// Faces in the order in which the walk reached them.
    queue: Vec<u32>,
}

impl Slicing<'_> {
    /// Sorts the members, which are one part, into slices by their distance from the first one;
    /// returns where each slice ends. The sizes of the slices are in proportion to the shares.
    fn slice(&mut self, members: &mut [u32], shares: &[usize]) -> Vec<usize> {
        if shares.len() < 2 || members.is_empty() {
            return vec![members.len(); shares.len()];
        }

        // Each slice becomes a part: a stretch of the walk.
        self.walk(members);
        let total: usize = shares.iter().sum();
        let first_part = self.parts;
        let (mut start, mut sum) = (0, 0);
        for share in shares {
            sum += share;
            let end = members.len() * sum / total;
            for &face in &self.queue[start..end] {
                self.part[face as usize] = self.parts;
            }
            self.parts += 1;
            start = end;
        }

        // A polygon goes where its first face went.
        if let Some(polygons) = self.polygons {
            for &face in &*members {
                let [first, _] = polygons[face as usize];
                self.part[face as usize] = self.part[first as usize];
            }
        }

        // By counting, so that what was near in memory stays so.
        let slice_of = |face: u32| self.part[face as usize] - first_part;
        let mut starts = rows::starts(shares.len(), members.iter().map(|&face| slice_of(face)));
        self.queue.copy_from_slice(members);
        let items = self.queue.iter().map(|&face| (slice_of(face), face));
        rows::place(&mut starts, items, members);
        starts[1..].iter().map(|&end| end as usize).collect()
    }

    /// Lists the members in `queue` by their distance from the first, then those that are not
    /// connected with it, piece by piece.
    fn walk(&mut self, members: &[u32]) {
        self.queue.clear();
        let part = self.part[members[0] as usize];
        // The number of a part marks what the walk has reached; slicing overwrites it.
        let reached = self.parts;
        self.parts += 1;

        for &piece in members {
            if self.part[piece as usize] == reached {
                continue;
            }
            self.part[piece as usize] = reached;

            // Breadth first from a face that was not reached.
            let mut next = self.queue.len();
            self.queue.push(piece);
            while let Some(&face) = self.queue.get(next) {
                next += 1;
                for vertex in self.faces[face as usize] {
                    // The faces of each vertex are visited once.
                    if std::mem::replace(&mut self.fans[vertex as usize], reached) == reached {
                        continue;
                    }
                    for &near in self.adjacency.faces_of(vertex) {
                        if self.part[near as usize] == part {
                            self.part[near as usize] = reached;
                            self.queue.push(near);
                        }
                    }
                }
            }
        }
    }
}
