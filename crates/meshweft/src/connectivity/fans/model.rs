//! What is likely, by tables of what is known around.

use super::fan_model::{FanModel, Outlook};
use super::lazy_tables::LazyTables;
use super::traversal::{FanTurn, Gap, Run};
use crate::bits::{AdaptiveTable, Lane, Mean, NumberCoder, Port};
use crate::index::index32;

/// More known faces at a root are all the same.
const MOST_AT_ROOT: u32 = 10;
/// More known faces at the vertex from which faces go on are all the same for a turn.
const MOST_AT_TURN: u32 = 6;
/// How many kinds of surplus are told apart, and of ends of a gap.
const SURPLUSES: usize = 3;
const ENDS: usize = 6;
/// Faces are coded in a lane of their own.
pub(super) const LANE: Lane = Lane::ALL[0];

/// Tables for all that is coded.
#[derive(Debug)]
pub(crate) struct TableModel {
    /// Of runs, by how many faces the root has.
    by_root: Vec<AdaptiveTable>,
    /// The same, by the surplus and both ends of the gap too. With more kinds of them, most meshes have too few faces of
    /// each kind to learn from.
    by_ends: LazyTables,
    /// Of turns, by direction.
    turns: [AdaptiveTable; 2],
    /// The same, by the faces known where they go on.
    turns_by_from: LazyTables,
    /// Whether a vertex is new.
    newness: AdaptiveTable,
    /// Which vertex, if it is near one of the ends.
    nearness: AdaptiveTable,
    /// How far a vertex is before the last one, if it is near none of the ends.
    far: NumberCoder,
}

impl FanModel for TableModel {
    const MOST_NEW: usize = 7;
    const LOOKS: bool = false;

    fn new() -> Self {
        let roots = 2 * MOST_AT_ROOT as usize;
        Self {
            by_root: vec![AdaptiveTable::EVEN; roots],
            by_ends: LazyTables::new(roots * SURPLUSES * ENDS),
            turns: [AdaptiveTable::EVEN; 2],
            turns_by_from: LazyTables::new(2 * (MOST_AT_TURN as usize + 1)),
            newness: AdaptiveTable::EVEN,
            nearness: AdaptiveTable::EVEN,
            far: NumberCoder::NEW,
        }
    }

    #[inline]
    fn run(&mut self, port: &mut impl Port, gap: &Gap, _: Outlook, run: Run) -> Run {
        // Which table.
        let [at_root, from, to] = gap.known;
        let at_root = at_root.clamp(1, MOST_AT_ROOT) - 1;
        let root = 2 * at_root as usize + usize::from(gap.is_backward);
        let surplus = 1 + gap.surplus.signum();
        let ends = 3 * usize::from(from > 4) + usize::from(to > 2) + usize::from(to > 4);
        let place = (root * SURPLUSES + surplus.unsigned_abs() as usize) * ENDS + ends;
        let parent = &mut self.by_root[root];
        let table = self.by_ends.get_or_insert_with(place, || parent.child());

        // The symbol.
        let symbol = 2 * run.new.min(Self::MOST_NEW) + usize::from(run.is_end);
        let symbol = port.code(LANE, table, symbol);
        if table.is_young() {
            parent.see(symbol);
        }
        table.see(symbol);
        Run {
            new: symbol / 2,
            is_end: symbol % 2 == 1,
            goes_on: false,
        }
    }

    #[inline]
    fn turn(&mut self, port: &mut impl Port, gap: &Gap, _: [u8; 2], turn: usize) -> FanTurn {
        self.turn_with(port, gap, None, turn)
    }

    /// A vertex after the root that was met.
    fn known(&mut self, port: &mut impl Port, root: u32, count: u32, vertex: u32) -> u32 {
        let (after_root, before_last) = (
            vertex.wrapping_sub(root + 1),
            (count - 1).wrapping_sub(vertex),
        );
        let near = match (after_root, before_last) {
            (0..8, _) => after_root,
            (_, 0..7) => 8 + before_last,
            _ => 15,
        };
        let near = port.code(LANE, &self.nearness, near as usize);
        self.nearness.see(near);
        match index32(near) {
            near @ 0..8 => root + 1 + near,
            near @ 8..15 => (count - 1).wrapping_sub(near - 8),
            _ => (count - 1).wrapping_sub(self.far.code(port, before_last)),
        }
    }

    /// A corner of a face that follows no other.
    fn corner(
        &mut self,
        port: &mut impl Port,
        root: u32,
        count: u32,
        vertex: Option<u32>,
    ) -> Option<u32> {
        let is_known = port.code(LANE, &self.newness, usize::from(vertex.is_some()));
        self.newness.see(is_known);
        (is_known != 0).then(|| self.known(port, root, count, vertex.unwrap_or(0)))
    }
}

impl TableModel {
    /// A turn, by the mean of two tables if there is another one.
    #[inline]
    pub(super) fn turn_with(
        &mut self,
        port: &mut impl Port,
        gap: &Gap,
        other: Option<(&mut LazyTables, usize)>,
        turn: usize,
    ) -> FanTurn {
        let backward = usize::from(gap.is_backward);
        let from = gap.known[1].min(MOST_AT_TURN);
        let place = 2 * from as usize + backward;
        let parent = &mut self.turns[backward];
        let table = self
            .turns_by_from
            .get_or_insert_with(place, || parent.child());
        let turn = match other {
            None => port.code(LANE, table, turn),
            Some((others, place)) => {
                let other = others.get_or_insert_with(place, || parent.child());
                let turn = port.code(LANE, &Mean(table, other), turn);
                other.see(turn);
                turn
            }
        };
        if table.is_young() {
            parent.see(turn);
        }
        table.see(turn);
        FanTurn::ALL.get(turn).copied().unwrap_or(FanTurn::Stop)
    }
}
