//! Ctrl-C: the first asks the work to stop, the second ends the process.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::answer;

/// Raised by the first Ctrl-C (or SIGTERM).
static STOP: AtomicBool = AtomicBool::new(false);

/// The flag that Ctrl-C raises, from now on.
pub(crate) fn flag() -> &'static AtomicBool {
    // Without a handler Ctrl-C ends the process as ever, which loses no finished chunk either.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            process::exit(1);
        }
        answer::tell("\nstopping after what is running; once more ends at once\n");
    });
    &STOP
}
