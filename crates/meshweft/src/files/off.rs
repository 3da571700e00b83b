//! Object File Format (Geomview), ascii: vertex lines and face lines move.
//!
//! One line is one record, as nearly every writer has it: the numbers after those that are needed
//! (colours of faces, or what a program adds to a vertex) go along with their line. The keyword may
//! be missing, the number of edges may be missing or wrong, as in many files that are around.

use std::ops::Range;

use super::content::ReadResult;
use super::entry::MeshEntry;
use super::error::{FileErrorKind, Place, Problem};
use super::face_records::{FaceRecords, check_face_count, check_vertex_count, corner_vertex};
use super::note::Note;
use super::options::ReadOptions;
use super::orders::RecordOrders;
use super::record_file::RecordFile;
use super::rewrite::{Notation, Rewrite, vertex_from_zero};
use super::slots::Spans;
use super::text::{
    Tokens, coordinate, is_blank, is_line_end, line_end, line_of, shown, trimmed, whole_number,
};
use crate::Mesh;
use crate::limits::Limits;

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
    let header = header(&mut lines, limits)?;
    let (vertices, positions) = vertices(&mut lines, &header)?;
    let (faces, records) = faces(&mut lines, &header, limits)?;

    let (mut entries, mut notes) = (Vec::new(), Vec::new());
    if records.len() == 0 {
        notes.push(Note::nothing_to_order());
    } else {
        let mesh = Mesh::new(positions, records.faces);
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        entries.push(MeshEntry {
            name: "mesh".into(),
            mesh,
            runs: vec![0],
            vertex_group: 0,
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
        notation: OffNotation,
        entries,
        orders: RecordOrders::default(),
    };
    Ok((Box::new(file), notes))
}

/// The lines that hold something, without their comments.
struct Lines<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<Range<usize>> {
        while self.at < self.text.len() {
            let byte = self.text[self.at];
            if is_blank(byte) || is_line_end(byte) {
                self.at += 1;
                continue;
            }
            let end = line_end(self.text, self.at);
            let line = &self.text[self.at..end];
            let content = line.iter().position(|&b| b == b'#').unwrap_or(line.len());
            let span = trimmed(self.text, self.at, self.at + content);
            self.at = end;
            if !span.is_empty() {
                return Some(span);
            }
        }
        None
    }

    fn tokens(&self, line: &Range<usize>) -> Tokens<'a> {
        Tokens::plain(&self.text[..line.end], line.start)
    }

    /// An upper bound of the records that can still come, each of `bytes` bytes or more.
    fn at_most(&self, count: usize, bytes: usize) -> usize {
        count.min((self.text.len() - self.at) / bytes + 1)
    }

    fn problem(&self, at: usize, kind: FileErrorKind) -> Problem {
        kind.at(Place::Line(line_of(self.text, at)))
    }

    fn malformed(&self, at: usize, text: impl Into<String>) -> Problem {
        self.problem(at, FileErrorKind::malformed(text))
    }

    fn truncated(&self, what: impl Into<String>) -> Problem {
        self.problem(self.text.len(), FileErrorKind::truncated(what))
    }
}

struct OffHeader {
    vertex_count: usize,
    face_count: usize,
    /// How many coordinates a vertex has.
    dimension: usize,
    /// How many numbers a vertex line has at least.
    vertex_numbers: usize,
}

/// Reads the keyword and the counts.
fn header(lines: &mut Lines<'_>, limits: &Limits) -> Result<OffHeader, Problem> {
    let text = lines.text;
    let mut tokens: Vec<Range<usize>> = Vec::new();
    let mut used = 0;
    // The next token, from as many lines as it takes; those of the last line stay in `tokens`.
    let mut next = |lines: &mut Lines<'_>, what: &str| -> Result<Range<usize>, Problem> {
        if used == tokens.len() {
            let line = lines.next().ok_or_else(|| lines.truncated(what))?;
            tokens = lines.tokens(&line).collect();
            used = 0;
        }
        used += 1;
        Ok(tokens[used - 1].clone())
    };

    let mut token = next(lines, "the header: an OFF file starts with the word OFF")?;
    let (mut dimension, mut vertex_numbers) = (3, 3);
    if whole_number(&text[token.clone()]).is_none() {
        let keyword = Keyword::parse(&text[token.clone()]).ok_or_else(|| {
            let found = shown(&text[token.clone()]);
            let text = format!("{found} where an OFF file has the word OFF: is it another format?");
            lines.malformed(token.start, text)
        })?;
        token = next(lines, "the header")?;
        if text[token.clone()].eq_ignore_ascii_case(b"BINARY") {
            let text = "binary OFF is not read. Convert it to ascii OFF or to PLY first";
            return Err(lines.problem(token.start, FileErrorKind::unsupported(text)));
        }
        if keyword.names_dimension {
            dimension = count(lines, token, "dimension")?;
            token = next(lines, "the header")?;
        }
        dimension = dimension.saturating_add(usize::from(keyword.is_homogeneous));
        let normal = if keyword.has_normals { dimension } else { 0 };
        // Colours are written with three numbers or with four.
        let colour = if keyword.has_colours { 3 } else { 0 };
        let texture = if keyword.has_texture { 2 } else { 0 };
        vertex_numbers = dimension
            .saturating_add(normal)
            .saturating_add(colour + texture);
    }

    let place = token.start;
    let vertex_count = count(lines, token, "number of vertices")?;
    let token = next(lines, "the header")?;
    let face_count = count(lines, token, "number of faces")?;

    // The number of edges is of no use here, and often wrong; but vertices cannot stand there.
    if let Some(third) = tokens.get(used) {
        let edges = whole_number(&text[third.clone()]);
        if edges.is_none() || tokens.len() > used + 1 {
            let text = "after the counts of vertices, faces and edges a new line must begin";
            return Err(lines.malformed(third.start, text));
        }
    }

    let checked = check_vertex_count(vertex_count, limits);
    let checked = checked.and_then(|()| check_face_count(face_count, limits));
    checked.map_err(|kind| lines.problem(place, kind))?;
    Ok(OffHeader {
        vertex_count,
        face_count,
        dimension,
        vertex_numbers,
    })
}

