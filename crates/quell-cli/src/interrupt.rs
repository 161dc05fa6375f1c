//! Signals: Ctrl-C ends the process, and exceeding a file size limit is an ordinary error.
//!
//! A verb that can stop without losing finished work is asked to do so by the first Ctrl-C. If it does not stop within
//! [`PATIENCE`], or after a second Ctrl-C, the process exits. Any other verb exits immediately. In all cases a file that is
//! being written is completed first.
//!
//! SIGTERM and SIGHUP are handled like Ctrl-C.

use std::fs;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use quell::output;

use crate::answer;

/// Exit status of an interrupted process: 128 plus the number of SIGINT, as in shells.
const INTERRUPTED: i32 = 130;

/// Time that a verb has to stop after the first signal.
const PATIENCE: Duration = Duration::from_secs(10);

/// Time to complete a file that is being written.
const LAST_FILE: Duration = Duration::from_secs(2);

/// Set by the first signal.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether the verb checks [`STOP`].
static CHECKED: AtomicBool = AtomicBool::new(false);

/// Installs the signal handlers.
pub(crate) fn handle() {
    catch_file_size_signal();
    // Under nohup, a hang-up must not end the process. Without a handler, signals have their default action, which does not
    // lose finished chunks either.
    if hangups_are_ignored() {
        return;
    }
    on_signals(|| {
        if STOP.swap(true, Ordering::Relaxed) || !CHECKED.load(Ordering::Relaxed) {
            end();
        }
        answer::print_error(
            "\nstopping after the work in progress; press Ctrl-C again to stop immediately\n",
        );
        let _ = thread::Builder::new().spawn(|| {
            thread::sleep(PATIENCE);
            end();
        });
    });
}

/// Acts on SIGINT, SIGTERM and SIGHUP, in a thread. If no handler can be installed, signals keep their default action.
#[cfg(unix)]
fn on_signals(act: impl Fn() + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    if let Ok(mut signals) = Signals::new([SIGHUP, SIGINT, SIGTERM]) {
        let _ = thread::Builder::new().spawn(move || signals.forever().for_each(|_| act()));
    }
}

#[cfg(not(unix))]
fn on_signals(act: impl Fn() + Send + 'static) {
    let _ = ctrlc::set_handler(act);
}

/// The flag that is set by a signal, for a verb that stops when it is set.
pub(crate) fn flag() -> &'static AtomicBool {
    CHECKED.store(true, Ordering::Relaxed);
    &STOP
}

/// Whether the process was started with SIGHUP, signal 1, ignored; false on systems that do not provide this information.
fn hangups_are_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 1 == 1)
}

fn end() -> ! {
    output::close(LAST_FILE);
    process::exit(INTERRUPTED);
}

/// Catches SIGXFSZ. If a file exceeds the limit (`ulimit -f`), the write then fails with an error, instead of the signal ending the
/// process during the write.
#[cfg(unix)]
fn catch_file_size_signal() {
    let reached = std::sync::Arc::new(AtomicBool::new(false));
    // If it cannot be caught, the signal keeps its default action.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, reached);
}

#[cfg(not(unix))]
fn catch_file_size_signal() {}
