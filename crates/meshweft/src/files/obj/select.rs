//! The lines of an OBJ that a selection leaves.
//!
//! All `vt` and `vn` lines stay, and with them their numbers. Where vertices leave, numbers of vertices
//! that count back become plain ones. A corner that moves to another vertex names the texture coordinate
//! and normal that another corner there names; see [`CornerSources`].

use std::ops::Range;

use super::corners::{Named, corners, named};
use super::kinds::corner_kinds;
use super::notation::ObjNotation;
use super::statement::Statements;
use crate::files::corner_sources::{CornerSources, place_in_record};
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::options::ReadOptions;
use crate::files::rewrite::{Change, Notation, Rewrite};
use crate::files::select::{LEFT_OUT, PlannedTriangle, RecordCorner, face_problem};
use crate::files::selected::{NewCounts, SelectNotation, SelectSource, SelectWriter, StoredCount};
use crate::files::slots::Spans;
use crate::files::text::{Tokens, leading_number, line_of, push_number};

impl SelectNotation for ObjNotation {
    fn select_writer<'a>(&'a self, source: &'a SelectSource<'a>) -> Box<dyn SelectWriter + 'a> {
        Box::new(ObjSelect {
            notation: self,
            source,
            values: None,
            corners: None,
            tokens: Vec::new(),
            settled: Vec::new(),
        })
    }

    fn corner_kinds(&self, source: &SelectSource<'_>, options: &ReadOptions) -> Vec<u32> {
        corner_kinds(source, options)
    }
}

struct ObjSelect<'a> {
    notation: &'a ObjNotation,
    source: &'a SelectSource<'a>,
    /// Where the `vt` and the `vn` lines start, once that is asked for.
    values: Option<[Vec<usize>; 2]>,
    /// What the corners name, once that is asked for.
    corners: Option<CornerSources>,
    tokens: Vec<Range<usize>>,
    settled: Vec<u8>,
}

impl SelectWriter for ObjSelect<'_> {
    fn counts(&self, _counts: NewCounts<'_>) -> Vec<StoredCount> {
        Vec::new()
    }

    fn whole(&mut self, record: usize, out: &mut Vec<u8>) -> Result<(), Problem> {
        self.renumbered(self.source.stored.faces, record, out);
        Ok(())
    }

    fn triangle(&mut self, triangle: &PlannedTriangle, out: &mut Vec<u8>) -> Result<(), Problem> {
        let stored = &self.source.stored;
        let record = triangle.record as usize;
        let vertices: Vec<u32> = stored.entry.corners_of(record).collect();
        let own = || {
            triangle
                .places()
                .map(|place| RecordCorner { record, place })
        };
        let mut sources = triangle.sources.unwrap_or_else(own);
        if triangle.sources.is_none() {
            for (corner, source) in sources.iter_mut().enumerate() {
                *source = match place_in_record(&vertices, triangle, corner) {
                    Some(place) => RecordCorner { record, place },
                    None => self.all_corners().source(triangle, corner)?,
                };
            }
        }

        // The first three corners are these, the others leave.
        let span = stored.faces.span(record);
        let places = corners(stored.source, &span);
        let mut copied = span.start;
        for (corner, source) in sources.into_iter().enumerate() {
            let place = &places[corner];
            out.extend_from_slice(&stored.source[copied..place.start]);
            copied = place.end;
            let new = self.source.new_number(triangle.corners[corner]);
            push_number(out, u64::from(new) + 1);
            match source.record == record {
                true => {
                    let token = &stored.source[places[source.place].clone()];
                    out.extend_from_slice(glued(token));
                }
                false => {
                    let own = &places[triangle.places()[corner]];
                    self.push_glued(triangle, own, source, out)?;
                }
            }
        }
        let end = places.last().map_or(copied, |last| last.end);
        out.extend_from_slice(&stored.source[end..span.end]);
        Ok(())
    }

    fn line(&mut self, line: usize, out: &mut Vec<u8>) -> Result<(), Problem> {
        let text = self.source.stored.source;
        let span = self.source.lines.span(line);
        let above = self.above(span.start);
        let old_to_new = self.source.old_to_new;
        for token in corners(text, &span) {
            let [vertex, ..] = named(&text[token], above);
            let vertex = usize::try_from(vertex).ok().and_then(|v| v.checked_sub(1));
            if let Some(vertex) = vertex.filter(|&vertex| old_to_new.get(vertex) == Some(&LEFT_OUT))
            {
                let problem = format!(
                    "this line or point names vertex {vertex} (from 0), which is left out: keep it, or \
                     remove the line"
                );
                let place = Place::Line(line_of(text, span.start));
                return Err(FileErrorKind::unsupported(problem).at(place));
            }
        }
        self.renumbered(self.source.lines, line, out);
        Ok(())
    }
}

