//! The header of a PLY file: which elements there are, and what their rows hold.

use crate::attribute::ComponentType;
use crate::files::error::{FileErrorKind, Place, Problem};
use crate::files::note::Note;
use crate::files::text::{is_blank, is_line_end, line_of, shown, whole_number};

/// The element whose rows go with the faces one by one, if there are as many.
pub(super) const COMPANION: &str = "multi_texture_face";

/// How the rows are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// What PLY asks of its types.
impl ComponentType {
    /// The type that a header calls by this word.
    fn of_ply(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The largest whole number that an index of this type can be.
    pub(super) fn largest(self) -> u64 {
        match self {
            Self::I8 => 0x7f,
            Self::U8 => 0xff,
            Self::I16 => 0x7fff,
            Self::U16 => 0xffff,
            Self::I32 => 0x7fff_ffff,
            Self::U32 => 0xffff_ffff,
            // Indices are never of these types.
            Self::F32 | Self::F64 => 0,
        }
    }
}

/// One number, or a list with its length before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PropertyKind {
    Scalar(ComponentType),
    List {
        count: ComponentType,
        item: ComponentType,
    },
}

/// One column of an element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyKind,
}

/// Rows of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// The line it is declared on.
    pub(super) line: usize,
}

impl Element {
    /// The number of the property that is one number and has this name.
    pub(super) fn scalar(&self, name: &str) -> Option<usize> {
        let is_it = |p: &Property| p.name == name && matches!(p.kind, PropertyKind::Scalar(_));
        self.properties.iter().position(is_it)
    }

    /// The number of the list that holds the corners of a face.
    pub(super) fn corner_list(&self) -> Option<usize> {
        let is_it = |p: &Property| {
            matches!(p.name.as_str(), "vertex_indices" | "vertex_index")
                && matches!(p.kind, PropertyKind::List { .. })
        };
        self.properties.iter().position(is_it)
    }

    /// The number of the list that may hold two texture coordinates a corner.
    pub(super) fn texture_list(&self) -> Option<usize> {
        let is_it =
            |p: &Property| p.name == "texcoord" && matches!(p.kind, PropertyKind::List { .. });
        self.properties.iter().position(is_it)
    }

    /// The least a row takes in a binary file.
    pub(super) fn smallest_row(&self) -> usize {
        let size = |property: &Property| match property.kind {
            PropertyKind::Scalar(scalar) => scalar.size(),
            PropertyKind::List { count, .. } => count.size(),
        };
        self.properties.iter().map(size).sum()
    }
}

/// Everything before the rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct PlyHeader {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// The first line that is not of a PLY header, and how many follow it before the first element.
    /// Blender 2.4 wrote "Created by Blender3D …" without the word `comment`.
    pub(super) foreign: Option<Note>,
    /// Where the rows start.
    pub(super) body: usize,
}

impl PlyHeader {
    pub(super) fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|element| element.name == name)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.element("vertex").map_or(0, |element| element.count)
    }
}

