//! Errors of the trainer as an exception of Python.

use frikan_trainer::error::Error;
use pyo3::exceptions::{PyException, PyRuntimeError};
use pyo3::prelude::*;

pyo3::create_exception!(
    frikan,
    FrikanError,
    PyException,
    "A recording, image or request that cannot be used; `code` is stable, as `trainer explain` takes it."
);

/// An error as an exception with its parts as attributes.
pub fn raise(py: Python<'_>, error: &Error) -> PyErr {
    let raised = FrikanError::new_err(error.to_string());
    let value = raised.value(py);
    let told = value
        .setattr("code", error.code().id)
        .and_then(|()| value.setattr("exit_status", error.exit_status()))
        .and_then(|()| value.setattr("file", error.file()))
        .and_then(|()| value.setattr("row", error.row()))
        .and_then(|()| value.setattr("column", error.column()))
        .and_then(|()| value.setattr("value", error.value()));
    told.err().unwrap_or(raised)
}

/// The exception of work whose thread has gone.
pub fn gone() -> PyErr {
    PyRuntimeError::new_err("the trainer has ended with an internal error")
}
