//! Quarter turns of the plane, the powers of i, and other small arithmetic.

use num_complex::Complex64;

/// `i^k z`, exactly.
#[inline]
pub fn turn(z: Complex64, k: i32) -> Complex64 {
    match k.rem_euclid(4) {
        0 => z,
        1 => Complex64::new(-z.im, z.re),
        2 => -z,
        _ => Complex64::new(z.im, -z.re),
    }
}

/// `i^k`.
#[inline]
pub fn unit(k: i32) -> Complex64 {
    turn(Complex64::ONE, k)
}

/// The rotation by `quarters` quarter turns, any real number.
pub fn rotation(quarters: f64) -> Complex64 {
    Complex64::from_polar(1.0, quarters * std::f64::consts::FRAC_PI_2)
}

/// `i^k wanted` with the k that brings it nearest to the direction of `to`.
#[inline]
pub fn nearest_quarter(wanted: Complex64, to: Complex64) -> Complex64 {
    let off = (to * wanted.conj()).arg() / std::f64::consts::FRAC_PI_2;
    turn(wanted, off.round() as i32)
}

/// Whether a figure is at most a limit; a figure that is not a number is not.
#[inline]
pub fn within(figure: f64, limit: f64) -> bool {
    figure <= limit
}

/// Unit complex number in the direction of `z`, 1 for zero.
#[inline]
pub fn direction(z: Complex64) -> Complex64 {
    // The square is safe: lengths are in mean edges. Tiny ones take the careful way.
    let square = z.norm_sqr();
    if square > 1e-200 {
        return z / square.sqrt();
    }
    let norm = z.norm();
    if norm > 0.0 { z / norm } else { Complex64::ONE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_i() {
        let z = Complex64::new(3.0, 4.0);
        for k in -8..8 {
            assert_eq!(turn(z, k), unit(k) * z);
            assert!((rotation(f64::from(k)) - unit(k)).norm() < 1e-14);
            assert_eq!(turn(turn(z, k), -k), z);
        }
        assert!((direction(z).norm() - 1.0).abs() < 1e-15);
        assert_eq!(direction(Complex64::ZERO), Complex64::ONE);
    }
}
