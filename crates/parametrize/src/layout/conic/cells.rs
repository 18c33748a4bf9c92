//! The cones of one triangle, as linear functions of its Jacobian, its epigraph variable and the bound.
//!
//! A triangle's Jacobian is the vector `q = (Re z, Im z, Re w, Im w)` of its two parts.

use super::cone::Scaling;
use num_complex::Complex64;

/// A triangle's share of the normal equations, over `q` and the bound `mu`, its epigraph variable
/// eliminated.
pub(super) struct Normal {
    /// Over `q`, symmetric.
    pub(super) block: [[f64; 4]; 4],
    /// Between `q` and `mu`.
    pub(super) border: [f64; 4],
    /// Of `mu`.
    pub(super) corner: f64,
    /// How the epigraph variable follows.
    pub(super) epigraph: Elimination,
}

/// The eliminated row of the epigraph variable s: `pivot s + q . row + border mu = right-hand side`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Elimination {
    pub(super) row: [f64; 4],
    pub(super) border: f64,
    /// `1 / pivot`; 0 where there is no such variable.
    pub(super) inverse: f64,
}

/// A vector per cone carried back to `q`, s and `mu`.
pub(super) struct Adjoint {
    pub(super) q: [f64; 4],
    pub(super) epigraph: f64,
    pub(super) bound: f64,
}

/// `C` cones of dimension `D` per triangle.
pub(super) trait Cones<const D: usize, const C: usize> {
    /// What lies in the cones: affine in `q`, s and `mu`.
    fn slack(frame: Complex64, q: &[f64; 4], epigraph: f64, bound: f64) -> [[f64; D]; C] {
        let mut slack = Self::step(frame, q, epigraph, bound);
        Self::shift(frame, &mut slack);
        slack
    }
    /// Adds the constant part.
    fn shift(frame: Complex64, slack: &mut [[f64; D]; C]);
    /// The linear part.
    fn step(frame: Complex64, q: &[f64; 4], epigraph: f64, bound: f64) -> [[f64; D]; C];
    /// Transpose of the linear part.
    fn adjoint(frame: Complex64, v: &[[f64; D]; C]) -> Adjoint;
    /// The normal equations `L^T W^-2 L` of the linear part L.
    fn normal(frame: Complex64, scalings: &[Scaling<D>; C]) -> Normal;
    /// The epigraph variable in the middle of its range.
    fn centre(q: &[f64; 4], bound: f64) -> f64;
}

/// `(s; z)`, `(mu - s; w)` and `(Re(z conj R) - 1; w)`: eq. (9) with one epigraph variable.
pub(super) struct StretchCones;

impl Cones<3, 3> for StretchCones {
    #[inline]
    fn shift(_: Complex64, slack: &mut [[f64; 3]; 3]) {
        slack[2][0] -= 1.0;
    }

    #[inline]
    fn step(frame: Complex64, q: &[f64; 4], epigraph: f64, bound: f64) -> [[f64; 3]; 3] {
        let along = frame.re * q[0] + frame.im * q[1];
        [[epigraph, q[0], q[1]], [bound - epigraph, q[2], q[3]], [along, q[2], q[3]]]
    }

    #[inline]
    fn adjoint(frame: Complex64, [a, b, c]: &[[f64; 3]; 3]) -> Adjoint {
        Adjoint {
            q: [a[1] + frame.re * c[0], a[2] + frame.im * c[0], b[1] + c[1], b[2] + c[2]],
            epigraph: a[0] - b[0],
            bound: b[0],
        }
    }

    #[inline]
    fn normal(frame: Complex64, scalings: &[Scaling<3>; 3]) -> Normal {
        let [a, b, c] = scalings.each_ref().map(square);
        let r = [frame.re, frame.im];
        let pivot = a[0][0] + b[0][0];
        let epigraph = Elimination {
            row: [a[0][1], a[0][2], -b[0][1], -b[0][2]],
            border: -b[0][0],
            inverse: 1.0 / pivot,
        };
        let mut block = [[0.0; 4]; 4];
        for i in 0..2 {
            for j in 0..2 {
                block[i][j] = a[1 + i][1 + j] + c[0][0] * r[i] * r[j];
                block[2 + i][2 + j] = b[1 + i][1 + j] + c[1 + i][1 + j];
                block[i][2 + j] = r[i] * c[0][1 + j];
                block[2 + j][i] = block[i][2 + j];
            }
        }
        for (row, x) in block.iter_mut().zip(epigraph.row) {
            for (entry, y) in row.iter_mut().zip(epigraph.row) {
                *entry -= x * y * epigraph.inverse;
            }
        }
        let share = b[0][0] * epigraph.inverse;
        let mut border = epigraph.row.map(|x| x * share);
        border[2] += b[0][1];
        border[3] += b[0][2];
        // b00 - b00^2 / (a00 + b00), without the difference
        Normal { block, border, corner: share * a[0][0], epigraph }
    }

    #[inline]
    fn centre(q: &[f64; 4], bound: f64) -> f64 {
        0.5 * (q[0].hypot(q[1]) + bound - q[2].hypot(q[3]))
    }
}

