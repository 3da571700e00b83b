//! Timer and progress bar for one file.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use meshweft::Progress;

/// Work that takes less is over before a bar is of use.
const SHOWN_AFTER: Duration = Duration::from_secs(1);
/// Positions of the bar: tenths of a percent.
const STEPS: u32 = 1000;

/// Watches over the work on one file.
pub(crate) struct Watch {
    start: Instant,
    /// How long the search of the file may take, whatever the effort.
    time: Option<Duration>,
    bar: ProgressBar,
}

impl Watch {
    /// Starts now; a bar is shown on standard error if that is a terminal and it is wanted.
    pub(crate) fn new(time: Option<Duration>, shows_bar: bool) -> Self {
        let style = ProgressStyle::with_template("{bar:40} {percent} %, {elapsed}");
        let bar = match shows_bar {
            true => ProgressBar::new(STEPS.into()),
            false => ProgressBar::hidden(),
        };
        Self {
            start: Instant::now(),
            time,
            bar: bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())),
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Watch {
    fn report(&self, fraction: f64) -> ControlFlow<()> {
        if !self.bar.is_hidden() && self.start.elapsed() > SHOWN_AFTER {
            #[expect(clippy::cast_possible_truncation, reason = "a fraction of a thousand")]
            #[expect(clippy::cast_sign_loss, reason = "a fraction is not negative")]
            self.bar.set_position((fraction * f64::from(STEPS)) as u64);
        }
        ControlFlow::Continue(())
    }

    fn time_spent(&self) -> Option<f64> {
        // Never 0, by which it is divided.
        let time = self.time?.as_secs_f64().max(f64::MIN_POSITIVE);
        Some(self.start.elapsed().as_secs_f64() / time)
    }
}
