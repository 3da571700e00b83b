//! A crate's sources as the checks see them: what is built into it, without comments, unit tests
//! and the text of strings.

use std::ops::Range;
use std::path::Path;

/// The files of one crate.
pub(crate) struct Sources {
    pub(crate) files: Vec<Source>,
}

/// One file of code.
pub(crate) struct Source {
    /// Its path below `src`, with `/` between folders.
    pub(crate) name: String,
    /// The path of its module: empty for the root.
    pub(crate) module: Vec<String>,
    /// Its text as it is.
    pub(crate) text: String,
    /// The text with blanks in place of comments, strings and unit tests.
    pub(crate) code: String,
    /// The strings of the code.
    pub(crate) strings: Vec<String>,
}

impl Sources {
    /// The files below a folder.
    pub(crate) fn read(root: &Path) -> Self {
        Self::of(texts(root))
    }

    /// Files that are not on disk, to try a check on.
    pub(crate) fn planted(files: &[(&str, &str)]) -> Self {
        let files = files.iter();
        Self::of(files.map(|(name, text)| ((*name).to_owned(), (*text).to_owned())))
    }

    fn of(files: impl IntoIterator<Item = (String, String)>) -> Self {
        let (mut kept, mut test_modules) = (Vec::new(), Vec::new());
        for (name, text) in files {
            let (source, tests) = Source::new(name, text);
            test_modules.extend(tests);
            kept.push(source);
        }
        // What is declared for tests only is not part of the crate, and neither is what is below.
        kept.retain(|source| {
            let is_test = |test: &Vec<String>| source.module.starts_with(test);
            !test_modules.iter().any(is_test)
        });
        kept.sort_by(|a, b| a.name.cmp(&b.name));
        Self { files: kept }
    }

    /// The file of a module, if there is such a module.
    pub(crate) fn file_of(&self, module: &[String]) -> Option<usize> {
        self.files.iter().position(|source| source.module == module)
    }
}

/// The Rust files below a folder, by name, and their texts.
pub(crate) fn texts(root: &Path) -> Vec<(String, String)> {
    let (mut folders, mut files) = (vec![root.to_owned()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let below = path.strip_prefix(root).unwrap().iter();
                let parts: Vec<_> = below.map(|part| part.to_string_lossy()).collect();
                files.push((parts.join("/"), text));
            }
        }
    }
    assert!(
        !files.is_empty(),
        "the sources in {} are found",
        root.display()
    );
    files
}

impl Source {
    /// Also gives the modules that it declares for tests only.
    fn new(name: String, text: String) -> (Self, Vec<Vec<String>>) {
        let module = module_path(&name);
        let (mut code, strings) = without_comments_and_strings(&text);
        let (tests, test_modules) = test_items(&code);
        for range in &tests {
            blank(&mut code, range.clone());
        }
        let is_built = |at: usize| !tests.iter().any(|range| range.contains(&at));
        let strings = strings.into_iter();
        let strings = strings.filter_map(|(at, string)| is_built(at).then_some(string));

        let below = |name: String| [&module[..], &[name]].concat();
        let test_modules = test_modules.into_iter().map(below).collect();
        let source = Self {
            module,
            strings: strings.collect(),
            name,
            text,
            code: String::from_utf8(code).unwrap(),
        };
        (source, test_modules)
    }

    /// The module directly below the root that it belongs to; empty for the root itself.
    pub(crate) fn room(&self) -> &str {
        self.module.first().map_or("", String::as_str)
    }
}

/// `order/search/mod.rs` is the module `order::search`, `main.rs` and `lib.rs` the root.
fn module_path(name: &str) -> Vec<String> {
    let name = name.strip_suffix(".rs").unwrap_or(name);
    let mut parts: Vec<String> = name.split('/').map(str::to_owned).collect();
    if matches!(parts.last().map(String::as_str), Some("mod")) {
        parts.pop();
    }
    match parts.join("/").as_str() {
        "lib" | "main" => Vec::new(),
        _ => parts,
    }
}

fn blank(code: &mut [u8], range: Range<usize>) {
    for byte in &mut code[range] {
        if *byte != b'\n' {
            *byte = b' ';
        }
    }
}

