//! From where a mesh is seen.

/// From where a mesh is seen, in the space of the mesh: a position, or a direction for an orthographic view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// With 1 as the fourth coordinate, the position of the eye; with 0, the direction *towards* the viewer, of any length.
    /// Any other above 0 divides the first three. For one below 0, or no number, everything is drawn.
    pub point: [f32; 4],
}

impl Eye {
    /// An eye at a position.
    #[must_use]
    pub fn at([x, y, z]: [f32; 3]) -> Self {
        Self {
            point: [x, y, z, 1.0],
        }
    }

    /// An eye so far in a direction that all lines of sight are parallel.
    #[must_use]
    pub fn towards([x, y, z]: [f32; 3]) -> Self {
        Self {
            point: [x, y, z, 0.0],
        }
    }

    /// The first three coordinates, and the fourth; `None` if they say nothing.
    pub(super) fn parts(self) -> Option<([f64; 3], f64)> {
        let [x, y, z, w] = self.point.map(f64::from);
        let is_sound = [x, y, z, w].iter().all(|part| part.is_finite()) && w >= 0.0;
        is_sound.then_some(([x, y, z], w))
    }
}
