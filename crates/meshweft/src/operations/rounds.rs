//! Rounds of improvement, and one progress for all meshes of all rounds.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::counts::VERTEX_SIZE;
use crate::cache;
use crate::faces::Faces;
use crate::order::vertex_fetch;
use crate::permutation::VertexOrder;
use crate::progress::Progress;

/// Most rounds. Each but the last gains something, so they end by themselves, nearly always after two
/// to four; this bounds the time where gains are tiny.
const MAX_ROUNDS: u32 = 64;

/// Runs rounds until one changes nothing; each says whether it changed anything. Whether the caller
/// stopped it.
///
/// A second round starts from another state and may find another order; it is taken if it misses
/// less. The last round finds nothing, and a run on its output starts with just that round: it changes
/// nothing. What runs once only is not idempotent.
pub(super) fn improve_until_settled(
    caller: &dyn Progress,
    faces: usize,
    runs_once: bool,
    mut round: impl FnMut(&Round<'_>) -> bool,
) -> bool {
    let is_stopped = AtomicBool::new(false);
    let rounds = if runs_once { 1 } else { MAX_ROUNDS };
    for number in 0..rounds {
        let heard = Round::new(caller, faces, (!runs_once).then_some(number), &is_stopped);
        let is_changed = round(&heard);
        if !is_changed || heard.is_stopped() {
            break;
        }
    }
    // Finished: the answer no longer matters.
    let _ = caller.report(1.0);
    is_stopped.into_inner()
}

/// The vertices in the order of their first use, if that moves any: where faces moved, or where it
/// fetches less.
pub(super) fn better_vertex_order(faces: Faces<'_>, faces_moved: bool) -> Option<VertexOrder> {
    let order = vertex_fetch(faces);
    if order.is_identity() {
        return None;
    }
    let fetches_less = || {
        let renumbered = order.renumber(faces.as_slice());
        cache::overfetch(&renumbered, VERTEX_SIZE) < cache::overfetch(faces, VERTEX_SIZE)
    };
    (faces_moved || fetches_less()).then_some(order)
}

/// Progress of one round, of all its meshes together.
pub(super) struct Round<'a> {
    caller: &'a dyn Progress,
    /// Faces of all meshes, and how many of them are done.
    faces: usize,
    done: AtomicUsize,
    /// The fraction at which the round starts, and what it adds.
    start: f64,
    span: f64,
    is_stopped: &'a AtomicBool,
}

impl<'a> Round<'a> {
    /// Round `number`, or `None` for a single one. How many will follow is unknown, so each takes half
    /// of what is left.
    pub(super) fn new(
        caller: &'a dyn Progress,
        faces: usize,
        number: Option<u32>,
        is_stopped: &'a AtomicBool,
    ) -> Self {
        let (start, span) = match number {
            Some(number) => {
                let left = 0.5_f64.powi(number.min(60).cast_signed());
                (1.0 - left, left / 2.0)
            }
            None => (0.0, 1.0),
        };
        Self {
            caller,
            faces,
            done: AtomicUsize::new(0),
            start,
            span,
            is_stopped,
        }
    }

    /// Progress of some of the faces.
    pub(super) fn part(&'a self, faces: usize) -> PartOfRound<'a> {
        PartOfRound {
            round: self,
            faces,
            before: self.done.load(Ordering::Relaxed),
            told: AtomicUsize::new(0),
        }
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    fn fraction_of_faces(&self, faces: usize) -> f64 {
        faces as f64 / self.faces.max(1) as f64
    }
}

/// Progress of some faces of a round.
pub(super) struct PartOfRound<'a> {
    round: &'a Round<'a>,
    faces: usize,
    /// How many faces of the round were done before these.
    before: usize,
    told: AtomicUsize,
}

impl PartOfRound<'_> {
    /// All of it is done.
    pub(super) fn finish(&self) {
        let _ = self.report(1.0);
    }
}

impl Progress for PartOfRound<'_> {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a share of a number of faces"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a fraction is not negative")]
        let now = (fraction.clamp(0.0, 1.0) * self.faces as f64) as usize;
        let told = self.told.fetch_max(now, Ordering::Relaxed);
        let more = now.saturating_sub(told);
        let done = self.round.done.fetch_add(more, Ordering::Relaxed) + more;

        let done = self.round.fraction_of_faces(done).min(1.0);
        let fraction = self.round.start + self.round.span * done;
        if self.round.caller.report(fraction).is_break() {
            self.round.is_stopped.store(true, Ordering::Relaxed);
        }
        match self.round.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// The part's own time. An overrun of earlier parts shortens it; time they saved extends it.
    fn time_spent(&self) -> Option<f64> {
        let spent = self.round.caller.time_spent()?;
        let before = self.round.fraction_of_faces(self.before);
        let share = self.round.fraction_of_faces(self.faces);
        Some(((spent - before) / share.max(f64::MIN_POSITIVE)).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[derive(Default)]
    struct Listener {
        heard: Mutex<Vec<f64>>,
        stop_at: Option<f64>,
    }

    impl Progress for Listener {
        fn report(&self, fraction: f64) -> ControlFlow<()> {
            self.heard.lock().unwrap().push(fraction);
            match self.stop_at.is_some_and(|stop| fraction >= stop) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        }

        fn time_spent(&self) -> Option<f64> {
            Some(0.5)
        }
    }

    #[test]
    fn parts_and_rounds_add_up() {
        let (listener, is_stopped) = (Listener::default(), AtomicBool::new(false));
        for number in 0..2 {
            let round = Round::new(&listener, 100, Some(number), &is_stopped);
            let (small, large) = (round.part(20), round.part(80));
            let _ = small.report(0.5);
            large.finish();
            small.finish();
            small.finish();
        }
        let expected = [0.05, 0.45, 0.5, 0.5, 0.525, 0.725, 0.75, 0.75];
        let heard = listener.heard.into_inner().unwrap();
        assert_eq!(heard.len(), expected.len());
        for (heard, expected) in heard.into_iter().zip(expected) {
            assert!((heard - expected).abs() < 1e-9, "{heard} {expected}");
        }
    }

    #[test]
    fn what_one_part_hears_stops_all() {
        let listener = Listener {
            stop_at: Some(0.3),
            ..Listener::default()
        };
        let is_stopped = AtomicBool::new(false);
        let round = Round::new(&listener, 100, None, &is_stopped);
        assert!(round.part(20).report(1.0).is_continue());
        assert!(round.part(20).report(0.5).is_break());
        assert!(round.part(60).report(0.0).is_break());
        assert!(round.is_stopped());
    }

    #[test]
    fn a_part_has_its_share_of_the_time() {
        let (listener, is_stopped) = (Listener::default(), AtomicBool::new(false));
        let round = Round::new(&listener, 100, None, &is_stopped);
        let first = round.part(40);
        assert_eq!(first.time_spent(), Some(1.25));
        first.finish();
        assert!((round.part(20).time_spent().unwrap() - 0.5).abs() < 1e-9);
    }
}
