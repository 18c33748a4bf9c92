//! Gaussian integers and sparse linear forms over them, exact or an error.

use num_complex::Complex64;
use std::collections::BTreeMap;

/// `re + im i` with integer parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub struct Gauss {
    /// Real part.
    pub re: i64,
    /// Imaginary part.
    pub im: i64,
}

/// A coefficient left the range of 64-bit integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the integer relations of the seams have coefficients beyond 64 bits")]
pub struct Overflow;

impl Gauss {
    /// 0.
    pub const ZERO: Self = Self { re: 0, im: 0 };
    /// 1.
    pub const ONE: Self = Self { re: 1, im: 0 };

    /// `i^k`.
    pub fn unit(k: i32) -> Self {
        let [re, im] = [[1, 0], [0, 1], [-1, 0], [0, -1]][k.rem_euclid(4) as usize];
        Self { re, im }
    }

    /// Whether it is 1, i, -1 or -i.
    pub fn is_unit(self) -> bool {
        self.re.unsigned_abs().saturating_add(self.im.unsigned_abs()) == 1
    }

    /// `re^2 + im^2`.
    pub fn norm(self) -> i128 {
        i128::from(self.re) * i128::from(self.re) + i128::from(self.im) * i128::from(self.im)
    }

    /// The complex conjugate.
    pub fn conj(self) -> Self {
        // The smallest integer has no negative; no such coefficient passes the checked operations.
        Self { re: self.re, im: self.im.saturating_neg() }
    }

    /// `-self`.
    pub fn negated(self) -> Self {
        Self { re: self.re.saturating_neg(), im: self.im.saturating_neg() }
    }

    /// `self + other`.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn plus(self, other: Self) -> Result<Self, Overflow> {
        let sum = |a: i64, b: i64| a.checked_add(b).filter(|s| *s > i64::MIN).ok_or(Overflow);
        Ok(Self { re: sum(self.re, other.re)?, im: sum(self.im, other.im)? })
    }

    /// `self * other`.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn times(self, other: Self) -> Result<Self, Overflow> {
        let [a, b, c, d] = [self.re, self.im, other.re, other.im].map(i128::from);
        Self::narrow(a * c - b * d, a * d + b * c)
    }

    /// The Gaussian integer nearest to `self / other`: the remainder has at most half the norm of
    /// `other`, which must not be zero.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn nearest_quotient(self, other: Self) -> Result<Self, Overflow> {
        let [a, b, c, d] = [self.re, self.im, other.re, other.im].map(i128::from);
        let norm = other.norm();
        let nearest = |x: i128| (2 * x + norm).div_euclid(2 * norm);
        Self::narrow(nearest(a * c + b * d), nearest(b * c - a * d))
    }

    fn narrow(re: i128, im: i128) -> Result<Self, Overflow> {
        let part = |x: i128| i64::try_from(x).ok().filter(|s| *s > i64::MIN).ok_or(Overflow);
        Ok(Self { re: part(re)?, im: part(im)? })
    }

    /// In floating point.
    pub fn to_complex(self) -> Complex64 {
        Complex64::new(self.re as f64, self.im as f64)
    }
}

/// The greatest common divisor, up to a unit.
///
/// # Errors
/// [`Overflow`].
pub fn gcd(mut a: Gauss, mut b: Gauss) -> Result<Gauss, Overflow> {
    while b != Gauss::ZERO {
        let rest = a.plus(a.nearest_quotient(b)?.times(b)?.negated())?;
        (a, b) = (b, rest);
    }
    Ok(a)
}

/// A linear form: coefficient per variable, none of them zero.
pub type Form = BTreeMap<u32, Gauss>;

/// `target += factor * source`.
///
/// # Errors
/// [`Overflow`].
pub fn add_scaled(target: &mut Form, source: &Form, factor: Gauss) -> Result<(), Overflow> {
    for (&variable, &c) in source {
        let entry = target.entry(variable).or_default();
        *entry = entry.plus(factor.times(c)?)?;
        if *entry == Gauss::ZERO {
            target.remove(&variable);
        }
    }
    Ok(())
}

/// `factor * source`.
///
/// # Errors
/// [`Overflow`].
pub fn scaled(source: &Form, factor: Gauss) -> Result<Form, Overflow> {
    let mut product = Form::new();
    add_scaled(&mut product, source, factor)?;
    Ok(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn g(re: i64, im: i64) -> Gauss {
        Gauss { re, im }
    }

    #[test]
    fn divisors_by_hand() {
        // 5 = (2 + i)(2 - i), and 3 + i = (1 + i)(2 - i)
        assert_eq!(gcd(g(5, 0), g(3, 1)).unwrap().norm(), 5);
        assert_eq!(gcd(g(1, 1), g(2, 0)).unwrap().norm(), 2);
        assert!(gcd(g(3, 0), g(2, 1)).unwrap().is_unit());
        assert_eq!(g(7, 3).nearest_quotient(g(2, 1)).unwrap(), g(3, 0));
    }

    #[test]
    fn units_turn_by_quarters() {
        for k in -5..5 {
            assert_eq!(Gauss::unit(k).times(Gauss::unit(1)), Ok(Gauss::unit(k + 1)));
            assert_eq!(Gauss::unit(k).conj(), Gauss::unit(-k));
        }
        assert!(!g(1, 1).is_unit() && !g(0, 0).is_unit() && g(0, -1).is_unit());
    }

    #[test]
    fn overflow_is_an_error() {
        let large = g(i64::MAX, 1);
        assert_eq!(large.plus(Gauss::ONE), Err(Overflow));
        assert_eq!(large.times(g(2, 0)), Err(Overflow));
        assert_eq!(large.times(Gauss::ONE), Ok(large));
    }
}
