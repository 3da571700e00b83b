//! Errors as the program reports them.

use std::fmt;

use anyhow::Error;
use meshweft::files::{FileError, FileErrorKind};
use meshweft::operations::{CompressError, ConversionError, CullError, LevelsError, LodError};

/// What the command line asks for cannot be done; exit code 2.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// The text of an error, in each report and on standard error.
///
/// Made in one place, because the library does not know the program's flags: where a flag helps, it
/// is named here.
pub(crate) fn message(error: &Error) -> String {
    let text = format!("{error:#}");
    let conversion = match (error.downcast_ref(), error.downcast_ref()) {
        (Some(CullError::Conversion(error)), _) => Some(error),
        (_, Some(LevelsError::Conversion(error))) => Some(error),
        _ => None,
    };
    if let Some(ConversionError::Lost { .. }) = conversion {
        return text.replace("drop_attributes", "--drop-attributes");
    }
    match error.downcast_ref() {
        Some(LodError::Losses { .. }) => {
            return text.replace("drop_attributes", "--drop-attributes");
        }
        Some(LodError::TooLong { .. }) => {
            return text.replace("raise limits.file_bytes", "allow more with --max-bytes");
        }
        _ => {}
    }
    match error.downcast_ref() {
        Some(CompressError::Attributes { .. }) => {
            return text.replace("drop_attributes", "--drop-attributes");
        }
        Some(CompressError::Lines { .. }) => {
            return text.replace("with triangles", "with --triangles");
        }
        Some(CompressError::WidePositions { .. }) => {
            return text.replace(
                "a position step or a number of position bits",
                "--position-step or --position-bits",
            );
        }
        _ => {}
    }
    let of_file = match error.downcast_ref() {
        Some(LodError::File(error)) => Some(error),
        _ => error.downcast_ref::<FileError>(),
    };
    match of_file.map(|error| &error.kind) {
        Some(FileErrorKind::Unknown { name, .. }) => format!(
            "{text}. Leave out --strict to keep what it may depend on, or say \
             --assume-order-safe {name} if it does not"
        ),
        // Only this limit has a flag.
        Some(FileErrorKind::OverLimit { what, .. }) => {
            let text = text.trim_end_matches(", or allow more");
            match *what {
                "bytes" | "bytes or more" => format!("{text}, or allow more with --max-bytes"),
                _ => text.to_owned(),
            }
        }
        Some(FileErrorKind::ReadOnly | FileErrorKind::Exists) => {
            format!("{text}. Give --force to replace it")
        }
        _ => text,
    }
}
