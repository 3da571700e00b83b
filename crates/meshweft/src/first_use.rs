//! Vertices numbered by their first use, at the cost of those that are used.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::faces::Faces;
use crate::index::{BLOCK, block_of, index32};

const UNNUMBERED: u32 = u32::MAX;

/// More vertices than this many times the corners are looked up instead of indexed: a few faces on a
/// large vertex buffer then cost what they have, not what the buffer has.
const SPARSE: usize = 8;

fn is_sparse(vertex_count: usize, corners: usize) -> bool {
    vertex_count / SPARSE > corners
}

/// Gives vertices numbers from 0 in the order in which they first come up.
pub(crate) struct FirstUse {
    number_of: NumberOf,
    /// The vertex of each number.
    used: Vec<u32>,
}

enum NumberOf {
    /// One entry a vertex.
    Array(Vec<u32>),
    /// One entry a vertex that came up. It is never iterated over.
    Lookup(HashMap<u32, u32>),
}

impl FirstUse {
    /// Nothing is numbered yet of `vertex_count` vertices, of which up to `corners` will come up.
    pub(crate) fn new(vertex_count: usize, corners: usize) -> Self {
        let number_of = match is_sparse(vertex_count, corners) {
            true => NumberOf::Lookup(HashMap::new()),
            false => NumberOf::Array(vec![UNNUMBERED; vertex_count]),
        };
        Self {
            number_of,
            used: Vec::new(),
        }
    }

    /// The number of a vertex.
    #[inline]
    pub(crate) fn number(&mut self, vertex: u32) -> u32 {
        let number = match &mut self.number_of {
            NumberOf::Array(numbers) => &mut numbers[vertex as usize],
            NumberOf::Lookup(numbers) => numbers.entry(vertex).or_insert(UNNUMBERED),
        };
        if *number == UNNUMBERED {
            *number = index32(self.used.len());
            self.used.push(vertex);
        }
        *number
    }

    /// The vertex of each number; nothing is numbered afterwards. Costs what was used.
    pub(crate) fn finish(&mut self) -> Vec<u32> {
        match &mut self.number_of {
            NumberOf::Array(numbers) => {
                for &vertex in &self.used {
                    numbers[vertex as usize] = UNNUMBERED;
                }
            }
            NumberOf::Lookup(numbers) => numbers.clear(),
        }
        std::mem::take(&mut self.used)
    }
}

/// More vertices than this many times those that are used: their blocks are given up.
const SPARSE_BLOCKS: usize = 4;

/// Whether faces that use so many of `vertex_count` vertices keep to the blocks of 65,536 that these stand
/// in. A few on a large vertex buffer do not: they would cost what the buffer has.
pub(crate) fn keeps_blocks(vertex_count: usize, used: usize) -> bool {
    vertex_count > BLOCK && used > vertex_count / SPARSE_BLOCKS
}

/// Faces over just the vertices that they use, numbered by their first use: borrowed where they are
/// numbered so already.
///
/// Of more than 65,536 vertices each stays in its block, numbered by first use in that one
/// ([`keeps_blocks`]): the vertices then are those of the buffer, used or not.
pub(crate) struct Compact<'a> {
    corners: Cow<'a, [[u32; 3]]>,
    vertex_count: usize,
    has_blocks: bool,
}

impl<'a> Compact<'a> {
    /// Time and space O(faces), with blocks O(vertices + faces).
    pub(crate) fn new(faces: Faces<'a>) -> Self {
        let has_blocks = faces.vertex_count() > BLOCK
            && 3 * faces.len() > faces.vertex_count() / SPARSE_BLOCKS
            && keeps_blocks(faces.vertex_count(), used_vertices(faces));
        Self::numbered(faces, has_blocks)
    }

    /// As [`new`](Self::new) where the vertices are far more than the corners, otherwise the faces as
    /// they are.
    pub(crate) fn where_sparse(faces: Faces<'a>) -> Self {
        match is_sparse(faces.vertex_count(), 3 * faces.len()) {
            true => Self::new(faces),
            false => Self {
                corners: Cow::Borrowed(faces.as_slice()),
                vertex_count: faces.vertex_count(),
                has_blocks: faces.vertex_count() > BLOCK,
            },
        }
    }

