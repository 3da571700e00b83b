//! The JSON of a glTF file, read field by field with the place of every fault.

use serde_json::{Map, Value};

use crate::files::error::{FileErrorKind, Place, Problem};

/// An object and the JSON pointer to it.
pub(super) struct Object<'a> {
    fields: &'a Map<String, Value>,
    pointer: String,
}

impl<'a> Object<'a> {
    pub(super) fn new(value: &'a Value, pointer: String) -> Result<Self, Problem> {
        match value {
            Value::Object(fields) => Ok(Self { fields, pointer }),
            other => Err(malformed(
                pointer,
                format!("expected an object, found {}", kind_of(other)),
            )),
        }
    }

    pub(super) fn pointer(&self) -> &str {
        &self.pointer
    }

    /// The pointer to a field of this object.
    pub(super) fn pointer_to(&self, name: &str) -> String {
        // RFC 6901: these two characters have a meaning of their own in a pointer.
        let name = name.replace('~', "~0").replace('/', "~1");
        format!("{}/{name}", self.pointer)
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.fields.contains_key(name)
    }

    /// A field of any kind.
    pub(super) fn value(&self, name: &str) -> Option<&'a Value> {
        self.fields.get(name)
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &'a str> {
        self.fields.keys().map(String::as_str)
    }

    /// A problem with this object as a whole.
    pub(super) fn problem(&self, text: impl Into<String>) -> Problem {
        malformed(self.pointer.clone(), text)
    }

    /// A whole number, if it is there.
    pub(super) fn number(&self, name: &str) -> Result<Option<usize>, Problem> {
        let Some(value) = self.fields.get(name) else {
            return Ok(None);
        };
        match whole(value) {
            Some(number) => Ok(Some(number)),
            None => Err(malformed(
                self.pointer_to(name),
                format!(
                    "expected a whole number from 0 on, found {}",
                    kind_of(value)
                ),
            )),
        }
    }

    /// A whole number that must be there.
    pub(super) fn required_number(&self, name: &str) -> Result<usize, Problem> {
        self.number(name)?
            .ok_or_else(|| self.problem(format!("{name} is missing")))
    }

    pub(super) fn text(&self, name: &str) -> Result<Option<&'a str>, Problem> {
        match self.fields.get(name) {
            None => Ok(None),
            Some(Value::String(text)) => Ok(Some(text)),
            Some(other) => Err(malformed(
                self.pointer_to(name),
                format!("expected a string, found {}", kind_of(other)),
            )),
        }
    }

    pub(super) fn object(&self, name: &str) -> Result<Option<Object<'a>>, Problem> {
        self.fields
            .get(name)
            .map(|value| Self::new(value, self.pointer_to(name)))
            .transpose()
    }

    /// The elements of an array; none if it is not there.
    pub(super) fn array(&self, name: &str) -> Result<&'a [Value], Problem> {
        match self.fields.get(name) {
            None => Ok(&[]),
            Some(Value::Array(elements)) => Ok(elements),
            Some(other) => Err(malformed(
                self.pointer_to(name),
                format!("expected an array, found {}", kind_of(other)),
            )),
        }
    }

    /// The elements of an array of objects.
    pub(super) fn objects(
        &self,
        name: &str,
    ) -> Result<impl Iterator<Item = Result<Object<'a>, Problem>>, Problem> {
        let pointer = self.pointer_to(name);
        Ok(self
            .array(name)?
            .iter()
            .enumerate()
            .map(move |(i, value)| Self::new(value, format!("{pointer}/{i}"))))
    }

    /// The names of the extensions on this object.
    pub(super) fn extensions(&self) -> Result<Vec<&'a str>, Problem> {
        let extensions = self.object("extensions")?;
        Ok(extensions.map_or(Vec::new(), |object| object.names().collect()))
    }
}

/// A problem at a JSON pointer.
pub(super) fn malformed(pointer: String, text: impl Into<String>) -> Problem {
    FileErrorKind::malformed(text).at(Place::Json(pointer))
}

/// The value as a whole number that can count bytes in memory.
///
/// JSON does not tell `36.0` from `36`, and some exporters write the former.
pub(super) fn whole(value: &Value) -> Option<usize> {
    if let Some(number) = value.as_u64() {
        return usize::try_from(number).ok();
    }
    let number = value.as_f64()?;
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

fn kind_of(value: &Value) -> String {
    match value {
        Value::Null => "null".into(),
        Value::Bool(_) => "a truth value".into(),
        Value::Number(number) => number.to_string(),
        Value::String(_) => "a string".into(),
        Value::Array(_) => "an array".into(),
        Value::Object(_) => "an object".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn whole_numbers_may_be_written_with_a_point() {
        assert_eq!(whole(&json!(36)), Some(36));
        assert_eq!(whole(&json!(36.0)), Some(36));
        for bad in [json!(-1), json!(0.5), json!(1e300), json!("1"), json!(null)] {
            assert_eq!(whole(&bad), None, "{bad}");
        }
    }

    #[test]
    fn pointers_escape_what_they_must() {
        let value = json!({"a/b~c": []});
        let object = Object::new(&value, "/x".into()).unwrap();
        let problem = object.number("a/b~c").unwrap_err();
        assert_eq!(problem.place, Place::Json("/x/a~1b~0c".into()));
    }
}
