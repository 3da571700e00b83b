//! PGM images of the Netpbm family: `P5` with bytes, `P2` as text.
//!
//! Samples above 255 take two bytes, the high one first. Nothing in the file says how large a sample is, how
//! far samples are apart, or which value is void: the caller does.

use std::ops::Range;

use super::super::error::{FileErrorKind, Place, Problem};
use super::super::note::Note;
use super::super::text::{line_end, line_of, shown, whole_number};
use super::options::HeightMapOptions;
use super::placement::MapPlacement;
use super::sampled::{HeightRule, ReadHeights, checked_size, ends_in_row};

pub(super) fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<ReadHeights, Problem> {
    let is_text = bytes[1] == b'2';
    let mut words = PgmWords { bytes, at: 2 };
    let columns = words.number("the number of columns")?;
    let rows = words.number("the number of rows")?;
    let size = checked_size([columns, rows], bytes.len(), options);
    let size = size.map_err(|kind| kind.at(Place::File))?;
    let maximum = words.number("the largest value")?;
    if !(1..=65_535).contains(&maximum) {
        let text = format!("a largest value of {maximum}: it is 1 to 65535");
        return Err(words.problem(words.at, FileErrorKind::malformed(text)));
    }

    let mut rule = HeightRule::new(options, 1.0, &[]);
    let (heights, end) = match is_text {
        true => plain_samples(&mut words, size, maximum, &mut rule)?,
        // One blank ends the header.
        false => packed_samples(bytes, words.at + 1, size, maximum, &mut rule)?,
    };

    let mut notes = rule.notes();
    let rest = &bytes[end..];
    if rest.iter().any(|byte| !byte.is_ascii_whitespace()) {
        let text = format!("the {} bytes after the image are not read", rest.len());
        notes.push(Note::new(Place::Byte(end), text));
    }
    Ok(ReadHeights {
        size,
        heights,
        placement: MapPlacement::Unknown,
        notes,
    })
}

/// The samples of a `P5` from a byte on, and where they end.
fn packed_samples(
    bytes: &[u8],
    start: usize,
    [columns, rows]: [u32; 2],
    maximum: u64,
    rule: &mut HeightRule,
) -> Result<(Vec<f32>, usize), Problem> {
    let width = if maximum > 255 { 2 } else { 1 };
    let row_bytes = columns as usize * width;
    let data = bytes.get(start..).unwrap_or(&[]);
    if data.len() / row_bytes < rows as usize {
        let row = crate::index::index32(data.len() / row_bytes);
        return Err(ends_in_row(row, rows, bytes.len()));
    }

    let data = &data[..row_bytes * rows as usize];
    let mut heights = Vec::with_capacity(data.len() / width);
    for (number, sample) in data.chunks_exact(width).enumerate() {
        let value = sample
            .iter()
            .fold(0, |value, &byte| value << 8 | u64::from(byte));
        if value > maximum {
            return Err(above(value, maximum).at(Place::Byte(start + number * width)));
        }
        heights.push(rule.height(value as f64));
    }
    Ok((heights, start + data.len()))
}

/// The samples of a `P2`, and where they end.
fn plain_samples(
    words: &mut PgmWords<'_>,
    [columns, rows]: [u32; 2],
    maximum: u64,
    rule: &mut HeightRule,
) -> Result<(Vec<f32>, usize), Problem> {
    let mut heights = Vec::new();
    for row in 0..rows {
        for _ in 0..columns {
            let at = words.at;
            let value = words.number_or(|| format!("row {row} of {rows}"))?;
            if value > maximum {
                return Err(words.problem(at, above(value, maximum)));
            }
            heights.push(rule.height(value as f64));
        }
    }
    Ok((heights, words.at))
}

fn above(value: u64, maximum: u64) -> FileErrorKind {
    FileErrorKind::malformed(format!(
        "a sample of {value}, above the largest value {maximum} that the header says"
    ))
}

/// The words of a PGM; a comment runs from `#` to the end of the line, wherever it stands.
struct PgmWords<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl PgmWords<'_> {
    fn next(&mut self) -> Range<usize> {
        let bytes = self.bytes;
        let is_end = |byte: u8| byte.is_ascii_whitespace() || byte == b'\x0b' || byte == b'#';
        while let Some(&byte) = bytes.get(self.at).filter(|byte| is_end(**byte)) {
            self.at = match byte {
                b'#' => line_end(bytes, self.at),
                _ => self.at + 1,
            };
        }
        let start = self.at;
        let length = bytes[start..].iter().position(|&byte| is_end(byte));
        self.at = length.map_or(bytes.len(), |length| start + length);
        start..self.at
    }

    fn number(&mut self, what: &str) -> Result<u64, Problem> {
        self.number_or(|| what.to_owned())
    }

    fn number_or(&mut self, what: impl Fn() -> String) -> Result<u64, Problem> {
        let word = self.next();
        let text = &self.bytes[word.clone()];
        if text.is_empty() {
            let kind = FileErrorKind::truncated(what());
            return Err(self.problem(word.start, kind));
        }
        let number = whole_number(text).and_then(|number| u64::try_from(number).ok());
        number.ok_or_else(|| {
            let text = format!("{} where a number was expected: {}", shown(text), what());
            self.problem(word.start, FileErrorKind::malformed(text))
        })
    }

    fn problem(&self, at: usize, kind: FileErrorKind) -> Problem {
        kind.at(Place::Line(line_of(self.bytes, at)))
    }
}