impl ObjSelect<'_> {
    /// Appends a face, line or point as it is, its vertices renumbered.
    fn renumbered(&mut self, spans: &Spans, record: usize, out: &mut Vec<u8>) {
        let change = Change {
            rotation: 0,
            old_to_new: self.source.old_to_new,
        };
        let span = spans.span(record);
        let mut text = &self.source.stored.source[span.clone()];
        if change.is_nothing() {
            return out.extend_from_slice(text);
        }

        // What counts back would count other vertices.
        let mut settled = std::mem::take(&mut self.settled);
        if text.contains(&b'-') {
            settled.clear();
            let above = self.above(span.start);
            self.notation.write_settled(text, above, &mut settled);
            text = &settled;
        }
        let corners = &mut self.tokens;
        let rewrite = Rewrite {
            change,
            corners,
            out,
        };
        self.notation.write_face(text, rewrite);
        self.settled = settled;
    }

    /// Appends what another corner names behind its vertex.
    fn push_glued(
        &mut self,
        triangle: &PlannedTriangle,
        own: &Range<usize>,
        source: RecordCorner,
        out: &mut Vec<u8>,
    ) -> Result<(), Problem> {
        let text = self.source.stored.source;
        let other = self.source.stored.faces.span(source.record);
        let above_other = self.above(other.start);
        let token = &corners(text, &other)[source.place];
        let found = named(&text[token.clone()], above_other);

        // Many readers look up at once what a face names.
        let above = self.above(own.start);
        let is_below = |named: Named| named.iter().zip(above).any(|(&n, above)| n > above as u64);
        if is_below(found) && !is_below(named(&text[own.clone()], above)) {
            let problem = "a corner moves to a vertex whose lines (v, vt, vn) stand below this face: move \
                           them to the top of the file first";
            return Err(face_problem(triangle.record, problem));
        }

        let mut rest = glued(&text[token.clone()]);
        let mut numbers = found[1..].iter();
        while let Some((slash, after)) = rest.split_first() {
            out.push(*slash);
            rest = after;
            let number = numbers.next();
            if let (Some((_, length)), Some(&number)) = (leading_number(rest), number) {
                push_number(out, number);
                rest = &rest[length..];
            }
        }
        Ok(())
    }

    fn all_corners(&mut self) -> &CornerSources {
        let entry = self.source.stored.entry;
        let all = self.corners.take();
        let all = all.unwrap_or_else(|| CornerSources::new(entry, |record| self.held(record)));
        self.corners.insert(all)
    }

    /// What each corner of a record names beside its vertex.
    fn held(&mut self, record: usize) -> Vec<Vec<u8>> {
        let text = self.source.stored.source;
        let span = self.source.stored.faces.span(record);
        let above = self.above(span.start);
        let held = |token: Range<usize>| {
            let [_, texture, normal] = named(&text[token], above);
            match [texture, normal] {
                [0, 0] => Vec::new(),
                both => both.map(u64::to_le_bytes).concat(),
            }
        };
        corners(text, &span).into_iter().map(held).collect()
    }

    /// How many `v`, `vt` and `vn` lines stand above `at` of the file.
    fn above(&mut self, at: usize) -> [usize; 3] {
        let stored = &self.source.stored;
        let [texture, normals] = self
            .values
            .get_or_insert_with(|| value_lines(stored.source));
        let above = |starts: &[usize]| starts.partition_point(|&start| start < at);
        [stored.vertices.above(at), above(texture), above(normals)]
    }
}

/// Where the `vt` and the `vn` lines of a text start.
fn value_lines(source: &[u8]) -> [Vec<usize>; 2] {
    let mut lines = [Vec::new(), Vec::new()];
    for span in Statements::new(source) {
        let keyword = Tokens::of_statement(&source[..span.end], span.start).next();
        match keyword.map(|keyword| &source[keyword]) {
            Some(b"vt") => lines[0].push(span.start),
            Some(b"vn") => lines[1].push(span.start),
            _ => {}
        }
    }
    lines
}

/// What stands behind the vertex of a corner.
fn glued(token: &[u8]) -> &[u8] {
    let length = leading_number(token).map_or(0, |(_, length)| length);
    &token[length..]
}
