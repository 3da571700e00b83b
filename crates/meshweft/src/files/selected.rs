//! Copies a file without the records that a selection leaves out.
//!
//! What stays keeps its place: the gaps between records are copied. In text, a record that leaves takes
//! its line along if nothing else stands on it, and records that become several stand on lines of their
//! own.

use std::ops::Range;

use super::error::{FileErrorKind, Place, Problem};
use super::options::ReadOptions;
use super::rewrite::{Change, Notation, Rewrite, StoredMesh};
use super::select::{LEFT_OUT, PlannedMesh, PlannedRecord, PlannedTriangle, SelectPlan};
use super::slots::Spans;
use super::text::{is_blank, is_line_end};
use crate::index::index32;

/// The records of a file, none moved, and the new numbers of its vertices.
pub(super) struct SelectSource<'a> {
    pub(super) stored: StoredMesh<'a>,
    /// Rows that hang on the faces one by one.
    pub(super) companions: &'a [Spans],
    /// Lines that name vertices.
    pub(super) lines: &'a Spans,
    /// As [`PlannedVertices`](super::select::PlannedVertices) has it; empty if all stay.
    pub(super) old_to_new: &'a [u32],
}

impl SelectSource<'_> {
    /// The new number of a vertex that stays.
    pub(super) fn new_number(&self, vertex: u32) -> u32 {
        let new = self.old_to_new.get(vertex as usize);
        new.copied().unwrap_or(vertex)
    }

    /// Appends a face record as it is, its vertices renumbered by `notation`; `corners` is scratch.
    pub(super) fn write_whole(
        &self,
        notation: &impl Notation,
        record: usize,
        corners: &mut Vec<Range<usize>>,
        out: &mut Vec<u8>,
    ) {
        let change = Change {
            rotation: 0,
            old_to_new: self.old_to_new,
        };
        let record = &self.stored.source[self.stored.faces.span(record)];
        if change.is_nothing() {
            return out.extend_from_slice(record);
        }
        let rewrite = Rewrite {
            change,
            corners,
            out,
        };
        notation.write_face(record, rewrite);
    }
}

/// A number that a file stores of how many records it has.
pub(super) struct StoredCount {
    /// Where it stands.
    pub(super) span: Range<usize>,
    /// The text or bytes that stand there instead.
    pub(super) new: Vec<u8>,
}

/// How many records there will be.
#[derive(Debug, Clone, Copy)]
pub(super) struct NewCounts<'a> {
    pub(super) vertices: usize,
    pub(super) faces: usize,
    /// The face records, unless all stay.
    pub(super) planned: Option<&'a PlannedMesh>,
}

/// How a format writes the records that stay.
pub(super) trait SelectWriter {
    /// Whether records stand on lines.
    fn is_text(&self) -> bool {
        true
    }
    /// The counts that change, rising.
    fn counts(&self, counts: NewCounts<'_>) -> Vec<StoredCount>;
    /// Appends a face record as it is, its vertices renumbered.
    fn whole(&mut self, record: usize, out: &mut Vec<u8>) -> Result<(), Problem>;
    /// Appends a triangle of a face record.
    fn triangle(&mut self, triangle: &PlannedTriangle, out: &mut Vec<u8>) -> Result<(), Problem>;
    /// Appends what goes with a triangle of the row of companions that goes with its record.
    fn companion(
        &mut self,
        _companions: usize,
        _triangle: &PlannedTriangle,
        _out: &mut Vec<u8>,
    ) -> Result<(), Problem> {
        Ok(())
    }
    /// Appends a line that names vertices, and stays.
    fn line(&mut self, _line: usize, _out: &mut Vec<u8>) -> Result<(), Problem> {
        Ok(())
    }
}

/// A notation whose records can be left out.
pub(super) trait SelectNotation: Notation {
    /// Writes the records of a file.
    fn select_writer<'a>(&'a self, source: &'a SelectSource<'a>) -> Box<dyn SelectWriter + 'a>;
    /// See [`Content::corner_kinds`](super::content::Content::corner_kinds).
    fn corner_kinds(&self, _source: &SelectSource<'_>, _options: &ReadOptions) -> Vec<u32> {
        Vec::new()
    }
}

/// A file without what was left out, and where its records stand.
pub(super) struct SelectedFile {
    pub(super) bytes: Vec<u8>,
    pub(super) vertices: Spans,
    pub(super) faces: Spans,
}

