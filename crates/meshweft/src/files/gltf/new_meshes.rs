//! New meshes as bytes of a buffer and values of the JSON.

use std::collections::BTreeSet;

use serde_json::{Value as NewJson, json};

use super::accessors::{UNSIGNED_INT, UNSIGNED_SHORT};
use super::additions::Additions;
use super::json::Value;
use super::movable::PrimitiveNumber;
use super::new_attributes::{NewAccessor, accessor_of, check_together};
use super::object::Object;
use super::scene::{Drawn, INSTANCES, Scenes};
use crate::attribute::Attribute;
use crate::faces::Faces;
use crate::files::error::{FileErrorKind, Problem};
use crate::files::new_mesh::{NewMesh, vertex_count};

/// What a buffer view is bound to.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// The vertices of a mesh that is there.
pub(super) struct SharedVertices {
    pub(super) primitive: PrimitiveNumber,
    pub(super) count: usize,
}

/// Adds meshes to a file: bytes for one of its buffers, and values.
pub(super) struct NewMeshes<'a> {
    root: &'a Object<'a>,
    /// The buffer that the bytes go to, and where in it they start.
    buffer: usize,
    start: usize,
    bytes: Vec<u8>,
    additions: Additions,
    next_view: usize,
    next_accessor: usize,
    next_mesh: usize,
    scenes: Scenes<'a>,
}

impl<'a> NewMeshes<'a> {
    pub(super) fn new(root: &'a Object<'a>, buffer: usize, start: usize) -> Result<Self, Problem> {
        Ok(Self {
            root,
            buffer,
            start,
            bytes: Vec::new(),
            additions: Additions::default(),
            next_view: root.array("bufferViews")?.len(),
            next_accessor: root.array("accessors")?.len(),
            next_mesh: root.array("meshes")?.len(),
            scenes: Scenes::new(root)?,
        })
    }

