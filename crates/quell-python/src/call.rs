//! Work without the interpreter's lock, on a thread of its own, so that Ctrl-C is heard meanwhile.
//!
//! Python delivers signals to its main thread alone. There the work goes to another thread and the
//! main thread looks for signals twenty times a second; elsewhere nobody can interrupt, and the work
//! is done where it was called for. A panic ends neither: it becomes a failure that says so.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread::{self, ThreadId};
use std::time::Duration;

use pyo3::prelude::*;
use quell::Failure;

use crate::errors;

/// How often signals are looked for.
const TICK: Duration = Duration::from_millis(50);

/// Stack of the thread that works: as large as that of a main thread.
const STACK: usize = 8 << 20;

/// What is told meanwhile, and what is asked to stop.
pub(crate) trait Watch {
    /// Called now and then while the work goes on.
    ///
    /// # Errors
    /// Whatever shall end the work.
    fn tick(&mut self, py: Python<'_>) -> PyResult<()>;
    /// The work shall stop; whether it will, soon.
    fn stop(&self) -> bool;
}

/// Nobody watches: what cannot be stopped goes on unheard until it ends, and its result is dropped.
struct Nobody;

impl Watch for Nobody {
    fn tick(&mut self, _py: Python<'_>) -> PyResult<()> {
        Ok(())
    }

    fn stop(&self) -> bool {
        false
    }
}

/// Does `work` without the interpreter's lock.
///
/// # Errors
/// What the work complains about, or a signal such as `KeyboardInterrupt`.
pub(crate) fn run<T, W>(py: Python<'_>, work: W) -> PyResult<T>
where
    T: Send + 'static,
    W: FnOnce() -> Result<T, Failure> + Send + 'static,
{
    watched(py, work, Nobody)
}

/// Does short `work` on this thread, without the interpreter's lock.
///
/// # Errors
/// What the work complains about.
pub(crate) fn here<T, W>(py: Python<'_>, work: W) -> PyResult<T>
where
    T: Send,
    W: FnOnce() -> Result<T, Failure> + Send,
{
    py.detach(|| guarded(work)).map_err(|failure| errors::raised(py, failure))
}

/// The same as [`run`], watched. After a signal the work is asked to stop, and waited for where it will, until there is
/// another signal.
///
/// # Errors
/// As [`run`], or what the watch refuses with.
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
        // Nobody listens any more after a signal.
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
                return Err(errors::raised(py, internal("the work ended without an answer")));
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

/// Waits for work that was asked to stop, until it has or there is another signal. What it says at the end is said by
/// the signal.
fn wait<T: Send>(py: Python<'_>, mut receiver: Receiver<T>) {
    loop {
        let (back, got) = py.detach(move || {
            let got = receiver.recv_timeout(TICK);
            (receiver, got)
        });
        receiver = back;
        let goes_on = matches!(got, Err(RecvTimeoutError::Timeout));
        if !goes_on || py.check_signals().is_err() {
            return;
        }
    }
}

/// Does the work; a panic becomes a failure.
fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(internal(&told(&*panic))))
}

fn told(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

fn internal(why: &str) -> Failure {
    Failure::Failed {
        key: "quell".to_owned(),
        why: format!("a fault of Quell, not of the study; please report it: {why}"),
    }
}

/// Whether this is the thread that Python gives signals to.
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
