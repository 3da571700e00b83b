//! Orders as values, with one documented direction.
//!
//! The classic bug of this field is a permutation read backwards. Here there is one convention:
//! a permutation is stored as `new_to_old`, so `out[i] = in[new_to_old[i]]`.

use crate::error::MeshError;
use crate::faces::turned;
use crate::index::{MAX_VERTICES, index32};
use crate::random::shuffled;

/// An order of `n` things, each number below `n` once: `out[i] = in[new_to_old[i]]`.
///
/// ```
/// use meshweft::Permutation;
/// let p = Permutation::new(vec![2, 0, 1])?;
/// assert_eq!(p.apply(&['a', 'b', 'c']), ['c', 'a', 'b']);
/// assert_eq!(p.inverse().apply(&p.apply(&['a', 'b', 'c'])), ['a', 'b', 'c']);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Permutation {
    new_to_old: Vec<u32>,
}

impl Permutation {
    /// The permutation with `out[i] = in[new_to_old[i]]`.
    ///
    /// # Errors
    /// [`MeshError::NotAPermutation`] if a value is too large or repeated,
    /// [`MeshError::TooLarge`] if there are more than 2³² − 1 entries.
    ///
    /// # Complexity
    /// Time O(n), space n bits.
    pub fn new(new_to_old: Vec<u32>) -> Result<Self, MeshError> {
        let len = new_to_old.len();
        if len > MAX_VERTICES {
            return Err(MeshError::TooLarge {
                what: "entries",
                count: len,
                limit: MAX_VERTICES,
            });
        }
        let mut seen = vec![0_u64; len.div_ceil(64)];
        for (position, &value) in new_to_old.iter().enumerate() {
            let (word, bit) = (value as usize / 64, 1_u64 << (value % 64));
            if value as usize >= len || seen[word] & bit != 0 {
                return Err(MeshError::NotAPermutation {
                    position,
                    value,
                    len,
                });
            }
            seen[word] |= bit;
        }
        Ok(Self { new_to_old })
    }

    /// A permutation that an algorithm of this crate built; checked in debug builds only.
    pub(crate) fn from_algorithm(new_to_old: Vec<u32>) -> Self {
        debug_assert!(Self::new(new_to_old.clone()).is_ok());
        Self { new_to_old }
    }

    /// The permutation that changes nothing.
    ///
    /// # Panics
    /// If `len` is more than 2³² − 1.
    #[must_use]
    pub fn identity(len: usize) -> Self {
        assert!(
            len <= MAX_VERTICES,
            "more entries than 32-bit indices count"
        );
        Self {
            new_to_old: (0..index32(len)).collect(),
        }
    }

    /// A random permutation, the same for the same seed on every platform.
    ///
    /// Numbers are drawn by SplitMix64 (Steele, Lea, Flood 2014, doi:10.1145/2714064.2660195).
    ///
    /// # Panics
    /// If `len` is more than 2³² − 1.
    #[must_use]
    pub fn random(len: usize, seed: u64) -> Self {
        assert!(
            len <= MAX_VERTICES,
            "more entries than 32-bit indices count"
        );
        Self {
            new_to_old: shuffled(len, seed),
        }
    }

    /// The old position of each new position.
    #[must_use]
    pub fn new_to_old(&self) -> &[u32] {
        &self.new_to_old
    }

    /// The new position of each old position.
    #[must_use]
    pub fn old_to_new(&self) -> Vec<u32> {
        let mut old_to_new = vec![0; self.new_to_old.len()];
        for (new, &old) in self.new_to_old.iter().enumerate() {
            old_to_new[old as usize] = index32(new);
        }
        old_to_new
    }

    /// The permutation that undoes this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self {
            new_to_old: self.old_to_new(),
        }
    }

    /// One permutation that has the effect of this one, followed by `next`.
    ///
    /// # Panics
    /// If the lengths differ.
    ///
    /// ```
    /// use meshweft::Permutation;
    /// let (p, q) = (Permutation::new(vec![2, 0, 1])?, Permutation::new(vec![1, 0, 2])?);
    /// assert_eq!(p.then(&q).apply(b"abc"), q.apply(&p.apply(b"abc")));
    /// # Ok::<(), meshweft::MeshError>(())
    /// ```
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            new_to_old: next.apply(&self.new_to_old),
        }
    }

    /// The number of entries.
    #[must_use]
    pub fn len(&self) -> usize {
        self.new_to_old.len()
    }

    /// Whether there are no entries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.new_to_old.is_empty()
    }

    /// Whether it changes nothing.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        (0_u32..)
            .zip(&self.new_to_old)
            .all(|(new, &old)| new == old)
    }

    /// The entries of `input` in the new order.
    ///
    /// # Panics
    /// If `input` has another length.
    #[must_use]
    pub fn apply<T: Clone>(&self, input: &[T]) -> Vec<T> {
        assert_eq!(input.len(), self.len(), "permutation of another length");
        self.new_to_old
            .iter()
            .map(|&old| input[old as usize].clone())
            .collect()
    }
}

