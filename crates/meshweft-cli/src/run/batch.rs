//! Many files at once: handed out to threads, reported in the order of the command line.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use anyhow::{Error, Result};

/// Runs `work` on each of `count` items on `jobs` threads, and `report` on each result in order.
///
/// Unless `keep_going`, no further item is begun after a failure.
///
/// # Errors
/// At once, that of a `report`; else at the end, the first failure of `work` in the order of the
/// items.
pub(super) fn run<T: Send>(
    count: usize,
    jobs: usize,
    keep_going: bool,
    work: impl Fn(usize) -> Result<T> + Sync,
    mut report: impl FnMut(usize, Result<&T, &Error>) -> Result<()>,
) -> Result<()> {
    let next = AtomicUsize::new(0);
    let is_stopped = AtomicBool::new(false);
    let (sender, results) = mpsc::channel();

    thread::scope(|scope| {
        // Each thread takes the next item, until none is left.
        for _ in 0..jobs.clamp(1, count.max(1)) {
            let (sender, next, is_stopped, work) = (sender.clone(), &next, &is_stopped, &work);
            scope.spawn(move || {
                while !is_stopped.load(Ordering::Relaxed) {
                    let item = next.fetch_add(1, Ordering::Relaxed);
                    if item >= count {
                        break;
                    }
                    let result = work(item);
                    if result.is_err() && !keep_going {
                        is_stopped.store(true, Ordering::Relaxed);
                    }
                    if sender.send((item, result)).is_err() {
                        break;
                    }
                }
            });
        }
        // The results end when the last thread has dropped its sender.
        drop(sender);

        let mut first_failure = None;
        let mut show = |item, result: Result<T>| -> Result<()> {
            let reported = report(item, result.as_ref());
            if reported.is_err() {
                // Nobody reads the reports any more: further work is of no use.
                is_stopped.store(true, Ordering::Relaxed);
            }
            if let Err(error) = result {
                first_failure.get_or_insert(error);
            }
            reported
        };

        // Results that come before their turn wait for it.
        let mut waiting = BTreeMap::new();
        let mut turn = 0;
        for (item, result) in results {
            waiting.insert(item, result);
            while let Some(result) = waiting.remove(&turn) {
                show(turn, result)?;
                turn += 1;
            }
        }

        // After a stop, items between may not have been begun.
        for (item, result) in waiting {
            show(item, result)?;
        }
        first_failure.map_or(Ok(()), Err)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_on_any_number_of_threads() {
        for jobs in [1, 2, 7] {
            let mut seen = Vec::new();
            let work = |i: usize| match i % 5 {
                3 => Err(Error::msg(i.to_string())),
                _ => Ok(i * i),
            };
            let done = run(40, jobs, true, work, |i, result| {
                seen.push((i, result.ok().copied()));
                Ok(())
            });
            let expected: Vec<_> = (0..40)
                .map(|i| (i, (i % 5 != 3).then_some(i * i)))
                .collect();
            assert_eq!(seen, expected);
            assert_eq!(done.unwrap_err().to_string(), "3", "the first failure");
        }
    }

    #[test]
    fn a_failure_stops_what_has_not_begun() {
        let mut seen = 0;
        let work = |i: usize| match i {
            2 => Err(Error::msg("no")),
            _ => Ok(()),
        };
        let done = run(1000, 1, false, work, |_, _| {
            seen += 1;
            Ok(())
        });
        assert!(done.is_err());
        assert_eq!(seen, 3);
        assert!(run(0, 4, false, |_| Ok(()), |_, _| Ok(())).is_ok());
    }
}
