//! Cones around the normals of faces, in four bytes.

use crate::geometry::double::{add, cross, dot, sub};

/// The directions at most an angle from an axis; in 32 bits, rounded to a larger cone.
///
/// Two numbers of 11 bits are the axis, folded on a square (Z. Cigolle and others: *A Survey of Efficient Representations for
/// Independent Unit Vectors*, 2014), and 10 bits are the sine of the angle. Only square roots are taken, so the bits are the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PackedCone(u32);

/// A cone with its numbers at hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cone {
    /// Of length 1, but for rounding.
    pub(super) axis: [f32; 3],
    pub(super) cosine: f32,
    /// Above 1 if all directions are in the cone.
    pub(super) sine: f32,
}

const AXIS_BITS: u32 = 11;
const AXIS_STEPS: f64 = ((1 << AXIS_BITS) - 2) as f64 / 2.0;
const ALL: u32 = 1023;

/// What is added to a sine, for the rounding of the test at run time.
const ROOM: f64 = 1e-5;

impl PackedCone {
    /// All directions.
    pub(super) const ALL: Self = Self(ALL);

    /// The cone around an axis, of any length, that has some directions of length 1 and some cones in it.
    pub(super) fn around(
        axis: [f64; 3],
        normals: impl Iterator<Item = [f64; 3]>,
        cones: impl Iterator<Item = Self>,
    ) -> Self {
        let axis_bits = folded(axis);
        let axis = unfolded(axis_bits);

        // The largest angle so far, by its cosine and sine.
        let mut widest = [1.0_f64, 0.0];
        for normal in normals {
            let cosine = dot(axis, normal);
            if cosine < widest[0] {
                widest = [cosine, (1.0 - cosine * cosine).max(0.0).sqrt()];
            }
        }
        for cone in cones {
            let Some((inner, [cosine, sine])) = cone.parts() else {
                return Self::ALL;
            };
            // The angle to its axis and its own one together.
            let between = dot(axis, inner);
            let across = (1.0 - between * between).max(0.0).sqrt();
            let sum = between * cosine - across * sine;
            // A sum beyond a half turn comes round again: the first angle alone is not below a quarter then.
            if between <= 0.0 {
                return Self::ALL;
            }
            if sum < widest[0] {
                widest = [sum, across * cosine + between * sine];
            }
        }
        Self::packed(axis_bits, widest)
    }

    /// Around each of some points the cone that has the normals of all faces there; a face is its three points and where these are.
    pub(super) fn around_points(
        count: usize,
        faces: impl Iterator<Item = ([u32; 3], [[f64; 3]; 3])> + Clone,
    ) -> Vec<Self> {
        // Large faces decide where an axis is.
        let mut axes = vec![[0.0; 3]; count];
        for (points, [a, b, c]) in faces.clone() {
            let normal = cross(sub(b, a), sub(c, a));
            for point in points {
                axes[point as usize] = add(axes[point as usize], normal);
            }
        }
        let axes: Vec<u32> = axes.into_iter().map(folded).collect();

        let mut cosines = vec![1.0_f64; count];
        for (points, [a, b, c]) in faces {
            let normal = cross(sub(b, a), sub(c, a));
            let length = dot(normal, normal).sqrt();
            if length > 0.0 {
                for point in points {
                    let cosine = dot(unfolded(axes[point as usize]), normal) / length;
                    let least = &mut cosines[point as usize];
                    *least = least.min(cosine);
                }
            }
        }
        let cone = |(axis, cosine): (u32, f64)| {
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            Self::packed(axis, [cosine, sine])
        };
        axes.into_iter().zip(cosines).map(cone).collect()
    }

    /// This cone, wider if others are not in it.
    pub(super) fn with(self, others: impl Iterator<Item = Self> + Clone) -> Self {
        match self.parts() {
            Some((axis, _)) if !others.clone().all(|it| self.contains(it)) => {
                Self::around(axis, std::iter::empty(), others.chain([self]))
            }
            _ => self,
        }
    }

    /// The cone around an axis with an angle of this cosine and sine.
    fn packed(axis_bits: u32, [cosine, sine]: [f64; 2]) -> Self {
        if cosine <= 0.0 {
            return Self::ALL;
        }
        let axis = unfolded(axis_bits);
        let sine = ((sine + ROOM) * f64::from(ALL)).ceil();
        let is_known = sine < f64::from(ALL) && axis.iter().all(|x| x.is_finite());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number from 0 to 1022"
        )]
        match is_known {
            true => Self(axis_bits << 10 | sine as u32),
            false => Self::ALL,
        }
    }

    /// The axis, and cosine and sine of the angle; `None` for all directions.
    fn parts(self) -> Option<([f64; 3], [f64; 2])> {
        let sine = self.0 & 1023;
        if sine == ALL {
            return None;
        }
        let sine = f64::from(sine) / f64::from(ALL);
        Some((unfolded(self.0 >> 10), [(1.0 - sine * sine).sqrt(), sine]))
    }

    /// Whether another cone is in this one.
    pub(super) fn contains(self, other: Self) -> bool {
        let Some((axis, [cosine, _])) = self.parts() else {
            return true;
        };
        other
            .parts()
            .is_some_and(|(inner, [inner_cosine, inner_sine])| {
                let between = dot(axis, inner);
                let across = (1.0 - between * between).max(0.0).sqrt();
                between * inner_cosine - across * inner_sine >= cosine - 1e-9
            })
    }

    /// The cone's numbers, for many tests.
    pub(super) fn unpacked(self) -> Cone {
        #[expect(clippy::cast_possible_truncation, reason = "the room is larger")]
        self.parts()
            .map_or(Cone::ALL, |(axis, [cosine, sine])| Cone {
                axis: axis.map(|x| x as f32),
                cosine: cosine as f32,
                sine: sine as f32,
            })
    }

    pub(super) fn to_bits(self) -> u32 {
        self.0
    }

    /// Any bits are a cone.
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }
}

