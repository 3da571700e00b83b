//! Fields of fixed width, as Fortran writes them.

use super::super::super::error::FileErrorKind;
use super::super::super::text::{shown, whole_number};

/// The characters of a field, without blanks around.
pub(super) fn text_of(block: &[u8], from: usize, width: usize) -> &[u8] {
    let end = (from + width).min(block.len());
    block.get(from..end).unwrap_or(&[]).trim_ascii()
}

/// A whole number.
pub(super) fn whole(block: &[u8], from: usize, width: usize) -> Option<i64> {
    whole_number(text_of(block, from, width))
}

/// A number with a point, whose exponent may be marked by a D.
pub(super) fn decimal(block: &[u8], from: usize, width: usize) -> Option<f64> {
    let text = std::str::from_utf8(text_of(block, from, width)).ok()?;
    text.replace(['D', 'd'], "E").parse().ok()
}

/// The error for a field that holds no number.
pub(super) fn field_error(block: &[u8], from: usize, width: usize, what: &str) -> FileErrorKind {
    let found = shown(text_of(block, from, width));
    FileErrorKind::malformed(format!("{found} where a number was expected: {what}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_marked_by_d_or_e() {
        let block = b"   0.557945011821133D+06  0.3E+02   -12 7   ";
        assert_eq!(decimal(block, 0, 24), Some(557_945.011_821_133));
        assert_eq!(decimal(block, 24, 9), Some(30.0));
        assert_eq!(whole(block, 33, 6), Some(-12));
        assert_eq!(whole(block, 39, 6), Some(7));
        assert_eq!(whole(block, 41, 6), None);
        assert_eq!(whole(block, 99, 6), None);
    }
}
