//! Lists of numbers, cut into polygons, points, colors; and their values.

use std::ops::Range;

use super::lexer::{Lexer, index};
use super::scene::List;
use crate::files::error::Fault;
use crate::files::slots::Spans;
use crate::files::text::is_coordinate;
use crate::files::text::{coordinate, shown};

/// Where the points of a list stand, three numbers each, after looking whether they are coordinates.
pub(super) fn points(text: &[u8], list: &List) -> Result<Spans, Fault> {
    let mut spans = Spans::new();
    for span in Groups::new(text, list, 3) {
        let mut words = Lexer::new(&text[..span.end], span.start);
        for _ in 0..3 {
            let word = words.word().unwrap_or(span.end..span.end);
            if !is_coordinate(&text[word.clone()]) {
                let text = format!(
                    "{} is not a coordinate: write a number",
                    shown(&text[word.clone()])
                );
                return Err(Fault::malformed(word.start, text));
            }
        }
        let at = span.start;
        spans.push(span).map_err(|kind| Fault { at, kind })?;
    }
    Ok(spans)
}

/// Appends all numbers of a stretch of text.
pub(super) fn numbers(
    text: &[u8],
    span: Range<usize>,
    numbers: &mut Vec<f32>,
) -> Result<(), Fault> {
    let mut words = Lexer::new(&text[..span.end], span.start);
    while let Some(word) = words.word() {
        let number = &text[word.clone()];
        numbers.push(coordinate(number).ok_or_else(|| {
            let text = format!("{} is not a value: write a number", shown(number));
            Fault::malformed(word.start, text)
        })?);
    }
    Ok(())
}

/// A polygon with its -1.
pub(super) struct Polygon {
    pub(super) span: Range<usize>,
    /// There is no -1 after it: it is the last.
    pub(super) is_open: bool,
}

/// The polygons of a list of indices.
pub(super) struct Polygons<'a> {
    text: &'a [u8],
    words: Lexer<'a>,
    /// The indices of the polygon just read.
    pub(super) numbers: Vec<i64>,
}

impl<'a> Polygons<'a> {
    pub(super) fn new(text: &'a [u8], list: &List) -> Self {
        Self {
            text,
            words: Lexer::new(&text[..list.content.end], list.content.start),
            numbers: Vec::new(),
        }
    }

    /// The next polygon; its indices are in `numbers`.
    pub(super) fn next(&mut self) -> Result<Option<Polygon>, Fault> {
        self.numbers.clear();
        let mut span: Option<Range<usize>> = None;
        while let Some(word) = self.words.word() {
            let start = span.map_or(word.start, |span| span.start);
            span = Some(start..word.end);
            let token = &self.text[word.clone()];
            match index(token) {
                Some(-1) => {
                    let polygon = |span| Polygon {
                        span,
                        is_open: false,
                    };
                    return Ok(span.map(polygon));
                }
                Some(number) => self.numbers.push(number),
                None => {
                    let text = format!("{} is not a vertex number", shown(token));
                    return Err(Fault::malformed(word.start, text));
                }
            }
        }

        Ok(span.map(|span| Polygon {
            span,
            is_open: true,
        }))
    }
}

/// The numbers of a list, `size` at a time.
pub(super) struct Groups<'a> {
    words: Lexer<'a>,
    size: usize,
}

impl<'a> Groups<'a> {
    pub(super) fn new(text: &'a [u8], list: &List, size: usize) -> Self {
        let words = Lexer::new(&text[..list.content.end], list.content.start);
        Self { words, size }
    }
}

impl Iterator for Groups<'_> {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        let first = self.words.word()?;
        let mut end = first.end;
        for _ in 1..self.size {
            end = self.words.word()?.end;
        }
        Some(first.start..end)
    }
}
