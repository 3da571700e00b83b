//! Made meshes with seams: a sheet rolled up once, textured, of two materials.

use std::fmt::Write;

use meshweft::files::Format;
use serde_json::json;

use crate::builder::{Builder, F32, U32};

/// A bumpy sheet of `width` × `height` cells in two triangles each. Its left and right edges stand at the same
/// positions in every format that has seams, with other texture coordinates; the upper half is of another
/// material. Records of vertices and faces are shuffled.
pub(crate) struct Sheet {
    width: usize,
    height: usize,
    /// Position and texture coordinate of each vertex.
    vertices: Vec<([f32; 3], [f32; 2])>,
    /// With the number of the material.
    faces: Vec<([usize; 3], usize)>,
    is_rolled: bool,
}

impl Sheet {
    pub(crate) fn new(width: usize, height: usize, seed: u64) -> Self {
        let mut random = crate::random::Numbers(seed.wrapping_mul(0x9e37_79b9) | 1);
        let at = |x: usize, y: usize| y * (width + 1) + x;
        let mut vertices = Vec::new();
        for y in 0..=height {
            for x in 0..=width {
                let bump = (x as f32 * 0.7).sin() * (y as f32 * 0.5).cos() * 1.5;
                let noise = random.below(1000) as f32 * 1e-4;
                let z = bump + noise;
                vertices.push((
                    [x as f32, y as f32, z],
                    [x as f32 / width as f32, y as f32 / height as f32],
                ));
            }
        }
        let mut faces = Vec::new();
        for y in 0..height {
            let material = usize::from(2 * y >= height);
            for x in 0..width {
                faces.push(([at(x, y), at(x + 1, y), at(x, y + 1)], material));
                faces.push(([at(x, y + 1), at(x + 1, y), at(x + 1, y + 1)], material));
            }
        }
        for last in (1..faces.len()).rev() {
            faces.swap(last, random.below(last + 1));
        }
        // Faces of one material stand together.
        faces.sort_by_key(|(_, material)| *material);
        Self {
            width,
            height,
            vertices,
            faces,
            is_rolled: false,
        }
    }

    /// Rolls it up: the right edge meets the left one.
    pub(crate) fn roll_up(&mut self) {
        let width = self.width as f32;
        for y in 0..=self.height {
            for x in 0..=self.width {
                let turn = std::f32::consts::TAU * (x % self.width) as f32 / width;
                let vertex = &mut self.vertices[y * (self.width + 1) + x].0;
                let radius = width / 6.0 + 0.3 * (y as f32).sin();
                *vertex = [radius * turn.cos(), y as f32, radius * turn.sin()];
            }
        }
        self.is_rolled = true;
    }

    pub(crate) fn flatten(&mut self) {
        self.vertices
            .iter_mut()
            .for_each(|(position, _)| position[2] = 0.0);
    }

    /// Takes faces away, for which `leaves` says so.
    pub(crate) fn remove_faces(&mut self, mut leaves: impl FnMut(usize) -> bool) {
        let mut number = 0..;
        self.faces.retain(|_| !leaves(number.next().unwrap_or(0)));
    }

    pub(crate) fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// How many vertices are on the border of the flat sheet.
    pub(crate) fn border_records(&self) -> usize {
        2 * (self.width + self.height)
    }

    pub(crate) fn bytes(&self, format: Format) -> Vec<u8> {
        match format {
            Format::Obj => self.obj().into_bytes(),
            Format::Ply => self.ply().into_bytes(),
            Format::Off => self.off().into_bytes(),
            Format::Stl => self.stl(),
            Format::Glb => self.builder(|builder, meshes| builder.glb(meshes, &json!({}))),
            _ => self.builder(|builder, meshes| {
                let mut root = builder.json(meshes, &json!({}));
                let data = base64(&builder.binary);
                root["buffers"][0]["uri"] =
                    format!("data:application/octet-stream;base64,{data}").into();
                root.to_string().into_bytes()
            }),
        }
    }

