//! How far a map or a reproduction is: a bar on standard error where that is a terminal.

use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use quell::sweep::Progress;
use quell_reproduce::EntryProgress;

use crate::answer::tell;

/// What the bar shows.
const TEMPLATE: &str =
    "{bar:32} {human_pos}/{human_len} points  {per_sec}  {elapsed} elapsed, {eta} left";

/// What the bar of a reproduction shows.
const ENTRIES: &str = "{bar:32} {pos}/{len}  {elapsed} elapsed  {msg}";

/// A bar.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar that is not shown yet; never where standard error is no terminal.
    pub(crate) fn new() -> Self {
        Self { bar: bar(0, TEMPLATE) }
    }
}

/// Hidden by itself where standard error is no terminal.
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
        // The rate counts what is computed now, not what was there.
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

/// A bar over the entries of a reproduction, with what is being made; a line for each where there is no terminal.
#[derive(Debug)]
pub(crate) struct Entries {
    bar: ProgressBar,
    /// Names of those begun and not done.
    making: Mutex<Vec<&'static str>>,
}

impl Entries {
    /// A bar over so many.
    pub(crate) fn new(count: usize) -> Self {
        let bar = bar(count as u64, ENTRIES);
        bar.enable_steady_tick(Duration::from_millis(500));
        Self { bar, making: Mutex::default() }
    }

    /// Hears of one begun or done.
    pub(crate) fn hear(&self, step: EntryProgress) {
        let Ok(mut making) = self.making.lock() else { return };
        match step {
            EntryProgress::Begun(entry) => making.push(entry.name),
            EntryProgress::Done(done) => {
                making.retain(|name| *name != done.entry.name);
                self.bar.inc(1);
                if self.bar.is_hidden() {
                    let seconds = done.elapsed.as_secs_f64();
                    tell(&format!(
                        "{:>9}  {:6.2} s  {}\n",
                        done.entry.name, seconds, done.entry.about
                    ));
                }
            }
        }
        self.bar.set_message(making.join(", "));
    }

    /// Takes the bar away.
    pub(crate) fn end(&self) {
        self.bar.finish_and_clear();
    }
}
