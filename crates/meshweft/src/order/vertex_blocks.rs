//! Vertices in blocks of exactly 65,536, with few faces across their borders.
//!
//! NVIDIA's cards forget which vertices they have transformed wherever the high 16 bits of two
//! consecutive indices differ, so a face across the border of two such blocks is dear, and a mesh
//! whose faces change between blocks often is drawn 12 to 18 % slower (measured on an H100 and an
//! H200). The number of a vertex is all that decides: blocks are cut from the mesh by minimum edge
//! cut, each of exactly 65,536 vertices, so that they stand where the high bits change.

use crate::faces::Faces;
use crate::index::{BLOCK, block_of, index32};
use crate::partition::{NO_PART, exact_parts};
use crate::permutation::{Permutation, VertexOrder};

/// The vertices block by block, each block of exactly 65,536 vertices but for the last, with few
/// faces across borders; in each by first use. Unused vertices come last, in file order.
///
/// Blocks come in the order of their first use. Up to 65,536 vertices stay as they are.
///
/// Vertices are counted from the first one: where a renderer adds a base vertex to the indices, as it
/// may where meshes share a buffer, blocks stand where the hardware's do only if that is a multiple of
/// 65,536.
///
/// # Complexity
/// Time O((vertices + faces) · log blocks), space 70 bytes a face.
///
/// ```
/// use meshweft::{Faces, order::vertex_blocks};
/// // A strip of 100,000 vertices, of which every other face is far from the last.
/// let face = |i: u32| { let v = i / 2 + i % 2 * 49_999; [v, v + 1, v + 2] };
/// let faces: Vec<_> = (0..99_998).map(face).collect();
/// let renumbered = vertex_blocks(&faces).renumber(&faces);
/// let is_across = |face: &&[u32; 3]| face.iter().any(|v| v >> 16 != face[0] >> 16);
/// assert!(renumbered.iter().filter(is_across).count() <= 4);
/// ```
#[must_use]
pub fn vertex_blocks<'a>(faces: impl Into<Faces<'a>>) -> VertexOrder {
    let faces = faces.into();
    match faces.vertex_count() {
        0..=BLOCK => VertexOrder::identity(faces.vertex_count()),
        _ => in_blocks(faces, &new_blocks(faces)),
    }
}

/// The block of each vertex, [`NO_PART`] for unused ones: blocks in the order of their first use, but
/// for the short one, which is last.
pub(super) fn new_blocks(faces: Faces<'_>) -> Vec<u32> {
    let mut block_of = exact_parts(faces, BLOCK);
    let parts = block_of.iter().filter(|&&part| part != NO_PART);
    let Some(&last) = parts.max() else {
        return block_of;
    };

    let mut number = vec![NO_PART; last as usize + 1];
    number[last as usize] = last;
    let mut next = 0;
    for &vertex in faces.as_slice().as_flattened() {
        let number = &mut number[block_of[vertex as usize] as usize];
        if *number == NO_PART {
            *number = next;
            next += 1;
        }
    }
    for block in block_of.iter_mut().filter(|block| **block != NO_PART) {
        *block = number[*block as usize];
    }
    block_of
}

/// The vertices block by block, those of one by first use; unused ones are the last of their block,
/// or of all where they have none.
pub(super) fn in_blocks(faces: Faces<'_>, block_of: &[u32]) -> VertexOrder {
    // Where the next vertex of each block goes; without a block, after all others.
    let vertex_count = faces.vertex_count();
    let last = block_of.iter().filter(|&&block| block != NO_PART).max();
    let without = last.map_or(0, |&last| last as usize + 1);
    let group_of = |vertex: u32| (block_of[vertex as usize] as usize).min(without);
    let mut next = vec![0; without + 2];
    for vertex in 0..index32(vertex_count) {
        next[group_of(vertex) + 1] += 1;
    }
    for group in 0..=without {
        next[group + 1] += next[group];
    }

    let mut seen = vec![false; vertex_count];
    let mut new_to_old = vec![0; vertex_count];
    let uses = faces.as_slice().as_flattened().iter().copied();
    for vertex in uses.chain(0..index32(vertex_count)) {
        if !std::mem::replace(&mut seen[vertex as usize], true) {
            let place = &mut next[group_of(vertex)];
            new_to_old[*place] = vertex;
            *place += 1;
        }
    }
    Permutation::from_algorithm(new_to_old).into()
}

/// How many faces have vertices of more than one block.
pub(super) fn faces_across(faces: Faces<'_>, block_of: impl Fn(u32) -> u32) -> usize {
    let is_across = |&&face: &&[u32; 3]| {
        let [a, b, c] = face.map(&block_of);
        a != b || b != c
    };
    faces.as_slice().iter().filter(is_across).count()
}

/// The vertices in the order of their first use, each in the block where it stands; without blocks where
/// one holds all that are used.
pub(crate) fn first_use_in_blocks(faces: Faces<'_>) -> VertexOrder {
    let vertex_count = faces.vertex_count();
    let mut is_used = vec![false; vertex_count];
    for &vertex in faces.as_slice().as_flattened() {
        is_used[vertex as usize] = true;
    }
    match is_used.iter().filter(|&&used| used).count() {
        0..=BLOCK => by_first_use(faces),
        _ => {
            let given: Vec<u32> = (0..index32(vertex_count)).map(block_of).collect();
            in_blocks(faces, &given)
        }
    }
}

/// The vertices in the order of their first use, whatever their number.
pub(crate) fn by_first_use(faces: Faces<'_>) -> VertexOrder {
    let vertex_count = faces.vertex_count();
    let mut seen = vec![false; vertex_count];
    let mut new_to_old = Vec::with_capacity(vertex_count);
    let uses = faces.as_slice().iter().flatten().copied();
    for vertex in uses.chain(0..index32(vertex_count)) {
        if !std::mem::replace(&mut seen[vertex as usize], true) {
            new_to_old.push(vertex);
        }
    }
    Permutation::from_algorithm(new_to_old).into()
}
