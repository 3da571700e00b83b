//! The faces of a file of records as triangles, and the checks of what they count and name.

use super::error::FileErrorKind;
use crate::index::{MAX_FACES, MAX_VERTICES, index32};
use crate::limits::Limits;

/// Collects the face records of a mesh as triangles.
#[derive(Debug, Default)]
pub(super) struct FaceRecords {
    pub(super) faces: Vec<[u32; 3]>,
    /// See [`MeshEntry::polygons`](super::MeshEntry::polygons); `None` as long as each record is one triangle.
    pub(super) polygons: Option<Vec<u32>>,
    count: usize,
    /// How many records are to come, as far as that is known.
    expected: usize,
}

impl FaceRecords {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Makes room for `count` records that take `bytes` bytes or fewer.
    pub(super) fn reserve(&mut self, count: usize, bytes: usize) {
        self.expected = count;
        // A face is its number of corners and the corners.
        self.faces.reserve(count.min(bytes / 4));
    }

    /// Counts triangles that were added to `faces` past it.
    ///
    /// # Errors
    /// As [`push`](Self::push).
    pub(super) fn count_triangles(&mut self, limits: &Limits) -> Result<(), FileErrorKind> {
        let limit = limits.faces.min(MAX_FACES);
        if self.faces.len() > limit {
            return Err(over_limit("faces", self.faces.len(), limit));
        }
        match &mut self.polygons {
            Some(starts) => {
                let counted = starts.last().copied().unwrap_or(0);
                starts.extend(counted + 1..=index32(self.faces.len()));
                self.count = starts.len() - 1;
            }
            None => self.count = self.faces.len(),
        }
        Ok(())
    }

    /// Adds a record, cut into the fan (0, i, i + 1).
    ///
    /// # Errors
    /// More faces, or more records, than the limit.
    #[inline]
    pub(super) fn push(&mut self, corners: &[u32], limits: &Limits) -> Result<(), FileErrorKind> {
        let limit = limits.faces.min(MAX_FACES);
        let added = corners.len().saturating_sub(2);
        if self.count >= limit || self.faces.len() + added > limit {
            return Err(over_limit("faces", self.faces.len() + added.max(1), limit));
        }

        // The usual record is a triangle.
        if let (&[a, b, c], None) = (corners, &self.polygons) {
            self.faces.push([a, b, c]);
            self.count += 1;
            return Ok(());
        }

        if added != 1 && self.polygons.is_none() {
            let mut starts = Vec::with_capacity(self.expected + 1);
            starts.extend(0..=index32(self.count));
            self.polygons = Some(starts);
        }
        if let [first, rest @ ..] = corners {
            let fan = rest.windows(2).map(|edge| [*first, edge[0], edge[1]]);
            self.faces.extend(fan);
        }
        if let Some(starts) = &mut self.polygons {
            starts.push(index32(self.faces.len()));
        }
        self.count += 1;
        Ok(())
    }
}

/// An error if `count` faces are more than the limit.
pub(super) fn check_face_count(count: usize, limits: &Limits) -> Result<(), FileErrorKind> {
    let limit = limits.faces.min(MAX_FACES);
    match count > limit {
        true => Err(over_limit("faces", count, limit)),
        false => Ok(()),
    }
}

/// An error if `count` vertices are more than the limit.
pub(super) fn check_vertex_count(count: usize, limits: &Limits) -> Result<(), FileErrorKind> {
    let limit = limits.vertices.min(MAX_VERTICES);
    match count > limit {
        true => Err(over_limit("vertices", count, limit)),
        false => Ok(()),
    }
}

fn over_limit(what: &'static str, found: usize, limit: usize) -> FileErrorKind {
    let (found, limit) = (found as u64, limit as u64);
    FileErrorKind::OverLimit { what, found, limit }
}

/// The vertex that a corner of a face names, where vertices are counted from 0.
///
/// # Errors
/// As [`past_the_last_vertex`] if there is no such vertex; `face` and `corner` say where.
#[inline]
pub(super) fn corner_vertex(
    index: i64,
    vertex_count: usize,
    face: usize,
    corner: usize,
) -> Result<u32, FileErrorKind> {
    let vertex = u32::try_from(index).ok();
    let vertex = vertex.filter(|&vertex| (vertex as usize) < vertex_count);
    vertex.ok_or_else(|| {
        let last = vertex_count.checked_sub(1);
        past_the_last_vertex("face", face, corner, index, last)
    })
}

/// A face (or what `what` says) names no vertex; `number` and `corner` from 0, `index` and `last`
/// as the file counts.
pub(super) fn past_the_last_vertex(
    what: &str,
    number: usize,
    corner: usize,
    index: i64,
    last: Option<usize>,
) -> FileErrorKind {
    let but = match last {
        Some(_) if index < 0 => " is below zero".to_owned(),
        Some(last) => format!(" is past the last vertex ({last})"),
        None => ", but the file has no vertices".to_owned(),
    };
    FileErrorKind::malformed(format!(
        "{what} {number}, corner {corner}: index {index}{but}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_are_fans_and_small_ones_have_no_faces() {
        let limits = Limits::default();
        let mut records = FaceRecords::default();
        for corners in [
            &[0_u32, 1, 2] as &[u32],
            &[3, 4, 5, 6],
            &[7, 8],
            &[],
            &[9, 8, 7],
        ] {
            records.push(corners, &limits).unwrap();
        }
        let fans = [[0, 1, 2], [3, 4, 5], [3, 5, 6], [9, 8, 7]];
        assert_eq!(records.faces, fans);
        assert_eq!(records.polygons, Some(vec![0, 1, 3, 3, 3, 4]));
    }
}
