//! The rows of a PLY file that a selection leaves.
//!
//! A list of a face row with as many entries as corners, or a multiple of that, holds something for each
//! corner, and so do the lists of rows that go with the faces. What a list holds for a corner follows it.

use std::collections::HashMap;
use std::ops::Range;

use super::header::{Element, Encoding, PropertyKind};
use super::notation::PlyNotation;
use super::rows::{Binary, PlyRows, Row};
use crate::attribute::ComponentType;
use crate::files::corner_sources::{CornerSources, place_in_record};
use crate::files::error::Problem;
use crate::files::options::ReadOptions;
use crate::files::select::{PlannedTriangle, RecordCorner, face_problem};
use crate::files::selected::{NewCounts, SelectNotation, SelectSource, SelectWriter, StoredCount};
use crate::files::slots::Spans;
use crate::files::text::{Tokens, is_line_end, push_number, whole_number};
use crate::index::index32;

impl SelectNotation for PlyNotation {
    fn select_writer<'a>(&'a self, source: &'a SelectSource<'a>) -> Box<dyn SelectWriter + 'a> {
        Box::new(PlySelect {
            notation: self,
            source,
            corners: None,
            tokens: Vec::new(),
        })
    }

    fn corner_kinds(&self, source: &SelectSource<'_>, _options: &ReadOptions) -> Vec<u32> {
        if !self.has_lists() {
            return Vec::new();
        }
        let writer = PlySelect {
            notation: self,
            source,
            corners: None,
            tokens: Vec::new(),
        };
        let mut numbers: HashMap<Vec<u8>, u32> = HashMap::new();
        source.stored.entry.of_face_corners(|record| {
            let number = |held| {
                let next = index32(numbers.len());
                *numbers.entry(held).or_insert(next)
            };
            writer.held(record).into_iter().map(number).collect()
        })
    }
}

struct PlySelect<'a> {
    notation: &'a PlyNotation,
    source: &'a SelectSource<'a>,
    /// What stands with the corners, once that is asked for.
    corners: Option<CornerSources>,
    tokens: Vec<Range<usize>>,
}

/// A list of a row.
struct RowList {
    /// The number of its property.
    property: usize,
    /// Where its length stands, and its entries.
    length: Range<usize>,
    entries: Vec<Range<usize>>,
}

impl RowList {
    fn end(&self) -> usize {
        self.entries.last().unwrap_or(&self.length).end
    }

    /// How many entries it has for each of `corner_count` corners, if it has some for all.
    fn per_corner(&self, corner_count: usize) -> Option<usize> {
        let count = self.entries.len();
        let is_of_corners = count > 0 && count.is_multiple_of(corner_count);
        is_of_corners.then(|| count / corner_count)
    }
}

impl SelectWriter for PlySelect<'_> {
    fn is_text(&self) -> bool {
        self.notation.encoding == Encoding::Ascii
    }

    fn counts(&self, counts: NewCounts<'_>) -> Vec<StoredCount> {
        let text = self.source.stored.source;
        let mut stored = Vec::new();
        let mut start = 0;
        for line in text.split_inclusive(|&byte| is_line_end(byte)) {
            let end = start + line.len();
            let mut words = Tokens::plain(&text[..end], start);
            let [keyword, name, count] = [words.next(), words.next(), words.next()];
            start = end;
            let word = |span: &Option<Range<usize>>| span.clone().map(|span| &text[span]);
            let new = match (word(&keyword), word(&name)) {
                (Some(b"end_header"), _) => break,
                (Some(b"element"), Some(b"vertex")) => counts.vertices,
                (Some(b"element"), Some(b"face")) => counts.faces,
                (Some(b"element"), Some(name)) if self.is_companion(name) => counts.faces,
                _ => continue,
            };
            let old = word(&count).and_then(whole_number);
            if let Some(span) = count.filter(|_| old != i64::try_from(new).ok()) {
                let new = new.to_string().into_bytes();
                stored.push(StoredCount { span, new });
            }
        }
        stored
    }

    fn whole(&mut self, record: usize, out: &mut Vec<u8>) -> Result<(), Problem> {
        let (source, corners) = (self.source, &mut self.tokens);
        source.write_whole(self.notation, record, corners, out);
        Ok(())
    }

    fn triangle(&mut self, triangle: &PlannedTriangle, out: &mut Vec<u8>) -> Result<(), Problem> {
        let Some((element, list)) = &self.notation.face else {
            return Ok(());
        };
        let sources = self.sources(triangle)?;
        let rows = self.source.stored.faces;
        self.write(element, rows, Some(*list), triangle, sources, out)
    }

    fn companion(
        &mut self,
        companions: usize,
        triangle: &PlannedTriangle,
        out: &mut Vec<u8>,
    ) -> Result<(), Problem> {
        let Some(element) = &self.notation.companion else {
            return Ok(());
        };
        let sources = self.sources(triangle)?;
        let rows = &self.source.companions[companions];
        self.write(element, rows, None, triangle, sources, out)
    }
}