/// `(m; z - R, w)` with `mu = 2 m^2`: eq. (8).
pub(super) struct DeviationCones;

impl Cones<5, 1> for DeviationCones {
    #[inline]
    fn shift(frame: Complex64, [a]: &mut [[f64; 5]; 1]) {
        a[1] -= frame.re;
        a[2] -= frame.im;
    }

    #[inline]
    fn step(_: Complex64, q: &[f64; 4], _: f64, bound: f64) -> [[f64; 5]; 1] {
        [[bound, q[0], q[1], q[2], q[3]]]
    }

    #[inline]
    fn adjoint(_: Complex64, [a]: &[[f64; 5]; 1]) -> Adjoint {
        Adjoint { q: [a[1], a[2], a[3], a[4]], epigraph: 0.0, bound: a[0] }
    }

    #[inline]
    fn normal(_: Complex64, [scaling]: &[Scaling<5>; 1]) -> Normal {
        let a = square(scaling);
        Normal {
            block: std::array::from_fn(|i| std::array::from_fn(|j| a[1 + i][1 + j])),
            border: [a[0][1], a[0][2], a[0][3], a[0][4]],
            corner: a[0][0],
            epigraph: Elimination::default(),
        }
    }

    #[inline]
    fn centre(_: &[f64; 4], _: f64) -> f64 {
        0.0
    }
}

/// `W^-2` as a matrix.
#[inline]
fn square<const D: usize>(scaling: &Scaling<D>) -> [[f64; D]; D] {
    let (scale, v) = scaling.inverse_square();
    let mut out = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..D {
            out[i][j] = 2.0 * scale * v[i] * v[j];
        }
        out[i][i] += if i == 0 { -scale } else { scale };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::cone::dot;
    use super::*;

    const Q: [f64; 4] = [1.3, 0.4, -0.1, 0.15];

    /// `L^T W^-2 L` applied to a step, without eliminating anything.
    fn normal_product<const D: usize, const C: usize, K: Cones<D, C>>(
        frame: Complex64,
        scalings: &[Scaling<D>; C],
        (q, s, mu): ([f64; 4], f64, f64),
    ) -> Adjoint {
        let step = K::step(frame, &q, s, mu);
        let scaled = std::array::from_fn(|c| {
            scalings[c].apply_inverse(&scalings[c].apply_inverse(&step[c]))
        });
        K::adjoint(frame, &scaled)
    }

    fn check<const D: usize, const C: usize, K: Cones<D, C>>(duals: [[f64; D]; C]) {
        let frame = Complex64::from_polar(1.0, 0.2);
        let s = K::centre(&Q, 2.5);
        let slack = K::slack(frame, &Q, s, 2.5);
        let scalings = std::array::from_fn(|c| Scaling::new(&slack[c], &duals[c]));
        let normal = K::normal(frame, &scalings);
        let (q, mu) = ([0.3, -0.1, 0.7, 0.2], 0.4);
        let e = normal.epigraph;
        let ds = -e.inverse * (dot(&e.row, &q) + e.border * mu);
        let full = normal_product::<D, C, K>(frame, &scalings, (q, ds, mu));
        for i in 0..4 {
            let reduced = dot(&normal.block[i], &q) + normal.border[i] * mu;
            assert!((reduced - full.q[i]).abs() < 1e-12, "{i}");
        }
        let corner = dot(&normal.border, &q) + normal.corner * mu;
        assert!((corner - full.bound).abs() < 1e-12 && full.epigraph.abs() < 1e-12);
        // <L x, v> = <x, L^T v>
        let adjoint = K::adjoint(frame, &duals);
        let step = K::step(frame, &q, 0.9, mu);
        let left: f64 = step.iter().zip(&duals).map(|(a, b)| dot(a, b)).sum();
        let right = dot(&adjoint.q, &q) + 0.9 * adjoint.epigraph + mu * adjoint.bound;
        assert!((left - right).abs() < 1e-13);
    }

    #[test]
    fn reduced_equations_are_the_full_ones() {
        check::<3, 3, StretchCones>([[1.0, 0.2, 0.1], [2.0, -1.0, 0.5], [0.7, 0.1, -0.3]]);
        check::<5, 1, DeviationCones>([[1.0, 0.2, 0.1, -0.4, 0.3]]);
    }

    #[test]
    fn slacks_state_the_constraints() {
        let slack = StretchCones::slack(Complex64::I, &[0.1, 2.0, 0.3, 0.4], 2.1, 3.0);
        assert_eq!(slack[0], [2.1, 0.1, 2.0]);
        assert_eq!(slack[2], [1.0, 0.3, 0.4]);
        assert!((slack[1][0] - 0.9).abs() < 1e-15);
        let slack = DeviationCones::slack(Complex64::I, &[0.1, 2.0, 0.3, 0.4], 0.0, 3.0);
        assert_eq!(slack, [[3.0, 0.1, 1.0, 0.3, 0.4]]);
    }
}
