//! Values added at the ends of a JSON text's arrays and objects; what was there keeps its place.

use std::ops::Range;

use serde_json::value::RawValue;

use super::json::Value;
use super::object::Object;
use crate::files::error::{FileErrorKind, Place, Problem};

/// New text for a part of a text; an empty part stands where the new text is inserted.
pub(super) type Splice = (Range<usize>, String);

/// Values to be added, in this order.
#[derive(Debug, Default)]
pub(super) struct Additions {
    values: Vec<Addition>,
}

#[derive(Debug)]
struct Addition {
    /// The names and numbers on the way to it; `-` is the end of an array.
    path: Vec<String>,
    json: String,
}

impl Additions {
    /// Adds an element to the array of the root with this name.
    pub(super) fn element(&mut self, array: &str, json: String) {
        self.value([array, "-"], json);
    }

    pub(super) fn value<'a>(&mut self, path: impl IntoIterator<Item = &'a str>, json: String) {
        let path = path.into_iter().map(str::to_owned).collect();
        self.values.push(Addition { path, json });
    }

    /// Adds what a caller wrote.
    ///
    /// # Errors
    /// The pointer is not one, or the text is not JSON.
    pub(super) fn written(&mut self, pointer: &str, json: &str) -> Result<(), Problem> {
        let place = || Place::Json(pointer.to_owned());
        let Some(path) = pointer.strip_prefix('/') else {
            let text = "a pointer to a new value starts with a slash";
            return Err(FileErrorKind::unsupported(text).at(place()));
        };
        if let Err(error) = serde_json::from_str::<&RawValue>(json) {
            let text = format!("the new value is not JSON: {error}");
            return Err(FileErrorKind::unsupported(text).at(place()));
        }
        // RFC 6901: two characters have a meaning of their own in a pointer.
        let path = path
            .split('/')
            .map(|part| part.replace("~1", "/").replace("~0", "~"));
        let path: Vec<String> = path.collect();
        let names: Vec<&str> = path.iter().map(String::as_str).collect();
        if let ["buffers"] | ["buffers", "-", ..] | ["buffers", _, "uri" | "byteLength", ..] =
            names[..]
        {
            let text = "what a buffer holds cannot be added as a value: add a mesh";
            return Err(FileErrorKind::unsupported(text).at(place()));
        }
        self.values.push(Addition {
            path,
            json: json.to_owned(),
        });
        Ok(())
    }

    /// The places and texts that add all values to the text of `root`.
    ///
    /// # Errors
    /// There is a value already, or no place for one.
    pub(super) fn splices(&self, root: &Object) -> Result<Vec<Splice>, Problem> {
        let values: Vec<Pending<'_>> = self.values.iter().map(Pending::of).collect();
        let mut splices = Vec::new();
        add_to_object(root.as_value(), "", &values, &mut splices)?;
        splices.sort_by_key(|(span, _)| span.start);
        Ok(splices)
    }
}

/// A value to be added, and the rest of the way to it.
#[derive(Clone, Copy)]
struct Pending<'a> {
    path: &'a [String],
    json: &'a str,
}

impl<'a> Pending<'a> {
    fn of(addition: &'a Addition) -> Self {
        Self {
            path: &addition.path,
            json: &addition.json,
        }
    }

    /// The next name on the way, and the value with what is left of the way.
    fn step(self) -> (&'a str, Self) {
        let (name, path) = self.path.split_first().expect("the way goes on");
        (name, Self { path, ..self })
    }

    fn is_there(self) -> bool {
        self.path.is_empty()
    }
}

