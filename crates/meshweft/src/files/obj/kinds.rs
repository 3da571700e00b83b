//! Which corners of one vertex differ: in what they name beside it, or in what holds for their faces.

use std::collections::HashMap;
use std::ops::Range;

use super::corners::{corners, named};
use super::state::FaceState;
use super::statement::Statements;
use crate::files::options::ReadOptions;
use crate::files::selected::SelectSource;
use crate::files::text::Tokens;
use crate::index::index32;

/// A number for each corner of the faces, three a face: the same for the same texture coordinate, normal and
/// state of the face (group, material, smoothing). KindLines with the same text are the same.
///
/// Time O(bytes), space 12 bytes a line of values and 4 a corner.
pub(super) fn corner_kinds(source: &SelectSource<'_>, options: &ReadOptions) -> Vec<u32> {
    let text = source.stored.source;
    let lines = KindLines::new(text, options);
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    source.stored.entry.of_face_corners(|record| {
        let span = source.stored.faces.span(record);
        let [texture, normals] = &lines.values;
        // Which vertex it is does not count.
        let above = [0, texture.above(span.start), normals.above(span.start)];
        let state = lines.states.get(record).copied().unwrap_or(0);
        let number = |token: Range<usize>| {
            let [_, texture_line, normal_line] = named(&text[token], above);
            let key = [
                state,
                texture.number(texture_line),
                normals.number(normal_line),
            ];
            let next = index32(numbers.len());
            *numbers.entry(key).or_insert(next)
        };
        corners(text, &span).into_iter().map(number).collect()
    })
}

/// What stands above the faces.
struct KindLines<'a> {
    /// The `vt` and the `vn` lines.
    values: [ValueLines<'a>; 2],
    /// A number of the state of each face.
    states: Vec<u32>,
}

/// The lines of one kind.
#[derive(Default)]
struct ValueLines<'a> {
    starts: Vec<usize>,
    /// A number for each line, from 1: the same for the same text.
    numbers: Vec<u32>,
    number_of: HashMap<&'a [u8], u32>,
}

impl<'a> ValueLines<'a> {
    fn push(&mut self, start: usize, text: &'a [u8]) {
        let next = index32(self.number_of.len() + 1);
        self.starts.push(start);
        self.numbers
            .push(*self.number_of.entry(text).or_insert(next));
    }

    fn above(&self, at: usize) -> usize {
        self.starts.partition_point(|&start| start < at)
    }

    /// The number of a line that is named from 1; 0 if there is none.
    fn number(&self, line: u64) -> u32 {
        let line = usize::try_from(line)
            .ok()
            .and_then(|line| line.checked_sub(1));
        let number = line.and_then(|line| self.numbers.get(line));
        number.copied().unwrap_or(0)
    }
}

impl<'a> KindLines<'a> {
    fn new(source: &'a [u8], options: &ReadOptions) -> Self {
        let mut lines = Self {
            values: Default::default(),
            states: Vec::new(),
        };
        let mut state = FaceState::new(source);
        let mut numbers = HashMap::new();
        let mut last = None;
        for span in Statements::new(source) {
            let mut tokens = Tokens::of_statement(&source[..span.end], span.start);
            let Some(keyword) = tokens.next() else {
                continue;
            };
            let rest = tokens.next().map_or(span.end, |token| token.start);
            match &source[keyword] {
                b"vt" => lines.values[0].push(span.start, &source[rest..span.end]),
                b"vn" => lines.values[1].push(span.start, &source[rest..span.end]),
                b"f" => {
                    let number = last.filter(|_| state.continues()).unwrap_or_else(|| {
                        let next = index32(numbers.len());
                        *numbers.entry(state.value()).or_insert(next)
                    });
                    // The first face sets the state that later ones are compared with.
                    if last.is_none() {
                        state.continues();
                    }
                    last = Some(number);
                    lines.states.push(number);
                }
                b"g" | b"o" if options.across_groups => {}
                keyword => {
                    state.set(keyword, rest..span.end);
                }
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_text_and_state_have_the_same_number() {
        let text =
            b"vt 0 1\nvt  0 1 \nvt 1 1\nusemtl a\nf 1\nusemtl b\nf 1\nusemtl a\nf 1\ng x\nf 1\n";
        let lines = KindLines::new(text, &ReadOptions::default());
        assert_eq!(lines.values[0].numbers, [1, 1, 2]);
        assert_eq!(lines.values[0].number(3), 2);
        assert_eq!(lines.values[0].number(4), 0);
        assert_eq!(lines.states, [0, 1, 0, 2]);
        let options = ReadOptions {
            across_groups: true,
            ..ReadOptions::default()
        };
        assert_eq!(KindLines::new(text, &options).states, [0, 1, 0, 0]);
    }
}
