//! Medians of interleaved repetitions.

use std::hint::black_box;
use std::time::Instant;

/// The median time of each job in seconds, from `repetitions` rounds that run every job once.
///
/// Rounds are interleaved so that whatever else the machine does affects all jobs alike.
pub fn medians<const N: usize, T>(
    repetitions: usize,
    mut jobs: [&mut dyn FnMut() -> T; N],
) -> [f64; N] {
    let medians = medians_of(repetitions, &mut jobs);
    medians.try_into().expect("a median for each job")
}

/// As [`medians`], for any number of jobs.
pub fn medians_of<T>(repetitions: usize, jobs: &mut [impl FnMut() -> T]) -> Vec<f64> {
    let mut seconds = vec![Vec::new(); jobs.len()];
    for _ in 0..repetitions.max(1) {
        for (job, seconds) in jobs.iter_mut().zip(&mut seconds) {
            let start = Instant::now();
            black_box(job());
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    seconds.into_iter().map(median).collect()
}

/// The median time of three runs in seconds (of one, if it takes long), and what the last one made.
pub fn timed<T>(mut job: impl FnMut() -> T) -> (f64, T) {
    let mut seconds = Vec::new();
    loop {
        let start = Instant::now();
        let made = job();
        seconds.push(start.elapsed().as_secs_f64());
        if seconds.len() == 3 || seconds[0] > 2.0 {
            return (median(seconds), made);
        }
    }
}

/// The middle value, the upper of two; 0 of none.
#[must_use]
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
