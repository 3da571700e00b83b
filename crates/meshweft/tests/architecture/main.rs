//! The shape of the sources: which file may name which, how long a file may be, and what must not
//! stand twice or in the wrong place.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sources::Sources;

mod circles;
mod paths;
mod rooms;
mod sources;

const LONGEST_FILE: usize = 600;

/// Names that more than one type of the library may have.
const TWINS: [&str; 0] = [];

/// A folder of the repository's `crates`.
fn folder(below: &str) -> PathBuf {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    crates.join(below)
}

fn library() -> Sources {
    Sources::read(&folder("meshweft/src"))
}

fn program() -> Sources {
    Sources::read(&folder("meshweft-cli/src"))
}

/// Fails with all that was found, a line each.
fn assert_none(what: &str, found: &[String]) {
    assert!(
        found.is_empty(),
        "{what}: {}\n{}",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn no_files_of_the_library_name_each_other_in_a_circle() {
    assert_none("circles", &circles::circles(&library()));
}

#[test]
fn no_files_of_the_program_name_each_other_in_a_circle() {
    assert_none("circles", &circles::circles(&program()));
}

#[test]
fn arrows_between_rooms_point_one_way() {
    assert_none("arrows", &rooms::wrong_arrows(&library()));
}

#[test]
fn the_program_names_of_the_library_only_what_it_may() {
    assert_none("names", &rooms::wrong_names_of_the_library(&program()));
}

#[test]
fn no_file_is_too_long() {
    let mut long = Vec::new();
    for below in [
        "meshweft/src",
        "meshweft/tests",
        "meshweft-cli/src",
        "meshweft-cli/tests",
    ] {
        for (name, text) in sources::texts(&folder(below)) {
            let lines = text.lines().count();
            if lines > LONGEST_FILE {
                long.push(format!("{below}/{name}: {lines} lines"));
            }
        }
    }
    assert_none("files over 600 lines", &long);
}

#[test]
fn the_library_knows_no_command_line() {
    let mut found = Vec::new();
    for file in library().files {
        found.extend(
            file.strings
                .iter()
                .filter(|string| has_flag(string))
                .map(|string| format!("{}: {string:?}", file.name)),
        );
    }
    assert_none("strings with a flag", &found);
}

fn has_flag(text: &str) -> bool {
    let mut after = text.split("--").skip(1);
    after.any(|after| after.starts_with(|c: char| c.is_ascii_lowercase()))
}

#[test]
fn flags_are_told_from_dashes() {
    assert!(has_flag("use --strict"));
    assert!(!has_flag("a -- b, |---|--:|, -s, ---"));
}

#[test]
fn no_two_types_have_one_name() {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in library().files {
        for name in paths::types(&file.code) {
            files.entry(name).or_default().push(file.name.clone());
        }
    }
    let twins = files
        .iter()
        .filter(|(name, files)| files.len() > 1 && !TWINS.contains(&&***name));
    let twins: Vec<String> = twins
        .map(|(name, files)| format!("{name}: {}", files.join(", ")))
        .collect();
    assert_none("names of two types", &twins);
}

#[test]
fn each_folder_opens_with_what_it_is() {
    let mut folders = 0;
    for file in library().files {
        if file.name.ends_with("mod.rs") {
            assert!(file.text.starts_with("//! "), "{}", file.name);
            folders += 1;
        }
    }
    assert!(folders >= 3);
}

/// A reader of the front page sees how to order indices, order a file and count misses without
/// scrolling.
#[test]
fn the_front_page_shows_the_three_calls_first() {
    let front = std::fs::read_to_string(folder("meshweft/src/lib.rs")).unwrap();
    let first: Vec<&str> = front.lines().take(60).collect();
    let first: Vec<&str> = first
        .into_iter()
        .filter(|line| line.starts_with("//!"))
        .collect();
    let first = first.join("\n");
    for call in ["optimize_indices(", " optimize(", "acmr("] {
        assert!(first.contains(call), "{call}");
    }
}
