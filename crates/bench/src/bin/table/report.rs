//! The report of a map, as cells of the table.

use serde_json::Value;

/// The columns.
pub(crate) const TITLES: [&str; 15] = [
    "triangles",
    "genus",
    "loops",
    "parts",
    "tau",
    "SD",
    "p99",
    "cones",
    "seams",
    "route",
    "CPU s",
    "wall s",
    "MB",
    "warnings",
    "outcome",
];

/// What `seamstress map` has reported.
#[derive(Debug)]
pub(crate) struct Report(Value);

impl Report {
    pub(crate) fn parse(json: &[u8]) -> Result<Self, serde_json::Error> {
        serde_json::from_slice(json).map(Self)
    }

    /// A value by its path, as in `/input/faces`.
    pub(crate) fn get(&self, path: &str) -> &Value {
        self.0.pointer(path).unwrap_or(&Value::Null)
    }

    /// CPU seconds of the whole run.
    pub(crate) fn cpu_seconds(&self) -> Option<f64> {
        self.get("/cost/cpu_seconds").as_f64()
    }

    /// One cell for each of the [`TITLES`].
    pub(crate) fn cells(&self) -> [String; TITLES.len()] {
        let figure = |path, digits| figure(self.get(path), digits);
        let megabytes = self.get("/cost/peak_memory_bytes").as_f64();
        [
            figure("/input/faces", 0),
            figure("/input/genus", 0),
            figure("/input/boundary_loops", 0),
            self.count("/input/components"),
            figure("/distortion/tau", 3),
            figure("/distortion/symmetric_dirichlet", 4),
            figure("/distortion/tau_t/p99", 3),
            figure("/cones/count", 0),
            figure("/seams/edges", 0),
            self.routes(),
            figure("/cost/cpu_seconds", 2),
            figure("/cost/wall_seconds", 2),
            megabytes.map_or("-".into(), |bytes| format!("{:.0}", bytes / 1e6)),
            self.count("/input/warnings"),
            "certified".into(),
        ]
    }

    fn count(&self, path: &str) -> String {
        let items = self.get(path).as_array();
        items.map_or("-".into(), |items| items.len().to_string())
    }

    /// The safeguards that laid the components out, with their numbers if there are several.
    fn routes(&self) -> String {
        let mut counts: Vec<(String, usize)> = Vec::new();
        for component in self.get("/components").as_array().into_iter().flatten() {
            let name = route(&component["route"]);
            match counts.iter_mut().find(|(other, _)| *other == name) {
                Some((_, count)) => *count += 1,
                None => counts.push((name, 1)),
            }
        }
        match &counts[..] {
            [(name, _)] => name.clone(),
            _ => {
                let parts = counts.iter().map(|(name, count)| format!("{count} {name}"));
                parts.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

fn route(value: &Value) -> String {
    let kind = value["kind"].as_str().unwrap_or("-");
    match value["exponent"].as_f64() {
        Some(exponent) => format!("{kind} {exponent}"),
        None => kind.to_owned(),
    }
}

/// A number with this many decimals; what JSON has no number for is spelled out as it is.
fn figure(value: &Value, decimals: usize) -> String {
    match value {
        Value::Number(number) => number.as_f64().map_or("-".into(), |x| format!("{x:.decimals$}")),
        Value::String(text) => text.clone(),
        _ => "-".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn routes_are_counted_if_they_differ() {
        let report = |json: &str| Report::parse(json.as_bytes()).unwrap();
        let one = report(r#"{"components": [{"route": {"kind": "snowflake", "exponent": 0.5}}]}"#);
        assert_eq!(one.routes(), "snowflake 0.5");
        let two = report(
            r#"{"components": [{"route": {"kind": "rigid"}}, {"route": {"kind": "barrier"}},
                {"route": {"kind": "rigid"}}]}"#,
        );
        assert_eq!(two.routes(), "2 rigid, 1 barrier");
    }

    #[test]
    fn a_report_without_values_has_cells_all_the_same() {
        let cells = Report::parse(b"{}").unwrap().cells();
        assert_eq!(cells[0], "-");
    }
}
