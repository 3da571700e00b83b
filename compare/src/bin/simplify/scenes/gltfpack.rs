//! What gltfpack does to a primitive when it is asked for fewer faces.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use compare::rivals;
use meshweft::Mesh;
use meshweft::attribute::{Attribute, Semantic};

use super::object::ScenePrimitive;

/// Normals, then colours.
const WEIGHTS: [f32; 6] = [0.5, 0.5, 0.5, 1.0, 1.0, 1.0];

/// A primitive as meshoptimizer gets it from gltfpack (`simplifyMesh` in its `mesh.cpp`): for itself, equal vertices as
/// one, no face with two equal corners; a vertex is cut in two where the texture is mirrored; normals weigh .5, colours
/// (times their alpha) 1, texture coordinates nothing. Parts may be pruned, as gltfpack has it, or not.
pub(crate) struct GltfpackPrimitive {
    mesh: Mesh,
    /// The vertex of the primitive that each vertex is.
    sources: Vec<u32>,
    attributes: Vec<[f32; 6]>,
    /// All faces, as they came.
    full: Vec<[u32; 3]>,
}

impl GltfpackPrimitive {
    pub(crate) fn new(primitive: &ScenePrimitive) -> Self {
        let of = |semantic: Semantic| {
            let is_own =
                |it: &&Attribute| it.info.semantic == semantic && it.info.morph_target.is_none();
            let found = primitive.attributes.iter().find(is_own);
            found.map(|it| (it.to_f32(), it.info.components))
        };
        let used = [Semantic::Normal, Semantic::Color(0), Semantic::TexCoord(0)];
        let [normals, colours, texture] = used.map(of);

        // On which sides of a mirrored texture each vertex is: 1, 2, or both.
        let whole =
            |face: &&[u32; 3]| face[0] != face[1] && face[1] != face[2] && face[2] != face[0];
        let full = primitive.mesh.faces();
        let faces: Vec<[u32; 3]> = full.iter().filter(whole).copied().collect();
        let side_of = |face: &[u32; 3]| {
            texture.as_ref().map_or(0_u8, |(values, components)| {
                let [a, b, c] = face.map(|vertex| {
                    let at = &values[vertex as usize * components..];
                    [at[0], at[1]]
                });
                let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
                u8::from(area > 0.0) + 2 * u8::from(area < 0.0)
            })
        };
        let mut sides = vec![0; primitive.mesh.vertex_count()];
        for face in &faces {
            for &vertex in face {
                sides[vertex as usize] |= side_of(face);
            }
        }

        // Vertices: those of faces, two where they are on both.
        let (mut numbers, mut sources, mut kept) = (BTreeMap::new(), Vec::new(), Vec::new());
        for face in &faces {
            let is_mirrored = side_of(face) == 2;
            kept.push(face.map(|vertex| {
                let is_second = is_mirrored && sides[vertex as usize] == 3;
                *numbers.entry((vertex, is_second)).or_insert_with(|| {
                    sources.push(vertex);
                    u32::try_from(sources.len() - 1).expect("at most two a vertex")
                })
            }));
        }

        let element = |column: &Option<(Vec<f32>, usize)>, vertex: u32, slot: usize| {
            let (values, components) = column.as_ref()?;
            let values = values[vertex as usize * components..].get(..*components)?;
            values.get(slot).copied()
        };
        let attributes = sources.iter().map(|&vertex| {
            let alpha = element(&colours, vertex, 3).unwrap_or(1.0);
            [0, 1, 2, 3, 4, 5].map(|slot| match slot {
                0..3 => element(&normals, vertex, slot).unwrap_or(0.0),
                _ => alpha * element(&colours, vertex, slot - 3).unwrap_or(0.0),
            })
        });
        let position = |&vertex: &u32| primitive.mesh.positions()[vertex as usize];
        let positions: Vec<_> = sources.iter().map(position).collect();
        Self {
            attributes: attributes.collect(),
            mesh: Mesh::new(positions, kept).expect("numbers of vertices"),
            sources,
            full: full.to_vec(),
        }
    }

    /// What is left with as near to so many faces as it gets, and at least `least`, if that is possible.
    pub(crate) fn nearest(&self, face_count: usize, least: usize, prunes: bool) -> Vec<[u32; 3]> {
        if face_count >= self.mesh.face_count() {
            return self.full.clone();
        }
        let (mut low, mut high) = (0, self.mesh.face_count());
        let mut best = self.full.clone();
        let mut asked = face_count;
        while low <= high {
            let left = self.simplified(asked, prunes);
            let count = left.len();
            if count >= least && count.abs_diff(face_count) < best.len().abs_diff(face_count) {
                best = left;
            }
            match count.cmp(&face_count) {
                Ordering::Equal => break,
                Ordering::Less => low = asked + 1,
                Ordering::Greater if asked == 0 => break,
                Ordering::Greater => high = asked - 1,
            }
            asked = low.midpoint(high);
        }
        best
    }

    fn simplified(&self, face_count: usize, prunes: bool) -> Vec<[u32; 3]> {
        let (mesh, attributes) = (&self.mesh, &self.attributes);
        let left =
            rivals::simplified_with_attributes(mesh, attributes, &WEIGHTS, face_count, prunes);
        let left = left.iter();
        left.map(|face| face.map(|vertex| self.sources[vertex as usize]))
            .collect()
    }
}
