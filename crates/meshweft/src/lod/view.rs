//! What a camera sees, and how exactly it has to be drawn.

use std::cmp::Ordering;
use std::fmt;

use super::cone::Cone;
use crate::geometry::double::{cross, dot, scaled, sub};

/// A perspective camera, in the space of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Where the eye is.
    pub eye: [f64; 3],
    /// What it looks at: another place than the eye.
    pub target: [f64; 3],
    /// What is up; not along the line of sight.
    pub up: [f64; 3],
    /// From the bottom of the picture to its top, in degrees, above 0 and below 180.
    pub field_of_view: f64,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
}

/// What of a mesh has to be drawn exactly: made of a [`Camera`], or of a length alone, for
/// [`Front::update`](super::fast_mesh::Front::update).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraView {
    eye: [f64; 3],
    /// The normals of the picture's four sides, towards its inside.
    sides: Option<[[f64; 3]; 4]>,
    /// How far the eye has to be from an error of length 1 that may just be seen.
    reach: f64,
    sees_back_faces: bool,
    /// Without an eye: errors up to this length may stay, wherever they are.
    everywhere: Option<f64>,
}

/// Why a camera cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ViewError {
    /// A number of the camera is not finite.
    NotFinite,
    /// The target is at the eye, or `up` is along the line of sight.
    NoDirection,
    /// The field of view, the size or the tolerance is out of its range.
    OutOfRange,
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "a number of the camera is not finite: give finite numbers",
            Self::NoDirection => {
                "the camera has no direction: give a target other than the eye, and an up vector that is not along the line of sight"
            }
            Self::OutOfRange => {
                "a number of the camera is out of its range: give a field of view above 0 and below 180 degrees, a picture of at least 1 by 1 pixel, and a tolerance above 0"
            }
        })
    }
}

impl std::error::Error for ViewError {}

/// A place where the mesh may be coarser: all that there is of it is in a ball, its normals in a cone.
#[derive(Debug, Clone, Copy)]
pub(super) struct DetailBound {
    pub(super) center: [f32; 3],
    pub(super) radius: f32,
    /// How far the coarse surface is from the input's vertices.
    pub(super) error: f32,
    pub(super) cone: Cone,
}

impl DetailBound {
    /// A ball seen from all sides.
    pub(super) fn of_ball(center: [f32; 3], radius: f32, error: f32) -> Self {
        Self {
            center,
            radius,
            error,
            cone: Cone::ALL,
        }
    }

    /// Whether another one is the same, bit for bit: numbers that are not finite are the same as themselves.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let bits = |it: &Self| {
            let Self {
                center: [x, y, z],
                radius,
                error,
                cone,
            } = *it;
            let [u, v, w] = cone.axis;
            [x, y, z, radius, error, u, v, w, cone.cosine, cone.sine].map(f32::to_bits)
        };
        bits(self) == bits(other)
    }
}

impl Camera {
    /// What it sees, if an error of `tolerance` pixels may be seen. Places outside of the picture and those seen from their
    /// back may be as coarse as they can.
    ///
    /// # Errors
    /// [`ViewError`] if the camera has no picture.
    pub fn view(&self, tolerance: f64) -> Result<CameraView, ViewError> {
        let numbers = self.eye.iter().chain(&self.target).chain(&self.up);
        let numbers = numbers.chain([&self.field_of_view, &tolerance]);
        if !numbers.clone().all(|x| x.is_finite()) {
            return Err(ViewError::NotFinite);
        }
        let is_angle = self.field_of_view > 0.0 && self.field_of_view < 180.0;
        if !is_angle || self.size.contains(&0) || tolerance <= 0.0 {
            return Err(ViewError::OutOfRange);
        }

        // The camera's axes.
        let ahead = unit(sub(self.target, self.eye)).ok_or(ViewError::NoDirection)?;
        let right = unit(cross(ahead, unit(self.up).ok_or(ViewError::NoDirection)?));
        let right = right.ok_or(ViewError::NoDirection)?;
        let up = cross(right, ahead);

        // The sides of the picture go through the eye.
        let [width, height] = self.size.map(f64::from);
        let half_height = (0.5 * self.field_of_view.to_radians()).tan();
        let half_width = half_height * width / height;
        let side = |axis: [f64; 3], half: f64| {
            let inside = [0, 1, 2].map(|i| half * ahead[i] + axis[i]);
            unit(inside).ok_or(ViewError::OutOfRange)
        };
        let sides = [
            side(right, half_width)?,
            side(scaled(right, -1.0), half_width)?,
            side(up, half_height)?,
            side(scaled(up, -1.0), half_height)?,
        ];
        let reach = 0.5 * height / half_height / tolerance;
        Ok(CameraView {
            eye: self.eye,
            sides: Some(sides),
            reach,
            sees_back_faces: false,
            everywhere: None,
        })
    }
}

fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    // Relative to the largest, so that no square overflows or vanishes.
    let largest = a.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let small = scaled(a, 1.0 / largest);
    let length = dot(small, small).sqrt();
    let is_sound = largest > 0.0 && length.is_finite() && length > 1e-12;
    is_sound.then(|| scaled(small, 1.0 / length))
}

