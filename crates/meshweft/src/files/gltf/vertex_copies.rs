//! Vertices for levels of detail, copied from a primitive without an index list.
//!
//! Each three of its vertices in a row are a face, so those that a level needs cannot all be the first ones. A level then
//! has copies of them, with an index list.

use std::collections::BTreeMap;

use serde_json::{Value as NewJson, json};

use super::GltfFile;
use super::accessors::Accessors;
use super::elements::Elements;
use super::entries::Corners;
use super::json::Value;
use super::new_attributes::NewAccessor;
use super::new_meshes::NewMeshes;
use super::object::{Object, primitives_of};
use super::stated_bounds::stated_bounds;
use crate::attribute::Values;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::new_levels::VerticesOfLevels;

/// Members of an accessor that its copy has, or that say where the source has its bytes, and extras.
const KNOWN_MEMBERS: [&str; 11] = [
    "bufferView",
    "byteOffset",
    "componentType",
    "normalized",
    "count",
    "type",
    "max",
    "min",
    "sparse",
    "name",
    "extras",
];

impl GltfFile {
    /// See [`Content::vertices_of_levels`](crate::files::content::Content::vertices_of_levels). Time O(JSON log JSON).
    pub(super) fn found_vertices_of_levels(&self) -> Vec<VerticesOfLevels> {
        let meshes = 0..self.view.entries.meshes.len();
        let found = || {
            let json = super::read_json(&self.container, &self.options.limits)?;
            let root = Object::new(json.root(), String::new())?;
            let copier = VertexCopier::new(self, &root)?;
            let of_mesh = |mesh: usize| match self.has_indices(mesh) {
                true => VerticesOfLevels::OfMesh,
                false if copier.sets(mesh).is_some() => VerticesOfLevels::Copies,
                false => VerticesOfLevels::None,
            };
            Ok::<_, Problem>(meshes.clone().map(of_mesh).collect())
        };
        // It was read before.
        found().unwrap_or_else(|_| vec![VerticesOfLevels::None; meshes.len()])
    }

    /// Whether the faces of a mesh are stored by the numbers of their vertices.
    pub(super) fn has_indices(&self, mesh: usize) -> bool {
        matches!(self.view.entries.corners[mesh], Corners::Indices(_))
    }
}

/// The names of a set of attributes, as the JSON has them, each with its accessor.
type NamedAccessors<'a> = Vec<(&'a str, usize)>;

/// The vertices of a primitive.
struct VertexSets<'a> {
    attributes: NamedAccessors<'a>,
    /// The morph targets; `None` if it names none.
    targets: Option<Vec<NamedAccessors<'a>>>,
}

impl<'a> VertexSets<'a> {
    /// Those of a primitive; `None` if they are not sound.
    fn of(primitive: Value<'a>) -> Option<Self> {
        let set = |set: Value<'a>| -> Option<NamedAccessors<'a>> {
            let named = set.named_nodes();
            let named = named.map(|(name, accessor)| Some((name.raw(), accessor.whole()?)));
            named.collect()
        };
        let targets = primitive.get("targets");
        let targets = targets.map(|targets| targets.elements().map(set).collect::<Option<_>>());
        let targets = match targets {
            Some(sound) => Some(sound?),
            None => None,
        };
        let attributes = set(primitive.get("attributes")?)?;
        Some(Self {
            attributes,
            targets,
        })
    }

    fn accessors(&self) -> impl Iterator<Item = usize> {
        let targets = self.targets.iter().flatten().flatten();
        self.attributes.iter().chain(targets).map(|&(_, it)| it)
    }

