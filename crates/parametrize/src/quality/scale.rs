//! Optimal global scales, one per measure.
//!
//! Each is the `s` that is best when all singular values are multiplied by it; 1 where there is no best.

use super::singular::SingularValues;

/// Minimises the maximum of `max(s sigma_1, 1 / (s sigma_2))`: eq. (2) with the extremes of the map.
pub(super) fn of_tau(singular: &SingularValues) -> f64 {
    let (largest, smallest) = singular.extremes();
    sensible(1.0 / (largest * smallest).sqrt())
}

/// Minimises the mean of `s^2 P + Q / s^2`.
pub(super) fn of_symmetric_dirichlet(singular: &SingularValues) -> f64 {
    let squares = |[s1, s2]: [f64; 2]| s1 * s1 + s2 * s2;
    let inverse_squares = |[s1, s2]: [f64; 2]| 1.0 / (s1 * s1) + 1.0 / (s2 * s2);
    let p = SingularValues::mean(singular.positive(), squares);
    let q = SingularValues::mean(singular.positive(), inverse_squares);
    sensible((q / p).powf(0.25))
}

/// Minimises the mean of `s^2 (sigma_1^2 + sigma_2^2) - 2 s (sigma_1 + sigma_2) + 2`.
pub(super) fn of_arap(singular: &SingularValues) -> f64 {
    let sums = SingularValues::mean(singular.measured(), |[s1, s2]| s1 + s2);
    let squares = SingularValues::mean(singular.measured(), |[s1, s2]| s1 * s1 + s2 * s2);
    not_negative(sums / squares)
}

/// Bisections of the slope: the interval shrinks below the last digit.
const BISECTIONS: usize = 60;

/// Minimises the maximum of the same parabolas, a convex function of the scale, by bisection of its slope.
pub(super) fn of_arap_max(singular: &SingularValues) -> f64 {
    let parabolas: Vec<[f64; 2]> =
        singular.measured().map(|(_, [s1, s2], _)| [s1 * s1 + s2 * s2, s1 + s2]).collect();
    // Every parabola falls before its own minimum b / a: the largest of these is an upper bound.
    let mut high = parabolas.iter().map(|[a, b]| b / a).fold(0.0, f64::max);
    let mut low = 0.0;
    for _ in 0..BISECTIONS {
        let s = 0.5 * (low + high);
        let (_, slope) = parabolas
            .iter()
            .map(|[a, b]| (s * (s * a - 2.0 * b), s * a - b))
            .fold((f64::NEG_INFINITY, 0.0), |worst, p| if p.0 > worst.0 { p } else { worst });
        if slope > 0.0 {
            high = s;
        } else {
            low = s;
        }
    }
    not_negative(0.5 * (low + high))
}

/// Gives `(sigma_1^2 + sigma_2^2) / 2` the mean 1. The energy itself would be least at scale zero.
pub(super) fn of_asap(singular: &SingularValues) -> f64 {
    let squares = SingularValues::mean(singular.measured(), |[s1, s2]| 0.5 * (s1 * s1 + s2 * s2));
    sensible(1.0 / squares.sqrt())
}

/// Where rotations are no nearer than nothing, as for reflections, the best scale is zero.
fn not_negative(scale: f64) -> f64 {
    if scale >= 0.0 && scale.is_finite() { scale } else { 1.0 }
}

fn sensible(scale: f64) -> f64 {
    if scale > 0.0 && scale.is_finite() { scale } else { 1.0 }
}
