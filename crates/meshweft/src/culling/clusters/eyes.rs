//! From where a mesh is looked at while its clusters are made.

use crate::culling::eye::Eye;
use crate::culling::planes::rounded;
use crate::geometry::Ball;

/// The eyes that clusters are made for: what is expected to be drawn is the mean over them. At most 512.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SampledEyes {
    /// Pairs of a distance, in radii of the bounding ball from its center, and a number of eyes there, in all directions; an
    /// infinite distance for orthographic views. More eyes at a distance weigh more.
    Around(Vec<(f64, usize)>),
    /// These, in the space of the mesh: positions of cameras, directions towards lights. One that comes more often weighs more.
    /// 64 eyes all around, at 4 radii, are added, so that faces that none of these sees are in clusters as well.
    These(Vec<Eye>),
}

impl Default for SampledEyes {
    /// 64 each at 2, 4 and 10 radii and orthographic.
    fn default() -> Self {
        Self::Around(
            [2.0, 4.0, 10.0, f64::INFINITY]
                .map(|far| (far, 64))
                .to_vec(),
        )
    }
}

/// The cosine and sine of the golden angle, of which multiples never come near each other.
const GOLDEN: (f64, f64) = (-0.737_368_878_078_32, 0.675_490_294_261_523_6);

impl SampledEyes {
    /// How many eyes there are at most, with those that are added.
    pub const MOST: usize = 512;

    /// How many may be given as [`These`](Self::These).
    pub const MOST_GIVEN: usize = Self::MOST - Self::ADDED;

    const ADDED: usize = 64;

    /// For views from near: 64 eyes each at 1.25, 1.5, 2 and 3 radii.
    #[must_use]
    pub fn near() -> Self {
        Self::Around([1.25, 1.5, 2.0, 3.0].map(|far| (far, 64)).to_vec())
    }

    /// For views from far: 64 eyes each at 4, 6, 10 and 20 radii.
    #[must_use]
    pub fn far() -> Self {
        Self::Around([4.0, 6.0, 10.0, 20.0].map(|far| (far, 64)).to_vec())
    }

    /// For orthographic views, such as those of directional lights: 256.
    #[must_use]
    pub fn orthographic() -> Self {
        Self::Around(vec![(f64::INFINITY, 256)])
    }

    /// How many eyes there are, with those that are added.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Around(spheres) => spheres
                .iter()
                .fold(0, |sum, &(_, count)| count.saturating_add(sum)),
            Self::These(eyes) => eyes.len().saturating_add(Self::ADDED),
        }
    }

    /// The eyes around a mesh with that bounding ball.
    ///
    /// # Panics
    /// If there are more than [`MOST`](Self::MOST).
    #[must_use]
    pub fn eyes(&self, ball: Ball) -> Vec<Eye> {
        let count = self.count();
        let most = Self::MOST;
        assert!(count <= most, "{count} eyes, at most {most} are sampled");
        match self {
            Self::These(eyes) => {
                let mut eyes = eyes.clone();
                eyes.extend(sphere(ball, 4.0, Self::ADDED, 0));
                eyes
            }
            Self::Around(spheres) => {
                let spheres = spheres.iter().enumerate();
                spheres
                    .flat_map(|(number, &(far, count))| sphere(ball, far, count, number))
                    .collect()
            }
        }
    }
}

/// Eyes on a spiral around a ball, evenly by area; each sphere is turned against the others.
fn sphere(ball: Ball, far: f64, count: usize, number: usize) -> Vec<Eye> {
    let (mut x, mut z) = (1.0_f64, 0.0_f64);
    let mut turn = || {
        let (cosine, sine) = GOLDEN;
        (x, z) = (x * cosine - z * sine, x * sine + z * cosine);
        (x, z)
    };
    for _ in 0..5 * number {
        turn();
    }
    let at = |step: usize| {
        let y = 1.0 - (2 * step + 1) as f64 / count as f64;
        let radius = ((1.0 - y) * (1.0 + y)).sqrt();
        let (x, z) = turn();
        let direction = [radius * x, y, radius * z];
        match far.is_finite() {
            true => {
                let point = [0, 1, 2].map(|i| ball.center[i] + far * ball.radius * direction[i]);
                Eye::at(point.map(rounded))
            }
            false => Eye::towards(direction.map(rounded)),
        }
    };
    (0..count).map(at).collect()
}
