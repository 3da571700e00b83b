//! Files that are a sequence of records: copied byte by byte, records permuted among their places.
//!
//! A *slot* is where a record stands. Whatever is between the slots (line ends, comments, headers,
//! elements that are not understood) is copied; into each slot goes the record that the order puts
//! there. The source is never changed: orders add up, and the output is spliced when it is asked
//! for.

use std::ops::Range;
use std::path::Path;
use std::{fmt, io};

use super::content::{Content, OutputFile};
use super::entry::MeshEntry;
use super::error::Problem;
use super::slots::Spans;
use super::text::{leading_number, push_number};
use crate::limits::index32;
use crate::permutation::{FaceOrder, VertexOrder};

/// What happens to the corners of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change<'a> {
    /// As [`FaceOrder::rotation`].
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

/// A file of records, and the orders its records were put in.
pub(super) struct RecordFile<N> {
    pub(super) source: Vec<u8>,
    pub(super) vertices: Spans,
    pub(super) faces: Spans,
    /// Rows that hang on the faces one by one and go where they go.
    pub(super) companions: Vec<Spans>,
    /// Lines that name vertices and stay where they are.
    pub(super) lines: Spans,
    pub(super) notation: N,
    /// One mesh, or none if the file has no faces.
    pub(super) entries: Vec<MeshEntry>,
    pub(super) orders: Orders,
}

/// All orders that were applied, as one; empty where nothing was moved or turned.
#[derive(Debug, Default)]
pub(super) struct Orders {
    pub(super) records: Vec<u32>,
    pub(super) rotations: Vec<u8>,
    pub(super) vertices: Vec<u32>,
}

impl Orders {
    pub(super) fn add_faces(&mut self, order: &FaceOrder) {
        if order.is_identity() {
            return;
        }
        if !self.rotations.is_empty() || !order.rotations().is_empty() {
            let earlier = |old: u32| self.rotations.get(old as usize).copied().unwrap_or(0);
            let turned = |(new, &old)| (earlier(old) + order.rotation(new)) % 3;
            self.rotations = order.new_to_old().iter().enumerate().map(turned).collect();
        }
        self.records = composed(&self.records, order.new_to_old());
    }

    pub(super) fn add_vertices(&mut self, order: &VertexOrder) {
        if !order.is_identity() {
            self.vertices = composed(&self.vertices, order.new_to_old());
        }
    }

    /// The new number of each vertex; empty if they keep theirs.
    pub(super) fn old_to_new(&self) -> Vec<u32> {
        let mut old_to_new = vec![0; self.vertices.len()];
        for (new, &old) in self.vertices.iter().enumerate() {
            old_to_new[old as usize] = index32(new);
        }
        old_to_new
    }

    /// How far the corners of the record that goes to `slot` are turned.
    pub(super) fn rotation(&self, slot: usize) -> usize {
        usize::from(self.rotations.get(slot).copied().unwrap_or(0))
    }
}

/// `new_to_old` after `earlier`, which is empty if it changes nothing.
fn composed(earlier: &[u32], new_to_old: &[u32]) -> Vec<u32> {
    if earlier.is_empty() {
        return new_to_old.to_vec();
    }
    let through = new_to_old.iter().map(|&middle| earlier[middle as usize]);
    through.collect()
}

/// The entry of `order`, or `slot` itself where the order is empty.
pub(super) fn record_in(order: &[u32], slot: usize) -> usize {
    order.get(slot).map_or(slot, |&record| record as usize)
}

impl<N: Notation> RecordFile<N> {
    fn write(&self, sink: &mut dyn io::Write) -> io::Result<()> {
        let Orders {
            records, vertices, ..
        } = &self.orders;
        let source = self.source.as_slice();
        let old_to_new = self.orders.old_to_new();
        let old_to_new = old_to_new.as_slice();
        let mut layers = Vec::new();

        if !records.is_empty() || !vertices.is_empty() {
            let mut corners = Vec::new();
            layers.push(Layer::new(&self.faces, move |slots, out| {
                for slot in slots {
                    let change = Change {
                        rotation: self.orders.rotation(slot),
                        old_to_new,
                    };
                    let record = &source[self.faces.span(record_in(records, slot))];
                    if change.is_nothing() {
                        out.extend_from_slice(record);
                        continue;
                    }
                    let rewrite = Rewrite {
                        change,
                        corners: &mut corners,
                        out,
                    };
                    self.notation.write_face(record, rewrite);
                }
            }));
            let companions = self.companions.iter();
            layers.extend(companions.map(|spans| Layer::moved(spans, source, records)));
        }

        if !vertices.is_empty() {
            layers.push(Layer::moved(&self.vertices, source, vertices));
            let mut corners = Vec::new();
            layers.push(Layer::new(&self.lines, move |slots, out| {
                for slot in slots {
                    let change = Change {
                        rotation: 0,
                        old_to_new,
                    };
                    let rewrite = Rewrite {
                        change,
                        corners: &mut corners,
                        out,
                    };
                    self.notation
                        .write_line(&source[self.lines.span(slot)], rewrite);
                }
            }));
        }
        splice(source, 0..source.len(), layers, sink)
    }
}

impl<N> fmt::Debug for RecordFile<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RecordFile")
            .field("bytes", &self.source.len())
            .field("vertices", &self.vertices.len())
            .field("faces", &self.faces.len())
            .finish_non_exhaustive()
    }
}

