//! What names bytes of a buffer in a way that is not known: where these bytes move, it would be wrong.

use std::collections::BTreeSet;

use super::accessors::{Accessors, COMPRESSED_VIEW};
use super::json::Value;
use super::object::Object;
use crate::files::error::{FileErrorKind, Place, Problem};

/// Refuses a file in which anything but a buffer view, or what a compressed one is made from, may name bytes of a buffer
/// that `moves`: an extension of a view or buffer that is not known, or an object anywhere with a `buffer` and an offset or
/// a length.
///
/// # Complexity
/// Time O(JSON log JSON), space O(JSON).
pub(super) fn check_names(
    root: &Object,
    accessors: &Accessors,
    moves: impl Fn(usize) -> bool,
) -> Result<(), Problem> {
    let is_known = |name: &str| COMPRESSED_VIEW.contains(&name) || accessors.is_order_free(name);
    let check = |holder: &Object| {
        let names = holder.extensions()?;
        match names.iter().find(|name| !is_known(name)) {
            Some(name) => Err(refused(
                holder.pointer().to_owned(),
                &format!("its extension {name} is not known, and"),
            )),
            None => Ok(()),
        }
    };

    // Buffers and views.
    for (number, buffer) in root.objects("buffers")?.enumerate() {
        let buffer = buffer?;
        if moves(number) {
            check(&buffer)?;
        }
    }
    let mut known = BTreeSet::new();
    for view in root.objects("bufferViews")? {
        let view = view?;
        if view.number("buffer")?.is_some_and(&moves) {
            check(&view)?;
        }
        let extensions = view.value("extensions");
        let sources = COMPRESSED_VIEW.map(|name| extensions?.get(name));
        let values = sources.into_iter().flatten().chain([view.as_value()]);
        known.extend(values.map(Value::start));
    }

    // Everything else.
    let mut open = vec![root.as_value()];
    while let Some(value) = open.pop() {
        let names_bytes = names_bytes_of(value).is_some_and(&moves);
        if names_bytes && !known.contains(&value.start()) {
            return Err(refused(pointer_to(root, value), "it"));
        }
        let members = value.members().map(|(_, member)| member);
        let inner = members.chain(value.elements());
        open.extend(inner.filter(|value| value.is_object() || value.is_array()));
    }
    Ok(())
}

/// The buffer of which an object names bytes, if it does.
fn names_bytes_of(object: Value<'_>) -> Option<usize> {
    let buffer = object.get("buffer")?.whole()?;
    let mut names = ["byteOffset", "byteLength"].into_iter();
    names
        .any(|name| object.get(name).is_some())
        .then_some(buffer)
}

fn refused(pointer: String, what: &str) -> Problem {
    let text = format!(
        "{what} may name bytes of the buffer, which would move: remove it, or say in assume_order_safe that the \
         extension does not"
    );
    FileErrorKind::unsupported(text).at(Place::Json(pointer))
}

/// The JSON pointer to a value below `root`.
fn pointer_to(root: &Object, value: Value<'_>) -> String {
    let (mut pointer, mut above) = (String::new(), root.as_value());
    while above.start() != value.start() {
        let members = above
            .members()
            .map(|(name, member)| (name.into_owned(), member));
        let elements = above.elements().enumerate();
        let elements = elements.map(|(number, element)| (number.to_string(), element));
        // They rise, so the last that starts before it holds it.
        let inner = members.chain(elements);
        let holder = inner
            .take_while(|(_, inner)| inner.start() <= value.start())
            .last();
        let Some((name, inner)) = holder else { break };
        pointer += "/";
        pointer += &name.replace('~', "~0").replace('/', "~1");
        above = inner;
    }
    pointer
}
