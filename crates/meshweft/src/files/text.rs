//! Bytes of text files: tokens, numbers, line numbers.
//!
//! Text formats are read as bytes: names and comments may be in any encoding, and nothing is
//! copied to look at it. A line ends with `\n`, `\r\n` or `\r`.

use std::io::Write;
use std::ops::Range;
use std::str::FromStr;

use super::decoded::note_floats;
use super::not_finite;

/// Whether `byte` separates tokens within a line.
#[inline]
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0b | 0x0c)
}

/// Whether `byte` ends a line.
#[inline]
pub(super) fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// The first line end at or after `at`, or the end of the text.
#[inline]
pub(super) fn line_end(text: &[u8], at: usize) -> usize {
    let rest = &text[at..];
    at + rest
        .iter()
        .position(|&byte| is_line_end(byte))
        .unwrap_or(rest.len())
}

/// The line, from 1, that the byte at `offset` stands on. O(offset): for errors and notes only.
pub(super) fn line_of(text: &[u8], offset: usize) -> usize {
    let before = &text[..offset.min(text.len())];
    let ends = before.iter().enumerate().filter(|&(at, &byte)| match byte {
        b'\n' => true,
        // The `\n` of a `\r\n` is the one that counts.
        b'\r' => text.get(at + 1) != Some(&b'\n'),
        _ => false,
    });
    1 + ends.count()
}

/// The span from `start` to the last byte before `end` that is neither blank nor a line end.
#[inline]
pub(super) fn trimmed(text: &[u8], start: usize, end: usize) -> Range<usize> {
    let solid = |&byte: &u8| !is_blank(byte) && !is_line_end(byte);
    let length = text[start..end].iter().rposition(solid);
    start..start + length.map_or(0, |last| last + 1)
}

/// Where a text ends: before the zero bytes that fill its last block, or the Ctrl-Z that ended it once.
pub(super) fn content_end(text: &[u8]) -> usize {
    let is_filling = |&byte: &u8| matches!(byte, 0 | 0x1a);
    let is_content = |byte: &u8| !is_filling(byte) && !is_blank(*byte) && !is_line_end(*byte);
    let from = text.iter().rposition(is_content).map_or(0, |last| last + 1);
    let filling = text[from..].iter().position(is_filling);
    filling.map_or(text.len(), |first| from + first)
}

/// The tokens of a stretch of text, as spans; line ends separate them as blanks do.
#[derive(Debug, Clone)]
pub(super) struct Tokens<'a> {
    text: &'a [u8],
    at: usize,
    /// Whether `#` ends the stretch, and `\` before a line end is a blank.
    marks: bool,
}

impl<'a> Tokens<'a> {
    /// The tokens of `text` from `at` on.
    #[inline]
    pub(super) fn plain(text: &'a [u8], at: usize) -> Self {
        let marks = false;
        Self { text, at, marks }
    }

    /// The tokens of one statement: it ends at a `#`, and goes on over lines that end in `\`.
    #[inline]
    pub(super) fn of_statement(text: &'a [u8], at: usize) -> Self {
        let marks = true;
        Self { text, at, marks }
    }

    /// Where the next look begins.
    #[inline]
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Whether the byte at `at` is a blank, a line end, or a continuation mark.
    #[inline]
    fn separates(&self, at: usize) -> bool {
        match self.text[at] {
            b'\\' => self.marks && self.text.get(at + 1).is_some_and(|&b| is_line_end(b)),
            byte => is_blank(byte) || is_line_end(byte),
        }
    }
}

impl Iterator for Tokens<'_> {
    type Item = Range<usize>;

    #[inline]
    fn next(&mut self) -> Option<Range<usize>> {
        let text = self.text;
        let mut at = self.at;
        while at < text.len() && self.separates(at) {
            at += 1;
        }
        let start = at;
        while at < text.len() && !self.separates(at) {
            if self.marks && text[at] == b'#' && begins_comment(text, start, at) {
                break;
            }
            at += 1;
        }
        self.at = at;
        (at > start).then_some(start..at)
    }
}

