//! What plain files hold, read here without the library: OBJ, PLY, OFF, STL.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

/// What a file holds, without how it is written.
#[derive(Debug, PartialEq)]
pub(super) struct Contents {
    pub(super) name: String,
    /// The bits of the positions.
    positions: Vec<[u32; 3]>,
    /// Each face from its least corner on, sorted.
    faces: Vec<Vec<usize>>,
    /// Everything else: what it is called here, and what a message may call it.
    pub(super) others: BTreeMap<String, Vec<String>>,
}

/// Nothing for other formats, and files that are not sound.
pub(super) fn contents(path: &Path) -> Option<Contents> {
    let mut bytes = Vec::new();
    let file = File::open(path).unwrap();
    let name = path.file_name()?.to_str()?;
    match name.strip_suffix(".gz") {
        Some(_) => MultiGzDecoder::new(file).read_to_end(&mut bytes).ok()?,
        None => (&file).read_to_end(&mut bytes).ok()?,
    };
    let name = name.strip_suffix(".gz").unwrap_or(name);
    let mut contents = Contents {
        name: String::new(),
        positions: Vec::new(),
        faces: Vec::new(),
        others: BTreeMap::new(),
    };
    match name.rsplit_once('.')?.1 {
        "obj" => contents.obj(&String::from_utf8_lossy(&bytes)),
        "off" => contents.off(&String::from_utf8_lossy(&bytes)),
        "ply" => contents.ply(&bytes),
        "stl" => contents.stl(&bytes),
        _ => None,
    }?;
    for face in &mut contents.faces {
        let turns = (0..face.len()).map(|turn| [&face[turn..], &face[..turn]].concat());
        *face = turns.min()?;
    }
    contents.faces.sort();
    Some(contents)
}

impl Contents {
    fn other(&mut self, what: &str, names: &[&str]) {
        let names = names.iter().map(|name| (*name).to_owned());
        self.others.insert(what.to_owned(), names.collect());
    }

    fn position(&mut self, numbers: &[&str]) -> Option<()> {
        let numbers = numbers
            .iter()
            .map(|word| word.parse::<f32>().map(f32::to_bits));
        let numbers = numbers.collect::<Result<Vec<u32>, _>>().ok()?;
        self.positions.push(numbers.try_into().ok()?);
        Some(())
    }

    fn obj(&mut self, text: &str) -> Option<()> {
        let mut vertex_count = 0;
        let (mut data, mut last_face) = (BTreeMap::<String, usize>::new(), 0);
        for (number, line) in text.replace("\\\n", " ").lines().enumerate() {
            if let Some(comment) = line.trim().strip_prefix('#') {
                let words: Vec<&str> = comment.split_whitespace().collect();
                let is_number = |word: &&str| word.parse::<f64>().is_ok();
                if words.len() > 1 && words[1..].iter().all(is_number) && !is_number(&words[0]) {
                    *data.entry(words[0].to_owned()).or_default() += words.len() - 1;
                }
                if words.first() == Some(&"MRGB") {
                    self.other("MRGB", &["MRGB"]);
                }
            }
            let line = line.split('#').next()?;
            let words: Vec<&str> = line.split_whitespace().collect();
            let Some((&keyword, rest)) = words.split_first() else {
                continue;
            };
            match keyword {
                "v" => {
                    vertex_count += 1;
                    self.position(rest.get(..3)?)?;
                    if rest.len() > 3 {
                        self.other("v", &["COLOR_0", "(v)"]);
                    }
                }
                "f" => {
                    last_face = number;
                    let corner = |word: &&str| {
                        let vertex: isize = word.split('/').next()?.parse().ok()?;
                        let start = if vertex > 0 { -1 } else { vertex_count };
                        usize::try_from(start + vertex).ok()
                    };
                    self.faces
                        .push(rest.iter().map(corner).collect::<Option<_>>()?);
                    if rest.len() < 3 {
                        self.other("short faces", &["fewer than three"]);
                    }
                    let mut parts = rest.iter().map(|word| word.split('/').skip(1));
                    if parts.any(|mut parts| parts.any(|part| !part.is_empty())) {
                        self.other("corners", &["TEXCOORD_0", "(vt)", "NORMAL", "(vn)"]);
                    }
                }
                "vt" => self.other("vt", &["TEXCOORD_0", "(vt)"]),
                "vn" => self.other("vn", &["NORMAL", "(vn)"]),
                "o" if self.name.is_empty() && last_face == 0 => self.name = rest.join(" "),
                "o" if self.name == rest.join(" ") && last_face == 0 => {}
                "g" if matches!(rest, [] | ["default"]) => {}
                // Named with the materials.
                "mtllib" => {}
                "s" if matches!(rest, [] | ["off" | "0"]) => {}
                other => {
                    let names = [format!("({other})"), format!("{other:?}")];
                    self.other(other, &[&names[0], &names[1]]);
                }
            }
        }
        for (word, numbers) in data {
            let counts = [self.positions.len(), self.faces.len()];
            if counts.iter().any(|&count| count > 2 && numbers == count) {
                self.other("comments", &[&word]);
            }
        }
        Some(())
    }

