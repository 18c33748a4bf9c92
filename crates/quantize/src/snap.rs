//! From a layout with integral seams to doubles whose seams fit to the last bit.

use crate::base::Base;
use crate::gauss::{Form, Gauss, Overflow};
use crate::space::IntegerSpace;
use num_complex::Complex64;
use seamstress_parametrize::quarter::turn;

/// Bits of a double's mantissa.
const MANTISSA: i32 = 53;

/// Wedge positions in grid units for the held unknowns, which are integers, and the free ones, all shifted
/// by an integer.
///
/// A vertex on a seam has several wedges, at `i^k x` plus integers. Its position is rounded to a multiple
/// of a power of two that is representable at all of them, so that quarter turns and integer
/// translations between them are exact in floating point. Other vertices keep all their digits. Levels of
/// isolines are integers, and stay.
///
/// # Errors
/// [`Overflow`].
pub fn snap(
    space: &IntegerSpace,
    held: &[i64],
    free: &[f64],
    shift: Gauss,
) -> Result<Vec<Complex64>, Overflow> {
    let levels: Vec<f64> = held.iter().map(|&k| k as f64).collect();
    let x = space.positions(free, &levels);
    let fixed: Vec<Complex64> = (0..space.n_wedges() as u32)
        .map(|w| Ok(value(space.form(w), held)?.plus(shift)?.to_complex()))
        .collect::<Result<_, Overflow>>()?;
    let mut copies = vec![0u32; x.len()];
    let mut reach = vec![0.0f64; x.len()];
    for (w, c) in fixed.iter().enumerate() {
        if let Base::Ordinary { vertex, turns } = space.base(w as u32) {
            let (v, z) = (vertex as usize, turn(x[vertex as usize], turns) + c);
            copies[v] += 1;
            let size = |z: &Complex64| z.re.abs().max(z.im.abs());
            reach[v] = [z, *c, x[v]].iter().map(size).fold(reach[v], f64::max);
        }
    }
    let rounded: Vec<Complex64> = (0..x.len())
        .map(|v| if copies[v] > 1 { round_to(x[v], ulp_at(reach[v])) } else { x[v] })
        .collect();
    let place = |(w, c): (usize, &Complex64)| match space.base(w as u32) {
        Base::Ordinary { vertex, turns } => turn(rounded[vertex as usize], turns) + c,
        Base::Fixed => *c,
    };
    Ok(fixed.iter().enumerate().map(place).collect())
}

/// The value of a form in X at integers.
fn value(form: &Form, held: &[i64]) -> Result<Gauss, Overflow> {
    let variable = |v: u32| Gauss { re: held[2 * v as usize], im: held[2 * v as usize + 1] };
    form.iter().try_fold(Gauss::ZERO, |sum, (&v, &c)| sum.plus(c.times(variable(v))?))
}

/// A power of two whose multiples up to twice `reach` are all doubles.
fn ulp_at(reach: f64) -> f64 {
    let exponent = reach.max(1.0).log2().ceil() as i32 + 1;
    f64::from(exponent - MANTISSA).exp2()
}

fn round_to(z: Complex64, step: f64) -> Complex64 {
    // Multiples of a power of two: dividing and multiplying is exact.
    Complex64::new((z.re / step).round() * step, (z.im / step).round() * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_snapped_numbers_are_exact() {
        for (x, c) in [(0.1, 1000.0), (1.0 / 3.0, -7.0), (511.7, 1.0), (1e-20, 4.0)] {
            let step = ulp_at(f64::max(x, f64::abs(c)));
            let snapped = round_to(Complex64::new(x, -x), step);
            assert!((snapped.re - x).abs() <= step / 2.0);
            let there = snapped + Complex64::new(c, c);
            assert_eq!(there - Complex64::new(c, c), snapped);
            // a number with all its digits does not come back
            let plain = x + c;
            assert!(x == snapped.re || plain - c != x);
        }
    }
}
