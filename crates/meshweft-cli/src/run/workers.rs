//! How many files are worked on at once, and how many threads work on each.

use anyhow::{Context, Result};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::arguments::{MOST_THREADS, Run};
use crate::usage::Usage;

/// How many threads do what.
pub(super) struct Workers {
    /// Files worked on at once.
    pub(super) jobs: usize,
    /// Threads for each of them.
    threads: usize,
}

impl Workers {
    /// What was asked for; what was not is the cores shared out among `files`.
    ///
    /// # Errors
    /// More than [`MOST_THREADS`] for all jobs together.
    pub(super) fn new(run: &Run, files: usize) -> Result<Self, Usage> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let cores = cores.min(MOST_THREADS);

        // As many jobs as the cores have room for, then as many threads as the jobs leave.
        let asked_threads = run.threads.map_or(1, usize::from);
        let jobs = run.jobs.map_or((cores / asked_threads).max(1), usize::from);
        let jobs = jobs.min(files.max(1));
        let threads = run.threads.map_or(cores.div_ceil(jobs), usize::from);

        match jobs * threads <= MOST_THREADS {
            true => Ok(Self { jobs, threads }),
            false => Err(Usage(format!(
                "{jobs} jobs of {threads} threads each are more than {MOST_THREADS} threads: ask for \
                 fewer --jobs or --threads"
            ))),
        }
    }

    /// A new pool of threads for one file.
    pub(super) fn pool(&self) -> Result<ThreadPool> {
        let pool = ThreadPoolBuilder::new().num_threads(self.threads).build();
        pool.context("no threads to work with")
    }
}
