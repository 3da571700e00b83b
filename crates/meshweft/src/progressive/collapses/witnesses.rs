//! Points that left, each at the face nearest to it.

use super::fan::Fan;
use super::patch::Patch;
use super::remaining::{NONE, RemainingMesh};
use crate::geometry::double::sub;

/// Most witnesses of a face.
const MOST: usize = 4;

/// The removed points, in a list a face.
#[derive(Debug, Default)]
pub(super) struct Witnesses {
    /// The first witness of each face.
    first: Vec<u32>,
    /// The next one after each point.
    next: Vec<u32>,
    /// Those of the fan that is looked at, relative to its point, which comes first.
    seen: Vec<(u32, [f64; 3])>,
    /// Of each of them: the nearest of the faces that stay, the squared distance from it, and the point.
    nearest: Vec<(u32, f64, u32)>,
}

impl Witnesses {
    pub(super) fn new(faces: usize, points: usize) -> Self {
        Self {
            first: vec![NONE; faces],
            next: vec![NONE; points],
            ..Self::default()
        }
    }

    /// Gathers the witnesses of a fan.
    pub(super) fn gather(&mut self, fan: &Fan, rest: &RemainingMesh<'_>, point: u32) {
        self.seen.clear();
        self.seen.push((point, [0.0; 3]));
        let center = rest.position(point);
        for face in &fan.faces {
            let mut witness = self.first[face.face() as usize];
            while witness != NONE {
                self.seen
                    .push((witness, sub(rest.position(witness), center)));
                witness = self.next[witness as usize];
            }
        }
    }

    /// The greatest squared distance of the point and the witnesses from `stay`, the faces that stay, and the
    /// mean.
    pub(super) fn squares(&self, stay: &Patch) -> (f64, f64) {
        let (mut farthest, mut sum) = (0.0_f64, 0.0);
        for &(_, witness) in &self.seen {
            let square = stay.square(witness);
            farthest = farthest.max(square);
            sum += square;
        }
        (farthest, sum / self.seen.len() as f64)
    }

    /// Gives the point and the witnesses gathered last to the faces that stay, by number in `stay`.
    pub(super) fn hand_over(&mut self, fan: &Fan, stay: &Patch) {
        for face in &fan.faces {
            self.first[face.face() as usize] = NONE;
        }
        self.nearest.clear();
        for &(point, witness) in &self.seen {
            if let Some((square, face)) = stay.nearest(witness) {
                self.nearest.push((face, square, point));
            }
        }

        // Of too many, the farthest stay.
        self.nearest.sort_unstable_by(|a, b| {
            let far = b.1.total_cmp(&a.1);
            a.0.cmp(&b.0).then(far).then(a.2.cmp(&b.2))
        });
        for of_a_face in self.nearest.chunk_by(|a, b| a.0 == b.0) {
            for &(face, _, point) in of_a_face.iter().take(MOST) {
                let first = &mut self.first[face as usize];
                self.next[point as usize] = std::mem::replace(first, point);
            }
        }
    }
}

/// The greatest squared distance of the middles of new edges and faces from the faces of the fan, which are
/// `old`, if the point moves to a neighbour.
pub(super) fn farthest_middle(fan: &Fan, old: &Patch, to: u32, step: [f64; 3]) -> f64 {
    let mut farthest = 0.0_f64;
    for (_, &[a, b]) in fan.staying(to) {
        let third = [0, 1, 2].map(|i| (step[i] + a[i] + b[i]) / 3.0);
        let half = [0, 1, 2].map(|i| (step[i] + a[i]) / 2.0);
        farthest = farthest.max(old.square(third)).max(old.square(half));
    }
    farthest
}
