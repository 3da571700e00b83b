//! The blocks that a DEM is made of.

use std::borrow::Cow;

use super::super::super::text::{is_line_end, line_end};

/// Characters of a block.
const BLOCK: usize = 1024;

/// The blocks of a file, filled up with blanks: 1,024 characters each, or a line each where there are lines.
pub(super) struct DemBlocks<'a> {
    pub(super) bytes: &'a [u8],
    at: usize,
    has_lines: bool,
}

impl<'a> DemBlocks<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        let start = &bytes[..bytes.len().min(BLOCK + 2)];
        Self {
            bytes,
            at: 0,
            has_lines: start.iter().any(|byte| is_line_end(*byte)),
        }
    }
}

impl<'a> Iterator for DemBlocks<'a> {
    type Item = (usize, Cow<'a, [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.at;
        if start >= self.bytes.len() {
            return None;
        }
        let end = match self.has_lines {
            true => line_end(self.bytes, start),
            false => (start + BLOCK).min(self.bytes.len()),
        };
        self.at = end;
        if self.has_lines {
            let rest = &self.bytes[end..];
            self.at += if rest.starts_with(b"\r\n") { 2 } else { 1 };
        }
        let block = &self.bytes[start..end];
        Some((
            start,
            match block.len() < BLOCK {
                true => {
                    let mut filled = block.to_vec();
                    filled.resize(BLOCK, b' ');
                    Cow::Owned(filled)
                }
                false => Cow::Borrowed(block),
            },
        ))
    }
}
