//! Slow and simple readers of OBJ, PLY and OFF, written apart from the library's.
//!
//! They cut a file into vertex records, face records and what is between them.

use meshweft::files::Format;

/// A face record: the vertex of each corner, what is glued to it (`/2/3`), and the text between.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Face {
    pub(crate) vertices: Vec<usize>,
    pub(crate) glued: Vec<Vec<u8>>,
    pub(crate) between: Vec<Vec<u8>>,
}

/// A file in pieces.
#[derive(Debug, Default)]
pub(crate) struct Pieces {
    pub(crate) vertices: Vec<Vec<u8>>,
    pub(crate) faces: Vec<Face>,
    /// The file with each record replaced by one mark.
    pub(crate) rest: Vec<u8>,
    /// OBJ: what the `l` and `p` lines name.
    pub(crate) lines: Vec<usize>,
    /// OBJ: the `vt` and `vn` lines.
    pub(crate) definitions: Vec<Vec<u8>>,
    /// OBJ: how much of what each face names stands below it.
    pub(crate) below: Vec<usize>,
}

const MARKS: [u8; 2] = [1, 2];

pub(crate) fn read(bytes: &[u8], format: Format) -> Pieces {
    match format {
        Format::Obj => read_obj(bytes),
        Format::Off => read_off(bytes),
        Format::Ply => read_ply(bytes),
        Format::Stl => super::simple_stl::read(bytes),
        other => panic!("{other} is not a text format"),
    }
}

/// Splits a line into (leading blanks, content, trailing blanks and line end).
fn cut(line: &[u8]) -> (&[u8], &[u8], &[u8]) {
    let start = line.iter().position(|b| !b.is_ascii_whitespace());
    let start = start.unwrap_or(line.len());
    let end = line.iter().rposition(|b| !b.is_ascii_whitespace());
    let end = end.map_or(start, |last| last + 1);
    (&line[..start], &line[start..end], &line[end..])
}

fn is_space(byte: u8) -> bool {
    byte == b' ' || byte == b'\t'
}

/// The face of `text`, whose corners are `count` words after the first `skip`.
fn face(text: &[u8], skip: usize, count: usize, vertex_of: impl Fn(i64) -> usize) -> Face {
    let mut face = Face {
        vertices: Vec::new(),
        glued: Vec::new(),
        between: vec![Vec::new()],
    };
    let mut at = 0;
    let mut word = 0;
    while at < text.len() {
        if is_space(text[at]) || word >= skip + count {
            face.between.last_mut().unwrap().push(text[at]);
            at += 1;
            continue;
        }
        let length = text[at..].iter().position(|&b| is_space(b));
        let token = &text[at..at + length.unwrap_or(text.len() - at)];
        at += token.len();
        word += 1;
        if word <= skip {
            face.between.last_mut().unwrap().extend(token);
            continue;
        }
        let token = String::from_utf8(token.to_vec()).unwrap();
        let (number, glued) = token.split_at(token.find('/').unwrap_or(token.len()));
        face.vertices.push(vertex_of(number.parse().unwrap()));
        face.glued.push(glued.into());
        face.between.push(Vec::new());
    }
    face
}

fn words(text: &[u8]) -> Vec<&[u8]> {
    let words = text.split(|&b| is_space(b));
    words.filter(|word| !word.is_empty()).collect()
}

fn number(word: &[u8]) -> usize {
    std::str::from_utf8(word).unwrap().parse().unwrap()
}

