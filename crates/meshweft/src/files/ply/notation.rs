//! Writing the corners of a PLY face.

use super::attributes::PlyAttributes;
use super::header::{COMPANION, Element, Encoding, PlyHeader, PropertyKind};
use super::rows::{Ascii, Binary, PlyRows, Row};
use super::unlisted::unlisted;
use crate::attribute::{Attribute, AttributeInfo, ComponentType};
use crate::files::error::Problem;
use crate::files::rewrite::{Change, Notation, Rewrite, StoredMesh, vertex_from_zero};
use crate::files::text::Tokens;
use crate::files::unlisted::FoundKinds;

/// How corners stand in face rows, and what else rows hold.
pub(super) struct PlyNotation {
    pub(super) encoding: Encoding,
    vertex: Option<Element>,
    /// The face element, and which of its properties is the list of corners.
    pub(super) face: Option<(Element, usize)>,
    /// The element whose rows go with the faces.
    pub(super) companion: Option<Element>,
    /// How many bytes of a binary row come before the first corner, and the type of corners, where
    /// that is the same in all rows.
    first_corner: Option<(usize, ComponentType)>,
    has_texture: bool,
}

impl PlyNotation {
    /// `has_companion`: whether rows go with the faces; `has_texture`: as
    /// [`PlyAttributes::has_texture`].
    pub(super) fn new(header: PlyHeader, has_companion: bool, has_texture: bool) -> Self {
        let encoding = header.encoding;
        let (mut vertex, mut face, mut companion) = (None, None, None);
        for element in header.elements {
            match element.name.as_str() {
                "vertex" => vertex = Some(element),
                "face" => face = element.corner_list().map(|list| (element, list)),
                COMPANION if has_companion => companion = Some(element),
                _ => {}
            }
        }
        let mut notation = Self {
            encoding,
            vertex,
            face,
            companion,
            first_corner: None,
            has_texture,
        };
        notation.first_corner = notation.find_first_corner();
        notation
    }

    /// Whether rows of faces, or those that go with them, may hold something for each corner.
    pub(super) fn has_lists(&self) -> bool {
        let count = |element: &Element| {
            let properties = element.properties.iter();
            let lists = properties.filter(|p| matches!(p.kind, PropertyKind::List { .. }));
            lists.count()
        };
        let of_faces = self.face.as_ref().map_or(0, |(element, _)| count(element));
        of_faces > 1 || self.companion.as_ref().map_or(0, count) > 0
    }

    fn stored_values(&self) -> PlyAttributes<'_> {
        PlyAttributes {
            encoding: self.encoding,
            vertex: self.vertex.as_ref(),
            face: self.face.as_ref().map(|(face, _)| face),
            has_texture: self.has_texture,
        }
    }

    fn find_first_corner(&self) -> Option<(usize, ComponentType)> {
        let (element, list) = self.face.as_ref()?;
        if self.encoding == Encoding::Ascii {
            return None;
        }
        let mut offset = 0;
        for property in &element.properties[..*list] {
            match property.kind {
                PropertyKind::Scalar(scalar) => offset += scalar.size(),
                PropertyKind::List { .. } => return None,
            }
        }
        match element.properties[*list].kind {
            // A length in one byte is read at once.
            PropertyKind::List { count, item } if count.size() == 1 => Some((offset + 1, item)),
            _ => None,
        }
    }

    /// Where the corners of a row start, how many there are, and their type.
    fn corners<R: PlyRows>(&self, mut rows: R) -> Option<(usize, usize, ComponentType)> {
        let (element, list) = self.face.as_ref()?;
        let row = Row { element, number: 0 };
        for (number, property) in element.properties.iter().enumerate() {
            // The row was read before: nothing can be wrong with it now.
            match property.kind {
                PropertyKind::Scalar(scalar) => rows.skip(1, scalar, &row).ok()?,
                PropertyKind::List { count, item } => {
                    let count = rows.list_length(count, &row).ok()?;
                    if number == *list {
                        return Some((rows.at(), count, item));
                    }
                    rows.skip(count, item, &row).ok()?;
                }
            }
        }
        None
    }

    fn write_binary<const BIG: bool>(
        record: &[u8],
        at: (usize, usize, ComponentType),
        change: Change<'_>,
        out: &mut Vec<u8>,
    ) {
        let (start, count, item) = at;
        let size = item.size();
        let copy_start = out.len();
        out.extend_from_slice(record);

        // The usual size, without a copy of each index.
        if size == 4 {
            let corners = record[start..].as_chunks::<4>().0;
            let slots = out[copy_start + start..].as_chunks_mut::<4>().0;
            for (corner, slot) in slots.iter_mut().take(count).enumerate() {
                let bytes = corners[change.turned(corner, count)];
                *slot = match (change.old_to_new.is_empty(), BIG) {
                    (true, _) => bytes,
                    (_, true) => {
                        change.old_to_new[u32::from_be_bytes(bytes) as usize].to_be_bytes()
                    }
                    (_, false) => {
                        change.old_to_new[u32::from_le_bytes(bytes) as usize].to_le_bytes()
                    }
                };
            }
            return;
        }

        for corner in 0..count {
            let turned = start + change.turned(corner, count) * size;
            let bytes = &record[turned..turned + size];
            let old = unsigned::<BIG>(bytes);
            let new = change.old_to_new.get(old);
            let renewed;
            let bytes = match new {
                Some(&new) if BIG => {
                    renewed = new.to_be_bytes();
                    &renewed[4 - size..]
                }
                Some(&new) => {
                    renewed = new.to_le_bytes();
                    &renewed[..size]
                }
                None => bytes,
            };
            let place = copy_start + start + corner * size;
            out[place..place + size].copy_from_slice(bytes);
        }
    }
}

