//! The report of a map, as cells of the table.

use crate::program::Report;
use serde_json::Value;

/// The columns.
pub(super) const TITLES: [&str; 14] = [
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
];

/// One cell for each of the [`TITLES`].
pub(super) fn cells(report: &Report) -> [String; TITLES.len()] {
    let number = |path, digits| number(report.get(path), digits);
    let megabytes = report.number("/cost/peak_memory_bytes");
    [
        number("/input/faces", 0),
        number("/input/genus", 0),
        number("/input/boundary_loops", 0),
        count(report, "/input/components"),
        number("/distortion/tau", 3),
        number("/distortion/symmetric_dirichlet", 4),
        number("/distortion/tau_t/p99", 3),
        number("/cones/count", 0),
        number("/seams/edges", 0),
        routes(report),
        number("/cost/cpu_seconds", 2),
        number("/cost/wall_seconds", 2),
        megabytes.map_or("-".into(), |bytes| format!("{:.0}", bytes / 1e6)),
        count(report, "/input/warnings"),
    ]
}

fn count(report: &Report, path: &str) -> String {
    report.get(path).as_array().map_or("-".into(), |items| items.len().to_string())
}

/// The stages of the ladder that laid the components out, with their numbers if there are several.
fn routes(report: &Report) -> String {
    let mut counts: Vec<(String, usize)> = Vec::new();
    for component in report.get("/components").as_array().into_iter().flatten() {
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

fn route(value: &Value) -> String {
    value["kind"].as_str().unwrap_or("-").to_owned()
}

/// A number with this many decimals; what JSON has no number for is spelled out as it is.
fn number(value: &Value, decimals: usize) -> String {
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
        let one = report(r#"{"components": [{"route": {"kind": "untangled"}}]}"#);
        assert_eq!(routes(&one), "untangled");
        let two = report(
            r#"{"components": [{"route": {"kind": "rigid"}}, {"route": {"kind": "barrier"}},
                {"route": {"kind": "rigid"}}]}"#,
        );
        assert_eq!(routes(&two), "2 rigid, 1 barrier");
    }

    #[test]
    fn a_report_without_values_has_cells_all_the_same() {
        let cells = cells(&Report::parse(b"{}").unwrap());
        assert_eq!(cells[0], "-");
    }
}
