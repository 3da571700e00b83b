//! The pieces of a buffer that can change places, and the buffer with them in another order.

use std::collections::BTreeMap;
use std::ops::Range;

use super::accessors::{Accessors, COMPRESSED_VIEW};
use super::buffers::Buffers;
use super::json::Value;
use super::object::Object;
use super::stream_order::StreamClass;
use crate::files::error::Problem;

/// What the components of accessors are aligned to, but for 64-bit ones.
const ALIGNMENT: usize = 4;
/// What stands at a multiple of this may hold 64-bit components, and stands at one afterwards.
const WIDE_ALIGNMENT: usize = 8;

/// A buffer view, or what a compressed one is made from.
struct StandingView<'a> {
    bytes: Range<usize>,
    class: StreamClass,
    /// The number of the view, and the extension that names the bytes, if it is compressed.
    view: usize,
    source: Option<&'static str>,
    value: Value<'a>,
}

/// Bytes that move together: views that share some.
pub(super) struct MovingPiece<'a> {
    bytes: Range<usize>,
    /// When the first of its views is wanted.
    pub(super) class: StreamClass,
    /// By where they stand.
    views: Vec<StandingView<'a>>,
}

/// The pieces of each storage, as they stand. Views of buffers that have no bytes here are left out.
///
/// # Errors
/// A view is not within its buffer.
///
/// # Complexity
/// Time O(n log n) and space O(n) in the views.
pub(super) fn pieces<'a>(
    root: &Object<'a>,
    accessors: &Accessors<'a>,
    buffers: &Buffers,
    classes: &[StreamClass],
) -> Result<BTreeMap<usize, Vec<MovingPiece<'a>>>, Problem> {
    // Every view, and what it is compressed from.
    let mut standing: BTreeMap<usize, Vec<StandingView<'a>>> = BTreeMap::new();
    for (number, (view, &class)) in root.objects("bufferViews")?.zip(classes).enumerate() {
        let view = view?;
        let mut add = |object: &Object<'a>, source| {
            let has_bytes = object.number("buffer")?.and_then(|it| buffers.find(it));
            if has_bytes.is_some() {
                let (storage, start, length) = accessors.view_bytes(object)?;
                standing.entry(storage).or_default().push(StandingView {
                    bytes: start..start + length,
                    class,
                    view: number,
                    source,
                    value: object.as_value(),
                });
            }
            Ok(())
        };
        add(&view, None)?;
        if let Some(extensions) = view.object("extensions")? {
            for name in COMPRESSED_VIEW {
                if let Some(source) = extensions.object(name)? {
                    add(&source, Some(name))?;
                }
            }
        }
    }
    let pieces = standing.into_iter();
    Ok(pieces
        .map(|(storage, views)| (storage, joined(views)))
        .collect())
}

/// Views joined where they share bytes.
fn joined(mut views: Vec<StandingView<'_>>) -> Vec<MovingPiece<'_>> {
    views.sort_by_key(|view| (view.bytes.start, view.bytes.end));
    let mut pieces: Vec<MovingPiece<'_>> = Vec::new();
    for view in views {
        match pieces.last_mut() {
            Some(last) if view.bytes.start < last.bytes.end => {
                last.bytes.end = last.bytes.end.max(view.bytes.end);
                last.class = last.class.min(view.class);
                last.views.push(view);
            }
            _ => pieces.push(MovingPiece {
                bytes: view.bytes.clone(),
                class: view.class,
                views: vec![view],
            }),
        }
    }
    pieces
}

impl MovingPiece<'_> {
    fn alignment(&self) -> usize {
        let is_wide = |view: &StandingView<'_>| view.bytes.start.is_multiple_of(WIDE_ALIGNMENT);
        match self.views.iter().any(is_wide) {
            true => WIDE_ALIGNMENT,
            false => ALIGNMENT,
        }
    }
}

/// A buffer in another order.
pub(super) struct LaidOut<'a> {
    pub(super) bytes: Vec<u8>,
    /// How many of them the buffer has.
    pub(super) declared: usize,
    /// The views that stand elsewhere now.
    pub(super) moved: Vec<Moved<'a>>,
}

/// Where a view stands now.
pub(super) struct Moved<'a> {
    pub(super) start: usize,
    pub(super) view: usize,
    pub(super) source: Option<&'static str>,
    pub(super) value: Value<'a>,
}

impl<'a> LaidOut<'a> {
    /// The bytes of a buffer, the first `declared` of which it has, with all of its pieces in this order. Each keeps its
    /// place modulo its alignment. Behind them stand the bytes that are in no piece, but for those that fill up to a multiple
    /// of eight. The buffer gets longer only if it must.
    ///
    /// # Complexity
    /// Time and space O(bytes + n log n) in the pieces.
    pub(super) fn new(old: &[u8], declared: usize, pieces: &[MovingPiece<'a>]) -> Self {
        // The pieces.
        let (mut bytes, mut moved) = (Vec::with_capacity(old.len()), Vec::new());
        for piece in pieces {
            let (start, alignment) = (piece.bytes.start, piece.alignment());
            let skipped = (start % alignment + alignment - bytes.len() % alignment) % alignment;
            bytes.resize(bytes.len() + skipped, 0);
            let new_start = bytes.len();
            bytes.extend_from_slice(&old[piece.bytes.clone()]);
            for view in piece.views.iter().filter(|_| new_start != start) {
                moved.push(Moved {
                    start: view.bytes.start - start + new_start,
                    view: view.view,
                    source: view.source,
                    value: view.value,
                });
            }
        }

        // What is in none of them.
        let mut places: Vec<Range<usize>> = pieces.iter().map(|it| it.bytes.clone()).collect();
        places.sort_unstable_by_key(|place| (place.start, place.end));
        let ends = [0].into_iter().chain(places.iter().map(|place| place.end));
        let starts = places.iter().map(|place| place.start).chain([declared]);
        for (end, start) in ends.zip(starts) {
            let between = &old[end..start];
            let is_padding = between.len() < WIDE_ALIGNMENT && between.iter().all(|&b| b == 0);
            if !is_padding {
                bytes.extend_from_slice(between);
            }
        }

        // The length that it had, or a longer one; and what the file has beyond it.
        let beyond = &old[declared..];
        let is_longer = bytes.len() > declared;
        let length = match is_longer {
            true => bytes.len().next_multiple_of(ALIGNMENT),
            false => declared,
        };
        bytes.resize(length, 0);
        let is_padding = beyond.len() < ALIGNMENT && beyond.iter().all(|&byte| byte == 0);
        if !is_longer || !is_padding {
            bytes.extend_from_slice(beyond);
        }
        if is_longer {
            bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
        }
        Self {
            bytes,
            declared: length,
            moved,
        }
    }
}
