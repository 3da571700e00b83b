//! Reading an OBJ file: where its records stand, and what keeps them there.

use std::ops::Range;

use super::attributes::{CornerValues, ObjAttributes};
use super::comments::Comments;
use super::runs::{Defined, Runs};
use super::statement::{Piece, Statements, attribute_numbers};
use crate::files::error::Fault;
use crate::files::face_records::{FaceRecords, check_vertex_count, past_the_last_vertex};
use crate::files::options::ReadOptions;
use crate::files::slots::Spans;
use crate::files::text::{Tokens, is_blank, leading_number, shown, trimmed};
use crate::files::text::{comment_start, is_coordinate};
use crate::index::index32;

/// The statements of a file, read one after the other.
pub(super) struct ObjReader<'a> {
    pub(super) source: &'a [u8],
    pub(super) options: &'a ReadOptions,
    pub(super) vertices: Spans,
    pub(super) faces: Spans,
    pub(super) records: FaceRecords,
    pub(super) runs: Runs<'a>,
    /// The `l` and `p` lines.
    pub(super) lines: Spans,
    /// The largest plain number that an `f`, `l` or `p` names.
    largest: i64,
    /// The text after the first `o`.
    pub(super) name: Option<Range<usize>>,
    /// Why the vertices cannot move, and where that was found.
    pub(super) obstacle: Option<(usize, String)>,
    /// What may be about the vertices by their numbers or their order, and where that was found.
    pub(super) bond: Option<(usize, String)>,
    /// The comments that may go by the order of the faces, and where the first is.
    pub(super) face_obstacle: Option<(usize, String)>,
    pub(super) comments: Comments<'a>,
    /// The first vertex below a face, line or point.
    pub(super) late_vertex: Option<usize>,
    /// The fewest and the most numbers that a `v` line has.
    vertex_numbers: (usize, usize),
    /// Texture coordinates and normals.
    pub(super) values: [SeenLines; 2],
    /// How many corners there are, of records with faces.
    corner_count: usize,
    corners: Vec<u32>,
}

/// What the corners of a face name.
#[derive(Default)]
struct NamedLines {
    /// How many name a texture coordinate, and a normal.
    counts: [usize; 2],
    /// Whether one names the first of all texture coordinates.
    first_texture: bool,
    /// Whether one counts back: to a vertex, a texture coordinate, a normal.
    back: [bool; 3],
    /// Whether one counts back past the first texture coordinate or normal.
    is_past_first: bool,
}

/// The `vt` or `vn` lines, as far as they are looked at.
#[derive(Clone, Copy, Default)]
pub(super) struct SeenLines {
    pub(super) count: usize,
    /// Where the first is.
    pub(super) first: usize,
    /// How many texture coordinates have three numbers, if the first has; not counted otherwise.
    with_three: usize,
    /// Whether a face names the first.
    is_first_named: bool,
    /// Whether a face names one.
    pub(super) is_named: bool,
    /// How many corners name one, of records with faces.
    corners: usize,
}

impl<'a> ObjReader<'a> {
    pub(super) fn new(source: &'a [u8], options: &'a ReadOptions) -> Self {
        Self {
            source,
            options,
            vertices: Spans::new(),
            faces: Spans::new(),
            records: FaceRecords::default(),
            runs: Runs::new(source),
            lines: Spans::new(),
            largest: 0,
            name: None,
            obstacle: None,
            bond: None,
            face_obstacle: None,
            comments: Comments::new(source),
            late_vertex: None,
            vertex_numbers: (usize::MAX, 0),
            values: [SeenLines::default(); 2],
            corner_count: 0,
            corners: Vec::new(),
        }
    }

    /// Reads all statements.
    pub(super) fn statements(&mut self) -> Result<(), Fault> {
        let mut pieces = Statements::new(self.source);
        while let Some(piece) = pieces.next_piece() {
            match piece {
                Piece::Statement(span) => self.statement(span)?,
                Piece::Comment(span) => {
                    let at = span.start;
                    let taken = self.comments.comment(span);
                    taken.map_err(|kind| Fault { at, kind })?;
                }
            }
        }
        let at = self.source.len();
        let closed = self.runs.close();
        closed.map_err(|kind| Fault { at, kind })
    }

