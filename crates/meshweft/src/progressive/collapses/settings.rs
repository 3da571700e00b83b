//! What is asked for.

use super::attributes::AttributeWeights;
use crate::order::Effort;

/// How vertices are chosen to leave, and how far that goes.
///
/// ```
/// use meshweft::Mesh;
/// use meshweft::progressive::{Collapses, Walk};
/// // A flat square of 8 by 8 cells.
/// let positions: Vec<[f32; 3]> = (0..81).map(|i| [(i % 9) as f32, (i / 9) as f32, 0.0]).collect();
/// let cell = |i: u32| [[i, i + 1, i + 9], [i + 9, i + 1, i + 10]];
/// let faces: Vec<_> = (0..72).filter(|i| i % 9 != 8).flat_map(cell).collect();
/// let mesh = Mesh::new(positions, faces)?;
///
/// let progressive = Collapses::default().build(&mesh, &[])?;
/// let mut walk = Walk::new(&progressive);
/// walk.go_to(progressive.level_of_error(1e-6));
/// let mut faces = Vec::new();
/// walk.emit(&mut faces);
/// assert_eq!(faces.len(), 2); // Still the whole square.
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collapses {
    /// `Fast`, or how well: `Best` and `Max` remember where removed vertices were.
    pub effort: Effort,
    /// Whether the vertices at open edges stay, so that meshes that meet there keep meeting.
    pub lock_border: bool,
    /// Whether a part that cannot be simplified any more may leave as a whole, at its extent as error, and a hole that
    /// has three edges left may close, at the distance that its border moves. The last part never leaves.
    pub drop_parts: bool,
    /// Whether vertices at a seam may go to the other side of another seam where they have no partner, at a price
    /// that keeps such moves for last. It gets further; a face may then have corners of two parts of a texture.
    pub cross_seams: bool,
    /// It stops when at most so many faces are left.
    pub faces: usize,
    /// Removals of a larger error are not made, in units of the positions.
    pub error: f32,
    /// What differences in attributes count.
    pub weights: AttributeWeights,
}

impl Default for Collapses {
    /// As far as possible.
    fn default() -> Self {
        Self {
            effort: Effort::Fast,
            lock_border: false,
            drop_parts: false,
            cross_seams: false,
            faces: 0,
            error: f32::INFINITY,
            weights: AttributeWeights::default(),
        }
    }
}
