//! How many files are worked on at once, and how many threads work on each.

use anyhow::{Context, Result};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::arguments::Run;

/// How many threads do what.
pub(super) struct Workers {
    /// Files worked on at once.
    pub(super) jobs: usize,
    /// For each file.
    threads: usize,
}

impl Workers {
    /// What was asked for, or the cores shared out.
    pub(super) fn new(run: &Run, files: usize) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let jobs = run.jobs.map_or(cores, usize::from).min(files.max(1));
        let threads = run.threads.map_or(cores.div_ceil(jobs), usize::from);
        Self { jobs, threads }
    }

    /// The threads for a file.
    pub(super) fn threads(&self) -> Result<ThreadPool> {
        let threads = ThreadPoolBuilder::new().num_threads(self.threads).build();
        threads.context("no threads to work with")
    }
}