    /// The same faces in another order, compact in the same way: what [`new`](Self::new) makes of them in
    /// the numbers of the file.
    pub(crate) fn reordered(&self, corners: Vec<[u32; 3]>) -> Compact<'static> {
        let faces = Faces::of_checked(&corners, self.vertex_count);
        let Compact {
            corners: renumbered,
            vertex_count,
            has_blocks,
        } = Compact::numbered(faces, self.has_blocks);
        let renumbered = match renumbered {
            Cow::Owned(renumbered) => Some(renumbered),
            Cow::Borrowed(_) => None,
        };
        Compact {
            corners: Cow::Owned(renumbered.unwrap_or(corners)),
            vertex_count,
            has_blocks,
        }
    }

    fn numbered(faces: Faces<'a>, has_blocks: bool) -> Self {
        // The next number of each block, or of all vertices.
        let vertex_count = faces.vertex_count();
        let block_of = |vertex| {
            if has_blocks {
                block_of(vertex) as usize
            } else {
                0
            }
        };
        let block_count = if has_blocks {
            vertex_count.div_ceil(BLOCK)
        } else {
            1
        };
        let starts: Vec<u32> = (0..block_count)
            .map(|block| index32(block * BLOCK))
            .collect();

        let mut next = starts.clone();
        let is_numbered_so = faces.as_slice().as_flattened().iter().all(|&vertex| {
            let next = &mut next[block_of(vertex)];
            *next += u32::from(vertex == *next);
            vertex < *next
        });
        if is_numbered_so {
            return Self {
                corners: Cow::Borrowed(faces.as_slice()),
                vertex_count: if has_blocks {
                    vertex_count
                } else {
                    next[0] as usize
                },
                has_blocks,
            };
        }

        let mut corners = Vec::with_capacity(faces.len());
        let vertex_count = if has_blocks {
            let mut next = starts;
            let mut numbers = vec![UNNUMBERED; vertex_count];
            let mut number = |vertex: u32| {
                let number = &mut numbers[vertex as usize];
                if *number == UNNUMBERED {
                    let next = &mut next[block_of(vertex)];
                    *number = *next;
                    *next += 1;
                }
                *number
            };
            corners.extend(faces.as_slice().iter().map(|face| face.map(&mut number)));
            vertex_count
        } else {
            let mut numbers = FirstUse::new(vertex_count, 3 * faces.len());
            let mut number = |vertex: u32| numbers.number(vertex);
            corners.extend(faces.as_slice().iter().map(|face| face.map(&mut number)));
            numbers.used.len()
        };
        Self {
            corners: Cow::Owned(corners),
            vertex_count,
            has_blocks,
        }
    }

    pub(crate) fn faces(&self) -> Faces<'_> {
        Faces::of_checked(&self.corners, self.vertex_count)
    }
}

fn used_vertices(faces: Faces<'_>) -> usize {
    let mut is_used = vec![false; faces.vertex_count()];
    for &vertex in faces.as_slice().as_flattened() {
        is_used[vertex as usize] = true;
    }
    is_used.into_iter().filter(|&used| used).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_first_use_however_they_are_found() {
        for vertex_count in [10, 1_000_000] {
            let mut numbers = FirstUse::new(vertex_count, 6);
            for _ in 0..2 {
                let numbered = [9, 4, 9, 0, 4, 7].map(|vertex| numbers.number(vertex));
                assert_eq!(numbered, [0, 1, 0, 2, 1, 3]);
                assert_eq!(numbers.finish(), [9, 4, 0, 7]);
            }
        }
    }

    #[test]
    fn faces_are_copied_only_to_renumber_them() {
        let faces = [[0, 1, 2], [2, 1, 3], [0, 0, 4]];
        for vertex_count in [5, 80, 1_000_000] {
            let compact = Compact::new(Faces::of_checked(&faces, vertex_count));
            assert!(matches!(compact.corners, Cow::Borrowed(_)));
            assert_eq!(compact.faces(), Faces::new(&faces, 5).unwrap());

            let other = [[7, 1, 2], [2, 1, 3], [7, 7, 0]];
            let compact = Compact::new(Faces::of_checked(&other, vertex_count.max(8)));
            assert_eq!(compact.faces(), Faces::new(&faces, 5).unwrap());
            let again = compact.reordered(vec![[4, 1, 2], [2, 1, 0]]);
            assert_eq!(again.faces().as_slice(), [[0, 1, 2], [2, 1, 3]]);
        }
    }

    #[test]
    fn many_vertices_stay_in_their_blocks() {
        let high = 1 << 16;
        let vertices = 70_000;
        let mut faces: Vec<[u32; 3]> = vec![[high + 9, 70, high + 5], [5, 70, 69_999]];
        faces.extend((0..20_000).map(|i| [i, i + 1, i + 2]));
        let compact = Compact::new(Faces::new(&faces, vertices).unwrap());
        assert_eq!(compact.faces().vertex_count(), vertices);
        let first = &compact.faces().as_slice()[..3];
        assert_eq!(first, [[high, 0, high + 1], [1, 0, high + 2], [2, 3, 4]]);

        // The last face first.
        let mut other = compact.faces().as_slice().to_vec();
        other.reverse();
        let reversed: Vec<_> = faces.iter().rev().copied().collect();
        let again = compact.reordered(other);
        let expected = Compact::new(Faces::new(&reversed, vertices).unwrap());
        assert_eq!(again.faces(), expected.faces());

        // Few of them give their blocks up.
        let few = Compact::new(Faces::new(&reversed[19_000..], vertices).unwrap());
        assert_eq!(few.faces().vertex_count(), 1_005);
    }
}
