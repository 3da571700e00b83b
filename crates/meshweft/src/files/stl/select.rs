//! The facets of an STL file that a selection leaves.
//!
//! A facet with other corners has the bytes of their positions, from facets that had these corners, and
//! the normal of its corners. One that is only turned keeps its normal.

use std::ops::Range;

use super::ascii::{self, AsciiNotation};
use super::binary::{self, BinaryNotation};
use super::facets::{FacetPlaces, normal_of};
use crate::files::error::Problem;
use crate::files::rewrite::Notation;
use crate::files::select::PlannedTriangle;
use crate::files::selected::{NewCounts, SelectNotation, SelectSource, SelectWriter, StoredCount};
use crate::index::index32;

/// What ascii and binary facets differ in.
pub(super) trait Facet: Notation {
    const IS_TEXT: bool;
    /// Takes a facet apart; `None` if it is none.
    fn places(source: &[u8], span: Range<usize>) -> Option<FacetPlaces>;
    /// Appends a number of a normal.
    fn push(number: f32, out: &mut Vec<u8>);
    /// Where the file says how many facets there are.
    fn count() -> Option<Range<usize>>;
}

impl Facet for AsciiNotation {
    const IS_TEXT: bool = true;

    fn places(source: &[u8], span: Range<usize>) -> Option<FacetPlaces> {
        ascii::places(source, span)
    }

    fn push(number: f32, out: &mut Vec<u8>) {
        out.extend_from_slice(number.to_string().as_bytes());
    }

    fn count() -> Option<Range<usize>> {
        None
    }
}

impl Facet for BinaryNotation {
    const IS_TEXT: bool = false;

    fn places(source: &[u8], span: Range<usize>) -> Option<FacetPlaces> {
        Some(binary::places(source, span))
    }

    fn push(number: f32, out: &mut Vec<u8>) {
        out.extend_from_slice(&number.to_le_bytes());
    }

    fn count() -> Option<Range<usize>> {
        Some(binary::COUNT)
    }
}

impl<N: Facet> SelectNotation for N {
    fn select_writer<'a>(&'a self, source: &'a SelectSource<'a>) -> Box<dyn SelectWriter + 'a> {
        let entry = source.stored.entry;
        let mut corner_of = vec![u32::MAX; entry.mesh.vertex_count()];
        for (corner, &vertex) in entry.mesh.faces().as_flattened().iter().enumerate().rev() {
            corner_of[vertex as usize] = index32(corner);
        }
        Box::new(StlSelect {
            source,
            corner_of,
            places: N::places,
            push: N::push,
            count: N::count(),
            is_text: N::IS_TEXT,
        })
    }
}

struct StlSelect<'a> {
    source: &'a SelectSource<'a>,
    /// The first corner of all that stands at each vertex.
    corner_of: Vec<u32>,
    places: fn(&[u8], Range<usize>) -> Option<FacetPlaces>,
    push: fn(f32, &mut Vec<u8>),
    count: Option<Range<usize>>,
    is_text: bool,
}

impl SelectWriter for StlSelect<'_> {
    fn is_text(&self) -> bool {
        self.is_text
    }

    fn counts(&self, counts: NewCounts<'_>) -> Vec<StoredCount> {
        let stored = self.count.clone().map(|span| StoredCount {
            span,
            new: index32(counts.faces).to_le_bytes().to_vec(),
        });
        stored.into_iter().collect()
    }

    fn whole(&mut self, record: usize, out: &mut Vec<u8>) -> Result<(), Problem> {
        let span = self.source.stored.faces.span(record);
        out.extend_from_slice(&self.source.stored.source[span]);
        Ok(())
    }

    fn triangle(&mut self, triangle: &PlannedTriangle, out: &mut Vec<u8>) -> Result<(), Problem> {
        let record = triangle.record as usize;
        let Some(places) = self.places_of(record) else {
            return self.whole(record, out);
        };

        // The corners that stand where these are to stand.
        let [a, b, c] = self.source.stored.entry.mesh.faces()[record];
        let turns = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
        let old = [a, b, c];
        let turn = turns
            .into_iter()
            .find(|turn| turn.map(|t| old[t]) == triangle.corners);
        let sources: [(usize, usize); 3] = match turn {
            Some(turn) => turn.map(|corner| (record, corner)),
            None => triangle.corners.map(|vertex| {
                let corner = self.corner_of[vertex as usize] as usize;
                (corner / 3, corner % 3)
            }),
        };
        let found = sources.map(|(record, corner)| {
            let places = self.places_of(record)?;
            Some((places.corners[corner].clone(), places.positions[corner]))
        });
        let [Some(first), Some(second), Some(third)] = found else {
            return self.whole(record, out);
        };
        let corners = [first, second, third];

        // The facet with these in the places of its own.
        let source = self.source.stored.source;
        let span = self.source.stored.faces.span(record);
        let mut copied = span.start;
        if turn.is_none() {
            let normal = normal_of(corners.each_ref().map(|(_, position)| *position));
            for (place, number) in places.normal.into_iter().zip(normal) {
                out.extend_from_slice(&source[copied..place.start]);
                (self.push)(number, out);
                copied = place.end;
            }
        }
        for (place, (corner, _)) in places.corners.into_iter().zip(corners) {
            out.extend_from_slice(&source[copied..place.start]);
            out.extend_from_slice(&source[corner]);
            copied = place.end;
        }
        out.extend_from_slice(&source[copied..span.end]);
        Ok(())
    }
}

impl StlSelect<'_> {
    fn places_of(&self, record: usize) -> Option<FacetPlaces> {
        let stored = &self.source.stored;
        (self.places)(stored.source, stored.faces.span(record))
    }
}