/// What stands at the places of a layer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LayerOf {
    Vertices,
    /// What hangs on the vertices one by one.
    VertexRows,
    Faces,
    Companions(usize),
    Lines,
    Counts,
}

/// Writes the file without what `plan` leaves out of its one mesh; `rows` hang on the vertices.
pub(super) fn write(
    source: &SelectSource<'_>,
    plan: &SelectPlan,
    rows: Option<&Spans>,
    writer: &mut dyn SelectWriter,
) -> Result<SelectedFile, Problem> {
    let StoredMesh {
        source: bytes,
        vertices,
        faces,
        ..
    } = source.stored;
    let planned = plan.mesh(0);
    let left_out = |vertex: usize| source.old_to_new.get(vertex) == Some(&LEFT_OUT);
    let at_file = |kind: FileErrorKind| kind.at(Place::File);

    // The counts.
    let vertices_leave = (0..vertices.len()).filter(|&vertex| left_out(vertex));
    let counts = writer.counts(NewCounts {
        vertices: vertices.len() - vertices_leave.count(),
        faces: planned.map_or(faces.len(), |mesh| mesh.records.len()),
        planned,
    });
    let mut count_spans = Spans::new();
    for count in &counts {
        count_spans.push(count.span.clone()).map_err(at_file)?;
    }

    // All that may change, each kind in the order in which it stands.
    let mut layers = vec![(LayerOf::Counts, &count_spans)];
    layers.push((LayerOf::Faces, faces));
    let companions = source.companions.iter().enumerate();
    layers.extend(companions.map(|(i, spans)| (LayerOf::Companions(i), spans)));
    layers.push((LayerOf::Vertices, vertices));
    if !source.old_to_new.is_empty() {
        layers.push((LayerOf::Lines, source.lines));
        layers.extend(rows.map(|rows| (LayerOf::VertexRows, rows)));
    }
    let mut next = vec![0; layers.len()];
    let mut planned_from = vec![0; layers.len()];

    let mut out = SelectOutput {
        source: bytes,
        is_text: writer.is_text(),
        copied: 0,
        bytes: Vec::with_capacity(bytes.len()),
    };
    let (mut new_vertices, mut new_faces) = (Spans::new(), Spans::new());
    loop {
        // What comes first of all that is left.
        let starts = layers.iter().zip(&next);
        let starts = starts.map(|((_, spans), &next)| spans.start(next));
        let first = starts.enumerate().min_by_key(|&(_, start)| start);
        let Some((turn, _)) = first.filter(|&(_, start)| start != usize::MAX) else {
            break;
        };
        let (layer, spans) = layers[turn];
        let slot = next[turn];
        let span = spans.span(slot);
        next[turn] += 1;

        match layer {
            LayerOf::Counts => {
                let new = &counts[slot].new;
                out.put(&span, |out| {
                    out.extend_from_slice(new);
                    Ok(())
                })?;
            }
            LayerOf::Lines => {
                out.put(&span, |out| writer.line(slot, out))?;
            }
            LayerOf::Vertices | LayerOf::VertexRows if left_out(slot) => out.leave_out(&span),
            LayerOf::Vertices | LayerOf::VertexRows => {
                let put = out.put(&span, |out| {
                    out.extend_from_slice(&bytes[span.clone()]);
                    Ok(())
                })?;
                if layer == LayerOf::Vertices {
                    new_vertices.push(put).map_err(at_file)?;
                }
            }
            LayerOf::Faces | LayerOf::Companions(_) => {
                let whole = [PlannedRecord::Whole(index32(slot))];
                let records = match planned {
                    Some(mesh) => taken(&mesh.records, &mut planned_from[turn], slot),
                    None => &whole,
                };
                for (number, planned) in records.iter().enumerate() {
                    let put = out.put_one(&span, number, |out| match (layer, planned) {
                        (LayerOf::Companions(_), PlannedRecord::Whole(_)) => {
                            out.extend_from_slice(&bytes[span.clone()]);
                            Ok(())
                        }
                        (LayerOf::Companions(which), PlannedRecord::Triangle(triangle)) => {
                            writer.companion(which, triangle, out)
                        }
                        (_, PlannedRecord::Whole(_)) => writer.whole(slot, out),
                        (_, PlannedRecord::Triangle(triangle)) => writer.triangle(triangle, out),
                    })?;
                    if layer == LayerOf::Faces {
                        new_faces.push(put).map_err(at_file)?;
                    }
                }
                if records.is_empty() {
                    out.leave_out(&span);
                }
            }
        }
    }
    out.copy_to(bytes.len());
    Ok(SelectedFile {
        bytes: out.bytes,
        vertices: new_vertices,
        faces: new_faces,
    })
}