/// The whole number that `text` starts with, and how many bytes it takes.
///
/// `None` if there is no digit, or the number does not fit in 64 bits.
#[inline]
pub(super) fn leading_number(text: &[u8]) -> Option<(i64, usize)> {
    let sign_length = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let mut value = 0_i64;
    let mut length = sign_length;
    while let Some(digit) = text.get(length).map(|byte| byte.wrapping_sub(b'0')) {
        if digit > 9 {
            break;
        }
        value = value.checked_mul(10)?.checked_add(i64::from(digit))?;
        length += 1;
    }
    if length == sign_length {
        return None;
    }
    let signed = if text[0] == b'-' { -value } else { value };
    Some((signed, length))
}

/// The whole number that all of `token` is.
#[inline]
pub(super) fn whole_number(token: &[u8]) -> Option<i64> {
    let (value, length) = leading_number(token)?;
    (length == token.len()).then_some(value)
}

/// The coordinate that `token` is; `nan` and `inf` are coordinates too, in any spelling.
#[inline]
pub(super) fn coordinate(token: &[u8]) -> Option<f32> {
    float(token)
}

/// A [`coordinate`] of 32 or of 64 bits.
#[inline]
pub(super) fn float<T: FromStr + From<f32>>(token: &[u8]) -> Option<T> {
    note_floats(1);
    parsed(token)
}

#[inline]
fn parsed<T: FromStr + From<f32>>(token: &[u8]) -> Option<T> {
    let number = std::str::from_utf8(token).ok()?.parse().ok();
    number.or_else(|| not_finite::parse(token).map(T::from))
}

/// Whether `token` is a [`coordinate`]; the usual ones are told without working out the number.
#[inline]
pub(super) fn is_coordinate(token: &[u8]) -> bool {
    let digits = |from: usize| {
        let rest = token[from..].iter();
        rest.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let mut at = usize::from(matches!(token.first(), Some(b'-' | b'+')));
    let mut found = digits(at);
    at += found;
    if token.get(at) == Some(&b'.') {
        let after = digits(at + 1);
        at += 1 + after;
        found += after;
    }
    if found > 0 && matches!(token.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(token.get(at + 1), Some(b'-' | b'+')));
        let exponent = digits(at + 1 + sign);
        at += 1 + sign + exponent;
        found = exponent;
    }
    (found > 0 && at == token.len()) || parsed::<f32>(token).is_some()
}

/// Whether the `#` at `at`, in or after the token that starts at `start`, begins a comment.
#[inline]
pub(super) fn begins_comment(text: &[u8], start: usize, at: usize) -> bool {
    // As in 1.#IND; a word that starts otherwise is not looked at.
    let is_looked_at = matches!(text.get(start), Some(b'1' | b'-' | b'+'));
    !(is_looked_at && at > start && not_finite::has_mark(text, start, at))
}

/// Where the first comment of a line starts, whose text is `start..end`.
#[inline]
pub(super) fn comment_start(text: &[u8], start: usize, end: usize) -> Option<usize> {
    let line = &text[start..end];
    // Most have none.
    if !line.contains(&b'#') {
        return None;
    }
    let mut marks = line.iter().enumerate().filter(|&(_, &b)| b == b'#');
    let found = marks.find(|&(at, _)| {
        let blank = line[..at].iter().rposition(|&b| is_blank(b));
        begins_comment(&text[..end], start + blank.map_or(0, |b| b + 1), start + at)
    });
    found.map(|(at, _)| start + at)
}

/// Appends `number` in decimal digits.
#[inline]
pub(super) fn push_number(out: &mut Vec<u8>, mut number: u64) {
    let mut digits = [0_u8; 20];
    let mut first = digits.len();
    loop {
        first -= 1;
        // A digit fits in a byte.
        digits[first] = b'0' + u8::try_from(number % 10).unwrap_or(0);
        number /= 10;
        if number == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[first..]);
}

/// Appends digits that read back as this number, which is finite: no more than that takes, and an exponent
/// where many zeros would stand.
pub(super) fn push_float(out: &mut Vec<u8>, number: f32) {
    let is_short = number == 0.0 || (1e-5..1e16).contains(&number.abs());
    let written = match is_short {
        true => write!(out, "{number}"),
        false => write!(out, "{number:e}"),
    };
    written.expect("memory takes all bytes");
}

