//! A second reader, written apart from the library: what each corner of each triangle holds.

use std::path::Path;

use meshweft::files::Format;
use serde_json::Value;

/// A glTF taken apart without any checks.
pub(crate) struct Reader {
    pub(crate) json_text: Vec<u8>,
    pub(crate) json: Value,
    pub(crate) buffers: Vec<Option<Vec<u8>>>,
}

/// One triangle: for each corner all its attributes and morph targets.
pub(crate) type Triangle = [Vec<u8>; 3];

impl Reader {
    /// Reads a file, or `bytes` in its stead.
    pub(crate) fn of_file(path: &Path, bytes: Option<Vec<u8>>) -> Self {
        let bytes = bytes.unwrap_or_else(|| std::fs::read(path).unwrap());
        let (json_text, binary) = match Format::of_path(path) {
            Some(Format::Glb) => chunks(&bytes),
            _ => (bytes, None),
        };
        let json: Value = serde_json::from_slice(&json_text).unwrap();
        let mut buffers = Vec::new();
        for buffer in json["buffers"].as_array().into_iter().flatten() {
            buffers.push(match buffer["uri"].as_str() {
                None if buffers.is_empty() => binary.clone(),
                None => None,
                Some(uri) => Some(match uri.split_once(";base64,") {
                    Some((_, data)) => decode(data),
                    None => std::fs::read(path.with_file_name(uri.replace("%20", " "))).unwrap(),
                }),
            });
        }
        Self {
            json_text,
            json,
            buffers,
        }
    }

    /// The triangles of each triangle-list primitive whose data is not compressed, sorted.
    pub(crate) fn triangles(&self) -> Vec<Vec<Triangle>> {
        let meshes = self.json["meshes"].as_array();
        let primitives = meshes
            .into_iter()
            .flatten()
            .flat_map(|mesh| mesh["primitives"].as_array().unwrap());
        primitives
            .filter(|primitive| primitive["mode"].as_u64().unwrap_or(4) == 4)
            .filter_map(|primitive| self.triangles_of(primitive))
            .collect()
    }

    /// The positions of what these primitives draw by indices, corner by corner in the order of the file.
    pub(crate) fn drawn_in_order(&self, is_in_order: impl Fn(&Value) -> bool) -> Vec<Vec<u8>> {
        let meshes = self.json["meshes"].as_array().into_iter().flatten();
        let primitives = meshes.flat_map(|mesh| mesh["primitives"].as_array().unwrap());
        let mut drawn = Vec::new();
        for primitive in primitives.filter(|primitive| is_in_order(primitive)) {
            let positions = self.elements(&primitive["attributes"]["POSITION"]);
            let numbers = self.elements(&primitive["indices"]);
            let (positions, numbers) = (positions.unwrap(), numbers.unwrap());
            drawn.extend(numbers.iter().map(|n| positions[number(n)].clone()));
        }
        drawn
    }

    /// Those of one primitive.
    pub(crate) fn triangles_of(&self, primitive: &Value) -> Option<Vec<Triangle>> {
        let mut columns = Vec::new();
        let mut sets = vec![&primitive["attributes"]];
        sets.extend(primitive["targets"].as_array().into_iter().flatten());
        for set in sets {
            for accessor in set.as_object().unwrap().values() {
                columns.push(self.elements(accessor)?);
            }
        }
        let corners: Vec<usize> = match primitive.get("indices") {
            Some(accessor) => self.elements(accessor)?.iter().map(|e| number(e)).collect(),
            None => (0..columns[0].len()).collect(),
        };
        let mut triangles: Vec<Triangle> = corners
            .chunks_exact(3)
            .map(|face| {
                let corner = |i: usize| {
                    let values = columns.iter().map(|column| column[face[i]].clone());
                    values.collect::<Vec<_>>().concat()
                };
                // The smallest of the three ways to write it down: corners may be equal.
                let turned = (0..3).map(|r| [0, 1, 2].map(|i| corner((i + r) % 3)));
                turned.min().unwrap()
            })
            .collect();
        triangles.sort();
        Some(triangles)
    }

    /// For each outline edge of each primitive the positions of its two ends, in file order.
    pub(crate) fn outlines(&self) -> Vec<Vec<u8>> {
        let mut ends = Vec::new();
        for mesh in self.json["meshes"].as_array().unwrap() {
            for primitive in mesh["primitives"].as_array().unwrap() {
                let outline = &primitive["extensions"]["CESIUM_primitive_outline"];
                let Some(indices) = outline.get("indices") else {
                    continue;
                };
                let positions = &primitive["attributes"]["POSITION"];
                let positions = self.elements(positions).unwrap();
                let numbers = self.elements(indices).unwrap();
                ends.extend(numbers.iter().map(|n| positions[number(n)].clone()));
            }
        }
        ends
    }

