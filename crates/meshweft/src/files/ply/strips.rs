//! Triangle strips made faces: the element `tristrips` becomes an element `face`, and nothing else changes.

use super::body::pass_over;
use super::header::{Element, Encoding, PlyHeader, PropertyKind};
use super::rows::{Ascii, Binary, PlyRows, Row};
use crate::attribute::ComponentType;
use crate::files::error::{Fault, Place, Problem};
use crate::files::face_records::{check_face_count, corner_vertex};
use crate::files::note::Note;
use crate::files::text::{is_blank, is_line_end, line_of};
use crate::limits::Limits;

/// The strips of a file, as triangles.
struct Strips {
    faces: Vec<[u32; 3]>,
    /// How many triangles with a vertex twice were left out.
    left_out: usize,
    /// Where the rows start, and where the last one ends.
    rows: (usize, usize),
}

/// The file with its strips as faces, and a note about them; `None` if there are none, or they have
/// something with them that would be lost, or stand beside faces.
///
/// A strip starts again after -1. The winding is that of its first triangle, turned for every second one.
///
/// # Errors
/// The strips cannot be read, name a vertex that is not there, or are more faces than the limit.
pub(super) fn to_faces(
    source: &[u8],
    header: &PlyHeader,
    limits: &Limits,
) -> Result<Option<(Vec<u8>, Note)>, Problem> {
    let Some((element, item)) = convertible(header) else {
        return Ok(None);
    };
    let read = match header.encoding {
        Encoding::Ascii => read(Ascii::new(source, header.body), header, limits),
        Encoding::LittleEndian => read(Binary::<false>::new(source, header.body), header, limits),
        Encoding::BigEndian => read(Binary::<true>::new(source, header.body), header, limits),
    };
    let strips = read.map_err(|fault| {
        fault.kind.at(match header.encoding {
            Encoding::Ascii => Place::Line(line_of(source, fault.at)),
            _ => Place::Byte(fault.at),
        })
    })?;

    if strips.faces.is_empty() {
        return Ok(None);
    }
    let (start, end) = strips.rows;
    let mut bytes = changed_header(&source[..header.body], strips.faces.len());
    bytes.extend_from_slice(&source[header.body..start]);
    write_rows(&strips.faces, header.encoding, item, &mut bytes);
    bytes.extend_from_slice(&source[end..]);

    let note = format!(
        "the triangle strips are {} faces now; {} triangles with a vertex twice are left out",
        strips.faces.len(),
        strips.left_out
    );
    Ok(Some((bytes, Note::new(Place::Line(element.line), note))))
}

/// The element of strips and the type of their numbers, if they are nothing but lists, and there are no
/// faces beside them.
fn convertible(header: &PlyHeader) -> Option<(&Element, ComponentType)> {
    let element = header.element("tristrips")?;
    let [property] = element.properties.as_slice() else {
        return None;
    };
    // What has a row for each strip would lose its strip.
    let mut others = header.elements.iter();
    let goes_along = others.any(|other| {
        !matches!(&*other.name, "tristrips" | "vertex") && other.count == element.count
    });
    let is_alone = header.element("face").is_none() && !goes_along;
    let is_known = element.corner_list().is_some() && is_alone;
    match property.kind {
        PropertyKind::List { item, .. } if is_known && !item.is_float() => Some((element, item)),
        _ => None,
    }
}

/// Reads all elements up to and with the strips.
fn read<R: PlyRows>(mut rows: R, header: &PlyHeader, limits: &Limits) -> Result<Strips, Fault> {
    let mut strips = Strips {
        faces: Vec::new(),
        left_out: 0,
        rows: (header.body, header.body),
    };
    for element in &header.elements {
        if element.name != "tristrips" {
            pass_over(&mut rows, element, |_, _| Ok(()))?;
            continue;
        }

        let at = rows.start_row();
        strips.rows = (at, at);
        for number in 0..element.count {
            let row = Row { element, number };
            rows.start_row();
            for property in &element.properties {
                if let PropertyKind::List { count, item } = property.kind {
                    let count = rows.list_length(count, &row)?;
                    strips.add(&mut rows, count, item, &row, header.vertex_count(), limits)?;
                }
            }
            strips.rows.1 = rows.end_row(&row)?;
        }
        break;
    }
    Ok(strips)
}

