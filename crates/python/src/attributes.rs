//! What meshes carry, as tuples: name, on what it is, its kind, numbers in a row, rows as bytes, and names of labels.

use crate::arrays::{array, numbers};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use seamstress::{Attribute, AttributeDomain, AttributeKind};

/// An attribute as Python has it; of labels with names the row of each element is the number of its name.
pub(crate) type Told<'py> =
    (String, &'static str, &'static str, usize, Bound<'py, PyByteArray>, Vec<String>);
/// The same as it is given.
pub(crate) type Given = (String, String, String, usize, Vec<u8>, Vec<String>);

const DOMAINS: [(AttributeDomain, &str); 3] = [
    (AttributeDomain::Vertex, "vertex"),
    (AttributeDomain::Corner, "corner"),
    (AttributeDomain::Face, "face"),
];
const KINDS: [(AttributeKind, &str); 5] = [
    (AttributeKind::Number, "number"),
    (AttributeKind::Label, "label"),
    (AttributeKind::Uv, "uv"),
    (AttributeKind::Normal, "normal"),
    (AttributeKind::Color, "color"),
];

fn name_of<T: PartialEq>(all: &[(T, &'static str)], thing: T) -> &'static str {
    all.iter().find(|(known, _)| *known == thing).map_or("", |(_, name)| name)
}

fn of_name<T: Copy>(all: &[(T, &'static str)], name: &str) -> T {
    all.iter().find(|(_, known)| *known == name).map_or(all[0].0, |(thing, _)| *thing)
}

/// What is on vertices, corners or faces, by its name.
pub(crate) fn domain(name: &str) -> AttributeDomain {
    of_name(&DOMAINS, name)
}

/// Attributes for Python.
pub(crate) fn told<'py>(py: Python<'py>, all: &[Attribute]) -> PyResult<Vec<Told<'py>>> {
    let tell = |attribute: &Attribute| {
        let Attribute { name, domain, kind, width, rows, names, .. } = attribute;
        let values: Vec<f64> = match width {
            0 => rows.iter().map(|&row| f64::from(row)).collect(),
            _ => rows.iter().flat_map(|&row| attribute.row(row)).copied().collect(),
        };
        let (on, kind) = (name_of(&DOMAINS, *domain), name_of(&KINDS, *kind));
        Ok((name.clone(), on, kind, (*width).max(1), array(py, &values)?, names.clone()))
    };
    all.iter().map(tell).collect()
}

/// Attributes of Python.
pub(crate) fn given(all: Vec<Given>) -> Vec<Attribute> {
    let take = |(name, on, kind, width, values, names): Given| {
        let (domain, values) = (domain(&on), numbers::<f64>(&values));
        match names.is_empty() {
            true => Attribute::new(name, domain, of_name(&KINDS, &kind), width, values),
            false => {
                let rows = values.into_iter().map(|row| row as u32).collect();
                Attribute::labels(name, domain, names, rows)
            }
        }
    };
    all.into_iter().map(take).collect()
}
