//! Numbers of vertex and face lines that have a meaning: which there are, and their values.

use std::ops::Range;

use super::header::OffHeader;
use super::lines::FreeTokens;
use crate::attribute::{Attribute, AttributeInfo, ComponentType, Domain, Semantic, Values};
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::rewrite::StoredMesh;
use crate::files::text::{coordinate, line_of, shown, whole_number};

/// How many numbers stand where lines have colours, and of which kind.
#[derive(Debug)]
pub(super) struct ColourColumns {
    /// `None` before the first line.
    count: Option<usize>,
    /// Whether every line has as many, three or four.
    is_even: bool,
    /// Whether all are whole numbers from 0 to 255.
    are_bytes: bool,
}

impl ColourColumns {
    pub(super) fn new() -> Self {
        Self {
            count: None,
            is_even: true,
            are_bytes: true,
        }
    }

    /// Whether there may still be colours.
    #[inline]
    pub(super) fn is_possible(&self) -> bool {
        self.is_even
    }

    /// Adds what stands on the next line.
    #[inline]
    pub(super) fn add(&mut self, text: &[u8], tokens: impl Iterator<Item = Range<usize>>) {
        if !self.is_even {
            return;
        }
        let mut count = 0;
        for token in tokens.take(5) {
            count += 1;
            self.are_bytes &= byte(&text[token]).is_some();
        }
        self.is_even = matches!(count, 3 | 4) && self.count.is_none_or(|before| before == count);
        self.count = Some(count);
    }

    /// The colours, if there are any.
    fn info(&self, domain: Domain) -> Option<AttributeInfo> {
        let components = self.count.filter(|_| self.is_even)?;
        let component_type = match self.are_bytes {
            true => ComponentType::U8,
            false => ComponentType::F32,
        };
        let mut info = AttributeInfo::new(Semantic::Color(0), domain, components, component_type);
        info.is_normalized = self.are_bytes;
        Some(info)
    }
}

/// A number from 0 to 255, written without a point.
fn byte(token: &[u8]) -> Option<u8> {
    whole_number(token).and_then(|number| number.try_into().ok())
}

/// An attribute and where its numbers stand on a line.
#[derive(Debug)]
pub(super) struct OffColumn {
    pub(super) info: AttributeInfo,
    /// How many numbers stand before it; of a face, after its corners.
    skipped: usize,
    /// How many numbers it has on the line: components beyond are zeros.
    pub(super) stored: usize,
}

/// The attributes of a file, by its header and the colours that were found.
pub(super) fn columns(
    header: &OffHeader,
    of_vertices: &ColourColumns,
    of_faces: &ColourColumns,
) -> Vec<OffColumn> {
    let of_vertex = |semantic, components, skipped, numbers: usize| OffColumn {
        info: AttributeInfo::new(semantic, Domain::Vertex, components, ComponentType::F32),
        skipped,
        stored: numbers.min(components),
    };
    let of_colours = |info: AttributeInfo, skipped| OffColumn {
        stored: info.components,
        info,
        skipped,
    };

    let mut columns = vec![of_vertex(Semantic::Position, 3, 0, header.dimension)];
    let mut at = header.dimension;
    if header.normal > 0 {
        columns.push(of_vertex(Semantic::Normal, 3, at, header.normal));
        at = at.saturating_add(header.normal);
    }

    let colours = of_vertices.info(Domain::Vertex);
    let colours = colours.filter(|_| header.has_colours);
    // Where colours have several lengths, there is no telling where they end.
    let is_known = colours.is_some() || !header.has_colours;
    if let Some(info) = colours {
        let colour = of_colours(info, at);
        at = at.saturating_add(colour.stored);
        columns.push(colour);
    }
    if is_known && header.texture > 0 {
        columns.push(of_vertex(Semantic::TexCoord(0), 2, at, header.texture));
    }

    let colours = of_faces.info(Domain::Face);
    columns.extend(colours.map(|info| of_colours(info, 0)));
    columns
}

impl OffColumn {
    /// The values, in the order in which vertices and faces now are.
    pub(super) fn read(&self, stored: &StoredMesh<'_>) -> Result<Attribute, Problem> {
        let values = match self.info.component_type {
            ComponentType::U8 => Values::U8(self.numbers(stored, byte)?),
            _ => Values::F32(self.numbers(stored, coordinate)?),
        };
        Ok(Attribute::new(self.info.clone(), values))
    }

    fn numbers<T: Copy + Default>(
        &self,
        stored: &StoredMesh<'_>,
        number: impl Fn(&[u8]) -> Option<T>,
    ) -> Result<Vec<T>, Problem> {
        let source = stored.source;
        let mut numbers = Vec::new();
        if self.info.domain == Domain::Vertex {
            let count = stored.entry.mesh.vertex_count();
            numbers.reserve_exact(count * self.info.components);
            for (vertex, span) in stored.vertices() {
                let line = Line {
                    what: "vertex",
                    number: vertex,
                    span,
                };
                let tokens = line.tokens(source);
                self.add(source, &line, tokens, &number, &mut numbers)?;
            }
            return Ok(numbers);
        }

        numbers.reserve_exact(stored.entry.mesh.face_count() * self.info.components);
        for face in stored.faces() {
            let line = Line {
                what: "face",
                number: face.record,
                span: face.span,
            };
            let mut tokens = line.tokens(source);
            let corners = tokens.next().and_then(|token| whole_number(&source[token]));
            let corners = corners.and_then(|count| usize::try_from(count).ok());
            let tokens = tokens.skip(corners.unwrap_or(0));
            // One of a point or a line is of no face.
            if face.face_count > 0 {
                let start = numbers.len();
                self.add(source, &line, tokens, &number, &mut numbers)?;
                let end = numbers.len();
                for _ in 1..face.face_count {
                    numbers.extend_from_within(start..end);
                }
            }
        }
        Ok(numbers)
    }

    /// Adds one element, whose numbers are among `tokens`.
    fn add<T: Default>(
        &self,
        source: &[u8],
        line: &Line,
        tokens: impl Iterator<Item = Range<usize>>,
        number: impl Fn(&[u8]) -> Option<T>,
        numbers: &mut Vec<T>,
    ) -> Result<(), Problem> {
        let mut tokens = tokens.skip(self.skipped);
        for _ in 0..self.stored {
            let token = tokens.next().unwrap_or(line.span.end..line.span.end);
            let token = &source[token];
            numbers.push(number(token).ok_or_else(|| {
                let found = shown(token);
                let semantic = &self.info.semantic;
                let text = format!(
                    "{} {}: {found} is not part of {semantic}: write a number",
                    line.what, line.number
                );
                let place = Place::Line(line_of(source, line.span.start));
                FileErrorKind::malformed(text).at(place)
            })?);
        }
        numbers.extend((self.stored..self.info.components).map(|_| T::default()));
        Ok(())
    }
}

/// A stretch of the file that holds a record, one line as a rule.
struct Line {
    what: &'static str,
    /// The number of the record.
    number: usize,
    span: Range<usize>,
}

impl Line {
    fn tokens<'a>(&self, source: &'a [u8]) -> FreeTokens<'a> {
        FreeTokens::new(&source[..self.span.end], self.span.start)
    }
}
