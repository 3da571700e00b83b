//! Object File Format (Geomview), ascii: vertex lines and face lines move.
//!
//! One line is one record, as nearly every writer has it: the numbers after those that are needed
//! (colours of faces, or what a program adds to a vertex) go along with their line. The keyword may
//! be missing, the number of edges may be missing or wrong, as in many files that are around.
//!
//! Attributes, where the format leaves room:
//!
//! - Positions and normals have three components: the first three numbers (of `4OFF` too, whose
//!   fourth is one to divide by), and zeros where there are fewer.
//! - Colours are the numbers that `COFF` puts last, and those after the corners of faces, if all
//!   lines have three or all have four. If every one is a whole number from 0 to 255 they are bytes
//!   that stand for fractions, else numbers as they are written. A single number is an entry in a
//!   table that is not in the file, and is not listed.
//! - Texture coordinates come after the colours, so they are listed if the colours are, or there
//!   are none.

mod columns;
mod header;
mod lines;

use std::ops::Range;

use super::content::ReadResult;
use super::entry::MeshEntry;
use super::error::no_attribute;
use super::error::{FileErrorKind, Place, Problem};
use super::face_records::{FaceRecords, corner_vertex};
use super::note::Note;
use super::options::ReadOptions;
use super::orders::RecordOrders;
use super::record_file::RecordFile;
use super::rewrite::{Notation, Rewrite, StoredMesh, vertex_from_zero};
use super::slots::Spans;
use super::text::is_coordinate;
use super::text::{Tokens, shown, whole_number};
use crate::Mesh;
use crate::attribute::{Attribute, AttributeInfo};
use crate::limits::Limits;
use columns::{ColourColumns, OffColumn};
use header::OffHeader;
use lines::Lines;

/// Reads an OFF file.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let limits = &options.limits;
    let mut lines = Lines {
        text: &bytes,
        at: if bytes.starts_with(b"\xef\xbb\xbf") {
            3
        } else {
            0
        },
    };
    let header = header::header(&mut lines, limits)?;
    let (vertices, vertex_colours) = vertices(&mut lines, &header)?;
    let FaceLines {
        spans: faces,
        records,
        colours,
    } = faces(&mut lines, &header, limits)?;

    let (mut entries, mut notes) = (Vec::new(), Vec::new());
    if records.len() == 0 {
        notes.push(Note::nothing_to_order());
    } else {
        let mesh = Mesh::connectivity_only(vertices.len(), records.faces);
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        entries.push(MeshEntry {
            name: "mesh".into(),
            mesh,
            runs: vec![0],
            vertex_group: 0,
            faces_movable: true,
            vertices_movable: true,
            corners_turnable: records.polygons.is_none(),
            polygons: records.polygons,
        });
    }

    let file = RecordFile {
        source: bytes,
        vertices,
        faces,
        companions: Vec::new(),
        lines: Spans::new(),
        notation: OffNotation {
            columns: columns::columns(&header, &vertex_colours, &colours),
        },
        entries,
        orders: RecordOrders::default(),
    };
    Ok((Box::new(file), notes))
}

/// Finds the vertex lines, and what they have of colours.
fn vertices(lines: &mut Lines<'_>, header: &OffHeader) -> Result<(Spans, ColourColumns), Problem> {
    let mut spans = Spans::new();
    let mut colours = ColourColumns::new();
    let before_colours = header.dimension.saturating_add(header.normal);
    let mut rest = Vec::new();
    for vertex in 0..header.vertex_count {
        let line = lines.next().ok_or_else(|| {
            lines.truncated(format!("vertex {vertex} of {}", header.vertex_count))
        })?;

        let mut tokens = lines.tokens(&line);
        let mut found = 0;
        for token in tokens.by_ref().take(header.dimension.min(3)) {
            let token = &lines.text[token];
            if !is_coordinate(token) {
                let text = format!("{} is not a coordinate: write a number", shown(token));
                return Err(lines.malformed(line.start, format!("vertex {vertex}: {text}")));
            }
            found += 1;
        }

        if found < header.vertex_numbers {
            found += tokens.take(header.vertex_numbers - found).count();
        }
        if found < header.vertex_numbers {
            let needed = header.vertex_numbers;
            let text =
                format!("vertex {vertex} has {found} numbers on its line and needs {needed}");
            return Err(lines.malformed(line.start, text));
        }

        if header.has_colours && colours.is_possible() {
            rest.clear();
            // One more than a colour of four, so that longer ones are seen.
            let most = 5 + header.texture;
            rest.extend(lines.tokens(&line).skip(before_colours).take(most));
            rest.truncate(rest.len() - header.texture);
            colours.add(lines.text, rest.drain(..));
        }

        let at = line.start;
        spans.push(line).map_err(|kind| lines.problem(at, kind))?;
    }
    Ok((spans, colours))
}

