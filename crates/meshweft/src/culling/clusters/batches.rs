//! Clusters that are whole batches of an NVIDIA card.
//!
//! The card cuts each draw afresh in batches of at most 32 faces and 32 vertices. Where a range of faces begins or ends inside a
//! batch, that one is not full, and all that follow hold other faces than they were ordered for. So what is merged here
//! are batches: those that are full in the order of a cluster, and others of the faces that are left over, from clusters
//! that are seen from nearly the same eyes. The vertices are expected to stand in one block of 65,536; where they are in blocks of
//! that many already, no batch has faces of two.

use super::face_cluster::{FaceCluster, gathered};
use super::masks::{self, Mask};
use super::merge::{Merging, Price};
use super::seen::Seen;
use super::tour;
use crate::cache::nvidia::{BATCH_FACES, LANES};
use crate::faces::Faces;
use crate::index::{block_of, index32};
use crate::order::{InBatches, is_in_blocks};
use crate::parallel;
use crate::permutation::FaceOrder;

/// Stands for the block of a face with vertices of several. Such faces are in batches of their own: each makes the card forget
/// its vertices.
const ACROSS: u32 = u32::MAX;

/// How many batches are one piece of work.
const PIECE: usize = 256;

/// Faces that are drawn one after the other, and the block of their vertices.
struct BlockRun {
    block: u32,
    faces: Vec<u32>,
}

/// Other clusters of the same faces, each of whole batches that come after each other, with the faces of each batch in the order
/// in which to draw them. `ordered` gives the order of some faces for the card.
pub(super) fn clusters<const WORDS: usize>(
    seen: &Seen<'_, WORDS>,
    clusters: Vec<FaceCluster<WORDS>>,
    price: Price,
    ordered: impl FnOnce(Vec<Vec<u32>>) -> Vec<Vec<u32>>,
) -> Vec<FaceCluster<WORDS>> {
    let batches = inside(seen, batches(seen, clusters, ordered));
    let mut first_of = vec![0; seen.faces.len()];
    for batch in &batches {
        for &face in batch {
            first_of[seen.place(face)] = index32(seen.place(batch[0]));
        }
    }
    let corners = seen.corners();
    let faces = Faces::of_checked(&corners, seen.mesh.vertex_count());
    let first_of = Merging::new(faces, seen.masks, first_of, price, |_| false).run();
    let cluster_of = |batch: &[u32]| first_of[seen.place(batch[0])];
    gathered(
        seen,
        batches.iter().map(|batch| (&**batch, cluster_of(batch))),
    )
}

/// The batches that are merged.
pub(super) fn batches<const WORDS: usize>(
    seen: &Seen<'_, WORDS>,
    clusters: Vec<FaceCluster<WORDS>>,
    ordered: impl FnOnce(Vec<Vec<u32>>) -> Vec<Vec<u32>>,
) -> Vec<Vec<u32>> {
    // The faces of each cluster in order, those of each block by themselves.
    let clusters = clusters.into_iter().map(|cluster| cluster.faces).collect();
    let runs = in_blocks(seen, clusters);
    let (blocks, runs): (Vec<u32>, Vec<Vec<u32>>) =
        runs.into_iter().map(|run| (run.block, run.faces)).unzip();

    // Full batches, and what is left over, side by side if it is seen from the same eyes.
    let mut batches = Vec::new();
    let mut left = Vec::new();
    for (block, faces) in blocks.into_iter().zip(ordered(runs)) {
        let mut rest = Vec::new();
        for batch in cut(seen, &faces) {
            match batch.len() == BATCH_FACES as usize && block != ACROSS {
                true => batches.push(batch.to_vec()),
                false => rest.extend_from_slice(batch),
            }
        }
        if !rest.is_empty() {
            left.push(BlockRun { block, faces: rest });
        }
    }
    batches.extend(of_left(seen, left));
    batches
}

