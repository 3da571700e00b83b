//! Wavefront OBJ: `f` lines move within their run, `v` lines as a whole.
//!
//! Two choices were made here:
//!
//! - A vertex is what the *position* number of a corner names (the first of `1/2/3`). So a file has
//!   as many vertices as `v` lines, whatever seams its textures have; texture and normal numbers
//!   stay attached to their corner. A program that makes one GPU vertex of each `1/2/3` sees a few
//!   more misses at seams, in the same order.
//! - A *run* is a stretch of `f` lines with nothing between but blank lines and comments. Any other
//!   statement (`g`, `o`, `usemtl`, `s`, `v`, `l`, …) ends it, because what it says holds for the
//!   faces after it. A face never leaves its run, so a number that counts back (`-1`) means the
//!   same wherever the face goes; it is written as a plain number only if its vertex is renumbered.
//!   If the caller wishes, `g` and `o` do not end a run.
//!
//! Vertices move only if every `v` line comes before the first `f`, `l` or `p`, and nothing in the
//! file may name vertices in a way that is not known here.

mod statement;

use std::ops::Range;

use crate::Mesh;
use crate::files::content::ReadResult;
use crate::files::entry::MeshEntry;
use crate::files::error::{Fault, FileErrorKind, Place};
use crate::files::face_records::{FaceRecords, check_vertex_count, past_the_last_vertex};
use crate::files::note::Note;
use crate::files::options::ReadOptions;
use crate::files::orders::RecordOrders;
use crate::files::record_file::RecordFile;
use crate::files::slots::Spans;
use crate::files::text::{
    Tokens, coordinate, is_blank, is_line_end, leading_number, line_end, line_of, shown, trimmed,
};
use crate::index::index32;
use statement::{ObjNotation, attributes_named, statement_span};

/// Statements that name no vertices (`v`, `f`, `l` and `p` are dealt with by themselves).
const NAME_NO_VERTICES: [&[u8]; 19] = [
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"g",
    b"lod",
    b"maplib",
    b"mg",
    b"mtllib",
    b"o",
    b"s",
    b"shadow_obj",
    b"trace_obj",
    b"usemap",
    b"usemtl",
    b"vn",
    b"vp",
    b"vt",
    b"ctech",
    b"stech",
];

/// Reads an OBJ file.
pub(super) fn read(bytes: Vec<u8>, options: &ReadOptions) -> ReadResult {
    let mut reader = ObjReader::new(&bytes, options);
    reader
        .statements()
        .map_err(|fault| fault.on_its_line(&bytes))?;
    reader
        .check_range()
        .map_err(|fault| fault.on_its_line(&bytes))?;
    let ObjReader {
        vertices,
        positions,
        faces,
        records,
        runs,
        lines,
        name,
        obstacle,
        ..
    } = reader;

    let mut notes = Vec::new();
    let mut entries = Vec::new();
    if records.len() == 0 {
        notes.push(Note::nothing_to_order());
    } else {
        let vertices_movable = obstacle.is_none();
        if let Some((at, why)) = obstacle {
            let place = Place::Line(line_of(&bytes, at));
            notes.push(Note::vertices_stay(place, why));
        }
        let name = name.map_or_else(
            || "mesh".to_owned(),
            |span| String::from_utf8_lossy(&bytes[span]).into_owned(),
        );
        let mesh = Mesh::new(positions, records.faces);
        let mesh = mesh.map_err(|e| FileErrorKind::malformed(e.to_string()).at(Place::File))?;
        entries.push(MeshEntry {
            name,
            mesh,
            corners_turnable: records.polygons.is_none(),
            polygons: records.polygons,
            runs,
            vertex_group: 0,
            vertices_movable,
        });
    }

    let notation = ObjNotation {
        vertex_count: vertices.len(),
    };
    let file = RecordFile {
        source: bytes,
        vertices,
        faces,
        companions: Vec::new(),
        lines,
        notation,
        entries,
        orders: RecordOrders::default(),
    };
    Ok((Box::new(file), notes))
}

