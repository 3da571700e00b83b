//! The attributes of the meshes: which there are, and their values on request.
//!
//! A file can have very many meshes, so what is kept is small: where each name stands in the JSON,
//! and every accessor once.

use std::collections::BTreeMap;

use super::accessors::Accessors;
use super::buffers::Buffers;
use super::elements::Elements;
use super::json::{Value, string_at};
use super::movable::PrimitiveNumber;
use super::object::Object;
use crate::attribute::{Attribute, AttributeInfo, Domain, Semantic};
use crate::files::error::{Problem, no_attribute};
use crate::index::index32;

/// What is stored with the vertices of each mesh.
///
/// Primitives that share an index accessor are one mesh. It has the attributes of the first of them;
/// accessors that only the others name are not listed.
#[derive(Debug)]
pub(super) struct Attributes {
    /// The attributes of all meshes, one mesh after the other.
    named: Vec<NamedElements>,
    /// Where in `named` those of each mesh start, and the end of the last.
    starts: Vec<usize>,
    /// What accessors hold, each accessor once.
    elements: Vec<Elements>,
}

/// An attribute of a primitive, or of one of its morph targets.
#[derive(Debug)]
struct NamedElements {
    /// Where its name starts in the JSON.
    name: u32,
    morph_target: Option<u32>,
    /// Which of [`Attributes::elements`] it has.
    elements: u32,
}

impl Attributes {
    /// Those of `primitives`, which rise, one a mesh.
    ///
    /// What [`Elements::of`] cannot read is left out.
    ///
    /// # Complexity
    /// Time O(JSON + sparse elements), space 16 bytes an attribute and about 100 an accessor.
    pub(super) fn new(
        root: &Object,
        accessors: &Accessors,
        primitives: &[PrimitiveNumber],
    ) -> Self {
        let mut collected = Collected {
            attributes: Self {
                named: Vec::new(),
                starts: vec![0],
                elements: Vec::new(),
            },
            number_of: BTreeMap::new(),
        };

        // Walk through the file once, and take each primitive as it comes.
        let mut wanted = primitives.iter().peekable();
        for (mesh, value) in (0_u32..).zip(elements_of(root.value("meshes"))) {
            if wanted.peek().is_none_or(|next| next.mesh != mesh) {
                continue;
            }
            for (primitive, value) in (0_u32..).zip(elements_of(value.get("primitives"))) {
                let number = PrimitiveNumber { mesh, primitive };
                if wanted.next_if_eq(&&number).is_some() {
                    collected.add_mesh(value, accessors);
                }
            }
        }
        debug_assert!(
            wanted.next().is_none(),
            "a primitive is missing or out of order"
        );
        collected.attributes
    }

    /// Those of a mesh, in the order of the file; `json` is the text that they were read from.
    pub(super) fn of_mesh(&self, mesh: usize, json: &[u8]) -> Vec<AttributeInfo> {
        let named = self.named_of(mesh).iter();
        named.map(|named| self.info(named, json)).collect()
    }

    /// The values of an attribute of a mesh with `vertex_count` vertices.
    ///
    /// # Errors
    /// There is no such attribute, or it has sparse elements that cannot be read.
    pub(super) fn read(
        &self,
        mesh: usize,
        info: &AttributeInfo,
        json: &[u8],
        vertex_count: usize,
        buffers: &Buffers,
    ) -> Result<Attribute, Problem> {
        let Some(found) = self.find(mesh, info, json) else {
            return Err(no_attribute(info));
        };
        let values = self.stored(found).values(buffers, vertex_count)?;
        Ok(Attribute::new(info.clone(), values))
    }

    /// Which of all accessors an attribute of a mesh has.
    pub(super) fn store(&self, mesh: usize, info: &AttributeInfo, json: &[u8]) -> Option<usize> {
        let found = self.find(mesh, info, json)?;
        Some(found.elements as usize)
    }

    fn find(&self, mesh: usize, info: &AttributeInfo, json: &[u8]) -> Option<&NamedElements> {
        // Of two members with the same name the last counts.
        let mut named = self.named_of(mesh).iter().rev();
        named.find(|named| {
            named.morph_target == info.morph_target && self.info(named, json) == *info
        })
    }