impl PlySelect<'_> {
    fn is_companion(&self, name: &[u8]) -> bool {
        let companion = self.notation.companion.as_ref();
        companion.is_some_and(|element| element.name.as_bytes() == name)
    }

    /// The corners that have what the corners of a triangle are to hold.
    fn sources(&mut self, triangle: &PlannedTriangle) -> Result<[RecordCorner; 3], Problem> {
        let record = triangle.record as usize;
        let corners: Vec<u32> = self.source.stored.entry.corners_of(record).collect();
        let own = triangle
            .places()
            .map(|place| RecordCorner { record, place });
        if !self.notation.has_lists() {
            return Ok(own);
        }
        if let Some(sources) = triangle.sources {
            return Ok(sources);
        }
        let mut sources = own;
        for (corner, source) in sources.iter_mut().enumerate() {
            *source = match place_in_record(&corners, triangle, corner) {
                Some(place) => RecordCorner { record, place },
                None => self.all_corners().source(triangle, corner)?,
            };
        }
        Ok(sources)
    }

    fn all_corners(&mut self) -> &CornerSources {
        let entry = self.source.stored.entry;
        let all = self.corners.take();
        let all = all.unwrap_or_else(|| CornerSources::new(entry, |record| self.held(record)));
        self.corners.insert(all)
    }

    /// What each corner of a record holds.
    fn held(&self, record: usize) -> Vec<Vec<u8>> {
        let stored = &self.source.stored;
        let count = stored.entry.corners_of(record).count();
        let mut held = vec![Vec::new(); count];
        let face = self.notation.face.as_ref();
        let of_face = face.map(|(element, list)| (element, stored.faces, Some(*list)));
        let companion = self.notation.companion.as_ref();
        let of_companion = companion.zip(self.source.companions.first());
        let of_companion = of_companion.map(|(element, rows)| (element, rows, None));
        for (element, rows, corner_list) in of_face.into_iter().chain(of_companion) {
            for list in self.lists(element, rows.span(record)) {
                let Some(each) = list.per_corner(count.max(1)) else {
                    continue;
                };
                if Some(list.property) == corner_list {
                    continue;
                }
                for (held, entries) in held.iter_mut().zip(list.entries.chunks(each)) {
                    for entry in entries {
                        held.extend_from_slice(&stored.source[entry.clone()]);
                        held.push(b' ');
                    }
                }
            }
        }
        held
    }

    /// Appends the row of a record with its list of corners, and with what other lists hold for them.
    fn write(
        &self,
        element: &Element,
        rows: &Spans,
        corner_list: Option<usize>,
        triangle: &PlannedTriangle,
        sources: [RecordCorner; 3],
        out: &mut Vec<u8>,
    ) -> Result<(), Problem> {
        let stored = &self.source.stored;
        let row = rows.span(triangle.record as usize);
        let mut copied = row.start;
        for list in self.lists(element, row.clone()) {
            let PropertyKind::List { count, item } = element.properties[list.property].kind else {
                continue;
            };

            // What stands in the list from now on.
            let new: Vec<Vec<u8>> = if Some(list.property) == corner_list {
                let numbers = triangle.corners.iter();
                let numbers = numbers.map(|&vertex| self.vertex(vertex, item, triangle));
                numbers.collect::<Result<_, _>>()?
            } else {
                let count = stored.entry.corners_of(triangle.record as usize).count();
                let Some(each) = list.per_corner(count) else {
                    continue;
                };
                let place = (element, rows, list.property);
                let found = sources.map(|source| self.found(place, each, source, triangle));
                let mut new = Vec::with_capacity(3 * each);
                for found in found {
                    new.extend(found?);
                }
                new
            };

            // Its length, and its entries with what stood between them.
            out.extend_from_slice(&stored.source[copied..list.length.start]);
            match new.len() == list.entries.len() {
                true => out.extend_from_slice(&stored.source[list.length.clone()]),
                false => self.push_whole(index32(new.len()), count, out),
            }
            copied = list.length.end;
            for (old, new) in list.entries.iter().zip(&new) {
                out.extend_from_slice(&stored.source[copied..old.start]);
                out.extend_from_slice(new);
                copied = old.end;
            }
            copied = list.end();
        }
        out.extend_from_slice(&stored.source[copied..row.end]);
        Ok(())
    }

    /// What a list holds for a corner of the file.
    fn found(
        &self,
        (element, rows, property): (&Element, &Spans, usize),
        each: usize,
        source: RecordCorner,
        triangle: &PlannedTriangle,
    ) -> Result<Vec<Vec<u8>>, Problem> {
        let stored = &self.source.stored;
        let count = stored.entry.corners_of(source.record).count();
        let lists = self.lists(element, rows.span(source.record));
        let list = lists.into_iter().find(|list| list.property == property);
        let list = list.filter(|list| list.per_corner(count) == Some(each));
        let list = list.ok_or_else(|| {
            let name = &element.properties[property].name;
            let text = format!(
                "a corner moves to a vertex where the list {name:?} has not as many entries a corner: leave \
                 its corners"
            );
            face_problem(triangle.record, &text)
        })?;
        let entries = &list.entries[source.place * each..][..each];
        let entries = entries
            .iter()
            .map(|span| stored.source[span.clone()].to_vec());
        Ok(entries.collect())
    }

    /// The number of a vertex as the list of corners has it.
    fn vertex(
        &self,
        vertex: u32,
        item: ComponentType,
        triangle: &PlannedTriangle,
    ) -> Result<Vec<u8>, Problem> {
        let new = self.source.new_number(vertex);
        if u64::from(new) > item.largest() {
            let text = format!(
                "its indices are stored in {} bytes, which cannot name vertex {new}: leave out more vertices",
                item.size()
            );
            return Err(face_problem(triangle.record, &text));
        }
        let mut bytes = Vec::new();
        self.push_whole(new, item, &mut bytes);
        Ok(bytes)
    }

    /// Appends a whole number of this type.
    fn push_whole(&self, number: u32, scalar: ComponentType, out: &mut Vec<u8>) {
        let size = scalar.size();
        match self.notation.encoding {
            Encoding::Ascii => push_number(out, number.into()),
            Encoding::LittleEndian => out.extend_from_slice(&number.to_le_bytes()[..size]),
            Encoding::BigEndian => out.extend_from_slice(&number.to_be_bytes()[4 - size..]),
        }
    }

    /// The lists of a row, which was read before.
    fn lists(&self, element: &Element, row: Range<usize>) -> Vec<RowList> {
        let source = self.source.stored.source;
        let lists = match self.notation.encoding {
            Encoding::Ascii => ascii_lists(source, element, row),
            Encoding::LittleEndian => {
                binary_lists(Binary::<false>::new(source, row.start), element)
            }
            Encoding::BigEndian => binary_lists(Binary::<true>::new(source, row.start), element),
        };
        lists.unwrap_or_default()
    }
}

