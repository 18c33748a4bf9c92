//! What is compared.

use crate::program::Report;

/// A number of a report.
pub(super) struct Metric {
    pub(super) title: &'static str,
    decimals: usize,
    pub(super) value: fn(&Report) -> Option<f64>,
    /// How worse is measured; none if more is neither better nor worse.
    pub(super) scale: Option<Scale>,
}

/// Makes a number a positive one whose growth in percent says how much worse it became.
pub(super) struct Scale {
    /// The best value there is.
    ideal: f64,
    /// What is added to the distance from the ideal, so that near it small changes are not large percentages.
    floor: f64,
}

impl Scale {
    /// How much worse the new value is: 1 if it is the same.
    pub(super) fn ratio(&self, old: f64, new: f64) -> f64 {
        if old == new {
            return 1.0;
        }
        (new - self.ideal + self.floor) / (old - self.ideal + self.floor)
    }
}

impl Metric {
    pub(super) fn show(&self, value: Option<f64>) -> String {
        value.map_or("-".into(), |x| format!("{x:.*}", self.decimals))
    }
}

/// The distance from 4, which is an isometry, that counts as no more than another so small.
const ENERGY_FLOOR: f64 = 0.01;
/// Seconds; reports count in hundredths.
const TIME_FLOOR: f64 = 0.1;

const TAU: Metric = Metric {
    title: "tau",
    decimals: 3,
    value: |report| report.number("/distortion/tau"),
    scale: Some(Scale { ideal: 0.0, floor: 0.0 }),
};
const ENERGY: Metric = Metric {
    title: "SD",
    decimals: 4,
    value: |report| report.number("/distortion/symmetric_dirichlet"),
    scale: Some(Scale { ideal: 4.0, floor: ENERGY_FLOOR }),
};
const SECONDS: Metric = Metric {
    title: "CPU s",
    decimals: 2,
    value: Report::cpu_seconds,
    scale: Some(Scale { ideal: 0.0, floor: TIME_FLOOR }),
};
const CONES: Metric = Metric {
    title: "cones",
    decimals: 0,
    value: |report| report.number("/cones/count"),
    scale: Some(Scale { ideal: 0.0, floor: 1.0 }),
};
const QUADS: Metric = Metric {
    title: "quads",
    decimals: 0,
    value: |report| report.number("/quads/count"),
    scale: None,
};
const IRREGULAR: Metric = Metric {
    title: "irregular",
    decimals: 0,
    value: |report| report.number("/quads/irregular/count"),
    scale: Some(Scale { ideal: 0.0, floor: 1.0 }),
};
/// By how much the number of quads misses the one asked for, per cent.
const OFF: Metric = Metric {
    title: "off %",
    decimals: 1,
    value: |report| {
        let requested = report.number("/grid/requested/quads")?;
        Some(100.0 * (report.number("/grid/quads")? / requested - 1.0).abs())
    },
    scale: Some(Scale { ideal: 0.0, floor: 2.0 }),
};
/// Quads that are inverted, self-intersecting or folded; reports of older builds have other words.
const BAD_QUADS: Metric = Metric {
    title: "bad quads",
    decimals: 0,
    value: |report| {
        let kinds = [["inverted"; 2], ["self_intersecting", "crossed"], ["folded", "bent"]];
        let count = |kind: &&str| report.number(&format!("/orientation/{kind}"));
        kinds.iter().map(|words| words.iter().find_map(&count)).sum()
    },
    scale: Some(Scale { ideal: 0.0, floor: 1.0 }),
};

const DROPPED: Metric = Metric {
    title: "features dropped",
    decimals: 0,
    value: |report| report.get("/features/dropped").as_array().map(|dropped| dropped.len() as f64),
    scale: Some(Scale { ideal: 0.0, floor: 1.0 }),
};
const COVER: Metric = Metric {
    title: "area lost %",
    decimals: 1,
    value: |report| report.number("/judged/cover").map(|cover| 100.0 * (1.0 - cover).abs()),
    scale: Some(Scale { ideal: 0.0, floor: 1.0 }),
};
/// What distances count as no more than: they are in cells.
const DISTANCE_FLOOR: f64 = 0.05;
const CREASES: Metric = Metric {
    title: "creases",
    decimals: 3,
    value: |report| report.number("/judged/crease_p95"),
    scale: Some(Scale { ideal: 0.0, floor: DISTANCE_FLOOR }),
};
const RIMS: Metric = Metric {
    title: "rims",
    decimals: 3,
    value: |report| report.number("/judged/rim_p95"),
    scale: Some(Scale { ideal: 0.0, floor: DISTANCE_FLOOR }),
};

/// The metrics of `map`.
pub(super) const MAP_METRICS: &[Metric] = &[TAU, ENERGY, CONES, SECONDS];
/// The metrics of `quad`: tau and energy are those of the integer-grid map.
pub(super) const QUAD_METRICS: &[Metric] =
    &[QUADS, OFF, IRREGULAR, BAD_QUADS, DROPPED, TAU, ENERGY, SECONDS];
/// Those of `quad` with what a script says of the quads.
pub(super) const JUDGED_METRICS: &[Metric] =
    &[QUADS, OFF, COVER, CREASES, RIMS, IRREGULAR, BAD_QUADS, DROPPED, TAU, ENERGY, SECONDS];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worse_is_measured_from_the_ideal() {
        let ratio = |metric: &Metric, old, new| metric.scale.as_ref().unwrap().ratio(old, new);
        assert!((ratio(&ENERGY, 4.04, 4.09) - 2.0).abs() < 1e-9);
        assert!(ratio(&ENERGY, 4.000_001, 4.000_01) < 1.01);
        assert_eq!(ratio(&TAU, 2.0, 3.0), 1.5);
        assert_eq!(ratio(&TAU, f64::INFINITY, f64::INFINITY), 1.0);
        assert!(ratio(&BAD_QUADS, 0.0, 1.0) > 1.5);
    }

    #[test]
    fn bad_quads_are_added_up() {
        let report = |json: &str| Report::parse(json.as_bytes()).unwrap();
        let some = report(r#"{"orientation": {"inverted": 1, "crossed": 0, "bent": 2}}"#);
        assert_eq!((BAD_QUADS.value)(&some), Some(3.0));
        let other =
            report(r#"{"orientation": {"inverted": 1, "self_intersecting": 4, "folded": 2}}"#);
        assert_eq!((BAD_QUADS.value)(&other), Some(7.0));
        assert_eq!((BAD_QUADS.value)(&report("{}")), None);
    }

    #[test]
    fn the_count_is_compared_with_the_one_asked_for() {
        let json = br#"{"grid": {"quads": 450, "requested": {"quads": 500}}}"#;
        let off = (OFF.value)(&Report::parse(json).unwrap()).unwrap();
        assert!((off - 10.0).abs() < 1e-9);
    }
}
