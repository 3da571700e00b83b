//! What a file that cannot be read is said to have, for the tests of all formats.

use std::path::Path;

use meshweft::files::{Document, FileErrorKind, Format, ReadOptions};

/// The message for bytes that must not be readable, under a name that tells their format.
///
/// The advice that is the same for all of its kind must be there, and is left out.
pub(crate) fn error_of(bytes: &[u8], name: &str, options: impl Into<ReadOptions>) -> String {
    let path = Path::new(name);
    let format = Format::of_path(path).expect("a name of a known format");
    let read = Document::from_bytes(bytes.to_vec(), format, path, options);
    let Err(error) = read else {
        panic!("{:?} was read", String::from_utf8_lossy(bytes));
    };
    let text = error.to_string();
    let advice = match error.kind {
        FileErrorKind::Malformed { .. } => " Fix it there, or re-export the file",
        FileErrorKind::OverLimit { .. } => " Split the file, or allow more",
        _ => return text,
    };
    let text = text.strip_suffix(advice).expect("advice");
    text.strip_suffix('.').unwrap_or(text).to_owned()
}
