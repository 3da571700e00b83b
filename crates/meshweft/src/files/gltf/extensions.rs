//! What extensions on meshes and primitives say about the order of faces and vertices.
//!
//! One that is not known may depend on any vertex number, so it keeps the vertices; nothing that is
//! known to number faces or corners is touched.

use std::borrow::Cow;

use super::accessors::Accessors;
use super::json::Object;
use super::primitives::{IndexList, Pin, is_index_type};
use crate::files::error::Problem;

/// What keeps a primitive, or its vertices, where they are: the first reason of each counts.
#[derive(Debug, Clone, Default)]
pub(super) struct Restraint {
    pub(super) left: Option<Cow<'static, str>>,
    pub(super) pin: Option<Pin>,
    /// Extensions that are not known, and the pointers to what has them.
    pub(super) unknown: Vec<(String, String)>,
}

impl Restraint {
    pub(super) fn leave(&mut self, why: impl Into<Cow<'static, str>>) {
        self.left.get_or_insert_with(|| why.into());
    }

    pub(super) fn pin(&mut self, pointer: &str, why: impl Into<String>) {
        self.pin.get_or_insert_with(|| Pin {
            pointer: pointer.to_owned(),
            why: why.into(),
        });
    }

    /// Pins because of an extension that is not known.
    pub(super) fn pin_unknown(&mut self, pointer: &str, extension: &str) {
        let why = format!("the extension {extension} is not known and may depend on their order");
        self.pin(pointer, why);
        self.unknown
            .push((pointer.to_owned(), extension.to_owned()));
    }
}

/// What extensions on the mesh ask of all its primitives.
///
/// An accessor that reads the same triangles in one piece, and does not mind their order, is added
/// to `order_free_accessors`.
pub(super) fn of_mesh(
    mesh: &Object,
    accessors: &Accessors,
    order_free_accessors: &mut Vec<usize>,
) -> Result<Restraint, Problem> {
    let mut restraint = Restraint::default();
    let Some(extensions) = mesh.object("extensions")? else {
        return Ok(restraint);
    };
    for name in extensions.names() {
        if name == "EXT_mesh_manifold" {
            restraint.pin(mesh.pointer(), "EXT_mesh_manifold names vertices again");
            let Some(manifold) = extensions.object(&name)? else {
                continue;
            };
            let primitive = manifold.object("manifoldPrimitive")?;
            let indices = primitive.map(|p| p.number("indices")).transpose()?;
            let is_sparse = |&number: &usize| {
                let accessor = accessors.value(number);
                accessor.is_some_and(|accessor| accessor.get("sparse").is_some())
            };
            let indices = indices.flatten();
            if manifold.has("mergeIndices") || indices.as_ref().is_some_and(is_sparse) {
                restraint.leave("EXT_mesh_manifold names corners by their place in the file");
            }
            order_free_accessors.extend(indices);
        } else if !accessors.is_order_free(&name) {
            restraint.pin_unknown(mesh.pointer(), &name);
        }
    }
    Ok(restraint)
}

/// What the primitive's extensions ask for; returns the list of outline edges.
pub(super) fn of_primitive(
    primitive: &Object,
    accessors: &Accessors,
    restraint: &mut Restraint,
) -> Result<Option<IndexList>, Problem> {
    let mut outline = None;
    let Some(extensions) = primitive.object("extensions")? else {
        return Ok(None);
    };
    let pointer = primitive.pointer();
    for name in extensions.names() {
        match name.as_ref() {
            "KHR_draco_mesh_compression" => restraint
                .leave("it is compressed by KHR_draco_mesh_compression: decompress it first"),
            "FB_ngon_encoding" => {
                restraint.leave("FB_ngon_encoding keeps polygons as runs of triangles");
            }
            "EXT_mesh_primitive_edge_visibility" => {
                restraint.leave(format!("{name} numbers the edges of its triangles"));
            }
            "KHR_mesh_primitive_restart" | "EXT_mesh_primitive_restart" => {
                restraint.leave(format!("{name} makes the order of its indices topology"));
            }
            "CESIUM_primitive_outline" => match read_outline(&extensions, accessors)? {
                Some(list) => outline = Some(list),
                None => restraint.pin(
                    pointer,
                    "the vertex numbers of CESIUM_primitive_outline cannot be renumbered",
                ),
            },
            "EXT_mesh_features" if !has_implicit_ids(&extensions)? => {}
            "EXT_mesh_features" => {
                restraint.pin(
                    pointer,
                    "EXT_mesh_features takes their numbers as identities",
                );
            }
            name if accessors.is_order_free(name) => {}
            "EXT_mesh_manifold" | "EXT_structural_metadata" => {
                restraint.pin(pointer, format!("{name} may depend on their order"));
            }
            name => restraint.pin_unknown(pointer, name),
        }
    }
    Ok(outline)
}

fn read_outline(extensions: &Object, accessors: &Accessors) -> Result<Option<IndexList>, Problem> {
    let outline = extensions.object("CESIUM_primitive_outline")?;
    let number = outline.map(|o| o.number("indices")).transpose()?.flatten();
    let Some(number) = number else {
        return Ok(None);
    };
    let accessor = accessors.resolve(number, extensions.pointer())?;
    let is_list = is_index_type(&accessor)
        && !(accessor.is_sparse
            || accessor.is_compressed
            || accessor.fixed.is_some()
            || accessor.is_strided
            || accessor.unknown_extension.is_some());
    Ok(accessor
        .records
        .filter(|_| is_list)
        .map(|records| IndexList {
            records,
            is_bounded: accessor.is_bounded,
            pointer: accessor.pointer,
        }))
}

/// Whether a feature of EXT_mesh_features has neither attribute nor texture: vertex numbers count.
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