    fn off(&mut self, text: &str) -> Option<()> {
        // Words line by line: colors end with the line of their face.
        let lines = text
            .lines()
            .map(|line| line.split('#').next().unwrap_or(""));
        let lines = lines.map(|line| line.split_whitespace().collect::<Vec<_>>());
        let mut lines = lines.filter(|words| !words.is_empty());
        let mut first = lines.next()?;
        match first[0] {
            "OFF" if first.len() > 1 => drop(first.remove(0)),
            "OFF" => first = lines.next()?,
            word if word.starts_with("OFF") => first[0] = &word[3..],
            word if word.parse::<usize>().is_ok() => {}
            _ => return None,
        }
        let [vertices, faces] = [first.first()?, first.get(1)?].map(|it| it.parse::<usize>());
        for _ in 0..vertices.ok()? {
            let words = lines.next()?;
            self.position(words.get(..3)?)?;
            if words.len() > 3 {
                self.other("numbers of vertices", &["more numbers of vertices"]);
            }
        }
        for _ in 0..faces.ok()? {
            let mut words = lines.next()?;
            let count: usize = words.first()?.parse().ok()?;
            while words.len() <= count {
                words.extend(lines.next()?);
            }
            let corners = words[1..=count].iter().map(|word| word.parse().ok());
            self.faces.push(corners.collect::<Option<_>>()?);
            if words.len() > count + 1 {
                self.other("colors of faces", &["COLOR_0", "colors of some faces"]);
            }
            if count < 3 {
                self.other("short faces", &["fewer than three"]);
            }
        }
        Some(())
    }

    fn stl(&mut self, bytes: &[u8]) -> Option<()> {
        // Facets of twelve numbers.
        let mut facets: Vec<Vec<f32>> = Vec::new();
        let text = String::from_utf8_lossy(bytes);
        if text.starts_with("solid") && text.contains("facet normal") {
            let words = text.split_whitespace();
            let numbers = words.filter_map(|word| word.parse().ok());
            let numbers: Vec<f32> = numbers.collect();
            facets.extend(numbers.chunks_exact(12).map(<[f32]>::to_vec));
            if text.matches("endsolid").count() > 1 {
                self.other("solids", &["several solids"]);
            }
        } else {
            for facet in bytes.get(84..)?.chunks_exact(50) {
                let numbers = facet[..48].as_chunks().0;
                facets.push(numbers.iter().map(|it| f32::from_le_bytes(*it)).collect());
                if facet[48..] != [0, 0] {
                    self.other("two bytes", &["attribute of faces"]);
                }
            }
        }

        // Positions by their bits, and normals that turn away from those of their corners.
        let corner = |facet: &[f32], at: usize| [0, 1, 2].map(|axis| facet[3 * at + axis]);
        let bits = |facet: &[f32], at: usize| corner(facet, at).map(f32::to_bits);
        let all = facets.iter();
        let all = all.flat_map(|facet| [1, 2, 3].map(|at| bits(facet, at)));
        let unique: BTreeSet<[u32; 3]> = all.collect();
        self.positions = unique.into_iter().collect();
        for facet in &facets {
            let corners = [1, 2, 3].map(|at| self.positions.binary_search(&bits(facet, at)));
            self.faces
                .push(corners.into_iter().collect::<Result<_, _>>().ok()?);
            let [normal, a, b, c] = [0, 1, 2, 3].map(|at| corner(facet, at).map(f64::from));
            let side = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
            let ([ux, uy, uz], [vx, vy, vz]) = (side(b), side(c));
            let cross = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let (area, length) = (dot(cross, cross).sqrt(), dot(normal, normal).sqrt());
            let is_other = dot(normal, cross) < 0.999 * area || (length - 1.0).abs() > 0.02;
            if length > 0.0 && area > 0.0 && is_other {
                self.other("normals", &["NORMAL of faces"]);
            }
        }
        Some(())
    }

