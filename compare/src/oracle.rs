//! A second, independent reading of OBJ, OFF, PLY and STL, plain or gzipped.
//!
//! It knows only what the test meshes need and trusts them; polygons are cut into fans.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use meshweft::Mesh;

/// The faces and the number of vertices of a mesh file, in file order.
///
/// # Errors
/// What is wrong, with the file's name; `.wrl` is not read.
pub fn read(file: &Path) -> Result<Mesh, String> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let bytes = std::fs::read(file).map_err(|error| format!("{name}: {error}"))?;
    let (plain_name, bytes) = match name.strip_suffix(".gz") {
        None => (&*name, bytes),
        Some(plain_name) => {
            let mut plain = Vec::new();
            flate2::read::MultiGzDecoder::new(&bytes[..])
                .read_to_end(&mut plain)
                .map_err(|error| format!("{name}: {error}"))?;
            (plain_name, plain)
        }
    };
    let ending = plain_name.rsplit('.').next().unwrap_or_default();
    let read = match ending {
        "obj" => obj(&bytes),
        "off" => off(&bytes),
        "ply" => ply(&bytes),
        "stl" => stl(&bytes),
        _ => Err(format!("no reader for .{ending}")),
    };
    let (vertex_count, faces) = read.map_err(|error| format!("{name}: {error}"))?;
    Mesh::connectivity_only(vertex_count, faces).map_err(|error| format!("{name}: {error}"))
}

type Connectivity = (usize, Vec<[u32; 3]>);

fn fan(polygon: &[u32], faces: &mut Vec<[u32; 3]>) {
    for edge in polygon.get(1..).unwrap_or_default().windows(2) {
        faces.push([polygon[0], edge[0], edge[1]]);
    }
}

fn number<T: std::str::FromStr>(word: Option<&str>) -> Result<T, String> {
    let word = word.ok_or("a number is missing")?;
    word.parse()
        .map_err(|_| format!("{word:?} is not a number"))
}

fn obj(bytes: &[u8]) -> Result<Connectivity, String> {
    let text = String::from_utf8_lossy(bytes).replace("\\\r\n", " ");
    let text = text.replace("\\\n", " ");
    let (mut vertex_count, mut faces) = (0_u32, Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => vertex_count += 1,
            Some("f") => {
                let corner = |word: &str| {
                    let index: i64 = number(word.split('/').next())?;
                    let from_zero = match index < 0 {
                        true => i64::from(vertex_count) + index,
                        false => index - 1,
                    };
                    u32::try_from(from_zero).map_err(|_| format!("index {index}"))
                };
                let polygon = words.map(corner).collect::<Result<Vec<u32>, String>>()?;
                fan(&polygon, &mut faces);
            }
            _ => {}
        }
    }
    Ok((vertex_count as usize, faces))
}

fn off(bytes: &[u8]) -> Result<Connectivity, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or_default().trim())
        .filter(|line| !line.is_empty());
    if !lines.next().is_some_and(|keyword| keyword.ends_with("OFF")) {
        return Err("no OFF keyword".to_owned());
    }
    let mut counts = lines.next().unwrap_or_default().split_whitespace();
    let vertex_count: usize = number(counts.next())?;
    let polygon_count: usize = number(counts.next())?;
    let mut faces = Vec::with_capacity(polygon_count);
    let mut rows = lines.skip(vertex_count);
    for _ in 0..polygon_count {
        let mut words = rows.next().unwrap_or_default().split_whitespace();
        let corners: usize = number(words.next())?;
        let polygon = (0..corners).map(|_| number(words.next()));
        fan(&polygon.collect::<Result<Vec<u32>, String>>()?, &mut faces);
    }
    Ok((vertex_count, faces))
}

