//! What is stored with the vertices, corners and faces of a PLY file, and its values.

use std::collections::HashSet;
use std::ops::Range;

use super::header::{Element, Encoding, PropertyKind};
use super::number::PlyNumber;
use super::rows::{Ascii, Binary, PlyRows, Row};
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::files::error::no_attribute;
use crate::files::error::{Fault, Place, Problem};
use crate::files::rewrite::{StoredMesh, fan};
use crate::files::text::line_of;

/// Properties that are colors together, the last may be missing.
pub(super) const COLORS: [[&str; 4]; 3] = [
    ["red", "green", "blue", "alpha"],
    ["r", "g", "b", "a"],
    [
        "diffuse_red",
        "diffuse_green",
        "diffuse_blue",
        "diffuse_alpha",
    ],
];

/// Properties that are texture coordinates together.
pub(super) const TEXTURES: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];

/// One attribute, and which properties of the element of its domain hold its components.
struct Column {
    info: AttributeInfo,
    properties: Vec<usize>,
}

/// The attributes of a PLY file. They are found when they are asked for: a header may declare many.
pub(super) struct PlyAttributes<'a> {
    pub(super) encoding: Encoding,
    pub(super) vertex: Option<&'a Element>,
    pub(super) face: Option<&'a Element>,
    /// Whether the list of texture coordinates has two numbers a corner in every face.
    pub(super) has_texture: bool,
}

impl PlyAttributes<'_> {
    /// Time O(properties).
    pub(super) fn infos(&self) -> Vec<AttributeInfo> {
        let columns = self.columns().into_iter();
        columns.map(|column| column.info).collect()
    }

    fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        let elements = [(self.vertex, Domain::Vertex), (self.face, Domain::Face)];
        for (element, domain) in elements {
            if let Some(element) = element {
                columns_of(element, domain, &mut columns);
            }
        }

        let list = self.face.filter(|_| self.has_texture).and_then(|face| {
            let list = face.texture_list()?;
            Some((list, face.properties[list].kind))
        });
        if let Some((list, PropertyKind::List { item, .. })) = list {
            let semantic = Semantic::TexCoord(0);
            columns.push(Column {
                info: AttributeInfo::new(semantic, Domain::Corner, 2, item),
                properties: vec![list],
            });
        }
        columns
    }

    /// The values of an attribute.
    ///
    /// Time O(bytes of the rows + properties), and no memory beside the values.
    pub(super) fn read(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        let mut columns = self.columns().into_iter();
        let column = columns.find(|column| column.info == *info);
        let element = match info.domain {
            Domain::Vertex => self.vertex,
            _ => self.face,
        };
        let (Some(column), Some(element)) = (column, element) else {
            return Err(no_attribute(info));
        };

        let reader = ColumnReader {
            column,
            element,
            stored,
        };
        let source = stored.source;
        let values = match self.encoding {
            Encoding::Ascii => reader.values(|span| Ascii::new(&source[..span.end], span.start)),
            Encoding::LittleEndian => {
                reader.values(|span| Binary::<false>::new(source, span.start))
            }
            Encoding::BigEndian => reader.values(|span| Binary::<true>::new(source, span.start)),
        };
        let values = values.map_err(|fault| {
            fault.kind.at(match self.encoding {
                Encoding::Ascii => Place::Line(line_of(source, fault.at)),
                _ => Place::Byte(fault.at),
            })
        })?;
        Ok(Attribute::new(info.clone(), values))
    }
}

/// Adds what the single numbers of an element are: those that belong together first.
fn columns_of(element: &Element, domain: Domain, columns: &mut Vec<Column>) {
    let mut taken: HashSet<&str> = HashSet::new();
    let mut add = |semantic: Semantic, names: &[&'static str]| {
        let Some(mut column) = column(element, semantic, domain, names) else {
            return false;
        };
        let is_color = matches!(column.info.semantic, Semantic::Color(_));
        column.info.is_normalized = is_color && is_unsigned(column.info.component_type);
        taken.extend(names);
        columns.push(column);
        true
    };

    if domain == Domain::Vertex {
        add(Semantic::Position, &["x", "y", "z"]);
    }
    add(Semantic::Normal, &["nx", "ny", "nz"]);
    let mut set = 0;
    for names in COLORS {
        let has_alpha = same_type(element, &names);
        let names = if has_alpha { &names[..] } else { &names[..3] };
        set += u32::from(add(Semantic::Color(set), names));
    }
    set = 0;
    for names in TEXTURES {
        set += u32::from(add(Semantic::TexCoord(set), &names));
    }

    for (number, property) in element.properties.iter().enumerate() {
        let PropertyKind::Scalar(scalar) = property.kind else {
            continue;
        };
        if taken.insert(&property.name) {
            let semantic = Semantic::Other(property.name.clone());
            columns.push(Column {
                info: AttributeInfo::new(semantic, domain, 1, scalar),
                properties: vec![number],
            });
        }
    }
}

/// The attribute that these properties are together, if they all are there as single numbers.
fn column(element: &Element, semantic: Semantic, domain: Domain, names: &[&str]) -> Option<Column> {
    let numbers = names.iter().map(|name| element.scalar(name));
    let properties = numbers.collect::<Option<Vec<usize>>>()?;
    let scalars = properties
        .iter()
        .filter_map(|&number| scalar(element, number));
    let component_type = joined(scalars)?;
    Some(Column {
        info: AttributeInfo::new(semantic, domain, properties.len(), component_type),
        properties,
    })
}

