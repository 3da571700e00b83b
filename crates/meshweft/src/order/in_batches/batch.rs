//! The faces of one batch, their vertices numbered from 0.

use crate::cache::nvidia::{BATCH_FACES, LANES};
use crate::index::{block_of, index32};

/// The FIFO cache that an order may be kept good for: the smallest that the universal target looks
/// after.
pub(in crate::order) const BESIDE_SIZE: u32 = 10;
/// Most faces in a batch.
pub(super) const MOST_FACES: usize = BATCH_FACES as usize;
/// Most vertices in a batch.
pub(super) const MOST_VERTICES: usize = LANES as usize;
/// More than the vertices of a batch, so that a free entry is always near.
const ENTRIES: usize = 128;

/// Faces that may be drawn in any order in one batch. Sets of faces and of vertices are bits.
#[derive(Debug, Clone)]
pub(super) struct Batch {
    /// Each face's corners, as numbers of vertices in the batch.
    corners: [[u8; 3]; MOST_FACES],
    len: usize,
    /// How many faces are drawn together from each face on; 0 for those that come along.
    together: [u8; MOST_FACES],
    /// The faces that begin a polygon.
    firsts: u32,
    /// How many of the first faces stay first: they finish a polygon of the batch before.
    fixed: usize,
    /// The faces at each vertex.
    faces_at: [u32; MOST_VERTICES],
    vertex_count: usize,
    /// By a hash of the vertex: the fill it belongs to, the vertex and its number.
    numbers: [(u32, u32, u8); ENTRIES],
    fill: u32,
}

impl Default for Batch {
    fn default() -> Self {
        Self {
            corners: [[0; 3]; MOST_FACES],
            len: 0,
            together: [0; MOST_FACES],
            firsts: 0,
            fixed: 0,
            faces_at: [0; MOST_VERTICES],
            vertex_count: 0,
            numbers: [(0, 0, 0); ENTRIES],
            fill: 0,
        }
    }
}

impl Batch {
    /// Takes the first of these faces: as many as one batch holds, up to the first that must stay where
    /// it is, because it is degenerate or in another block. `polygons` has the polygon of each face, also
    /// of those before `start`.
    pub(super) fn fill(&mut self, faces: &[[u32; 3]], start: usize, polygons: Option<&[u32]>) {
        self.clear();
        let faces = &faces[start..];
        let Some(&[first, ..]) = faces.first() else {
            return;
        };
        let block = block_of(first);
        for &face in faces.iter().take(MOST_FACES) {
            let [a, b, c] = face;
            let is_plain = a != b && b != c && c != a;
            if !is_plain || face.map(block_of) != [block; 3] || !self.add(face) {
                break;
            }
        }

        // Polygons, as far as they are in the batch as a whole.
        self.together[..self.len].fill(1);
        if let Some(polygons) = polygons {
            let (before, polygons) = polygons.split_at(start);
            self.keep_together(before.last(), polygons);
        }
        let firsts = (0..self.len).filter(|&face| self.together[face] != 0);
        self.firsts = firsts.fold(0, |set, face| set | 1 << face);
    }

    fn clear(&mut self) {
        self.len = 0;
        self.fixed = 0;
        self.vertex_count = 0;
        self.fill = self.fill.checked_add(1).unwrap_or_else(|| {
            self.numbers = [(0, 0, 0); ENTRIES];
            1
        });
    }

    /// Adds a face, unless its vertices do not fit.
    fn add(&mut self, face: [u32; 3]) -> bool {
        let vertices_before = self.vertex_count;
        let mut corners = [0; 3];
        for (number, vertex) in corners.iter_mut().zip(face) {
            match self.number(vertex) {
                Some(found) => *number = found,
                None => {
                    self.vertex_count = vertices_before;
                    return false;
                }
            }
        }
        self.corners[self.len] = corners;
        for vertex in corners {
            self.faces_at[usize::from(vertex)] |= 1 << self.len;
        }
        self.len += 1;
        true
    }

