//! Random numbers that are the same on every platform.

use crate::index::index32;

/// G. Steele, D. Lea, C. Flood: *Fast Splittable Pseudorandom Number Generators*, 2014,
/// doi:10.1145/2714064.2660195. Any number is a good start.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SplitMix64(pub(crate) u64);

impl SplitMix64 {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `limit`; 0 if that is 0.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        // The high half of the product: uniform but for one part in 2^32.
        let high = (u128::from(self.next()) * limit as u128) >> 64;
        usize::try_from(high).unwrap_or(0)
    }
}

/// The numbers below `len` in a random order (R. Fisher, F. Yates).
pub(crate) fn shuffled(len: usize, seed: u64) -> Vec<u32> {
    let mut random = SplitMix64(seed);
    let mut order: Vec<u32> = (0..index32(len)).collect();
    for last in (1..len).rev() {
        order.swap(last, random.below(last + 1));
    }
    order
}

/// A number that a long run of a test by hand gives: `MESHWEFT_CASES` meshes from `MESHWEFT_SEED`.
#[cfg(test)]
pub(crate) fn from_environment(name: &str, usual: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("{name} is {text:?}: give a whole number")),
        Err(_) => usual,
    }
}
