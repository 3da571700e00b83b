//! Positions, each by how far it is from where its neighbours let it be expected.

use super::ring::Ring;
use crate::bits::{AdaptiveTable, MOST_BITS, SYMBOLS};
use crate::connectivity::{Port, VertexCoder};
use crate::index::index32;

/// The last symbol: this number or more.
const MOST: u32 = {
    assert!(SYMBOLS == 16);
    15
};
/// The most that is told apart of how far neighbours were from where they were expected, in bits.
const LEVELS: usize = 20;

/// A coordinate as a number, and how it follows from others.
pub(super) trait Coordinate {
    /// What completes a parallelogram: `a + b - c`.
    fn complete(a: u32, b: u32, c: u32) -> u32;
}

/// Multiples of a step, two to the power of 32 being 0.
#[derive(Debug)]
pub(super) struct OnLattice;

impl Coordinate for OnLattice {
    #[inline]
    fn complete(a: u32, b: u32, c: u32) -> u32 {
        a.wrapping_add(b).wrapping_sub(c)
    }
}

/// Numbers in the order of the `f32` that they stand for, bit by bit.
#[derive(Debug)]
pub(super) struct Exact;

/// The highest bit.
const SIGN: u32 = 1 << 31;

impl Exact {
    pub(super) fn of(coordinate: f32) -> u32 {
        let bits = coordinate.to_bits();
        match bits & SIGN {
            0 => bits | SIGN,
            _ => !bits,
        }
    }

    pub(super) fn coordinate(number: u32) -> f32 {
        f32::from_bits(match number & SIGN {
            0 => !number,
            _ => number & !SIGN,
        })
    }
}

impl Coordinate for Exact {
    /// One addition and one subtraction, rounded as IEEE 754 says: the same everywhere.
    #[inline]
    fn complete(a: u32, b: u32, c: u32) -> u32 {
        let sum = Self::coordinate(a) + Self::coordinate(b) - Self::coordinate(c);
        // The bits of a NaN are not the same everywhere.
        if sum.is_nan() { a } else { Self::of(sum) }
    }
}

/// Where positions come from when they are written: by vertex of the source.
pub(super) type Source<'a> = Option<&'a [[u32; 3]]>;

/// What is kept of a vertex.
#[derive(Debug, Clone, Copy, Default)]
struct Near {
    position: [u32; 3],
    /// By axis, how many bits it was from where it was expected.
    levels: [u8; 3],
}

/// Positions of vertices as they are met.
#[derive(Debug)]
pub(super) struct Positions<'a, C> {
    source: Source<'a>,
    near: Ring<Near>,
    /// How many bits, by axis and neighbours.
    levels: [[AdaptiveTable; LEVELS]; 3],
    /// How many beyond the last symbol.
    more: AdaptiveTable,
    /// Those that were read, until they are taken.
    pub(super) read: Vec<[u32; 3]>,
    coordinate: std::marker::PhantomData<C>,
}

impl<'a, C: Coordinate> Positions<'a, C> {
    pub(super) fn new(source: Source<'a>) -> Self {
        Self {
            source,
            near: Ring::new(),
            levels: [[AdaptiveTable::EVEN; LEVELS]; 3],
            more: AdaptiveTable::EVEN,
            read: Vec::new(),
            coordinate: std::marker::PhantomData,
        }
    }

    /// How far a coordinate is from where it was expected, and how many bits that has.
    #[inline]
    fn difference(
        &mut self,
        port: &mut impl Port,
        axis: usize,
        context: usize,
        difference: u32,
    ) -> (u32, u32) {
        // The sign comes last: 0, 1, -1, 2, -2 …
        let signed = difference.cast_signed();
        let above = ((signed << 1) ^ (signed >> 31)).cast_unsigned();
        let mut length = u32::BITS - above.leading_zeros();
        let table = &mut self.levels[axis][context];
        let symbol = port.code(table, length.min(MOST) as usize);
        table.see(symbol);
        length = match index32(symbol) {
            MOST => MOST + more(&mut self.more, port, length.wrapping_sub(MOST)),
            length => length,
        };

        // The bits after the first one, which is set.
        let mut value = u32::from(length > 0);
        let mut left = length.saturating_sub(1);
        while left > 0 {
            let count = left.min(MOST_BITS);
            left -= count;
            let bits = (above >> left) & ((1 << count) - 1);
            value = value << count | port.bits(count, bits);
        }
        let half = (value >> 1).cast_signed();
        ((half ^ -(value & 1).cast_signed()).cast_unsigned(), length)
    }
}

/// How many more bits than 15 a number has: up to 17.
#[cold]
fn more(table: &mut AdaptiveTable, port: &mut impl Port, more: u32) -> u32 {
    let symbol = port.code(table, more.min(MOST) as usize);
    table.see(symbol);
    match index32(symbol) {
        MOST => (MOST + port.bits(2, more.wrapping_sub(MOST) & 3)).min(17),
        more => more,
    }
}

impl<C: Coordinate> VertexCoder for Positions<'_, C> {
    const IS_NOTHING: bool = false;

    #[inline]
    fn code(&mut self, port: &mut impl Port, source: u32, near: [u32; 3]) {
        // What is expected.
        let [a, b, c] = match self.near.count() {
            0 => [Near::default(); 3],
            _ => near.map(|vertex| self.near.get(vertex)),
        };
        let given = self
            .source
            .map_or([0; 3], |source_of| source_of[source as usize]);

        // What there is.
        let mut next = Near::default();
        for (axis, &given) in given.iter().enumerate() {
            let expected = C::complete(a.position[axis], b.position[axis], c.position[axis]);
            let context = usize::from((a.levels[axis] + b.levels[axis]).div_ceil(2));
            let context = context.min(LEVELS - 1);
            let difference = given.wrapping_sub(expected);
            let (difference, level) = self.difference(port, axis, context, difference);
            next.position[axis] = expected.wrapping_add(difference);
            next.levels[axis] = level.to_le_bytes()[0];
        }
        self.near.push(near[0], next);
        if self.source.is_none() {
            self.read.push(next.position);
        }
    }
}