/// Values by the next name on their way, in the order in which the names first come.
fn by_name<'a>(parts: &[Pending<'a>]) -> Vec<(&'a str, Vec<Pending<'a>>)> {
    let mut groups: Vec<(&str, Vec<Pending<'a>>)> = Vec::new();
    let mut number_of = std::collections::BTreeMap::new();
    for part in parts {
        let (name, rest) = part.step();
        let number = *number_of.entry(name).or_insert_with(|| {
            groups.push((name, Vec::new()));
            groups.len() - 1
        });
        groups[number].1.push(rest);
    }
    groups
}

fn add(
    value: Value<'_>,
    pointer: &str,
    parts: &[Pending<'_>],
    splices: &mut Vec<Splice>,
) -> Result<(), Problem> {
    if parts.iter().any(|part| part.is_there()) {
        return refused(pointer, "there is a value already, which is not replaced");
    }
    if value.is_array() {
        add_to_array(value, pointer, parts, splices)
    } else if value.is_object() {
        add_to_object(value, pointer, parts, splices)
    } else {
        let text = format!("nothing can be added to {}", value.kind());
        refused(pointer, text)
    }
}

fn add_to_array(
    array: Value<'_>,
    pointer: &str,
    parts: &[Pending<'_>],
    splices: &mut Vec<Splice>,
) -> Result<(), Problem> {
    let mut new = Vec::new();
    let elements: Vec<Value<'_>> = array.elements().collect();
    for (name, parts) in by_name(parts) {
        let pointer = format!("{pointer}/{name}");
        if name == "-" {
            new.extend(each_alone(&pointer, &parts)?);
            continue;
        }
        let number = name.parse().ok().filter(|i: &usize| i.to_string() == name);
        let Some(&element) = number.and_then(|i| elements.get(i)) else {
            let count = elements.len();
            let text = format!("there are {count} elements here; - adds one after the last");
            return refused(&pointer, text);
        };
        add(element, &pointer, &parts, splices)?;
    }
    insert(array, new, splices);
    Ok(())
}

fn add_to_object(
    object: Value<'_>,
    pointer: &str,
    parts: &[Pending<'_>],
    splices: &mut Vec<Splice>,
) -> Result<(), Problem> {
    let mut new = Vec::new();
    for (name, parts) in by_name(parts) {
        let pointer = format!("{pointer}/{}", name.replace('~', "~0").replace('/', "~1"));
        match object.get(name) {
            Some(member) => add(member, &pointer, &parts, splices)?,
            None => {
                let name = serde_json::Value::from(name);
                new.push(format!("{name}:{}", made(&pointer, &parts)?));
            }
        }
    }
    insert(object, new, splices);
    Ok(())
}

/// The text of what is not there yet: a value, or what holds these values.
fn made(pointer: &str, parts: &[Pending<'_>]) -> Result<String, Problem> {
    if let [part] = parts
        && part.is_there()
    {
        return Ok(part.json.to_owned());
    }
    if parts.iter().any(|part| part.is_there()) {
        return refused(pointer, "two values are added at one place");
    }

    let groups = by_name(parts);
    if let [("-", elements)] = &groups[..] {
        let elements = each_alone(&format!("{pointer}/-"), elements)?;
        return Ok(format!("[{}]", elements.join(",")));
    }
    let mut members = Vec::new();
    for (name, parts) in groups {
        let pointer = format!("{pointer}/{name}");
        let name = serde_json::Value::from(name);
        members.push(format!("{name}:{}", made(&pointer, &parts)?));
    }
    Ok(format!("{{{}}}", members.join(",")))
}

/// The texts of new elements: each `-` is an element of its own.
fn each_alone(pointer: &str, parts: &[Pending<'_>]) -> Result<Vec<String>, Problem> {
    let text = |part: &Pending<'_>| made(pointer, std::slice::from_ref(part));
    parts.iter().map(text).collect()
}

/// Puts texts after the last value that an array or object holds.
fn insert(holder: Value<'_>, new: Vec<String>, splices: &mut Vec<Splice>) {
    if new.is_empty() {
        return;
    }
    let (end, is_empty) = holder.inner_end();
    let comma = if is_empty { "" } else { "," };
    splices.push((end..end, format!("{comma}{}", new.join(","))));
}

fn refused<T>(pointer: &str, text: impl Into<String>) -> Result<T, Problem> {
    Err(FileErrorKind::unsupported(text).at(Place::Json(pointer.to_owned())))
}

/// The text with these parts replaced; they rise and do not overlap.
pub(super) fn spliced(text: &[u8], splices: &[Splice]) -> Vec<u8> {
    let added: usize = splices.iter().map(|(_, new)| new.len()).sum();
    let mut out = Vec::with_capacity(text.len() + added);
    let mut copied = 0;
    for (span, new) in splices {
        out.extend_from_slice(&text[copied..span.start]);
        out.extend_from_slice(new.as_bytes());
        copied = span.end;
    }
    out.extend_from_slice(&text[copied..]);
    out
}

#[cfg(test)]
mod tests {
    use super::super::json::Json;
    use super::*;
    use crate::limits::Limits;

    fn with(text: &str, values: &[(&str, &str)]) -> Result<String, String> {
        let json = Json::read(text.as_bytes(), &Limits::default())
            .unwrap_or_else(|_| panic!("{text} is sound"));
        let root = Object::new(json.root(), String::new()).map_err(|p| p.kind.to_string())?;
        let mut additions = Additions::default();
        let told = |p: Problem| format!("{}: {}", p.place, p.kind);
        for (pointer, json) in values {
            additions.written(pointer, json).map_err(told)?;
        }
        let splices = additions.splices(&root).map_err(told)?;
        Ok(String::from_utf8(spliced(text.as_bytes(), &splices)).unwrap())
    }

    #[test]
    fn values_go_to_the_ends() {
        let text = r#" {"a": [1, {"b" : 2 } ] , "c":{ }, "d":[ ]} "#;
        let values = [
            ("/a/-", "3"),
            ("/c/x", "\"y\""),
            ("/d/-", "[]"),
            ("/a/-", "4"),
            ("/a/1/e~1f", "5"),
            ("/g/-", "6"),
            ("/g/-", "7"),
            ("/h/i/j", "8"),
            ("/h/i/k", "9"),
            ("/l/-/m", "0"),
        ];
        let expected = concat!(
            r#" {"a": [1, {"b" : 2,"e/f":5 },3,4 ] , "c":{"x":"y" }, "d":[[] ],"#,
            r#""g":[6,7],"h":{"i":{"j":8,"k":9}},"l":[{"m":0}]} "#,
        );
        assert_eq!(with(text, &values).unwrap(), expected);
        assert_eq!(with(text, &[]).unwrap(), text);
    }

    #[test]
    fn nothing_is_replaced_and_every_refusal_says_where() {
        let text = r#"{"a": [1], "b": {}, "a~": 0}"#;
        for (values, expected) in [
            (&[("/b", "1")][..], "/b: there is a value already"),
            (
                &[("/a/1", "1")],
                "/a/1: there are 1 elements here; - adds one after the last",
            ),
            (&[("/a/x", "1")], "/a/x: there are 1 elements here"),
            (&[("/a/00/y", "1")], "/a/00: there are 1 elements here"),
            (&[("/a/+0/y", "1")], "/a/+0: there are 1 elements here"),
            (
                &[("/buffers/-", "{}")],
                "/buffers/-: what a buffer holds cannot be added as a value",
            ),
            (
                &[("/buffers/0/uri", "\"a\"")],
                "/buffers/0/uri: what a buffer holds",
            ),
            (&[("/a/0/x", "1")], "/a/0: nothing can be added to 1"),
            (&[("/a~0/x", "1")], "/a~0: nothing can be added to 0"),
            (&[("/c", "1"), ("/c", "2")], "/c: two values are added"),
            (&[("/c", "1"), ("/c/d", "2")], "/c: two values are added"),
            (&[("b", "1")], "b: a pointer to a new value starts with"),
            (&[("", "1")], ": a pointer to a new value starts with"),
            (&[("/c", "1 2")], "/c: the new value is not JSON"),
            (&[("/c", "")], "/c: the new value is not JSON"),
        ] {
            let refused = with(text, values).unwrap_err();
            assert!(refused.starts_with(expected), "{refused}");
        }
    }
}
