//! What a check has found, element by element.

use seamstress_mesh::soup::{Fault, Severity as FaultSeverity};
use seamstress_parametrize::Violation;
use seamstress_parametrize::map::in_words;
use serde::Serialize;
use serde_json::{Map, Value};
use std::fmt;

/// Elements of a mesh, counted from 0.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Elements {
    /// Vertices.
    pub vertices: Vec<u32>,
    /// Edges, by their ends.
    pub edges: Vec<[u32; 2]>,
    /// Faces.
    pub faces: Vec<u32>,
}

impl Elements {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty() && self.edges.is_empty() && self.faces.is_empty()
    }

    pub(crate) fn extend(&mut self, other: &Self) {
        self.vertices.extend(&other.vertices);
        self.edges.extend(&other.edges);
        self.faces.extend(&other.faces);
    }

    /// The elements that the fields of a fault or violation name.
    fn of_fields(fields: &Map<String, Value>) -> Self {
        let id = |value: &Value| value.as_u64().and_then(|id| u32::try_from(id).ok());
        let ids = |value: &Value| -> Vec<u32> {
            value.as_array().map_or_else(Vec::new, |list| list.iter().filter_map(id).collect())
        };
        let mut found = Self::default();
        for (name, value) in fields {
            match name.as_str() {
                "vertex" => found.vertices.extend(id(value)),
                "face" | "first" => found.faces.extend(id(value)),
                "faces" => found.faces.extend(ids(value)),
                "vertices" | "edge" => found.edges.extend(<[u32; 2]>::try_from(ids(value))),
                _ => {}
            }
        }
        found
    }
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Severity {
    /// The work can go on.
    Warning,
    /// It cannot.
    Error,
}

/// One thing that a check has found.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// A stable name of its kind.
    pub kind: String,
    /// What it is, for people.
    pub message: String,
    /// Where it is, counted from 0.
    #[serde(skip_serializing_if = "Elements::is_empty")]
    pub elements: Elements,
    /// All its numbers, by name.
    #[serde(flatten)]
    pub details: Map<String, Value>,
}

impl Finding {
    fn new(severity: Severity, message: String, value: &impl Serialize) -> Self {
        let mut details = match serde_json::to_value(value) {
            Ok(Value::Object(fields)) => fields,
            _ => Map::new(),
        };
        let kind = details.remove("kind").and_then(|kind| kind.as_str().map(str::to_owned));
        let kind = kind.unwrap_or_else(|| "other".into());
        Self { severity, kind, message, elements: Elements::of_fields(&details), details }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl From<&Fault> for Finding {
    fn from(fault: &Fault) -> Self {
        let severity = match fault.severity() {
            FaultSeverity::Warning => Severity::Warning,
            FaultSeverity::Error => Severity::Error,
        };
        Self::new(severity, fault.to_string(), fault)
    }
}

impl From<&Violation> for Finding {
    fn from(violation: &Violation) -> Self {
        Self::new(Severity::Error, in_words(violation), violation)
    }
}

/// One line per finding, those of a kind together, at most `limit` of each kind.
pub fn listing<'a>(findings: impl IntoIterator<Item = &'a Finding>, limit: usize) -> Vec<String> {
    listing_by(findings, limit, |finding| finding.kind.clone())
}

/// One line per item, those of a variant together, at most `limit` of each.
pub(crate) fn listing_of<'a, T: fmt::Display + 'a>(
    items: impl IntoIterator<Item = &'a T>,
    limit: usize,
) -> Vec<String> {
    listing_by(items, limit, std::mem::discriminant)
}

fn listing_by<'a, T: fmt::Display + 'a, K: PartialEq>(
    items: impl IntoIterator<Item = &'a T>,
    limit: usize,
    kind_of: impl Fn(&T) -> K,
) -> Vec<String> {
    let mut kinds: Vec<(K, Vec<&T>)> = Vec::new();
    for item in items {
        let kind = kind_of(item);
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, members)) => members.push(item),
            None => kinds.push((kind, vec![item])),
        }
    }
    let mut lines = Vec::new();
    for (_, members) in kinds {
        lines.extend(members.iter().take(limit).map(ToString::to_string));
        if members.len() > limit {
            lines.push(format!("and {} more", members.len() - limit));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut_by_kind() {
        let mut faults: Vec<Fault> = (0..5).map(|face| Fault::ZeroAreaFace { face }).collect();
        faults.push(Fault::UnreferencedVertex { vertex: 7 });
        let findings: Vec<Finding> = faults.iter().map(Finding::from).collect();
        let expected = [
            "face 0 has zero area",
            "face 1 has zero area",
            "and 3 more",
            "vertex 7 belongs to no face",
        ];
        assert_eq!(listing(&findings, 2), expected);
        assert_eq!(listing_of(&faults, 2), expected);
    }

    #[test]
    fn findings_name_their_elements() {
        let fault = Fault::InconsistentOrientation { edge: [3, 5], faces: [0, 7] };
        let finding = Finding::from(&fault);
        assert_eq!(finding.kind, "inconsistent-orientation");
        assert_eq!(finding.severity, Severity::Error);
        assert_eq!((finding.elements.edges, finding.elements.faces), (vec![[3, 5]], vec![0, 7]));
        let violation = Violation::ConeAngle { vertex: 4, quarters: 3.5 };
        let finding = Finding::from(&violation);
        assert_eq!((finding.kind.as_str(), finding.elements.vertices), ("cone-angle", vec![4]));
        assert_eq!(finding.details["quarters"], 3.5);
    }
}
