//! Time that this thread was on a processor, so that other work on the machine does not count.

use std::fs;
use std::sync::OnceLock;
use std::thread;
use std::time::Instant;

/// Seconds since some moment: on a processor where the system tells, else of the wall clock.
pub(crate) fn seconds() -> f64 {
    static BEGAN: OnceLock<Instant> = OnceLock::new();
    let wall = || BEGAN.get_or_init(Instant::now).elapsed().as_secs_f64();
    processor().unwrap_or_else(wall)
}

fn processor() -> Option<f64> {
    // The system brings its account up to date where a thread gives way.
    thread::yield_now();
    let told = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = told.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
