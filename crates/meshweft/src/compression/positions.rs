//! Positions, each by how far it is from where its neighbours let it be expected.

use super::ring::Ring;
use crate::bits::{AdaptiveTable, Lane, MOST_BITS, Port, SYMBOLS, code_more, code_rest};
use crate::connectivity::{BlockSize, FanModel, VertexCoder};
use crate::index::index32;

/// The last symbol: this number or more.
const MOST: u32 = {
    assert!(SYMBOLS == 16);
    15
};
/// The most that is told apart of how far neighbours were from where they were expected, in bits.
const LEVELS: usize = 20;

/// Where coordinates are coded, by axis.
const LANES: [Lane; 3] = [Lane::ALL[1], Lane::ALL[2], Lane::ALL[3]];

/// A coordinate as a number, and how it follows from others.
pub(super) trait Coordinate {
    /// How much is decoded at once: at about 5,000 bytes, what a block costs beyond its symbols is little.
    const BLOCK_SIZE: BlockSize;

    /// What completes a parallelogram: `a + b - c`.
    fn complete(a: u32, b: u32, c: u32) -> u32;

    /// What the number stands for, but for its unit and a shift.
    fn value(number: u32) -> f64;
}

/// Multiples of a step, two to the power of 32 being 0.
#[derive(Debug)]
pub(super) struct OnLattice;

impl Coordinate for OnLattice {
    const BLOCK_SIZE: BlockSize = BlockSize(4096);

    #[inline]
    fn complete(a: u32, b: u32, c: u32) -> u32 {
        a.wrapping_add(b).wrapping_sub(c)
    }

    #[inline]
    fn value(number: u32) -> f64 {
        number.into()
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
    const BLOCK_SIZE: BlockSize = BlockSize(1024);

    /// One addition and one subtraction, rounded as IEEE 754 says: the same everywhere.
    #[inline]
    fn complete(a: u32, b: u32, c: u32) -> u32 {
        let sum = Self::coordinate(a) + Self::coordinate(b) - Self::coordinate(c);
        // The bits of a NaN are not the same everywhere.
        if sum.is_nan() { a } else { Self::of(sum) }
    }

    #[inline]
    fn value(number: u32) -> f64 {
        Self::coordinate(number).into()
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
pub(super) struct Positions<'a, C, M> {
    source: Source<'a>,
    near: Ring<Near>,
    /// How many bits, by axis and neighbours.
    levels: [[AdaptiveTable; LEVELS]; 3],
    /// How many beyond the last symbol.
    more: AdaptiveTable,
    /// Those that were read, until they are taken.
    pub(super) read: Vec<[u32; 3]>,
    kinds: std::marker::PhantomData<(C, M)>,
}

impl<'a, C: Coordinate, M> Positions<'a, C, M> {
    pub(super) fn new(source: Source<'a>) -> Self {
        Self {
            source,
            near: Ring::new(),
            levels: [[AdaptiveTable::EVEN; LEVELS]; 3],
            more: AdaptiveTable::EVEN,
            read: Vec::new(),
            kinds: std::marker::PhantomData,
        }
    }

    #[inline]
    fn point(&self, vertex: u32) -> [f64; 3] {
        let [x, y, z] = self.near.get(vertex).position;
        [C::value(x), C::value(y), C::value(z)]
    }

    /// How many bits the number of a difference has.
    #[inline(always)]
    fn length(&mut self, port: &mut impl Port, axis: usize, context: usize, length: u32) -> u32 {
        let table = &mut self.levels[axis][context];
        let symbol = port.code(LANES[axis], table, length.min(MOST) as usize);
        table.see(symbol);
        match index32(symbol) {
            MOST => MOST + code_more(port, LANES[0], &mut self.more, length.wrapping_sub(MOST)),
            length => length,
        }
    }
}

/// A difference as a number: 0, 1, -1, 2, -2 … The sign comes last.
#[inline]
fn folded(difference: u32) -> u32 {
    let signed = difference.cast_signed();
    ((signed << 1) ^ (signed >> 31)).cast_unsigned()
}

#[inline]
fn unfolded(number: u32) -> u32 {
    (number >> 1) ^ (number & 1).wrapping_neg()
}

/// The bits after the first one of three numbers of some lengths.
#[inline(always)]
fn rest_of(port: &mut impl Port, lengths: [u32; 3], numbers: [u32; 3]) -> [u32; 3] {
    let counts = lengths.map(|length| length.saturating_sub(1));
    let first = lengths.map(|length| u32::from(length > 0));
    let total: u32 = counts.iter().sum();
    let rest = |axis: usize| numbers[axis] & ((1 << counts[axis]) - 1);

    // Mostly they are few enough to be taken at once.
    if total <= MOST_BITS {
        if total == 0 {
            return first;
        }
        let [_, y, z] = counts;
        let bits = (rest(0) << y | rest(1)) << z | rest(2);
        let bits = port.bits(LANES[0], total, bits);
        let with_first =
            |axis: usize, bits: u32| first[axis] << counts[axis] | bits & ((1 << counts[axis]) - 1);
        return [
            with_first(0, bits >> (y + z)),
            with_first(1, bits >> z),
            with_first(2, bits),
        ];
    }
    [0, 1, 2].map(|axis| code_rest(port, LANES[0], first[axis], counts[axis], numbers[axis]))
}

impl<C: Coordinate, M: FanModel> VertexCoder for Positions<'_, C, M> {
    type Model = M;

    const LANES: usize = 3;

    fn expect(&mut self, vertices: usize) {
        self.read.reserve(vertices);
    }

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

        // How far that is from what there is.
        let expected =
            [0, 1, 2].map(|axis| C::complete(a.position[axis], b.position[axis], c.position[axis]));
        let numbers = [0, 1, 2].map(|axis| folded(given[axis].wrapping_sub(expected[axis])));
        let mut lengths = [0; 3];
        for axis in 0..3 {
            let context = usize::from((a.levels[axis] + b.levels[axis]).div_ceil(2));
            let length = u32::BITS - numbers[axis].leading_zeros();
            lengths[axis] = self.length(port, axis, context.min(LEVELS - 1), length);
        }
        let numbers = rest_of(port, lengths, numbers);
        let next = Near {
            position: [0, 1, 2].map(|axis| expected[axis].wrapping_add(unfolded(numbers[axis]))),
            levels: lengths.map(|length| length.to_le_bytes()[0]),
        };
        self.near.push(near[0], next);
        if self.source.is_none() {
            self.read.push(next.position);
        }
    }

