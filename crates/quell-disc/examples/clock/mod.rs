//! Processor time of the current thread, so that other work on the machine does not count.

use std::fs;
use std::sync::OnceLock;
use std::thread;
use std::time::Instant;

/// Seconds since an arbitrary origin: processor time where the system reports it, otherwise wall-clock time.
pub(crate) fn seconds() -> f64 {
    static BEGAN: OnceLock<Instant> = OnceLock::new();
    let wall = || BEGAN.get_or_init(Instant::now).elapsed().as_secs_f64();
    processor().unwrap_or_else(wall)
}

fn processor() -> Option<f64> {
    // The system updates its statistics when a thread yields.
    thread::yield_now();
    let statistics = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = statistics.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
