//! Progress of work that is done in stages.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::progress::Progress;

/// A stage of the work, from one fraction of it to another.
pub(super) struct Stage<'a> {
    caller: &'a dyn Progress,
    start: f64,
    end: f64,
    total: usize,
    done: AtomicUsize,
    is_stopped: AtomicBool,
}

impl<'a> Stage<'a> {
    /// With `total` pieces of work.
    pub(super) fn new(caller: &'a dyn Progress, start: f64, end: f64, total: usize) -> Self {
        Self {
            caller,
            start,
            end,
            total,
            done: AtomicUsize::new(0),
            is_stopped: AtomicBool::new(false),
        }
    }

    /// A part of it, from one fraction of the stage to another, with `total` pieces of work.
    pub(super) fn part(&self, start: f64, end: f64, total: usize) -> Stage<'_> {
        Stage::new(self, start, end, total)
    }

    /// So many more are done.
    pub(super) fn add(&self, count: usize) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        let _ = self.report(done as f64 / self.total.max(1) as f64);
    }

    /// Whether the caller stopped it.
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}

impl Progress for Stage<'_> {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        let fraction = self.start + fraction * (self.end - self.start);
        let go_on = self.caller.report(fraction);
        if go_on.is_break() {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
        go_on
    }

    fn time_spent(&self) -> Option<f64> {
        self.caller.time_spent()
    }
}
