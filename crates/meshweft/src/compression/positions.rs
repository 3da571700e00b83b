//! Positions, each by how far it is from where its neighbours let it be expected.

use super::ring::Ring;
use crate::bits::{AdaptiveTable, Lane, MOST_BITS, Port, SYMBOLS, code_more, low_half};
use crate::connectivity::{BlockSize, FanModel, Outlook, VertexCoder};
use crate::index::index32;

/// The last symbol: this number or more.
const MOST: u32 = {
    assert!(SYMBOLS == 16);
    // The bits of three numbers are taken at once; a number with more than these has a bit that they have not.
    assert!(3 * 15 <= MOST_BITS);
    15
};
/// The most that is told apart of how far neighbours were from where they were expected, in bits.
const MOST_LEVEL: u32 = 19;

/// More than that: a power of two.
const LEVELS: usize = 32;

/// How many vertices are coded together where the model of faces does not look at them: positions then do not wait for faces.
const MOST_LATER: usize = 256;

/// Where coordinates are coded, by axis.
const LANES: [Lane; 3] = [Lane::ALL[1], Lane::ALL[2], Lane::ALL[3]];

/// A coordinate as a number, and how it follows from others.
pub(super) trait Coordinate {
    /// How much is decoded at once: at about 5,000 bytes, what a block costs beyond its symbols is little.
    const BLOCK_SIZE: BlockSize;

    /// What completes a parallelogram: `a + b - c`.
    fn complete(a: u32, b: u32, c: u32) -> u32;

    /// What one number stands for beyond another, in some unit.
    fn difference(number: u32, other: u32) -> f64;
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
    fn difference(number: u32, other: u32) -> f64 {
        number.wrapping_sub(other).cast_signed().into()
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
    fn difference(number: u32, other: u32) -> f64 {
        f64::from(Self::coordinate(number)) - f64::from(Self::coordinate(other))
    }
}

/// Where positions come from when they are written: by vertex of the source.
pub(super) type Source<'a> = Option<&'a [[u32; 3]]>;

/// What is kept of a vertex: its position, and by axis, from the lowest byte on, how many bits it was from where it was
/// expected. All in one piece, as the next vertex often waits for it.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(16))]
struct Near([u32; 4]);

impl Near {
    #[inline(always)]
    fn new([x, y, z]: [u32; 3], lengths: [u32; 3]) -> Self {
        let [a, b, c] = lengths.map(|length| length.min(MOST_LEVEL));
        Self([x, y, z, a | b << 8 | c << 16])
    }