/// The order in which faces are drawn, and how far each one's corners are turned.
///
/// Turning changes which of the three corners is first, never the winding: with rotation `r`, new
/// corner `j` is old corner `(j + r) % 3`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct FaceOrder {
    permutation: Permutation,
    /// One entry a face in the *new* order, or empty if no corners are turned.
    rotations: Vec<u8>,
}

impl FaceOrder {
    /// The order that draws old face `new_to_old[i]` as the `i`-th, with corners turned by
    /// `rotations[i]`.
    ///
    /// `rotations` is empty (no corners are turned) or as long as the permutation.
    ///
    /// # Errors
    /// [`MeshError::LengthMismatch`] if the lengths differ, [`MeshError::InvalidRotation`] if a
    /// rotation is above 2.
    pub fn new(permutation: Permutation, rotations: Vec<u8>) -> Result<Self, MeshError> {
        if !rotations.is_empty() && rotations.len() != permutation.len() {
            return Err(MeshError::LengthMismatch {
                what: "rotations of a face order",
                expected: permutation.len(),
                found: rotations.len(),
            });
        }
        if let Some(position) = rotations.iter().position(|&r| r > 2) {
            return Err(MeshError::InvalidRotation {
                position,
                value: rotations[position],
            });
        }
        Ok(Self {
            permutation,
            rotations,
        })
    }

    /// The order that changes nothing.
    ///
    /// # Panics
    /// If `face_count` is more than 2³² − 1.
    #[must_use]
    pub fn identity(face_count: usize) -> Self {
        Self::from(Permutation::identity(face_count))
    }

    /// The permutation of the faces, without the rotations.
    #[must_use]
    pub fn permutation(&self) -> &Permutation {
        &self.permutation
    }

    /// The old face of each new face.
    #[must_use]
    pub fn new_to_old(&self) -> &[u32] {
        self.permutation.new_to_old()
    }

    /// How far the corners of the `new_face`-th face are turned: 0, 1 or 2.
    ///
    /// # Panics
    /// If corners are turned and `new_face` is not below [`len`](Self::len).
    #[must_use]
    pub fn rotation(&self, new_face: usize) -> u8 {
        if self.rotations.is_empty() {
            0
        } else {
            self.rotations[new_face]
        }
    }

    /// All rotations in the new order; empty if no corners are turned.
    #[must_use]
    pub fn rotations(&self) -> &[u8] {
        &self.rotations
    }

    /// One order that has the effect of this one, followed by `next`.
    ///
    /// # Panics
    /// If the lengths differ.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let turned = |(new, &between): (usize, &u32)| {
            (self.rotation(between as usize) + next.rotation(new)) % 3
        };
        let rotations = match self.rotations.is_empty() && next.rotations.is_empty() {
            true => Vec::new(),
            false => next.new_to_old().iter().enumerate().map(turned).collect(),
        };
        Self {
            permutation: self.permutation.then(&next.permutation),
            rotations,
        }
    }

    /// How many faces it orders.
    #[must_use]
    pub fn len(&self) -> usize {
        self.permutation.len()
    }

    /// Whether it orders no faces.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.permutation.is_empty()
    }

    /// Whether it neither moves a face nor turns a corner.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        self.permutation.is_identity() && self.rotations.iter().all(|&r| r == 0)
    }

    /// The faces in the new order, with their corners turned.
    ///
    /// A corner may be a vertex index or any other data of a corner.
    ///
    /// # Panics
    /// If `faces` has another length.
    ///
    /// ```
    /// use meshweft::{FaceOrder, Permutation};
    /// let order = FaceOrder::new(Permutation::new(vec![1, 0])?, vec![2, 0])?;
    /// assert_eq!(order.apply(&[[0, 1, 2], [2, 1, 3]]), [[3, 2, 1], [0, 1, 2]]);
    /// # Ok::<(), meshweft::MeshError>(())
    /// ```
    #[must_use]
    pub fn apply<T: Copy>(&self, faces: &[[T; 3]]) -> Vec<[T; 3]> {
        assert_eq!(faces.len(), self.len(), "face order of another length");
        let rotated = |(new, &old): (usize, &u32)| turned(faces[old as usize], self.rotation(new));
        self.new_to_old().iter().enumerate().map(rotated).collect()
    }
}

