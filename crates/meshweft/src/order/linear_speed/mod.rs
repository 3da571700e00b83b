//! Linear-speed vertex cache optimisation: draw next the face whose vertices score most.
//!
//! Tom Forsyth: *Linear-Speed Vertex Cache Optimisation*, 2006,
//! <https://tomforsyth1000.github.io/papers/fast_vert_cache_opt.html>. A vertex scores by how lately it was
//! used, as a place in an LRU list, and by how few faces it has left; a face scores the sum of its
//! vertices. Only faces at vertices of the list are looked at, so that a step takes the same time
//! whatever the size of the mesh.
//!
//! Where the paper leaves room, this follows meshoptimizer's `optimizeVertexCache`, whose order it is
//! face for face (`compare/tests/linear_speed.rs`):
//!
//! - The list has 16 places, and scores are those of [`scores`].
//! - A score of a face is kept up by adding the change of each vertex, in `f32`. Nothing else
//!   settles ties: sums differ in the last bits by their history.
//! - Vertices are gone through from the last used to those that just left the list, their faces in
//!   the order of their rows, and each face is compared at once, before the changes of its other
//!   vertices arrive. The first of the greatest is next. A row is in file order at first; its last
//!   face takes the place of the one that is drawn.
//! - At a dead end the first face in file order that is not drawn is next.
//! - A face that names a vertex twice stands in its row and in the list twice.
//!
//! The original goes through all faces of a vertex, which is quadratic at the centre of a large fan.
//! Here [`hubs`] finds the same face in less time. Read [`traverse`] first.

mod best_face;
mod hubs;
mod open_faces;
mod recent_vertices;
mod score_classes;
mod scores;

#[cfg(test)]
mod tests;

use crate::faces::Faces;
use crate::index::index32;
use crate::permutation::{FaceOrder, Permutation};
use best_face::BestFace;
use hubs::Hubs;
use open_faces::OpenFaces;
use recent_vertices::RecentVertices;
use scores::VERTEX_SCORES;

/// Most faces of a vertex that are gone through one by one; a vertex with more is a hub. The number
/// was not tuned, and changes no order.
const HUB: u32 = 256;

/// How many faces a mesh may have gone through for each that is drawn, where that is limited. Meshes have some
/// fifty; more than a thousand only soups, in which all vertices have hundreds of faces.
const MOST_WORK: u64 = 4096;
/// So many are gone through in any case: it takes a quarter of a second.
const ALWAYS_DONE: u64 = 1 << 26;
/// Faces drawn between two looks at whether it goes on.
const FACES_BETWEEN_LOOKS: usize = 1 << 14;

/// A rendering sequence by linear-speed vertex cache optimisation, which suits caches of many sizes.
///
/// Tom Forsyth: *Linear-Speed Vertex Cache Optimisation*, 2006,
/// <https://tomforsyth1000.github.io/papers/fast_vert_cache_opt.html>, with the scores that meshoptimizer's
/// `optimizeVertexCache` was tuned to. Faces come in the same order as from that, on every mesh, and
/// with their corners as they are.
///
/// # Complexity
/// Time O(vertices + faces) where vertices have up to 256 faces. At a vertex with more, a step takes the
/// time of the distinct scores of its faces, which are few: a fan of any size is linear up to a
/// logarithm. Where most faces of such vertices have others of them too, as in soups, it takes the
/// time of all these faces, and the whole is quadratic, as the original is at every such vertex. Space 16 bytes a
/// vertex and 20 a face, with the result; with vertices of more than 256 faces up to 100 a face more.
///
/// ```
/// use meshweft::order::baselines;
/// let order = baselines::linear_speed(&[[0, 1, 2], [3, 4, 5], [2, 1, 3]]);
/// assert_eq!(order.new_to_old(), [0, 2, 1]);
/// ```
#[must_use]
pub fn linear_speed<'a>(faces: impl Into<Faces<'a>>) -> FaceOrder {
    let most_work = Work::default();
    let numbers = face_numbers(faces.into(), HUB, &most_work);
    Permutation::from_algorithm(numbers.expect("it has no limit")).into()
}

