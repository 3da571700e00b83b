//! The lines of a file, and problems on them.

use std::ops::Range;

use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::text::{
    Tokens, comment_start, is_blank, is_line_end, line_end, line_of, trimmed,
};

/// The lines that hold something, without their comments.
pub(super) struct Lines<'a> {
    pub(super) text: &'a [u8],
    pub(super) at: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn next(&mut self) -> Option<Range<usize>> {
        while self.at < self.text.len() {
            let byte = self.text[self.at];
            if is_blank(byte) || is_line_end(byte) {
                self.at += 1;
                continue;
            }
            let end = line_end(self.text, self.at);
            let content = comment_start(self.text, self.at, end).unwrap_or(end);
            let span = trimmed(self.text, self.at, content);
            self.at = end;
            if !span.is_empty() {
                return Some(span);
            }
        }
        None
    }

    pub(super) fn tokens(&self, line: &Range<usize>) -> Tokens<'a> {
        Tokens::plain(&self.text[..line.end], line.start)
    }

    /// An upper bound of the records that can still come, each of `bytes` bytes or more.
    pub(super) fn at_most(&self, count: usize, bytes: usize) -> usize {
        count.min((self.text.len() - self.at) / bytes + 1)
    }

    pub(super) fn problem(&self, at: usize, kind: FileErrorKind) -> Problem {
        kind.at(Place::Line(line_of(self.text, at)))
    }

    pub(super) fn malformed(&self, at: usize, text: impl Into<String>) -> Problem {
        self.problem(at, FileErrorKind::malformed(text))
    }

    pub(super) fn truncated(&self, what: impl Into<String>) -> Problem {
        self.problem(self.text.len(), FileErrorKind::truncated(what))
    }
}
