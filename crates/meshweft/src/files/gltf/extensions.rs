//! What extensions on meshes and primitives say about the order of faces and vertices.
//!
//! One on a mesh or a primitive that is not known may refer to faces, corners or vertices by number, so
//! the primitive stays as it is, as it does for those that are known to. One that is known to refer to
//! vertices only keeps the vertices. One of this project on anything around the primitive keeps it too:
//! those exist to say how faces and vertices are ordered.

use std::collections::BTreeMap;

use super::accessors::Accessors;
use super::culling;
use super::json::Value;
use super::movable::IndexList;
use super::object::Object;
use super::obstacles::Obstacles;
use crate::files::error::Problem;

/// What the names of this project's extensions start with.
const OWN: &str = "MESHWEFT_";

/// Whether this is an extension of this project that this version does not know.
pub(super) fn is_unknown_own(name: &str, accessors: &Accessors) -> bool {
    name.starts_with(OWN) && !accessors.is_order_free(name)
}

/// Keeps a primitive because of an extension of which [`is_unknown_own`] holds.
pub(super) fn keep_for_unknown_own(name: &str, obstacles: &mut Obstacles) {
    obstacles.keep_primitive(format!(
        "the extension {name} goes with the order of its faces and vertices: use the version of meshweft \
         that wrote it, or remove the extension"
    ));
}

/// Extensions of this project, not known to this version, on the file and on nodes.
pub(super) struct OwnExtensions {
    of_file: Option<String>,
    /// Those on nodes, by the mesh that the node draws.
    of_nodes: BTreeMap<usize, String>,
}

impl OwnExtensions {
    /// Those of a file; `accessors` says which extensions are known.
    pub(super) fn new(root: &Object, accessors: &Accessors) -> Self {
        let own_of = |holder: Value<'_>| {
            let extensions = holder.get("extensions")?;
            let mut names = extensions.members().map(|(name, _)| name);
            let own = names.find(|name| is_unknown_own(name, accessors));
            own.map(|name| name.into_owned())
        };
        let nodes = root.value("nodes").into_iter().flat_map(Value::elements);
        let of_node = |node: Value<'_>| Some((node.get("mesh")?.whole()?, own_of(node)?));
        Self {
            of_file: own_of(root.as_value()),
            of_nodes: nodes.filter_map(of_node).collect(),
        }
    }

    /// Keeps all primitives of a mesh if the file or a node that draws it has such an extension.
    pub(super) fn keep(&self, mesh: usize, obstacles: &mut Obstacles) {
        if let Some(name) = self.of_file.as_ref().or(self.of_nodes.get(&mesh)) {
            keep_for_unknown_own(name, obstacles);
        }
    }
}

/// What the extensions of a mesh keep of all its primitives.
///
/// Accessors that read the faces of all its primitives in one piece, and do not mind their order, are
/// added to `order_free_accessors`.
pub(super) fn of_mesh(
    mesh: &Object,
    accessors: &Accessors,
    order_free_accessors: &mut Vec<usize>,
) -> Result<Obstacles, Problem> {
    let mut obstacles = Obstacles::default();
    let Some(extensions) = mesh.object("extensions")? else {
        return Ok(obstacles);
    };

    for name in extensions.names() {
        if name == "EXT_mesh_manifold" {
            obstacles.keep_vertices(mesh.pointer(), "EXT_mesh_manifold lists their numbers too");
            if let Some(manifold) = extensions.object(&name)? {
                let indices = of_manifold(&manifold, accessors, &mut obstacles)?;
                order_free_accessors.extend(indices);
            }
        } else if is_unknown_own(&name, accessors) {
            keep_for_unknown_own(&name, &mut obstacles);
        } else if !accessors.is_order_free(&name) {
            obstacles.keep_primitive_for_unknown(mesh.pointer(), &name);
        }
    }
    Ok(obstacles)
}

/// What `EXT_mesh_manifold` keeps of the primitives; returns the accessor that reads the faces of all in
/// one piece.
fn of_manifold(
    manifold: &Object,
    accessors: &Accessors,
    obstacles: &mut Obstacles,
) -> Result<Option<usize>, Problem> {
    let primitive = manifold.object("manifoldPrimitive")?;
    let indices = primitive.map(|p| p.number("indices")).transpose()?;
    let indices = indices.flatten();

    // Merged vertices are given by the places of corners in the index list.
    let accessor = indices.and_then(|number| accessors.value(number));
    let is_sparse = accessor.is_some_and(|accessor| accessor.get("sparse").is_some());
    if manifold.has("mergeIndices") || is_sparse {
        obstacles.keep_primitive("EXT_mesh_manifold names corners by their place in the file");
    }
    Ok(indices)
}

