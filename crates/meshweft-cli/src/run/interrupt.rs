//! Ctrl-C: the program ends between two writes, never within one.

use std::sync::{RwLock, RwLockReadGuard};

/// Held for reading by each thread that writes a file, for writing by the one that ends the program.
static WRITES: RwLock<()> = RwLock::new(());

/// The exit code of a program ended by Ctrl-C: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

/// From now on a signal waits for the files that are being written, then ends the program; a second
/// one ends it at once.
pub(super) fn watch() {
    let mut is_second = false;
    // Without a handler the signal ends the program as it always does: no reason to fail.
    let _ = ctrlc::set_handler(move || {
        if std::mem::replace(&mut is_second, true) {
            std::process::exit(INTERRUPTED);
        }
        // On a thread of its own, so that a second signal is heard while this one waits.
        std::thread::spawn(|| {
            let _no_writes = WRITES.write();
            eprintln!("interrupted: every file is as it was, or whole");
            std::process::exit(INTERRUPTED);
        });
    });
}

/// While this is held the program is not ended.
pub(super) fn hold_off() -> RwLockReadGuard<'static, ()> {
    WRITES.read().unwrap_or_else(|lock| lock.into_inner())
}
