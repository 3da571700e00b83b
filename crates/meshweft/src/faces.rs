//! Faces that are borrowed, their indices known to be in range.

use crate::error::MeshError;
use crate::index::{MAX_FACES, MAX_VERTICES};

/// Borrowed faces over a number of vertices, checked once: what every order, count and cut takes.
///
/// Wherever `impl Into<Faces>` is asked for, a [`Mesh`](crate::Mesh) lends its faces, and a slice of
/// `[u32; 3]` is taken with a vertex count of its largest index plus one. Flat indices come in by
/// [`from_indices`](Self::from_indices), 16-bit ones by [`widened`](Self::widened).
///
/// ```
/// use meshweft::{CacheModel, Faces, cache, order::vertex_fetch};
/// let indices: [u32; 6] = [0, 1, 2, 2, 1, 3];
/// let faces = Faces::from_indices(&indices, 4)?;
/// assert_eq!(cache::acmr(faces, CacheModel::fifo(16)), 2.0);
/// assert_eq!(vertex_fetch(faces).len(), 4);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Faces<'a> {
    corners: &'a [[u32; 3]],
    vertex_count: usize,
}

impl<'a> Faces<'a> {
    /// These faces over `vertex_count` vertices.
    ///
    /// # Errors
    /// [`MeshError::IndexOutOfRange`] for the first index that names no vertex,
    /// [`MeshError::TooLarge`] beyond 2³² − 1 vertices or (2³² − 1) / 3 faces.
    ///
    /// # Complexity
    /// Time O(faces), no memory.
    pub fn new(corners: &'a [[u32; 3]], vertex_count: usize) -> Result<Self, MeshError> {
        for (what, count, limit) in [
            ("vertices", vertex_count, MAX_VERTICES),
            ("faces", corners.len(), MAX_FACES),
        ] {
            if count > limit {
                return Err(MeshError::TooLarge { what, count, limit });
            }
        }
        let out_of_range = |&&index: &&u32| index as usize >= vertex_count;
        let is_out = |face: &[u32; 3]| face.iter().any(|index| out_of_range(&index));
        if let Some(face) = corners.iter().position(is_out) {
            let mut numbered = corners[face].iter().enumerate();
            let (corner, &index) = numbered
                .find(|(_, index)| out_of_range(index))
                .expect("one of the three is out of range");
            return Err(MeshError::IndexOutOfRange {
                face,
                corner,
                index,
                vertex_count,
            });
        }
        Ok(Self {
            corners,
            vertex_count,
        })
    }

    /// The faces of flat indices, three a face, without a copy.
    ///
    /// # Errors
    /// [`MeshError::PartialFace`] if the last face is not whole, and as [`new`](Self::new).
    ///
    /// # Complexity
    /// Time O(indices), no memory.
    pub fn from_indices(indices: &'a [u32], vertex_count: usize) -> Result<Self, MeshError> {
        match indices.as_chunks() {
            (corners, []) => Self::new(corners, vertex_count),
            _ => Err(MeshError::PartialFace { len: indices.len() }),
        }
    }

    /// The faces of flat 16-bit indices, three a face, widened into `buffer`, which can be reused.
    ///
    /// # Errors
    /// As [`from_indices`](Self::from_indices).
    ///
    /// # Complexity
    /// Time O(indices), 12 bytes a face.
    ///
    /// ```
    /// use meshweft::{CacheModel, Faces, cache};
    /// let indices: [u16; 6] = [0, 1, 2, 2, 1, 3];
    /// let mut buffer = Vec::new();
    /// let faces = Faces::widened(&indices, 4, &mut buffer)?;
    /// assert_eq!(cache::misses(faces, CacheModel::fifo(16)), 4);
    /// # Ok::<(), meshweft::MeshError>(())
    /// ```
    pub fn widened(
        indices: &[u16],
        vertex_count: usize,
        buffer: &'a mut Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let (faces, []) = indices.as_chunks::<3>() else {
            return Err(MeshError::PartialFace { len: indices.len() });
        };
        buffer.clear();
        buffer.extend(faces.iter().map(|face| face.map(u32::from)));
        Self::new(buffer, vertex_count)
    }

    /// Faces of a mesh that was checked before.
    pub(crate) fn of_checked(corners: &'a [[u32; 3]], vertex_count: usize) -> Self {
        debug_assert!(Self::new(corners, vertex_count).is_ok());
        Self {
            corners,
            vertex_count,
        }
    }

    /// The three vertices of each face.
    #[must_use]
    #[inline]
    pub fn as_slice(&self) -> &'a [[u32; 3]] {
        self.corners
    }

    /// How many faces there are.
    #[must_use]
    #[inline]
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    /// Whether there is no face.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// How many vertices there are, used or not.
    #[must_use]
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }
}