    /// By axis, the mean of its levels and another one's, rounded up.
    #[inline(always)]
    fn levels_with(self, other: Self) -> [usize; 3] {
        let (own, others) = (self.0[3], other.0[3]);
        let halves = ((own >> 1) & 0x7F_7F7F) + ((others >> 1) & 0x7F_7F7F);
        let mean = halves + ((own | others) & 0x01_0101);
        [mean, mean >> 8, mean >> 16].map(|mean| mean as usize % LEVELS)
    }
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
    /// Vertices that were put off: where each is expected, and its number in the source.
    later: Vec<[u32; 4]>,
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
            later: Vec::new(),
            kinds: std::marker::PhantomData,
        }
    }

    /// The way from one vertex to another.
    #[inline]
    fn way(&self, from: u32, to: u32) -> [f64; 3] {
        let [from, to] = [from, to].map(|vertex| self.near.get(vertex).0);
        [0, 1, 2].map(|axis| C::difference(to[axis], from[axis]))
    }

    /// How far a vertex is from where a new one would be expected beyond an edge.
    #[inline]
    fn reach_beyond(&self, [root, from]: [u32; 2], edge: [f64; 3], across: u32, vertex: u32) -> u8 {
        let [root, from, across, vertex] =
            [root, from, across, vertex].map(|vertex| self.near.get(vertex).0);
        let way = [0, 1, 2].map(|axis| {
            let expected = C::complete(from[axis], root[axis], across[axis]);
            C::difference(vertex[axis], expected)
        });
        steps(dot(way, way), dot(edge, edge))
    }

    /// Codes the next vertex: its position is near those of three others.
    #[inline(always)]
    fn code_now<P: Port>(&mut self, port: &mut P, source: u32, near: [u32; 3]) -> [u32; 3] {
        // What is expected.
        let [a, b, c] = near.map(|vertex| self.near.get(vertex));
        let expected = [0, 1, 2].map(|axis| C::complete(a.0[axis], b.0[axis], c.0[axis]));

        // How far that is from what there is.
        let mut numbers = [0; 3];
        if P::WRITES
            && let Some(source_of) = self.source
        {
            let given = source_of[source as usize];
            numbers = [0, 1, 2].map(|axis| folded(given[axis].wrapping_sub(expected[axis])));
        }
        let levels = a.levels_with(b);
        let lengths = [
            self.length(port, 0, levels[0], numbers[0]),
            self.length(port, 1, levels[1], numbers[1]),
            self.length(port, 2, levels[2], numbers[2]),
        ];
        let numbers = numbers_of(port, lengths, numbers);
        let position = [0, 1, 2].map(|axis| expected[axis].wrapping_add(unfolded(numbers[axis])));
        self.near.push(near[0], Near::new(position, lengths));
        position
    }

    /// How many bits one more than a number has after the first one.
    #[inline(always)]
    fn length(&mut self, port: &mut impl Port, axis: usize, level: usize, number: u32) -> u32 {
        let table = &mut self.levels[axis][level];
        let length = (u64::from(number) + 1).ilog2();
        let symbol = port.code(LANES[axis], table, length.min(MOST) as usize);
        table.see(symbol);
        match index32(symbol) {
            MOST => self.longer(port, length),
            length => length,
        }
    }

    /// A length that is the last symbol's or above.
    #[cold]
    fn longer(&mut self, port: &mut impl Port, length: u32) -> u32 {
        let more = length.wrapping_sub(MOST);
        MOST + port.apart(|port| code_more(port, LANES[0], &mut self.more, more))
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

/// Three numbers, one more than which has some bits after the first one.
#[inline(always)]
fn numbers_of<P: Port>(port: &mut P, lengths: [u32; 3], numbers: [u32; 3]) -> [u32; 3] {
    let [x, y, z] = lengths;
    if x | y | z > MOST {
        return long_numbers(port, lengths, numbers);
    }

    // One more than a number is the first bit and the rest, so a number is this and the rest.
    let least = lengths.map(|length| (1_u32 << length) - 1);
    let mut bits = 0;
    if P::WRITES {
        let rest = [0, 1, 2].map(|axis| u64::from(numbers[axis] - least[axis]));
        bits = rest[0] | rest[1] << x | rest[2] << (x + y);
    }
    let bits = port.bits(LANES[0], x + y + z, bits);
    [
        least[0] + (low_half(bits) & least[0]),
        least[1] + (low_half(bits >> x) & least[1]),
        least[2] + (low_half(bits >> (x + y)) & least[2]),
    ]
}

#[cold]
fn long_numbers(port: &mut impl Port, lengths: [u32; 3], numbers: [u32; 3]) -> [u32; 3] {
    port.apart(|port| {
        [0, 1, 2].map(|axis| {
            let least = (1_u64 << lengths[axis]) - 1;
            let rest = u64::from(numbers[axis]).wrapping_sub(least) & least;
            low_half(least + port.bits(LANES[0], lengths[axis], rest))
        })
    })
}

impl<C: Coordinate, M: FanModel> VertexCoder for Positions<'_, C, M> {
    type Model = M;

    const LANES: usize = 3;

    fn expect(&mut self, vertices: usize) {
        self.read.reserve(vertices);
    }

    #[inline]
    fn code<P: Port>(&mut self, port: &mut P, source: u32, near: [u32; 3]) {
        if M::LOOKS {
            let position = self.code_now(port, source, near);
            if !P::WRITES {
                self.read.push(position);
            }
            return;
        }
        let [a, b, c] = near;
        self.later.push([a, b, c, source]);
        if self.later.len() == MOST_LATER {
            self.settle(port);
        }
    }

    #[inline(never)]
    fn settle<P: Port>(&mut self, port: &mut P) {
        let mut later = std::mem::take(&mut self.later);
        port.apart(|port| {
            for vertex in &mut later {
                let [a, b, c, source] = *vertex;
                let [x, y, z] = self.code_now(port, source, [a, b, c]);
                *vertex = [x, y, z, 0];
            }
        });
        if !P::WRITES {
            self.read
                .extend(later.iter().map(|&[x, y, z, _]| [x, y, z]));
        }
        later.clear();
        self.later = later;
    }

    #[inline]
    fn reach(&self, [root, from]: [u32; 2], across: u32, vertex: u32) -> u8 {
        self.reach_beyond([root, from], self.way(root, from), across, vertex)
    }

    #[inline]
    fn outlook(&self, [root, from, to]: [u32; 3], across: Option<u32>) -> Outlook {
        let (edge, other) = (self.way(root, from), self.way(root, to));
        Outlook {
            reach: across.map_or(0, |across| {
                self.reach_beyond([root, from], edge, across, to)
            }),
            angle: steps_of_angle(dot(edge, other), dot(edge, edge) * dot(other, other)),
        }
    }
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
