//! Copies a file with its records permuted among their places.
//!
//! A *slot* is where a record stands. Whatever is between the slots (line ends, comments, headers,
//! elements that are not understood) is copied; into each slot goes the record that the order puts
//! there.

use std::io;
use std::ops::Range;

use super::orders::record_in;
use super::slots::Spans;

/// Bytes to gather before they are written.
const PIECE: usize = 1 << 18;

/// Appends the new content of neighbouring slots, given by their numbers.
type WriteSlots<'a> = dyn FnMut(Range<usize>, &mut Vec<u8>) + 'a;

/// The slots of one kind of record, and what goes into each.
pub(super) struct Layer<'a> {
    slots: &'a Spans,
    /// The first slot that is not yet filled.
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

    /// A layer that fills slot `i` with record `order[i]` of `source`.
    pub(super) fn moved(slots: &'a Spans, source: &'a [u8], order: &'a [u32]) -> Self {
        Self::new(slots, move |numbers, out| {
            for slot in numbers {
                out.extend_from_slice(&source[slots.span(record_in(order, slot))]);
            }
        })
    }

    /// Where the next slot starts; `usize::MAX` after the last.
    fn next_start(&self) -> usize {
        self.slots.start(self.next)
    }

    /// The next slots that can be filled in one call: they touch, and are about a piece at most.
    fn next_batch(&self) -> Range<usize> {
        let left = self.slots.len() - self.next;
        let count = match self.slots.even_length() {
            Some(length) => left.min(PIECE / length.max(1)).max(1),
            None => 1,
        };
        self.next..self.next + count
    }
}

/// Writes the bytes `range` of `source`, with the slots of all layers filled again.
///
/// Slots lie within `range` and do not overlap, within a layer or between two.
pub(super) fn splice(
    source: &[u8],
    range: Range<usize>,
    mut layers: Vec<Layer<'_>>,
    sink: &mut dyn io::Write,
) -> io::Result<()> {
    // A first guess: a batch may overshoot the piece, and the numbers in a small file may get longer.
    let capacity = (PIECE + PIECE / 4).min(range.len() * 2);
    let mut out = Vec::with_capacity(capacity);
    let mut copied = range.start;

    // Slots come in long stretches of one kind: stay with a layer until another one's turn comes.
    while let Some((layer, until)) = next_turn(&mut layers) {
        while layer.next < layer.slots.len() {
            let start = layer.next_start();
            if start > until {
                break;
            }
            debug_assert!(copied <= start, "slots overlap");

            // Copy what stands before the slot; long gaps go straight to the sink.
            let gap = &source[copied..start];
            if gap.len() > PIECE {
                sink.write_all(&out)?;
                out.clear();
                sink.write_all(gap)?;
            } else {
                out.extend_from_slice(gap);
            }

            // Fill as many slots as touch.
            let batch = layer.next_batch();
            layer.next = batch.end;
            copied = layer.slots.span(batch.end - 1).end;
            (layer.write)(batch, &mut out);

            if out.len() >= PIECE {
                sink.write_all(&out)?;
                out.clear();
            }
        }
    }

    debug_assert!(copied <= range.end, "slots reach past the range");
    sink.write_all(&out)?;
    sink.write_all(&source[copied..range.end])
}

/// The layer whose next slot comes first, and where the next slot of any other starts; `None` once
/// all slots are filled.
fn next_turn<'l, 'a>(layers: &'l mut [Layer<'a>]) -> Option<(&'l mut Layer<'a>, usize)> {
    let starts = layers.iter().map(Layer::next_start).enumerate();
    let (turn, start) = starts.min_by_key(|&(_, start)| start)?;
    if start == usize::MAX {
        return None;
    }

    let others = layers.iter().enumerate();
    let others = others.filter(|&(other, _)| other != turn);
    let until = others.map(|(_, layer)| layer.next_start()).min();
    Some((&mut layers[turn], until.unwrap_or(usize::MAX)))
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
