//! Measures at known maps, their scales, and what they do not depend on.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::surface;
use proptest::prelude::*;
use seamstress_mesh::{Face, FaceData};
use seamstress_parametrize::quality::{
    Measure, SingularValues, Summary, distance_to_frames, distortion, frames, measure_all,
    summarize,
};
use seamstress_testkit as kit;

type Matrix = [[f64; 2]; 2];

/// A flat square under a linear map.
fn linear([[a, b], [c, d]]: Matrix) -> SingularValues {
    let soup = kit::disk_grid(3, 2);
    let (mesh, metric) = surface(&soup);
    let corner = |v: &u32| {
        let [x, y, _] = soup.positions[*v as usize];
        [a * x + b * y + 3.0, c * x + d * y - 1.0]
    };
    let uvs: Vec<_> = soup.faces.iter().flatten().map(corner).collect();
    SingularValues::new(&mesh, &metric, &uvs)
}

#[track_caller]
fn expect(singular: &SingularValues, figures: [(Measure, f64); 8]) {
    for (measure, expected) in figures {
        let summary = summarize(measure, singular);
        for found in [summary.mean, summary.max, summary.percentiles.p50, summary.figure()] {
            let is_equal = found == expected || (found - expected).abs() < 1e-12;
            assert!(is_equal, "{measure}: {found}, not {expected}");
        }
    }
}

#[test]
fn similarities_have_ideal_values() {
    let figures = Measure::ALL.map(|measure| (measure, measure.ideal()));
    expect(&linear([[0.6, -0.8], [0.8, 0.6]]), figures);
    // Scaled by 5, only the measure of the map as it stands changes.
    let mut scaled = figures;
    scaled[0].1 = 5.0;
    expect(&linear([[3.0, -4.0], [4.0, 3.0]]), scaled);
}

#[test]
fn unit_shear_by_hand() {
    // sigma = (sqrt 5 +- 1) / 2: sum sqrt 5, difference 1, product 1, squares 3.
    let golden = 0.5 * (5f64.sqrt() + 1.0);
    expect(
        &linear([[1.0, 1.0], [0.0, 1.0]]),
        [
            (Measure::TauTilde, golden),
            (Measure::Tau, golden),
            (Measure::SymmetricDirichlet, 6.0),
            (Measure::Arap, 2.0 - 5.0 / 3.0),
            (Measure::ArapMax, 2.0 - 5.0 / 3.0),
            (Measure::Asap, 1.0 / 3.0),
            (Measure::AsapMax, 1.0 / 3.0),
            (Measure::Dilatation, golden * golden),
        ],
    );
}

#[test]
fn anisotropic_scaling_by_hand() {
    // sigma = 4 and 1/2, not balanced: (2) scales by 1 / sqrt 2 to sqrt 8 and its inverse.
    expect(
        &linear([[0.5, 0.0], [0.0, 4.0]]),
        [
            (Measure::TauTilde, 4.0),
            (Measure::Tau, 8f64.sqrt()),
            (Measure::SymmetricDirichlet, 2.0 * (8.0 + 1.0 / 8.0)),
            (Measure::Arap, 2.0 - 4.5 * 4.5 / 16.25),
            (Measure::ArapMax, 2.0 - 4.5 * 4.5 / 16.25),
            (Measure::Asap, 3.5 * 3.5 / 16.25),
            (Measure::AsapMax, 3.5 * 3.5 / 16.25),
            (Measure::Dilatation, 8.0),
        ],
    );
}

#[test]
fn a_reflection_is_infinite_where_the_seed_says_so() {
    let singular = linear([[1.0, 0.0], [0.0, -1.0]]);
    assert_eq!(singular.flipped(), 12);
    let infinite =
        [Measure::TauTilde, Measure::Tau, Measure::SymmetricDirichlet, Measure::Dilatation];
    for summary in measure_all(&singular) {
        assert_eq!(summary.max.is_infinite(), infinite.contains(&summary.measure));
        assert_eq!(summary.infinite, if summary.max.is_infinite() { 12 } else { 0 });
    }
    // Nothing of a rotation is in it: zero is as near to one, at 2, which is also half the square of
    // 1 - (-1), and its square over 1 + 1.
    for measure in [Measure::Arap, Measure::ArapMax, Measure::Asap, Measure::AsapMax] {
        let figure = summarize(measure, &singular).figure();
        assert!((figure - 2.0).abs() < 1e-12, "{measure}: {figure}");
    }
}

#[test]
fn flips_among_others_are_counted_and_the_rest_measured() {
    let singular = SingularValues {
        values: FaceData(vec![Some([2.0, 0.5]), None, Some([1.0, -0.5]), Some([0.0, 0.0])]),
        area: FaceData(vec![1.0; 4]),
    };
    assert_eq!((singular.flipped(), singular.degenerate()), (2, 1));
    let tau = summarize(Measure::Tau, &singular);
    assert_eq!((tau.scale, tau.infinite, tau.worst), (1.0, 2, Some(Face(2))));
    assert!(tau.values[Face(1)].is_nan() && tau.values[Face(0)] == 2.0);
    let arap = summarize(Measure::ArapMax, &singular);
    assert!(arap.max.is_finite() && arap.infinite == 0);
    // What is left of a collapsed triangle is as far from a similarity as can be.
    assert_eq!(summarize(Measure::AsapMax, &singular).values[Face(3)], 2.0);
}

