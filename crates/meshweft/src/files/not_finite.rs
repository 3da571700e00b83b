//! Numbers that are not finite, in the spellings of C libraries that no other language reads.
//!
//! Those of Windows were `1.#INF`, `-1.#IND` (the quiet not-a-number of a failed operation), `1.#QNAN`
//! and `1.#SNAN` until 2015: cut and rounded like digits to the precision that was asked for, so `1.#J` is
//! `1.#INF` with two places. Later ones write `-nan(ind)` and `nan(snan)`, others `nan(0x8000)`.

/// The letters after `1.#`, and whether they are an infinity.
const WORDS: [(&[u8], bool); 4] = [
    (b"INF", true),
    (b"IND", false),
    (b"QNAN", false),
    (b"SNAN", false),
];

/// The number that `token` is, if it is one of these.
#[cold]
pub(super) fn parse(token: &[u8]) -> Option<f32> {
    let (number, length) = leading(token)?;
    (length == token.len()).then_some(number)
}

/// Whether the `#` at `at` is part of a number that starts at `start`, and begins no comment.
#[cold]
pub(super) fn has_mark(text: &[u8], start: usize, at: usize) -> bool {
    let rest = &text[start..];
    leading(rest).is_some_and(|(_, length)| {
        let ends = rest.get(length).is_none_or(|b| !b.is_ascii_alphanumeric());
        ends && at - start < length
    })
}

/// The number that `text` starts with, and how many bytes it takes.
fn leading(text: &[u8]) -> Option<(f32, usize)> {
    let sign_length = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let signed = |number: f32| if text[0] == b'-' { -number } else { number };
    let rest = &text[sign_length..];
    if let Some(length) = named(rest) {
        return Some((signed(f32::NAN), sign_length + length));
    }

    // Two places: the mark itself is rounded, and what it was cannot be told.
    if rest.starts_with(b"1.$") {
        return Some((signed(f32::NAN), sign_length + 3));
    }
    let letters = rest.strip_prefix(b"1.#")?;
    let count = letters.iter().take_while(|b| b.is_ascii_uppercase());
    let (word, after) = letters.split_at(count.count());
    let number = if WORDS.contains(&(word, true)) || is_rounded_infinity(word, text[0]) {
        f32::INFINITY
    } else if WORDS.iter().any(|(full, _)| is_full_or_rounded(word, full)) {
        f32::NAN
    } else {
        return None;
    };

    // Places beyond the letters, and an exponent.
    let zeros = after.iter().take_while(|&&b| b == b'0').count();
    let exponent = exponent_length(&after[zeros..]);
    let length = sign_length + 3 + word.len() + zeros + exponent;
    Some((signed(number), length))
}

/// How many bytes `nan(…)` takes at the start of a text.
fn named(text: &[u8]) -> Option<usize> {
    let (nan, rest) = text.split_at_checked(3)?;
    let inner = rest.strip_prefix(b"(")?;
    let is_inner = |&&b: &&u8| b.is_ascii_alphanumeric() || b == b'_';
    let count = inner.iter().take_while(is_inner).count();
    let is_closed = inner.get(count) == Some(&b')');
    (nan.eq_ignore_ascii_case(b"nan") && is_closed).then_some(count + 5)
}

/// Whether `word` is `full`, or its beginning with the last letter rounded up.
fn is_full_or_rounded(word: &[u8], full: &[u8]) -> bool {
    let rounded = || {
        let (last, before) = word.split_last()?;
        let rest = full.strip_prefix(before).filter(|rest| rest.len() > 1)?;
        Some(*last == rest[0] + 1)
    };
    word == full || rounded() == Some(true)
}

/// Whether it is `1.#INF` with few places. A negative one is as likely to be `-1.#IND`.
fn is_rounded_infinity(word: &[u8], first: u8) -> bool {
    first != b'-' && is_full_or_rounded(word, b"INF")
}

/// How many bytes an exponent takes at the start of a text.
fn exponent_length(text: &[u8]) -> usize {
    let [b'e' | b'E', b'-' | b'+', digits @ ..] = text else {
        return 0;
    };
    match digits.iter().take_while(|b| b.is_ascii_digit()).count() {
        0 => 0,
        count => count + 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_c_libraries_are_read() {
        let nan = |text: &str| parse(text.as_bytes()).is_some_and(f32::is_nan);
        for text in [
            "nan(ind)",
            "-nan(ind)",
            "nan(snan)",
            "+NaN(0x8000_1)",
            "nan()",
            "1.#QNAN",
            "-1.#QNAN0",
            "1.#SNAN",
            "-1.#IND",
            "-1.#IND00",
            "1.#IND",
            "-1.#INDe+000",
            "-1.#J",
            "-1.#IO",
            "1.#QNB",
            "1.#R",
            "1.$",
        ] {
            assert!(nan(text), "{text}");
        }
        for (text, expected) in [
            ("1.#INF", f32::INFINITY),
            ("-1.#INF", f32::NEG_INFINITY),
            ("+1.#INF00", f32::INFINITY),
            ("-1.#INF00E+001", f32::NEG_INFINITY),
            ("1.#J", f32::INFINITY),
            ("1.#IO", f32::INFINITY),
        ] {
            assert_eq!(parse(text.as_bytes()), Some(expected), "{text}");
        }
    }

    #[test]
    fn nothing_else_is() {
        for text in [
            "",
            "-",
            "1",
            "1.",
            "1.#",
            "-1.#",
            "1.#I",
            "1.#IN",
            "1.#INFO",
            "1.#INF1",
            "1.#INFe",
            "1.#INFe+",
            "1.#inf",
            "2.#INF",
            "1.#K",
            "nan(",
            "nan(ind",
            "nan)",
            "nan(-)",
            "nam()",
            "nan(ind)1",
            "1.#QNANQ",
            "0.#INF",
            "1#INF",
        ] {
            assert_eq!(parse(text.as_bytes()).map(f32::to_bits), None, "{text}");
        }
    }

    #[test]
    fn a_mark_within_a_number_begins_no_comment() {
        let text = b"v 1.#IND 0 0";
        assert!(has_mark(text, 2, 4));
        assert!(has_mark(b"-1.#INF,", 0, 3));
        for text in ["1.#", "1.#INFO", "1.# INF", "1.#information"] {
            assert!(!has_mark(text.as_bytes(), 0, 2), "{text}");
        }
        // The second one does.
        assert!(!has_mark(b"1.#INF#", 0, 6));
    }
}
