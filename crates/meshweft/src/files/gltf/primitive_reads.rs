//! What is read to draw each primitive, as the JSON names it; nothing of it is checked.

use super::json::Value;
use super::movable::PrimitiveNumber;
use super::object::Object;
use crate::files::error::Problem;

/// What a primitive reads, by the numbers of accessors and buffer views.
pub(super) struct PrimitiveReads<'a> {
    pub(super) number: PrimitiveNumber,
    pub(super) primitive: Value<'a>,
    /// Lists of vertex numbers: what it draws, and its outline.
    pub(super) lists: Vec<usize>,
    /// Attributes and morph targets.
    pub(super) vertices: Vec<usize>,
    /// The buffer view with all of them, if they are compressed by Draco.
    pub(super) compressed: Option<usize>,
}

/// Calls `visit` with what each primitive reads, in the order of the file.
pub(super) fn each_primitive<'a>(
    root: &Object<'a>,
    mut visit: impl FnMut(PrimitiveReads<'a>),
) -> Result<(), Problem> {
    // JSON is shorter than 4 GiB, so all numbers fit.
    for (mesh, value) in (0_u32..).zip(root.array("meshes")?) {
        let primitives = value.get("primitives").into_iter();
        for (primitive, value) in (0_u32..).zip(primitives.flat_map(Value::elements)) {
            let number = PrimitiveNumber { mesh, primitive };
            visit(reads_of(number, value));
        }
    }
    Ok(())
}

fn reads_of(number: PrimitiveNumber, primitive: Value<'_>) -> PrimitiveReads<'_> {
    let of_extension = |name: &str, member: &str| {
        let extension = primitive.get("extensions")?.get(name);
        extension?.get(member)?.whole()
    };
    let drawn = primitive.get("indices").and_then(Value::whole);
    let outline = of_extension("CESIUM_primitive_outline", "indices");

    let targets = primitive.get("targets").into_iter();
    let sets = primitive.get("attributes").into_iter();
    let sets = sets.chain(targets.flat_map(Value::elements));
    let vertices = sets.flat_map(Value::members);
    PrimitiveReads {
        number,
        primitive,
        lists: drawn.into_iter().chain(outline).collect(),
        vertices: vertices.filter_map(|(_, value)| value.whole()).collect(),
        compressed: of_extension("KHR_draco_mesh_compression", "bufferView"),
    }
}

/// The accessors with the matrices of joints, and with what places instances.
pub(super) fn matrices(root: &Object) -> Vec<usize> {
    let skins = root
        .elements("skins")
        .filter_map(|skin| skin.get("inverseBindMatrices")?.whole());
    let instances = root.elements("nodes").filter_map(|node| {
        let extensions = node.get("extensions")?;
        extensions.get("EXT_mesh_gpu_instancing")?.get("attributes")
    });
    let instances = instances.flat_map(Value::members);
    let instances = instances.filter_map(|(_, accessor)| accessor.whole());
    skins.chain(instances).collect()
}
