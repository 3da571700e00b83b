//! The paths that a file's code names, and what they lead to.

use crate::sources::{Source, Sources};

/// A path in the code, as it is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Path {
    pub(crate) segments: Vec<String>,
    pub(crate) place: Place,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Place {
    /// In a `use`, which gives it this name in the file.
    Use { name: String, is_public: bool },
    /// Anywhere else.
    Inline,
}

impl Path {
    fn name(&self) -> Option<&str> {
        match &self.place {
            Place::Use { name, .. } => Some(name),
            Place::Inline => None,
        }
    }

    pub(crate) fn is_re_export(&self) -> bool {
        matches!(
            self.place,
            Place::Use {
                is_public: true,
                ..
            }
        )
    }
}

/// All paths of some code: those of `use`, one for each name, and elsewhere those of two and more
/// segments, and the names of types.
pub(crate) fn paths(code: &str) -> Vec<Path> {
    let tokens = tokens(code);
    let (mut paths, mut at) = (Vec::new(), 0);
    while at < tokens.len() {
        if tokens[at] == "use" {
            let is_public = at > 0 && is_visibility(&tokens[..at]);
            at += 1;
            use_tree(&tokens, &mut at, &[], is_public, &mut paths);
            continue;
        }
        // Saying who may see an item does not use it.
        if at > 1 && tokens[at] == "in" && tokens[at - 2..at] == ["pub", "("] {
            at += tokens[at..]
                .iter()
                .take_while(|&&token| token != ")")
                .count();
            continue;
        }
        let start = at;
        let mut segments = Vec::new();
        while let Some(token) = tokens.get(at).filter(|token| is_name(token)) {
            segments.push((*token).to_owned());
            at += 1;
            match tokens.get(at..at + 2) {
                Some(["::", next]) if is_name(next) => at += 1,
                _ => break,
            }
        }
        // Behind `>::` or a dot stands a name of the type before it.
        let is_start = start == 0 || !["::", "."].contains(&tokens[start - 1]);
        let is_type = segments
            .first()
            .is_some_and(|name| name.starts_with(char::is_uppercase));
        if (segments.len() > 1 || is_type) && is_start {
            let place = Place::Inline;
            paths.push(Path { segments, place });
        }
        at = at.max(start + 1);
    }
    paths
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Whether what stands before a `use` makes it a re-export.
fn is_visibility(before: &[&str]) -> bool {
    let before = match before {
        [.., ")"] => match before.iter().rposition(|&token| token == "(") {
            Some(open) => &before[..open],
            None => before,
        },
        _ => before,
    };
    before.last() == Some(&"pub")
}

/// Words, `::`, and other characters one by one.
fn tokens(code: &str) -> Vec<&str> {
    let (mut tokens, mut rest) = (Vec::new(), code.trim_start());
    while let Some(first) = rest.chars().next() {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let length = match rest.find(|c| !is_part(c)) {
            _ if rest.starts_with("::") => 2,
            Some(0) => first.len_utf8(),
            Some(end) => end,
            None => rest.len(),
        };
        tokens.push(&rest[..length]);
        rest = rest[length..].trim_start();
    }
    tokens
}

/// Reads a tree of `use` from `at` to what ends it, and adds its leaves.
fn use_tree(
    tokens: &[&str],
    at: &mut usize,
    prefix: &[String],
    is_public: bool,
    paths: &mut Vec<Path>,
) {
    let mut segments = prefix.to_vec();
    let mut name = None;
    while let Some(&token) = tokens.get(*at) {
        match token {
            ";" | "," | "}" => break,
            "{" => {
                while !matches!(tokens.get(*at), None | Some(&"}")) {
                    *at += 1;
                    use_tree(tokens, at, &segments, is_public, paths);
                }
                *at += 1;
                return;
            }
            "as" => {
                *at += 1;
                name = tokens.get(*at).map(|&token| token.to_owned());
            }
            "::" => {}
            token => segments.push(token.to_owned()),
        }
        *at += 1;
    }
    // After the last comma of a group stands nothing.
    if segments.len() == prefix.len() {
        return;
    }
    // `a::{self}` names `a`.
    if prefix.len() + 1 == segments.len() && !prefix.is_empty() {
        segments.pop_if(|last| last == "self");
    }
    let name = name
        .or_else(|| segments.last().cloned())
        .unwrap_or_default();
    let place = Place::Use { name, is_public };
    paths.push(Path { segments, place });
}

/// What each file of a crate names.
pub(crate) struct Names<'a> {
    pub(crate) sources: &'a Sources,
    pub(crate) paths: Vec<Vec<Path>>,
}

/// How many re-exports of re-exports are followed.
const DEEPEST: usize = 16;

impl<'a> Names<'a> {
    pub(crate) fn of(sources: &'a Sources) -> Self {
        let paths = sources.files.iter().map(|file| paths(&file.code));
        let paths = paths.collect();
        Self { sources, paths }
    }

    /// The file that defines what the path in `file` names, if that is of this crate.
    ///
    /// `None` also for a module that a `use` brings in: what is then named through it counts.
    pub(crate) fn definition(&self, file: usize, path: &Path) -> Option<usize> {
        let module = &self.sources.files[file].module;
        let is_own = |found: &(usize, bool)| found.0 != file;
        let found = self.resolve(module, &path.segments, 0).filter(is_own)?;
        let (definition, is_module) = found;
        (path.place == Place::Inline || !is_module).then_some(definition)
    }

