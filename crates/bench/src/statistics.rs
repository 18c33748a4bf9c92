//! Means and trends.

/// The exponent `a` of the power law `y ~ x^a` that fits the points best in the least-squares sense of the
/// logarithms; none for fewer than two points.
pub(crate) fn order(points: &[(f64, f64)]) -> Option<f64> {
    if points.len() < 2 {
        return None;
    }
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let along: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
    let both: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    Some(both / along)
}

/// Geometric mean of second over first, over the pairs of positive numbers; none without one.
pub(crate) fn mean_ratio(pairs: &[[f64; 2]]) -> Option<f64> {
    let positive = pairs.iter().filter(|pair| pair.iter().all(|&x| x > 0.0));
    let logs: Vec<f64> = positive.map(|[a, b]| (b / a).ln()).collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

/// The item in the middle, the upper of two; none if there is no item.
pub(crate) fn median<T>(mut items: Vec<T>, key: impl Fn(&T) -> f64) -> Option<T> {
    items.sort_by(|a, b| key(a).total_cmp(&key(b)));
    let middle = items.len() / 2;
    items.into_iter().nth(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_have_their_exponent() {
        let points = [0.1, 0.2, 0.5, 3.0].map(|x: f64| (x, 7.0 * x.powf(1.5)));
        assert!((order(&points).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(order(&points[..1]), None);
    }

    #[test]
    fn the_mean_ratio_is_geometric_and_leaves_out_zeros() {
        let mean = mean_ratio(&[[1.0, 4.0], [2.0, 2.0], [0.0, 1.0]]).unwrap();
        assert!((mean - 2.0).abs() < 1e-12);
        assert_eq!(mean_ratio(&[[0.0, 1.0]]), None);
    }

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0], |&x| x), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0], |&x| x), Some(4.0));
        assert_eq!(median(vec![], |&x: &f64| x), None);
    }
}
