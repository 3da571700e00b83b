//! What a glTF holds beside the names of its meshes, positions, faces and listed attributes.
//!
//! Everything is named that is not known to be a part of these, so that an extension or a field that comes
//! later is named too. Text about the file (`asset`) and names of scenes are not, nor is how values are stored.

use std::collections::{BTreeMap, BTreeSet};

use super::json::Value;
use super::movable::PrimitiveNumber;
use super::object::Object;
use super::{GltfFile, read_json};
use crate::attribute::AttributeInfo;
use crate::files::content::Content;
use crate::files::unlisted::FoundKinds;

/// What says nothing beside meshes: how they are stored, and what there is a look at below.
const STORAGE: [&str; 10] = [
    "asset",
    "accessors",
    "bufferViews",
    "buffers",
    "extensionsRequired",
    "extensionsUsed",
    "meshes",
    "nodes",
    "scene",
    "scenes",
];

impl GltfFile {
    /// See [`Content::unlisted`]. Time O(JSON log JSON).
    pub(super) fn found_unlisted(&self) -> FoundKinds {
        let mut found = FoundKinds::default();
        if let Some(name) = &self.view.unread_faces {
            found.add_faces(name.clone());
        }
        // It was read before, and is an object.
        let json = read_json(&self.container, &self.options.limits);
        let root = json.as_ref().ok();
        let root = root.and_then(|json| Object::new(json.root(), String::new()).ok());
        let Some(root) = root else { return found };

        let infos = (0..self.meshes().len()).flat_map(|mesh| self.attributes(mesh));
        let name = |info: AttributeInfo| match info.morph_target {
            None => info.semantic.to_string(),
            Some(_) => "targets".to_owned(),
        };
        let walk = GltfKinds {
            listed: infos.map(name).collect(),
            repeated: &self.view.entries.repeated,
            found,
        };
        walk.walk(&root)
    }
}

/// A walk through the JSON.
struct GltfKinds<'a> {
    /// The names of the attributes that are listed, of any mesh; `targets` if morph targets are.
    listed: BTreeSet<String>,
    /// Primitives whose faces are those of an earlier one, with that one: they are one mesh.
    repeated: &'a BTreeMap<PrimitiveNumber, PrimitiveNumber>,
    found: FoundKinds,
}

impl GltfKinds<'_> {
    fn walk(mut self, root: &Object) -> FoundKinds {
        for (name, value) in root.as_value().members() {
            let count = value.elements().count();
            match &*name {
                known if STORAGE.contains(&known) => {}
                _ if value.is_array() && count == 0 => {}
                _ if value.is_array() && count == 1 => {
                    let one = name.strip_suffix('s').unwrap_or(&name);
                    self.found.add_named(format!("1 {one}"));
                }
                _ if value.is_array() => self.found.add_named(format!("{count} {name}")),
                _ => self.found.add_named(name.into_owned()),
            }
        }
        let names = self.meshes(root);
        self.nodes(root, &names);
        if all(root, "scenes").count() > 1 {
            self.found.add("several scenes");
        }
        for (name, _) in all(root, "scenes").flat_map(Value::members) {
            if !matches!(&*name, "nodes" | "name") {
                self.found.add_named(format!("{name} of scenes"));
            }
        }
        self.found
    }

    /// The name of each mesh.
    fn meshes(&mut self, root: &Object) -> Vec<Option<String>> {
        let mut names = Vec::new();
        let mut positions = BTreeMap::new();
        for (mesh, value) in (0_u32..).zip(all(root, "meshes")) {
            let mut primitive_count = 0;
            for (name, value) in value.members() {
                match &*name {
                    "primitives" => {
                        for (primitive, value) in (0_u32..).zip(value.elements()) {
                            primitive_count += 1;
                            let number = PrimitiveNumber { mesh, primitive };
                            let position = value.get("attributes");
                            let position = position.and_then(|all| all.get("POSITION")?.whole());
                            positions.insert(number, position);
                            self.primitive(value);
                        }
                    }
                    "name" => {}
                    _ => self.found.add_named(format!("{name} of meshes")),
                }
            }
            if primitive_count > 1 {
                self.found.add("meshes of several primitives");
            }
            names.push(
                value
                    .get("name")
                    .and_then(Value::text)
                    .map(|it| it.into_owned()),
            );
        }

        // One mesh has the positions of the first.
        for (number, first) in self.repeated {
            match positions.get(number) == positions.get(first) {
                true => self.found.add("primitives with the same faces"),
                false => self.found.add_faces(format!(
                    "mesh {}, primitive {}",
                    number.mesh, number.primitive
                )),
            }
        }
        names
    }

    fn primitive(&mut self, primitive: Value<'_>) {
        for (name, value) in primitive.members() {
            match &*name {
                "attributes" => {
                    for (name, _) in value.members() {
                        if name != "POSITION" && !self.listed.contains(&*name) {
                            self.found.add_named(format!("{name} of vertices"));
                        }
                    }
                }
                "mode" => match value.whole() {
                    Some(0) => self.found.add("points"),
                    Some(1..=3) => self.found.add("lines"),
                    _ => {}
                },
                // Materials are named as such.
                "indices" | "material" => {}
                "targets" if self.listed.contains("targets") => {}
                _ => self.found.add_named(format!("{name} of primitives")),
            }
        }
    }

    fn nodes(&mut self, root: &Object, names: &[Option<String>]) {
        let mut drawn = vec![0_u32; names.len()];
        let mut node_count = 0;
        for node in all(root, "nodes") {
            node_count += 1;
            let mesh = node.get("mesh").and_then(Value::whole);
            if let Some(drawn) = mesh.and_then(|mesh| drawn.get_mut(mesh)) {
                *drawn += 1;
            }
            for (member, value) in node.members() {
                match &*member {
                    "mesh" => {}
                    // A copy has the name of the mesh there.
                    "name" => {
                        let of_mesh = mesh.and_then(|mesh| names.get(mesh)?.as_deref());
                        if value.text().as_deref() != of_mesh {
                            self.found.add("names of nodes");
                        }
                    }
                    _ => self.found.add_named(format!("{member} of nodes")),
                }
            }
        }
        if drawn.iter().any(|&drawn| drawn > 1) {
            self.found.add("meshes that several nodes draw");
        }
        if node_count > 0 && drawn.contains(&0) {
            self.found.add("meshes that no node draws");
        }
    }
}

/// The elements of an array of the file.
fn all<'a>(root: &Object<'a>, name: &str) -> impl Iterator<Item = Value<'a>> {
    root.value(name).into_iter().flat_map(Value::elements)
}
