//! Numbers for what a walk needs of a terrain, which has too much for a table of all.

use crate::index::index32;

/// Numbers from 0 in the order in which keys come, each key with one of them.
///
/// Space: 4 bytes a key and at most 16 a key for a table of open addresses.
#[derive(Debug, Clone, Default)]
pub(super) struct DistinctNumbers {
    /// Numbers plus one; 0 is free. A power of two, at most half full.
    table: Vec<u32>,
    keys: Vec<u32>,
}

impl DistinctNumbers {
    /// The number of a key, and whether it came just now.
    pub(super) fn number(&mut self, key: u32) -> (u32, bool) {
        if 2 * (self.keys.len() + 1) > self.table.len() {
            self.widen();
        }
        let place = self.place(key);
        match self.table[place].checked_sub(1) {
            Some(number) => (number, false),
            None => {
                let number = index32(self.keys.len());
                self.keys.push(key);
                self.table[place] = number + 1;
                (number, true)
            }
        }
    }

    pub(super) fn len(&self) -> usize {
        self.keys.len()
    }

    /// Where a key is in the table, or would be.
    fn place(&self, key: u32) -> usize {
        let last = self.table.len() - 1;
        // The upper bits of a product with the golden ratio are spread well.
        let spread = u64::from(key).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        let mut place = spread as usize & last;
        while let Some(number) = self.table[place].checked_sub(1)
            && self.keys[number as usize] != key
        {
            place = (place + 1) & last;
        }
        place
    }

    fn widen(&mut self) {
        self.table = vec![0; (2 * self.table.len()).max(64)];
        for number in 0..self.keys.len() {
            let place = self.place(self.keys[number]);
            self.table[place] = index32(number) + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn each_key_has_one_number() {
        let mut random = SplitMix64(3);
        let mut numbers = DistinctNumbers::default();
        let mut expected = HashMap::new();
        for i in 0..20_000 {
            let key = match i % 3 {
                0 => u32::MAX - index32(random.below(5000)),
                1 => index32(random.below(3000)) << 16,
                _ => index32(random.below(7000)),
            };
            let next = index32(expected.len());
            let is_new = !expected.contains_key(&key);
            let number = *expected.entry(key).or_insert(next);
            assert_eq!(numbers.number(key), (number, is_new));
        }
        assert_eq!(numbers.len(), expected.len());
    }
}
