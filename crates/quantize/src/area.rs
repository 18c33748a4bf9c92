//! The area of a map, to the last bit.

use num_complex::Complex64;

/// The signed area of triangles in the plane, counter-clockwise positive, in the square of their unit.
///
/// Summed with twice the digits of a double (Ogita, Rump and Oishi 2005), from coordinates that are taken as exact:
/// whatever adds up to a whole number of cells is that number.
pub(crate) fn area(triangles: impl Iterator<Item = [Complex64; 3]>) -> f64 {
    let mut sum = Sum::default();
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sum.add_product(from.re, to.im);
            sum.add_product(-from.im, to.re);
        }
    }
    0.5 * sum.value()
}

/// A sum and what rounding has taken from it.
#[derive(Default)]
struct Sum {
    high: f64,
    low: f64,
}

impl Sum {
    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        let product_error = a.mul_add(b, -product);
        let sum = self.high + product;
        let part = sum - self.high;
        let sum_error = (self.high - (sum - part)) + (product - part);
        self.high = sum;
        self.low += sum_error + product_error;
    }

    fn value(&self) -> f64 {
        self.high + self.low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles around the point `(x, y)` over the square from 0 to `n`.
    fn fan(n: f64, x: f64, y: f64) -> [[Complex64; 3]; 4] {
        let at = Complex64::new;
        let (centre, corners) = (at(x, y), [at(0.0, 0.0), at(n, 0.0), at(n, n), at(0.0, n)]);
        [0, 1, 2, 3].map(|k| [centre, corners[k], corners[(k + 1) % 4]])
    }

    #[test]
    fn whole_cells_add_up_to_whole_numbers() {
        // One square far from the origin of many triangles, and many of few.
        let fans = (1..200).flat_map(|k| fan(3.0, 0.37 * f64::from(k), 1.0 / f64::from(k)));
        assert_eq!(area(fans), 199.0 * 9.0);
        let shifted = fan(1.0, 1.0 / 3.0, 1e-9).map(|t| t.map(|z| z + 1e6));
        let turned = shifted.map(|t| t.map(|z| z * Complex64::I));
        assert_eq!(area(shifted.into_iter()), area(turned.into_iter()));
    }

    #[test]
    fn a_part_of_a_cell_is_a_part() {
        let [first, ..] = fan(1.0, 0.5, 0.3);
        assert_eq!(area([first].into_iter()), 0.15);
        let reversed = [first[0], first[2], first[1]];
        assert_eq!(area([first, reversed].into_iter()), 0.0);
    }
}
