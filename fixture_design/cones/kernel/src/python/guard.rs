//! No panic crosses into Python, and Ctrl-C gets through to long work.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How often long work looks whether it should stop.
const PATIENCE: Duration = Duration::from_millis(100);

/// Panics are reported as exceptions; the crate prints nothing.
pub fn be_quiet() {
    std::panic::set_hook(Box::new(|_| {}));
}

/// The result of `work`, or a `KernelError` where it panics.
pub fn guarded<T>(py: Python<'_>, work: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(result) => result,
        Err(panic) => {
            let words = panic.downcast_ref::<String>().cloned();
            let words = words.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_string()));
            Err(error(py, "KernelError", words.unwrap_or_else(|| "no message".to_string())))
        }
    }
}

/// One of the package's exceptions, by name.
pub fn error(py: Python<'_>, name: &str, words: String) -> PyErr {
    let make = || -> PyResult<Bound<'_, PyAny>> { py.import("fixture_design.errors")?.getattr(name)?.call1((&words,)) };
    match make() {
        Ok(exception) => PyErr::from_value(exception),
        Err(_) => PyRuntimeError::new_err(words),
    }
}

pub fn cone_error(py: Python<'_>, words: String) -> PyErr {
    error(py, "ConeError", words)
}

/// Asks Python now and then whether a signal came; keeps the exception that it raised.
pub struct Signals {
    state: Mutex<(Instant, Option<PyErr>)>,
}

impl Signals {
    pub fn new() -> Self {
        Self { state: Mutex::new((Instant::now(), None)) }
    }

    pub fn stop(&self) -> bool {
        let Ok(mut state) = self.state.lock() else { return true };
        if state.0.elapsed() < PATIENCE {
            return false;
        }
        state.0 = Instant::now();
        if let Err(raised) = Python::attach(|py| py.check_signals()) {
            state.1 = Some(raised);
            return true;
        }
        false
    }

    pub fn raised(self) -> PyErr {
        let raised = self.state.into_inner().ok().and_then(|state| state.1);
        raised.unwrap_or_else(|| PyRuntimeError::new_err("interrupted"))
    }
}

/// For the test that no panic crosses.
#[pyfunction]
pub fn panic_on_purpose(py: Python<'_>) -> PyResult<()> {
    guarded(py, || py.detach(|| panic!("on purpose")))
}
