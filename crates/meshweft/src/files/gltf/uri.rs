//! The URIs of buffers: data in the text, or a file below the folder of the glTF.

use std::path::PathBuf;

use super::base64;

/// The data of a `data:` URI, and the text up to and with its comma.
///
/// # Errors
/// What is wrong with it.
pub(super) fn decode_data(uri: &str) -> Result<(&str, Vec<u8>), String> {
    let bad = |text: String| Err(text);
    let Some(comma) = uri.find(',') else {
        return bad("a data: URI needs a comma before its data".into());
    };
    let (prefix, data) = uri.split_at(comma + 1);
    if !prefix.to_ascii_lowercase().ends_with(";base64,") {
        return bad("the data: URI is not base64: export it as base64 or as a file".into());
    }
    match base64::decode(data) {
        Ok(bytes) => Ok((prefix, bytes)),
        Err(position) => bad(format!(
            "the base64 data is wrong at character {position} of {}",
            data.len()
        )),
    }
}

/// The path that a URI names, if it is one that stays below the folder of the glTF.
///
/// # Errors
/// What is wrong with it.
pub(super) fn relative_path(uri: &str) -> Result<PathBuf, String> {
    let bad = |why: &str| {
        Err(format!(
            "{uri:?} {why}: only files in the folder of the glTF or below are read"
        ))
    };
    let Some(decoded) = percent_decoded(uri) else {
        return bad("is not UTF-8 text when decoded");
    };

    if decoded.starts_with('/') {
        return bad("is an absolute path");
    }
    if decoded.contains(':') {
        return bad("has a scheme or a drive");
    }
    if decoded.contains('\\') {
        let with_slashes = decoded.replace('\\', "/");
        return Err(format!(
            "{uri:?} has a backslash, which separates no folders in a URI: write {with_slashes:?}"
        ));
    }
    if decoded.contains('\0') {
        return bad("has a character that file names cannot share between systems");
    }

    let segments = decoded.split('/').filter(|s| !matches!(*s, "" | "."));
    let mut path = PathBuf::new();
    for segment in segments {
        if segment == ".." {
            return bad("leaves the folder of the glTF");
        }
        path.push(segment);
    }
    match path.as_os_str().is_empty() || decoded.ends_with('/') {
        true => bad("names no file"),
        false => Ok(path),
    }
}

/// Whether a URI names nothing on this disk: data in the text, or something of the web.
pub(super) fn is_of_another_place(uri: &str) -> bool {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme);
    // One letter is a drive.
    scheme.is_some_and(|scheme| {
        scheme.len() > 1
            && scheme.starts_with(|c: char| c.is_ascii_alphabetic())
            && scheme
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
    })
}

/// The path that a URI of this place names, with its `..`; `None` if it is not one.
pub(super) fn path_with_parents(uri: &str) -> Option<PathBuf> {
    let decoded = percent_decoded(uri)?;
    let is_path = !decoded.starts_with('/') && !decoded.contains([':', '\\', '\0']);
    is_path.then(|| {
        decoded
            .split('/')
            .filter(|part| !matches!(*part, "" | "."))
            .collect()
    })
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let digit = |i: usize| char::from(*after.get(i)?).to_digit(16);
        let pair = digit(0).zip(digit(1)).map(|(high, low)| high * 16 + low);
        match pair.and_then(|code| u8::try_from(code).ok()) {
            Some(code) if byte == b'%' => {
                bytes.push(code);
                rest = &after[2..];
            }
            // A lone `%` stands for itself: some exporters do not encode at all.
            _ => {
                bytes.push(byte);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

/// A file name as a URI: everything but unreserved characters encoded.
pub(super) fn percent_encoded(name: &str) -> String {
    let mut uri = String::new();
    for &byte in name.as_bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => {
                uri.push(char::from(byte));
            }
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    uri
}

pub(super) fn starts_with_ignoring_case(text: &str, start: &str) -> bool {
    let found = text.as_bytes().get(..start.len());
    found.is_some_and(|found| found.eq_ignore_ascii_case(start.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn paths_stay_in_the_folder() {
        let good = |uri| relative_path(uri).unwrap();
        assert_eq!(good("a.bin"), Path::new("a.bin"));
        assert_eq!(good("./sub//a%20b.bin"), Path::new("sub/a b.bin"));
        assert_eq!(good("100%.bin"), Path::new("100%.bin"));
        for uri in [
            "",
            "/etc/passwd",
            "http://host/a.bin",
            "C:/a.bin",
            "../a.bin",
            "sub/../a.bin",
            "%2e%2e%2Fa.bin",
            "..\\a.bin",
            "sub/",
            "a%00.bin",
            "%FF.bin",
        ] {
            assert!(relative_path(uri).is_err(), "{uri}");
        }
    }

    #[test]
    fn what_is_on_the_web_is_not_on_this_disk() {
        for uri in ["data:,", "https://host/a.png", "urn:x", "x-a+b.c:d"] {
            assert!(is_of_another_place(uri), "{uri}");
        }
        for uri in ["a.png", "C:/a.png", "a/b:c", "1:2", ":", "a b:c"] {
            assert!(!is_of_another_place(uri), "{uri}");
        }
    }

    #[test]
    fn names_survive_the_way_through_a_uri() {
        for name in ["a.bin", "ä b%.bin", "x#y?.bin"] {
            let uri = percent_encoded(name);
            assert!(uri.is_ascii() && !uri.contains(' '), "{uri}");
            assert_eq!(percent_decoded(&uri).unwrap(), name);
        }
    }

    #[test]
    fn data_must_be_base64() {
        let (prefix, bytes) = decode_data("data:a/b;x=y;base64,AAE=").unwrap();
        assert_eq!((prefix, bytes), ("data:a/b;x=y;base64,", vec![0, 1]));
        for uri in ["data:", "data:,abc", "data:;base64,A*AA"] {
            assert!(decode_data(uri).is_err(), "{uri}");
        }
    }
}
