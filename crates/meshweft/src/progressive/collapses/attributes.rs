//! How far the attributes of the vertices are changed.

use super::fan::Fan;
use super::remaining::RemainingMesh;
use crate::attribute::{Attribute, ComponentType, Semantic};
use crate::geometry::double::{cross, dot, sub};
use crate::geometry::triangle::way_to_triangle;
use crate::progressive::records::SidePair;

/// What a difference in an attribute weighs: as a distance of so many hundredths of the diagonal of the
/// bounding box for a difference of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttributeWeights {
    /// Normals.
    pub normal: f32,
    /// Texture coordinates, of every set.
    pub tex_coord: f32,
    /// Colours, of every set.
    pub color: f32,
}

impl Default for AttributeWeights {
    fn default() -> Self {
        Self {
            normal: 0.5,
            tex_coord: 1.0,
            color: 0.5,
        }
    }
}

impl AttributeWeights {
    fn of(self, attribute: &Attribute) -> f32 {
        match attribute.info.semantic {
            _ if attribute.info.morph_target.is_some() => 0.0,
            Semantic::Normal => self.normal,
            Semantic::TexCoord(_) => self.tex_coord,
            Semantic::Color(_) => self.color,
            _ => 0.0,
        }
    }
}

/// Whether an attribute says where a vertex is in a pose.
pub(super) fn moves_a_vertex(attribute: &Attribute) -> bool {
    let info = &attribute.info;
    match info.semantic {
        Semantic::Position => info.morph_target.is_some(),
        Semantic::Joints(_) | Semantic::Weights(_) => true,
        _ => false,
    }
}

/// Whether an attribute has numbers that stand for something, such as a part: one between two others is none.
pub(super) fn is_a_name(attribute: &Attribute) -> bool {
    let info = &attribute.info;
    let is_integer = !matches!(info.component_type, ComponentType::F32 | ComponentType::F64);
    is_integer && !info.is_normalized && matches!(info.semantic, Semantic::Other(_))
}

/// All weighed attributes of each vertex, as lengths.
#[derive(Debug)]
pub(super) struct Lengths {
    components: usize,
    of: Vec<f32>,
}

impl Lengths {
    /// `None` where no attribute counts.
    pub(super) fn new(
        attributes: &[&Attribute],
        weights: AttributeWeights,
        vertices: usize,
        diagonal: f64,
    ) -> Option<Self> {
        let weighed = attributes
            .iter()
            .map(|&attribute| (attribute, weights.of(attribute)));
        let weighed: Vec<_> = weighed.filter(|&(_, weight)| weight > 0.0).collect();
        let components: usize = weighed
            .iter()
            .map(|(attribute, _)| attribute.info.components)
            .sum();
        if components == 0 {
            return None;
        }
        let mut of = vec![0.0; vertices * components];
        let mut at = 0;
        for (attribute, weight) in weighed {
            let own = attribute.info.components;
            #[expect(clippy::cast_possible_truncation, reason = "an estimate")]
            let scale = (f64::from(weight) * 0.01 * diagonal) as f32;
            let elements = attribute.to_f32();
            for (to, from) in of
                .chunks_exact_mut(components)
                .zip(elements.chunks_exact(own))
            {
                for (to, from) in to[at..at + own].iter_mut().zip(from) {
                    *to = from * scale;
                }
            }
            at += own;
        }
        Some(Self { components, of })
    }

    fn at(&self, vertex: u32) -> &[f32] {
        &self.of[vertex as usize * self.components..][..self.components]
    }

    /// How much two vertices differ.
    pub(super) fn between(&self, a: u32, b: u32) -> f64 {
        let both = self.at(a).iter().zip(self.at(b));
        let squares = both.map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// The greatest difference between an attribute of the point and what is at its place once it moved to
    /// a neighbour, over its vertices; `pairs` has where they go.
    pub(super) fn difference(
        &self,
        rest: &RemainingMesh<'_>,
        fan: &Fan,
        to: u32,
        step: [f64; 3],
        pairs: &[SidePair],
    ) -> f64 {
        let greatest = pairs.iter().map(|pair| {
            // The face of this vertex that is nearest to the point, of those that stay.
            let mut nearest = (f64::INFINITY, [0.0; 3], None);
            for (face, &[a, b]) in fan.staying(to) {
                if rest.side(face.corner) != pair.from {
                    continue;
                }
                let triangle = [step, a, b];
                let way = way_to_triangle([0.0; 3], triangle);
                if dot(way, way) < nearest.0 {
                    let [next, last] = face.others().map(|corner| rest.side(corner));
                    nearest = (
                        dot(way, way),
                        shares(way, triangle),
                        Some([pair.to, next, last]),
                    );
                }
            }
            let Some(corners) = nearest.2 else {
                return 0.0;
            };

            // The attributes there.
            let own = self.at(pair.from);
            let corners = corners.map(|vertex| self.at(vertex));
            let squares = own.iter().enumerate().map(|(i, &own)| {
                let there: f64 = corners
                    .iter()
                    .zip(nearest.1)
                    .map(|(of, share)| f64::from(of[i]) * share)
                    .sum();
                (there - f64::from(own)).powi(2)
            });
            squares.sum::<f64>().sqrt()
        });
        greatest.filter(|it| it.is_finite()).fold(0.0, f64::max)
    }
}

/// What each corner of a triangle counts at a point on it.
fn shares(point: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let normal = cross(sub(b, a), sub(c, a));
    let square = dot(normal, normal);
    if square <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let of = |from: [f64; 3], to: [f64; 3]| {
        dot(cross(sub(from, point), sub(to, point)), normal) / square
    };
    [of(b, c), of(c, a), of(a, b)]
}