/// As [`linear_speed`], but `None` where it takes more than [`MOST_WORK`] faces of the list's vertices a face, in large meshes, and
/// where `goes_on` says that it is to stop.
pub(in crate::order) fn linear_speed_within_limits(
    faces: Faces<'_>,
    goes_on: &dyn Fn() -> bool,
) -> Option<FaceOrder> {
    let most = MOST_WORK.saturating_mul(faces.len() as u64);
    let work = Work {
        most: most.max(ALWAYS_DONE),
        goes_on,
    };
    let numbers = face_numbers(faces, HUB, &work)?;
    Some(Permutation::from_algorithm(numbers).into())
}

/// How much a traversal may do.
struct Work<'a> {
    /// How many faces are gone through, or scores of hubs changed, in all.
    most: u64,
    goes_on: &'a dyn Fn() -> bool,
}

impl Default for Work<'_> {
    /// All that there is to do.
    fn default() -> Self {
        Self {
            most: u64::MAX,
            goes_on: &|| true,
        }
    }
}

impl Work<'_> {
    /// Whether there is more to do than may be done, after `done` and `drawn` faces.
    #[inline]
    fn is_over(&self, done: u64, drawn: usize) -> bool {
        done > self.most || (drawn.is_multiple_of(FACES_BETWEEN_LOOKS) && !(self.goes_on)())
    }
}

/// The faces in the order of drawing; vertices with more faces than `most_walked` are hubs. `None` where that is more
/// work than may be done.
fn face_numbers(faces: Faces<'_>, most_walked: u32, work: &Work<'_>) -> Option<Vec<u32>> {
    let mut open = OpenFaces::new(faces);
    let mut hubs = Hubs::new(&mut open, most_walked);
    match hubs.is_empty() {
        true => traverse::<false>(&mut open, &mut hubs, work),
        false => traverse::<true>(&mut open, &mut hubs, work),
    }
}

/// Draws all faces; without `HAS_HUBS` no vertex is asked whether it is a hub.
fn traverse<const HAS_HUBS: bool>(
    open: &mut OpenFaces<'_>,
    hubs: &mut Hubs,
    work: &Work<'_>,
) -> Option<Vec<u32>> {
    let face_count = open.corners.len();
    let mut new_to_old = Vec::with_capacity(face_count);
    let mut in_file_order = 0..index32(face_count);
    let mut recent = RecentVertices::default();
    let mut best = BestFace::default();
    let mut done = 0_u64;

    loop {
        // At a dead end, go on in file order.
        let next = match best.score > 0.0 {
            true => Some(best.face),
            false => in_file_order.find(|&face| !open.is_drawn(face)),
        };
        let Some(face) = next else { break };
        if work.is_over(done, new_to_old.len()) {
            return None;
        }

        // Draw it.
        new_to_old.push(face);
        let corners = open.corners[face as usize];
        if HAS_HUBS {
            hubs.draw(open, face);
        }
        open.draw(face);
        recent.draw(corners);
        if HAS_HUBS {
            hubs.enter(open, corners);
        }

        // Score the vertices again whose place changed, and with them their faces.
        best = BestFace::default();
        for (scores, &number) in VERTEX_SCORES.iter().zip(recent.with_those_that_left()) {
            let vertex = &mut open.vertices[number as usize];
            if vertex.live == 0 {
                continue;
            }
            let change = vertex.set_score(scores);
            if HAS_HUBS && vertex.is_hub() {
                done += hubs.change(open, number, change, &mut best);
                continue;
            }
            let (start, live) = (vertex.start as usize, vertex.live as usize);
            done += u64::from(vertex.live);
            for &face in &open.rows[start..start + live] {
                let score = &mut open.scores[face as usize];
                *score += change;
                best.offer(*score, face);
            }
        }
        if HAS_HUBS {
            hubs.leave(open, &recent);
        }
    }
    Some(new_to_old)
}
