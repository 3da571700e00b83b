//! The JSON of a glTF file, kept as text: where each value starts, eight bytes a value.
//!
//! A tree of owned values can take ninety times the text, if the text was made for that. Here
//! nothing is copied before it is asked for, so memory stays below a few times the text.

use std::borrow::Cow;
use std::ops::Range;

use serde_json::value::RawValue;

use crate::files::error::FileErrorKind;
use crate::limits::Limits;

/// A JSON text and the places of its values.
pub(super) struct Json<'a> {
    text: &'a [u8],
    /// Values and names in the order of the text.
    nodes: Vec<Node>,
}

/// A value, or the name of a member.
struct Node {
    /// Its first byte in the text, which tells its kind.
    start: u32,
    /// The node after all that it holds.
    next: u32,
}

/// What is wrong with a text as a whole.
pub(super) enum JsonFault {
    Syntax(String),
    Kind(FileErrorKind),
}

impl<'a> Json<'a> {
    /// Checks a text and finds its values.
    pub(super) fn read(text: &'a [u8], limits: &Limits) -> Result<Self, JsonFault> {
        if u32::try_from(text.len()).is_err() {
            return Err(JsonFault::Kind(FileErrorKind::OverLimit {
                what: "bytes of JSON",
                found: text.len() as u64,
                limit: u64::from(u32::MAX),
            }));
        }
        // The library's parser judges; what follows may rely on sound JSON.
        serde_json::from_slice::<&RawValue>(text)
            .map_err(|error| JsonFault::Syntax(error.to_string()))?;
        let nodes = nodes(text, limits.nesting).map_err(JsonFault::Kind)?;
        Ok(Self { text, nodes })
    }

    /// The value that the whole text is.
    pub(super) fn root(&self) -> Value<'_> {
        Value {
            json: self,
            node: 0,
        }
    }
}

/// Finds the nodes of sound JSON text.
fn nodes(text: &[u8], nesting: usize) -> Result<Vec<Node>, FileErrorKind> {
    // The text is shorter than 4 GiB, and has no more nodes than bytes.
    let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let mut nodes: Vec<Node> = Vec::new();
    let mut open = Vec::new();

    let mut at = 0;
    while let Some(&byte) = text.get(at) {
        let start = at;
        at += 1;
        match byte {
            b' ' | b'\t' | b'\n' | b'\r' | b',' | b':' => continue,
            b'}' | b']' => {
                let end = number(nodes.len());
                if let Some(container) = open.pop().and_then(|node: usize| nodes.get_mut(node)) {
                    container.next = end;
                }
                continue;
            }
            b'{' | b'[' => {
                open.push(nodes.len());
                if open.len() > nesting {
                    return Err(FileErrorKind::OverLimit {
                        what: "levels of JSON inside each other",
                        found: open.len() as u64,
                        limit: nesting as u64,
                    });
                }
            }
            b'"' => at = string_end(text, start),
            _ => at = word_end(text, start),
        }
        nodes.push(Node {
            start: number(start),
            next: number(nodes.len() + 1),
        });
    }
    Ok(nodes)
}

/// The byte after a string that starts at `start`.
pub(super) fn string_end(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while let Some(&byte) = text.get(at) {
        match byte {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    text.len()
}

/// What the string that starts at byte `start` of sound JSON says.
pub(super) fn string_at(text: &[u8], start: usize) -> Option<Cow<'_, str>> {
    let quoted = &text[start..string_end(text, start)];
    let inner = quoted.get(1..quoted.len() - 1)?;
    if inner.contains(&b'\\') {
        return serde_json::from_slice(quoted).ok().map(Cow::Owned);
    }
    std::str::from_utf8(inner).ok().map(Cow::Borrowed)
}

/// The byte after a number, `true`, `false` or `null`.
fn word_end(text: &[u8], start: usize) -> usize {
    let ends = |byte: &u8| b",:]}[{\" \t\r\n".contains(byte);
    let rest = &text[start..];
    start + rest.iter().position(ends).unwrap_or(rest.len())
}

/// A value in the text.
#[derive(Clone, Copy)]
pub(super) struct Value<'a> {
    json: &'a Json<'a>,
    node: u32,
}

