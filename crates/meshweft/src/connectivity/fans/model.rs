//! What is likely, by tables of what is known around.

use super::fan_model::{FanModel, Outlook};
use super::lazy_tables::LazyTables;
use super::traversal::{FanTurn, Gap, Run};
use crate::bits::{AdaptiveTable, Lane, Port, SYMBOLS};
use crate::index::index32;

/// More known faces at a root, at the first neighbour and at the other end are all the same.
const MOST_KNOWN: [u32; 3] = [10, 6, 8];
/// A larger surplus, or shortage, is all the same.
const MOST_SURPLUS: i32 = 3;
/// Faces are coded in a lane of their own.
pub(super) const LANE: Lane = Lane::ALL[0];

/// Tables for all that is coded.
#[derive(Debug)]
pub(crate) struct TableModel {
    /// Of runs, by how many faces the root has.
    by_root: Vec<AdaptiveTable>,
    /// The same, by both ends of the gap too.
    by_ends: LazyTables,
    /// The same, by the surplus and one end.
    by_surplus: LazyTables,
    /// Of turns, by direction.
    turns: [AdaptiveTable; 2],
    /// The same, by both ends of the gap too.
    turns_by_ends: LazyTables,
    /// Whether a vertex is new.
    newness: AdaptiveTable,
    /// Which vertex, if it is near one of the ends.
    nearness: AdaptiveTable,
    /// How many bits a number has, beyond 15 by the second.
    lengths: [AdaptiveTable; 2],
}

impl FanModel for TableModel {
    const MOST_NEW: usize = 7;
    const LOOKS: bool = false;

    fn new() -> Self {
        let [root, from, to] = MOST_KNOWN.map(|most| most as usize);
        let surplus = 2 * MOST_SURPLUS.unsigned_abs() as usize + 1;
        Self {
            by_root: vec![AdaptiveTable::EVEN; 2 * root],
            by_ends: LazyTables::new(2 * root * from * (to + 1)),
            by_surplus: LazyTables::new(2 * root * surplus * (to + 1)),
            turns: [AdaptiveTable::EVEN; 2],
            turns_by_ends: LazyTables::new(2 * (from + 1) * (to + 1)),
            newness: AdaptiveTable::EVEN,
            nearness: AdaptiveTable::EVEN,
            lengths: [AdaptiveTable::EVEN; 2],
        }
    }

    /// A run; the mean of two tables says what is likely.
    #[inline]
    fn run(&mut self, port: &mut impl Port, gap: &Gap, _: Outlook, run: Run) -> Run {
        // Which tables.
        let place = |side: usize| gap.known[side].clamp(1, MOST_KNOWN[side]) as usize - 1;
        let [_, froms, tos] = MOST_KNOWN.map(|most| most as usize);
        let tos = tos + 1;
        let to = gap.known[2].min(MOST_KNOWN[2]) as usize;
        let root = usize::from(gap.is_backward) * MOST_KNOWN[0] as usize + place(0);
        let surplus = gap.surplus.clamp(-MOST_SURPLUS, MOST_SURPLUS) + MOST_SURPLUS;
        let surpluses = 2 * MOST_SURPLUS.unsigned_abs() as usize + 1;
        let by_surplus = (root * surpluses + surplus.unsigned_abs() as usize) * tos + to;

        let parent = &mut self.by_root[root];
        let by_ends = (root * froms + place(1)) * tos + to;
        let ends = self.by_ends.get_or_insert_with(by_ends, || parent.child());
        let surplus = self
            .by_surplus
            .get_or_insert_with(by_surplus, || parent.child());

        // The symbol.
        let symbol = 2 * run.new.min(Self::MOST_NEW) + usize::from(run.is_end);
        let symbol = port.code(LANE, &ends.with(surplus), symbol);
        if ends.is_young() {
            parent.see(symbol);
        }
        ends.see(symbol);
        surplus.see(symbol);
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
            _ => (count - 1).wrapping_sub(self.number(port, before_last)),
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
        let [_, froms, tos] = MOST_KNOWN.map(|most| most as usize);
        let from = gap.known[1].min(MOST_KNOWN[1]) as usize;
        let to = gap.known[2].min(MOST_KNOWN[2]) as usize;
        let parent = &mut self.turns[backward];
        let by_ends = (backward * (froms + 1) + from) * (tos + 1) + to;
        let table = self
            .turns_by_ends
            .get_or_insert_with(by_ends, || parent.child());
        let turn = match other {
            None => port.code(LANE, table, turn),
            Some((others, place)) => {
                let other = others.get_or_insert_with(place, || parent.child());
                let turn = port.code(LANE, &table.with(other), turn);
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

    /// A number: how many bits follow the first one that is set in it plus one, then these.
    fn number(&mut self, port: &mut impl Port, number: u32) -> u32 {
        let above = u64::from(number) + 1;
        let mut length = above.ilog2() as usize;
        let most = SYMBOLS - 1;
        let short = port.code(LANE, &self.lengths[0], length.min(most));
        self.lengths[0].see(short);
        length = match short == most {
            true => {
                let more = port.code(LANE, &self.lengths[1], length.saturating_sub(most));
                self.lengths[1].see(more);
                most + more
            }
            false => short,
        };

        // Four bits a symbol, the last ones first.
        let mut value = 0_u64;
        for shift in (0..length).step_by(4) {
            let width = (length - shift).min(4);
            let bits = (above >> shift) & ((1 << width) - 1);
            let bits = usize::try_from(bits).unwrap_or(0);
            let bits = port.code(LANE, &AdaptiveTable::EVEN, bits << (4 - width)) >> (4 - width);
            value |= (bits as u64) << shift;
        }
        let value = (value | 1 << length) - 1;
        u32::try_from(value).unwrap_or(u32::MAX)
    }
}
