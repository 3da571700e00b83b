//! A PLY file of a new mesh: a binary one, with the names that [`attributes`](super::attributes) reads.

use std::collections::BTreeSet;

use super::attributes::{COLORS, TEXTURES, is_unsigned};
use crate::attribute::{Attribute, ComponentType, Domain, Semantic, Values};
use crate::files::error::FileErrorKind;
use crate::files::new_mesh::{
    NewMesh, PolygonCorners, in_one_line, nothing_to_share, vertex_count,
};
use crate::index::index32;

/// The bytes of a file with this mesh.
///
/// # Errors
/// The mesh shares vertices, or a PLY file cannot hold an attribute.
pub(super) fn bytes(mesh: &NewMesh<'_>) -> Result<Vec<u8>, FileErrorKind> {
    let attributes = mesh.vertices.attributes().map_err(nothing_to_share)?;
    let vertex_count = vertex_count(&attributes, mesh.faces)?;
    let polygons = mesh.checked_polygons()?;
    check_polygons(polygons, &attributes)?;
    let vertices = columns(&attributes, Domain::Vertex)?;
    let faces = columns(&attributes, Domain::Face)?;
    let textures = texture_list(&attributes)?;

    // The header.
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment made by meshweft {}\n",
        env!("CARGO_PKG_VERSION")
    );
    if !mesh.name.is_empty() {
        header += &format!("comment mesh {}\n", in_one_line(mesh.name));
    }
    header += &format!("element vertex {vertex_count}\n");
    declare(&vertices, &mut header);
    // Older readers know no other type of corner.
    let corner = match i32::try_from(vertex_count) {
        Ok(_) => "int",
        Err(_) => "uint",
    };
    // Older readers know no other type of their number either.
    let most_corners = (0..polygons.len())
        .map(|polygon| polygons.count(polygon))
        .max();
    let count_type = match most_corners {
        Some(256..) => ComponentType::U32,
        _ => ComponentType::U8,
    };
    header += &format!(
        "element face {}\nproperty list {} {corner} vertex_indices\n",
        polygons.len(),
        type_name(count_type)
    );
    if let Some(textures) = &textures {
        header += &format!(
            "property list uchar {} texcoord\n",
            type_name(textures.kind)
        );
    }
    declare(&faces, &mut header);
    header += "end_header\n";

    // The rows.
    let row = |columns: &[NewProperty]| columns.iter().map(|column| column.size).sum::<usize>();
    let face_row =
        count_type.size() + 8 + row(&faces) + textures.as_ref().map_or(0, |t| 1 + t.size);
    let length = vertex_count * row(&vertices) + polygons.len() * face_row + 4 * mesh.faces.len();
    let mut bytes = header.into_bytes();
    bytes.reserve_exact(length);
    for vertex in 0..vertex_count {
        add_row(&vertices, vertex, &mut bytes);
    }
    for number in 0..polygons.len() {
        let count = index32(polygons.count(number)).to_le_bytes();
        bytes.extend(&count[..count_type.size()]);
        bytes.extend(polygons.of(number).flat_map(u32::to_le_bytes));
        if let Some(textures) = &textures {
            bytes.push(6);
            textures.add(number, &mut bytes);
        }
        add_row(&faces, number, &mut bytes);
    }
    Ok(bytes)
}

/// Refuses what is stored by face or corner where faces are cut from polygons: such a file has it by polygon.
fn check_polygons(
    polygons: PolygonCorners<'_>,
    attributes: &[Attribute],
) -> Result<(), FileErrorKind> {
    let mut of_faces = attributes
        .iter()
        .filter(|a| a.info.domain != Domain::Vertex);
    let has_larger = (0..polygons.len()).any(|polygon| polygons.count(polygon) > 3);
    match of_faces.next().filter(|_| has_larger) {
        None => Ok(()),
        Some(attribute) => refused(format!(
            "{} is stored by triangle, and a PLY file with polygons has it by polygon: leave the polygons out",
            attribute.info.semantic
        )),
    }
}

/// The values of one attribute, and the names of the properties that hold its components.
struct NewProperty {
    names: Vec<String>,
    kind: ComponentType,
    /// Bytes of all components of an element.
    size: usize,
    bytes: Vec<u8>,
}

impl NewProperty {
    fn new(names: Vec<String>, components: usize, values: &Values) -> Self {
        let kind = values.component_type();
        Self {
            names,
            kind,
            size: components * kind.size(),
            bytes: values.to_le_bytes(),
        }
    }

