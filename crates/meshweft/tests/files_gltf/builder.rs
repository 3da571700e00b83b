//! Builds glTF files in memory.

use serde_json::{Value, json};

pub(crate) const U8: usize = 5121;
pub(crate) const U16: usize = 5123;
pub(crate) const U32: usize = 5125;
pub(crate) const F32: usize = 5126;

/// Buffer views and accessors over one buffer, gaps filled with bytes that must stay.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) binary: Vec<u8>,
    pub(crate) views: Vec<Value>,
    pub(crate) accessors: Vec<Value>,
}

impl Builder {
    /// Adds a view of these bytes, and a gap behind it; returns its number.
    pub(crate) fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        let mut view = json!({
            "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len(),
        });
        if let Some(stride) = stride {
            view["byteStride"] = stride.into();
        }
        self.binary.extend_from_slice(bytes);
        let gap = 8 - self.binary.len() % 4;
        self.binary.extend(std::iter::repeat_n(0xA5, gap));
        self.views.push(view);
        self.views.len() - 1
    }

    /// Adds an accessor; returns its number.
    pub(crate) fn accessor(
        &mut self,
        view: usize,
        offset: usize,
        component: usize,
        count: usize,
        name: &str,
    ) -> usize {
        self.accessors.push(json!({
            "bufferView": view, "byteOffset": offset, "componentType": component, "count": count,
            "type": name, "extras": {"kept": [1.50, "x"]},
        }));
        self.accessors.len() - 1
    }

    /// Adds a tight view of `count` elements made of different bytes, and its accessor.
    pub(crate) fn data(&mut self, component: usize, name: &str, count: usize) -> usize {
        let width = match component {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let components = match name {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        let salt = self.binary.len();
        let bytes: Vec<u8> = (0..count * width * components)
            .map(|i| u8::try_from((i * 37 + i / 251 + salt) % 120).unwrap())
            .collect();
        let view = self.view(&bytes, None);
        self.accessor(view, 0, component, count, name)
    }

    /// Adds a list of vertex numbers.
    pub(crate) fn indices(&mut self, component: usize, numbers: &[usize]) -> usize {
        let width = match component {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let bytes = numbers
            .iter()
            .flat_map(|&n| n.to_le_bytes()[..width].to_vec());
        let bytes: Vec<u8> = bytes.collect();
        let view = self.view(&bytes, None);
        self.accessor(view, 0, component, numbers.len(), "SCALAR")
    }

    /// The JSON with these meshes and other fields.
    pub(crate) fn json(&self, meshes: &Value, others: &Value) -> Value {
        let mut root = json!({
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": self.binary.len()}],
            "bufferViews": self.views,
            "accessors": self.accessors,
            "meshes": meshes,
        });
        for (name, value) in others.as_object().unwrap() {
            root[name] = value.clone();
        }
        root
    }

    /// A GLB with an unknown chunk at its end, and bytes behind that.
    pub(crate) fn glb(&self, meshes: &Value, others: &Value) -> Vec<u8> {
        glb(&self.json(meshes, others).to_string(), Some(&self.binary))
    }
}

pub(crate) fn glb(json: &str, binary: Option<&[u8]>) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut chunks: Vec<(&[u8], &[u8])> = vec![(b"JSON", &json)];
    chunks.extend(binary.map(|bytes| (&b"BIN\0"[..], bytes)));
    chunks.push((b"ODD\0", b"\x01\x02\x03\x04"));
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, data) in chunks {
        bytes.extend_from_slice(&u32::try_from(data.len()).unwrap().to_le_bytes());
        bytes.extend_from_slice(kind);
        bytes.extend_from_slice(data);
    }
    let length = u32::try_from(bytes.len()).unwrap().to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    bytes.extend_from_slice(b"behind");
    bytes
}

/// `face_count` faces over `vertex_count` vertices, every vertex in at least one if there is room.
pub(crate) fn faces(face_count: usize, vertex_count: usize) -> Vec<usize> {
    (0..3 * face_count)
        .map(|i| match i < vertex_count {
            true => i,
            false => (i * 7 + i / 5) % vertex_count,
        })
        .collect()
}