    fn statement(&mut self, span: Range<usize>) -> Result<(), Fault> {
        let text = &self.source[..span.end];
        let mut tokens = Tokens::of_statement(text, span.start);
        // Continuation marks with nothing to continue.
        let Some(keyword) = tokens.next() else {
            return Ok(());
        };

        let rest = trimmed(text, keyword.end, span.end);
        let blanks = text[rest.clone()].iter().take_while(|&&b| is_blank(b));
        let rest = rest.start + blanks.count()..rest.end;
        match &text[keyword] {
            b"f" => return self.face(span, tokens),
            b"v" => return self.vertex(span, tokens),
            b"l" | b"p" => return self.line(span, tokens),
            b"vt" => self.value(0, span, tokens),
            b"vn" => self.value(1, span, tokens),
            b"vp" => {}
            keyword @ (b"g" | b"o") => {
                if keyword == b"o" && self.name.is_none() && !rest.is_empty() {
                    self.name = Some(rest.clone());
                }
                // Vertices below are those of another object, to some readers.
                self.runs.bar(Defined::Vertex);
                if !self.options.across_groups {
                    // Objects without a name are told apart by their `o` alone.
                    if keyword == b"o" && rest.is_empty() {
                        self.runs.end();
                    }
                    self.runs.state.set(keyword, rest);
                }
            }
            keyword if self.runs.state.set(keyword, rest) => {}
            keyword if self.is_assumed_safe(keyword) => self.runs.end(),
            keyword => {
                self.runs.end();
                let name = String::from_utf8_lossy(keyword);
                if let Some(kind) = self.options.refusal("the statement", &name) {
                    let at = span.start;
                    return Err(Fault { at, kind });
                }
                let why = format!("the statement {} may name them", shown(keyword));
                self.obstacle.get_or_insert((span.start, why));
            }
        }
        Ok(())
    }

    fn is_assumed_safe(&self, keyword: &[u8]) -> bool {
        std::str::from_utf8(keyword).is_ok_and(|name| self.options.is_assumed_safe(name))
    }

    fn vertex(&mut self, span: Range<usize>, mut tokens: Tokens<'_>) -> Result<(), Fault> {
        for found in 0..3 {
            let token = tokens.next().ok_or_else(|| {
                let vertex = self.vertices.len() + 1;
                let text = format!("vertex {vertex} has {found} coordinates and needs 3");
                Fault::malformed(span.start, text)
            })?;
            let token = &self.source[token];
            if !is_coordinate(token) {
                let text = format!("{} is not a coordinate: write a number", shown(token));
                return Err(Fault::malformed(span.start, text));
            }
        }
        let (fewest, most) = self.vertex_numbers;
        let numbers = 3 + tokens.count();
        self.vertex_numbers = (fewest.min(numbers), most.max(numbers));

        let record = &self.source[span.clone()];
        let is_commented = || comment_start(self.source, span.start, span.end).is_some();
        if record.ends_with(b"\\") && !is_commented() {
            // Before another line end it would swallow the line after it.
            let text = "a \\ at the end that is not followed by a line end: remove it";
            return Err(Fault::malformed(span.start, text));
        }

        if self.records.len() + self.lines.len() > 0 {
            self.late_vertex.get_or_insert(span.start);
        }

        let at = span.start;
        self.runs.definition(span.clone(), Defined::Vertex);
        self.vertices
            .push(span)
            .map_err(|kind| Fault { at, kind })?;
        check_vertex_count(self.vertices.len(), &self.options.limits)
            .map_err(|kind| Fault { at, kind })
    }

    fn value(&mut self, which: usize, span: Range<usize>, mut tokens: Tokens<'_>) {
        let seen = &mut self.values[which];
        if seen.count == 0 {
            seen.first = span.start;
        }
        self.runs
            .definition(span, [Defined::Texture, Defined::Normal][which]);
        seen.count += 1;
        // Most files have two: the first tells, and the others need no look.
        if which == 0 && (seen.count == 1 || seen.with_three > 0) {
            seen.with_three += usize::from(tokens.nth(2).is_some());
        }
    }

