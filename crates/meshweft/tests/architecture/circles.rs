//! Circles: files that name each other, directly or through others.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::paths::Names;
use crate::sources::Sources;

/// Which file names what another defines, with one path that does so: `arrows[from][to]`.
type Arrows = Vec<BTreeMap<usize, String>>;

/// The circles among the files, a text each with the paths that make it; empty if there is none.
pub(crate) fn circles(sources: &Sources) -> Vec<String> {
    let arrows = arrows(sources);
    let reached: Vec<Vec<bool>> = (0..arrows.len())
        .map(|file| reached(&arrows, file))
        .collect();
    let mut is_told = vec![false; arrows.len()];
    let mut circles = Vec::new();
    for file in 0..arrows.len() {
        let is_with = |other: &usize| reached[file][*other] && reached[*other][file];
        let circle: Vec<usize> = (0..arrows.len()).filter(is_with).collect();
        if circle.len() > 1 && !is_told[file] {
            circle.iter().for_each(|&file| is_told[file] = true);
            circles.push(text(sources, &arrows, &circle));
        }
    }
    circles
}

/// A line for the files of a circle, and one for each arrow among them.
fn text(sources: &Sources, arrows: &Arrows, circle: &[usize]) -> String {
    let name = |file: usize| &*sources.files[file].name;
    let names: Vec<&str> = circle.iter().map(|&file| name(file)).collect();
    let mut text = names.join(", ");
    for &from in circle {
        for (&to, path) in arrows[from].iter().filter(|(to, _)| circle.contains(to)) {
            let _ = write!(text, "\n    {} -> {}: {path}", name(from), name(to));
        }
    }
    text
}

/// Re-exports of a module with modules below are no arrows: it only shows what those have.
fn arrows(sources: &Sources) -> Arrows {
    let names = Names::of(sources);
    let mut arrows = vec![BTreeMap::new(); sources.files.len()];
    for (file, paths) in names.paths.iter().enumerate() {
        let module = &sources.files[file].module;
        let is_below = |other: &[String]| other.len() > module.len() && other.starts_with(module);
        let has_children = sources.files.iter().any(|other| is_below(&other.module));
        for path in paths {
            if has_children && path.is_re_export() {
                continue;
            }
            if let Some(definition) = names.definition(file, path) {
                let path = path.segments.join("::");
                arrows[file].entry(definition).or_insert(path);
            }
        }
    }
    arrows
}

fn reached(arrows: &Arrows, start: usize) -> Vec<bool> {
    let mut reached = vec![false; arrows.len()];
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        for &next in arrows[file].keys() {
            if !std::mem::replace(&mut reached[next], true) {
                open.push(next);
            }
        }
    }
    reached
}

/// The names of the files of the only circle of planted sources, or nothing.
#[cfg(test)]
fn circle(files: &[(&str, &str)]) -> String {
    let circles = circles(&Sources::planted(files));
    assert!(circles.len() <= 1, "{circles:?}");
    let first = circles.first().and_then(|text| text.lines().next());
    first.unwrap_or_default().to_owned()
}

#[test]
fn a_direct_circle_is_found() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;"),
        ("a.rs", "use crate::b::B;\npub struct A(B);"),
        ("b.rs", "pub struct B(Box<super::a::A>);"),
        ("c.rs", "use crate::{a::A, b::B};"),
    ];
    assert_eq!(circle(&files), "a.rs, b.rs");
}

#[test]
fn a_circle_through_three_files_is_found() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;"),
        (
            "a.rs",
            "use crate::{b::{self, Other}, error};\nfn f() { b::g() }",
        ),
        ("b.rs", "use super::c;\nfn g() { c::h() }"),
        ("c/mod.rs", "mod d;\nfn h() { d::i() }"),
        ("c/d.rs", "fn i() { crate::a::f() }"),
    ];
    assert_eq!(circle(&files), "a.rs, b.rs, c/d.rs, c/mod.rs");
}

#[test]
fn a_circle_through_a_re_export_is_found() {
    let files = [
        ("lib.rs", "mod room;\npub use room::A;"),
        (
            "room/mod.rs",
            "mod a;\nmod b;\npub use a::A;\npub(crate) use b::*;",
        ),
        ("room/a.rs", "use super::B;\npub struct A(B);"),
        ("room/b.rs", "pub(crate) struct B(Option<Box<crate::A>>);"),
    ];
    assert_eq!(circle(&files), "room/a.rs, room/b.rs");
}

#[test]
fn a_folder_and_its_child_can_be_a_circle() {
    let files = [
        ("lib.rs", "mod room;"),
        (
            "room/mod.rs",
            "mod a;\nuse a::A;\npub struct Room(A);\npub enum Kind {}",
        ),
        ("room/a.rs", "pub(super) struct A(super::Kind);"),
    ];
    assert_eq!(circle(&files), "room/a.rs, room/mod.rs");
}

#[test]
fn no_circle_is_seen_where_none_is() {
    let files = [
        // Showing what is below does not use it.
        ("lib.rs", "mod room;\nmod other;\npub use room::{A, B};"),
        (
            "room/mod.rs",
            "//! [`crate::other`]\nmod a;\nmod b;\npub use {a::A, b::B};\npub const X: u8 = 1;",
        ),
        (
            "room/a.rs",
            "use super::B;\nuse crate::room::X;\npub struct A(B);\n// super::c::C",
        ),
        (
            "room/b.rs",
            "pub struct B;\nconst T: &str = \"crate::A\";\n#[cfg(test)]\nmod tests { use super::super::a::A; }",
        ),
        (
            "other.rs",
            "use crate::{A, room::{self, X}};\nuse std::fmt::{self, A as _};\n#[cfg(test)]\nmod oracle;\nfn f() -> fmt::Result { room::B }",
        ),
        ("other/oracle.rs", "use super::*;"),
    ];
    assert_eq!(circle(&files), "");
}
