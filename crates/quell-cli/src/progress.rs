//! Progress bars of maps and reproductions, on standard error if that is a terminal.

use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use quell::sweep::Progress;
use quell_reproduce::EntryProgress;

use crate::answer::print_error;

/// Template of the bar of a computation.
const TEMPLATE: &str =
    "{bar:32} {human_pos}/{human_len} points  {per_sec}  {elapsed} elapsed, {eta} left";

/// Template of the bar of a report.
const ANSWERS: &str = "{bar:32} {pos}/{len} answers  {elapsed} elapsed";

/// Template of the bar of a reproduction.
const ENTRIES: &str = "{bar:32} {pos}/{len}  {elapsed} elapsed  {msg}";

/// The bar of a computation.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar that is not shown yet; it is never shown if standard error is not a terminal.
    pub(crate) fn new() -> Self {
        Self { bar: bar(0, TEMPLATE) }
    }

    /// The same over the answers of a report.
    pub(crate) fn of_answers() -> Self {
        Self { bar: bar(0, ANSWERS) }
    }
}

/// A progress bar, which `indicatif` hides if standard error is not a terminal.
fn bar(length: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

impl Progress for Bar {
    fn begin(&self, points: usize, there: usize) {
        self.bar.set_length(points as u64);
        self.bar.set_position(there as u64);
        // The rate counts points computed now, not those already in the store.
        self.bar.reset_eta();
        self.bar.enable_steady_tick(Duration::from_millis(500));
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
        let bar = bar(count as u64, ENTRIES);
        bar.enable_steady_tick(Duration::from_millis(500));
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
