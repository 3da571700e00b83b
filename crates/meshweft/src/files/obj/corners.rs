//! The corners of a face, as text: where they stand, and what they name.

use std::ops::Range;

use crate::files::text::{Tokens, leading_number};

/// The numbers of the vertex, texture coordinate and normal that a corner names, from 1; 0 for none.
pub(super) type Named = [u64; 3];

/// Where the corners of a face, line or point stand.
pub(super) fn corners(source: &[u8], span: &Range<usize>) -> Vec<Range<usize>> {
    let tokens = Tokens::of_statement(&source[..span.end], span.start);
    tokens.skip(1).collect()
}

/// What a corner names, by how many lines of each kind are above it.
pub(super) fn named(token: &[u8], above: [usize; 3]) -> Named {
    let mut named = [0; 3];
    let mut rest = token;
    for (named, above) in named.iter_mut().zip(above) {
        if let Some((number, length)) = leading_number(rest) {
            let plain = match number {
                ..0 => (above as u64 + 1).checked_sub(number.unsigned_abs()),
                _ => u64::try_from(number).ok(),
            };
            *named = plain.unwrap_or(0);
            rest = &rest[length..];
        }
        // Past the `/`.
        rest = rest.get(1..).unwrap_or_default();
    }
    named
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_names_three_lines() {
        let above = [7, 5, 3];
        for (token, expected) in [
            ("1", [1, 0, 0]),
            ("2/3", [2, 3, 0]),
            ("2//4", [2, 0, 4]),
            ("-1/-5/-3", [7, 1, 1]),
            ("-9/2/", [0, 2, 0]),
        ] {
            assert_eq!(named(token.as_bytes(), above), expected, "{token}");
        }
    }
}