impl<'a> From<&'a [[u32; 3]]> for Faces<'a> {
    /// The vertex count is the largest index plus one; O(faces). Most calls allocate by the vertex
    /// count: check indices that you do not trust by [`Faces::new`].
    ///
    /// # Panics
    /// If an index is `u32::MAX`, or there are more than (2³² − 1) / 3 faces.
    fn from(corners: &'a [[u32; 3]]) -> Self {
        let greatest = corners.as_flattened().iter().max();
        let greatest = greatest.copied();
        assert!(
            greatest != Some(u32::MAX) && corners.len() <= MAX_FACES,
            "more vertices or faces than 32-bit indices count"
        );
        let vertex_count = greatest.map_or(0, |greatest| greatest as usize + 1);
        Self {
            corners,
            vertex_count,
        }
    }
}

impl<'a, const N: usize> From<&'a [[u32; 3]; N]> for Faces<'a> {
    fn from(corners: &'a [[u32; 3]; N]) -> Self {
        corners.as_slice().into()
    }
}

impl<'a> From<&'a Vec<[u32; 3]>> for Faces<'a> {
    fn from(corners: &'a Vec<[u32; 3]>) -> Self {
        corners.as_slice().into()
    }
}

/// A face with its corners turned: new corner `j` is old corner `(j + rotation) % 3`.
///
/// # Panics
/// If `rotation` is above 2.
#[inline]
pub(crate) fn turned<T: Copy>([a, b, c]: [T; 3], rotation: u8) -> [T; 3] {
    [[a, b, c], [b, c, a], [c, a, b]][usize::from(rotation)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bad_corner_is_named() {
        let error = Faces::new(&[[0, 1, 2], [3, 4, 5]], 4).unwrap_err();
        let expected = MeshError::IndexOutOfRange {
            face: 1,
            corner: 1,
            index: 4,
            vertex_count: 4,
        };
        assert_eq!(error, expected);
        let mut buffer = Vec::new();
        let short = Faces::widened(&[0, 1, 2, 3, 4, 5], 4, &mut buffer);
        assert_eq!(short.unwrap_err(), expected);
    }

    #[test]
    fn every_way_in_gives_the_same_faces() {
        let corners = [[0, 1, 2], [2, 1, 3]];
        let faces = Faces::new(&corners, 4).unwrap();
        let flat = [0, 1, 2, 2, 1, 3];
        let mut buffer = vec![[7; 3]; 9];
        assert_eq!(Faces::from_indices(&flat, 4), Ok(faces));
        let short = flat.map(|index| u16::try_from(index).unwrap());
        assert_eq!(Faces::widened(&short, 4, &mut buffer), Ok(faces));
        assert_eq!(Faces::from(&corners), faces);
        assert_eq!(Faces::from(&corners.to_vec()), faces);
        assert_eq!(Faces::from(&[[0_u32; 3]; 0]), Faces::default());
    }

    #[test]
    fn part_of_a_face_is_refused() {
        let error = Faces::from_indices(&[0, 1, 2, 0], 3).unwrap_err();
        assert_eq!(error, MeshError::PartialFace { len: 4 });
        assert_eq!(
            error.to_string(),
            "4 indices: not a multiple of three, the corners of a face"
        );
        let error = Faces::widened(&[0, 1], 3, &mut Vec::new()).unwrap_err();
        assert_eq!(error, MeshError::PartialFace { len: 2 });
    }

    #[test]
    fn turning_keeps_the_winding() {
        let turns = [0, 1, 2].map(|rotation| turned([7, 8, 9], rotation));
        assert_eq!(turns, [[7, 8, 9], [8, 9, 7], [9, 7, 8]]);
    }
}
