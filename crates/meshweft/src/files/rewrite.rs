//! Face records on their way to the output: corners turned, vertices renumbered, all else copied.

use std::ops::Range;

use super::text::{leading_number, push_number};

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

    /// Which of the `count` old corners the new corner `corner` is.
    #[inline]
    pub(super) fn turned(&self, corner: usize, count: usize) -> usize {
        let turned = corner + self.rotation;
        // Without a division for most corners.
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
    /// Where the corners stand in the record, for formats that have to look for them. There to be
    /// reused: what it holds at first means nothing.
    pub(super) corners: &'a mut Vec<Range<usize>>,
    /// The record is appended to this.
    pub(super) out: &'a mut Vec<u8>,
}

impl Rewrite<'_> {
    /// Appends `record` with its `corners` turned and their vertices renumbered; all else is copied.
    ///
    /// `vertex_of` gives the vertex that a corner names, and how many bytes its number takes at the
    /// start of the corner. `first` is the number that the file has for vertex 0.
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
            out.extend_from_slice(&record[copied..slot.start]);
            copied = slot.end;

            let turned = change.turned(position, corners.len());
            let corner = &record[corners[turned].clone()];
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

/// How a format writes the corners of a face record.
pub(super) trait Notation: Send + Sync {
    /// Appends a face record with its corners changed.
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>);

    /// Appends a line that names vertices and stays where it is.
    fn write_line(&self, line: &[u8], rewrite: Rewrite<'_>) {
        rewrite.out.extend_from_slice(line);
    }
}
