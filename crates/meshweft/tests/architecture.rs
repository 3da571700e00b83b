//! The shape of the library's sources: which module may name which, and how long a file may be.

use std::path::{Path, PathBuf};

const LONGEST_FILE: usize = 800;

/// What each module may name of the crate; `mesh, permutation ← adjacency ← cache ← order → partition`, and
/// `files → mesh, permutation` only. The names at the root are their modules' types.
const ALLOWED: [(&str, &[&str]); 11] = [
    ("error", &[]),
    ("limits", &[]),
    ("permutation", &["error", "limits"]),
    ("mesh", BASE),
    ("adjacency", BASE),
    (
        "cache",
        &["error", "limits", "permutation", "mesh", "adjacency"],
    ),
    ("parallel", &[]),
    ("random", &["limits"]),
    ("partition", &["error", "limits", "parallel", "random"]),
    (
        "order",
        &[
            "error",
            "limits",
            "permutation",
            "mesh",
            "adjacency",
            "cache",
            "parallel",
            "partition",
            "random",
        ],
    ),
    ("files", BASE),
];

const BASE: &[&str] = &["error", "limits", "permutation", "mesh"];

/// Types that the root re-exports, with their module.
const ROOT_TYPES: [(&str, &str); 7] = [
    ("Mesh", "mesh"),
    ("MeshError", "error"),
    ("Limits", "limits"),
    ("FaceOrder", "permutation"),
    ("Permutation", "permutation"),
    ("VertexOrder", "permutation"),
    ("CacheModel", "cache"),
];

fn sources() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut folders, mut files) = (vec![root.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                files.push((path.strip_prefix(&root).unwrap().to_owned(), text));
            }
        }
    }
    assert!(files.len() > 10, "the sources are found");
    files.sort();
    files
}

/// The module directly below the root that a file belongs to.
fn module(file: &Path) -> String {
    let first = file.iter().next().unwrap_or_default().to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// Code that is built into the library: no comments, no unit tests.
fn library_code(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests {").next();
    let lines = code.unwrap_or_default().lines();
    let without_comment = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
    lines.map(without_comment).collect::<Vec<_>>().join("\n")
}

/// What follows each `crate::`, the names in braces one by one.
fn crate_names(code: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let is_part = |c: &char| c.is_alphanumeric() || *c == '_';
        text.trim_start().chars().take_while(is_part).collect()
    };
    let mut names = Vec::new();
    for after in code.split("crate::").skip(1) {
        let Some(group) = after.strip_prefix('{') else {
            names.push(name(after));
            continue;
        };
        // Names at depth 0 of the braces; what is nested belongs to one of them.
        let (mut depth, mut starts) = (0, true);
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => starts = true,
                _ if starts && !c.is_whitespace() => {
                    names.push(name(&group[at..]));
                    starts = false;
                }
                _ => {}
            }
        }
    }
    names
}

#[test]
fn grouped_names_are_told_apart() {
    let code = "use crate::{a::{b, c}, d};\nlet x = crate::e::f;";
    assert_eq!(crate_names(code), ["a", "d", "e"]);
}

#[test]
fn arrows_point_one_way() {
    for (file, text) in sources() {
        let module = module(&file);
        if module == "lib" || file.ends_with("tests.rs") {
            continue;
        }
        let allowed = ALLOWED.iter().find(|(name, _)| *name == module);
        let (_, allowed) = allowed.unwrap_or_else(|| panic!("no arrows for module {module}"));
        for name in crate_names(&library_code(&text)) {
            let at_root = ROOT_TYPES.iter().find(|(root_type, _)| *root_type == name);
            let named = at_root.map_or(&*name, |(_, module)| module);
            assert!(
                named == module || allowed.contains(&named),
                "{}: {module} may not name crate::{name}",
                file.display()
            );
        }
    }
}

#[test]
fn no_algorithm_knows_files() {
    for (file, text) in sources() {
        if ["files", "lib"].contains(&&*module(&file)) {
            continue;
        }
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        for (at, _) in text.match_indices("files::") {
            assert!(
                text[..at].ends_with(is_name),
                "{} names files",
                file.display()
            );
        }
        assert!(
            !text.contains("crate::files"),
            "{} names files",
            file.display()
        );
    }
}

#[test]
fn no_file_is_too_long() {
    for (file, text) in sources() {
        let lines = text.lines().count();
        assert!(lines <= LONGEST_FILE, "{}: {lines} lines", file.display());
    }
}

#[test]
fn each_folder_opens_with_what_it_is() {
    let mut folders = 0;
    for (file, text) in sources() {
        if file.ends_with("mod.rs") {
            assert!(text.starts_with("//! "), "{}", file.display());
            folders += 1;
        }
    }
    assert!(folders >= 3);
}