fn ascii_lists(source: &[u8], element: &Element, row: Range<usize>) -> Option<Vec<RowList>> {
    let mut tokens = Tokens::plain(&source[..row.end], row.start);
    let mut lists = Vec::new();
    for (property, declared) in element.properties.iter().enumerate() {
        let token = tokens.next()?;
        if let PropertyKind::List { .. } = declared.kind {
            let count = usize::try_from(whole_number(&source[token.clone()])?).ok()?;
            lists.push(RowList {
                property,
                length: token,
                entries: tokens.by_ref().take(count).collect(),
            });
        }
    }
    Some(lists)
}

fn binary_lists<R: PlyRows>(mut rows: R, element: &Element) -> Option<Vec<RowList>> {
    let row = Row { element, number: 0 };
    let mut lists = Vec::new();
    for (property, declared) in element.properties.iter().enumerate() {
        match declared.kind {
            PropertyKind::Scalar(scalar) => rows.skip(1, scalar, &row).ok()?,
            PropertyKind::List { count, item } => {
                let start = rows.at();
                let count = rows.list_length(count, &row).ok()?;
                let first = rows.at();
                rows.skip(count, item, &row).ok()?;
                let entry = |i: usize| first + i * item.size()..first + (i + 1) * item.size();
                lists.push(RowList {
                    property,
                    length: start..first,
                    entries: (0..count).map(entry).collect(),
                });
            }
        }
    }
    Some(lists)
}