/// A number of the header that counts something.
fn count(lines: &Lines<'_>, token: Range<usize>, what: &str) -> Result<usize, Problem> {
    let number = whole_number(&lines.text[token.clone()]);
    let number = number.and_then(|number| usize::try_from(number).ok());
    number.ok_or_else(|| {
        let found = shown(&lines.text[token.clone()]);
        lines.malformed(
            token.start,
            format!("the {what} is {found}, which counts nothing"),
        )
    })
}

/// `[ST][C][N][4][n]OFF`: what a vertex line holds beside its coordinates.
struct Keyword {
    has_texture: bool,
    has_colours: bool,
    has_normals: bool,
    /// A fourth coordinate to divide by.
    is_homogeneous: bool,
    /// The number of coordinates stands before the counts.
    names_dimension: bool,
}

impl Keyword {
    fn parse(token: &[u8]) -> Option<Self> {
        let mut rest = token.strip_suffix(b"OFF")?;
        let mut takes = |prefix: &[u8]| match rest.strip_prefix(prefix) {
            Some(after) => {
                rest = after;
                true
            }
            None => false,
        };
        let keyword = Self {
            has_texture: takes(b"ST"),
            has_colours: takes(b"C"),
            has_normals: takes(b"N"),
            is_homogeneous: takes(b"4"),
            names_dimension: takes(b"n"),
        };
        rest.is_empty().then_some(keyword)
    }
}

type VertexLines = (Spans, Vec<[f32; 3]>);

fn vertices(lines: &mut Lines<'_>, header: &OffHeader) -> Result<VertexLines, Problem> {
    let mut spans = Spans::new();
    let shortest = header.vertex_numbers.saturating_mul(2).max(1);
    let mut positions = Vec::with_capacity(lines.at_most(header.vertex_count, shortest));
    for vertex in 0..header.vertex_count {
        let line = lines.next().ok_or_else(|| {
            lines.truncated(format!("vertex {vertex} of {}", header.vertex_count))
        })?;

        let mut tokens = lines.tokens(&line);
        let mut position = [0.0; 3];
        let mut found = 0;
        for (value, token) in position.iter_mut().take(header.dimension).zip(&mut tokens) {
            let token = &lines.text[token];
            *value = coordinate(token).ok_or_else(|| {
                let text = format!("{} is not a coordinate: write a number", shown(token));
                lines.malformed(line.start, format!("vertex {vertex}: {text}"))
            })?;
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

        positions.push(position);
        let at = line.start;
        spans.push(line).map_err(|kind| lines.problem(at, kind))?;
    }
    Ok((spans, positions))
}

fn faces(
    lines: &mut Lines<'_>,
    header: &OffHeader,
    limits: &Limits,
) -> Result<(Spans, FaceRecords), Problem> {
    let mut spans = Spans::new();
    let mut records = FaceRecords::default();
    // In text each number has something after it.
    let left = lines.text.len() - lines.at;
    records.reserve(lines.at_most(header.face_count, 2), left / 2);
    let mut corners = Vec::new();
    for face in 0..header.face_count {
        let line = lines
            .next()
            .ok_or_else(|| lines.truncated(format!("face {face} of {}", header.face_count)))?;
        face_corners(lines, &line, face, header.vertex_count, &mut corners)?;
        let at = line.start;
        let pushed = records.push(&corners, limits);
        let pushed = pushed.and_then(|()| spans.push(line));
        pushed.map_err(|kind| lines.problem(at, kind))?;
    }
    Ok((spans, records))
}

/// Reads the corners of one face line.
fn face_corners(
    lines: &Lines<'_>,
    line: &Range<usize>,
    face: usize,
    vertex_count: usize,
    corners: &mut Vec<u32>,
) -> Result<(), Problem> {
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
    Ok(())
}

/// How corners stand in face lines: after their number.
struct OffNotation;

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
}