/// The planned records, from `from` on, that are made of this record; `from` is moved past them.
fn taken<'a>(all: &'a [PlannedRecord], from: &mut usize, record: usize) -> &'a [PlannedRecord] {
    let rest = &all[*from..];
    let is_of = |planned: &&PlannedRecord| planned.record() as usize == record;
    let count = rest.iter().take_while(is_of).count();
    *from += count;
    &rest[..count]
}

/// A copy of a file in the making.
struct SelectOutput<'a> {
    source: &'a [u8],
    is_text: bool,
    /// How much of the source has been copied or left out.
    copied: usize,
    bytes: Vec<u8>,
}

impl SelectOutput<'_> {
    /// Copies the source up to `end`.
    fn copy_to(&mut self, end: usize) {
        self.bytes.extend_from_slice(&self.source[self.copied..end]);
        self.copied = end;
    }

    /// Puts something in the place of what stands at `span`; where it then stands.
    fn put(
        &mut self,
        span: &Range<usize>,
        write: impl FnOnce(&mut Vec<u8>) -> Result<(), Problem>,
    ) -> Result<Range<usize>, Problem> {
        self.put_one(span, 0, write)
    }

    /// As [`put`](Self::put), of several things at one place the one with this number.
    fn put_one(
        &mut self,
        span: &Range<usize>,
        number: usize,
        write: impl FnOnce(&mut Vec<u8>) -> Result<(), Problem>,
    ) -> Result<Range<usize>, Problem> {
        if number == 0 {
            self.copy_to(span.start);
        } else if self.is_text {
            let separator = self.separator(span);
            self.bytes.extend_from_slice(separator);
        }
        let start = self.bytes.len();
        write(&mut self.bytes)?;
        self.copied = span.end;
        Ok(start..self.bytes.len())
    }

    /// Leaves out what stands at `span`, with its line if it is alone there.
    fn leave_out(&mut self, span: &Range<usize>) {
        let line = match self.is_text {
            true => self.line_of_its_own(span),
            false => None,
        };
        let left_out = line.as_ref().unwrap_or(span);
        self.copy_to(left_out.start);
        self.copied = left_out.end;
    }

    /// The whole lines that `span` stands on, if nothing else does.
    fn line_of_its_own(&self, span: &Range<usize>) -> Option<Range<usize>> {
        let start = self.line_start(span)?;
        let rest = self.source[span.end..].iter();
        let end = span.end + rest.take_while(|&&byte| is_blank(byte)).count();
        match self.source.get(end) {
            None => Some(start..end),
            Some(&byte) if is_line_end(byte) => {
                Some(start..end + line_end_at(self.source, end).len())
            }
            Some(_) => None,
        }
    }

    /// The start of the line that `span` starts on, if nothing stands before it there.
    fn line_start(&self, span: &Range<usize>) -> Option<usize> {
        let before = self.source[self.copied.min(span.start)..span.start].iter();
        let blanks = before.rev().take_while(|&&byte| is_blank(byte)).count();
        let start = span.start - blanks;
        let is_start = start == 0 || is_line_end(self.source[start - 1]);
        is_start.then_some(start)
    }

    /// What stands between two records that were one: a line end where it began its line, else a blank.
    fn separator(&self, span: &Range<usize>) -> &'static [u8] {
        let line = &self.source[..span.start];
        let blanks = line
            .iter()
            .rev()
            .take_while(|&&byte| is_blank(byte))
            .count();
        let start = span.start - blanks;
        if start > 0 && !is_line_end(self.source[start - 1]) {
            return b" ";
        }
        let first = self.source.iter().position(|&byte| is_line_end(byte));
        first.map_or(b"\n", |first| line_end_at(self.source, first))
    }
}

/// The line end that starts at `at`.
fn line_end_at(text: &[u8], at: usize) -> &'static [u8] {
    match (text[at], text.get(at + 1)) {
        (b'\r', Some(b'\n')) => b"\r\n",
        (b'\r', _) => b"\r",
        _ => b"\n",
    }
}
