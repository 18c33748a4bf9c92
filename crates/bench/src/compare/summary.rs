//! Two builds compared over all meshes.

use super::{Metric, Pair};
use crate::markdown::Table;
use crate::program::Outcome;

/// Counts of what was lost and gained, a row for each metric, and the reasons of what failed.
pub(super) fn summary(pairs: &[Pair], metrics: &[Metric], percent: f64) -> String {
    let count = |of: &dyn Fn(&Pair) -> bool| pairs.iter().filter(|pair| of(pair)).count();
    let names = |of: &dyn Fn(&Pair) -> bool| {
        let names: Vec<&str> = pairs.iter().filter(|p| of(p)).map(|p| p.name.as_str()).collect();
        if names.is_empty() { "none".into() } else { names.join(", ") }
    };
    let worse = |pair: &Pair| {
        // Times vary from run to run: they have their own row.
        let metrics = metrics.iter().filter(|metric| metric.title != "CPU s");
        let mut ratios = metrics.filter_map(|metric| ratio(pair, metric));
        ratios.any(|ratio| ratio > 1.0 + percent / 100.0)
    };
    let mut text = format!(
        "{} meshes: {} -> {} succeed; {} lost, {} gained, {} worse by more than {percent} %, {} the same \
         byte for byte.\n\n",
        pairs.len(),
        count(&|p| p.old.report().is_some()),
        count(&|p| p.new.report().is_some()),
        count(&Pair::is_lost),
        count(&Pair::is_gained),
        count(&worse),
        count(&|p| p.is_same),
    );
    text += &format!("* lost: {}\n", names(&Pair::is_lost));
    text += &format!("* gained: {}\n", names(&Pair::is_gained));
    text += &format!("* worse: {}\n\n", names(&worse));
    text += &metrics_table(pairs, metrics, percent).to_string();
    text + &reasons(pairs)
}

fn ratio(pair: &Pair, metric: &Metric) -> Option<f64> {
    let [old, new] = pair.values(metric);
    Some(metric.scale.as_ref()?.ratio(old?, new?))
}

fn metrics_table(pairs: &[Pair], metrics: &[Metric], percent: f64) -> Table {
    let limit = 1.0 + percent / 100.0;
    let mut table = Table::new([
        "metric".to_owned(),
        "better".into(),
        "worse".into(),
        format!("by > {percent} %"),
        "mean ratio".into(),
        "sum".into(),
        "worst".into(),
    ]);
    for metric in metrics {
        let ratios: Vec<(f64, &str)> = pairs
            .iter()
            .filter_map(|pair| Some((ratio(pair, metric)?, pair.name.as_str())))
            .collect();
        let count = |of: &dyn Fn(f64) -> bool| ratios.iter().filter(|r| of(r.0)).count();
        let logs: f64 = ratios.iter().map(|(ratio, _)| ratio.ln()).sum();
        let worst = ratios.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let is_compared = |p: &&Pair| p.values(metric).iter().all(Option::is_some);
        let sum = |k: usize| {
            let values = pairs.iter().filter(is_compared).filter_map(|p| p.values(metric)[k]);
            metric.show(Some(values.sum()))
        };
        table.push(vec![
            metric.title.to_owned(),
            count(&|r| r < 1.0).to_string(),
            count(&|r| r > 1.0).to_string(),
            count(&|r| r > limit).to_string(),
            if ratios.is_empty() {
                "-".into()
            } else {
                format!("{:.4}", (logs / ratios.len() as f64).exp())
            },
            super::change(sum(0), sum(1)),
            worst.filter(|w| w.0 > 1.0).map_or("-".into(), |(r, name)| format!("{r:.3} {name}")),
        ]);
    }
    table
}

/// Why meshes gave no result, where that is a failure of either build or differs.
fn reasons(pairs: &[Pair]) -> String {
    let reason = |outcome: &Outcome| match outcome {
        Outcome::Done(_) => "ok".to_owned(),
        Outcome::Refused(reason) => format!("refused: {reason}"),
        Outcome::Failed(reason) => format!("failed: {reason}"),
    };
    let mut lines = String::new();
    for pair in pairs {
        let [old, new] = [&pair.old, &pair.new].map(reason);
        let is_failure = |outcome: &Outcome| matches!(outcome, Outcome::Failed(_));
        if old != new || is_failure(&pair.old) {
            lines += &format!("* {}: {}\n", pair.name, super::change(old, new));
        }
    }
    if lines.is_empty() { lines } else { format!("\nWithout a result:\n\n{lines}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::metric::MAP_METRICS;
    use crate::program::Report;

    fn done(tau: f64) -> Outcome {
        let json = format!(
            r#"{{"distortion": {{"tau": {tau}, "symmetric_dirichlet": 4.1}}, "cones": {{"count": 8}},
                "cost": {{"cpu_seconds": 1}}}}"#
        );
        Outcome::Done(Report::parse(json.as_bytes()).unwrap())
    }

    #[test]
    fn lost_gained_and_worse() {
        let failed = || Outcome::Failed("no layout".to_owned().into());
        let pair = |name: &str, old, new| Pair { name: name.into(), old, new, is_same: false };
        let pairs = [
            pair("a", done(2.0), failed()),
            pair("b", failed(), done(2.0)),
            pair("c", done(2.0), done(2.1)),
            pair("d", done(2.0), done(2.01)),
            Pair { is_same: true, ..pair("e", done(3.0), done(3.0)) },
        ];
        let text = summary(&pairs, MAP_METRICS, 1.0);
        let first = "5 meshes: 4 -> 4 succeed; 1 lost, 1 gained, 1 worse by more than 1 %, 1 the same \
                     byte for byte.";
        assert!(text.starts_with(first), "{text}");
        for line in ["* lost: a\n", "* gained: b\n", "* worse: c\n", "1.050 c", "7.000 -> 7.110"] {
            assert!(text.contains(line), "{line} in {text}");
        }
        assert!(text.contains("* a: ok -> failed: no layout"), "{text}");
    }
}
