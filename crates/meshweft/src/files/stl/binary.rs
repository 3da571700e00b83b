//! Binary STL: 80 bytes of anything, a count, 50 bytes a facet.

use std::ops::Range;

use super::attributes::{self, attribute_bytes, normal, position};
use super::facets::{FacetPlaces, Facets};
use crate::attribute::{Attribute, AttributeInfo, Values};
use crate::files::decoded::note_floats;
use crate::files::error::no_attribute;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::face_records::check_face_count;
use crate::files::rewrite::{Notation, Rewrite, StoredMesh};
use crate::files::slots::Spans;
use crate::files::unlisted::FoundKinds;
use crate::limits::Limits;

/// Where the first facet starts: after the header and the count.
pub(super) const HEADER: usize = 84;
/// A normal, three positions, two bytes of attributes.
pub(super) const FACET: usize = 50;
const NORMAL: usize = 12;
const POSITION: usize = 12;

/// Where the number of facets stands.
pub(super) const COUNT: Range<usize> = HEADER - 4..HEADER;

/// The number of facets that the header promises, if there is a header.
fn promised(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(COUNT)?;
    Some(u32::from_le_bytes(count.try_into().ok()?))
}

/// Whether a file that starts with `solid` is binary.
pub(super) fn is_sure(bytes: &[u8]) -> bool {
    promised(bytes).is_some_and(|count| {
        let length = HEADER as u64 + u64::from(count) * FACET as u64;
        bytes.len() as u64 == length || count.to_le_bytes().contains(&0)
    })
}

pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Facets, Problem> {
    let end = Place::Byte(bytes.len());
    let Some(count) = promised(bytes) else {
        let what = "the 84 bytes that a binary STL file starts with (an ascii one starts with the word solid)";
        return Err(FileErrorKind::truncated(what).at(end));
    };

    let there = (bytes.len() - HEADER) / FACET;
    // A count beyond 32 bits is one beyond what is there, whatever the width of `usize`.
    let wanted = usize::try_from(count).unwrap_or(usize::MAX);
    if there < wanted {
        let kind = match count.to_le_bytes().contains(&0) {
            true => FileErrorKind::truncated(format!("facet {there} of {count}")),
            // More than 16 million facets: rather something else than a file that was cut.
            false => FileErrorKind::malformed(format!(
                "{count} facets are promised and {there} are there: is it another format? An \
                 ascii STL file starts with the word solid"
            )),
        };
        return Err(kind.at(end));
    }

    check_face_count(wanted, limits).map_err(|kind| kind.at(Place::Byte(HEADER - 4)))?;

    let mut spans = Spans::new();
    let mut corners = Vec::with_capacity(wanted);
    for facet in 0..wanted {
        let start = HEADER + facet * FACET;
        let span = start..start + FACET;
        corners.push(positions(&bytes[span.clone()]));
        let pushed = spans.push(span);
        pushed.map_err(|kind| kind.at(Place::Byte(start)))?;
    }
    Ok(Facets {
        spans,
        runs: if wanted > 0 { vec![0] } else { Vec::new() },
        corners,
        name: "mesh".into(),
    })
}

/// The bits of the three positions of a facet, which is whole.
fn positions(facet: &[u8]) -> [[u32; 3]; 3] {
    let mut bits = [[0; 3]; 3];
    let (numbers, _) = facet[NORMAL..].as_chunks::<4>();
    for (value, bytes) in bits.as_flattened_mut().iter_mut().zip(numbers) {
        *value = u32::from_le_bytes(*bytes);
    }
    bits
}

/// Where the numbers of the facet at `span` stand.
pub(super) fn places(source: &[u8], span: Range<usize>) -> FacetPlaces {
    let at = |offset: usize, length: usize| {
        [0, 1, 2].map(|i| {
            let start = span.start + offset + i * length;
            start..start + length
        })
    };
    let bits = positions(&source[span.clone()]);
    note_floats(9);
    FacetPlaces {
        normal: at(0, NORMAL / 3),
        corners: at(NORMAL, POSITION),
        positions: bits.map(|corner| corner.map(f32::from_bits)),
    }
}

/// Turns the three positions of a facet.
pub(super) struct BinaryNotation;

impl Notation for BinaryNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        let Rewrite { change, out, .. } = rewrite;
        out.extend_from_slice(&record[..NORMAL]);
        for corner in 0..3 {
            let start = NORMAL + change.turned(corner, 3) * POSITION;
            out.extend_from_slice(&record[start..start + POSITION]);
        }
        out.extend_from_slice(&record[NORMAL + 3 * POSITION..]);
    }

    fn attributes(&self) -> Vec<AttributeInfo> {
        vec![position(), normal(), attribute_bytes()]
    }

    fn attribute(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        let records = stored.faces().map(|facet| &stored.source[facet.span]);
        let values = if *info == position() {
            Values::F32(attributes::positions(stored, |facet| {
                let bits = positions(&stored.source[facet.span.clone()]);
                note_floats(9);
                Ok(bits.map(|corner| corner.map(f32::from_bits)))
            })?)
        } else if *info == normal() {
            let numbers = records.flat_map(|record| record[..NORMAL].as_chunks().0);
            note_floats(3 * stored.faces.len());
            Values::F32(numbers.map(|&bytes| f32::from_le_bytes(bytes)).collect())
        } else if *info == attribute_bytes() {
            let numbers = records.flat_map(|record| record[FACET - 2..].as_chunks().0);
            Values::U16(numbers.map(|&bytes| u16::from_le_bytes(bytes)).collect())
        } else {
            return Err(no_attribute(info));
        };
        Ok(Attribute::new(info.clone(), values))
    }

    /// Of the header, which is text, some programs read a color and a material of the whole mesh.
    fn unlisted(&self, stored: &StoredMesh<'_>) -> FoundKinds {
        let mut found = FoundKinds::default();
        let header = &stored.source[..stored.source.len().min(HEADER)];
        for (word, what) in [
            (&b"COLOR="[..], "a color in the header (COLOR=)"),
            (b"MATERIAL=", "a material in the header (MATERIAL=)"),
        ] {
            if header.windows(word.len()).any(|it| it == word) {
                found.add(what);
            }
        }
        found
    }
}