/// Adds what the extensions of a primitive keep; returns the list of its outline's edges.
pub(super) fn of_primitive(
    primitive: &Object,
    accessors: &Accessors,
    obstacles: &mut Obstacles,
) -> Result<Option<IndexList>, Problem> {
    let mut outline = None;
    let Some(extensions) = primitive.object("extensions")? else {
        return Ok(None);
    };
    let pointer = primitive.pointer();

    for name in extensions.names() {
        match name.as_ref() {
            "KHR_draco_mesh_compression" => obstacles.keep_primitive(
                "it is compressed by KHR_draco_mesh_compression: decompress it first",
            ),
            "FB_ngon_encoding" => {
                obstacles.keep_primitive("FB_ngon_encoding stores polygons as runs of triangles");
            }
            "EXT_mesh_primitive_edge_visibility" => {
                obstacles.keep_primitive(format!("{name} numbers the edges of its triangles"));
            }
            "KHR_mesh_primitive_restart" | "EXT_mesh_primitive_restart" => {
                obstacles
                    .keep_primitive(format!("{name} gives the order of its indices a meaning"));
            }
            "CESIUM_primitive_outline" => match read_outline(&extensions, accessors)? {
                Some(list) => outline = Some(list),
                None => obstacles.keep_vertices(
                    pointer,
                    "the vertex numbers of CESIUM_primitive_outline cannot be renumbered",
                ),
            },
            "EXT_mesh_features" if !has_implicit_ids(&extensions)? => {}
            "EXT_mesh_features" => {
                obstacles.keep_vertices(
                    pointer,
                    "EXT_mesh_features identifies features by their numbers",
                );
            }
            name if accessors.is_order_free(name) => {}
            // Looked at where the faces are known.
            culling::NAME if primitive.number("mode")?.unwrap_or(4) == 4 => {}
            culling::NAME => obstacles.keep_primitive(format!("{name} is of lists of triangles")),
            name if is_unknown_own(name, accessors) => keep_for_unknown_own(name, obstacles),
            // Property textures, and property attributes, which are vertex data.
            "EXT_structural_metadata" if names_only_properties(&extensions)? => {}
            "EXT_mesh_manifold" | "EXT_structural_metadata" => {
                obstacles.keep_vertices(pointer, format!("{name} may depend on their order"));
            }
            name => obstacles.keep_primitive_for_unknown(pointer, name),
        }
    }
    Ok(outline)
}

/// The list of `CESIUM_primitive_outline`; `None` if it cannot be renumbered.
fn read_outline(extensions: &Object, accessors: &Accessors) -> Result<Option<IndexList>, Problem> {
    let outline = extensions.object("CESIUM_primitive_outline")?;
    let number = outline.map(|o| o.number("indices")).transpose()?.flatten();
    let Some(number) = number else {
        return Ok(None);
    };

    let accessor = accessors.resolve(number, extensions.pointer())?;
    let is_list = accessor.is_index_type()
        && !(accessor.is_sparse
            || accessor.is_compressed
            || accessor.fixed.is_some()
            || accessor.is_strided
            || accessor.unknown_extension.is_some());
    Ok(IndexList::of(accessor).filter(|_| is_list))
}

/// Whether `EXT_structural_metadata` of a primitive says nothing that could depend on an order.
fn names_only_properties(extensions: &Object) -> Result<bool, Problem> {
    let metadata = extensions.object("EXT_structural_metadata")?;
    let free = ["propertyTextures", "propertyAttributes", "extras"];
    Ok(metadata.is_none_or(|metadata| metadata.names().all(|name| free.contains(&&*name))))
}

/// Whether `EXT_mesh_features` has features without attribute and texture: vertex numbers are their
/// IDs.
fn has_implicit_ids(extensions: &Object) -> Result<bool, Problem> {
    let Some(features) = extensions.object("EXT_mesh_features")? else {
        return Ok(false);
    };
    for feature in features.objects("featureIds")? {
        let feature = feature?;
        if !feature.has("attribute") && !feature.has("texture") {
            return Ok(true);
        }
    }
    Ok(false)
}
