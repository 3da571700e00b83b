//! Sets of the last pushes, one bit each: a `u64` or a `u128` for at most 64 or 128 of them.

/// A set of numbers of which any two differ by less than [`SPAN`](Self::SPAN): each is stored as its
/// remainder.
pub(super) trait Mask: Copy + Default + Eq {
    /// How many consecutive numbers it tells apart.
    const SPAN: u32;
    fn contains(self, number: u32) -> bool;
    fn set_if(&mut self, condition: bool, number: u32);
    fn clear_if(&mut self, condition: bool, number: u32);
    /// The set of the distances of its numbers from `start`, which none of them is before.
    fn rotated(self, start: u32) -> Self;
    fn count(self) -> u32;
    /// Removes the least number and returns it.
    fn take_lowest(&mut self) -> u32;
}

macro_rules! mask {
    ($int:ty) => {
        impl Mask for $int {
            const SPAN: u32 = <$int>::BITS;
            #[inline]
            fn contains(self, number: u32) -> bool {
                self >> (number % Self::SPAN) & 1 != 0
            }
            #[inline]
            fn set_if(&mut self, condition: bool, number: u32) {
                *self |= Self::from(condition) << (number % Self::SPAN);
            }
            #[inline]
            fn clear_if(&mut self, condition: bool, number: u32) {
                *self &= !(Self::from(condition) << (number % Self::SPAN));
            }
            #[inline]
            fn rotated(self, start: u32) -> Self {
                self.rotate_right(start % Self::SPAN)
            }
            #[inline]
            fn count(self) -> u32 {
                self.count_ones()
            }
            #[inline]
            fn take_lowest(&mut self) -> u32 {
                let lowest = self.trailing_zeros();
                *self &= self.wrapping_sub(1);
                lowest
            }
        }
    };
}

mask!(u64);
mask!(u128);