fn scalar(element: &Element, number: usize) -> Option<ComponentType> {
    match element.properties[number].kind {
        PropertyKind::Scalar(scalar) => Some(scalar),
        PropertyKind::List { .. } => None,
    }
}

/// Whether all of these properties are there and have one type.
fn same_type(element: &Element, names: &[&str]) -> bool {
    let scalars = names
        .iter()
        .map(|name| scalar(element, element.scalar(name)?));
    let scalars: Option<Vec<ComponentType>> = scalars.collect();
    scalars.is_some_and(|scalars| scalars.windows(2).all(|pair| pair[0] == pair[1]))
}

/// The type that holds the numbers of all these types.
fn joined(scalars: impl Iterator<Item = ComponentType>) -> Option<ComponentType> {
    // A float of four bytes holds whole numbers of two.
    let floating = |scalar| match scalar {
        ComponentType::I32 | ComponentType::U32 | ComponentType::F64 => ComponentType::F64,
        _ => ComponentType::F32,
    };
    let join = |a, b| match (a, b) {
        (a, b) if a == b => a,
        (a, b) if floating(a) == floating(b) => floating(a),
        _ => ComponentType::F64,
    };
    scalars.reduce(join)
}

pub(super) fn is_unsigned(component: ComponentType) -> bool {
    matches!(
        component,
        ComponentType::U8 | ComponentType::U16 | ComponentType::U32
    )
}

/// Reads the values of a column.
struct ColumnReader<'a> {
    column: Column,
    element: &'a Element,
    stored: &'a StoredMesh<'a>,
}

impl ColumnReader<'_> {
    fn values<R: PlyRows>(&self, rows: impl Fn(Range<usize>) -> R) -> Result<Values, Fault> {
        Ok(match self.column.info.component_type {
            ComponentType::I8 => i8::values(self.numbers(rows)?),
            ComponentType::U8 => u8::values(self.numbers(rows)?),
            ComponentType::I16 => i16::values(self.numbers(rows)?),
            ComponentType::U16 => u16::values(self.numbers(rows)?),
            ComponentType::I32 => i32::values(self.numbers(rows)?),
            ComponentType::U32 => u32::values(self.numbers(rows)?),
            ComponentType::F32 => f32::values(self.numbers(rows)?),
            ComponentType::F64 => f64::values(self.numbers(rows)?),
        })
    }

    fn numbers<T: PlyNumber, R: PlyRows>(
        &self,
        rows: impl Fn(Range<usize>) -> R,
    ) -> Result<Vec<T>, Fault> {
        let StoredMesh { entry, .. } = self.stored;
        let components = self.column.info.components;
        let mut numbers = Vec::new();
        let mut parts = vec![T::default(); components];
        match self.column.info.domain {
            Domain::Vertex => {
                numbers.reserve(entry.mesh.vertex_count() * components);
                for (record, span) in self.stored.vertices() {
                    self.parts(rows(span), record, &mut parts)?;
                    numbers.extend_from_slice(&parts);
                }
            }
            Domain::Corner => {
                numbers.reserve(entry.mesh.face_count() * 3 * components);
                let mut list = Vec::new();
                // Rows without faces may have any number of them.
                for face in self.stored.faces().filter(|face| face.face_count > 0) {
                    self.list(rows(face.span), face.record, &mut list)?;
                    for corner in fan(list.len() / components, face.rotation) {
                        let start = corner * components;
                        numbers.extend_from_slice(&list[start..start + components]);
                    }
                }
            }
            Domain::Face => {
                numbers.reserve(entry.mesh.face_count() * components);
                for face in self.stored.faces().filter(|face| face.face_count > 0) {
                    self.parts(rows(face.span), face.record, &mut parts)?;
                    for _ in 0..face.face_count {
                        numbers.extend_from_slice(&parts);
                    }
                }
            }
        }
        Ok(numbers)
    }

    /// Reads a row as far as its single numbers of the column.
    fn parts<T: PlyNumber>(
        &self,
        mut rows: impl PlyRows,
        number: usize,
        parts: &mut [T],
    ) -> Result<(), Fault> {
        let element = self.element;
        let row = Row { element, number };
        let mut missing = parts.len();
        for (number, property) in element.properties.iter().enumerate() {
            let place = self.column.properties.iter().position(|&p| p == number);
            match (property.kind, place) {
                (PropertyKind::Scalar(scalar), Some(place)) => {
                    parts[place] = rows.number(scalar, &row)?;
                    missing -= 1;
                    if missing == 0 {
                        break;
                    }
                }
                (kind, _) => skip(&mut rows, kind, &row)?,
            }
        }
        Ok(())
    }

    /// Reads a row as far as the list of the column.
    fn list<T: PlyNumber>(
        &self,
        mut rows: impl PlyRows,
        number: usize,
        list: &mut Vec<T>,
    ) -> Result<(), Fault> {
        let element = self.element;
        let row = Row { element, number };
        list.clear();
        for (number, property) in element.properties.iter().enumerate() {
            match property.kind {
                PropertyKind::List { count, item } if self.column.properties == [number] => {
                    for _ in 0..rows.list_length(count, &row)? {
                        list.push(rows.number(item, &row)?);
                    }
                    break;
                }
                kind => skip(&mut rows, kind, &row)?,
            }
        }
        Ok(())
    }
}

/// Reads past a property.
fn skip(rows: &mut impl PlyRows, kind: PropertyKind, row: &Row<'_>) -> Result<(), Fault> {
    match kind {
        PropertyKind::Scalar(scalar) => rows.skip(1, scalar, row),
        PropertyKind::List { count, item } => {
            let count = rows.list_length(count, row)?;
            rows.skip(count, item, row)
        }
    }
}