/// The faces of clusters, apart for each block if the vertices are in blocks.
fn in_blocks<const WORDS: usize>(seen: &Seen<'_, WORDS>, clusters: Vec<Vec<u32>>) -> Vec<BlockRun> {
    if !is_in_blocks(seen.mesh.into()) {
        let one = |faces| BlockRun { block: 0, faces };
        return clusters.into_iter().map(one).collect();
    }
    let block_of_face = |face: u32| {
        let [a, b, c] = seen.mesh.faces()[face as usize].map(block_of);
        if a == b && b == c { a } else { ACROSS }
    };
    let mut runs = Vec::with_capacity(clusters.len());
    for mut faces in clusters {
        faces.sort_by_key(|&face| block_of_face(face));
        for faces in faces.chunk_by(|&a, &b| block_of_face(a) == block_of_face(b)) {
            runs.push(BlockRun {
                block: block_of_face(faces[0]),
                faces: faces.to_vec(),
            });
        }
    }
    runs
}

/// Batches of what is left over, block by block.
fn of_left<const WORDS: usize>(seen: &Seen<'_, WORDS>, left: Vec<BlockRun>) -> Vec<Vec<u32>> {
    let mask = |run: &BlockRun| {
        let masks = run.faces.iter().map(|&face| &seen.masks[seen.place(face)]);
        masks.fold([0; WORDS], |both, mask| masks::union(&both, mask))
    };
    let masks: Vec<Mask<WORDS>> = left.iter().map(mask).collect();
    let mut path = tour::path(&masks, seen.directions);
    path.sort_by_key(|&run| left[run as usize].block);
    let runs: Vec<&BlockRun> = path.iter().map(|&run| &left[run as usize]).collect();
    let mut batches = Vec::new();
    for runs in runs.chunk_by(|a, b| a.block == b.block) {
        let faces: Vec<u32> = runs.iter().flat_map(|run| run.faces.clone()).collect();
        batches.extend(cut(seen, &faces).into_iter().map(<[u32]>::to_vec));
    }
    batches
}

/// Faces cut where a batch has as many faces or vertices as it holds. Nothing falls out of the window: the faces of a
/// batch are ordered so later.
fn cut<'a, const WORDS: usize>(seen: &Seen<'_, WORDS>, faces: &'a [u32]) -> Vec<&'a [u32]> {
    let mut batches = Vec::new();
    let mut vertices: Vec<u32> = Vec::new();
    let mut start = 0;
    for (at, &face) in faces.iter().enumerate() {
        add_vertices(&mut vertices, seen.mesh.faces()[face as usize]);
        if at - start == BATCH_FACES as usize || vertices.len() > LANES as usize {
            batches.push(&faces[start..at]);
            start = at;
            vertices.clear();
            add_vertices(&mut vertices, seen.mesh.faces()[face as usize]);
        }
    }
    batches.extend((start < faces.len()).then(|| &faces[start..]));
    batches
}

/// Adds the corners that are not there.
fn add_vertices(vertices: &mut Vec<u32>, corners: [u32; 3]) {
    for vertex in corners {
        if !vertices.contains(&vertex) {
            vertices.push(vertex);
        }
    }
}

/// The faces of each batch in the order that is set up fastest.
fn inside<const WORDS: usize>(seen: &Seen<'_, WORDS>, batches: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
    let order = |batch: &Vec<u32>| {
        let mut vertices = Vec::with_capacity(LANES as usize);
        let mut number = |vertex: u32| {
            let known = vertices.iter().position(|&known| known == vertex);
            index32(known.unwrap_or_else(|| {
                vertices.push(vertex);
                vertices.len() - 1
            }))
        };
        let corners = batch.iter().map(|&face| seen.mesh.faces()[face as usize]);
        let corners: Vec<[u32; 3]> = corners.map(|face| face.map(&mut number)).collect();
        let order = InBatches::ALONE.follow(&corners, &FaceOrder::identity(batch.len()));
        let order = order.new_to_old().iter();
        order.map(|&place| batch[place as usize]).collect()
    };
    let pieces = batches.chunks(PIECE).collect();
    let ordered = parallel::map(pieces, |piece: &[Vec<u32>]| {
        piece.iter().map(order).collect::<Vec<_>>()
    });
    ordered.concat()
}