/// The usual row of a binary file, a triangle and nothing else, with its corners changed.
#[inline]
fn triangle_row<const BIG: bool>(row: &[u8; 13], change: Change<'_>) -> [u8; 13] {
    let [count, corners @ ..] = row;
    let (corners, _) = corners.as_chunks::<4>();
    let mut changed = [*count; 13];
    let (slots, _) = changed[1..].as_chunks_mut::<4>();
    for (corner, slot) in slots.iter_mut().enumerate() {
        let bytes = corners[change.turned(corner, 3)];
        *slot = match (change.old_to_new.is_empty(), BIG) {
            (true, _) => bytes,
            (_, true) => change.old_to_new[u32::from_be_bytes(bytes) as usize].to_be_bytes(),
            (_, false) => change.old_to_new[u32::from_le_bytes(bytes) as usize].to_le_bytes(),
        };
    }
    changed
}

/// An index of up to four bytes; negative ones were refused when the file was read.
#[inline]
fn unsigned<const BIG: bool>(bytes: &[u8]) -> usize {
    let append = |number: usize, &byte: &u8| number << 8 | usize::from(byte);
    match BIG {
        true => bytes.iter().fold(0, append),
        false => bytes.iter().rev().fold(0, append),
    }
}

impl Notation for PlyNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        let change = rewrite.change;
        if let (Some((1, item)), Ok(row)) = (self.first_corner, <&[u8; 13]>::try_from(record))
            && (item.size(), row[0]) == (4, 3)
        {
            rewrite.out.extend_from_slice(&match self.encoding {
                Encoding::BigEndian => triangle_row::<true>(row, change),
                _ => triangle_row::<false>(row, change),
            });
            return;
        }

        let at_once = self.first_corner.and_then(|(first, item)| {
            let count = usize::from(*record.get(first - 1)?);
            Some((first, count, item))
        });
        let corners = match self.encoding {
            _ if at_once.is_some() => at_once,
            Encoding::Ascii => self.corners(Ascii::new(record, 0)),
            Encoding::LittleEndian => self.corners(Binary::<false>::new(record, 0)),
            Encoding::BigEndian => self.corners(Binary::<true>::new(record, 0)),
        };
        let Some(corners) = corners else {
            return rewrite.out.extend_from_slice(record);
        };

        match self.encoding {
            Encoding::Ascii => {
                let (start, count, _) = corners;
                rewrite.corners.clear();
                rewrite
                    .corners
                    .extend(Tokens::plain(record, start).take(count));
                rewrite.write_corners(record, 0, vertex_from_zero);
            }
            Encoding::LittleEndian => {
                Self::write_binary::<false>(record, corners, change, rewrite.out);
            }
            Encoding::BigEndian => {
                Self::write_binary::<true>(record, corners, change, rewrite.out);
            }
        }
    }

    fn attributes(&self) -> Vec<AttributeInfo> {
        self.stored_values().infos()
    }

    fn attribute(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        self.stored_values().read(stored, info)
    }

    fn unlisted(&self, stored: &StoredMesh<'_>) -> FoundKinds {
        unlisted(stored.source, self.has_texture)
    }
}