impl Cone {
    /// All directions.
    pub(super) const ALL: Self = Self {
        axis: [0.0; 3],
        cosine: 0.0,
        sine: 2.0,
    };

    /// Whether no face with its normal in the cone and a corner within `radius` of a point can be seen as a front face from
    /// an eye; `way` goes from the eye to the point.
    #[inline]
    pub(super) fn is_turned_away(&self, way: [f64; 3], square: f64, radius: f64) -> bool {
        let along = dot(way, self.axis.map(f64::from));
        if along <= 0.0 || self.sine > 1.0 {
            return false;
        }
        let across = (square - along * along).max(0.0).sqrt();
        along * f64::from(self.cosine) - across * f64::from(self.sine) > radius
    }
}

/// An axis on the square, 11 bits each way.
fn folded(axis: [f64; 3]) -> u32 {
    let sum: f64 = axis.iter().map(|x| x.abs()).sum();
    let [x, y, z] = match sum > 0.0 && sum.is_finite() {
        true => axis.map(|x| x / sum),
        false => [0.0, 0.0, 1.0],
    };
    let turned = |a: f64, b: f64| (1.0 - b.abs()) * if a < 0.0 { -1.0 } else { 1.0 };
    let [u, v] = if z < 0.0 {
        [turned(x, y), turned(y, x)]
    } else {
        [x, y]
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number from 0 to 2046"
    )]
    let [u, v] = [u, v].map(|x| ((x + 1.0) * AXIS_STEPS).round() as u32);
    u << AXIS_BITS | v
}

/// The axis of length 1.
fn unfolded(bits: u32) -> [f64; 3] {
    let mask = (1 << AXIS_BITS) - 1;
    let [u, v] = [bits >> AXIS_BITS & mask, bits & mask].map(|x| f64::from(x) / AXIS_STEPS - 1.0);
    let z = 1.0 - u.abs() - v.abs();
    let turned = |a: f64, b: f64| (1.0 - b.abs()) * if a < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = if z < 0.0 {
        [turned(u, v), turned(v, u)]
    } else {
        [u, v]
    };
    let length = dot([x, y, z], [x, y, z]).sqrt();
    [x / length, y / length, z / length]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::double::scaled;
    use crate::random::SplitMix64;

    fn unit(random: &mut SplitMix64) -> [f64; 3] {
        loop {
            let at = [(); 3].map(|()| random.below(2001) as f64 / 1000.0 - 1.0);
            let square = dot(at, at);
            if square > 0.01 && square <= 1.0 {
                return scaled(at, 1.0 / square.sqrt());
            }
        }
    }

    #[test]
    fn a_cone_has_its_normals_and_cones_in_it() {
        let mut random = SplitMix64(3);
        let mut known = 0;
        for _ in 0..3000 {
            let axis = unit(&mut random);
            let spread = random.below(100) as f64 / 100.0;
            let near = |random: &mut SplitMix64| {
                let at = add(axis, scaled(unit(random), spread));
                scaled(at, 1.0 / dot(at, at).sqrt())
            };
            let normals: Vec<_> = (0..5).map(|_| near(&mut random)).collect();
            let inner = PackedCone::around(axis, normals.iter().copied(), [].into_iter());
            let outer_axis = near(&mut random);
            let outer = PackedCone::around(outer_axis, [].into_iter(), [inner].into_iter());

            for cone in [inner, outer] {
                let Some((axis, [cosine, _])) = cone.parts() else {
                    continue;
                };
                known += 1;
                assert!(
                    normals
                        .iter()
                        .all(|&normal| dot(normal, axis) >= cosine - 1e-12)
                );
            }
        }
        assert!(known > 2000, "{known}");
    }

    #[test]
    fn what_is_turned_away_is_no_front_face() {
        let mut random = SplitMix64(4);
        let mut turned = 0;
        for _ in 0..3000 {
            let normals = [(); 3].map(|()| unit(&mut random));
            let axis = add(normals[0], scaled(add(normals[1], normals[2]), 0.1));
            let one = normals[0];
            let cone = PackedCone::around(axis, [one].into_iter(), [].into_iter()).unpacked();
            let way = scaled(unit(&mut random), 3.0);
            let radius = random.below(100) as f64 / 50.0;
            if cone.is_turned_away(way, dot(way, way), radius) {
                turned += 1;
                // The corner within the radius that is turned towards the eye most.
                let corner = sub(way, scaled(one, radius));
                assert!(dot(one, corner) > 0.0);
            }
        }
        assert!(turned > 300, "{turned}");
    }
}