/// What the face lines hold.
struct FaceLines {
    spans: Spans,
    records: FaceRecords,
    colours: ColourColumns,
}

fn faces(lines: &mut Lines<'_>, header: &OffHeader, limits: &Limits) -> Result<FaceLines, Problem> {
    let mut spans = Spans::new();
    let mut records = FaceRecords::default();
    let mut colours = ColourColumns::new();
    // In text each number has something after it.
    let left = lines.text.len() - lines.at;
    records.reserve(lines.at_most(header.face_count, 2), left / 2);
    let mut corners = Vec::new();
    for face in 0..header.face_count {
        let line = lines
            .next()
            .ok_or_else(|| lines.truncated(format!("face {face} of {}", header.face_count)))?;
        let rest = face_corners(lines, &line, face, header.vertex_count, &mut corners)?;
        colours.add(lines.text, rest);
        let at = line.start;
        let pushed = records.push(&corners, limits);
        let pushed = pushed.and_then(|()| spans.push(line));
        pushed.map_err(|kind| lines.problem(at, kind))?;
    }
    Ok(FaceLines {
        spans,
        records,
        colours,
    })
}

/// Reads the corners of one face line; gives what follows them.
fn face_corners<'a>(
    lines: &Lines<'a>,
    line: &Range<usize>,
    face: usize,
    vertex_count: usize,
    corners: &mut Vec<u32>,
) -> Result<Tokens<'a>, Problem> {
    let malformed = |text: String| lines.malformed(line.start, format!("face {face}{text}"));
    corners.clear();
    let mut tokens = lines.tokens(line);

    let promised = tokens.next().unwrap_or(line.start..line.start);
    let promised = &lines.text[promised];
    let corner_count = whole_number(promised).and_then(|n| usize::try_from(n).ok());
    let corner_count = corner_count
        .ok_or_else(|| malformed(format!(": {} is not a number of corners", shown(promised))))?;

    for corner in 0..corner_count {
        let token = tokens.next().ok_or_else(|| {
            malformed(format!(
                " has {corner} corners on its line, not the {corner_count} it says"
            ))
        })?;
        let token = &lines.text[token];
        let number = whole_number(token).ok_or_else(|| {
            malformed(format!(
                ", corner {corner}: {} is not a vertex number",
                shown(token)
            ))
        })?;
        let vertex = corner_vertex(number, vertex_count, face, corner);
        corners.push(vertex.map_err(|kind| lines.problem(line.start, kind))?);
    }
    Ok(tokens)
}

/// How corners stand in face lines: after their number. And what else lines hold.
struct OffNotation {
    columns: Vec<OffColumn>,
}

impl Notation for OffNotation {
    fn write_face(&self, record: &[u8], rewrite: Rewrite<'_>) {
        let mut tokens = Tokens::plain(record, 0);
        let corner_count = tokens.next().and_then(|token| whole_number(&record[token]));
        let corner_count = corner_count.and_then(|n| usize::try_from(n).ok());
        rewrite.corners.clear();
        rewrite
            .corners
            .extend(tokens.take(corner_count.unwrap_or(0)));
        rewrite.write_corners(record, 0, vertex_from_zero);
    }

    fn attributes(&self) -> Vec<AttributeInfo> {
        let infos = self.columns.iter().map(|column| column.info.clone());
        infos.collect()
    }

    fn attribute(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        let mut columns = self.columns.iter();
        let column = columns.find(|column| column.info == *info);
        let column = column.ok_or_else(|| no_attribute(info))?;
        column.read(stored)
    }
}
