//! Errors measured on the surfaces that a front has.
//!
//! A mesh is simplified in an order of costs, which also keeps the hierarchy shallow. A front has another order: at a tolerance
//! whatever has a smaller error has left. So what is around a point when it leaves differs, and with it the distance.

use super::replay::Replay;
use crate::index::index32;
use crate::topology::half_edges::NONE;

/// What an error is, once it was measured again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measure {
    /// What was found now.
    Now,
    /// The larger one of before and now.
    Larger,
}

impl Replay<'_> {
    /// Measures all errors once more, where points leave in the order of their errors so far, as a tolerance that grows has it.
    ///
    /// Everything has to be collapsed, and is again. Those below are contained, as before.
    pub(super) fn measure(&mut self, measure: Measure) {
        let order = self.order_of_errors();
        self.split_all();
        for number in order {
            let error = self.collapse_again(number);
            let node = &mut self.nodes[self.made[number as usize].point as usize];
            match measure {
                Measure::Now => node.error = error,
                Measure::Larger => {
                    node.error = node.error.max(error);
                    self.contain_measured(number);
                }
            }
        }
        self.contain_below();
    }

    /// The collapses in the order of the least tolerances at which their points are not active: they neither fail nor are needed
    /// by one that is.
    fn order_of_errors(&self) -> Vec<u32> {
        // The collapse of each point and of each face.
        let mut of_point = vec![NONE; self.positions.len()];
        let mut of_face = vec![NONE; self.edges.len() / 3];
        for (number, made) in (0..).zip(&self.made) {
            of_point[made.point as usize] = number;
            for face in made.edge.faces() {
                of_face[face as usize] = number;
            }
        }

        // What a collapse needs came after it when the mesh was built.
        let error = |point: u32| self.nodes[point as usize].error;
        let mut tolerances: Vec<f32> = self.made.iter().map(|it| error(it.point)).collect();
        for (number, made) in self.made.iter().enumerate() {
            let tolerance = tolerances[number];
            let parent = self.nodes[made.point as usize].parent;
            let around = made.edge.faces_around(&self.edges);
            let needed = around.map(|face| of_face[face as usize]);
            for needed in needed.chain([of_point[parent as usize]]) {
                if let Some(other) = tolerances.get_mut(needed as usize) {
                    *other = other.max(tolerance);
                }
            }
        }

        let mut order: Vec<u32> = (0..index32(tolerances.len())).collect();
        order.sort_by(|&a, &b| tolerances[a as usize].total_cmp(&tolerances[b as usize]));
        order
    }
}
