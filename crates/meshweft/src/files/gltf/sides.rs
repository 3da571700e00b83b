//! Which sides of faces are seen: what the materials, nodes and morph targets of a mesh say.

use std::collections::{BTreeMap, BTreeSet};

use super::json::Value;
use super::movable::PrimitiveNumber;
use super::object::Object;
use super::{GltfFile, read_json};
use crate::files::stored_culling::SeenSides;

const SKINNED: &str = "joints move its vertices (a node that draws it has a skin)";
const MORPHED: &str = "morph targets move its vertices";
const OTHER_POSITIONS: &str = "several primitives draw its faces with different positions";

/// What there is to know of a primitive.
struct DrawnPrimitive {
    sides: SeenSides,
    is_morphed: bool,
    position: Option<usize>,
}

impl GltfFile {
    /// See [`Content::seen_sides`](crate::files::content::Content::seen_sides). Time O(JSON log JSON).
    pub(super) fn found_sides(&self) -> Vec<Result<SeenSides, &'static str>> {
        let entries = &self.view.entries;
        // It was read before, and is an object.
        let json = read_json(&self.container, &self.options.limits);
        let root = json.as_ref().ok();
        let root = root.and_then(|json| Object::new(json.root(), String::new()).ok());
        let Some(root) = root else {
            return vec![Ok(SeenSides::Both); entries.meshes.len()];
        };

        // All primitives.
        let of_vrm = materials_of_vrm(&root);
        let materials = root.elements("materials").enumerate();
        let shows_backs: Vec<bool> = materials
            .map(|(number, material)| {
                let is_double = material.get("doubleSided").is_some_and(Value::is_true);
                is_double || has_outline(material) || of_vrm.get(number) == Some(&true)
            })
            .collect();
        let mut primitives = BTreeMap::new();
        for (mesh, value) in (0_u32..).zip(root.elements("meshes")) {
            let list = value.get("primitives").into_iter();
            for (primitive, value) in (0_u32..).zip(list.flat_map(Value::elements)) {
                let number = PrimitiveNumber { mesh, primitive };
                primitives.insert(number, DrawnPrimitive::of(value, &shows_backs));
            }
        }
        let skinned = root
            .elements("nodes")
            .filter(|node| node.get("skin").is_some());
        let skinned = skinned.filter_map(|node| node.get("mesh")?.whole());
        let skinned: BTreeSet<usize> = skinned.collect();

        // The meshes, each drawn by its first primitive and by those that repeat it.
        let mut drawn_by: BTreeMap<PrimitiveNumber, Vec<PrimitiveNumber>> = BTreeMap::new();
        for (&number, &first) in &entries.repeated {
            drawn_by.entry(first).or_default().push(number);
        }
        let sides = entries.first_primitives.iter().map(|first| {
            let others = drawn_by.get(first).into_iter().flatten();
            let numbers: Vec<&PrimitiveNumber> = [first].into_iter().chain(others).collect();
            let found: Vec<&DrawnPrimitive> =
                numbers.iter().filter_map(|n| primitives.get(n)).collect();
            if numbers.iter().any(|n| skinned.contains(&(n.mesh as usize))) {
                return Err(SKINNED);
            }
            if found.iter().any(|primitive| primitive.is_morphed) {
                return Err(MORPHED);
            }
            if found.iter().any(|it| it.position != found[0].position) {
                return Err(OTHER_POSITIONS);
            }
            let is_front = found.iter().all(|it| it.sides == SeenSides::Front);
            Ok(match is_front {
                true => SeenSides::Front,
                false => SeenSides::Both,
            })
        });
        sides.collect()
    }
}

impl DrawnPrimitive {
    fn of(value: Value<'_>, shows_backs: &[bool]) -> Self {
        // Its material, and those that variants give it.
        let extensions = value.get("extensions");
        let variants = extensions.and_then(|all| all.get("KHR_materials_variants"));
        let mappings = variants.and_then(|variants| variants.get("mappings"));
        let mappings = mappings.into_iter().flat_map(Value::elements);
        let of_variants = mappings.map(|mapping| mapping.get("material"));
        let mut materials = of_variants.chain([value.get("material")]).flatten();
        let is_both = materials.any(|material| {
            let number = material.whole();
            number.is_some_and(|number| shows_backs.get(number) == Some(&true))
        });

        let targets = value.get("targets").into_iter().flat_map(Value::elements);
        let position = value.get("attributes");
        Self {
            sides: match is_both {
                true => SeenSides::Both,
                false => SeenSides::Front,
            },
            is_morphed: targets.count() > 0,
            position: position.and_then(|all| all.get("POSITION")?.whole()),
        }
    }
}

/// Whether a toon material of VRM 1 draws an outline: the faces once more, their backs to the eye.
fn has_outline(material: Value<'_>) -> bool {
    let toon = material.get("extensions");
    let toon = toon.and_then(|all| all.get("VRMC_materials_mtoon"));
    let mode = toon.and_then(|toon| toon.get("outlineWidthMode"));
    mode.is_some_and(|mode| mode.text().as_deref() != Some("none"))
}

/// Whether each material of a file of VRM 0, by its own properties, draws an outline or leaves out other faces than those
/// that face away.
fn materials_of_vrm(root: &Object) -> Vec<bool> {
    /// The back faces are not drawn.
    const CULL_BACK: usize = 2;
    let vrm = root.value("extensions").and_then(|all| all.get("VRM"));
    let properties = vrm.and_then(|vrm| vrm.get("materialProperties"));
    let properties = properties.into_iter().flat_map(Value::elements);
    let shows_backs = |properties: Value<'_>| {
        let number = |name: &str| properties.get("floatProperties")?.get(name);
        let is_other = |name: &str, usual: usize| {
            number(name).is_some_and(|number| number.whole() != Some(usual))
        };
        is_other("_OutlineWidthMode", 0) || is_other("_CullMode", CULL_BACK)
    };
    properties.map(shows_backs).collect()
}
