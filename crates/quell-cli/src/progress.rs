//! How far a map is: a bar with rate and time left, on standard error where that is a terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use quell::sweep::Progress;

/// What the bar shows.
const TEMPLATE: &str =
    "{bar:32} {human_pos}/{human_len} points  {per_sec}  {elapsed} gone, {eta} left";

/// A bar.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar that is not shown yet; never where standard error is no terminal.
    pub(crate) fn new() -> Self {
        // Hidden by itself where standard error is no terminal.
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
            bar.set_style(style);
        }
        Self { bar }
    }
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