impl<N: Notation> Content for RecordFile<N> {
    fn meshes(&self) -> &[MeshEntry] {
        &self.entries
    }

    fn apply(&mut self, mesh: usize, faces: &FaceOrder, vertices: Option<&VertexOrder>) {
        let entry = &mut self.entries[mesh];
        self.orders.add_faces(faces);
        entry.apply_faces(faces);
        if let Some(vertices) = vertices {
            self.orders.add_vertices(vertices);
            entry.apply_vertices(vertices);
        }
    }

    fn files(&self, path: &Path) -> Result<Vec<OutputFile<'_>>, Problem> {
        Ok(vec![OutputFile {
            path: path.to_owned(),
            write: Box::new(|sink| self.write(sink)),
        }])
    }
}

/// Appends what goes into slots that stand side by side, given by their numbers.
type WriteSlots<'a> = dyn FnMut(Range<usize>, &mut Vec<u8>) + 'a;

/// The slots of one kind of record, and what goes into each.
pub(super) struct Layer<'a> {
    slots: &'a Spans,
    next: usize,
    write: Box<WriteSlots<'a>>,
}

impl<'a> Layer<'a> {
    pub(super) fn new(
        slots: &'a Spans,
        write: impl FnMut(Range<usize>, &mut Vec<u8>) + 'a,
    ) -> Self {
        Self {
            slots,
            next: 0,
            write: Box::new(write),
        }
    }

    /// Each slot gets the record of `source` that `order` says.
    pub(super) fn moved(slots: &'a Spans, source: &'a [u8], order: &'a [u32]) -> Self {
        Self::new(slots, move |numbers, out| {
            for slot in numbers {
                out.extend_from_slice(&source[slots.span(record_in(order, slot))]);
            }
        })
    }

    /// How many slots from the next one on can be filled at once.
    fn batch(&self) -> usize {
        let left = self.slots.len() - self.next;
        match self.slots.even_length() {
            Some(length) => left.min(PIECE / length.max(1)).max(1),
            None => 1,
        }
    }

    fn next_start(&self) -> usize {
        self.slots.start(self.next)
    }
}

/// Bytes that are gathered before they are written.
const PIECE: usize = 1 << 18;

/// Writes the bytes `range` of the source, in which all slots are, with each slot filled again. Slots do
/// not overlap.
pub(super) fn splice(
    source: &[u8],
    range: Range<usize>,
    mut layers: Vec<Layer<'_>>,
    sink: &mut dyn io::Write,
) -> io::Result<()> {
    let mut out = Vec::with_capacity((PIECE + PIECE / 4).min(range.len() * 2));
    let mut copied = range.start;
    loop {
        // Slots come in long stretches of one kind: find the layer whose turn it is, and stay with
        // it until another one's next slot comes first.
        let starts = layers.iter().map(Layer::next_start).enumerate();
        let Some((turn, start)) = starts.min_by_key(|&(_, start)| start) else {
            break;
        };
        if start == usize::MAX {
            break;
        }
        let others = layers
            .iter()
            .enumerate()
            .filter(|&(other, _)| other != turn);
        let until = others.map(|(_, layer)| layer.next_start()).min();
        let until = until.unwrap_or(usize::MAX);
        let layer = &mut layers[turn];
        while layer.next < layer.slots.len() {
            let slot = layer.slots.span(layer.next);
            if slot.start > until {
                break;
            }
            if slot.start - copied > PIECE {
                sink.write_all(&out)?;
                out.clear();
                sink.write_all(&source[copied..slot.start])?;
            } else {
                out.extend_from_slice(&source[copied..slot.start]);
            }
            let batch = layer.next..layer.next + layer.batch();
            layer.next = batch.end;
            copied = layer.slots.span(batch.end - 1).end;
            (layer.write)(batch, &mut out);
            if out.len() >= PIECE {
                sink.write_all(&out)?;
                out.clear();
            }
        }
    }
    sink.write_all(&out)?;
    sink.write_all(&source[copied..range.end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_add_up() {
        use crate::Permutation;
        let order = |new_to_old, rotations| {
            FaceOrder::new(Permutation::new(new_to_old).unwrap(), rotations).unwrap()
        };
        let (first, second) = (
            order(vec![2, 0, 1], vec![1, 0, 2]),
            order(vec![1, 2, 0], vec![2, 1, 1]),
        );
        let mut orders = Orders::default();
        orders.add_faces(&first);
        orders.add_faces(&second);
        let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let both = order(orders.records, orders.rotations);
        assert_eq!(both.apply(&faces), second.apply(&first.apply(&faces)));
    }

    #[test]
    fn gaps_stay_between_layers() {
        let source = b"<aa|B|cc|D>";
        let (mut small, mut large) = (Spans::new(), Spans::new());
        small.push(1..3).unwrap();
        large.push(4..5).unwrap();
        small.push(6..8).unwrap();
        large.push(9..10).unwrap();
        let layers = vec![
            Layer::new(&small, |slots, out| out.extend_from_slice(&b"ca"[slots])),
            Layer::new(&large, |slots, out| {
                slots.for_each(|slot| out.extend_from_slice([b"DD", b"BB"][slot]))
            }),
        ];
        let mut out = Vec::new();
        splice(source, 0..source.len(), layers, &mut out).unwrap();
        assert_eq!(out, b"<c|DD|a|BB>");
    }
}
