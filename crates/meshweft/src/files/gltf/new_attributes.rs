//! The values of an attribute as an accessor and its bytes.

use serde_json::{Value as NewJson, json};

use super::accessors::{BYTE, FLOAT, SHORT, UNSIGNED_BYTE, UNSIGNED_SHORT};
use super::stated_bounds::stated_bounds;
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::files::error::FileErrorKind;

/// An accessor that is not there yet.
pub(super) struct NewAccessor {
    /// Its JSON, without its buffer view.
    pub(super) json: NewJson,
    /// Elements at whole words.
    pub(super) bytes: Vec<u8>,
    /// The bytes from one element to the next, if there are some between.
    pub(super) stride: Option<usize>,
}

impl NewAccessor {
    /// That of elements with these values, which are no matrices.
    pub(super) fn new(json: NewJson, values: &Values, components: usize) -> Self {
        let tight = values.to_le_bytes();
        let size = values.component_type().size() * components;
        let stride = size.next_multiple_of(4);
        if stride == size {
            return Self {
                json,
                bytes: tight,
                stride: None,
            };
        }
        let mut bytes = Vec::with_capacity(tight.len() / size * stride);
        for element in tight.chunks_exact(size) {
            bytes.extend_from_slice(element);
            bytes.resize(bytes.len().next_multiple_of(4), 0);
        }
        Self {
            json,
            bytes,
            stride: Some(stride),
        }
    }
}

/// Whether a primitive may have these attributes together.
///
/// # Errors
/// Numbered ones are not numbered from 0 on, joints and weights do not go together, or a morph target
/// moves what is not there.
pub(super) fn check_together(attributes: &[Attribute]) -> Result<(), FileErrorKind> {
    use Semantic::{Color, Joints, TexCoord, Weights};
    let infos = attributes.iter().map(|attribute| &attribute.info);
    let (own, of_targets): (Vec<_>, Vec<_>) = infos.partition(|info| info.morph_target.is_none());
    let has = |semantic: &Semantic| own.iter().any(|info| info.semantic == *semantic);
    let first_missing = |info: &AttributeInfo| {
        let wanted = match info.semantic {
            TexCoord(n) => (n > 0).then(|| vec![TexCoord(n - 1)]),
            Color(n) => (n > 0).then(|| vec![Color(n - 1)]),
            Joints(0) => Some(vec![Weights(0)]),
            Joints(n) => Some(vec![Joints(n - 1), Weights(n)]),
            Weights(0) => Some(vec![Joints(0)]),
            Weights(n) => Some(vec![Weights(n - 1), Joints(n)]),
            _ => None,
        };
        let mut wanted = wanted.into_iter().flatten();
        wanted.find(|semantic| !has(semantic))
    };

    let lonely = |info: &&AttributeInfo| Some((info.semantic.to_string(), first_missing(info)?));
    if let Some((name, missing)) = own.iter().find_map(lonely) {
        let text = format!("glTF does not store {name} without {missing}");
        return Err(FileErrorKind::unsupported(text));
    }
    if let Some(moved) = of_targets.iter().find(|info| !has(&info.semantic)) {
        let text = format!(
            "a morph target has {}, which the mesh itself does not have",
            moved.semantic
        );
        return Err(FileErrorKind::unsupported(text));
    }
    Ok(())
}

/// The accessor of an attribute of vertices.
///
/// # Errors
/// glTF cannot store it.
pub(super) fn accessor_of(attribute: &Attribute) -> Result<NewAccessor, FileErrorKind> {
    let info = &attribute.info;
    let component_type = check(info)?;
    let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][info.components - 1];

    let mut json = json!({
        "componentType": component_type,
        "count": attribute.len(),
        "type": kind,
    });
    if info.is_normalized {
        json["normalized"] = true.into();
    }
    if let Values::F32(values) = &attribute.values {
        check_finite(values, info)?;
    }
    // Of positions the format asks for the bounds.
    if info.semantic == Semantic::Position
        && let Some([min, max]) = stated_bounds(&attribute.values, info.components)
    {
        (json["min"], json["max"]) = (min, max);
    }
    Ok(NewAccessor::new(json, &attribute.values, info.components))
}

/// The number of its component type, if glTF allows it for what it means.
fn check(info: &AttributeInfo) -> Result<usize, FileErrorKind> {
    let name = &info.semantic;
    let refused = |text: String| Err(FileErrorKind::unsupported(text));
    if info.domain != Domain::Vertex {
        return refused(format!(
            "{name} is stored by {:?}: glTF stores attributes of vertices only, so give each corner a \
             vertex of its own",
            info.domain
        ));
    }

    let component_type = match info.component_type {
        ComponentType::I8 => BYTE,
        ComponentType::U8 => UNSIGNED_BYTE,
        ComponentType::I16 => SHORT,
        ComponentType::U16 => UNSIGNED_SHORT,
        ComponentType::F32 => FLOAT,
        other => {
            return refused(format!(
                "{name} has components of type {other:?}, which glTF does not store: convert them to \
                 32-bit floats"
            ));
        }
    };

    let is_real = component_type == FLOAT;
    let is_fraction =
        info.is_normalized && matches!(component_type, UNSIGNED_BYTE | UNSIGNED_SHORT);
    let is_morph = info.morph_target.is_some();
    let (components, is_allowed) = match &info.semantic {
        Semantic::Position | Semantic::Normal => (3..=3, is_real),
        Semantic::Tangent if is_morph => (3..=3, is_real),
        Semantic::Tangent => (4..=4, is_real),
        Semantic::TexCoord(_) => (2..=2, is_real || is_fraction),
        Semantic::Color(_) => (3..=4, is_real || is_fraction),
        Semantic::Joints(_) => (
            4..=4,
            matches!(component_type, UNSIGNED_BYTE | UNSIGNED_SHORT) && !info.is_normalized,
        ),
        Semantic::Weights(_) => (4..=4, is_real || is_fraction),
        Semantic::Other(name) => (1..=4, name.starts_with('_')),
    };
    if let (Semantic::Other(name), false) = (&info.semantic, is_allowed) {
        return refused(format!(
            "glTF has no attribute {name}: start the name with an underscore, as in _{name}"
        ));
    }
    if !is_allowed || !components.contains(&info.components) {
        let normalized = if info.is_normalized {
            ", normalized"
        } else {
            ""
        };
        return refused(format!(
            "glTF does not store {name} as {} components of type {:?}{normalized}",
            info.components, info.component_type
        ));
    }
    Ok(component_type)
}

fn check_finite(values: &[f32], info: &AttributeInfo) -> Result<(), FileErrorKind> {
    let Some(at) = values.iter().position(|value| !value.is_finite()) else {
        return Ok(());
    };
    let text = format!(
        "{} of vertex {} is not finite, which glTF does not allow",
        info.semantic,
        at / info.components
    );
    Err(FileErrorKind::unsupported(text))
}