/// The text with blanks for comments and for what stands in strings, and the strings with their
/// places. As long as the text, so that places mean the same in both.
fn without_comments_and_strings(text: &str) -> (Vec<u8>, Vec<(usize, String)>) {
    let mut code = text.as_bytes().to_vec();
    let (mut strings, mut at) = (Vec::new(), 0);
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        let in_word = at > 0 && is_word(text.as_bytes()[at - 1]);
        let length = if rest.starts_with(b"//") {
            rest.iter().position(|&byte| byte == b'\n')
        } else if rest.starts_with(b"/*") {
            Some(block_comment(rest))
        } else if let Some((inside, length)) = string(rest, in_word) {
            strings.push((at, String::from_utf8_lossy(&rest[inside]).into_owned()));
            Some(length)
        } else if let Some(length) = text.get(at..).and_then(character) {
            Some(length)
        } else {
            at += 1;
            continue;
        };
        let end = at + length.unwrap_or(rest.len());
        blank(&mut code, at..end);
        at = end;
    }
    (code, strings)
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// The length of a comment that may hold others.
fn block_comment(text: &[u8]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < text.len() {
        let pair = &text[at..text.len().min(at + 2)];
        depth = match pair {
            b"/*" => depth + 1,
            b"*/" => depth - 1,
            _ => {
                at += 1;
                continue;
            }
        };
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// Where the inside of a string stands, and the length of all of it, if `text` starts with one.
fn string(text: &[u8], in_word: bool) -> Option<(Range<usize>, usize)> {
    let prefixes: [&[u8]; 6] = [b"br", b"cr", b"r", b"b", b"c", b""];
    let prefix = prefixes
        .into_iter()
        .find(|&prefix| text.starts_with(prefix))?;
    if in_word && !prefix.is_empty() {
        return None;
    }
    let is_raw = prefix.ends_with(b"r");
    let hashes = text[prefix.len()..]
        .iter()
        .take_while(|&&b| b == b'#')
        .count();
    let open = prefix.len() + hashes + 1;
    if text.get(open - 1) != Some(&b'"') || (hashes > 0 && !is_raw) {
        return None;
    }

    let mut at = open;
    while at < text.len() {
        match text[at] {
            b'\\' if !is_raw => at += 1,
            b'"' if text[at + 1..].iter().take_while(|&&b| b == b'#').count() >= hashes => {
                return Some((open..at, at + 1 + hashes));
            }
            _ => {}
        }
        at += 1;
    }
    Some((open..text.len(), text.len()))
}

/// The length of a character in quotes; a lifetime is none.
fn character(text: &str) -> Option<usize> {
    let mut characters = text.strip_prefix('\'')?.chars();
    match characters.next()? {
        '\\' => Some(4 + text.get(3..)?.find('\'')?),
        first => (characters.next()? == '\'').then_some(2 + first.len_utf8()),
    }
}

/// Where items for tests stand, and the names of modules among them that have a file of their own.
fn test_items(code: &[u8]) -> (Vec<Range<usize>>, Vec<String>) {
    const MARK: &str = "#[cfg(test)]";
    let text = std::str::from_utf8(code).unwrap();
    let (mut ranges, mut modules) = (Vec::new(), Vec::new());
    for (start, _) in text.match_indices(MARK) {
        let after = start + MARK.len();
        let end = after + item_length(&code[after..]);
        ranges.push(start..end);
        let item = text[after..end].trim().strip_suffix(';');
        let words: Vec<&str> = item.unwrap_or_default().split_whitespace().collect();
        if let [.., "mod", name] = words[..] {
            modules.push(name.to_owned());
        }
    }
    (ranges, modules)
}

/// The length of an item: to its semicolon, or to the end of its braces.
fn item_length(code: &[u8]) -> usize {
    let (mut depth, mut in_braces) = (0, false);
    for (at, byte) in code.iter().enumerate() {
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth -= 1,
            _ => {}
        }
        in_braces |= *byte == b'{' && depth == 1;
        if depth == 0 && (*byte == b';' || (*byte == b'}' && in_braces)) {
            return at + 1;
        }
    }
    code.len()
}

#[test]
fn only_code_that_is_built_is_left() {
    let text = r##"//! use crate::a;
use crate::b; // use crate::c;
/* use crate::d; /* nested */ use crate::e; */
const TEXT: (&str, &str) = ("use \" crate::f;", r#"--"flag"#);
const QUOTE: [char; 3] = ['"', '\'', '…'];
fn lifetime<'a>(x: &'a str) -> &'a str { x }
#[cfg(test)]
use crate::g;
#[cfg(test)]
mod oracle;
#[cfg(test)]
mod tests {
    fn f() { let x = "--test"; }
}
fn last() {}
"##;
    let sources = Sources::planted(&[("a.rs", text), ("a/oracle.rs", ""), ("a/x/mod.rs", "")]);
    let names: Vec<&str> = sources.files.iter().map(|file| &*file.name).collect();
    assert_eq!(names, ["a.rs", "a/x/mod.rs"]);
    assert_eq!(sources.files[1].module, ["a", "x"]);
    let file = &sources.files[0];
    assert_eq!(file.strings, [r#"use \" crate::f;"#, r#"--"flag"#]);
    let words: Vec<&str> = file.code.split_whitespace().collect();
    let expected = "use crate::b; const TEXT: (&str, &str) = ( , ); const QUOTE: [char; 3] = [ , , ]; \
        fn lifetime<'a>(x: &'a str) -> &'a str { x } fn last() {}";
    assert_eq!(words.join(" "), expected);
}