    /// Adds a mesh; `shared` are the vertices of a mesh of the document. Of a mesh without vertices and
    /// faces only a node is left, as no accessor may be empty.
    ///
    /// # Errors
    /// It has vertices and no faces, or they name vertices that are not there, or glTF cannot store an
    /// attribute.
    pub(super) fn add(
        &mut self,
        mesh: &NewMesh<'_>,
        shared: impl Fn(usize) -> SharedVertices,
    ) -> Result<(), FileErrorKind> {
        let attributes = mesh.vertices.attributes();
        if mesh.faces.is_empty() {
            if attributes.is_ok_and(|all| all.iter().all(Attribute::is_empty)) {
                self.add_node(mesh.name, None, None);
                return Ok(());
            }
            let text = "it has no faces, and no meshes of vertices alone are made in a glTF: leave it out, or \
                        create a .ply or an .obj";
            return Err(FileErrorKind::unsupported(text));
        }

        // Polygons are drawn as their faces.
        mesh.checked_polygons()?;

        // The vertices: what the primitive has beside its faces, as members of its JSON.
        let (count, mut members, weights, drawn) = match attributes {
            Err(number) => {
                let SharedVertices { primitive, count } = shared(number);
                Faces::new(mesh.faces, count).map_err(FileErrorKind::Order)?;
                let (members, weights) = self.shared(primitive);
                let drawn = self.scenes.first_drawn(primitive.mesh);
                (count, members, weights, drawn)
            }
            Ok(attributes) => {
                let count = vertex_count(&attributes, mesh.faces)?;
                (count, self.stored(&attributes)?, None, None)
            }
        };

        // The faces.
        let indices = self.indices(mesh.faces, count);
        members.push(format!(r#""indices":{indices},"mode":4"#));

        // The mesh, and a node that draws it.
        let primitive = members.join(",");
        let mut members: Vec<String> = name_member(mesh.name).into_iter().collect();
        members.push(format!(r#""primitives":[{{{primitive}}}]"#));
        members.extend(weights.map(|raw| format!(r#""weights":{raw}"#)));
        self.additions
            .element("meshes", format!("{{{}}}", members.join(",")));
        self.add_node(mesh.name, Some(self.next_mesh), drawn);
        self.next_mesh += 1;
        Ok(())
    }

    /// What a primitive that is there says of its vertices and material, and its mesh of the weights of
    /// morph targets.
    fn shared(&self, number: PrimitiveNumber) -> (Vec<String>, Option<&'a str>) {
        let meshes = self.root.value("meshes");
        let mesh = meshes.and_then(|meshes| meshes.elements().nth(number.mesh as usize));
        let primitives = mesh.and_then(|mesh| mesh.get("primitives"));
        let primitive = primitives.and_then(|all| all.elements().nth(number.primitive as usize));

        let member = |name: &str| {
            let raw = primitive?.get(name)?.raw();
            Some(format!(r#""{name}":{raw}"#))
        };
        let mut members: Vec<String> = ["attributes", "targets", "material"]
            .into_iter()
            .filter_map(member)
            .collect();
        // The only extension that is of the material alone.
        const VARIANTS: &str = "KHR_materials_variants";
        let extensions = primitive.and_then(|primitive| primitive.get("extensions"));
        let variants = extensions.and_then(|extensions| extensions.get(VARIANTS));
        members.extend(
            variants.map(|variants| format!(r#""extensions":{{"{VARIANTS}":{}}}"#, variants.raw())),
        );
        let weights = mesh.and_then(|mesh| mesh.get("weights")).map(Value::raw);
        (members, weights)
    }

    /// Stores attributes and morph targets.
    fn stored(&mut self, attributes: &[Attribute]) -> Result<Vec<String>, FileErrorKind> {
        let targets = attributes.iter().filter_map(|a| a.info.morph_target);
        let named: BTreeSet<u32> = targets.collect();
        let mut expected = (0_u32..).zip(&named);
        if let Some((missing, &target)) = expected.find(|(i, target)| i != *target) {
            let text =
                format!("there are attributes of morph target {target}, but none of {missing}");
            return Err(FileErrorKind::unsupported(text));
        }
        let mut sets = vec![serde_json::Map::new(); 1 + named.len()];
        for attribute in attributes {
            let number = self.vertices(accessor_of(attribute)?);
            let set = attribute.info.morph_target.map_or(0, |t| 1 + t as usize);
            sets[set].insert(attribute.info.semantic.to_string(), number.into());
        }
        // After what is wrong with one alone, which says more.
        check_together(attributes)?;

        let mut sets = sets.into_iter().map(NewJson::from);
        let mut members = vec![format!(
            r#""attributes":{}"#,
            sets.next().unwrap_or_default()
        )];
        if !named.is_empty() {
            members.push(format!(r#""targets":{}"#, sets.collect::<NewJson>()));
        }
        Ok(members)
    }

    /// Stores what vertices have; the number of their accessor.
    pub(super) fn vertices(&mut self, mut accessor: NewAccessor) -> usize {
        let view = self.view(&accessor.bytes, Some(VERTICES), accessor.stride);
        accessor.json["bufferView"] = view.into();
        self.accessor(&accessor.json)
    }

    /// Stores the corners of faces, in 16 bits if that is enough; the number of their accessor.
    pub(super) fn indices(&mut self, faces: &[[u32; 3]], vertex_count: usize) -> usize {
        let corners = faces.as_flattened();
        // The largest number of a type restarts a strip and is not a vertex.
        let is_short = vertex_count <= usize::from(u16::MAX);
        let bytes: Vec<u8> = match is_short {
            true => corners
                .iter()
                .flat_map(|corner| {
                    let [low, high, ..] = corner.to_le_bytes();
                    [low, high]
                })
                .collect(),
            false => corners.iter().flat_map(|c| c.to_le_bytes()).collect(),
        };
        let view = self.view(&bytes, Some(INDICES), None);
        self.accessor(&json!({
            "bufferView": view,
            "componentType": if is_short { UNSIGNED_SHORT } else { UNSIGNED_INT },
            "count": corners.len(),
            "type": "SCALAR",
        }))
    }

    /// Adds a mesh of which this is the text; its number.
    pub(super) fn mesh(&mut self, json: String) -> usize {
        self.additions.element("meshes", json);
        self.next_mesh += 1;
        self.next_mesh - 1
    }

    /// The number of one more node, whose text is to be added when it is its turn.
    pub(super) fn new_node(&mut self) -> usize {
        self.scenes.new_node()
    }

    /// Adds the text of a node.
    pub(super) fn node(&mut self, json: String) {
        self.additions.element("nodes", json);
    }

    /// Adds numbers that are neither vertices nor their indices; the number of their accessor.
    pub(super) fn numbers(
        &mut self,
        bytes: &[u8],
        component_type: usize,
        count: usize,
        kind: &str,
    ) -> usize {
        let view = self.view(bytes, None, None);
        self.accessor(&json!({
            "bufferView": view,
            "componentType": component_type,
            "count": count,
            "type": kind,
        }))
    }

    /// Adds a value that is not a mesh.
    pub(super) fn value<'b>(&mut self, path: impl IntoIterator<Item = &'b str>, json: String) {
        self.additions.value(path, json);
    }

    /// Adds bytes as a buffer view; its number.
    fn view(&mut self, bytes: &[u8], target: Option<u32>, stride: Option<usize>) -> usize {
        self.bytes.extend_from_slice(bytes);
        let mut view = json!({
            "buffer": self.buffer,
            "byteOffset": self.start + self.bytes.len() - bytes.len(),
            "byteLength": bytes.len(),
        });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        if let Some(stride) = stride {
            view["byteStride"] = stride.into();
        }
        self.additions.element("bufferViews", view.to_string());
        // Everything starts at a whole word.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.next_view += 1;
        self.next_view - 1
    }

    fn accessor(&mut self, accessor: &NewJson) -> usize {
        self.additions.element("accessors", accessor.to_string());
        self.next_accessor += 1;
        self.next_accessor - 1
    }

    /// Adds a node that draws a mesh, if any, where and as `drawn` is.
    fn add_node(&mut self, name: &str, mesh: Option<usize>, drawn: Option<Drawn<'_>>) {
        let mesh = mesh.map(|mesh| format!(r#""mesh":{mesh}"#));
        let mut members: Vec<String> = mesh.into_iter().chain(name_member(name)).collect();
        let node_number = self.scenes.new_node();
        match drawn {
            // A skinned mesh stands where its joints are, whatever is above it.
            Some(Drawn {
                skin: Some(skin),
                scene,
                ..
            }) => {
                members.push(format!(r#""skin":{skin}"#));
                self.scenes.add_root(node_number, Some(scene));
            }
            // A child moves with the node that draws the source.
            Some(Drawn { node: parent, .. }) => {
                let path = ["nodes", &parent.to_string(), "children", "-"];
                self.additions.value(path, node_number.to_string());
            }
            None => self.scenes.add_root(node_number, None),
        }

        if let Some(weights) = drawn.and_then(|drawn| drawn.weights) {
            members.push(format!(r#""weights":{weights}"#));
        }
        if let Some(instances) = drawn.and_then(|drawn| drawn.instances) {
            members.push(format!(r#""extensions":{{"{INSTANCES}":{instances}}}"#));
        }
        self.additions
            .element("nodes", format!("{{{}}}", members.join(",")));
    }

    /// All that was added.
    pub(super) fn finish(mut self) -> (Vec<u8>, Additions) {
        self.scenes.finish(&mut self.additions);
        (self.bytes, self.additions)
    }
}

/// The member that says how something is called, if it has a name.
fn name_member(name: &str) -> Option<String> {
    (!name.is_empty()).then(|| format!(r#""name":{}"#, NewJson::from(name)))
}