/// All records have one mark, as `vt` and `vn` lines go where faces were.
fn read_obj(bytes: &[u8]) -> Pieces {
    let mut pieces = Pieces::default();
    let mut counts = [0; 3];
    for line in bytes.split_inclusive(|&b| b == b'\n') {
        let (before, content, after) = cut(line);
        let vertex_of = |number: i64| match number > 0 {
            true => number as usize - 1,
            false => counts[0] - number.unsigned_abs() as usize,
        };
        let code = content.split(|&b| b == b'#').next().unwrap_or_default();
        let words = words(code);
        match words.first().copied() {
            Some(word @ (b"v" | b"vt" | b"vn")) => {
                let kind = [b"v" as &[u8], b"vt", b"vn"]
                    .iter()
                    .position(|&w| w == word);
                counts[kind.unwrap()] += 1;
                match kind {
                    Some(0) => pieces.vertices.push(content.to_vec()),
                    _ => pieces.definitions.push(content.to_vec()),
                }
                pieces.rest.extend([before, &MARKS[1..], after].concat());
            }
            Some(b"f") => {
                let mut face = face(content, 1, words.len() - 1, vertex_of);
                let mut below = face.vertices.iter().filter(|&&v| v >= counts[0]).count();
                for glued in &mut face.glued {
                    below += settle(glued, [counts[1], counts[2]]);
                }
                pieces.faces.push(face);
                pieces.below.push(below);
                pieces.rest.extend([before, &MARKS[1..], after].concat());
            }
            Some(b"l" | b"p") => {
                let named = face(content, 1, words.len() - 1, vertex_of);
                pieces.lines.extend(named.vertices);
                for between in named.between {
                    pieces.rest.extend(between);
                }
            }
            _ => pieces.rest.extend(line),
        }
    }
    pieces
}

/// Counts from the first line what counts back in `/2/3`; how much names lines that are not yet there.
fn settle(glued: &mut Vec<u8>, counts: [usize; 2]) -> usize {
    let text = String::from_utf8(glued.clone()).unwrap();
    let mut below = 0;
    let settled = text.split('/').enumerate().map(|(place, number)| {
        let count = |place: usize| counts[place - 1] as i64;
        match number.parse::<i64>() {
            Ok(back @ ..0) if -back <= count(place) => (count(place) + 1 + back).to_string(),
            Ok(number) => {
                below += usize::from(number > count(place));
                number.to_string()
            }
            Err(_) => number.to_owned(),
        }
    });
    *glued = settled.collect::<Vec<_>>().join("/").into_bytes();
    below
}

fn read_off(bytes: &[u8]) -> Pieces {
    let mut pieces = Pieces::default();
    let mut counts = Vec::new();
    for line in bytes.split_inclusive(|&b| b == b'\n') {
        let code = line.split(|&b| b == b'#').next().unwrap_or_default();
        let (before, content, _) = cut(code);
        let after = &line[before.len() + content.len()..];
        if content.is_empty() {
            pieces.rest.extend(line);
        } else if counts.len() < 2 {
            let numbers = words(content).into_iter();
            counts.extend(numbers.filter(|w| w[0].is_ascii_digit()).map(number));
            pieces.rest.extend(line);
        } else if pieces.vertices.len() < counts[0] {
            pieces.vertices.push(content.to_vec());
            pieces.rest.extend([before, &MARKS[..1], after].concat());
        } else if pieces.faces.len() < counts[1] {
            let count = number(words(content)[0]);
            let face = face(content, 1, count, |number| number as usize);
            pieces.faces.push(face);
            pieces.rest.extend([before, &MARKS[1..], after].concat());
        } else {
            pieces.rest.extend(line);
        }
    }
    pieces
}

/// Name, count, and properties (type of the length or "", type, name).
type Element = (String, usize, Vec<(String, String, String)>);