impl CameraView {
    /// A view without an eye: whatever has an error above a length, in units of the positions, has to be finer, wherever it
    /// is. Below 0 that is everything.
    ///
    /// ```
    /// use meshweft::Mesh;
    /// use meshweft::lod::CameraView;
    /// use meshweft::lod::fast_mesh::{FastMesh, Front};
    /// // Waves over a square of 8 by 8 cells.
    /// let place = |i: u16| [i % 9, i / 9].map(f32::from);
    /// let positions = (0..81).map(place).map(|[x, y]| [x, y, x.sin() * y.cos()]);
    /// let cell = |i: u32| [[i, i + 1, i + 9], [i + 9, i + 1, i + 10]];
    /// let faces = (0..72).filter(|i| i % 9 != 8).flat_map(cell);
    /// let mesh = Mesh::new(positions.collect::<Vec<_>>(), faces.collect::<Vec<_>>())?;
    ///
    /// let mut front = Front::new(FastMesh::default().build(&mesh, &[])?);
    /// front.update(&CameraView::of_errors_above(0.5)?, 1.0);
    /// assert!(front.face_count() < 128 && front.largest_error_left() <= 0.5);
    /// front.update(&CameraView::of_errors_above(-1.0)?, 1.0);
    /// assert_eq!(front.face_count(), 128);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ViewError::NotFinite`] if the length is not finite.
    pub fn of_errors_above(length: f64) -> Result<Self, ViewError> {
        match length.is_finite() {
            true => Ok(Self {
                eye: [0.0; 3],
                sides: None,
                reach: f64::INFINITY,
                sees_back_faces: true,
                everywhere: Some(length),
            }),
            false => Err(ViewError::NotFinite),
        }
    }

    /// The same, but all around the eye: what is outside of the picture is drawn as exactly as what is inside.
    #[must_use]
    pub fn all_around(self) -> Self {
        Self {
            sides: None,
            ..self
        }
    }

    /// The same, but faces seen from their back are drawn as exactly as others: for surfaces with two sides.
    #[must_use]
    pub fn with_back_faces(self) -> Self {
        Self {
            sees_back_faces: true,
            ..self
        }
    }

    /// The same for another tolerance, in parts of this one.
    pub(super) fn with_tolerance(self, factor: f64) -> Self {
        Self {
            reach: self.reach / factor,
            everywhere: self.everywhere.map(|length| length * factor),
            ..self
        }
    }

    /// Whether a place has to be finer: it can be seen, and so can its error.
    ///
    /// If this holds for a place, it holds for every place whose ball, cone and error contain its own.
    #[inline]
    pub(super) fn needs(&self, bound: &DetailBound) -> bool {
        let error = f64::from(bound.error);
        if let Some(length) = self.everywhere {
            return error > length;
        }
        let radius = f64::from(bound.radius);
        let way = sub(bound.center.map(f64::from), self.eye);
        let square = dot(way, way);
        let seen_within = error * self.reach + radius;
        // A place that is not a number is nowhere.
        let is_near = square < seen_within * seen_within;
        if error == 0.0 || !is_near {
            return false;
        }
        let is_outside = |side: &[f64; 3]| dot(*side, way) < -radius;
        if self.sides.iter().flatten().any(is_outside) {
            return false;
        }
        self.sees_back_faces || !bound.cone.is_turned_away(way, square, radius)
    }

    /// How large the error of a place is seen.
    pub(super) fn urgency(&self, bound: &DetailBound) -> Urgency {
        let hidden = Urgency {
            excess: 0.0,
            error: bound.error,
        };
        if let Some(length) = self.everywhere {
            let error = f64::from(bound.error);
            let excess = match length > 0.0 {
                true => error / length,
                false if error > length => f64::INFINITY,
                false => 0.0,
            };
            return Urgency { excess, ..hidden };
        }
        let anyhow = Self {
            reach: f64::INFINITY,
            ..*self
        };
        match anyhow.needs(bound) {
            true => self.urgency_of_needed(bound),
            false => hidden,
        }
    }

    /// How large the error of a place is seen, if that has to be finer.
    pub(super) fn needed_urgency(&self, bound: &DetailBound) -> Option<Urgency> {
        self.needs(bound).then(|| match self.everywhere {
            Some(_) => self.urgency(bound),
            None => self.urgency_of_needed(bound),
        })
    }

    /// How large the error of a place is seen that is in the picture.
    fn urgency_of_needed(&self, bound: &DetailBound) -> Urgency {
        let way = sub(bound.center.map(f64::from), self.eye);
        let distance = dot(way, way).sqrt() - f64::from(bound.radius);
        let excess = match distance > 0.0 {
            true => f64::from(bound.error) * self.reach / distance,
            false => f64::INFINITY,
        };
        Urgency {
            excess,
            error: bound.error,
        }
    }
}

/// How large an error is seen: what a place makes more urgent to be finer than another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Urgency {
    /// In tolerances; infinite where the eye is inside.
    excess: f64,
    /// As a length, which decides between places of equal excess.
    error: f32,
}

impl Urgency {
    /// In tolerances.
    #[cfg(test)]
    pub(super) fn excess(self) -> f64 {
        self.excess
    }

    /// Whether it is more than a number of tolerances.
    pub(super) fn is_above(self, tolerances: f64) -> bool {
        self.excess > tolerances
    }

    /// Whether it is less than a part of another one.
    pub(super) fn is_below(self, other: Self, part: f64) -> bool {
        self.excess < part * other.excess
    }

    /// Its place among quarters of octaves of the excess, and of the error where the excess is infinite.
    pub(super) fn step(self) -> u32 {
        match self.excess.is_finite() {
            true => (self.excess.to_bits() >> 50) as u32,
            false => (1 << 16) + (self.error.to_bits() >> 21),
        }
    }

    pub(super) fn order(self, other: Self) -> Ordering {
        let by_excess = self.excess.total_cmp(&other.excess);
        by_excess.then(self.error.total_cmp(&other.error))
    }
}