    #[inline]
    fn reach(&self, [root, from]: [u32; 2], across: u32, vertex: u32) -> u8 {
        let [root, from, across, vertex] = [
            self.point(root),
            self.point(from),
            self.point(across),
            self.point(vertex),
        ];
        let mut way = [0.0; 3];
        for axis in 0..3 {
            way[axis] = vertex[axis] - (from[axis] + root[axis] - across[axis]);
        }
        let edge = minus(from, root);
        steps(dot(way, way), dot(edge, edge))
    }

    #[inline]
    fn angle(&self, [at, one, other]: [u32; 3]) -> u8 {
        let at = self.point(at);
        let [one, other] = [minus(self.point(one), at), minus(self.point(other), at)];
        steps_of_angle(dot(one, other), dot(one, one) * dot(other, other))
    }
}

#[inline]
fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// About half octaves of the ratio of two squares, from two to the power of -4 on: 1 to 15, or 0 for no number, whose bits
/// are not the same everywhere.
#[inline]
fn steps(square: f64, unit: f64) -> u8 {
    // Bits of numbers above 0 are about their logarithms.
    let is_there = square < f64::INFINITY && unit > 0.0 && unit < f64::INFINITY;
    if !is_there {
        return 0;
    }
    let bits = |square: f64| square.to_bits().cast_signed();
    let half_octaves = (bits(square) - bits(unit)) >> 51;
    1 + (half_octaves + 8).clamp(0, 14).to_le_bytes()[0]
}

/// By the square of the cosine, from 1, opposite, to 31, the same way; 0 for no angle. `square` is that of both lengths.
#[inline]
fn steps_of_angle(product: f64, square: f64) -> u8 {
    let cosine = product * product.abs() / square;
    if cosine.is_nan() {
        return 0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "from -15 to 15")]
    let steps = (cosine * 15.5) as i32;
    (16 + steps.clamp(-15, 15)).to_le_bytes()[0]
}
