//! Options from JSON, reports to JSON.

use crate::errors;
use pyo3::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Reads options.
pub(crate) fn options<T: DeserializeOwned>(py: Python<'_>, text: &str) -> PyResult<T> {
    serde_json::from_str(text).map_err(|cause| errors::of_options(py, &cause))
}

/// Writes a report.
pub(crate) fn json(py: Python<'_>, report: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(report).map_err(|cause| errors::internal(py, &cause.to_string()))
}
