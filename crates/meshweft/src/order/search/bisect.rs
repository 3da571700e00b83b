//! Compact parts of a mesh, by connectivity alone.

use crate::adjacency::Adjacency;
use crate::limits::index32;
use crate::permutation::Permutation;

/// The faces in parts of at least `size` faces (if there are as many), and where each part ends.
///
/// Halves until parts are small enough: faces by their distance from an end of the part, cut in the
/// middle, which for a long part is across it. Inside a part faces keep their order; polygons, if
/// any, stay whole.
///
/// Time O(faces · log parts), space 40 bytes a face.
pub(super) fn compact_parts(
    faces: &[[u32; 3]],
    vertex_count: usize,
    size: usize,
    polygons: Option<&[[u32; 2]]>,
) -> (Permutation, Vec<usize>) {
    let mut halving = Halving {
        faces,
        adjacency: Adjacency::new(faces, vertex_count),
        polygons,
        part: vec![0; faces.len()],
        reached: vec![0; faces.len()],
        fans: vec![0; vertex_count],
        walks: 0,
        queue: Vec::new(),
    };
    let mut members: Vec<u32> = (0..index32(faces.len())).collect();
    let mut ends = Vec::new();
    // Parts still to be halved, the first one last: where it starts and ends, in how many parts.
    let mut open = vec![(0, faces.len(), faces.len() / size)];
    let mut next_part = 1;
    while let Some((start, end, parts)) = open.pop() {
        if parts < 2 {
            ends.push(end);
            continue;
        }
        let before = parts / 2;
        let middle = halving.halve(&mut members[start..end], before, parts, next_part);
        next_part += 1;
        open.push((start + middle, end, parts - before));
        open.push((start, start + middle, before));
    }
    (Permutation::from_algorithm(members), ends)
}

struct Halving<'a> {
    faces: &'a [[u32; 3]],
    adjacency: Adjacency,
    polygons: Option<&'a [[u32; 2]]>,
    /// The part of each face.
    part: Vec<u32>,
    /// The last walk that reached each face, and that went round each vertex.
    reached: Vec<u32>,
    fans: Vec<u32>,
    walks: u32,
    /// Faces in the order in which the walk reached them.
    queue: Vec<u32>,
}

impl Halving<'_> {
    /// Puts about `before / parts` of the faces first, those near one end; how many.
    ///
    /// The others become part `next_part`.
    fn halve(&mut self, members: &mut [u32], before: usize, parts: usize, next_part: u32) -> usize {
        self.walk(members, members[0]);
        // The last face that was reached is at an end.
        let end = *self.queue.last().expect("a part has faces");
        self.walk(members, end);
        let wanted = members.len() * before / parts;
        for &face in &self.queue[wanted..] {
            self.part[face as usize] = next_part;
        }
        if let Some(polygons) = self.polygons {
            // Each goes where its first face went.
            for &face in &*members {
                let [first, _] = polygons[face as usize];
                self.part[face as usize] = self.part[first as usize];
            }
        }
        // Stable, so that what was near in memory stays so.
        let (stay, go): (Vec<u32>, Vec<u32>) = members
            .iter()
            .partition(|&&face| self.part[face as usize] != next_part);
        members[..stay.len()].copy_from_slice(&stay);
        members[stay.len()..].copy_from_slice(&go);
        stay.len()
    }

    /// Lists the members by their distance from `start`, and piece by piece what does not hang
    /// together with it.
    fn walk(&mut self, members: &[u32], start: u32) {
        self.walks += 1;
        self.queue.clear();
        let part = self.part[start as usize];
        for &piece in std::iter::once(&start).chain(members) {
            if self.reached[piece as usize] == self.walks {
                continue;
            }
            self.reached[piece as usize] = self.walks;
            let mut next = self.queue.len();
            self.queue.push(piece);
            while let Some(&face) = self.queue.get(next) {
                next += 1;
                for vertex in self.faces[face as usize] {
                    // Once round each vertex, however many faces it has.
                    if std::mem::replace(&mut self.fans[vertex as usize], self.walks) == self.walks
                    {
                        continue;
                    }
                    for &near in self.adjacency.faces_of(vertex) {
                        let reached = &mut self.reached[near as usize];
                        if *reached != self.walks && self.part[near as usize] == part {
                            *reached = self.walks;
                            self.queue.push(near);
                        }
                    }
                }
            }
        }
    }
}
