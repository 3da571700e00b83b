//! What is likely, by chances that are mixed from what is known around and how vertices lie.

use super::fan_model::{FanModel, Outlook};
use super::lazy_tables::LazyTables;
use super::model::{LANE, TableModel};
use super::traversal::{FanTurn, Gap, Run};
use crate::bits::{BitChances, LogOdds, Port, Weights, code_mixed, even_weights};

/// How many chances are mixed.
const INPUTS: usize = 4;

/// More known faces at a root, at the first neighbour and at the other end are all the same.
const MOST_KNOWN: [u32; 3] = [9, 5, 7];
const ROOTS: usize = 2 * 10;
const FROMS: usize = 6;
const TOS: usize = 8;
const FEW_TOS: usize = 4;
/// A larger surplus, or shortage, is all the same.
const MOST_SURPLUS: i32 = 3;
const SURPLUSES: usize = 7;

/// How many chances each input has.
const SIZES: [usize; INPUTS] = [
    ROOTS * FROMS * TOS,
    ROOTS * SURPLUSES * FEW_TOS,
    ROOTS * 2 * Outlook::REACHES,
    2 * Outlook::ANGLES * Outlook::REACHES,
];

/// Chances of what a run is.
#[derive(Debug)]
pub(crate) struct MixedModel {
    /// By input and what it says: whether a vertex is new, and else whether the gap is closed.
    chances: [Vec<BitChances>; INPUTS],
    weights: Vec<[Weights<INPUTS>; 2]>,
    log_odds: LogOdds,
    /// Of turns, by direction, reach and what is beyond.
    turns: LazyTables,
    tables: TableModel,
    /// How far the other end of the gap was in the last run.
    reach: u8,
}

/// Coarser steps.
fn coarse(reach: u8) -> usize {
    usize::from(reach) / 2
}

impl FanModel for MixedModel {
    const MOST_NEW: usize = 1;
    const LOOKS: bool = true;

    fn new() -> Self {
        Self {
            chances: SIZES.map(|size| vec![BitChances::EVEN; size]),
            log_odds: LogOdds::new(),
            weights: vec![[even_weights(); 2]; ROOTS],
            turns: LazyTables::new(2 * 8 * 8 * 8),
            tables: TableModel::new(),
            reach: 0,
        }
    }

    #[inline]
    fn run(&mut self, port: &mut impl Port, gap: &Gap, outlook: Outlook, run: Run) -> Run {
        // Which chances.
        let known = |side: usize| gap.known[side].min(MOST_KNOWN[side]) as usize;
        let backward = usize::from(gap.is_backward || !gap.can_close());
        let root = 2 * known(0) + backward;
        let surplus = gap.surplus.clamp(-MOST_SURPLUS, MOST_SURPLUS) + MOST_SURPLUS;
        let surplus = surplus.unsigned_abs() as usize;
        let (reach, angle) = (usize::from(outlook.reach), usize::from(outlook.angle));
        let by = [
            (root * FROMS + known(1)) * TOS + known(2),
            (root * SURPLUSES + surplus) * FEW_TOS + known(2).min(FEW_TOS - 1),
            (root * 2 + known(2).min(1)) * Outlook::REACHES + reach,
            (backward * Outlook::ANGLES + angle) * Outlook::REACHES + reach,
        ];
        self.reach = outlook.reach;
        let [a, b, c, d] = &mut self.chances;
        let mut chances = [&mut a[by[0]], &mut b[by[1]], &mut c[by[2]], &mut d[by[3]]];
        let [new_weights, end_weights] = &mut self.weights[root];

        // Whether a vertex is new, and else whether the gap is closed.
        let is_new = run.new > 0;
        if code_mixed(
            port,
            LANE,
            &self.log_odds,
            &mut chances,
            0,
            new_weights,
            is_new,
        ) {
            return Run::ONE;
        }
        let is_end = code_mixed(
            port,
            LANE,
            &self.log_odds,
            &mut chances,
            1,
            end_weights,
            run.is_end,
        );
        Run {
            new: 0,
            is_end,
            goes_on: false,
        }
    }

    #[inline]
    fn turn(&mut self, port: &mut impl Port, gap: &Gap, beyond: [u8; 2], turn: usize) -> FanTurn {
        let mut place = usize::from(gap.is_backward);
        for step in [self.reach, beyond[0], beyond[1]] {
            place = 8 * place + coarse(step);
        }
        self.tables
            .turn_with(port, gap, Some((&mut self.turns, place)), turn)
    }

    fn known(&mut self, port: &mut impl Port, root: u32, count: u32, vertex: u32) -> u32 {
        self.tables.known(port, root, count, vertex)
    }

    fn corner(
        &mut self,
        port: &mut impl Port,
        root: u32,
        count: u32,
        vertex: Option<u32>,
    ) -> Option<u32> {
        self.tables.corner(port, root, count, vertex)
    }
}