    /// The number of a vertex, a new one if it has none; `None` if the batch has no room for it.
    #[inline]
    fn number(&mut self, vertex: u32) -> Option<u8> {
        let at = self.place(vertex);
        let (fill, _, number) = self.numbers[at];
        if fill == self.fill {
            return Some(number);
        }
        if self.vertex_count == MOST_VERTICES {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "at most 32")]
        let number = self.vertex_count as u8;
        self.numbers[at] = (self.fill, vertex, number);
        self.faces_at[self.vertex_count] = 0;
        self.vertex_count += 1;
        Some(number)
    }

    /// The entry of a vertex, or a free one.
    #[inline]
    fn place(&self, vertex: u32) -> usize {
        // Fibonacci hashing: the top 7 bits.
        let mut at = (vertex.wrapping_mul(0x9e37_79b9) >> 25) as usize;
        loop {
            let (fill, known, _) = self.numbers[at];
            if fill != self.fill || known == vertex {
                return at;
            }
            at = (at + 1) % ENTRIES;
        }
    }

    /// Marks the faces of each polygon as drawn together, and drops a last one that is not whole; `before`
    /// is the polygon drawn last.
    fn keep_together(&mut self, before: Option<&u32>, polygons: &[u32]) {
        let mut first = 0;
        for face in 1..=self.len {
            if face < self.len && polygons[face] == polygons[first] {
                self.together[face] = 0;
                continue;
            }
            if before == Some(&polygons[first]) {
                self.together[first] = 0;
                self.fixed = face;
            } else if face == self.len && polygons.get(face) == Some(&polygons[first]) {
                self.len = first;
            } else {
                #[expect(clippy::cast_possible_truncation, reason = "at most 32")]
                {
                    self.together[first] = (face - first) as u8;
                }
            }
            first = face;
        }
        let kept = all(self.len);
        for faces in &mut self.faces_at[..self.vertex_count] {
            *faces &= kept;
        }
    }

    /// How many of the first faces stay first.
    pub(super) fn fixed(&self) -> usize {
        self.fixed
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// How many vertices its faces use.
    pub(super) fn vertex_count(&self) -> u32 {
        self.faces_at[..self.vertex_count]
            .iter()
            .filter(|&&faces| faces != 0)
            .map(|_| 1)
            .sum()
    }

    /// The number of a vertex in the batch.
    #[inline]
    pub(super) fn number_of(&self, vertex: u32) -> Option<usize> {
        let (fill, _, number) = self.numbers[self.place(vertex)];
        (fill == self.fill).then_some(usize::from(number))
    }

    /// The numbers of a face's vertices.
    #[inline]
    pub(super) fn corners(&self, face: usize) -> [usize; 3] {
        self.corners[face % MOST_FACES].map(|vertex| usize::from(vertex) % MOST_VERTICES)
    }

    /// The same, as lanes.
    #[inline]
    pub(super) fn lanes(&self, face: usize) -> [u32; 3] {
        self.corners[face % MOST_FACES].map(u32::from)
    }

    /// The faces at a vertex.
    #[inline]
    pub(super) fn faces_at(&self, vertex: usize) -> u32 {
        self.faces_at[vertex % MOST_VERTICES]
    }

    /// The faces that are drawn together, from one on that begins a polygon.
    #[inline]
    pub(super) fn together(&self, first: usize) -> std::ops::Range<usize> {
        first..first + usize::from(self.together[first % MOST_FACES])
    }

    /// The faces that begin a polygon.
    #[inline]
    pub(super) fn firsts(&self) -> u32 {
        self.firsts
    }

    /// How many faces it has.
    #[inline]
    pub(super) fn face_count(&self) -> u32 {
        index32(self.len)
    }
}

/// The set of the numbers below `count`, at most 32.
pub(super) fn all(count: usize) -> u32 {
    match count {
        0 => 0,
        count => u32::MAX >> (MOST_FACES - count),
    }
}
