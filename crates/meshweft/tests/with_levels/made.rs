//! A bumpy sheet with levels of detail in one GLB: what the nodes say, and the faces of each level.

use meshweft::files::{Document, Format};
use meshweft::{Limits, Permutation};
use serde_json::{Value, json};

use crate::builder::{Builder, F32, U16, U32, glb};

/// What a GLB is made of.
#[derive(Debug, Clone)]
pub(crate) struct Sheet {
    /// How many squares are along each side.
    pub(crate) side: u32,
    /// How many times squares of half the number are a level.
    pub(crate) level_count: u32,
    /// Into how many primitives each level is cut.
    pub(crate) primitive_count: usize,
    /// Vertices that no face uses.
    pub(crate) unused: u32,
    /// Every so many faces one is left out of each level; 0 for none.
    pub(crate) holes: usize,
    /// Which levels each have vertices of their own.
    pub(crate) own_vertices: bool,
    pub(crate) seed: u64,
}

impl Default for Sheet {
    fn default() -> Self {
        Self {
            side: 16,
            level_count: 3,
            primitive_count: 1,
            unused: 0,
            holes: 0,
            own_vertices: false,
            seed: 1,
        }
    }
}

impl Sheet {
    fn vertex_count(&self) -> u32 {
        (self.side + 1).pow(2) + self.unused
    }

    fn positions(&self) -> Vec<[f32; 3]> {
        let row = self.side + 1;
        let position = |v: u32| {
            let [x, y] = [(v % row) as f32, (v / row) as f32];
            [x, y, (0.3 * x).sin() * (0.2 * y).cos()]
        };
        (0..self.vertex_count()).map(position).collect()
    }

    /// The faces of each level in each primitive, fine to coarse, shuffled.
    fn levels(&self) -> Vec<Vec<Vec<[u32; 3]>>> {
        let level = |number: u32| {
            let step = 1 << number;
            let per_side = self.side / step;
            let square = |i: u32| {
                let corner = (i / per_side * (self.side + 1) + i % per_side) * step;
                let above = corner + (self.side + 1) * step;
                [
                    [corner, corner + step, above],
                    [corner + step, above + step, above],
                ]
            };
            let all: Vec<[u32; 3]> = (0..per_side * per_side).flat_map(square).collect();
            let mut all: Vec<[u32; 3]> = match self.holes {
                0 => all,
                holes => {
                    let kept = all.into_iter().enumerate();
                    kept.filter(|(i, _)| i % holes != 0)
                        .map(|it| it.1)
                        .collect()
                }
            };
            // Parts from left to right.
            all.sort_by_key(|face| face[0] % (self.side + 1));
            let parts = all.chunks(all.len().div_ceil(self.primitive_count));
            let seed = self.seed + u64::from(number);
            parts
                .map(|part| Permutation::random(part.len(), seed).apply(part))
                .collect()
        };
        (0..=self.level_count).map(level).collect()
    }

    /// The GLB. Vertices are shuffled.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut builder = Builder::default();
        let count = self.vertex_count() as usize;
        let new_to_old = Permutation::random(count, self.seed);
        let positions = new_to_old.apply(&self.positions());
        let old_to_new = new_to_old.old_to_new();
        let position = |builder: &mut Builder| {
            let bytes: Vec<u8> = positions
                .iter()
                .flatten()
                .flat_map(|x| x.to_le_bytes())
                .collect();
            let view = builder.view(&bytes, None);
            builder.accessor(view, 0, F32, count, "VEC3")
        };

        let mut shared = position(&mut builder);
        let component = if count < 65_536 { U16 } else { U32 };
        let mut meshes = Vec::new();
        for (number, parts) in self.levels().iter().enumerate() {
            if self.own_vertices && number > 0 {
                shared = position(&mut builder);
            }
            let primitives: Vec<Value> = parts
                .iter()
                .map(|faces| {
                    let numbers = faces
                        .iter()
                        .flatten()
                        .map(|&v| old_to_new[v as usize] as usize);
                    let indices = builder.indices(component, &numbers.collect::<Vec<_>>());
                    json!({"attributes": {"POSITION": shared}, "indices": indices})
                })
                .collect();
            let mut mesh = json!({"name": "sheet", "primitives": primitives});
            if number > 0 {
                mesh["name"] = format!("sheet, level {number}").into();
                mesh["extras"] =
                    json!({"MESHWEFT_level": {"level": number, "error": 0.125 * number as f64}});
            }
            meshes.push(mesh);
        }

        let ids: Vec<u32> = (1..=self.level_count).collect();
        let mut nodes: Vec<Value> = (0..=self.level_count)
            .map(|mesh| json!({"mesh": mesh}))
            .collect();
        let mut others = json!({ "scenes": [{"nodes": [0]}], "scene": 0 });
        if !ids.is_empty() {
            nodes[0]["extensions"] = json!({"MSFT_lod": {"ids": ids}});
            others["extensionsUsed"] = json!(["MSFT_lod"]);
        }
        others["nodes"] = nodes.into();
        let json = builder.json(&meshes.into(), &others);
        glb(&json.to_string(), Some(&builder.binary))
    }

    pub(crate) fn document(&self) -> Document {
        open(&self.bytes())
    }

    /// The same without levels.
    pub(crate) fn plain(&self) -> Document {
        let plain = Self {
            level_count: 0,
            ..self.clone()
        };
        plain.document()
    }
}

/// One of two primitives, with vertices that no face uses.
pub(crate) fn two_primitives() -> Sheet {
    Sheet {
        primitive_count: 2,
        unused: 2,
        ..Sheet::default()
    }
}

pub(crate) fn open(bytes: &[u8]) -> Document {
    let name = std::path::Path::new("sheet.glb");
    Document::from_bytes(bytes.to_vec(), Format::Glb, name, Limits::default()).unwrap()
}
