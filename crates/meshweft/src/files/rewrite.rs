//! What a record format has to say of its notation: how to write a face record with its corners
//! turned and its vertices renumbered, and how to read values from records.

use std::ops::Range;
use std::path::PathBuf;

use super::definitions::Definitions;
use super::entry::MeshEntry;
use super::error::{Problem, no_attribute};
use super::orders::{RecordOrders, record_in};
use super::slots::Spans;
use super::text::{leading_number, push_number};
use super::unlisted::FoundKinds;
use crate::attribute::{Attribute, AttributeInfo};

/// What happens to the corners of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change<'a> {
    /// As [`FaceOrder::rotation`](crate::FaceOrder::rotation).
    pub(super) rotation: usize,
    /// The new number of each vertex; empty if they keep theirs.
    pub(super) old_to_new: &'a [u32],
}

impl Change<'_> {
    pub(super) fn is_nothing(&self) -> bool {
        self.rotation == 0 && self.old_to_new.is_empty()
    }

    /// The old position of the corner that goes to position `corner` of `count`.
    #[inline]
    pub(super) fn turned(&self, corner: usize, count: usize) -> usize {
        let turned = corner + self.rotation;
        // Most corners take no division.
        if turned < count {
            turned
        } else {
            turned % count
        }
    }
}

/// One record on its way to the output, with its corners changed.
pub(super) struct Rewrite<'a> {
    pub(super) change: Change<'a>,
    /// Where the corners stand in the record, for formats that have to look for them. Its memory is
    /// used again for each record; what it holds at first means nothing.
    pub(super) corners: &'a mut Vec<Range<usize>>,
    /// The record is appended to this.
    pub(super) out: &'a mut Vec<u8>,
}

impl Rewrite<'_> {
    /// Appends `record` with its `corners` turned and their vertices renumbered; all else is copied.
    ///
    /// `vertex_of` gives the vertex that a corner names (`None` for none), and how many bytes its
    /// number takes at the start of the corner. `first` is what the file calls vertex 0.
    #[inline]
    pub(super) fn write_corners(
        self,
        record: &[u8],
        first: u64,
        vertex_of: impl Fn(&[u8]) -> Option<(usize, usize)>,
    ) {
        let Self {
            change,
            corners,
            out,
        } = self;
        let mut copied = 0;
        for (position, slot) in corners.iter().enumerate() {
            debug_assert!(copied <= slot.start, "corners overlap");
            out.extend_from_slice(&record[copied..slot.start]);
            copied = slot.end;

            let turned = change.turned(position, corners.len());
            let corner = &record[corners[turned].clone()];

            // A corner whose vertex keeps its number is copied as it is spelled.
            let renumbered = vertex_of(corner).and_then(|(old, length)| {
                let new = *change.old_to_new.get(old)?;
                (new as usize != old).then_some((u64::from(new), length))
            });

            match renumbered {
                Some((new, length)) => {
                    push_number(out, new + first);
                    out.extend_from_slice(&corner[length..]);
                }
                None => out.extend_from_slice(corner),
            }
        }
        out.extend_from_slice(&record[copied..]);
    }
}

/// The vertex of a corner that starts with its number, counted from 0; for
/// [`Rewrite::write_corners`].
#[inline]
pub(super) fn vertex_from_zero(corner: &[u8]) -> Option<(usize, usize)> {
    let (number, length) = leading_number(corner)?;
    Some((usize::try_from(number).ok()?, length))
}

/// The records of a mesh as the file has them, and the orders that were applied since.
pub(super) struct StoredMesh<'a> {
    pub(super) source: &'a [u8],
    pub(super) vertices: &'a Spans,
    pub(super) faces: &'a Spans,
    pub(super) entry: &'a MeshEntry,
    pub(super) orders: &'a RecordOrders,
}

/// A face record of the file, as the orders leave it.
pub(super) struct PlacedFace {
    /// Its number in the file.
    pub(super) record: usize,
    /// Where it stands in the file.
    pub(super) span: Range<usize>,
    /// How far its corners are turned.
    pub(super) rotation: usize,
    /// How many faces of the mesh it is cut into.
    pub(super) face_count: usize,
}

impl StoredMesh<'_> {
    /// The vertices in their new order: the number of each in the file, and where it stands there.
    pub(super) fn vertices(&self) -> impl Iterator<Item = (usize, Range<usize>)> {
        (0..self.vertices.len()).map(|vertex| {
            let record = record_in(&self.orders.vertices, vertex);
            (record, self.vertices.span(record))
        })
    }

    /// The face records in their new order.
    pub(super) fn faces(&self) -> impl Iterator<Item = PlacedFace> {
        (0..self.faces.len()).map(|slot| {
            let record = record_in(&self.orders.records, slot);
            PlacedFace {
                record,
                span: self.faces.span(record),
                rotation: self.orders.rotation(slot),
                face_count: match &self.entry.polygons {
                    Some(starts) => (starts[slot + 1] - starts[slot]) as usize,
                    None => 1,
                },
            }
        })
    }
}

/// The corners of the faces that a record with `count` corners is cut into, three a face, each as its
/// position in the file's record.
pub(super) fn fan(count: usize, rotation: usize) -> impl Iterator<Item = usize> {
    let change = Change {
        rotation,
        old_to_new: &[],
    };
    let corners = (2..count).flat_map(|last| [0, last - 1, last]);
    corners.map(move |corner| change.turned(corner, count))
}

/// How a format writes the corners of a face record, and reads the values stored in records.
pub(super) trait Notation: Send + Sync {
    /// Appends a face record with its corners changed.
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>);

    /// What hangs on the vertices one by one, in a file whose vertices move, and goes where they go.
    fn vertex_rows(&self) -> Option<&Spans> {
        None
    }

    /// The lines between the faces of a run that faces name.
    fn definitions(&self) -> Option<&Definitions> {
        None
    }

    /// Appends a face record with numbers that name the same wherever it stands; `above` it are so many
    /// definitions of each kind.
    fn write_settled(&self, record: &[u8], _above: [usize; 3], out: &mut Vec<u8>) {
        out.extend_from_slice(record);
    }

    /// Appends a line that names vertices and stays where it is.
    fn write_line(&self, line: &[u8], rewrite: Rewrite<'_>) {
        rewrite.out.extend_from_slice(line);
    }

    /// See [`Content::companions`](super::content::Content::companions).
    fn companions(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    /// See [`Content::attributes`](super::content::Content::attributes).
    fn attributes(&self) -> Vec<AttributeInfo> {
        Vec::new()
    }

    /// See [`Content::attribute`](super::content::Content::attribute).
    fn attribute(
        &self,
        _stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        Err(no_attribute(info))
    }

    /// See [`Content::unlisted`](super::content::Content::unlisted).
    fn unlisted(&self, stored: &StoredMesh<'_>) -> FoundKinds;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_of_a_fan_are_turned_as_those_of_a_triangle() {
        assert_eq!(fan(3, 2).collect::<Vec<_>>(), [2, 0, 1]);
        assert_eq!(fan(5, 0).collect::<Vec<_>>(), [0, 1, 2, 0, 2, 3, 0, 3, 4]);
        assert_eq!(fan(2, 0).chain(fan(0, 0)).count(), 0);
    }
}