fn read_ply(bytes: &[u8]) -> Pieces {
    let mut elements: Vec<Element> = Vec::new();
    let mut format = String::new();
    let mut at = 0;
    loop {
        let end = at + bytes[at..].iter().position(|&b| b == b'\n').unwrap();
        let line = String::from_utf8_lossy(&bytes[at..end]).into_owned();
        at = end + 1;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            ["format", name, ..] => format = name.into(),
            ["element", name, count] => {
                elements.push((name.into(), count.parse().unwrap(), Vec::new()));
            }
            ["property", "list", length, item, name] => {
                let property = (length.into(), item.into(), name.into());
                elements.last_mut().unwrap().2.push(property);
            }
            ["property", item, name] => {
                let property = (String::new(), item.into(), name.into());
                elements.last_mut().unwrap().2.push(property);
            }
            ["end_header"] => break,
            _ => {}
        }
    }
    let mut pieces = Pieces {
        rest: bytes[..at].to_vec(),
        ..Pieces::default()
    };
    for (name, count, properties) in &elements {
        for _ in 0..*count {
            let row = match format == "ascii" {
                true => ascii_row(bytes, at, name, properties, &mut pieces),
                false => binary_row(bytes, at, &format, name, properties, &mut pieces),
            };
            at = row;
        }
    }
    pieces.rest.extend(&bytes[at..]);
    pieces
}

type Properties = [(String, String, String)];

fn ascii_row(
    bytes: &[u8],
    at: usize,
    name: &str,
    properties: &Properties,
    pieces: &mut Pieces,
) -> usize {
    let mut end = at;
    let (before, content, after) = loop {
        let length = bytes[end..].iter().position(|&b| b == b'\n');
        end = length.map_or(bytes.len(), |length| end + length + 1);
        let (before, content, after) = cut(&bytes[at..end]);
        if !content.is_empty() {
            break (before, content, after);
        }
    };
    match name {
        "vertex" => {
            pieces.vertices.push(content.to_vec());
            pieces.rest.extend([before, &MARKS[..1], after].concat());
        }
        "face" => {
            let words = words(content);
            let mut skip = 0;
            for (length, _, name) in properties {
                if name.starts_with("vertex_ind") {
                    break;
                }
                skip += if length.is_empty() {
                    1
                } else {
                    1 + number(words[skip])
                };
            }
            let count = number(words[skip]);
            let face = face(content, skip + 1, count, |number| number as usize);
            pieces.faces.push(face);
            pieces.rest.extend([before, &MARKS[1..], after].concat());
        }
        _ => pieces.rest.extend(&bytes[at..end]),
    }
    end
}

fn binary_row(
    bytes: &[u8],
    start: usize,
    format: &str,
    name: &str,
    properties: &Properties,
    pieces: &mut Pieces,
) -> usize {
    let size = |kind: &str| match kind {
        "char" | "uchar" | "int8" | "uint8" => 1,
        "short" | "ushort" | "int16" | "uint16" => 2,
        "double" | "float64" => 8,
        _ => 4,
    };
    let whole = |at: usize, kind: &str| {
        let mut digits = bytes[at..at + size(kind)].to_vec();
        if format == "binary_little_endian" {
            digits.reverse();
        }
        digits
            .iter()
            .fold(0, |number, &byte| number * 256 + usize::from(byte))
    };
    let mut at = start;
    let mut corners = (start, 0, 0);
    for (length, item, name) in properties {
        if length.is_empty() {
            at += size(item);
            continue;
        }
        let count = whole(at, length);
        at += size(length);
        if name.starts_with("vertex_ind") {
            corners = (at, count, size(item));
        }
        at += count * size(item);
    }
    match name {
        "vertex" => {
            pieces.vertices.push(bytes[start..at].to_vec());
            pieces.rest.push(MARKS[0]);
        }
        "face" => {
            let (first, count, width) = corners;
            let kind = ["", "uchar", "ushort", "", "int"][width];
            let starts = (0..count).map(|corner| first + corner * width);
            pieces.faces.push(Face {
                vertices: starts.map(|at| whole(at, kind)).collect(),
                glued: vec![Vec::new(); count],
                between: vec![
                    bytes[start..first].into(),
                    bytes[first + count * width..at].into(),
                ],
            });
            pieces.rest.push(MARKS[1]);
        }
        // Rows that go with the faces are looked at in a test of their own.
        "multi_texture_face" => pieces.rest.push(MARKS[1]),
        _ => pieces.rest.extend(&bytes[start..at]),
    }
    at
}
