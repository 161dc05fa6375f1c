//! Signals: Ctrl-C ends the process, and exceeding a file size limit is an ordinary error.
//!
//! A verb that can stop without losing finished work is asked to do so by the first Ctrl-C. If it does not stop within
//! [`PATIENCE`], or after a second Ctrl-C, the process ends. Any other verb ends immediately. In all cases a file that is being
//! written is completed first, what was kept is reported on standard error, the exit status is [`INTERRUPTED`], and no more
//! than three seconds pass.
//!
//! SIGTERM and SIGHUP are handled like Ctrl-C; a hang-up that is ignored when the process starts (`nohup`) stays ignored.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use quell::output;

use crate::answer;

/// Exit status of an interrupted process: 128 plus the number of SIGINT, as in shells.
pub(crate) const INTERRUPTED: u8 = 130;

/// Time that a verb has to stop after the first signal.
const PATIENCE: Duration = Duration::from_millis(1500);

/// Time to complete a file that is being written.
const LAST_FILE: Duration = Duration::from_millis(1200);

/// Set by the first signal.
static STOP: AtomicBool = AtomicBool::new(false);

/// Whether the verb checks [`STOP`].
static CHECKED: AtomicBool = AtomicBool::new(false);

/// What a verb keeps if it ends before it has stopped by itself.
type LastWords = Box<dyn Fn() -> String + Send>;

/// The last words of the verb; `None` where nothing is kept.
static LAST_WORDS: Mutex<Option<LastWords>> = Mutex::new(None);

/// Installs the signal handlers.
pub(crate) fn handle() {
    catch_file_size_signal();
    on_signals(|| {
        if STOP.swap(true, Ordering::Relaxed) || !CHECKED.load(Ordering::Relaxed) {
            end();
        }
        // First the deadline: writing the message may block.
        let _ = thread::Builder::new().spawn(|| {
            thread::sleep(PATIENCE);
            end();
        });
        answer::print_error(
            "\nstopping after the work in progress; press Ctrl-C again to stop immediately\n",
        );
    });
}

/// Acts on SIGINT, SIGTERM and SIGHUP, in a thread. If no handler can be installed, signals keep their default action.
#[cfg(unix)]
fn on_signals(act: impl Fn() + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    let ends =
        if hangups_are_ignored() { vec![SIGINT, SIGTERM] } else { vec![SIGINT, SIGTERM, SIGHUP] };
    if let Ok(mut signals) = Signals::new(ends) {
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

/// Whether a signal has asked the process to end.
pub(crate) fn is_stopping() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// Reports by these words what is kept if the process ends before the verb has stopped by itself.
pub(crate) fn keeping(words: impl Fn() -> String + Send + 'static) {
    *LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(words));
}

/// Whether the process was started with SIGHUP, signal 1, ignored; false on systems that do not provide this information.
#[cfg(unix)]
fn hangups_are_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 1 == 1)
}

fn end() -> ! {
    output::close(LAST_FILE);
    // A thread that writes the message may hold standard error indefinitely: the process ends without it then.
    let _ = thread::Builder::new().spawn(|| {
        thread::sleep(Duration::from_millis(200));
        process::exit(i32::from(INTERRUPTED));
    });
    let words = LAST_WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    let words = words.as_ref().map_or_else(|| "no results were kept".to_owned(), |words| words());
    answer::print_error(&format!("\nstopped; {words}\n"));
    process::exit(i32::from(INTERRUPTED));
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
