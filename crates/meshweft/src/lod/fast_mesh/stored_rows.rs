//! The rows of vertices in a file: what they are, at the end of the head, and they themselves, in the blocks of their points.
//!
//! | part | bytes |
//! |---|---|
//! | how many attributes | varint |
//! | of each: what it means, see [`code_of`] | 1 |
//! | the number of its set, or the length of its name and the name in UTF-8 | varint; bytes |
//! | 0, or one more than the number of its morph target; components | varints |
//! | type of a component: see [`TYPES`], and 8 more if integers stand for fractions | 1 |
//! | length of the name of the mesh, and the name in UTF-8 | varint; bytes |

use std::ops::Range;

use super::hierarchy::VertexHierarchy;
use super::rows::{are_different, is_of_rows};
use crate::attribute::{AttributeInfo, ComponentType, Domain, Semantic};
use crate::bits::{DecodeError, varint};
use crate::lod::fields::FieldReader;

impl VertexHierarchy {
    /// The rows of the vertices of some points.
    pub(super) fn put_rows(&self, bytes: &mut Vec<u8>, points: Range<u32>) {
        if !self.rows.layouts.is_empty() {
            let vertices = points.flat_map(|point| self.vertices_of(point));
            vertices.for_each(|vertex| bytes.extend_from_slice(self.rows.row(vertex)));
        }
    }

    /// Reads the rows of the vertices of some points.
    pub(super) fn read_rows(
        &mut self,
        reader: &mut FieldReader<'_>,
        points: Range<u32>,
    ) -> Result<(), DecodeError> {
        if self.rows.layouts.is_empty() {
            return Ok(());
        }
        for point in points {
            for vertex in self.vertices_of(point) {
                let row = self.rows.row_mut(vertex);
                row.copy_from_slice(reader.slice(row.len())?);
            }
        }
        Ok(())
    }
}

/// Types by their numbers in a file.
const TYPES: [ComponentType; 8] = [
    ComponentType::I8,
    ComponentType::U8,
    ComponentType::I16,
    ComponentType::U16,
    ComponentType::I32,
    ComponentType::U32,
    ComponentType::F32,
    ComponentType::F64,
];
/// Added to a type where integers stand for fractions.
const NORMALIZED: u8 = 8;

/// A meaning by its number in a file, and the number of its set.
fn code_of(semantic: &Semantic) -> (u8, Option<u32>) {
    match *semantic {
        Semantic::Position => (0, None),
        Semantic::Normal => (1, None),
        Semantic::Tangent => (2, None),
        Semantic::TexCoord(set) => (3, Some(set)),
        Semantic::Color(set) => (4, Some(set)),
        Semantic::Joints(set) => (5, Some(set)),
        Semantic::Weights(set) => (6, Some(set)),
        Semantic::Other(_) => (7, None),
    }
}

/// Writes what the rows are, and a name.
pub(super) fn write(bytes: &mut Vec<u8>, layouts: &[AttributeInfo], name: &str) {
    varint::write(bytes, layouts.len() as u64);
    for info in layouts {
        let (code, set) = code_of(&info.semantic);
        bytes.push(code);
        if let Some(set) = set {
            varint::write(bytes, set.into());
        }
        if let Semantic::Other(name) = &info.semantic {
            write_text(bytes, name);
        }
        let target = info.morph_target.map_or(0, |target| 1 + u64::from(target));
        varint::write(bytes, target);
        varint::write(bytes, info.components as u64);
        let found = TYPES.iter().position(|&it| it == info.component_type);
        #[expect(clippy::cast_possible_truncation, reason = "one of eight")]
        let number = found.unwrap_or_default() as u8;
        bytes.push(number + NORMALIZED * u8::from(info.is_normalized));
    }
    write_text(bytes, name);
}

/// Reads what [`write()`] wrote.
pub(super) fn read(
    reader: &mut FieldReader<'_>,
) -> Result<(Vec<AttributeInfo>, String), DecodeError> {
    let mut layouts = Vec::new();
    // Each takes bytes, so a wrong number ends where they do.
    for _ in 0..reader.number()? {
        let info = read_layout(reader)?;
        if !is_of_rows(&info) {
            return Err(reader.damaged());
        }
        layouts.push(info);
    }
    if !are_different(&layouts) {
        return Err(reader.damaged());
    }
    Ok((layouts, read_text(reader)?))
}

