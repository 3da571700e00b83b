//! Faces moved along chains of parts, until all parts have their size again.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::parts::{Parts, part16};
use crate::index::index32;

/// A part that a chain reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Step {
    part: u16,
    /// The number of the step before; [`NOWHERE`] for the first one.
    from: u32,
    /// The face that comes from the part before.
    face: u32,
}

/// As the number of a step: there is none.
const NOWHERE: u32 = u32::MAX;

/// What a chain costs for each vertex that a step adds, and for each step.
const VERTEX: u32 = 8;
const STEP: u32 = 1;

/// Looks for chains.
struct ChainSearch<'a, 'b> {
    parts: &'a mut Parts<'b>,
    /// The faces of each part that may move.
    members: Vec<Vec<u32>>,
    /// The steps whose cost is settled, and the parts that they reach.
    steps: Vec<Step>,
    is_reached: Vec<bool>,
    /// Steps by what the chain up to them costs.
    open: BinaryHeap<Reverse<(u32, Step)>>,
    /// The parts around one, each with the face that adds fewest vertices there, and how many.
    around: Vec<(u16, i32, u32)>,
}

/// Moves a face out of each part that has one too many, and so on along a chain of parts to one that has
/// one too few: along the chain that adds fewest vertices. Returns whether all parts have their size then.
///
/// Time O(faces · log faces) a chain at most; chains are mostly short.
pub(super) fn balance(parts: &mut Parts<'_>) -> bool {
    let part_count = parts.excess().len();
    let mut members = vec![Vec::new(); part_count];
    for &face in parts.movable() {
        members[usize::from(parts.part(face))].push(face);
    }
    let mut balance = ChainSearch {
        parts,
        members,
        steps: Vec::new(),
        is_reached: vec![false; part_count],
        open: BinaryHeap::new(),
        around: Vec::new(),
    };
    for part in 0..part_count {
        while balance.parts.excess()[part] > 0 {
            let Some(end) = balance.chain_from(part16(part)) else {
                return false;
            };
            balance.shift_along(end);
        }
    }
    true
}

impl ChainSearch<'_, '_> {
    /// The last step of the cheapest chain from a part to one that has too few faces (E. Dijkstra: *A Note
    /// on Two Problems in Connexion with Graphs*, 1959, doi:10.1007/BF01386390).
    fn chain_from(&mut self, part: u16) -> Option<Step> {
        for step in self.steps.drain(..) {
            self.is_reached[usize::from(step.part)] = false;
        }
        self.open.clear();
        let start = Step {
            part,
            from: NOWHERE,
            face: 0,
        };
        self.open.push(Reverse((0, start)));

        while let Some(Reverse((cost, step))) = self.open.pop() {
            let part = usize::from(step.part);
            if std::mem::replace(&mut self.is_reached[part], true) {
                continue;
            }
            self.steps.push(step);
            if self.parts.excess()[part] < 0 {
                return Some(step);
            }
            self.look_around(step.part);
            let from = index32(self.steps.len() - 1);
            for &(part, added, face) in &self.around {
                let cost = cost + VERTEX * added.max(0).unsigned_abs() + STEP;
                self.open.push(Reverse((cost, Step { part, from, face })));
            }
        }
        None
    }

    /// Finds the parts around one that are not reached yet and have room.
    fn look_around(&mut self, from: u16) {
        self.around.clear();
        for &face in &self.members[usize::from(from)] {
            for part in self.parts.around(face) {
                if self.is_reached[usize::from(part)] {
                    continue;
                }
                let Some(change) = self.parts.change(face, part) else {
                    continue;
                };
                let found = (part, change.added(), face);
                match self.around.iter_mut().find(|(known, ..)| *known == part) {
                    Some(known) => *known = found.min(*known),
                    None => self.around.push(found),
                }
            }
        }
    }

    /// Moves the faces of a chain, the last one first: so each part has room for what comes.
    fn shift_along(&mut self, end: Step) {
        let mut step = end;
        while step.from != NOWHERE {
            let before = self.steps[step.from as usize];
            self.parts.shift(step.face, step.part);
            self.members[usize::from(before.part)].retain(|&face| face != step.face);
            self.members[usize::from(step.part)].push(step.face);
            step = before;
        }
    }
}