#[test]
fn scales_of_two_similarities_by_hand() {
    let singular = SingularValues {
        values: FaceData(vec![Some([1.0, 1.0]), Some([2.0, 2.0])]),
        area: FaceData(vec![1.0, 1.0]),
    };
    let scale = |measure: Measure| measure.scale(&singular);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
    // 1 - s = 2 s - 1
    assert!(close(scale(Measure::ArapMax), 2.0 / 3.0));
    assert!(close(summarize(Measure::ArapMax, &singular).figure(), 2.0 / 9.0));
    // (2 + 4) / (2 + 8)
    assert!(close(scale(Measure::Arap), 0.6));
    assert!(close(scale(Measure::Tau), 0.5f64.sqrt()));
    // (mean of 2 and 1/2) over (mean of 2 and 8), to the power 1/4
    assert!(close(scale(Measure::SymmetricDirichlet), 0.25f64.powf(0.25)));
    assert!(close(scale(Measure::Asap), 2.5f64.sqrt().recip()));
    assert!(close(scale(Measure::Dilatation), 1.0));
}

#[test]
fn nothing_to_measure_is_not_a_number() {
    let singular = SingularValues { values: FaceData(vec![None]), area: FaceData(vec![1.0]) };
    for summary in measure_all(&singular) {
        assert!(summary.mean.is_nan() && summary.max.is_nan() && summary.worst.is_none());
    }
}

#[test]
fn frames_are_rotations_of_the_map() {
    let soup = kit::disk_grid(2, 2);
    let (mesh, metric) = surface(&soup);
    let turned = |angle: f64, stretch: f64| -> Vec<[f64; 2]> {
        let (sin, cos) = angle.sin_cos();
        let at = |v: &u32| {
            let [x, y, _] = soup.positions[*v as usize];
            [stretch * x * cos - y * sin, stretch * x * sin + y * cos]
        };
        soup.faces.iter().flatten().map(at).collect()
    };
    let (plain, other) = (frames(&mesh, &metric, &turned(0.0, 1.0)), turned(0.4, 1.0));
    for (f, frame) in frames(&mesh, &metric, &other).enumerate() {
        assert!(((frame / plain[f]).arg() - 0.4).abs() < 1e-12);
    }
    // Quarter turns of the whole map do not count, other turns do: |R - 1|^2 = 4 - 4 cos.
    let quarter = turned(std::f64::consts::FRAC_PI_2, 1.0);
    assert!(distance_to_frames(&mesh, &metric, &quarter, &turned(0.0, 1.0)) < 1e-20);
    let distance = distance_to_frames(&mesh, &metric, &other, &turned(0.0, 1.0));
    assert!((distance - (4.0 - 4.0 * 0.4f64.cos())).abs() < 1e-12);
    // A stretch by 3 along one axis is off by 2 there.
    let distance = distance_to_frames(&mesh, &metric, &turned(0.0, 3.0), &turned(0.0, 1.0));
    assert!((distance - 4.0).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn scale_and_rotation_change_nothing(seed in 0u32..1000, angle in 0.0..6.3, exponent in -30i32..30) {
        let soup = kit::bumpy(&kit::saddle(4), 0.1, seed.into());
        let (mesh, metric) = surface(&soup);
        let factor = 1.3 * f64::from(exponent).exp2();
        let (sin, cos) = f64::sin_cos(angle);
        let uvs = |scale: f64, sin: f64, cos: f64| -> Vec<[f64; 2]> {
            let at = |v: &u32| {
                let [x, y, _] = soup.positions[*v as usize];
                let [u, v] = [scale * (x + 0.2 * y * y), scale * (1.1 * y + 0.1 * x)];
                [cos * u - sin * v, sin * u + cos * v]
            };
            soup.faces.iter().flatten().map(at).collect()
        };
        let measure = |uvs: &[[f64; 2]]| measure_all(&SingularValues::new(&mesh, &metric, uvs));
        let (plain, moved) = (measure(&uvs(1.0, 0.0, 1.0)), measure(&uvs(factor, sin, cos)));
        for (a, b) in plain.iter().zip(&moved) {
            if a.measure == Measure::TauTilde {
                continue;
            }
            for (x, y) in [(a.mean, b.mean), (a.max, b.max), (a.percentiles.p95, b.percentiles.p95)] {
                prop_assert!((x - y).abs() < 1e-7 * (1.0 + x.abs()), "{}: {x} {y}", a.measure);
            }
        }
        let tau = Summary::figure(&plain[1]);
        prop_assert!((tau - distortion(&mesh, &metric, &uvs(factor, sin, cos)).tau).abs() < 1e-9 * tau);
    }

    #[test]
    fn no_other_scale_is_better(values in proptest::collection::vec((0.2..3.0, 0.1..1.0), 1..12)) {
        let singular = SingularValues {
            values: values.iter().map(|&(s1, ratio): &(f64, f64)| Some([s1, ratio * s1])).collect(),
            area: FaceData(vec![1.0; values.len()]),
        };
        for measure in [Measure::Tau, Measure::SymmetricDirichlet, Measure::Arap, Measure::ArapMax] {
            let best = summarize(measure, &singular);
            for factor in [0.9, 0.999, 1.001, 1.1] {
                let scaled = |&[s1, s2]: &[f64; 2]| measure.value(
                    factor * best.scale * s1, factor * best.scale * s2);
                let values: Vec<f64> = singular.values.iter().flatten().map(scaled).collect();
                let figure = match measure {
                    Measure::SymmetricDirichlet | Measure::Arap => {
                        values.iter().sum::<f64>() / values.len() as f64
                    }
                    _ => values.iter().copied().fold(0.0, f64::max),
                };
                prop_assert!(figure >= best.figure() - 1e-12, "{measure} {factor}");
            }
        }
    }
}