    fn ply(&mut self, bytes: &[u8]) -> Option<()> {
        // The header, as lines of words.
        let end = b"end_header";
        let end = bytes.windows(end.len()).position(|window| window == end)? + end.len();
        let header = String::from_utf8_lossy(&bytes[..end]).replace('\r', "\n");
        let body = bytes[end..].iter().position(|&byte| byte == b'\n')? + end + 1;
        let mut format = String::new();
        let mut elements: Vec<(String, usize, Vec<Vec<String>>)> = Vec::new();
        for line in header.lines() {
            let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
            match words.first().map(String::as_str) {
                Some("format") => format.clone_from(words.get(1)?),
                Some("element") => {
                    elements.push((words.get(1)?.clone(), words.get(2)?.parse().ok()?, vec![]));
                }
                Some("property") => elements.last_mut()?.2.push(words[1..].to_vec()),
                _ => {}
            }
        }

        // The rows.
        let text = String::from_utf8_lossy(&bytes[body..]);
        let mut rows = Rows {
            words: (format == "ascii").then(|| text.split_whitespace()),
            bytes: &bytes[body..],
            is_big: format == "binary_big_endian",
        };
        for (element, count, properties) in elements.iter().filter(|it| it.1 > 0) {
            let mut known = BTreeSet::new();
            match element.as_str() {
                "vertex" => known.extend(["x", "y", "z"]),
                "face" => known.extend(["vertex_indices", "vertex_index"]),
                other => self.other(other, &[other]),
            }
            for property in properties {
                let name = property.last()?.as_str();
                if (element == "vertex" || element == "face") && !known.contains(name) {
                    let special = match name {
                        "nx" | "ny" | "nz" => "NORMAL",
                        "texcoord" | "s" | "t" | "u" | "v" | "texture_u" | "texture_v" => {
                            "TEXCOORD_0"
                        }
                        _ => "COLOR_0",
                    };
                    self.other(&format!("{element} {name}"), &[name, special]);
                }
            }
            for _ in 0..*count {
                let mut position = [0; 3];
                for property in properties {
                    let name = property.last()?.as_str();
                    match property.first()?.as_str() {
                        "list" => {
                            let length = rows.number(&property[1])?;
                            let items = (0..to_usize(length)?).map(|_| rows.number(&property[2]));
                            let items: Vec<f64> = items.collect::<Option<_>>()?;
                            if element == "face" && known.contains(name) {
                                if items.len() < 3 {
                                    self.other("short faces", &["fewer than three"]);
                                }
                                let corners = items.into_iter().map(to_usize);
                                self.faces.push(corners.collect::<Option<_>>()?);
                            }
                        }
                        kind => {
                            let number = rows.number(kind)?;
                            let axis = ["x", "y", "z"].iter().position(|it| *it == name);
                            if let Some(axis) = axis.filter(|_| element == "vertex") {
                                position[axis] = rounded(number).to_bits();
                            }
                        }
                    }
                }
                if element == "vertex" {
                    self.positions.push(position);
                }
            }
        }
        Some(())
    }
}

fn to_usize(number: f64) -> Option<usize> {
    number.to_string().parse().ok()
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "as a file with 32-bit positions has it"
)]
fn rounded(number: f64) -> f32 {
    number as f32
}

/// The rows of a PLY file.
struct Rows<'a> {
    words: Option<std::str::SplitWhitespace<'a>>,
    bytes: &'a [u8],
    is_big: bool,
}

impl Rows<'_> {
    fn number(&mut self, kind: &str) -> Option<f64> {
        if let Some(words) = &mut self.words {
            let word = words.next()?;
            // Rounded once.
            return match kind {
                "float" | "float32" => word.parse::<f32>().ok().map(f64::from),
                _ => word.parse().ok(),
            };
        }
        let size = match kind {
            "char" | "uchar" | "int8" | "uint8" => 1,
            "short" | "ushort" | "int16" | "uint16" => 2,
            "int" | "uint" | "float" | "int32" | "uint32" | "float32" => 4,
            "double" | "float64" => 8,
            _ => return None,
        };
        let (number, rest) = self.bytes.split_at_checked(size)?;
        self.bytes = rest;
        let mut le = number.to_vec();
        if self.is_big {
            le.reverse();
        }
        le.resize(8, 0);
        let bits = u64::from_le_bytes(le.try_into().ok()?);
        Some(match kind {
            "float" | "float32" => {
                let bits = u32::try_from(bits).expect("four bytes");
                f64::from(f32::from_bits(bits))
            }
            "double" | "float64" => f64::from_bits(bits),
            // Corners, colors and lengths are not negative in files that are taken.
            _ => bits as f64,
        })
    }
}
