//! The orders that a document was given, added up.

use crate::index::index32;
use crate::permutation::{FaceOrder, VertexOrder};

/// All orders that were applied, as one; empty where nothing was moved or turned.
#[derive(Debug, Default)]
pub(super) struct RecordOrders {
    pub(super) records: Vec<u32>,
    pub(super) rotations: Vec<u8>,
    pub(super) vertices: Vec<u32>,
}

impl RecordOrders {
    /// Whether everything is where it was.
    pub(super) fn is_empty(&self) -> bool {
        self.records.is_empty() && self.rotations.is_empty() && self.vertices.is_empty()
    }

    pub(super) fn add_faces(&mut self, order: &FaceOrder) {
        if order.is_identity() {
            return;
        }
        if !self.rotations.is_empty() || !order.rotations().is_empty() {
            let earlier = |old: u32| self.rotations.get(old as usize).copied().unwrap_or(0);
            let turned = |(new, &old)| (earlier(old) + order.rotation(new)) % 3;
            self.rotations = order.new_to_old().iter().enumerate().map(turned).collect();
        }
        self.records = composed(&self.records, order.new_to_old());
    }

    pub(super) fn add_vertices(&mut self, order: &VertexOrder) {
        if !order.is_identity() {
            self.vertices = composed(&self.vertices, order.new_to_old());
        }
    }

    /// The new number of each vertex; empty if they keep theirs.
    pub(super) fn old_to_new(&self) -> Vec<u32> {
        let mut old_to_new = vec![0; self.vertices.len()];
        for (new, &old) in self.vertices.iter().enumerate() {
            old_to_new[old as usize] = index32(new);
        }
        old_to_new
    }

    /// How far the corners of the record that goes to `slot` are turned.
    pub(super) fn rotation(&self, slot: usize) -> usize {
        usize::from(self.rotations.get(slot).copied().unwrap_or(0))
    }
}

/// `new_to_old` after `earlier`, which is empty if it changes nothing.
fn composed(earlier: &[u32], new_to_old: &[u32]) -> Vec<u32> {
    if earlier.is_empty() {
        return new_to_old.to_vec();
    }
    let through = new_to_old.iter().map(|&middle| earlier[middle as usize]);
    through.collect()
}

/// The entry of `order`, or `slot` itself where the order is empty.
pub(super) fn record_in(order: &[u32], slot: usize) -> usize {
    order.get(slot).map_or(slot, |&record| record as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::permutation::Permutation;

    #[test]
    fn orders_add_up() {
        let order = |new_to_old, rotations| {
            FaceOrder::new(Permutation::new(new_to_old).unwrap(), rotations).unwrap()
        };
        let (first, second) = (
            order(vec![2, 0, 1], vec![1, 0, 2]),
            order(vec![1, 2, 0], vec![2, 1, 1]),
        );
        let mut orders = RecordOrders::default();
        orders.add_faces(&first);
        orders.add_faces(&second);
        let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let both = order(orders.records, orders.rotations);
        assert_eq!(both.apply(&faces), second.apply(&first.apply(&faces)));
    }
}
