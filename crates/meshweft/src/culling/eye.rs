//! From where a mesh is seen.

use crate::geometry::double::{scaled, sub};

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

    /// Whether it is somewhere, or a direction; otherwise everything is drawn for it.
    #[must_use]
    pub fn says_something(self) -> bool {
        let is_nowhere = |([x, y, z], w): ([f64; 3], f64)| w == 0.0 && [x, y, z] == [0.0; 3];
        self.parts().is_some_and(|parts| !is_nowhere(parts))
    }

    /// The first three coordinates, and the fourth; `None` if they say nothing.
    pub(super) fn parts(self) -> Option<([f64; 3], f64)> {
        let [x, y, z, w] = self.point.map(f64::from);
        let is_sound = [x, y, z, w].iter().all(|part| part.is_finite()) && w >= 0.0;
        is_sound.then_some(([x, y, z], w))
    }

    /// The coordinates with another origin; `None` if they say nothing.
    pub(super) fn around(self, origin: [f64; 3]) -> Option<[f64; 4]> {
        let (point, w) = self.parts()?;
        let [x, y, z] = sub(point, scaled(origin, w));
        Some([x, y, z, w])
    }
}

/// All eyes in a box, in the space of the mesh: those of some frames, of both eyes of a viewer, of a light that moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EyeBox {
    /// The least of each coordinate.
    pub low: [f32; 3],
    /// The greatest of each coordinate.
    pub high: [f32; 3],
    /// 1 for positions, 0 for directions *towards* the viewer, as in [`Eye::point`].
    pub w: f32,
}

impl EyeBox {
    /// All positions in a box.
    #[must_use]
    pub fn at(low: [f32; 3], high: [f32; 3]) -> Self {
        Self { low, high, w: 1.0 }
    }

    /// All orthographic views whose direction towards the viewer is in a box.
    #[must_use]
    pub fn towards(low: [f32; 3], high: [f32; 3]) -> Self {
        Self { low, high, w: 0.0 }
    }

    /// The eye in the middle, with another origin, and half of the box, rounded up; `None` if they say nothing.
    pub(super) fn middle(self, origin: [f64; 3]) -> Option<([f64; 4], [f64; 3])> {
        let corner = |[x, y, z]: [f32; 3]| {
            Eye {
                point: [x, y, z, self.w],
            }
            .around(origin)
        };
        let (low, high) = (corner(self.low)?, corner(self.high)?);
        let middle = [0, 1, 2, 3].map(|i| 0.5 * (low[i] + high[i]));
        let half = [0, 1, 2].map(|i| 0.5 * (high[i] - low[i]) * (1.0 + f64::from(f32::EPSILON)));
        let is_box = half.iter().all(|&x| x >= 0.0);
        is_box.then_some((middle, half))
    }
}