/// What the values of a PLY file are taken from.
enum Values<'a> {
    Text(std::str::SplitWhitespace<'a>),
    LittleEndian(&'a [u8]),
    BigEndian(&'a [u8]),
}

impl Values<'_> {
    /// The next value, of a PLY type, as a whole number; a fraction is cut off.
    fn next(&mut self, kind: &str) -> Result<i64, String> {
        let (bytes, little) = match self {
            Self::Text(words) => {
                let word = words.next().ok_or("the file ends early")?;
                return match kind.starts_with(['f', 'd']) {
                    true => Ok(0),
                    false => number(Some(word)),
                };
            }
            Self::LittleEndian(bytes) => (bytes, true),
            Self::BigEndian(bytes) => (bytes, false),
        };
        let width = match kind {
            "char" | "uchar" | "int8" | "uint8" => 1,
            "short" | "ushort" | "int16" | "uint16" => 2,
            "int" | "uint" | "float" | "int32" | "uint32" | "float32" => 4,
            "double" | "float64" => 8,
            _ => return Err(format!("type {kind:?}")),
        };
        let (value, rest) = bytes.split_at_checked(width).ok_or("the file ends early")?;
        *bytes = rest;
        let fold = |sum: i64, &byte: &u8| sum.wrapping_mul(256) + i64::from(byte);
        // Only vertex counts and indices are of interest, and those are never negative.
        Ok(match little {
            true => value.iter().rev().fold(0, fold),
            false => value.iter().fold(0, fold),
        })
    }
}

fn ply(bytes: &[u8]) -> Result<Connectivity, String> {
    const END: &[u8] = b"end_header";
    let end = bytes.windows(END.len()).position(|window| window == END);
    let end = end.ok_or("no end_header")? + END.len();
    let line_end = bytes[end..].iter().position(|&byte| byte == b'\n');
    let body = &bytes[end + line_end.ok_or("no line after end_header")? + 1..];
    let header = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let body_text = String::from_utf8_lossy(body);
    let mut values = None;
    // Name, count and properties of each element; a property is its words without "property".
    let mut elements: Vec<(&str, usize, Vec<Vec<&str>>)> = Vec::new();
    for line in header.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("format") => {
                values = Some(match words.next() {
                    Some("ascii") => Values::Text(body_text.split_whitespace()),
                    Some("binary_little_endian") => Values::LittleEndian(body),
                    _ => Values::BigEndian(body),
                });
            }
            Some("element") => {
                let name = words.next().unwrap_or_default();
                elements.push((name, number(words.next())?, Vec::new()));
            }
            Some("property") => {
                let (.., properties) = elements
                    .last_mut()
                    .ok_or("a property before the first element")?;
                properties.push(words.collect());
            }
            _ => {}
        }
    }
    let mut values = values.ok_or("no format")?;
    let (mut vertex_count, mut faces) = (0, Vec::new());
    for (element, count, properties) in elements {
        if element == "vertex" {
            vertex_count = count;
        }
        for _ in 0..count {
            for property in &properties {
                let &["list", length_kind, kind, name] = &property[..] else {
                    values.next(property[0])?;
                    continue;
                };
                let length = values.next(length_kind)?;
                let entries = (0..length).map(|_| values.next(kind));
                let entries = entries.collect::<Result<Vec<i64>, String>>()?;
                if element == "face" && matches!(name, "vertex_indices" | "vertex_index") {
                    let index = |&entry: &i64| u32::try_from(entry).map_err(|e| e.to_string());
                    let polygon = entries.iter().map(index);
                    fan(&polygon.collect::<Result<Vec<u32>, String>>()?, &mut faces);
                }
            }
        }
    }
    Ok((vertex_count, faces))
}

/// Binary STL; corners with the same bits of position are one vertex, numbered by first use.
fn stl(bytes: &[u8]) -> Result<Connectivity, String> {
    let count = bytes.get(80..84).ok_or("shorter than a header")?;
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
    if bytes.len() != 84 + 50 * count {
        return Err("not a binary STL file of this length".to_owned());
    }
    let mut vertices: HashMap<&[u8], u32> = HashMap::new();
    let mut faces = Vec::with_capacity(count);
    for record in bytes[84..].chunks_exact(50) {
        let corner = |slot: usize, vertices: &mut HashMap<_, u32>| {
            let next = u32::try_from(vertices.len()).map_err(|error| error.to_string())?;
            let position = &record[12 + 12 * slot..][..12];
            Ok::<u32, String>(*vertices.entry(position).or_insert(next))
        };
        let mut face = [0; 3];
        for (slot, vertex) in face.iter_mut().enumerate() {
            *vertex = corner(slot, &mut vertices)?;
        }
        faces.push(face);
    }
    Ok((vertices.len(), faces))
}
