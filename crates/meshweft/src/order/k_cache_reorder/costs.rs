//! The cost metric in integers.

use crate::cache::MAX_CACHE_SIZE;

/// `C(v) = k1·C1 − k2·C2 + k3·C3` times a common denominator.
///
/// Sums wrap around where absurd weights meet absurd valences: such an order is poor, but it is
/// an order, and the same on every platform.
#[derive(Debug, Clone)]
pub(super) struct Costs {
    push: i64,
    face: i64,
    /// Cost of a remaining place in the cache: `k3 / K`.
    place: i64,
    size: i64,
}

/// Weights are rounded to multiples of one over this.
const DENOMINATOR: f64 = 1000.0;

impl Costs {
    pub(super) fn new(k1: f64, k2: f64, k3: f64, size: u32) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "clamped to 2^20 before")]
        let fixed = |k: f64| (k.clamp(-1024.0, 1024.0) * DENOMINATOR).round() as i64;
        let size = i64::from(size.min(MAX_CACHE_SIZE));
        Self {
            push: fixed(k1) * size,
            face: fixed(k2) * size,
            place: fixed(k3),
            size,
        }
    }

    /// The cost if `pushes` are needed, from the state before them.
    #[inline]
    pub(super) fn of(&self, pushes: u32, faces: u32, age: u32) -> i64 {
        self.after_run(pushes, faces, age.wrapping_add(pushes))
    }

    /// The cost from the state after the vertex was finished.
    #[inline]
    pub(super) fn after_run(&self, pushes: u32, faces: u32, age: u32) -> i64 {
        let pushes = self.push.wrapping_mul(i64::from(pushes));
        let faces = self.face.wrapping_mul(i64::from(faces));
        let place = self.place.wrapping_mul(self.size - i64::from(age));
        pushes.wrapping_sub(faces).wrapping_add(place)
    }
}