impl<'a> Value<'a> {
    fn node(self) -> &'a Node {
        &self.json.nodes[self.node as usize]
    }

    fn at(self, node: u32) -> Self {
        Self {
            json: self.json,
            node,
        }
    }

    fn first_byte(self) -> u8 {
        self.json.text[self.node().start as usize]
    }

    /// Where it starts in the text.
    pub(super) fn start(self) -> u32 {
        self.node().start
    }

    /// Where a string or number stands in the text, quotes included.
    pub(super) fn span(self) -> Range<usize> {
        let start = self.node().start as usize;
        let end = match self.first_byte() {
            b'"' => string_end(self.json.text, start),
            b'{' | b'[' => start + 1,
            _ => word_end(self.json.text, start),
        };
        start..end
    }

    /// The byte after it.
    fn end(self) -> usize {
        match self.first_byte() {
            b'{' | b'[' => {
                let (end, _) = self.inner_end();
                let rest = &self.json.text[end..];
                let close = rest.iter().position(|byte| b"]}".contains(byte));
                end + close.map_or(0, |blank| blank + 1)
            }
            _ => self.span().end,
        }
    }

    /// The byte after the last value that an array or object holds; of an empty one, the byte after
    /// its bracket, and `true`.
    pub(super) fn inner_end(self) -> (usize, bool) {
        let members = self.named_nodes().map(|(_, value)| value);
        match members.chain(self.elements()).last() {
            Some(last) => (last.end(), false),
            None => (self.node().start as usize + 1, true),
        }
    }

    /// Its text, as it stands there.
    pub(super) fn raw(self) -> &'a str {
        let text = &self.json.text[self.node().start as usize..self.end()];
        std::str::from_utf8(text).unwrap_or_default()
    }

    pub(super) fn is_object(self) -> bool {
        self.first_byte() == b'{'
    }

    pub(super) fn is_array(self) -> bool {
        self.first_byte() == b'['
    }

    /// The text of a string.
    pub(super) fn text(self) -> Option<Cow<'a, str>> {
        if self.first_byte() != b'"' {
            return None;
        }
        string_at(self.json.text, self.node().start as usize)
    }

    /// Whether it is the truth value `true`.
    pub(super) fn is_true(self) -> bool {
        self.first_byte() == b't'
    }

    /// The value as a whole number that can count bytes in memory.
    ///
    /// JSON does not tell `36.0` from `36`, and some exporters write the former.
    pub(super) fn whole(self) -> Option<usize> {
        let byte = self.first_byte();
        if !byte.is_ascii_digit() && byte != b'-' {
            return None;
        }
        let digits = std::str::from_utf8(&self.json.text[self.span()]).ok()?;
        if let Ok(number) = digits.parse::<u64>() {
            return usize::try_from(number).ok();
        }
        let number: f64 = digits.parse().ok()?;
        // Up to here every whole number is exact.
        let exact = number.fract() == 0.0 && (0.0..=9_007_199_254_740_992.0).contains(&number);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole and in range"
        )]
        exact
            .then_some(number as u64)
            .and_then(|n| n.try_into().ok())
    }

    /// The elements of an array; none of anything else.
    pub(super) fn elements(self) -> impl Iterator<Item = Self> {
        let end = match self.is_array() {
            true => self.node().next,
            false => 0,
        };
        let mut node = self.node + 1;
        std::iter::from_fn(move || {
            let element = self.at(node);
            (node < end).then(|| {
                node = element.node().next;
                element
            })
        })
    }

    /// The members of an object; none of anything else.
    pub(super) fn members(self) -> impl Iterator<Item = (Cow<'a, str>, Self)> {
        self.named_nodes()
            .map(|(name, value)| (name.text().unwrap_or_default(), value))
    }

    /// The members of an object, each with the node of its name.
    pub(super) fn named_nodes(self) -> impl Iterator<Item = (Self, Self)> {
        let end = match self.is_object() {
            true => self.node().next,
            false => 0,
        };
        let mut node = self.node + 1;
        std::iter::from_fn(move || {
            (node < end).then(|| {
                let (name, value) = (self.at(node), self.at(node + 1));
                node = value.node().next;
                (name, value)
            })
        })
    }

    /// The member of an object with this name: the last, if there are several.
    pub(super) fn get(self, name: &str) -> Option<Self> {
        let mut found = None;
        for (member, value) in self.named_nodes() {
            if member.text().is_some_and(|text| text == name) {
                found = Some(value);
            }
        }
        found
    }

    /// What it is, for error messages.
    pub(super) fn kind(self) -> String {
        match self.first_byte() {
            b'{' => "an object".into(),
            b'[' => "an array".into(),
            b'"' => "a string".into(),
            b'n' => "null".into(),
            b't' | b'f' => "a truth value".into(),
            _ => String::from_utf8_lossy(&self.json.text[self.span()]).into_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Json<'_> {
        let read = Json::read(text.as_bytes(), &Limits::default());
        read.unwrap_or_else(|_| panic!("{text}"))
    }

    #[test]
    fn whole_numbers_may_be_written_with_a_point() {
        let whole = |text: &str| read(text).root().whole();
        for good in ["36", "36.0", "3.6e1"] {
            assert_eq!(whole(good), Some(36), "{good}");
        }
        for bad in ["-1", "0.5", "1e300", "\"1\"", "null", "[]"] {
            assert_eq!(whole(bad), None, "{bad}");
        }
    }

    #[test]
    fn values_are_those_of_the_library() {
        let text = r#" { "a" : [1, -2.5e3, true, {"x":[[],{}]}, "s\"]}\u00e9"], "b":{},
            "\u0061": null, "" :"" } "#;
        let json = read(text);
        let of = |text: &str| -> serde_json::Value { serde_json::from_str(text).unwrap() };
        assert_eq!(of(&shown(json.root())), of(text));
    }

    /// The value as text, the last of members with one name.
    fn shown(value: Value<'_>) -> String {
        if value.is_object() {
            let members: std::collections::BTreeMap<String, String> = value
                .members()
                .map(|(name, value)| (name.into_owned(), shown(value)))
                .collect();
            let members: Vec<String> = members
                .into_iter()
                .map(|(name, value)| format!("{}:{value}", serde_json::Value::from(name)))
                .collect();
            return format!("{{{}}}", members.join(","));
        }
        if value.is_array() {
            let elements: Vec<String> = value.elements().map(shown).collect();
            return format!("[{}]", elements.join(","));
        }
        let value: serde_json::Value = match value.text() {
            Some(text) => text.into(),
            None => serde_json::from_slice(&value.json.text[value.span()]).unwrap(),
        };
        value.to_string()
    }

    #[test]
    fn the_text_of_a_value_ends_with_it() {
        let text = r#"{"a" : [ 1 , {"x]": [ ] } ] , "b" : "}" , "c": {} }"#;
        let json = read(text);
        let raw = |name| json.root().get(name).map(Value::raw);
        assert_eq!(raw("a"), Some(r#"[ 1 , {"x]": [ ] } ]"#));
        assert_eq!((raw("b"), raw("c")), (Some(r#""}""#), Some("{}")));
        assert_eq!(json.root().raw(), text);
    }

    #[test]
    fn the_last_of_two_members_counts() {
        let json = read(r#"{"a":1,"b":{"a":5},"\u0061":2}"#);
        assert_eq!(json.root().get("a").and_then(Value::whole), Some(2));
    }

    #[test]
    fn depth_is_limited() {
        let deep = |depth: usize| "[".repeat(depth) + &"]".repeat(depth);
        let limits = Limits::default();
        assert!(Json::read(deep(limits.nesting).as_bytes(), &limits).is_ok());
        for depth in [limits.nesting + 1, 1_000_000] {
            let text = deep(depth);
            let fault = Json::read(text.as_bytes(), &limits);
            assert!(matches!(
                fault,
                Err(JsonFault::Kind(FileErrorKind::OverLimit { .. }))
            ));
        }
    }

    #[test]
    fn broken_text_is_refused() {
        for text in ["", "{", "[1,]", "{\"a\" 1}", "nul", "\"\\x\"", "[] []"] {
            let fault = Json::read(text.as_bytes(), &Limits::default());
            assert!(matches!(fault, Err(JsonFault::Syntax(_))), "{text}");
        }
        assert!(Json::read(b"\"\xff\"", &Limits::default()).is_err());
    }
}
