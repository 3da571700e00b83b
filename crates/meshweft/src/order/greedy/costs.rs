//! The cost metric in integers.

use crate::cache::MAX_CACHE_SIZE;

/// `C(v) = k1·C1 − k2·C2 + k3·C3` times a common denominator, without the term that all vertices
/// share.
///
/// With `C3 = (K − age) / K`, that term is `k3`: it drops out of comparisons.
///
/// Sums wrap around at extreme weights and valences. The order is then poor, but complete and the
/// same on every platform.
#[derive(Debug, Clone)]
pub(in crate::order) struct Costs {
    /// `k1`: added for each push.
    push: i64,
    /// `k2`: taken off for each face drawn.
    face: i64,
    /// `k3 / K`: taken off for each push since the vertex entered.
    age: i64,
    /// `k1 − k3 / K`: a push also makes the vertex older.
    aging_push: i64,
}

/// Weights are rounded to multiples of one over this. The common denominator is this times `K`.
const DENOMINATOR: f64 = 1000.0;

impl Costs {
    /// The metric for a cache of `size` vertices; weights are clamped to ±1024.
    pub(in crate::order) fn new(k1: f64, k2: f64, k3: f64, size: u32) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "clamped to 2^20 before")]
        let fixed = |k: f64| (k.clamp(-1024.0, 1024.0) * DENOMINATOR).round() as i64;
        let size = i64::from(size.min(MAX_CACHE_SIZE));
        let (push, age) = (fixed(k1) * size, fixed(k3));
        Self {
            push,
            face: fixed(k2) * size,
            age,
            aging_push: push - age,
        }
    }

    /// The cost estimated before drawing, if finishing the vertex takes `pushes`, none of them its
    /// own; `age` is counted before them.
    #[inline]
    pub(in crate::order) fn of(&self, pushes: u32, faces: u32, age: u32) -> i64 {
        Self::sum(self.aging_push, self.face, self.age, pushes, faces, age)
    }

    /// The cost measured after the vertex was finished; `age` is counted then.
    #[inline]
    pub(in crate::order) fn after_run(&self, pushes: u32, faces: u32, age: u32) -> i64 {
        Self::sum(self.push, self.face, self.age, pushes, faces, age)
    }

    /// `k1 · pushes − k2 · faces − k3 · age`.
    #[inline]
    fn sum(k1: i64, k2: i64, k3: i64, pushes: u32, faces: u32, age: u32) -> i64 {
        let pushes = k1.wrapping_mul(i64::from(pushes));
        let faces = k2.wrapping_mul(i64::from(faces));
        let age = k3.wrapping_mul(i64::from(age));
        pushes.wrapping_sub(faces).wrapping_sub(age)
    }
}
