//! The names of other files, in an OBJ and in the libraries of materials that it names.

use std::path::{Path, PathBuf};

use crate::files::surroundings::Surroundings;
use crate::files::text::{Tokens, is_coordinate, trimmed};

/// The path that a name stands for, if it stays below the folder; `\` separates folders as `/` does.
pub(super) fn relative_path(name: &[u8]) -> Option<PathBuf> {
    let name = name.strip_prefix(b"\"").unwrap_or(name);
    let name = name.strip_suffix(b"\"").unwrap_or(name);
    let is_absolute = matches!(name.first(), Some(b'/' | b'\\')) || name.get(1) == Some(&b':');
    if is_absolute || name.contains(&0) {
        return None;
    }
    let mut path = PathBuf::new();
    for part in name.split(|byte| matches!(byte, b'/' | b'\\')) {
        match part {
            b"" | b"." => {}
            b".." => return None,
            part => path.push(file_name(part)?),
        }
    }
    (!path.as_os_str().is_empty()).then_some(path)
}

/// Bytes as a name of this system.
#[cfg(unix)]
fn file_name(bytes: &[u8]) -> Option<&Path> {
    use std::{ffi::OsStr, os::unix::ffi::OsStrExt};
    Some(Path::new(OsStr::from_bytes(bytes)))
}

#[cfg(not(unix))]
fn file_name(bytes: &[u8]) -> Option<&Path> {
    std::str::from_utf8(bytes).ok().map(Path::new)
}

/// The files that the text of an `mtllib` names: one whose name is all of it, if there is such a file,
/// as some programs write names with blanks; else one a word.
///
/// A word that names nothing below the folder is given as it is.
pub(super) fn named_libraries<'a>(
    text: &'a [u8],
    surroundings: Surroundings<'_>,
) -> Vec<Result<PathBuf, &'a [u8]>> {
    let whole = relative_path(text);
    if let Some(whole) = whole.filter(|whole| surroundings.has(whole)) {
        return vec![Ok(whole)];
    }
    let words = Tokens::of_statement(text, 0).map(|word| &text[word]);
    words.map(|word| relative_path(word).ok_or(word)).collect()
}

/// The file that the text of a texture statement names, as in `-s 1 1 -bm 0.5 stone wall.png`; the
/// library stands in `folder`.
///
/// A name may have blanks, and some programs write options after it. The longest name that is there
/// counts, first from the folder of the library and then from that of the OBJ. Where none is there, it
/// is the longest without options, from the folder of the library.
pub(super) fn named_texture(
    text: &[u8],
    folder: &Path,
    surroundings: Surroundings<'_>,
) -> Option<PathBuf> {
    let tokens: Vec<_> = Tokens::of_statement(text, 0).take(MOST_WORDS).collect();
    let words = tokens.iter().map(|token| &text[token.clone()]);
    let words: Vec<&[u8]> = words.collect();
    let first = after_options(&words);
    let start = tokens.get(first)?.start;
    let end_of = |last: usize| trimmed(text, start, tokens[last].end).end;

    // The longest first.
    let ends = (first..words.len()).rev().map(end_of);
    let whole = trimmed(text, start, text.len()).end;
    for end in [whole].into_iter().chain(ends) {
        let Some(name) = relative_path(&text[start..end]) else {
            continue;
        };
        let paths = [folder.join(&name), name];
        if let Some(found) = paths.into_iter().find(|path| surroundings.has(path)) {
            return Some(found);
        }
    }

    let is_option = |word: &&[u8]| arguments(word).is_some();
    let count = words[first..]
        .iter()
        .take_while(|word| !is_option(word))
        .count();
    let last = first + count.max(1) - 1;
    Some(folder.join(relative_path(&text[start..end_of(last)])?))
}

/// How many words of a texture statement are looked at.
const MOST_WORDS: usize = 16;

/// The number of the first word after the options.
fn after_options(words: &[&[u8]]) -> usize {
    let mut at = 0;
    while let Some((fewest, most)) = words.get(at).and_then(|word| arguments(word)) {
        at += 1 + fewest;
        let more = words.iter().skip(at).take(most - fewest);
        at += more.take_while(|word| is_coordinate(word)).count();
    }
    at
}

/// The fewest and the most arguments of an option; those past the fewest are numbers.
fn arguments(option: &[u8]) -> Option<(usize, usize)> {
    match option {
        b"-o" | b"-s" | b"-t" => Some((1, 3)),
        b"-mm" => Some((2, 2)),
        b"-blendu" | b"-blendv" | b"-bm" | b"-boost" | b"-cc" | b"-clamp" | b"-imfchan"
        | b"-texres" | b"-type" => Some((1, 1)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn names_stay_below_the_folder() {
        let path = |name: &str| relative_path(name.as_bytes());
        assert_eq!(path("a b.mtl"), Some("a b.mtl".into()));
        assert_eq!(path(".\\x\\y.png"), Some("x/y.png".into()));
        assert_eq!(path("\"my file.mtl\""), Some("my file.mtl".into()));
        for bad in [
            "",
            "\"",
            ".",
            "/a",
            "\\a",
            "C:\\a",
            "../a",
            "a/../../b",
            "a\0",
        ] {
            assert_eq!(path(bad), None, "{bad}");
        }
    }

    #[test]
    fn libraries_are_one_a_word_unless_all_is_a_name() {
        let files = BTreeMap::from([(PathBuf::from("my file.mtl"), Vec::new())]);
        let beside = Surroundings::Memory(&files);
        fn named<'a>(text: &'a str, beside: Surroundings<'_>) -> Vec<Result<PathBuf, &'a [u8]>> {
            named_libraries(text.as_bytes(), beside)
        }
        assert_eq!(
            named("my file.mtl", beside),
            [Ok(PathBuf::from("my file.mtl"))]
        );
        let words = ["a.mtl", "b/c.mtl"].map(|word| Ok(PathBuf::from(word)));
        assert_eq!(named("a.mtl  b\\c.mtl # more", beside), words);
        assert_eq!(named("../d.mtl", beside), [Err(&b"../d.mtl"[..])]);
    }

    #[test]
    fn textures_are_named_after_options() {
        let here = ["m/a b.png", "c.png", "m/d.png", "1"];
        let files = here.map(|path| (PathBuf::from(path), Vec::new()));
        let files = BTreeMap::from(files);
        let named = |text: &str| {
            let found = named_texture(
                text.as_bytes(),
                Path::new("m"),
                Surroundings::Memory(&files),
            );
            found.map(|path| path.to_str().unwrap().to_owned())
        };
        for (text, expected) in [
            ("a b.png", "m/a b.png"),
            ("-s 1 1 1 -bm 0.5 a b.png", "m/a b.png"),
            ("-o 1 c.png", "c.png"),
            ("-clamp on -mm 0 1 -type sphere d.png", "m/d.png"),
            ("d.png -bm 2", "m/d.png"),
            ("gone.png -bm 2", "m/gone.png"),
            ("gone too.png", "m/gone too.png"),
            ("-t 1 2 3 1", "1"),
        ] {
            assert_eq!(named(text).as_deref(), Some(expected), "{text}");
        }
        for nothing in ["", "-s 1 1 1", "-bm", "C:\\a.png", "../c.png"] {
            assert_eq!(named(nothing), None, "{nothing}");
        }
    }
}
