//! OBJ statements as text: where one ends, and how it names vertices.

use std::ops::Range;

use crate::files::rewrite::{Notation, Rewrite};
use crate::files::text::{Tokens, is_line_end, leading_number, line_end, trimmed};

/// The statement that starts at `start`, and where its last line ends: at a line end that no `\`
/// stands before.
///
/// A `\` at the end of a comment continues nothing. One that only blank lines follow is not part of
/// the statement: moved along, it would swallow the line after its new place.
pub(super) fn statement_span(source: &[u8], start: usize) -> (Range<usize>, usize) {
    let mut from = start;
    loop {
        let end = line_end(source, from);
        let is_commented = source[from..end].contains(&b'#');
        if end == source.len() || source[end - 1] != b'\\' || is_commented {
            let mut span = trimmed(source, start, end);
            let continues = |span: &Range<usize>| {
                source[span.clone()].ends_with(b"\\")
                    && span.end < end
                    && is_line_end(source[span.end])
            };
            while !is_commented && continues(&span) {
                span = trimmed(source, start, span.end - 1);
            }
            return (span, end);
        }
        let is_pair = source[end..].starts_with(b"\r\n");
        from = end + if is_pair { 2 } else { 1 };
    }
}

/// Whether `/2`, `//3`, `/2/3` names a texture coordinate, and a normal; `None` if it is something
/// else. Numbers may be missing, as some programs leave them.
pub(super) fn attributes_named(text: &[u8]) -> Option<[bool; 2]> {
    let mut named = [false; 2];
    let mut rest = text;
    for is_named in &mut named {
        let Some((b'/', after)) = rest.split_first() else {
            break;
        };
        rest = after;
        if let Some((_, length)) = leading_number(rest) {
            *is_named = true;
            rest = &rest[length..];
        }
    }
    rest.is_empty().then_some(named)
}

/// How corners stand in `f`, `l` and `p` lines.
pub(super) struct ObjNotation {
    /// How many vertices the file has.
    pub(super) vertex_count: usize,
}

impl Notation for ObjNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        rewrite.corners.clear();
        rewrite
            .corners
            .extend(Tokens::of_statement(record, 0).skip(1));
        // Vertices are only renumbered where all of them stand above the first face, so counting
        // back starts at the last one everywhere.
        let vertex_of = |corner: &[u8]| {
            let (number, length) = leading_number(corner)?;
            let number = isize::try_from(number).ok()?;
            let vertex = match number > 0 {
                true => usize::try_from(number - 1).ok()?,
                false => self.vertex_count.checked_add_signed(number)?,
            };
            Some((vertex, length))
        };
        rewrite.write_corners(record, 1, vertex_of);
    }

    fn write_line(&self, line: &[u8], rewrite: Rewrite<'_>) {
        self.write_face(line, rewrite);
    }
}