fn read_layout(reader: &mut FieldReader<'_>) -> Result<AttributeInfo, DecodeError> {
    let [code] = reader.bytes()?;
    let mut set = || reader.below(u32::MAX);
    let semantic = match code {
        0 => Semantic::Position,
        1 => Semantic::Normal,
        2 => Semantic::Tangent,
        3 => Semantic::TexCoord(set()?),
        4 => Semantic::Color(set()?),
        5 => Semantic::Joints(set()?),
        6 => Semantic::Weights(set()?),
        7 => Semantic::Other(read_text(reader)?),
        _ => return Err(reader.damaged()),
    };
    let morph_target = reader.below(u32::MAX)?.checked_sub(1);
    let components = reader.below(u32::MAX)? as usize;
    let [kind] = reader.bytes()?;
    let Some(&component_type) = TYPES.get(usize::from(kind % NORMALIZED)) else {
        return Err(reader.damaged());
    };
    if kind >= 2 * NORMALIZED {
        return Err(reader.damaged());
    }
    Ok(AttributeInfo {
        morph_target,
        is_normalized: kind >= NORMALIZED,
        ..AttributeInfo::new(semantic, Domain::Vertex, components, component_type)
    })
}

fn write_text(bytes: &mut Vec<u8>, text: &str) {
    varint::write(bytes, text.len() as u64);
    bytes.extend_from_slice(text.as_bytes());
}

fn read_text(reader: &mut FieldReader<'_>) -> Result<String, DecodeError> {
    let length = reader.number()?;
    let bytes = reader.slice(usize::try_from(length).unwrap_or(usize::MAX))?;
    let text = str::from_utf8(bytes).map(str::to_owned);
    text.map_err(|_| reader.damaged())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layout_comes_back() {
        let mut layouts = Vec::new();
        for (number, semantic) in [
            Semantic::Normal,
            Semantic::Tangent,
            Semantic::TexCoord(300),
            Semantic::Color(1),
            Semantic::Joints(0),
            Semantic::Weights(0),
            Semantic::Other("_größe".into()),
            Semantic::Other(String::new()),
        ]
        .into_iter()
        .enumerate()
        {
            let mut info = AttributeInfo::new(semantic, Domain::Vertex, number + 1, TYPES[number]);
            info.is_normalized = number % 2 == 1;
            layouts.push(info.clone());
            info.morph_target = Some(u32::from(number > 4));
            layouts.push(info);
        }
        let mut bytes = Vec::new();
        write(&mut bytes, &layouts, "a name");
        let mut reader = FieldReader::new(&bytes, 0);
        let found = read(&mut reader).unwrap();
        assert_eq!(found, (layouts, "a name".to_owned()));
        reader.finish().unwrap();
        for cut in 0..bytes.len() {
            assert!(read(&mut FieldReader::new(&bytes[..cut], 0)).is_err());
        }
    }

    #[test]
    fn what_no_row_has_is_damage() {
        let row = |layouts: &[&[u8]]| {
            let mut bytes = vec![u8::try_from(layouts.len()).unwrap()];
            bytes.extend(layouts.concat());
            bytes.push(0);
            read(&mut FieldReader::new(&bytes, 0)).map(|found| found.0.len())
        };
        assert_eq!(row(&[&[1, 0, 3, 6]]), Ok(1));
        assert_eq!(row(&[&[1, 0, 3, 6], &[1, 1, 3, 6]]), Ok(2));
        let bad: [&[&[u8]]; 6] = [
            &[&[1, 0, 3, 6], &[1, 0, 2, 7]],
            &[&[1, 0, 0, 6]],
            &[&[0, 0, 3, 6]],
            &[&[8, 0, 3, 6]],
            &[&[1, 0, 3, 16]],
            &[&[7, 1, 0xff, 0, 3, 6]],
        ];
        for bad in bad {
            assert!(row(bad).is_err(), "{bad:?}");
        }
    }
}
