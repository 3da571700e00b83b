//! The lines of an OFF file that a selection leaves.
//!
//! The number of edges follows if it was right; in many files it is not.

use std::ops::Range;

use super::header::CountSpans;
use super::lines::FreeTokens;
use super::notation::OffNotation;
use crate::files::error::Problem;
use crate::files::select::{PlannedMesh, PlannedRecord, PlannedTriangle};
use crate::files::selected::{NewCounts, SelectNotation, SelectSource, SelectWriter, StoredCount};
use crate::files::text::{push_number, whole_number};
use crate::index::index32;

impl SelectNotation for OffNotation {
    fn select_writer<'a>(&'a self, source: &'a SelectSource<'a>) -> Box<dyn SelectWriter + 'a> {
        Box::new(OffSelect {
            notation: self,
            source,
            tokens: Vec::new(),
        })
    }
}

struct OffSelect<'a> {
    notation: &'a OffNotation,
    source: &'a SelectSource<'a>,
    tokens: Vec<Range<usize>>,
}

impl SelectWriter for OffSelect<'_> {
    fn counts(&self, counts: NewCounts<'_>) -> Vec<StoredCount> {
        let CountSpans {
            vertices,
            faces,
            edges,
        } = &self.notation.counts;
        let text = self.source.stored.source;
        let stored = |span: &Range<usize>| {
            let number = whole_number(&text[span.clone()])?;
            usize::try_from(number).ok()
        };
        let mut all = vec![(vertices, counts.vertices), (faces, counts.faces)];
        if let Some(span) = edges
            && let Some(mesh) = counts.planned
            && let Some(found) = stored(span).filter(|&count| count > 0)
            && found == self.edges(None)
        {
            all.push((span, self.edges(Some(mesh))));
        }
        all.retain(|&(span, new)| stored(span) != Some(new));
        let stored = all.into_iter().map(|(span, new)| StoredCount {
            span: span.clone(),
            new: new.to_string().into_bytes(),
        });
        stored.collect()
    }

    fn whole(&mut self, record: usize, out: &mut Vec<u8>) -> Result<(), Problem> {
        let (source, corners) = (self.source, &mut self.tokens);
        source.write_whole(self.notation, record, corners, out);
        Ok(())
    }

    fn triangle(&mut self, triangle: &PlannedTriangle, out: &mut Vec<u8>) -> Result<(), Problem> {
        let stored = &self.source.stored;
        let span = stored.faces.span(triangle.record as usize);
        let text = &stored.source[..span.end];
        let corner_count = stored.entry.corners_of(triangle.record as usize).count();
        let mut tokens = FreeTokens::new(text, span.start).take(1 + corner_count);

        // Three corners, with what stood before the first three.
        let vertices = triangle
            .corners
            .map(|vertex| self.source.new_number(vertex));
        let mut copied = span.start;
        for number in [3].into_iter().chain(vertices) {
            if let Some(token) = tokens.next() {
                out.extend_from_slice(&text[copied..token.start]);
                copied = token.end;
            }
            push_number(out, number.into());
        }
        if let Some(last) = tokens.last() {
            copied = last.end;
        }
        out.extend_from_slice(&text[copied..]);
        Ok(())
    }
}

impl OffSelect<'_> {
    /// How many edges the faces of the file have, or those that are planned.
    fn edges(&self, planned: Option<&PlannedMesh>) -> usize {
        let entry = self.source.stored.entry;
        let mut edges: Vec<[u32; 2]> = Vec::new();
        let mut add = |corners: &[u32]| {
            let next = corners.iter().skip(1).chain(corners.first());
            let pairs = corners.iter().zip(next);
            edges.extend(pairs.map(|(&a, &b)| [a.min(b), a.max(b)]));
        };
        let mut add_record = |planned: &PlannedRecord| match planned {
            PlannedRecord::Whole(record) => {
                let corners: Vec<u32> = entry.corners_of(*record as usize).collect();
                add(&corners);
            }
            PlannedRecord::Triangle(triangle) => add(&triangle.corners),
        };
        match planned {
            Some(mesh) => mesh.records.iter().for_each(add_record),
            None => (0..entry.record_count())
                .for_each(|record| add_record(&PlannedRecord::Whole(index32(record)))),
        }
        edges.sort_unstable();
        edges.dedup();
        edges.len()
    }
}
