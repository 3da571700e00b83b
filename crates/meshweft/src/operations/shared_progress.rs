//! One progress for all the meshes of a document.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::progress::Progress;

/// Progress of all faces together.
pub(super) struct SharedProgress<'a> {
    caller: &'a dyn Progress,
    /// How many faces there are, and how many of them are done.
    faces: usize,
    done: AtomicUsize,
    is_stopped: AtomicBool,
}

impl<'a> SharedProgress<'a> {
    /// Nothing is done of `faces` faces.
    pub(super) fn new(caller: &'a dyn Progress, faces: usize) -> Self {
        Self {
            caller,
            faces,
            done: AtomicUsize::new(0),
            is_stopped: AtomicBool::new(false),
        }
    }

    /// Progress of some of the faces.
    pub(super) fn part(&'a self, faces: usize) -> PartProgress<'a> {
        PartProgress {
            whole: self,
            faces,
            before: self.done.load(Ordering::Relaxed),
            told: AtomicUsize::new(0),
        }
    }

    /// Whether the caller limits the time.
    pub(super) fn is_timed(&self) -> bool {
        self.caller.time_spent().is_some()
    }

    /// Whether the caller stopped it.
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    /// All is done: the caller's answer no longer matters. Whether it stopped the work before.
    pub(super) fn finish(self) -> bool {
        let _ = self.caller.report(1.0);
        self.is_stopped.into_inner()
    }

    fn fraction_of_faces(&self, faces: usize) -> f64 {
        faces as f64 / self.faces.max(1) as f64
    }
}

/// Progress of some of the faces.
pub(super) struct PartProgress<'a> {
    whole: &'a SharedProgress<'a>,
    faces: usize,
    /// How many of all faces were done before these.
    before: usize,
    told: AtomicUsize,
}

impl PartProgress<'_> {
    /// All of it is done.
    pub(super) fn finish(&self) {
        let _ = self.report(1.0);
    }
}

impl Progress for PartProgress<'_> {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a share of a number of faces"
        )]
        #[expect(clippy::cast_sign_loss, reason = "a fraction is not negative")]
        let now = (fraction.clamp(0.0, 1.0) * self.faces as f64) as usize;
        let told = self.told.fetch_max(now, Ordering::Relaxed);
        let more = now.saturating_sub(told);
        let done = self.whole.done.fetch_add(more, Ordering::Relaxed) + more;

        let fraction = self.whole.fraction_of_faces(done).min(1.0);
        if self.whole.caller.report(fraction).is_break() {
            self.whole.is_stopped.store(true, Ordering::Relaxed);
        }
        match self.whole.is_stopped() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// The part's own time. An overrun of earlier parts shortens it; time they saved extends it.
    fn time_spent(&self) -> Option<f64> {
        let spent = self.whole.caller.time_spent()?;
        let before = self.whole.fraction_of_faces(self.before);
        let share = self.whole.fraction_of_faces(self.faces);
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
    fn parts_add_up() {
        let listener = Listener::default();
        let whole = SharedProgress::new(&listener, 100);
        let (small, large) = (whole.part(20), whole.part(80));
        let _ = small.report(0.5);
        large.finish();
        small.finish();
        small.finish();
        assert!(!whole.finish());
        let expected = [0.1, 0.9, 1.0, 1.0, 1.0];
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
        let whole = SharedProgress::new(&listener, 100);
        assert!(whole.part(20).report(1.0).is_continue());
        assert!(whole.part(20).report(0.5).is_break());
        assert!(whole.part(60).report(0.0).is_break());
        assert!(whole.is_stopped() && whole.finish());
    }

    #[test]
    fn a_part_has_its_share_of_the_time() {
        let listener = Listener::default();
        let whole = SharedProgress::new(&listener, 100);
        let first = whole.part(40);
        assert_eq!(first.time_spent(), Some(1.25));
        first.finish();
        assert!((whole.part(20).time_spent().unwrap() - 0.5).abs() < 1e-9);
    }
}
