//! Signals: Ctrl-C ends the process, and a file that may not grow is an error like any other.
//!
//! A verb that can stop by itself, so that nothing that is done is lost, is asked to by the first Ctrl-C; where it does not
//! within [`PATIENCE`], or after a second one, the process ends. Any other verb ends at once. A file is never half-written
//! then: what is being written is finished first.
//!
//! SIGTERM and SIGHUP are as Ctrl-C.

use std::fs;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use quell::output;

use crate::answer;

/// Exit status of a process that was interrupted: 128 and the number of SIGINT, as a shell says it.
const INTERRUPTED: i32 = 130;

/// How long a verb that can stop by itself has for it.
const PATIENCE: Duration = Duration::from_secs(10);

/// How long a file that is being written has to be finished.
const LAST_FILE: Duration = Duration::from_secs(2);

/// Raised by the first signal.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether the verb looks at the flag.
static HEARD: AtomicBool = AtomicBool::new(false);

/// Handles signals from now on.
pub(crate) fn handle() {
    refuse_growth_softly();
    // Under nohup a hang-up must not end the process. Without a handler signals do what they ever do, which loses no
    // finished chunk either.
    if hangups_are_ignored() {
        return;
    }
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) || !HEARD.load(Ordering::Relaxed) {
            end();
        }
        answer::tell(
            "\nstopping after the work in progress; press Ctrl-C again to stop immediately\n",
        );
        let _ = thread::Builder::new().spawn(|| {
            thread::sleep(PATIENCE);
            end();
        });
    });
}

/// The flag that a signal raises, for a verb that stops when it is.
pub(crate) fn flag() -> &'static AtomicBool {
    HEARD.store(true, Ordering::Relaxed);
    &STOP
}

/// Whether whoever started the process asked for SIGHUP, signal 1, to be ignored. Where the system does not say, it is not.
fn hangups_are_ignored() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok()).is_some_and(|it| it & 1 == 1)
}

fn end() -> ! {
    output::close(LAST_FILE);
    process::exit(INTERRUPTED);
}

/// Where a limit (`ulimit -f`) keeps a file from growing, the write fails and is told, in place of SIGXFSZ, which ends the
/// process amidst it: the signal is blocked, here and so in every thread.
#[cfg(unix)]
fn refuse_growth_softly() {
    use nix::sys::signal::{SigSet, Signal};
    let mut signals = SigSet::empty();
    signals.add(Signal::SIGXFSZ);
    // Where it cannot be blocked, the signal does what it ever does.
    let _ = signals.thread_block();
}

#[cfg(not(unix))]
fn refuse_growth_softly() {}
