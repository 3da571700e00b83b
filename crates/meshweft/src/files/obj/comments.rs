//! Comments with data: ZBrush writes the color of each vertex so, other programs other things.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::files::error::FileErrorKind;
use crate::files::options::ReadOptions;
use crate::files::slots::Spans;
use crate::files::text::{Tokens, is_coordinate};

/// What ZBrush's lines of colors begin with.
const MRGB: &[u8] = b"#MRGB";

/// Digits of a color: mask, red, green, blue.
const DIGITS: usize = 8;

/// How many kinds of comments are told apart.
const MOST_KINDS: usize = 64;

/// The comments of a file, as far as they hold data.
pub(super) struct Comments<'a> {
    source: &'a [u8],
    /// The colors of `#MRGB` lines.
    pub(super) colors: Spans,
    /// Where the first `#MRGB` line stands.
    first_colors: Option<usize>,
    /// Where one stands that holds something else than colors.
    bad_colors: Option<usize>,
    /// The other comments that are a word and numbers, by the word.
    kinds: BTreeMap<&'a [u8], Kind>,
}

/// The comments that begin with one word.
struct Kind {
    first: usize,
    lines: usize,
    numbers: usize,
    /// Digits of numbers that are colors in base 16.
    digits: usize,
}

impl Kind {
    /// Whether there may be one for each of `count` records: a line, a number, or a few numbers.
    fn may_go_with(&self, count: usize) -> bool {
        let Self {
            lines,
            numbers,
            digits,
            ..
        } = *self;
        let of_each = |per: usize, total| count.checked_mul(per) == Some(total);
        of_each(1, lines)
            || [1, 2, 3, 4].into_iter().any(|per| of_each(per, numbers))
            || [6, 8].into_iter().any(|per| of_each(per, digits))
    }
}

impl<'a> Comments<'a> {
    pub(super) fn new(source: &'a [u8]) -> Self {
        Self {
            source,
            colors: Spans::new(),
            first_colors: None,
            bad_colors: None,
            kinds: BTreeMap::new(),
        }
    }

    /// Takes a comment, from its `#` on.
    ///
    /// # Errors
    /// Those of [`Spans::push`].
    pub(super) fn comment(&mut self, span: Range<usize>) -> Result<(), FileErrorKind> {
        let text = &self.source[..span.end];
        let mut tokens = Tokens::plain(text, span.start);
        let mut word = tokens.next().unwrap_or(span.start..span.start);
        if &text[word.clone()] == MRGB {
            return self.color_line(span.start, tokens);
        }

        // The word may stand apart from its `#`, and be missing.
        word.start += 1;
        if word.is_empty() {
            let mut ahead = tokens.clone();
            match ahead.next() {
                Some(next) if !is_number(&text[next.clone()]) => (word, tokens) = (next, ahead),
                Some(_) => {}
                None => return Ok(()),
            }
        }

        let (mut numbers, mut digits) = (0, 0);
        for token in tokens {
            let token = &text[token];
            if !is_number(token) {
                return Ok(());
            }
            numbers += 1;
            digits += if is_hexadecimal(token) {
                token.len()
            } else {
                0
            };
        }
        let is_full = self.kinds.len() == MOST_KINDS;
        let word = &self.source[word];
        if numbers > 0 && (!is_full || self.kinds.contains_key(word)) {
            let kind = self.kinds.entry(word).or_insert(Kind {
                first: span.start,
                lines: 0,
                numbers: 0,
                digits: 0,
            });
            kind.lines += 1;
            kind.numbers += numbers;
            kind.digits += digits;
        }
        Ok(())
    }

    fn color_line(&mut self, at: usize, tokens: Tokens<'_>) -> Result<(), FileErrorKind> {
        self.first_colors.get_or_insert(at);
        for token in tokens {
            let is_colors = is_hexadecimal(&self.source[token.clone()]);
            if !is_colors || !token.len().is_multiple_of(DIGITS) {
                self.bad_colors.get_or_insert(at);
                return Ok(());
            }
            self.colors
                .push_even(token.start, DIGITS, token.len() / DIGITS)?;
        }
        Ok(())
    }

    /// Why the vertices stay, if comments may go by their order and cannot go along; and where.
    pub(super) fn vertex_obstacle(&self, vertex_count: usize) -> Option<(usize, String)> {
        if let Some(at) = self.bad_colors {
            let why = "this #MRGB line holds something else than colors of 8 digits in base 16";
            return Some((at, why.to_owned()));
        }
        let found = self.colors.len();
        if let Some(at) = self.first_colors.filter(|_| found != vertex_count) {
            let why = format!(
                "the #MRGB lines hold {found} colors, and there are {vertex_count} vertices"
            );
            return Some((at, why));
        }
        None
    }

    /// The first kind of comments that may go by the order of as many records, and where it stands.
    pub(super) fn unknown(&self, count: usize, options: &ReadOptions) -> Option<(usize, String)> {
        let unknown = self.kinds.iter().filter(|(word, kind)| {
            let word = std::str::from_utf8(word);
            let is_safe = word.is_ok_and(|word| options.is_assumed_safe(word));
            kind.may_go_with(count) && !is_safe
        });
        let first = unknown.min_by_key(|(_, kind)| kind.first);
        first.map(|(word, kind)| (kind.first, String::from_utf8_lossy(word).into_owned()))
    }
}

/// Whether a token is a number, in base 10 or, with 6 digits or more, in base 16.
fn is_number(token: &[u8]) -> bool {
    is_coordinate(token) || is_hexadecimal(token)
}

fn is_hexadecimal(token: &[u8]) -> bool {
    token.len() >= 6 && token.iter().all(u8::is_ascii_hexdigit)
}