    fn face(&mut self, span: Range<usize>, tokens: Tokens<'_>) -> Result<(), Fault> {
        let at = span.start;
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        let mut named = NamedLines::default();
        for token in tokens {
            let vertex = self.vertex_of_token(&self.source[token], &mut named);
            corners.push(vertex.map_err(|text| {
                let (face, corner) = (self.records.len(), corners.len());
                Fault::malformed(at, format!("face {face}, corner {corner}: {text}"))
            })?);
        }
        let has_faces = corners.len() > 2;
        for (seen, named) in self.values.iter_mut().zip(named.counts) {
            seen.is_named |= named > 0;
            seen.corners += if has_faces { named } else { 0 };
        }
        self.values[0].is_first_named |= has_faces && named.first_texture;
        self.corner_count += if has_faces { corners.len() } else { 0 };

        // One that names what is not there stays where it does so.
        if named.is_past_first {
            self.runs.end();
        }
        let [texture, normals] = self.values.map(|seen| seen.count);
        let above = [self.vertices.len(), texture, normals];
        let pushed = self.runs.face(self.records.len(), above);
        if named.is_past_first {
            self.runs.end();
        }
        let pushed = pushed.and_then(|()| self.records.push(&corners, &self.options.limits));
        self.corners = corners;
        let pushed = pushed.and_then(|()| self.faces.push(span));
        pushed.map_err(|kind| Fault { at, kind })
    }

    fn line(&mut self, span: Range<usize>, tokens: Tokens<'_>) -> Result<(), Fault> {
        let at = span.start;
        for token in tokens {
            let mut named = NamedLines::default();
            let vertex = self.vertex_of_token(&self.source[token], &mut named);
            vertex.map_err(|text| Fault::malformed(at, text))?;
            let kinds = [Defined::Vertex, Defined::Texture, Defined::Normal];
            for (kind, _) in kinds.into_iter().zip(named.back).filter(|&(_, back)| back) {
                self.runs.bar(kind);
            }
        }
        self.lines.push(span).map_err(|kind| Fault { at, kind })
    }

    /// The vertex that `1`, `1/2`, `1//3`, `1/2/3` names, from 0; whether it exists is checked when
    /// all vertices are known. Counts in `named` whether it names a texture coordinate and a normal.
    #[inline]
    fn vertex_of_token(&mut self, token: &[u8], named: &mut NamedLines) -> Result<u32, String> {
        let (number, length) = leading_number(token)
            .ok_or_else(|| format!("{} is not a vertex number", shown(token)))?;
        if length < token.len() {
            let numbers = attribute_numbers(&token[length..])
                .ok_or_else(|| format!("{} is not of the form 1/2/3", shown(token)))?;
            for (which, number) in numbers.into_iter().enumerate() {
                named.counts[which] += usize::from(number.is_some());
                let back = number.filter(|&number| number < 0).map(i64::unsigned_abs);
                named.back[1 + which] |= back.is_some();
                let count = self.values[which].count as u64;
                named.is_past_first |= back.is_some_and(|back| back > count);
            }
            named.first_texture |= numbers[0] == Some(1);
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
        named.back[0] = true;
        let back = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
        match vertex_count.checked_sub(back) {
            Some(vertex) => Ok(index32(vertex)),
            None => Err(format!(
                "index {number} counts back past the first of the {vertex_count} vertices above it"
            )),
        }
    }

    /// What is stored with every vertex, and with every corner.
    pub(super) fn attributes(&self) -> ObjAttributes {
        let colors = match self.vertex_numbers {
            (fewest @ 6..=7, 6..=7) => Some(fewest - 3),
            _ => None,
        };
        let is_of_all = |seen: &SeenLines| {
            seen.count > 0 && seen.corners > 0 && seen.corners == self.corner_count
        };
        let [texture, normals] = &self.values;
        let components = || match texture.with_three {
            0 if texture.is_first_named => 2,
            three if three == texture.count => 3,
            _ => CornerValues::TEXTURE
                .fewest_named(self.source, &self.faces)
                .clamp(2, 3),
        };
        ObjAttributes {
            colors,
            texture: is_of_all(texture).then(components),
            has_normals: is_of_all(normals),
        }
    }

    /// Whether all numbers name vertices: those below the face count too, so this is last.
    pub(super) fn check_range(&self) -> Result<(), Fault> {
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
