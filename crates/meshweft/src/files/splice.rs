//! Bytes copied one for one, with records permuted among their places.
//!
//! A *slot* is where a record stands. Whatever is between the slots (line ends, comments, headers,
//! elements that are not understood) is copied; into each slot goes the record that the order puts
//! there.

use std::io;
use std::ops::Range;

use super::orders::record_in;
use super::slots::Spans;

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

            // As many slots as can be filled at once: they touch, so nothing else stands between.
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