    /// For each byte of the first buffer whether it is part of what may be moved.
    pub(crate) fn record_bytes(&self) -> Vec<bool> {
        let mut is_record = vec![false; self.buffers[0].as_ref().unwrap().len()];
        let mut accessors = Vec::new();
        for mesh in self.json["meshes"].as_array().unwrap() {
            for primitive in mesh["primitives"].as_array().unwrap() {
                accessors.extend(primitive.get("indices"));
                let sets = primitive["targets"].as_array().into_iter().flatten();
                for set in sets.chain([&primitive["attributes"]]) {
                    accessors.extend(set.as_object().unwrap().values());
                }
                let outline = &primitive["extensions"]["CESIUM_primitive_outline"];
                accessors.extend(outline.get("indices"));
            }
        }
        let mut mark = |part: &Value, length: usize, count: usize| {
            let Some(view) = part.get("bufferView") else {
                return;
            };
            let view = &self.json["bufferViews"][size(view, 0)];
            let stride = size(&view["byteStride"], length);
            let start = size(&view["byteOffset"], 0) + size(&part["byteOffset"], 0);
            for i in 0..count {
                is_record[start + i * stride..][..length].fill(true);
            }
        };
        for accessor in accessors {
            let accessor = &self.json["accessors"][size(accessor, 0)];
            let length = element_size(accessor);
            mark(accessor, length, size(&accessor["count"], 0));
            if let Some(sparse) = accessor.get("sparse") {
                let (indices, count) = (&sparse["indices"], size(&sparse["count"], 0));
                mark(indices, width(&indices["componentType"]), count);
                mark(&sparse["values"], length, count);
            }
        }
        is_record
    }

    /// The bytes of each element; sparse replacements are put in.
    pub(crate) fn elements(&self, accessor: &Value) -> Option<Vec<Vec<u8>>> {
        let accessor = &self.json["accessors"][size(accessor, 0)];
        let length = element_size(accessor);
        let count = size(&accessor["count"], 0);
        let mut elements = match accessor.get("bufferView") {
            Some(view) => self.pieces(view, &accessor["byteOffset"], length, count)?,
            None => vec![vec![0; length]; count],
        };
        if let Some(sparse) = accessor.get("sparse") {
            let (indices, values) = (&sparse["indices"], &sparse["values"]);
            let count = size(&sparse["count"], 0);
            let index_width = self::width(&indices["componentType"]);
            let indices = self.pieces(
                &indices["bufferView"],
                &indices["byteOffset"],
                index_width,
                count,
            )?;
            let values =
                self.pieces(&values["bufferView"], &values["byteOffset"], length, count)?;
            for (index, value) in indices.iter().zip(values) {
                elements[number(index)] = value;
            }
        }
        Some(elements)
    }

    fn pieces(
        &self,
        view: &Value,
        offset: &Value,
        length: usize,
        count: usize,
    ) -> Option<Vec<Vec<u8>>> {
        let view = &self.json["bufferViews"][size(view, 0)];
        let is_compressed = view.get("extensions").is_some_and(|e| {
            e.as_object()
                .unwrap()
                .keys()
                .any(|name| name.contains("meshopt"))
        });
        if is_compressed {
            return None;
        }
        let bytes = self.buffers[size(&view["buffer"], 0)].as_ref()?;
        let start = size(&view["byteOffset"], 0) + size(offset, 0);
        let stride = size(&view["byteStride"], length);
        let piece = |i: usize| bytes[start + i * stride..][..length].to_vec();
        Some((0..count).map(piece).collect())
    }
}

fn size(value: &Value, default: usize) -> usize {
    value
        .as_u64()
        .map_or(default, |n| usize::try_from(n).unwrap())
}

fn element_size(accessor: &Value) -> usize {
    let components = match accessor["type"].as_str().unwrap() {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" | "MAT2" => 4,
        "MAT3" => 9,
        _ => 16,
    };
    components * width(&accessor["componentType"])
}

fn width(component: &Value) -> usize {
    match size(component, 0) {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    }
}

fn number(bytes: &[u8]) -> usize {
    bytes
        .iter()
        .rev()
        .fold(0, |n, &byte| n << 8 | usize::from(byte))
}

fn chunks(bytes: &[u8]) -> (Vec<u8>, Option<Vec<u8>>) {
    let mut rest = &bytes[12..];
    let mut next = || {
        let length = number(rest.get(..4)?);
        let data = rest[8..8 + length].to_vec();
        rest = &rest[8 + length..];
        Some(data)
    };
    (next().unwrap(), next())
}

/// Base64, one character at a time.
fn decode(text: &str) -> Vec<u8> {
    let (mut bits, mut count) = (0_u32, 0);
    let mut bytes = Vec::new();
    for character in text.chars().filter(|&c| c != '=') {
        let value = match character {
            'A'..='Z' => u32::from(character) - 65,
            'a'..='z' => u32::from(character) - 71,
            '0'..='9' => u32::from(character) + 4,
            '+' => 62,
            _ => 63,
        };
        bits = bits << 6 | value;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push(u8::try_from(bits >> count & 255).unwrap());
        }
    }
    bytes
}