    /// The members of a primitive that has copies of the accessors.
    fn members(&self, copies: &BTreeMap<usize, usize>) -> Vec<String> {
        let set = |set: &NamedAccessors<'_>| {
            let named = set.iter();
            let named = named.map(|(name, accessor)| format!("{name}:{}", copies[accessor]));
            format!("{{{}}}", named.collect::<Vec<_>>().join(","))
        };
        let mut members = vec![format!(r#""attributes":{}"#, set(&self.attributes))];
        members.extend(self.targets.as_ref().map(|targets| {
            let targets: Vec<String> = targets.iter().map(set).collect();
            format!(r#""targets":[{}]"#, targets.join(","))
        }));
        members
    }
}

/// Copies vertices of the primitives of a file.
pub(super) struct VertexCopier<'a> {
    file: &'a GltfFile,
    accessors: Accessors<'a>,
    primitives: Vec<Vec<Value<'a>>>,
}

impl<'a> VertexCopier<'a> {
    /// That of a file with this JSON.
    ///
    /// # Errors
    /// The accessors cannot be read.
    pub(super) fn new(file: &'a GltfFile, root: &'a Object<'a>) -> Result<Self, Problem> {
        let safe = &file.options.assume_order_safe;
        Ok(Self {
            accessors: Accessors::new(root, &file.buffers, safe)?,
            primitives: primitives_of(root.as_value()),
            file,
        })
    }

    /// The vertices of a mesh; `None` if they cannot be copied.
    fn sets(&self, mesh: usize) -> Option<VertexSets<'a>> {
        let entries = &self.file.view.entries;
        let number = entries.first_primitives[mesh];
        let primitive = self.primitives[number.mesh as usize][number.primitive as usize];
        let sets = VertexSets::of(primitive)?;
        let all_can_be = sets.accessors().all(|it| self.elements(it).is_some());
        all_can_be.then_some(sets)
    }

    /// What an accessor holds, if a copy of some of it says all that it says.
    fn elements(&self, accessor: usize) -> Option<Elements> {
        let value = self.accessors.value(accessor)?;
        let mut members = value.members();
        if members.any(|(name, _)| !KNOWN_MEMBERS.contains(&&*name)) {
            return None;
        }
        Elements::of(&self.accessors, accessor).filter(|elements| elements.components() <= 4)
    }

    /// Stores copies of these vertices of a mesh, in this order; the members that a primitive has of them.
    ///
    /// # Errors
    /// They cannot be copied.
    pub(super) fn copy(
        &self,
        mesh: usize,
        vertices: &[u32],
        new: &mut NewMeshes<'_>,
    ) -> Result<Vec<String>, Problem> {
        let entries = &self.file.view.entries;
        let Some(sets) = self.sets(mesh) else {
            let place = Place::Json(entries.first_primitives[mesh].pointer());
            let text = "its vertices cannot be copied for its levels";
            return Err(FileErrorKind::unsupported(text).at(place));
        };

        // Each accessor once.
        let count = entries.meshes[mesh].mesh.vertex_count();
        let mut copies: BTreeMap<usize, usize> = BTreeMap::new();
        for accessor in sets.accessors() {
            if copies.contains_key(&accessor) {
                continue;
            }
            let Some(elements) = self.elements(accessor) else {
                continue;
            };
            let components = elements.components();
            let mut values = Values::zeros(elements.component_type, vertices.len() * components);
            let all = elements.values(&self.file.buffers, count)?;
            values.put(0, &all, components, vertices.iter().copied());
            let json = self.json_of_copy(accessor, &values, components);
            let copy = new.vertices(NewAccessor::new(json, &values, components));
            copies.insert(accessor, copy);
        }
        Ok(sets.members(&copies))
    }

    /// The JSON of an accessor of other values, without its buffer view.
    fn json_of_copy(&self, accessor: usize, values: &Values, components: usize) -> NewJson {
        let source = self.accessors.value(accessor);
        let member = |name: &str| source.and_then(|source| source.get(name));
        let mut json = json!({ "count": values.len() / components });
        for name in ["componentType", "type", "normalized"] {
            let value = member(name).and_then(|it| serde_json::from_str(it.raw()).ok());
            if let Some(value) = value {
                json[name] = value;
            }
        }
        if member("min").is_some()
            && let Some([min, max]) = stated_bounds(values, components)
        {
            (json["min"], json["max"]) = (min, max);
        }
        json
    }
}
