//! Which vertices stand at one point, and which of them are the same.

use std::cmp::Ordering;

use crate::attribute::{Attribute, Values};
use crate::geometry::place_bits;
use crate::index::index32;

/// The vertices of a mesh by position. A point is named by its first vertex.
#[derive(Debug)]
pub(super) struct WeldedPoints {
    /// The point of each vertex.
    pub(super) point_of: Vec<u32>,
    /// The first vertex that agrees with each in its position and every attribute.
    pub(super) same_as: Vec<u32>,
}

impl WeldedPoints {
    /// Positions and attributes are compared byte for byte, but −0 is 0. Without positions every vertex
    /// is a point.
    ///
    /// Time O(vertices log vertices) whatever the values are.
    pub(super) fn new(positions: &[[f32; 3]], attributes: &[&Attribute]) -> Self {
        // Vertices by a hash of their position, so that equal ones come together.
        let hash = |[x, y, z]: [u32; 3]| {
            let mixed = [x, y, z].iter().fold(0_u64, |mixed, &part| {
                (mixed ^ u64::from(part))
                    .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                    .rotate_left(29)
            });
            mixed.wrapping_mul(0xbf58_476d_1ce4_e5b9) & 0xffff_ffff_0000_0000
        };
        let mut order: Vec<u64> = positions
            .iter()
            .zip(0..)
            .map(|(&p, v)| hash(place_bits(p)) | v)
            .collect();
        order.sort_unstable();

        let identity: Vec<u32> = (0..index32(positions.len())).collect();
        let mut points = Self {
            point_of: identity.clone(),
            same_as: identity,
        };
        let mut vertices = Vec::new();
        for run in order
            .chunk_by(|a, b| a >> 32 == b >> 32)
            .filter(|run| run.len() > 1)
        {
            // In a run of one hash, those of one position; there, those of the same record.
            let vertex =
                |entry: &u64| u32::try_from(entry & u64::from(u32::MAX)).unwrap_or_default();
            vertices.clear();
            vertices.extend(run.iter().map(vertex));
            vertices.sort_unstable_by_key(|&v| (place_bits(positions[v as usize]), v));
            let at = |v: u32| place_bits(positions[v as usize]);
            for point in vertices.chunk_by_mut(|&a, &b| at(a) == at(b)) {
                points.group(point, attributes);
            }
        }
        points
    }

    /// Takes vertices of one position, in ascending order.
    fn group(&mut self, vertices: &mut [u32], attributes: &[&Attribute]) {
        for &vertex in &*vertices {
            self.point_of[vertex as usize] = vertices[0];
        }
        vertices.sort_by(|&a, &b| order(attributes, a, b));
        for same in vertices.chunk_by(|&a, &b| order(attributes, a, b).is_eq()) {
            for &vertex in same {
                self.same_as[vertex as usize] = same[0];
            }
        }
    }
}

/// The bits of a number, −0 taken for 0.
fn bits(number: f32) -> u32 {
    (number + 0.0).to_bits()
}

/// Two vertices by all their attributes.
fn order(attributes: &[&Attribute], a: u32, b: u32) -> Ordering {
    attributes
        .iter()
        .map(|attribute| order_in(attribute, a, b))
        .find(|o| o.is_ne())
        .unwrap_or(Ordering::Equal)
}

fn order_in(attribute: &Attribute, a: u32, b: u32) -> Ordering {
    let components = attribute.info.components;
    let of = |vertex: u32| vertex as usize * components..(vertex as usize + 1) * components;
    let (a, b) = (of(a), of(b));
    match &attribute.values {
        Values::I8(values) => values[a].cmp(&values[b]),
        Values::U8(values) => values[a].cmp(&values[b]),
        Values::I16(values) => values[a].cmp(&values[b]),
        Values::U16(values) => values[a].cmp(&values[b]),
        Values::I32(values) => values[a].cmp(&values[b]),
        Values::U32(values) => values[a].cmp(&values[b]),
        Values::F32(values) => {
            let bits = |x: &f32| bits(*x);
            values[a].iter().map(bits).cmp(values[b].iter().map(bits))
        }
        Values::F64(values) => {
            let bits = |x: &f64| (x + 0.0).to_bits();
            values[a].iter().map(bits).cmp(values[b].iter().map(bits))
        }
    }
}
