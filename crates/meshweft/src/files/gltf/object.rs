//! JSON objects with the pointer to them: members by name, and problems that say where.

use std::borrow::Cow;

use super::json::Value;
use crate::files::error::{FileErrorKind, Place, Problem};

/// An object and the JSON pointer to it.
pub(super) struct Object<'a> {
    value: Value<'a>,
    pointer: String,
}

impl<'a> Object<'a> {
    pub(super) fn new(value: Value<'a>, pointer: String) -> Result<Self, Problem> {
        match value.is_object() {
            true => Ok(Self { value, pointer }),
            false => Err(malformed(
                pointer,
                format!("expected an object, found {}", value.kind()),
            )),
        }
    }

    pub(super) fn as_value(&self) -> Value<'a> {
        self.value
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
        self.value(name).is_some()
    }

    /// A field of any kind.
    pub(super) fn value(&self, name: &str) -> Option<Value<'a>> {
        self.value.get(name)
    }

    /// The names of its fields.
    pub(super) fn names(&self) -> impl Iterator<Item = Cow<'a, str>> {
        self.value.members().map(|(name, _)| name)
    }

    /// The fields that are to be whole numbers, each with its name.
    pub(super) fn numbers(&self) -> impl Iterator<Item = Result<(Cow<'a, str>, usize), Problem>> {
        self.value.members().map(|(name, value)| {
            let number = self.whole(&name, value)?;
            Ok((name, number))
        })
    }

    /// A problem with this object as a whole.
    pub(super) fn problem(&self, text: impl Into<String>) -> Problem {
        malformed(self.pointer.clone(), text)
    }

    fn whole(&self, name: &str, value: Value<'a>) -> Result<usize, Problem> {
        value.whole().ok_or_else(|| {
            let found = value.kind();
            let text = format!("expected a whole number from 0 on, found {found}");
            malformed(self.pointer_to(name), text)
        })
    }

    /// A whole number, if it is there.
    pub(super) fn number(&self, name: &str) -> Result<Option<usize>, Problem> {
        let value = self.value(name);
        value.map(|value| self.whole(name, value)).transpose()
    }

    /// A whole number that must be there.
    pub(super) fn required_number(&self, name: &str) -> Result<usize, Problem> {
        self.number(name)?
            .ok_or_else(|| self.problem(format!("{name} is missing")))
    }

    pub(super) fn text(&self, name: &str) -> Result<Option<Cow<'a, str>>, Problem> {
        let Some(value) = self.value(name) else {
            return Ok(None);
        };
        match value.text() {
            Some(text) => Ok(Some(text)),
            None => Err(malformed(
                self.pointer_to(name),
                format!("expected a string, found {}", value.kind()),
            )),
        }
    }

    pub(super) fn object(&self, name: &str) -> Result<Option<Object<'a>>, Problem> {
        self.value(name)
            .map(|value| Self::new(value, self.pointer_to(name)))
            .transpose()
    }

    /// The elements of an array; none if it is not there.
    pub(super) fn array(&self, name: &str) -> Result<Vec<Value<'a>>, Problem> {
        match self.value(name) {
            None => Ok(Vec::new()),
            Some(value) if value.is_array() => {
                // Counted first: growing would take twice the memory.
                let mut elements = Vec::with_capacity(value.elements().count());
                elements.extend(value.elements());
                Ok(elements)
            }
            Some(other) => Err(malformed(
                self.pointer_to(name),
                format!("expected an array, found {}", other.kind()),
            )),
        }
    }

    /// The elements of an array; none if it is not there, or is something else.
    pub(super) fn elements(&self, name: &str) -> impl Iterator<Item = Value<'a>> + use<'a> {
        self.value(name).into_iter().flat_map(Value::elements)
    }

    /// The elements of an array of objects.
    pub(super) fn objects(
        &self,
        name: &str,
    ) -> Result<impl Iterator<Item = Result<Object<'a>, Problem>>, Problem> {
        let pointer = self.pointer_to(name);
        let elements = self.array(name)?.into_iter().enumerate();
        Ok(elements.map(move |(i, value)| Self::new(value, format!("{pointer}/{i}"))))
    }

    /// The names of the extensions on this object.
    pub(super) fn extensions(&self) -> Result<Vec<Cow<'a, str>>, Problem> {
        let extensions = self.object("extensions")?;
        Ok(extensions.map_or(Vec::new(), |object| object.names().collect()))
    }
}

/// A problem at a JSON pointer.
pub(super) fn malformed(pointer: String, text: impl Into<String>) -> Problem {
    FileErrorKind::malformed(text).at(Place::Json(pointer))
}

/// The primitives of each mesh.
pub(super) fn primitives_of<'a>(root: Value<'a>) -> Vec<Vec<Value<'a>>> {
    let meshes = root.get("meshes").into_iter().flat_map(Value::elements);
    meshes.map(primitives_of_mesh).collect()
}

/// The primitives of a mesh.
pub(super) fn primitives_of_mesh(mesh: Value<'_>) -> Vec<Value<'_>> {
    let primitives = mesh.get("primitives").into_iter();
    primitives.flat_map(Value::elements).collect()
}

#[cfg(test)]
mod tests {
    use super::super::json::Json;
    use super::*;
    use crate::limits::Limits;

    #[test]
    fn pointers_escape_what_they_must() {
        let text = br#"{"a/b~c": []}"#;
        let json = Json::read(text, &Limits::default()).unwrap_or_else(|_| panic!("sound"));
        let object = Object::new(json.root(), "/x".into()).unwrap();
        let problem = object.number("a/b~c").unwrap_err();
        assert_eq!(problem.place, Place::Json("/x/a~1b~0c".into()));
    }
}
