//! The tokens of VRML97: words, strings, brackets.
//!
//! Commas are white space, and `#` begins a comment outside strings (and numbers such as `1.#INF`).

use std::ops::Range;

use crate::files::error::{Fault, FileErrorKind};
use crate::files::text::{begins_comment, is_line_end, line_end, whole_number};

/// A token and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    /// A number, a name, a keyword.
    Word(Range<usize>),
    /// A string with its quotes.
    Text(Range<usize>),
    /// One of `{}[]`.
    Mark(u8, usize),
}

impl Token {
    pub(super) fn span(&self) -> Range<usize> {
        match self {
            Self::Word(span) | Self::Text(span) => span.clone(),
            Self::Mark(_, at) => *at..at + 1,
        }
    }
}

/// Cuts a text into tokens.
#[derive(Debug, Clone)]
pub(super) struct Lexer<'a> {
    text: &'a [u8],
    at: usize,
}

fn separates(byte: u8) -> bool {
    matches!(byte, b' ' | b',' | b'\t') || is_line_end(byte)
}

fn ends_word(byte: u8) -> bool {
    separates(byte) || matches!(byte, b'#' | b'"' | b'{' | b'}' | b'[' | b']')
}

impl<'a> Lexer<'a> {
    /// The tokens of `text` from `at` on.
    pub(super) fn new(text: &'a [u8], at: usize) -> Self {
        Self { text, at }
    }

    /// Where the next look begins.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Goes to the next byte that is neither white space nor in a comment.
    pub(super) fn skip(&mut self) -> Option<u8> {
        while let Some(&byte) = self.text.get(self.at) {
            if byte == b'#' {
                self.at = line_end(self.text, self.at);
            } else if separates(byte) {
                self.at += 1;
            } else {
                return Some(byte);
            }
        }
        None
    }

    /// The next word, if a word comes next.
    pub(super) fn word(&mut self) -> Option<Range<usize>> {
        self.skip()?;
        let rest = &self.text[self.at..];
        // A # may be part of a number.
        let ends = |&(at, &byte): &(usize, &u8)| {
            ends_word(byte) && (byte != b'#' || begins_comment(rest, 0, at))
        };
        let length = rest.iter().enumerate().find(ends);
        let length = length.map_or(rest.len(), |(at, _)| at);
        let span = self.at..self.at + length;
        self.at = span.end;
        (length > 0).then_some(span)
    }

    /// The next token.
    ///
    /// # Errors
    /// A string without an end.
    pub(super) fn token(&mut self) -> Result<Option<Token>, Fault> {
        let Some(byte) = self.skip() else {
            return Ok(None);
        };
        let start = self.at;
        Ok(match byte {
            b'"' => {
                self.string()?;
                Some(Token::Text(start..self.at))
            }
            b'{' | b'}' | b'[' | b']' => {
                self.at += 1;
                Some(Token::Mark(byte, start))
            }
            _ => self.word().map(Token::Word),
        })
    }

    fn string(&mut self) -> Result<(), Fault> {
        let start = self.at;
        self.at += 1;
        while let Some(&byte) = self.text.get(self.at) {
            // Whatever comes after a backslash belongs to the string.
            self.at += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                return Ok(());
            }
        }
        let kind = FileErrorKind::truncated("a string: there is no \" that ends it");
        Err(Fault { at: start, kind })
    }
}

/// Whether a word is a number or begins like one; no name does.
pub(super) fn is_number(word: &[u8]) -> bool {
    matches!(word.first(), Some(b'0'..=b'9' | b'+' | b'-' | b'.'))
}

/// The whole number that `word` is, decimal or hexadecimal.
pub(super) fn index(word: &[u8]) -> Option<i64> {
    // Most words are decimal.
    if let Some(number) = whole_number(word) {
        return Some(number);
    }
    let digits = word.strip_prefix(b"0x").or(word.strip_prefix(b"0X"))?;
    // A sign is not a hexadecimal digit.
    let digits = std::str::from_utf8(digits).ok();
    let digits = digits.filter(|digits| digits.bytes().all(|b| b.is_ascii_hexdigit()))?;
    i64::from_str_radix(digits, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<&str> {
        let mut lexer = Lexer::new(text.as_bytes(), 0);
        let mut found = Vec::new();
        while let Some(token) = lexer.token().unwrap() {
            found.push(&text[token.span()]);
        }
        found
    }

    #[test]
    fn commas_and_comments_separate_and_strings_hold_anything() {
        let text = "a,b#c { \" \r\nd[\"e\\\"#{\"-1]f{}# end";
        let expected = ["a", "b", "d", "[", "\"e\\\"#{\"", "-1", "]", "f", "{", "}"];
        assert_eq!(tokens(text), expected);
        assert_eq!(
            tokens("[-1.#IND 0 1.#INF,1.#x"),
            ["[", "-1.#IND", "0", "1.#INF", "1."]
        );
        for open in ["\"", "x \"a\\", "\"a\\\""] {
            let mut lexer = Lexer::new(open.as_bytes(), 0);
            assert!((0..3).any(|_| lexer.token().is_err()), "{open}");
        }
    }

    #[test]
    fn indices_are_decimal_or_hexadecimal() {
        assert_eq!(index(b"-1"), Some(-1));
        assert_eq!(index(b"0x1f"), Some(31));
        for bad in [b"0x" as &[u8], b"0x+1", b"1.0", b"-0x1", b"x"] {
            assert_eq!(index(bad), None);
        }
    }
}