struct ObjReader<'a> {
    source: &'a [u8],
    options: &'a ReadOptions,
    vertices: Spans,
    positions: Vec<[f32; 3]>,
    faces: Spans,
    records: FaceRecords,
    runs: Vec<u32>,
    in_run: bool,
    /// The `l` and `p` lines.
    lines: Spans,
    /// The largest plain number that an `f`, `l` or `p` names.
    largest: i64,
    /// The text after the first `o`.
    name: Option<Range<usize>>,
    /// Why the vertices cannot move, and where that was found.
    obstacle: Option<(usize, String)>,
    /// Of texture coordinates and normals: how many, where the first is, and whether a face names
    /// any.
    attributes: [(usize, usize, bool); 2],
    corners: Vec<u32>,
}

impl<'a> ObjReader<'a> {
    fn new(source: &'a [u8], options: &'a ReadOptions) -> Self {
        Self {
            source,
            options,
            vertices: Spans::new(),
            positions: Vec::new(),
            faces: Spans::new(),
            records: FaceRecords::default(),
            runs: Vec::new(),
            in_run: false,
            lines: Spans::new(),
            largest: 0,
            name: None,
            obstacle: None,
            attributes: [(0, 0, false); 2],
            corners: Vec::new(),
        }
    }

    fn statements(&mut self) -> Result<(), Fault> {
        let source = self.source;
        // A byte order mark is not part of the first keyword.
        let mut at = if source.starts_with(b"\xef\xbb\xbf") {
            3
        } else {
            0
        };
        while at < source.len() {
            let byte = source[at];
            if is_blank(byte) || is_line_end(byte) {
                at += 1;
            } else if byte == b'#' {
                at = line_end(source, at);
            } else {
                let (span, end) = statement_span(source, at);
                self.statement(span)?;
                at = end;
            }
        }
        self.check_attributes();
        Ok(())
    }

    fn statement(&mut self, span: Range<usize>) -> Result<(), Fault> {
        let text = &self.source[..span.end];
        let mut tokens = Tokens::of_statement(text, span.start);
        // Continuation marks with nothing to continue.
        let Some(keyword) = tokens.next() else {
            return Ok(());
        };

        match &text[keyword.clone()] {
            b"f" => return self.face(span, tokens),
            b"v" => self.vertex(span, tokens)?,
            b"l" | b"p" => self.line(span, tokens)?,
            b"vt" => self.attribute(0, span.start),
            b"vn" => self.attribute(1, span.start),
            b"g" if self.options.across_groups => return Ok(()),
            b"o" => {
                let rest = trimmed(text, keyword.end, span.end);
                let blanks = text[rest.clone()].iter().take_while(|&&b| is_blank(b));
                let rest = rest.start + blanks.count()..rest.end;
                if self.name.is_none() && !rest.is_empty() {
                    self.name = Some(rest);
                }
                if self.options.across_groups {
                    return Ok(());
                }
            }
            other if NAME_NO_VERTICES.contains(&other) => {}
            other if self.is_assumed_safe(other) => {}
            other => {
                let name = String::from_utf8_lossy(other);
                if let Some(kind) = self.options.refusal("the statement", &name) {
                    let at = span.start;
                    return Err(Fault { at, kind });
                }
                let why = format!("the statement {} may name them", shown(other));
                self.obstacle.get_or_insert((span.start, why));
            }
        }
        self.in_run = false;
        Ok(())
    }

    fn is_assumed_safe(&self, keyword: &[u8]) -> bool {
        std::str::from_utf8(keyword).is_ok_and(|name| self.options.is_assumed_safe(name))
    }

    fn vertex(&mut self, span: Range<usize>, mut tokens: Tokens<'_>) -> Result<(), Fault> {
        let mut position = [0.0; 3];
        for (found, value) in position.iter_mut().enumerate() {
            let token = tokens.next().ok_or_else(|| {
                let vertex = self.vertices.len() + 1;
                let text = format!("vertex {vertex} has {found} coordinates and needs 3");
                Fault::malformed(span.start, text)
            })?;
            let token = &self.source[token];
            *value = coordinate(token).ok_or_else(|| {
                let text = format!("{} is not a coordinate: write a number", shown(token));
                Fault::malformed(span.start, text)
            })?;
        }

        let record = &self.source[span.clone()];
        if record.ends_with(b"\\") && !record.contains(&b'#') {
            // Before another line end it would swallow the line after it.
            let text = "a \\ at the end that is not followed by a line end: remove it";
            return Err(Fault::malformed(span.start, text));
        }

        if self.records.len() + self.lines.len() > 0 {
            let why = "this one comes after faces, lines or points".to_owned();
            self.obstacle.get_or_insert((span.start, why));
        }

        let at = span.start;
        self.vertices
            .push(span)
            .map_err(|kind| Fault { at, kind })?;
        self.positions.push(position);
        check_vertex_count(self.vertices.len(), &self.options.limits)
            .map_err(|kind| Fault { at, kind })
    }

