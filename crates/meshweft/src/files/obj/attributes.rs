//! The values of an OBJ file: positions and colors of vertices, texture coordinates and normals of
//! corners.

use std::ops::Range;

use super::statement::{Statements, attribute_numbers};
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::files::error::no_attribute;
use crate::files::error::{Fault, Problem};
use crate::files::rewrite::{StoredMesh, fan};
use crate::files::slots::Spans;
use crate::files::text::{Tokens, coordinate, leading_number, shown};

/// What an OBJ file has for every vertex or every corner, beside the positions.
#[derive(Debug, Clone)]
pub(super) struct ObjAttributes {
    /// How many components its colors have.
    pub(super) colors: Option<usize>,
    /// How many components its texture coordinates have.
    pub(super) texture: Option<usize>,
    pub(super) has_normals: bool,
}

impl ObjAttributes {
    pub(super) fn infos(&self) -> Vec<AttributeInfo> {
        let info = |semantic, domain, components| {
            AttributeInfo::new(semantic, domain, components, ComponentType::F32)
        };
        let color = |components| info(Semantic::Color(0), Domain::Vertex, components);
        let texture = |components| info(Semantic::TexCoord(0), Domain::Corner, components);
        let normal = || info(Semantic::Normal, Domain::Corner, 3);
        let mut infos = vec![info(Semantic::Position, Domain::Vertex, 3)];
        infos.extend(self.colors.map(color));
        infos.extend(self.texture.map(texture));
        infos.extend(self.has_normals.then(normal));
        infos
    }

    /// The values of an attribute.
    ///
    /// Time O(bytes of the `v` lines); of corners O(bytes of the file), and memory for its `vt` or
    /// `vn` lines.
    pub(super) fn read(
        &self,
        stored: &StoredMesh<'_>,
        info: &AttributeInfo,
    ) -> Result<Attribute, Problem> {
        if !self.infos().contains(info) {
            return Err(no_attribute(info));
        }
        let components = info.components;
        let read = match info.semantic {
            Semantic::Position => of_vertices(stored, 0..3),
            Semantic::Color(_) => of_vertices(stored, 3..3 + components),
            Semantic::Normal => CornerValues::NORMALS.read(stored, components),
            _ => CornerValues::TEXTURE.read(stored, components),
        };
        let values = read.map_err(|fault| fault.on_its_line(stored.source))?;
        Ok(Attribute::new(info.clone(), Values::F32(values)))
    }
}

/// The numbers of the `v` lines that stand at these places.
fn of_vertices(stored: &StoredMesh<'_>, places: Range<usize>) -> Result<Vec<f32>, Fault> {
    let mut values = Vec::with_capacity(stored.vertices.len() * places.len());
    for (_, span) in stored.vertices() {
        numbers_of(
            stored.source,
            span,
            places.clone(),
            places.len(),
            &mut values,
        )?;
    }
    Ok(values)
}

/// Appends the numbers of a statement that stand at these places; those that are missing are 0, but
/// `needed` must be there.
fn numbers_of(
    source: &[u8],
    span: Range<usize>,
    places: Range<usize>,
    needed: usize,
    values: &mut Vec<f32>,
) -> Result<(), Fault> {
    let mut tokens = Tokens::of_statement(&source[..span.end], span.start).skip(1 + places.start);
    for place in 0..places.len() {
        let value = match tokens.next() {
            Some(token) => {
                let token = &source[token];
                coordinate(token).ok_or_else(|| {
                    let text = format!("{} is not a value: write a number", shown(token));
                    Fault::malformed(span.start, text)
                })?
            }
            None if place < needed => {
                let text = format!("{place} values on a line that needs {needed}");
                return Err(Fault::malformed(span.start, text));
            }
            None => 0.0,
        };
        values.push(value);
    }
    Ok(())
}

