//! The second-order cone `{(u0, u1): |u1| <= u0}`, its Jordan algebra and Nesterov-Todd scalings.
//!
//! Elements are arrays with the axis first.

use crate::energy::smallest_positive_root;

/// `sum of a_i b_i`.
#[inline]
pub(super) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `a0 b0 - a1 . b1`, the form whose positive part is the cone.
#[inline]
fn form<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    2.0 * a[0] * b[0] - dot(a, b)
}

/// `sqrt(u0^2 - |u1|^2)`; not a number outside the cone.
#[inline]
fn size<const D: usize>(u: &[f64; D]) -> f64 {
    let tail = u[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
    // The product keeps the digits that the difference of the squares loses near the boundary.
    ((u[0] - tail) * (u[0] + tail)).sqrt()
}

/// The Jordan product `(a . b, a0 b1 + b0 a1)`.
#[inline]
pub(super) fn product<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    let mut out = std::array::from_fn(|k| a[0] * b[k] + b[0] * a[k]);
    out[0] = dot(a, b);
    out
}

/// The solution x of `product(a, x) = b`.
#[inline]
pub(super) fn quotient<const D: usize>(b: &[f64; D], a: &[f64; D]) -> [f64; D] {
    let first = form(a, b) / size(a).powi(2);
    let mut out = std::array::from_fn(|k| (b[k] - first * a[k]) / a[0]);
    out[0] = first;
    out
}

/// The inverse for the Jordan product.
#[inline]
pub(super) fn inverse<const D: usize>(u: &[f64; D]) -> [f64; D] {
    let scale = 1.0 / size(u).powi(2);
    let mut out = u.map(|x| -x * scale);
    out[0] = -out[0];
    out
}

/// The largest step from inside along `d` that does not leave the cone; infinite if none does.
#[inline]
pub(super) fn largest_step<const D: usize>(u: &[f64; D], d: &[f64; D]) -> f64 {
    smallest_positive_root(form(d, d), 2.0 * form(u, d), size(u).powi(2))
}

/// Whether a step from inside along `d` ends inside.
#[inline]
pub(super) fn stays_inside<const D: usize>(u: &[f64; D], d: &[f64; D], step: f64) -> bool {
    let end: [f64; D] = std::array::from_fn(|k| u[k] + step * d[k]);
    end[0] > 0.0 && form(&end, &end) > 0.0
}

/// The scaling `W` of a pair of inner elements with `W dual = W^-1 slack`, symmetric and positive
/// definite (Nesterov and Todd 1998).
#[derive(Debug, Clone, Copy)]
pub(super) struct Scaling<const D: usize> {
    /// The scaling point, of size 1.
    w: [f64; D],
    eta: f64,
}

impl<const D: usize> Scaling<D> {
    pub(super) const ONE: Self = {
        let mut w = [0.0; D];
        w[0] = 1.0;
        Self { w, eta: 1.0 }
    };

    /// The scaling of a slack and its dual; not finite if one of them lies on the boundary.
    #[inline]
    pub(super) fn new(slack: &[f64; D], dual: &[f64; D]) -> Self {
        let (u, l) = (1.0 / size(slack), 1.0 / size(dual));
        let cosine = dot(slack, dual) * u * l;
        let half = 0.5 / ((1.0 + cosine) / 2.0).sqrt();
        let mut w = std::array::from_fn(|k| (slack[k] * u - dual[k] * l) * half);
        w[0] = (slack[0] * u + dual[0] * l) * half;
        Self { w, eta: (l / u).sqrt() }
    }

    #[inline]
    fn apply_signed(&self, a: &[f64; D], sign: f64, scale: f64) -> [f64; D] {
        let along = sign * (dot(&self.w, a) - self.w[0] * a[0]);
        let share = sign * (a[0] + along / (1.0 + self.w[0]));
        let mut out = std::array::from_fn(|k| scale * (a[k] + self.w[k] * share));
        out[0] = scale * (self.w[0] * a[0] + along);
        out
    }

    /// `W a`.
    #[inline]
    pub(super) fn apply(&self, a: &[f64; D]) -> [f64; D] {
        self.apply_signed(a, 1.0, self.eta)
    }

    /// `W^-1 a`.
    #[inline]
    pub(super) fn apply_inverse(&self, a: &[f64; D]) -> [f64; D] {
        self.apply_signed(a, -1.0, 1.0 / self.eta)
    }

    /// `W^-2 a`.
    #[inline]
    pub(super) fn apply_inverse_square(&self, a: &[f64; D]) -> [f64; D] {
        let (scale, v) = self.inverse_square();
        let along = 2.0 * dot(&v, a);
        let mut out = std::array::from_fn(|k| scale * (along * v[k] + a[k]));
        out[0] = scale * (along * v[0] - a[0]);
        out
    }

    /// `W^-2 = scale (2 v v^T - diag(1, -1, ..., -1))`: the scale and `v`.
    #[inline]
    pub(super) fn inverse_square(&self) -> (f64, [f64; D]) {
        let mut v = self.w.map(|x| -x);
        v[0] = self.w[0];
        (1.0 / (self.eta * self.eta), v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const U: [f64; 3] = [2.0, 1.0, -0.5];
    const L: [f64; 3] = [3.0, -1.5, 2.0];

    fn close<const D: usize>(a: [f64; D], b: [f64; D]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-13 * (1.0 + b.abs()))
    }

    #[test]
    fn the_algebra_has_a_unit_inverses_and_quotients() {
        assert!(close(product(&U, &[1.0, 0.0, 0.0]), U));
        assert!(close(product(&U, &inverse(&U)), [1.0, 0.0, 0.0]));
        assert!(close(product(&U, &quotient(&L, &U)), L));
    }

    #[test]
    fn scalings_bring_slack_and_dual_to_one_point() {
        let scaling = Scaling::new(&U, &L);
        assert!(close(scaling.apply(&L), scaling.apply_inverse(&U)));
        assert!(close(scaling.apply(&scaling.apply_inverse(&U)), U));
        let (scale, v) = scaling.inverse_square();
        let by_form: [f64; 3] = std::array::from_fn(|k| {
            let diagonal = if k == 0 { -U[0] } else { U[k] };
            scale * (2.0 * v[k] * dot(&v, &U) + diagonal)
        });
        assert!(close(by_form, scaling.apply_inverse(&scaling.apply_inverse(&U))));
        assert!(close(by_form, scaling.apply_inverse_square(&U)));
        let five = Scaling::new(&[3.0, 1.0, 1.0, 1.0, 1.0], &[2.0, -1.0, 0.0, 0.5, 0.0]);
        assert!(close(
            five.apply(&[2.0, -1.0, 0.0, 0.5, 0.0]),
            five.apply_inverse(&[3.0, 1.0, 1.0, 1.0, 1.0])
        ));
    }

    #[test]
    fn steps_end_at_the_boundary() {
        // |1 + t| = 2 at t = 1; inwards there is no end.
        assert!((largest_step(&[2.0, 1.0, 0.0], &[0.0, 1.0, 0.0]) - 1.0).abs() < 1e-14);
        assert_eq!(largest_step(&U, &[1.0, 0.0, 0.5]), f64::INFINITY);
        assert!((largest_step(&[2.0, 1.0, 0.0], &[-1.0, 0.0, 0.0]) - 1.0).abs() < 1e-14);
    }
}
