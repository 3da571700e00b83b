//! Vertices numbered by their first use, at the cost of those that are used.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::faces::Faces;
use crate::index::index32;

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

/// Faces over just the vertices that they use, numbered by their first use: borrowed where they are
/// numbered so already.
pub(crate) struct Compact<'a> {
    corners: Cow<'a, [[u32; 3]]>,
    vertex_count: usize,
}

impl<'a> Compact<'a> {
    /// Time and space O(faces).
    pub(crate) fn new(faces: Faces<'a>) -> Self {
        let mut first_unused = 0;
        let is_numbered_so = faces.as_slice().as_flattened().iter().all(|&vertex| {
            first_unused += u32::from(vertex == first_unused);
            vertex < first_unused
        });
        if is_numbered_so {
            return Self {
                corners: Cow::Borrowed(faces.as_slice()),
                vertex_count: first_unused as usize,
            };
        }

        let mut numbers = FirstUse::new(faces.vertex_count(), 3 * faces.len());
        let corners = faces.as_slice().iter();
        let corners = corners.map(|face| face.map(|vertex| numbers.number(vertex)));
        Self {
            corners: Cow::Owned(corners.collect()),
            vertex_count: numbers.used.len(),
        }
    }

    /// As [`new`](Self::new) where the vertices are far more than the corners, otherwise the faces as
    /// they are.
    pub(crate) fn where_sparse(faces: Faces<'a>) -> Self {
        match is_sparse(faces.vertex_count(), 3 * faces.len()) {
            true => Self::new(faces),
            false => Self {
                corners: Cow::Borrowed(faces.as_slice()),
                vertex_count: faces.vertex_count(),
            },
        }
    }

    /// As [`new`](Self::new), of faces that are not needed afterwards.
    pub(crate) fn of_owned(corners: Vec<[u32; 3]>, vertex_count: usize) -> Compact<'static> {
        let compact = Compact::new(Faces::of_checked(&corners, vertex_count));
        let vertex_count = compact.vertex_count;
        let corners = match compact.corners {
            Cow::Owned(renumbered) => renumbered,
            Cow::Borrowed(_) => corners,
        };
        Compact {
            corners: Cow::Owned(corners),
            vertex_count,
        }
    }

    pub(crate) fn faces(&self) -> Faces<'_> {
        Faces::of_checked(&self.corners, self.vertex_count)
    }
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
            let compact = Compact::of_owned(other.to_vec(), vertex_count.max(8));
            assert_eq!(compact.faces(), Faces::new(&faces, 5).unwrap());
        }
    }
}