    fn attribute(&mut self, which: usize, at: usize) {
        let (count, first, _) = &mut self.attributes[which];
        if *count == 0 {
            *first = at;
        }
        *count += 1;
    }

    fn face(&mut self, span: Range<usize>, tokens: Tokens<'_>) -> Result<(), Fault> {
        let at = span.start;
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for token in tokens {
            let vertex = self.vertex_of_token(&self.source[token], true);
            corners.push(vertex.map_err(|text| {
                let (face, corner) = (self.records.len(), corners.len());
                Fault::malformed(at, format!("face {face}, corner {corner}: {text}"))
            })?);
        }
        if !self.in_run {
            self.runs.push(index32(self.records.len()));
            self.in_run = true;
        }
        let pushed = self.records.push(&corners, &self.options.limits);
        self.corners = corners;
        let pushed = pushed.and_then(|()| self.faces.push(span));
        pushed.map_err(|kind| Fault { at, kind })
    }

    fn line(&mut self, span: Range<usize>, tokens: Tokens<'_>) -> Result<(), Fault> {
        let at = span.start;
        for token in tokens {
            let vertex = self.vertex_of_token(&self.source[token], false);
            vertex.map_err(|text| Fault::malformed(at, text))?;
        }
        self.lines.push(span).map_err(|kind| Fault { at, kind })
    }

    /// The vertex that `1`, `1/2`, `1//3`, `1/2/3` names, from 0; whether it exists is checked when
    /// all vertices are known.
    #[inline]
    fn vertex_of_token(&mut self, token: &[u8], is_face: bool) -> Result<u32, String> {
        let (number, length) = leading_number(token)
            .ok_or_else(|| format!("{} is not a vertex number", shown(token)))?;
        if length < token.len() {
            let named = attributes_named(&token[length..])
                .ok_or_else(|| format!("{} is not of the form 1/2/3", shown(token)))?;
            if is_face {
                self.attributes[0].2 |= named[0];
                self.attributes[1].2 |= named[1];
            }
        }

        let vertex_count = self.vertices.len();
        if number > 0 {
            self.largest = self.largest.max(number);
            // A number that does not fit is past the last vertex, and reported as that.
            return Ok(u32::try_from(number - 1).unwrap_or(u32::MAX));
        }
        if number == 0 {
            return Err("index 0: vertices are counted from 1 (or back from -1)".to_owned());
        }
        let back = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
        match vertex_count.checked_sub(back) {
            Some(vertex) => Ok(index32(vertex)),
            None => Err(format!(
                "index {number} counts back past the first of the {vertex_count} vertices above it"
            )),
        }
    }

    /// Texture coordinates or normals that no face names, as many as vertices: some programs take
    /// them as belonging to the vertices one by one, so these must not move.
    fn check_attributes(&mut self) {
        for (keyword, (count, at, named)) in ["vt", "vn"].into_iter().zip(self.attributes) {
            if count > 0 && count == self.vertices.len() && !named {
                let why = format!("as many {keyword} lines, named by no face, may belong to them");
                self.obstacle.get_or_insert((at, why));
            }
        }
    }

    /// Whether all numbers name vertices: those below the face count too, so this is last.
    fn check_range(&self) -> Result<(), Fault> {
        let count = self.vertices.len();
        let past = |number: i64| usize::try_from(number).is_ok_and(|number| number > count);
        if !past(self.largest) {
            return Ok(());
        }
        let last = (count > 0).then_some(count);
        for (spans, what) in [(&self.faces, "face"), (&self.lines, "line or point")] {
            for record in 0..spans.len() {
                let span = spans.span(record);
                let text = &self.source[..span.end];
                let tokens = Tokens::of_statement(text, span.start).skip(1);
                for (corner, token) in tokens.enumerate() {
                    let number = leading_number(&text[token]).map_or(0, |(number, _)| number);
                    if past(number) {
                        let at = span.start;
                        let kind = past_the_last_vertex(what, record, corner, number, last);
                        return Err(Fault { at, kind });
                    }
                }
            }
        }
        Ok(())
    }
}
