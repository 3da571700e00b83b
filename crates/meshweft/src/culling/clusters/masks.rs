//! Which of the sampled eyes may see a face, as bits.

use crate::culling::eye::Eye;
use crate::culling::planes::rounded;
use crate::geometry::linear_program::HalfSpace;
use crate::parallel;

/// A bit for each sampled eye.
pub(super) type Mask<const WORDS: usize> = [u64; WORDS];

/// How many faces are one piece of work.
const PIECE: usize = 1 << 14;

/// How many eyes see something of a mask.
#[inline]
pub(super) fn count<const WORDS: usize>(mask: &Mask<WORDS>) -> u32 {
    // Bytes of all words are added before they are added up: twice as fast where no instruction counts bits.
    let mut bytes = 0_u64;
    for &word in mask {
        let pairs = word - (word >> 1 & 0x5555_5555_5555_5555);
        let fours = (pairs & 0x3333_3333_3333_3333) + (pairs >> 2 & 0x3333_3333_3333_3333);
        bytes += (fours + (fours >> 4)) & 0x0f0f_0f0f_0f0f_0f0f;
    }
    let pairs = (bytes & 0x00ff_00ff_00ff_00ff) + (bytes >> 8 & 0x00ff_00ff_00ff_00ff);
    (pairs.wrapping_mul(0x0001_0001_0001_0001) >> 48) as u32
}

#[inline]
pub(super) fn union<const WORDS: usize>(a: &Mask<WORDS>, b: &Mask<WORDS>) -> Mask<WORDS> {
    std::array::from_fn(|i| a[i] | b[i])
}

/// The mask of each of some faces, by their planes around `origin`.
///
/// # Complexity
/// Time O(faces · eyes).
pub(super) fn of_planes<const WORDS: usize>(
    planes: &[HalfSpace],
    origin: [f64; 3],
    eyes: &[Eye],
) -> Vec<Mask<WORDS>> {
    let views: Vec<[f64; 4]> = eyes
        .iter()
        .map(|eye| eye.around(origin).unwrap_or([0.0; 4]))
        .collect();
    let [xs, ys, zs, ws] = [0, 1, 2, 3].map(|axis| {
        let mut lanes = [[0.0_f32; 64]; WORDS];
        for (eye, view) in views.iter().enumerate() {
            lanes[eye / 64][eye % 64] = rounded(view[axis]);
        }
        lanes
    });
    let mask_of = |plane: &HalfSpace| {
        let [a, b, c] = plane.normal.map(rounded);
        let h = rounded(plane.offset);
        std::array::from_fn(|word| {
            let mut bits = 0_u64;
            let (xs, ys, zs, ws) = (&xs[word], &ys[word], &zs[word], &ws[word]);
            for lane in 0..64 {
                let at = a * xs[lane] + b * ys[lane] + (c * zs[lane] - h * ws[lane]);
                bits |= u64::from(at > 0.0) << lane;
            }
            bits
        })
    };
    let pieces = planes.chunks(PIECE).collect();
    parallel::map(pieces, |piece: &[HalfSpace]| {
        piece.iter().map(mask_of).collect::<Vec<_>>()
    })
    .concat()
}