impl Strips {
    /// Adds the triangles of a list of `count` numbers.
    fn add<R: PlyRows>(
        &mut self,
        rows: &mut R,
        count: usize,
        item: ComponentType,
        row: &Row<'_>,
        vertex_count: usize,
        limits: &Limits,
    ) -> Result<(), Fault> {
        // Of a strip: its last two vertices, and how many there were.
        let (mut last, mut length) = ([0; 2], 0_usize);
        for place in 0..count {
            let at = rows.at();
            let index = rows.whole(item, row)?;
            let is_end = index == -1 || item == ComponentType::U32 && index == i64::from(u32::MAX);
            if is_end {
                length = 0;
                continue;
            }
            let vertex = corner_vertex(index, vertex_count, row.number, place);
            let vertex = vertex.map_err(|kind| Fault { at, kind })?;
            let [a, b] = last;
            if length >= 2 {
                let is_odd = length % 2 == 1;
                let face = if is_odd {
                    [a, vertex, b]
                } else {
                    [a, b, vertex]
                };
                match a == b || b == vertex || a == vertex {
                    true => self.left_out += 1,
                    false => self.faces.push(face),
                }
                check_face_count(self.faces.len(), limits).map_err(|kind| Fault { at, kind })?;
            }
            (last, length) = ([b, vertex], length + 1);
        }
        Ok(())
    }
}

/// The header with the element of strips as one of so many faces, of lists whose length is one byte.
fn changed_header(header: &[u8], face_count: usize) -> Vec<u8> {
    let mut changed = Vec::with_capacity(header.len());
    let mut is_of_strips = false;
    for line in header.split_inclusive(|&byte| is_line_end(byte)) {
        let words: Vec<&[u8]> = line
            .split(|&b| is_blank(b) || is_line_end(b))
            .filter(|word| !word.is_empty())
            .collect();
        let end = line.iter().rposition(|&b| !is_blank(b) && !is_line_end(b));
        let end = &line[end.map_or(0, |last| last + 1)..];
        let new = match words.as_slice() {
            [b"element", name, ..] => {
                is_of_strips = *name == b"tristrips";
                is_of_strips.then(|| format!("element face {face_count}").into_bytes())
            }
            [b"property", b"list", _, item, name, ..] if is_of_strips => {
                Some([b"property list uchar ", *item, b" ", name].concat())
            }
            _ => None,
        };
        match new {
            Some(new) => changed.extend([&new, end].concat()),
            None => changed.extend_from_slice(line),
        }
    }
    changed
}

/// Appends a row for each face; of text, the line end of the last is there already.
fn write_rows(faces: &[[u32; 3]], encoding: Encoding, item: ComponentType, out: &mut Vec<u8>) {
    let size = item.size();
    if encoding != Encoding::Ascii {
        out.reserve(faces.len() * (1 + 3 * size));
    }
    for (number, face) in faces.iter().enumerate() {
        match encoding {
            Encoding::Ascii => {
                let [a, b, c] = face;
                let line_end = if number > 0 { "\n" } else { "" };
                out.extend_from_slice(format!("{line_end}3 {a} {b} {c}").as_bytes());
            }
            Encoding::BigEndian => {
                out.push(3);
                for corner in face {
                    out.extend_from_slice(&corner.to_be_bytes()[4 - size..]);
                }
            }
            Encoding::LittleEndian => {
                out.push(3);
                for corner in face {
                    out.extend_from_slice(&corner.to_le_bytes()[..size]);
                }
            }
        }
    }
}
