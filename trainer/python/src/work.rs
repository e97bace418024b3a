//! Long work beside Python: the lock is free meanwhile, Ctrl-C ends it, a callback is told how far it is.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use frikan_trainer::error::Error;
use pyo3::prelude::*;

use crate::failure::{gone, raise};

/// Time between two looks for Ctrl-C.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// A line of progress: stage, steps, error.
type Line = (String, usize, Option<f64>);

/// How the work tells how far it is.
pub struct Progress {
    lines: Mutex<Sender<Line>>,
    is_cancelled: Arc<AtomicBool>,
}

/// What the stack of cancelled work is unwound with.
struct Cancelled;

impl Progress {
    /// Tells what is being done; ends the work where nobody waits for it any more.
    pub fn tell(&self, stage: &str, steps: usize, error: Option<f64>) {
        if self.is_cancelled.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Cancelled));
        }
        if let Ok(lines) = self.lines.lock() {
            // Lines that nobody reads any more are lost with the work.
            let _ = lines.send((stage.to_owned(), steps, error));
        }
    }
}

/// Does work on a thread of its own, and hands its progress to `callback` on this one, where exceptions of Python come up.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    callback: Option<Py<PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let is_cancelled = Arc::new(AtomicBool::new(false));
    let (lines, told) = channel();
    let progress = Progress { lines: Mutex::new(lines), is_cancelled: Arc::clone(&is_cancelled) };
    let (done, result) = channel();
    std::thread::spawn(move || {
        // Cancelled work and work that panics have nothing to hand over.
        if let Ok(outcome) = catch_unwind(AssertUnwindSafe(|| work(&progress))) {
            let _ = done.send(outcome);
        }
    });
    let waited = wait(py, result, &told, callback.as_ref());
    is_cancelled.store(true, Ordering::Relaxed);
    waited.and_then(|outcome| outcome.map_err(|error| raise(py, &error)))
}

fn wait<T: Send>(
    py: Python<'_>,
    result: Receiver<Result<T, Error>>,
    told: &Receiver<Line>,
    callback: Option<&Py<PyAny>>,
) -> PyResult<Result<T, Error>> {
    let result = Mutex::new(result);
    loop {
        let next = py.detach(|| result.lock().map_err(drop).map(|result| result.recv_timeout(LOOK_EVERY)));
        match next {
            Ok(Ok(outcome)) => return Ok(outcome),
            Ok(Err(RecvTimeoutError::Disconnected)) | Err(_) => return Err(gone()),
            Ok(Err(RecvTimeoutError::Timeout)) => {}
        }
        py.check_signals()?;
        if let (Some(callback), Some(line)) = (callback, told.try_iter().last()) {
            callback.call1(py, line)?;
        }
    }
}
