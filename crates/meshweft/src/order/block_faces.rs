//! The faces of a mesh by the blocks of 65,536 vertices that its numbering stands in.

use super::vertex_blocks::faces_across;
use crate::faces::Faces;
use crate::index::{BLOCK, block_of, index32};
use crate::permutation::Permutation;
use crate::topology::rows;

/// At most one face in so many may be across a border for the blocks to be worth keeping to: of a large
/// flat mesh in square blocks it is one in 128.
const FEW_ACROSS: usize = 50;

/// Faces sorted by their block.
pub(super) struct BlockFaces {
    pub(super) order: Permutation,
    pub(super) blocks: Vec<BlockEnds>,
}

/// Where the faces of a block end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BlockEnds {
    /// Of those that are inside, which come first.
    pub(super) inside: usize,
    /// Of all, with those across a border.
    pub(super) all: usize,
}

/// Whether there are more vertices than one block holds, numbered so that few faces are across
/// borders: then faces are to be ordered block by block.
///
/// Time O(faces).
pub(crate) fn is_in_blocks(faces: Faces<'_>) -> bool {
    faces.vertex_count() > BLOCK && faces_across(faces, block_of) * FEW_ACROSS <= faces.len()
}

impl BlockFaces {
    /// The faces of each block that has any, in file order: first those inside, then, if `apart`, those
    /// across a border. Such a face belongs to the block with two of its vertices, or with its first;
    /// a polygon, which begins and ends as `polygons` says, where its first face does.
    ///
    /// Time and space O(faces + blocks).
    pub(super) fn new(faces: Faces<'_>, polygons: Option<&[[u32; 2]]>, apart: bool) -> Self {
        let all = faces.as_slice();
        let row_of = |face: u32| {
            let first = polygons.map_or(face, |polygons| polygons[face as usize][0]);
            let (home, is_across) = home(all[first as usize]);
            2 * home + u32::from(apart && is_across)
        };

        let row_count = 2 * faces.vertex_count().div_ceil(BLOCK);
        let numbers = 0..index32(all.len());
        let mut starts = rows::starts(row_count, numbers.clone().map(row_of));
        let mut members = vec![0; all.len()];
        let items = numbers.map(|face| (row_of(face), face));
        rows::place(&mut starts, items, &mut members);

        let blocks = starts[1..].chunks_exact(2).map(|ends| BlockEnds {
            inside: ends[0] as usize,
            all: ends[1] as usize,
        });
        let mut blocks: Vec<BlockEnds> = blocks.collect();
        blocks.dedup_by_key(|ends| ends.all);
        // Blocks without faces before the first that has some.
        blocks.retain(|ends| ends.all != 0);
        Self {
            order: Permutation::from_algorithm(members),
            blocks,
        }
    }
}

/// The block that a face belongs to, and whether it is across a border.
fn home(face: [u32; 3]) -> (u32, bool) {
    let [a, b, c] = face.map(block_of);
    (if b == c { b } else { a }, a != b || b != c)
}

/// How far to turn a face so that its corners in its own block come first, and, where `is_last`, last.
pub(super) fn turned_home(face: [u32; 3], is_last: bool) -> u8 {
    let (home, _) = home(face);
    let [a, b, c] = face.map(|vertex| block_of(vertex) == home);
    match ([a, b, c], is_last) {
        ([true, true, false], false) | ([false, true, true], true) => 0,
        ([false, true, true], false) | ([true, false, true], true) => 1,
        ([true, false, true], false) | ([true, true, false], true) => 2,
        _ => 0,
    }
}

/// How far to turn a face so that it starts in `block` if it has two, one of them that: its corners
/// then are in one block after the other.
pub(super) fn turned_from(face: [u32; 3], block: Option<u32>) -> u8 {
    let first = turned_home(face, false);
    match (home(face), block) {
        ((home, true), Some(block)) if block != home && face.map(block_of).contains(&block) => {
            turned_home(face, true)
        }
        _ => first,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faces::turned;

    #[test]
    fn faces_are_sorted_by_the_block_of_two_vertices() {
        let high = 1 << 16;
        let faces = [
            [0, 1, high],
            [high, high + 1, 2],
            [high, high + 1, high + 2],
            [1, high, 2],
            [0, 1, 2],
            [3 * high, 3 * high + 1, 3 * high + 2],
        ];
        let vertex_count = 3 * BLOCK + 3;
        let of = |apart| BlockFaces::new(Faces::of_checked(&faces, vertex_count), None, apart);
        let ends = |pairs: &[[usize; 2]]| -> Vec<BlockEnds> {
            let ends = pairs.iter().map(|&[inside, all]| BlockEnds { inside, all });
            ends.collect()
        };
        let apart = of(true);
        assert_eq!(apart.order.new_to_old(), [4, 0, 3, 2, 1, 5]);
        assert_eq!(apart.blocks, ends(&[[1, 3], [4, 5], [6, 6]]));
        let together = of(false);
        assert_eq!(together.order.new_to_old(), [0, 3, 4, 1, 2, 5]);
        assert_eq!(together.blocks, ends(&[[3, 3], [5, 5], [6, 6]]));

        let pairs = [[0, 2], [0, 2], [2, 4], [2, 4], [4, 6], [4, 6]];
        let pairs = BlockFaces::new(Faces::of_checked(&faces, vertex_count), Some(&pairs), false);
        assert_eq!(pairs.order.new_to_old(), [0, 1, 4, 5, 2, 3]);
    }

    #[test]
    fn faces_are_turned_to_their_block() {
        let high = 1 << 16;
        for face in [[0, 1, high], [high, 0, 1], [1, high, 0]] {
            assert_eq!(turned(face, turned_home(face, false)), [0, 1, high]);
            assert_eq!(turned(face, turned_home(face, true)), [high, 0, 1]);
        }
    }
}