    fn add(&self, element: usize, row: &mut Vec<u8>) {
        row.extend_from_slice(&self.bytes[element * self.size..][..self.size]);
    }
}

fn add_row(columns: &[NewProperty], element: usize, bytes: &mut Vec<u8>) {
    columns.iter().for_each(|column| column.add(element, bytes));
}

fn declare(columns: &[NewProperty], header: &mut String) {
    for NewProperty { names, kind, .. } in columns {
        for name in names {
            *header += &format!("property {} {name}\n", type_name(*kind));
        }
    }
}

/// The columns of the attributes of a domain, each name once.
fn columns(attributes: &[Attribute], domain: Domain) -> Result<Vec<NewProperty>, FileErrorKind> {
    let mut taken = BTreeSet::from(["vertex_indices".to_owned()]);
    let of_domain = attributes.iter().filter(|a| a.info.domain == domain);
    let column = |attribute: &Attribute| {
        let names = names_of(attribute)?;
        for name in &names {
            if !taken.insert(name.clone()) {
                return refused(format!("two properties would be called {name}: rename one"));
            }
        }
        Ok(NewProperty::new(
            names,
            attribute.info.components,
            &attribute.values,
        ))
    };
    of_domain.map(column).collect()
}

fn names_of(attribute: &Attribute) -> Result<Vec<String>, FileErrorKind> {
    let info = &attribute.info;
    let semantic = &info.semantic;
    if info.morph_target.is_some() {
        return refused("a PLY file has no morph targets: create a .glb");
    }

    // The names that have a meaning.
    let known: Option<&[&str]> = match *semantic {
        Semantic::Position => Some(&["x", "y", "z"]),
        Semantic::Normal => Some(&["nx", "ny", "nz"]),
        Semantic::Color(set) => COLORS.get(set as usize).map(|names| &names[..]),
        Semantic::TexCoord(set) => TEXTURES.get(set as usize).map(|names| &names[..]),
        _ => None,
    };
    let is_color = matches!(semantic, Semantic::Color(_));
    if info.is_normalized != (is_color && is_unsigned(info.component_type)) {
        return refused(format!(
            "{semantic}: in a PLY file colors of unsigned integers are fractions, and nothing else is; \
             convert it to floats"
        ));
    }
    if let Some(names) = known {
        let least = if is_color { 3 } else { names.len() };
        return match names
            .get(..info.components)
            .filter(|names| names.len() >= least)
        {
            Some(names) => Ok(names.iter().map(|&name| name.to_owned()).collect()),
            None => refused(format!(
                "{semantic} has {} components, a PLY file stores {least} of it",
                info.components
            )),
        };
    }

    // Any others by their own name.
    let name = semantic.to_string();
    let is_word = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
    match (is_word, info.components) {
        (false, _) | (_, 0) => refused(format!("{name:?} cannot be the name of a PLY property")),
        (true, 1) => Ok(vec![name]),
        (true, components) => Ok((0..components).map(|i| format!("{name}_{i}")).collect()),
    }
}

/// Texture coordinates of corners, which PLY files keep as a list of each face.
fn texture_list(attributes: &[Attribute]) -> Result<Option<NewProperty>, FileErrorKind> {
    let mut list = None;
    for attribute in attributes
        .iter()
        .filter(|a| a.info.domain == Domain::Corner)
    {
        let info = &attribute.info;
        let is_it = info.semantic == Semantic::TexCoord(0)
            && info.components == 2
            && info.morph_target.is_none()
            && !info.is_normalized;
        if !is_it {
            return refused(format!(
                "{} is stored by corner: of corners a PLY file holds TEXCOORD_0 alone, so give each \
                 corner a vertex of its own",
                info.semantic
            ));
        }
        list = Some(NewProperty::new(Vec::new(), 6, &attribute.values));
    }
    Ok(list)
}

fn type_name(kind: ComponentType) -> &'static str {
    match kind {
        ComponentType::I8 => "char",
        ComponentType::U8 => "uchar",
        ComponentType::I16 => "short",
        ComponentType::U16 => "ushort",
        ComponentType::I32 => "int",
        ComponentType::U32 => "uint",
        ComponentType::F32 => "float",
        ComponentType::F64 => "double",
    }
}

fn refused<T>(text: impl Into<String>) -> Result<T, FileErrorKind> {
    Err(FileErrorKind::unsupported(text))
}