    /// Vertices by position, texture coordinates of corners, materials.
    fn obj(&self) -> String {
        let mut text = String::from("# a sheet\n");
        let mut points: Vec<[f32; 3]> = Vec::new();
        let mut point_of = Vec::new();
        for (position, _) in &self.vertices {
            let found = points.iter().position(|p| p == position);
            point_of.push(found.unwrap_or(points.len()));
            if found.is_none() {
                points.push(*position);
            }
        }
        for [x, y, z] in points {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for (_, [u, v]) in &self.vertices {
            writeln!(text, "vt {u} {v}").unwrap();
        }
        let mut last = usize::MAX;
        for (face, material) in &self.faces {
            if *material != last {
                writeln!(text, "usemtl material{material}").unwrap();
                last = *material;
            }
            let [a, b, c] = face.map(|v| format!("{}/{}", point_of[v] + 1, v + 1));
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
        text
    }

    fn ply(&self) -> String {
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             property float s\nproperty float t\nelement face {}\nproperty list uchar int vertex_indices\n\
             property uchar material\nend_header\n",
            self.vertices.len(),
            self.faces.len()
        );
        for ([x, y, z], [u, v]) in &self.vertices {
            writeln!(text, "{x} {y} {z} {u} {v}").unwrap();
        }
        for ([a, b, c], material) in &self.faces {
            writeln!(text, "3 {a} {b} {c} {material}").unwrap();
        }
        text
    }

    fn off(&self) -> String {
        let mut text = format!("OFF\n{} {} 0\n", self.vertices.len(), self.faces.len());
        for ([x, y, z], _) in &self.vertices {
            writeln!(text, "{x} {y} {z}").unwrap();
        }
        for ([a, b, c], _) in &self.faces {
            writeln!(text, "3 {a} {b} {c}").unwrap();
        }
        text
    }

    fn stl(&self) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes.extend((self.faces.len() as u32).to_le_bytes());
        for (face, material) in &self.faces {
            bytes.extend([0; 12]);
            for position in face.map(|v| self.vertices[v].0) {
                bytes.extend(position.iter().flat_map(|x| x.to_le_bytes()));
            }
            bytes.extend((*material as u16).to_le_bytes());
        }
        bytes
    }

    /// One mesh of two primitives with vertices of their own.
    fn builder<T>(&self, finish: impl FnOnce(&Builder, &serde_json::Value) -> T) -> T {
        let mut builder = Builder::default();
        let mut primitives = Vec::new();
        for material in 0..2 {
            let faces = self.faces.iter().filter(|(_, of)| *of == material);
            let mut number_of = vec![usize::MAX; self.vertices.len()];
            let (mut used, mut indices) = (Vec::new(), Vec::new());
            for &vertex in faces.flat_map(|(face, _)| face) {
                if number_of[vertex] == usize::MAX {
                    number_of[vertex] = used.len();
                    used.push(vertex);
                }
                indices.push(number_of[vertex]);
            }
            if used.is_empty() {
                continue;
            }
            let bytes = |numbers: &mut dyn Iterator<Item = f32>| -> Vec<u8> {
                numbers.flat_map(f32::to_le_bytes).collect()
            };
            let positions = bytes(&mut used.iter().flat_map(|&v| self.vertices[v].0));
            let texture = bytes(&mut used.iter().flat_map(|&v| self.vertices[v].1));
            let view = builder.view(&positions, None);
            let positions = builder.accessor(view, 0, F32, used.len(), "VEC3");
            let view = builder.view(&texture, None);
            let texture = builder.accessor(view, 0, F32, used.len(), "VEC2");
            let indices = builder.indices(U32, &indices);
            primitives.push(json!({
                "attributes": {"POSITION": positions, "TEXCOORD_0": texture}, "indices": indices,
            }));
        }
        finish(&builder, &json!([{"primitives": primitives}]))
    }
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |bytes: &[u8]| {
        let number =
            bytes.iter().fold(0_u32, |n, &b| n << 8 | u32::from(b)) << (8 * (3 - bytes.len()));
        let digits = (0..4).map(|i| match i <= bytes.len() {
            true => DIGITS[(number >> (18 - 6 * i)) as usize & 63] as char,
            false => '=',
        });
        digits.collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}