    fn named_of(&self, mesh: usize) -> &[NamedElements] {
        &self.named[self.starts[mesh]..self.starts[mesh + 1]]
    }

    fn stored(&self, named: &NamedElements) -> &Elements {
        &self.elements[named.elements as usize]
    }

    fn info(&self, named: &NamedElements, json: &[u8]) -> AttributeInfo {
        let elements = self.stored(named);
        let name = string_at(json, named.name as usize).unwrap_or_default();
        let mut info = AttributeInfo::new(
            semantic(&name),
            Domain::Vertex,
            elements.components(),
            elements.component_type,
        );
        info.morph_target = named.morph_target;
        info.is_normalized = elements.is_normalized;
        info
    }
}

/// [`Attributes`] while they are collected.
struct Collected {
    attributes: Attributes,
    /// For each accessor that was looked at, which of the elements it has, if it can be read.
    number_of: BTreeMap<usize, Option<u32>>,
}

impl Collected {
    /// Adds a mesh with the attributes of its primitive.
    fn add_mesh(&mut self, primitive: Value<'_>, accessors: &Accessors) {
        self.add_set(primitive.get("attributes"), None, accessors);
        for (target, set) in (0_u32..).zip(elements_of(primitive.get("targets"))) {
            self.add_set(Some(set), Some(target), accessors);
        }
        let end = self.attributes.named.len();
        self.attributes.starts.push(end);
    }

    /// Adds the attributes, or one morph target.
    fn add_set(
        &mut self,
        set: Option<Value<'_>>,
        morph_target: Option<u32>,
        accessors: &Accessors,
    ) {
        for (name, accessor) in set.into_iter().flat_map(Value::named_nodes) {
            let Some(accessor) = accessor.whole() else {
                continue;
            };

            let elements = &mut self.attributes.elements;
            let number = *self.number_of.entry(accessor).or_insert_with(|| {
                elements.push(Elements::of(accessors, accessor)?);
                Some(index32(elements.len() - 1))
            });
            let named = number.map(|elements| NamedElements {
                name: name.start(),
                morph_target,
                elements,
            });
            self.attributes.named.extend(named);
        }
    }
}

/// The elements of a JSON array; none if there is no array.
fn elements_of(array: Option<Value<'_>>) -> impl Iterator<Item = Value<'_>> {
    array.into_iter().flat_map(Value::elements)
}

/// What a name means in glTF.
fn semantic(name: &str) -> Semantic {
    let set = |prefix: &str| name.strip_prefix(prefix)?.parse().ok();
    let known = match name {
        "POSITION" => Some(Semantic::Position),
        "NORMAL" => Some(Semantic::Normal),
        "TANGENT" => Some(Semantic::Tangent),
        _ => set("TEXCOORD_")
            .map(Semantic::TexCoord)
            .or_else(|| set("COLOR_").map(Semantic::Color))
            .or_else(|| set("JOINTS_").map(Semantic::Joints))
            .or_else(|| set("WEIGHTS_").map(Semantic::Weights)),
    };
    // Numbers spelled otherwise make other names: `COLOR_01` and `COLOR_+1` are not `COLOR_1`.
    let known = known.filter(|semantic| semantic.to_string() == name);
    known.unwrap_or_else(|| Semantic::Other(name.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_their_meaning_and_keep_their_spelling() {
        for (name, expected) in [
            ("POSITION", Semantic::Position),
            ("TEXCOORD_0", Semantic::TexCoord(0)),
            ("COLOR_4294967295", Semantic::Color(u32::MAX)),
            ("JOINTS_1", Semantic::Joints(1)),
            ("WEIGHTS_12", Semantic::Weights(12)),
        ] {
            assert_eq!(semantic(name), expected);
        }
        for name in [
            "",
            "Position",
            "COLOR_",
            "COLOR_01",
            "COLOR_+1",
            "_AGE",
            "COLOR_4294967296",
        ] {
            assert_eq!(semantic(name), Semantic::Other(name.to_owned()));
        }
    }
}