/// A kind of lines that corners name.
pub(super) struct CornerValues {
    keyword: &'static str,
    /// Which number behind that of the vertex names one.
    which: usize,
    /// How many numbers a line must have.
    needed: usize,
}

impl CornerValues {
    pub(super) const TEXTURE: Self = Self {
        keyword: "vt",
        which: 0,
        needed: 1,
    };
    const NORMALS: Self = Self {
        keyword: "vn",
        which: 1,
        needed: 3,
    };

    /// The values of the corners of all faces.
    fn read(&self, stored: &StoredMesh<'_>, components: usize) -> Result<Vec<f32>, Fault> {
        let source = stored.source;
        let lines = self.lines(source);
        let mut numbers = Vec::with_capacity(lines.len() * components);
        for line in &lines {
            numbers_of(
                source,
                line.clone(),
                0..components,
                self.needed,
                &mut numbers,
            )?;
        }

        let mut values = Vec::with_capacity(stored.entry.mesh.face_count() * 3 * components);
        let mut named = Vec::new();
        for face in stored.faces() {
            named.clear();
            let tokens = Tokens::of_statement(&source[..face.span.end], face.span.start).skip(1);
            named.extend(tokens.map(|token| self.number(&source[token])));
            for corner in fan(named.len(), face.rotation) {
                let line = self.line(named[corner], &lines, face.span.start)?;
                values.extend_from_slice(&numbers[line * components..][..components]);
            }
        }
        Ok(values)
    }

    /// The least count of numbers of the lines that faces name.
    ///
    /// Time O(bytes).
    pub(super) fn fewest_named(&self, source: &[u8], faces: &Spans) -> usize {
        let lines = self.lines(source);
        let counts = lines.iter().map(|line| {
            let tokens = Tokens::of_statement(&source[..line.end], line.start);
            tokens.skip(1).count()
        });
        let counts: Vec<usize> = counts.collect();

        let mut fewest = usize::MAX;
        let mut named = Vec::new();
        for span in (0..faces.len()).map(|record| faces.span(record)) {
            named.clear();
            let tokens = Tokens::of_statement(&source[..span.end], span.start).skip(1);
            named.extend(tokens.map(|token| self.number(&source[token])));
            for corner in fan(named.len(), 0) {
                // One that names no line is an error when the values are read.
                if let Ok(line) = self.line(named[corner], &lines, span.start) {
                    fewest = fewest.min(counts[line]);
                }
            }
        }
        fewest
    }

    /// Where the lines stand.
    fn lines(&self, source: &[u8]) -> Vec<Range<usize>> {
        let is_it = |span: &Range<usize>| {
            let mut tokens = Tokens::of_statement(&source[..span.end], span.start);
            tokens
                .next()
                .is_some_and(|token| &source[token] == self.keyword.as_bytes())
        };
        Statements::new(source).filter(is_it).collect()
    }

    /// The number by which a corner names a line.
    fn number(&self, corner: &[u8]) -> Option<i64> {
        let (_, length) = leading_number(corner)?;
        attribute_numbers(&corner[length..])?[self.which]
    }

    /// The line that a number names, from 0, in a face that stands at `at` of the file.
    fn line(&self, number: Option<i64>, lines: &[Range<usize>], at: usize) -> Result<usize, Fault> {
        let keyword = self.keyword;
        let number =
            number.ok_or_else(|| Fault::malformed(at, format!("a corner names no {keyword}")))?;
        let line = match number {
            0 => None,
            1.. => usize::try_from(number - 1)
                .ok()
                .filter(|&line| line < lines.len()),
            _ => {
                let above = lines.partition_point(|line| line.start < at);
                let back = usize::try_from(number.unsigned_abs()).ok();
                back.and_then(|back| above.checked_sub(back))
            }
        };
        line.ok_or_else(|| {
            let count = lines.len();
            let text = format!("a corner names {keyword} {number}, and there are {count}");
            Fault::malformed(at, text)
        })
    }
}
