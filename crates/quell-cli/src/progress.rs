//! Progress on standard error if that is a terminal: bars of work in many parts, and the elapsed time of any other verb that
//! takes longer than [`SHORT`].

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use quell::running::Progress;
use quell_reproduce::EntryProgress;

use crate::answer::print_error;
use crate::interrupt;

/// Template of the bar of a computation.
const TEMPLATE: &str =
    "{bar:32} {human_pos}/{human_len} points  {per_sec}  {elapsed} elapsed, {eta} left";

/// Template of the bar of a report.
const ANSWERS: &str = "{bar:32} {pos}/{len} answers  {elapsed} elapsed";

/// Template of the bar of a reproduction.
const ENTRIES: &str = "{bar:32} {pos}/{len}  {elapsed} elapsed  {msg}";

/// Template of a verb without a bar of its own.
const WAITING: &str = "{spinner} {msg}  {elapsed} elapsed; Ctrl-C stops it";

/// A verb that takes longer shows the elapsed time.
const SHORT: Duration = Duration::from_secs(2);

/// Interval of drawing.
const TICK: Duration = Duration::from_millis(500);

/// Whether a verb shows a bar of its own.
static HAS_BAR: AtomicBool = AtomicBool::new(false);

/// Does the work of a verb. The elapsed time is shown after [`SHORT`], unless the verb shows a bar of its own.
pub(crate) fn during<T>(verb: &str, work: impl FnOnce() -> T) -> T {
    let shown = bar(None, WAITING).with_message(verb.to_owned());
    if shown.is_hidden() {
        return work();
    }
    let (ended, end) = channel::<()>();
    // Without a thread nothing is shown.
    let shows = thread::Builder::new().spawn(move || {
        let mut pause = SHORT;
        while end.recv_timeout(pause) == Err(RecvTimeoutError::Timeout)
            && !HAS_BAR.load(Ordering::Relaxed)
        {
            shown.tick();
            pause = TICK;
        }
        shown.finish_and_clear();
    });
    let done = work();
    drop(ended);
    if let Ok(shows) = shows {
        // A panic of that thread concerns the display alone.
        let _ = shows.join();
    }
    done
}

/// The bar of a computation.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar that is not shown yet; it is never shown if standard error is not a terminal.
    pub(crate) fn new() -> Self {
        Self { bar: bar(Some(0), TEMPLATE) }
    }

    /// Reports the finished points, which are kept in a store, if the process ends before the work has stopped; `how` says how to
    /// continue it.
    pub(crate) fn keeps(&self, path: &Path, how: &'static str) {
        let (bar, path) = (self.bar.clone(), path.display().to_string());
        interrupt::keeping(move || {
            let (kept, all) = (bar.position(), bar.length().unwrap_or_default());
            let left = all.saturating_sub(kept);
            format!("{kept} of {all} points kept in {path}, {left} left: {how}")
        });
    }

    /// The same over the answers of a report.
    pub(crate) fn of_answers() -> Self {
        Self { bar: bar(Some(0), ANSWERS) }
    }
}

/// A progress bar, which `indicatif` hides if standard error is not a terminal.
fn bar(length: Option<u64>, template: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

impl Progress for Bar {
    fn begin(&self, points: usize, there: usize) {
        HAS_BAR.store(true, Ordering::Relaxed);
        self.bar.set_length(points as u64);
        self.bar.set_position(there as u64);
        // The rate counts points computed now, not those already in the store.
        self.bar.reset_eta();
        self.bar.enable_steady_tick(TICK);
    }

    fn advance(&self, points: usize) {
        self.bar.inc(points as u64);
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// A bar over the entries of a reproduction with the names of those in progress; one line per entry if there is no terminal.
#[derive(Debug)]
pub(crate) struct Entries {
    bar: ProgressBar,
    /// Names of the entries in progress.
    in_progress: Mutex<Vec<&'static str>>,
}

impl Entries {
    /// A bar over `count` entries.
    pub(crate) fn new(count: usize) -> Self {
        let bar = bar(Some(count as u64), ENTRIES);
        HAS_BAR.store(true, Ordering::Relaxed);
        bar.enable_steady_tick(TICK);
        Self { bar, in_progress: Mutex::default() }
    }

    /// Records that an entry was started or finished.
    pub(crate) fn update(&self, step: EntryProgress) {
        let Ok(mut in_progress) = self.in_progress.lock() else { return };
        match step {
            EntryProgress::Begun(entry) => in_progress.push(entry.name),
            EntryProgress::Done(done) => {
                in_progress.retain(|name| *name != done.entry.name);
                self.bar.inc(1);
                if self.bar.is_hidden() {
                    let seconds = done.elapsed.as_secs_f64();
                    print_error(&format!(
                        "{:>9}  {:6.2} s  {}\n",
                        done.entry.name, seconds, done.entry.about
                    ));
                }
            }
        }
        self.bar.set_message(in_progress.join(", "));
    }

    /// Removes the bar.
    pub(crate) fn end(&self) {
        self.bar.finish_and_clear();
    }
}
