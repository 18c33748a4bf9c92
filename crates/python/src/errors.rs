//! Errors of the facade as exceptions of the package.

use pyo3::prelude::*;
use seamstress::{Error, ErrorCategory};
use serde_json::json;

/// The exception for an error.
pub(crate) fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let class = match error.kind().category() {
        ErrorCategory::Input | ErrorCategory::Usage => "InputError",
        ErrorCategory::Stopped => "Stopped",
        _ => "NoCertifiedMap",
    };
    let fields = json!({
        "code": error.code(),
        "stage": error.stage().map(|stage| stage.name()),
        "elements": error.elements(),
        "hint": error.hint(),
        "findings": error.findings(),
    });
    raised(py, class, &error.to_string(), &fields.to_string())
}

/// The exception for options that cannot be read.
pub(crate) fn of_options(py: Python<'_>, cause: &serde_json::Error) -> PyErr {
    // Where in the text it is helps no one who gave keywords.
    let text = cause.to_string();
    let message = text.split(" at line ").next().unwrap_or(&text);
    raised(py, "InputError", message, r#"{"code": "options"}"#)
}

/// The exception for work that has been left behind because it did not stop in time.
pub(crate) fn stopped(py: Python<'_>, code: &str, message: &str) -> PyErr {
    raised(py, "Stopped", message, &json!({ "code": code }).to_string())
}

/// The exception for a fault of this program.
pub(crate) fn internal(py: Python<'_>, message: &str) -> PyErr {
    let fields = json!({ "code": "internal", "hint": "please report this with the mesh" });
    raised(py, "NoCertifiedMap", message, &fields.to_string())
}

fn raised(py: Python<'_>, class: &str, message: &str, fields: &str) -> PyErr {
    let made = py
        .import("seamstress_mesh._errors")
        .and_then(|errors| errors.call_method1("made", (class, message, fields)));
    made.map_or_else(|error| error, PyErr::from_value)
}
