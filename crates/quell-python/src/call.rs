//! Computations that release the interpreter's lock and run on a separate thread, so that Ctrl-C is handled in the meantime.
//!
//! Python delivers signals to its main thread only. A call from the main thread therefore runs on another thread, and the
//! main thread checks for signals twenty times per second. A call from any other thread cannot be interrupted and runs on
//! that thread. A panic does not end the process; it is converted to a failure.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread::{self, ThreadId};
use std::time::Duration;

use pyo3::prelude::*;
use quell::Failure;

use crate::errors;

/// Interval between checks for signals.
const TICK: Duration = Duration::from_millis(50);

/// Stack size of the working thread (bytes): that of a main thread.
const STACK: usize = 8 << 20;

/// An observer of running work, which can also ask it to stop.
pub(crate) trait Watch {
    /// Called repeatedly while the work is running.
    ///
    /// # Errors
    /// Any error that shall end the work.
    fn tick(&mut self, py: Python<'_>) -> PyResult<()>;
    /// Asks the work to stop; returns whether it will stop soon.
    fn stop(&self) -> bool;
}

/// No observer: after a signal the work continues in the background until it ends, and its result is dropped.
struct Unwatched;

impl Watch for Unwatched {
    fn tick(&mut self, _py: Python<'_>) -> PyResult<()> {
        Ok(())
    }

    fn stop(&self) -> bool {
        false
    }
}

/// Runs `work` without the interpreter's lock.
///
/// # Errors
/// The failure of the work, or a signal such as `KeyboardInterrupt`.
pub(crate) fn run<T, W>(py: Python<'_>, work: W) -> PyResult<T>
where
    T: Send + 'static,
    W: FnOnce() -> Result<T, Failure> + Send + 'static,
{
    watched(py, work, Unwatched)
}

/// Runs short `work` on this thread, without the interpreter's lock.
///
/// # Errors
/// The failure of the work.
pub(crate) fn here<T, W>(py: Python<'_>, work: W) -> PyResult<T>
where
    T: Send,
    W: FnOnce() -> Result<T, Failure> + Send,
{
    py.detach(|| guarded(work)).map_err(|failure| errors::raised(py, failure))
}

/// As [`run`], with an observer. After a signal the work is asked to stop; if it will stop soon, this function waits for it
/// until a second signal arrives.
///
/// # Errors
/// As [`run`], or an error of the observer.
pub(crate) fn watched<T, W>(py: Python<'_>, work: W, mut watch: impl Watch) -> PyResult<T>
where
    T: Send + 'static,
    W: FnOnce() -> Result<T, Failure> + Send + 'static,
{
    if !on_main_thread(py)? {
        let done = py.detach(|| guarded(work));
        watch.tick(py)?;
        return done.map_err(|failure| errors::raised(py, failure));
    }
    let (sender, mut receiver) = sync_channel(1);
    let thread = thread::Builder::new().name("quell".to_owned()).stack_size(STACK);
    let started = thread.spawn(move || {
        // After a signal the receiver may no longer exist.
        let _ = sender.send(guarded(work));
    });
    started.map_err(|why| {
        errors::raised(py, internal(&format!("no thread could be started: {why}")))
    })?;
    loop {
        let (back, got) = py.detach(move || {
            let got = receiver.recv_timeout(TICK);
            (receiver, got)
        });
        receiver = back;
        match got {
            Ok(done) => {
                watch.tick(py)?;
                return done.map_err(|failure| errors::raised(py, failure));
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(errors::raised(py, internal("the computation ended without a result")));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Err(signal) = py.check_signals().and_then(|()| watch.tick(py)) {
                    if watch.stop() {
                        wait(py, receiver);
                    }
                    return Err(signal);
                }
            }
        }
    }
}

/// Waits for work that was asked to stop, until it has stopped or another signal arrives. Its result is dropped; the caller
/// returns the signal.
fn wait<T: Send>(py: Python<'_>, mut receiver: Receiver<T>) {
    loop {
        let (back, got) = py.detach(move || {
            let got = receiver.recv_timeout(TICK);
            (receiver, got)
        });
        receiver = back;
        let is_running = matches!(got, Err(RecvTimeoutError::Timeout));
        if !is_running || py.check_signals().is_err() {
            return;
        }
    }
}

/// Runs the work; a panic is converted to a failure.
fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(internal(&message(&*panic))))
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

fn internal(why: &str) -> Failure {
    Failure::Failed {
        key: "quell".to_owned(),
        why: format!("internal error of Quell, not of the study; please report it: {why}").into(),
    }
}

/// Whether this is the thread to which Python delivers signals.
fn on_main_thread(py: Python<'_>) -> PyResult<bool> {
    static MAIN: OnceLock<ThreadId> = OnceLock::new();
    if let Some(main) = MAIN.get() {
        return Ok(*main == thread::current().id());
    }
    let threading = py.import("threading")?;
    let main = threading.call_method0("main_thread")?;
    let here = threading.call_method0("current_thread")?;
    let on_main = main.is(&here);
    if on_main {
        MAIN.get_or_init(|| thread::current().id());
    }
    Ok(on_main)
}
