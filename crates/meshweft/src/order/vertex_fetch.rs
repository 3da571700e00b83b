//! Vertices in the order in which the faces first use them, so that they are fetched in sequence.

use super::vertex_blocks::{by_first_use, faces_across, in_blocks, new_blocks};
use crate::faces::Faces;
use crate::index::{BLOCK, block_of, index32};
use crate::partition::NO_PART;
use crate::permutation::VertexOrder;

/// One face in so many across a border is as good as none. Cuts of a mesh in other numbers differ, by up
/// to a third where few faces are across.
const FEW_ACROSS: usize = 1000;

/// The vertices in the order of their first use by `faces`; unused ones after them, in file order.
///
/// Nothing is lost: unused vertices are kept. (A slice of triples has no vertices after its largest
/// index: give [`Faces`] with the number of your vertices.) For a face order that is good for a vertex cache,
/// first use is close to the best storage order there is (overfetch 1.10 to 1.14 on scanned meshes
/// with 32-byte vertices, where 1 is the floor).
///
/// More than 65,536 used vertices are put in blocks of that many, as
/// [`vertex_blocks`](super::vertex_blocks()) does, and inside a block by first use. Where they stand in
/// blocks of at most one and a half times as many faces across borders, or of one in a thousand, these
/// stay, and vertices move inside them: so they do after an order of the faces inside the blocks.
///
/// # Complexity
/// Time and space O(vertices + faces); of more than 65,536 vertices as
/// [`vertex_blocks`](super::vertex_blocks()).
///
/// ```
/// use meshweft::{Faces, order::vertex_fetch};
/// let order = vertex_fetch(Faces::new(&[[3, 1, 0], [0, 1, 4]], 5)?);
/// assert_eq!(order.new_to_old(), [3, 1, 0, 4, 2]);
/// assert_eq!(order.renumber(&[[3, 1, 0]]), [[0, 1, 2]]);
/// # Ok::<(), meshweft::MeshError>(())
/// ```
#[must_use]
pub fn vertex_fetch<'a>(faces: impl Into<Faces<'a>>) -> VertexOrder {
    let faces = faces.into();
    if faces.vertex_count() <= BLOCK {
        return by_first_use(faces);
    }

    // Those that are used may need one block.
    let new = new_blocks(faces);
    let last = new.iter().filter(|&&block| block != NO_PART).max();
    let count = last.map_or(0, |&last| last as usize + 1);
    if count < 2 {
        return by_first_use(faces);
    }

    // The blocks that there are stay if they are no more and cut as well.
    let given: Vec<u32> = (0..index32(faces.vertex_count())).map(block_of).collect();
    let mut is_named = vec![false; given.len().div_ceil(BLOCK)];
    for &vertex in faces.as_slice().as_flattened() {
        is_named[block_of(vertex) as usize] = true;
    }
    let is_full = is_named.iter().filter(|&&named| named).count() == count;
    let [across, across_new] =
        [&given, &new].map(|blocks| faces_across(faces, |v| blocks[v as usize]));
    let are_few = across * FEW_ACROSS <= faces.len() || across * 2 <= across_new * 3;
    let stay = is_full && are_few;
    in_blocks(faces, if stay { &given } else { &new })
}

#[cfg(test)]
mod tests {
    use super::super::vertex_blocks;
    use super::*;
    use crate::permutation::Permutation;

    /// A grid of 300 × 300 squares and five unused vertices, all vertices and faces shuffled.
    fn grid() -> (Vec<[u32; 3]>, usize) {
        let square = |i: u32| {
            let corner = i / 300 * 301 + i % 300;
            let above = corner + 301;
            [[corner, corner + 1, above], [corner + 1, above + 1, above]]
        };
        let faces: Vec<_> = (0..90_000).flat_map(square).collect();
        let vertex_count = 301 * 301 + 5;
        let faces = Permutation::random(faces.len(), 1).apply(&faces);
        let vertices = VertexOrder::from(Permutation::random(vertex_count, 2));
        (vertices.renumber(&faces), vertex_count)
    }

    #[test]
    fn many_vertices_come_in_blocks_that_stay() {
        let (faces, vertex_count) = grid();
        let faces = Faces::of_checked(&faces, vertex_count);
        let is_used = |v: u32| faces.as_slice().as_flattened().contains(&v);
        let orders = [vertex_fetch(faces), vertex_blocks(faces)];
        assert_eq!(orders[0], orders[1], "scattered vertices get new blocks");
        let unused = &orders[0].new_to_old()[vertex_count - 5..];
        assert!(unused.is_sorted() && !unused.iter().any(|&v| is_used(v)));

        // Few faces across: a straight cut has 600, and one around a corner more.
        let renumbered = orders[0].renumber(faces.as_slice());
        let renumbered = Faces::of_checked(&renumbered, vertex_count);
        assert!(faces_across(renumbered, block_of) < 900);
        assert!(faces_across(faces, block_of) > 50_000);
        assert!(vertex_fetch(renumbered).is_identity());

        // Faces in another order: the blocks stay, and inside them first use decides.
        let reversed: Vec<_> = renumbered.as_slice().iter().rev().copied().collect();
        let again = vertex_fetch(Faces::of_checked(&reversed, vertex_count));
        let kept = (0..).zip(again.new_to_old());
        assert!(
            kept.clone()
                .all(|(new, &old)| block_of(new) == block_of(old))
        );
        assert!(kept.clone().any(|(new, &old)| new != old));
    }

    #[test]
    fn few_used_vertices_need_no_blocks() {
        let order = vertex_fetch(Faces::of_checked(&[[90_000, 5, 70_000]], 100_000));
        assert_eq!(order.new_to_old()[..4], [90_000, 5, 70_000, 0]);
        let few = Faces::of_checked(&[[2, 1, 0]], 65_536);
        assert!(vertex_blocks(few).is_identity());
        let none = Faces::of_checked(&[], 70_000);
        assert!(vertex_blocks(none).is_identity() && vertex_fetch(none).is_identity());
    }
}