    /// The path with what the file's own `use` lines stand for put in.
    pub(crate) fn written_out(&self, file: usize, path: &Path) -> Vec<String> {
        let first = &path.segments[0];
        let import = self
            .import(file, first)
            .filter(|_| path.place == Place::Inline);
        match import {
            Some(import) => [&import.segments[..], &path.segments[1..]].concat(),
            None => path.segments.clone(),
        }
    }

    fn import(&self, file: usize, name: &str) -> Option<&Path> {
        self.paths[file]
            .iter()
            .find(|path| path.name() == Some(name))
    }

    /// The file that a path leads to from a module, and whether it names that file's module itself.
    fn resolve(&self, from: &[String], path: &[String], depth: usize) -> Option<(usize, bool)> {
        let (first, rest) = path.split_first().filter(|_| depth < DEEPEST)?;
        match first.as_str() {
            "crate" => self.below(&[], rest, depth),
            "self" => self.below(from, rest, depth),
            "super" => self.in_parent(from, rest, depth),
            _ => {
                let child = [from, std::slice::from_ref(first)].concat();
                let here = self.sources.file_of(from)?;
                let import = self.import(here, first);
                // `use cache::x` in the module that declares `cache` goes down; a name that a `use`
                // brings in goes where that leads, unless it is this very path.
                match import.filter(|import| import.segments != path) {
                    _ if self.sources.file_of(&child).is_some() => self.below(&child, rest, depth),
                    Some(import) => {
                        let path = [&import.segments[..], rest].concat();
                        self.resolve(from, &path, depth + 1)
                    }
                    None => None,
                }
            }
        }
    }

    fn in_parent(&self, from: &[String], path: &[String], depth: usize) -> Option<(usize, bool)> {
        let parent = &from[..from.len().checked_sub(1)?];
        match path.first().map(String::as_str) {
            Some("super") => self.in_parent(parent, &path[1..], depth),
            _ => self.below(parent, path, depth),
        }
    }

    /// As [`Self::resolve`], for what a module has.
    fn below(&self, module: &[String], path: &[String], depth: usize) -> Option<(usize, bool)> {
        let file = self.sources.file_of(module)?;
        let Some((first, rest)) = path.split_first() else {
            return Some((file, true));
        };
        let child = [module, std::slice::from_ref(first)].concat();
        if self.sources.file_of(&child).is_some() {
            return self.below(&child, rest, depth);
        }
        if depth < DEEPEST
            && let Some(import) = self.import(file, first)
        {
            let path = [&import.segments[..], rest].concat();
            if let Some(found) = self.resolve(module, &path, depth + 1) {
                return Some(found);
            }
        }
        let through_glob = self.paths[file].iter().find_map(|glob| {
            let inside = glob.segments.strip_suffix(&["*".to_owned()])?;
            let (found, _) = self.resolve(module, inside, depth + 1)?;
            defines(&self.sources.files[found], first).then_some((found, false))
        });
        Some(through_glob.unwrap_or((file, false)))
    }
}

/// Whether the file has an item of this name.
fn defines(file: &Source, name: &str) -> bool {
    const KINDS: [&str; 8] = [
        "fn", "struct", "enum", "trait", "type", "const", "static", "union",
    ];
    let tokens = tokens(&file.code);
    tokens
        .windows(2)
        .any(|pair| KINDS.contains(&pair[0]) && pair[1] == name)
}

/// The structs, enums and traits that the code defines.
pub(crate) fn types(code: &str) -> Vec<String> {
    let tokens = tokens(code);
    let pairs = tokens.windows(2);
    let is_type = |pair: &&[&str]| ["struct", "enum", "trait"].contains(&pair[0]);
    pairs
        .filter(is_type)
        .map(|pair| pair[1].to_owned())
        .collect()
}

#[test]
fn every_path_of_a_file_is_found() {
    let code = "use a::{self, b::{C, d as e}, f::*};
        pub(in crate::x) use super::super::G;
        pub use self::h::I;
        fn f(x: crate::j::K) -> l::M { x.n.o::<P>(); <Q as r::S>::t::u(); v::<w::X>() }";
    let found = paths(code);
    let text = |path: &Path| path.segments.join("::");
    let all: Vec<String> = found.iter().map(text).collect();
    let expected = [
        "a",
        "a::b::C",
        "a::b::d",
        "a::f::*",
        "super::super::G",
        "self::h::I",
        "crate::j::K",
        "l::M",
        "P",
        "Q",
        "r::S",
        "w::X",
    ];
    assert_eq!(all, expected);
    let public = found.iter().filter(|path| path.is_re_export());
    let public: Vec<String> = public.map(text).collect();
    assert_eq!(public, ["super::super::G", "self::h::I"]);
    assert_eq!(found[2].name(), Some("e"));
}

#[test]
fn types_are_found() {
    let code = "pub struct A(u8); enum B {} pub(crate) trait C {} fn d() {} impl A {}";
    assert_eq!(types(code), ["A", "B", "C"]);
}