impl From<Permutation> for FaceOrder {
    fn from(permutation: Permutation) -> Self {
        Self {
            permutation,
            rotations: Vec::new(),
        }
    }
}

/// The order in which vertices are stored.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct VertexOrder {
    permutation: Permutation,
}

impl VertexOrder {
    /// The order that changes nothing.
    ///
    /// # Panics
    /// If `vertex_count` is more than 2³² − 1.
    #[must_use]
    pub fn identity(vertex_count: usize) -> Self {
        Self::from(Permutation::identity(vertex_count))
    }

    /// The permutation of the vertices.
    #[must_use]
    pub fn permutation(&self) -> &Permutation {
        &self.permutation
    }

    /// The old vertex of each new vertex.
    #[must_use]
    pub fn new_to_old(&self) -> &[u32] {
        self.permutation.new_to_old()
    }

    /// One order that has the effect of this one, followed by `next`.
    ///
    /// # Panics
    /// If the lengths differ.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        self.permutation.then(&next.permutation).into()
    }

    /// How many vertices it orders.
    #[must_use]
    pub fn len(&self) -> usize {
        self.permutation.len()
    }

    /// Whether it orders no vertices.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.permutation.is_empty()
    }

    /// Whether it moves no vertex.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        self.permutation.is_identity()
    }

    /// The faces with the new number of each vertex.
    ///
    /// # Panics
    /// If a face names a vertex that the order does not have.
    #[must_use]
    pub fn renumber(&self, faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
        let mut faces = faces.to_vec();
        self.renumber_in_place(&mut faces);
        faces
    }

    /// As [`renumber`](Self::renumber), without a copy of the faces.
    pub(crate) fn renumber_in_place(&self, faces: &mut [[u32; 3]]) {
        renumber(faces, &self.permutation.old_to_new());
    }
}

/// Gives each corner the new number of its vertex.
pub(crate) fn renumber(faces: &mut [[u32; 3]], old_to_new: &[u32]) {
    for face in faces {
        *face = face.map(|vertex| old_to_new[vertex as usize]);
    }
}

impl From<Permutation> for VertexOrder {
    fn from(permutation: Permutation) -> Self {
        Self { permutation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repetition_is_refused_and_named() {
        let error = Permutation::new(vec![0, 2, 2]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "not a permutation: entry 2 is 2, which is a repetition for length 3"
        );
    }

    #[test]
    fn a_value_past_the_end_is_refused_and_named() {
        let error = Permutation::new(vec![0, 3, 1]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "not a permutation: entry 1 is 3, which is too large for length 3"
        );
    }

    #[test]
    fn inverse_swaps_the_two_directions() {
        let p = Permutation::new(vec![2, 0, 3, 1]).unwrap();
        assert_eq!(p.old_to_new(), [1, 3, 0, 2]);
        assert_eq!(p.inverse().new_to_old(), p.old_to_new());
        assert_eq!(p.inverse().inverse(), p);
    }

    #[test]
    fn rotations_keep_the_winding() {
        let order = FaceOrder::new(Permutation::identity(3), vec![0, 1, 2]).unwrap();
        let turned = order.apply(&[[7, 8, 9]; 3]);
        assert_eq!(turned, [[7, 8, 9], [8, 9, 7], [9, 7, 8]]);
    }

    #[test]
    fn orders_add_up_with_their_rotations() {
        let order = |new_to_old: [u32; 3], rotations: &[u8]| {
            let permutation = Permutation::new(new_to_old.to_vec()).unwrap();
            FaceOrder::new(permutation, rotations.to_vec()).unwrap()
        };
        let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let orders = [
            order([2, 0, 1], &[1, 2, 0]),
            order([0, 2, 1], &[2, 2, 1]),
            order([1, 2, 0], &[]),
        ];
        for first in &orders {
            for second in &orders {
                let both = first.then(second).apply(&faces);
                assert_eq!(both, second.apply(&first.apply(&faces)));
            }
        }
    }

    #[test]
    fn a_fourth_corner_is_refused() {
        let error = FaceOrder::new(Permutation::identity(2), vec![0, 3]).unwrap_err();
        assert_eq!(
            error,
            MeshError::InvalidRotation {
                position: 1,
                value: 3
            }
        );
        assert!(FaceOrder::new(Permutation::identity(2), vec![0]).is_err());
    }

    #[test]
    fn renumbering_follows_the_vertices() {
        let order = VertexOrder::from(Permutation::new(vec![2, 0, 1]).unwrap());
        let positions = order.permutation().apply(&["a", "b", "c"]);
        let faces = order.renumber(&[[0, 1, 2]]);
        assert_eq!(faces[0].map(|v| positions[v as usize]), ["a", "b", "c"]);
    }
}
