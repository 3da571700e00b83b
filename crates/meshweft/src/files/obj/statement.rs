//! OBJ statements as text: where one ends, and how it names vertices.

use std::ops::Range;

use crate::files::text::{comment_start, is_blank, is_line_end, leading_number, line_end, trimmed};

/// Where each statement of a file stands.
pub(super) struct Statements<'a> {
    source: &'a [u8],
    at: usize,
}

impl<'a> Statements<'a> {
    pub(super) fn new(source: &'a [u8]) -> Self {
        // A byte order mark is not part of the first keyword.
        let has_mark = source.starts_with(b"\xef\xbb\xbf");
        let at = if has_mark { 3 } else { 0 };
        Self { source, at }
    }
}

/// A piece of a file.
pub(super) enum Piece {
    Statement(Range<usize>),
    /// A comment with a line of its own, from its `#` on.
    Comment(Range<usize>),
}

impl Statements<'_> {
    /// The next statement or comment.
    #[inline]
    pub(super) fn next_piece(&mut self) -> Option<Piece> {
        let source = self.source;
        while let Some(&byte) = source.get(self.at) {
            if is_blank(byte) || is_line_end(byte) {
                self.at += 1;
            } else if byte == b'#' {
                let start = self.at;
                self.at = line_end(source, start);
                return Some(Piece::Comment(start..self.at));
            } else {
                let (span, end) = statement_span(source, self.at);
                self.at = end;
                return Some(Piece::Statement(span));
            }
        }
        None
    }
}

impl Iterator for Statements<'_> {
    type Item = Range<usize>;

    #[inline]
    fn next(&mut self) -> Option<Range<usize>> {
        loop {
            if let Piece::Statement(span) = self.next_piece()? {
                return Some(span);
            }
        }
    }
}

/// The statement that starts at `start`, and where its last line ends: at a line end that no `\`
/// stands before.
///
/// A `\` at the end of a comment continues nothing. One that only blank lines follow is not part of
/// the statement: moved along, it would swallow the line after its new place.
fn statement_span(source: &[u8], start: usize) -> (Range<usize>, usize) {
    let mut from = start;
    loop {
        let end = line_end(source, from);
        let is_commented = comment_start(source, from, end).is_some();
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

/// The texture coordinate and the normal that `/2`, `//3`, `/2/3` names; `None` if it is something
/// else. Numbers may be missing, as some programs leave them.
pub(super) fn attribute_numbers(text: &[u8]) -> Option<[Option<i64>; 2]> {
    let mut numbers = [None; 2];
    let mut rest = text;
    for named in &mut numbers {
        let Some((b'/', after)) = rest.split_first() else {
            break;
        };
        rest = after;
        if let Some((number, length)) = leading_number(rest) {
            *named = Some(number);
            rest = &rest[length..];
        }
    }
    rest.is_empty().then_some(numbers)
}
