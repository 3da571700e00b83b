//! The lines of a file, and problems on them.

use std::ops::Range;

use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::text::{
    Tokens, begins_comment, comment_start, is_blank, is_line_end, line_end, line_of, trimmed,
};

/// The lines that hold something, without their comments.
#[derive(Clone)]
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

/// The tokens of a text, over its lines and past comments.
#[derive(Debug, Clone)]
pub(super) struct FreeTokens<'a> {
    text: &'a [u8],
    pub(super) at: usize,
}

impl<'a> FreeTokens<'a> {
    pub(super) fn new(text: &'a [u8], at: usize) -> Self {
        Self { text, at }
    }

    /// What is left of the line, without its comment and the blanks before that. The next token is on
    /// another line.
    #[inline]
    pub(super) fn rest_of_line(&mut self) -> Range<usize> {
        let end = line_end(self.text, self.at);
        let content = comment_start(self.text, self.at, end).unwrap_or(end);
        let rest = trimmed(self.text, self.at, content);
        self.at = end;
        rest
    }

    /// Whether no other token is on the line.
    pub(super) fn is_line_done(&self) -> bool {
        self.clone().rest_of_line().is_empty()
    }
}

impl Iterator for FreeTokens<'_> {
    type Item = Range<usize>;

    #[inline]
    fn next(&mut self) -> Option<Range<usize>> {
        let text = self.text;
        while let Some(&byte) = text.get(self.at) {
            if is_blank(byte) || is_line_end(byte) {
                self.at += 1;
            } else if byte == b'#' {
                self.at = line_end(text, self.at);
            } else {
                break;
            }
        }
        let start = self.at;
        while let Some(&byte) = text.get(self.at) {
            let ends = is_blank(byte)
                || is_line_end(byte)
                || byte == b'#' && begins_comment(text, start, self.at);
            if ends {
                break;
            }
            self.at += 1;
        }
        (self.at > start).then_some(start..self.at)
    }
}