/// A token as an error message shows it: quoted, and cut if it is long.
pub(super) fn shown(token: &[u8]) -> String {
    const LONGEST: usize = 24;
    let cut = &token[..token.len().min(LONGEST)];
    let dots = if token.len() > LONGEST { "…" } else { "" };
    format!("{:?}{dots}", String::from_utf8_lossy(cut))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_line_end_counts_once() {
        let text = b"a\nb\r\nc\rd";
        let lines: Vec<usize> = [0, 2, 5, 7].map(|at| line_of(text, at)).to_vec();
        assert_eq!(lines, [1, 2, 3, 4]);
    }

    #[test]
    fn a_statement_ends_at_its_comment_and_crosses_a_continuation() {
        let text = b"f 1\\\r\n 2 3# 4";
        let tokens: Vec<&[u8]> = Tokens::of_statement(text, 0).map(|t| &text[t]).collect();
        assert_eq!(tokens, [b"f" as &[u8], b"1", b"2", b"3"]);
        // A # within a number does not end it.
        let text = b"v -1.#IND 1.#INF00#c 1.#IND";
        let tokens: Vec<&[u8]> = Tokens::of_statement(text, 0).map(|t| &text[t]).collect();
        assert_eq!(tokens, [b"v" as &[u8], b"-1.#IND", b"1.#INF00"]);
    }

    #[test]
    fn what_fills_the_last_block_is_no_text() {
        for (text, end) in [
            (&b"a\0b \r\n\0\0\n\0"[..], 6),
            (b"a\n\x1a", 2),
            (b"a \n", 3),
            (b"\0", 0),
            (b"", 0),
        ] {
            assert_eq!(content_end(text), end);
        }
    }

    #[test]
    fn a_comment_starts_outside_numbers() {
        for (text, expected) in [
            ("1.#IND 0 # c", Some(9)),
            ("0 -1.#INF#c", Some(9)),
            ("1.#IND", None),
            ("#1", Some(0)),
            ("1.#x", Some(2)),
        ] {
            assert_eq!(comment_start(text.as_bytes(), 0, text.len()), expected);
        }
    }

    #[test]
    fn numbers_are_whole_and_fit() {
        assert_eq!(leading_number(b"-12/7"), Some((-12, 3)));
        assert_eq!(whole_number(b"+3"), Some(3));
        for bad in [b"" as &[u8], b"-", b"1X", b"1.0", b"9223372036854775808"] {
            assert_eq!(whole_number(bad), None);
        }
    }

    #[test]
    fn what_is_a_coordinate_is_what_parses() {
        let alphabet = b"+-.0e7Enaif ";
        let mut tokens = vec![Vec::new()];
        for from in 0.. {
            let Some(token) = tokens.get(from).cloned() else {
                break;
            };
            let parses = coordinate(&token).is_some();
            assert_eq!(is_coordinate(&token), parses, "{:?}", token.escape_ascii());
            if token.len() < 5 {
                let longer = |&byte: &u8| [token.as_slice(), &[byte]].concat();
                tokens.extend(alphabet.iter().map(longer));
            }
        }
        for token in [
            "infinity",
            "-Infinity",
            "1e9999",
            "0.00000000000000000001e-50",
            "1e+-3",
            "1f",
            "-nan(ind)",
            "1.#QNAN",
            "-1.#INF00",
            "1.#X",
        ] {
            let token = token.as_bytes();
            assert_eq!(is_coordinate(token), coordinate(token).is_some());
        }
    }

    #[test]
    fn numbers_are_written_as_they_are_read() {
        for number in [0, 9, 10, 4_294_967_295, u64::MAX] {
            let mut out = Vec::new();
            push_number(&mut out, number);
            assert_eq!(String::from_utf8(out).unwrap(), number.to_string());
        }
    }

    #[test]
    fn floats_are_written_with_the_digits_they_need() {
        for (number, expected) in [
            (0.0_f32, "0"),
            (-0.0, "-0"),
            (0.1, "0.1"),
            (-16_777_216.0, "-16777216"),
            (1.0 / 3.0, "0.33333334"),
            (1e-5, "0.00001"),
            (9.99e-6, "9.99e-6"),
            (-1e16, "-1e16"),
            (f32::MAX, "3.4028235e38"),
            (f32::MIN_POSITIVE, "1.1754944e-38"),
            (f32::from_bits(1), "1e-45"),
        ] {
            let mut out = Vec::new();
            push_float(&mut out, number);
            assert_eq!(str::from_utf8(&out).unwrap(), expected);
            let read = coordinate(&out).map(f32::to_bits);
            assert_eq!(read, Some(number.to_bits()), "{expected}");
        }
    }
}