/// Reads the header.
pub(super) fn read(source: &[u8]) -> Result<PlyHeader, Problem> {
    let malformed = |at: usize, text: String| {
        FileErrorKind::malformed(text).at(Place::Line(line_of(source, at)))
    };
    if !source.starts_with(b"ply") || !source.get(3).is_none_or(|&b| is_blank(b) || is_line_end(b))
    {
        let text = "a PLY file starts with the word ply: is it another format?".into();
        return Err(malformed(0, text));
    }

    // Lines may end with a lone `\r`; the first line shows it. It has to be known, for the first
    // byte after the last `\r` of such a header may be a `\n`.
    let first = source.iter().position(|&byte| is_line_end(byte));
    let only_returns =
        first.is_some_and(|at| source[at] == b'\r' && source.get(at + 1) != Some(&b'\n'));
    let ending = if only_returns { b'\r' } else { b'\n' };

    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut foreign: Option<Note> = None;
    let mut at = 0;
    while at < source.len() {
        let start = at;
        let length = source[start..].iter().position(|&byte| byte == ending);
        let end = length.map_or(source.len(), |length| start + length);
        at = (end + 1).min(source.len());

        let line = &source[start..end];
        let mut words = line
            .split(|&b| is_blank(b) || is_line_end(b))
            .filter(|w| !w.is_empty());
        match words.next().unwrap_or_default() {
            b"ply" | b"" => {}
            word if [&b"comment"[..], b"obj_info"]
                .iter()
                .any(|c| word.eq_ignore_ascii_case(c)) => {}
            b"format" => {
                let word = words.next().unwrap_or_default();
                encoding = Some(parse_encoding(word).map_err(|text| malformed(start, text))?);
            }
            b"element" => {
                let element = element(&mut words, line_of(source, start));
                let element = element.map_err(|text| malformed(start, text))?;
                if elements.iter().any(|other| other.name == element.name) {
                    let text = format!("the element {:?} is declared a second time", element.name);
                    return Err(malformed(start, text));
                }
                elements.push(element);
            }
            b"property" => {
                let property = property(&mut words).map_err(|text| malformed(start, text))?;
                let element = elements.last_mut().ok_or_else(|| {
                    malformed(start, "a property before the first element".into())
                })?;
                element.properties.push(property);
            }
            b"end_header" => {
                let encoding = encoding.ok_or_else(|| {
                    malformed(
                        start,
                        "the header ends without a line that says the format".into(),
                    )
                })?;
                check_faces(&elements)?;
                return Ok(PlyHeader {
                    encoding,
                    elements,
                    foreign,
                    body: at,
                });
            }
            // Where no element is declared yet, no line can be about one.
            _ if elements.is_empty() => match &mut foreign {
                Some(first) => first.more += 1,
                None => foreign = Some(foreign_line(line_of(source, start), line)),
            },
            other => {
                let text = format!("{} is not a word of a PLY header", shown(other));
                return Err(malformed(start, text));
            }
        }
    }

    let what = "the header: there is no end_header";
    Err(FileErrorKind::truncated(what).at(Place::Line(line_of(source, source.len()))))
}

/// What there is to say about a line that is not of a PLY header.
fn foreign_line(number: usize, line: &[u8]) -> Note {
    let line = shown(line.trim_ascii());
    let text = format!("the header line {line} is not of PLY: taken for a comment");
    Note::new(Place::Line(number), text)
}

/// What a `format` line says.
fn parse_encoding(word: &[u8]) -> Result<Encoding, String> {
    match word {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        other => Err(format!("the format {} is not one of PLY", shown(other))),
    }
}

/// What an `element` line declares, without its properties.
fn element<'a>(words: &mut impl Iterator<Item = &'a [u8]>, line: usize) -> Result<Element, String> {
    let name = String::from_utf8_lossy(words.next().unwrap_or_default()).into_owned();
    let word = words.next().unwrap_or_default();
    let count = whole_number(word).and_then(|n| usize::try_from(n).ok());
    let count = count.ok_or_else(|| {
        let rows = shown(word);
        format!("the element {name:?} has {rows} rows, which is not a count")
    })?;
    Ok(Element {
        name,
        count,
        properties: Vec::new(),
        line,
    })
}

/// What a `property` line declares.
fn property<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<Property, String> {
    let scalar = |word: Option<&[u8]>| {
        let word = word.unwrap_or_default();
        ComponentType::of_ply(word).ok_or_else(|| format!("{} is not a type of PLY", shown(word)))
    };
    let first = words.next();
    let kind = match first {
        Some(b"list") => {
            let (count, item) = (scalar(words.next())?, scalar(words.next())?);
            if count.is_float() {
                return Err("the length of a list cannot be a float".into());
            }
            PropertyKind::List { count, item }
        }
        other => PropertyKind::Scalar(scalar(other)?),
    };
    let name = words.next().ok_or("a property without a name")?;
    let name = String::from_utf8_lossy(name).into_owned();
    Ok(Property { name, kind })
}

/// Faces need a list of corners, and that one of whole numbers.
fn check_faces(elements: &[Element]) -> Result<(), Problem> {
    let Some(face) = elements.iter().find(|element| element.name == "face") else {
        return Ok(());
    };
    let malformed = |text: &str| Err(FileErrorKind::malformed(text).at(Place::Line(face.line)));
    match face.corner_list().map(|list| face.properties[list].kind) {
        Some(PropertyKind::List { item, .. }) if item.is_float() => {
            malformed("the corners of the faces are floats: export them as whole numbers")
        }
        None if face.count > 0 => malformed(
            "the faces have no list vertex_indices or vertex_index: their corners are not known",
        ),
        _ => Ok(()),
    }
}
