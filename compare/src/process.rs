//! What a process costs.

use std::io;
use std::process::{Command, Stdio};

/// What a process cost that has ended.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// Its user time in seconds.
    pub user: f64,
    /// The time in seconds that the system spent for it.
    pub system: f64,
    /// The most memory that it had resident, in kilobytes.
    pub peak: f64,
}

/// Runs a command, silent and without input, and waits for it; `None` if it does not end well.
///
/// # Errors
/// It cannot be started or waited for.
pub fn run(command: &mut Command) -> io::Result<Option<Cost>> {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null());
    let child = command.stderr(Stdio::null()).spawn()?;
    let pid = libc::pid_t::try_from(child.id()).map_err(io::Error::other)?;
    let mut status = 0;
    // SAFETY: a record of numbers, of which any may be 0.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: it writes to both places and keeps neither. The child is not waited for elsewhere.
    let ended = unsafe { libc::wait4(pid, &raw mut status, 0, &raw mut usage) };
    if ended != pid {
        return Err(io::Error::last_os_error());
    }
    let seconds = |time: libc::timeval| time.tv_sec as f64 + time.tv_usec as f64 / 1e6;
    let cost = Cost {
        user: seconds(usage.ru_utime),
        system: seconds(usage.ru_stime),
        peak: usage.ru_maxrss as f64,
    };
    Ok((status == 0).then_some(cost))
}

/// The processor time in seconds that this process has taken so far, by all its threads.
///
/// # Panics
/// If there is no such clock.
#[must_use]
pub fn own_seconds() -> f64 {
    let mut time = libc::timespec {
        tv_sec: 0,
        tv_nsec: 0,
    };
    // SAFETY: it writes to the record and does not keep it.
    let failed = unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &raw mut time) };
    assert_eq!(failed, 0, "no clock of this process");
    time.tv_sec as f64 + time.tv_nsec as f64 / 1e9
}
