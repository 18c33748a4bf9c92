//! Integer steps that cost little.

use crate::linear::{Dense, Row, apply};

/// A basis of the integer vectors, reduced in pairs: no vector gets shorter by taking multiples of another one
/// from it, in the energy.
///
/// Moving a cone alone changes many coordinates at once where relations couple them; the reduced basis has
/// such steps as vectors of their own.
#[derive(Debug, Clone)]
pub struct ReducedBasis {
    /// Coordinate and step.
    pub vectors: Vec<Row>,
    /// The energy on multiples of the vectors.
    pub matrix: Dense,
}

/// Passes over all pairs at most.
const MOST_SWEEPS: usize = 50;
/// A fall of the energy that counts, as a share.
const GAIN: f64 = 1e-9;

impl ReducedBasis {
    /// Reduces the unit vectors in an energy `x' P x`.
    pub fn new(energy: &Dense) -> Self {
        let n = energy.order;
        let mut matrix = energy.clone();
        let mut vectors = vec![0; n * n];
        (0..n).for_each(|k| vectors[k * n + k] = 1);
        for _ in 0..MOST_SWEEPS {
            let mut is_reduced = true;
            for i in 0..n {
                for j in (0..n).filter(|&j| j != i) {
                    let (own, shared, other) =
                        (matrix.row(i)[i], matrix.row(i)[j], matrix.row(j)[j]);
                    let q = (shared / other).round();
                    if q != 0.0 && (q * other - 2.0 * shared) * q < -GAIN * own {
                        subtract(&mut vectors, n, i, j, q as i64);
                        matrix.subtract(i, j, q);
                        is_reduced = false;
                    }
                }
            }
            if is_reduced {
                break;
            }
        }
        let sparse = |k: usize| -> Row {
            let entries = vectors[k * n..(k + 1) * n].iter().copied().enumerate();
            entries.filter(|&(_, c)| c != 0).collect()
        };
        Self { vectors: (0..n).map(sparse).collect(), matrix }
    }
}

impl ReducedBasis {
    /// A quadratic form on multiples of the vectors.
    pub fn express(&self, form: &Dense) -> Dense {
        let n = form.order;
        let rows: Vec<Vec<f64>> = self
            .vectors
            .iter()
            .map(|vector| {
                let mut row = vec![0.0; n];
                for &(k, c) in vector {
                    row.iter_mut().zip(form.row(k)).for_each(|(r, f)| *r += c as f64 * f);
                }
                row
            })
            .collect();
        let along = |row: &Vec<f64>| self.vectors.iter().map(|v| apply(v, row)).collect::<Vec<_>>();
        Dense { order: n, values: rows.iter().flat_map(along).collect() }
    }
}

/// Takes `q` times vector j from vector i.
fn subtract(vectors: &mut [i64], n: usize, i: usize, j: usize, q: i64) {
    for k in 0..n {
        vectors[i * n + k] -= q * vectors[j * n + k];
    }
}

impl Dense {
    /// The energy after `q` times vector j was taken from vector i.
    fn subtract(&mut self, i: usize, j: usize, q: f64) {
        let n = self.order;
        (0..n).for_each(|k| self.values[i * n + k] -= q * self.values[j * n + k]);
        (0..n).for_each(|k| self.values[k * n + i] -= q * self.values[k * n + j]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit::Rng;

    /// A positive definite matrix in a basis far from reduced.
    fn skewed(n: usize, seed: u64) -> Dense {
        let mut rng = Rng::new(seed);
        let factor: Vec<f64> = (0..n * n)
            .map(|k| match k % n {
                0 => 5.0 + rng.unit(),
                _ => rng.unit() - 0.5,
            })
            .collect();
        let entry = |i: usize, j: usize| {
            let product: f64 = (0..n).map(|k| factor[n * i + k] * factor[n * j + k]).sum();
            product + if i == j { 0.01 } else { 0.0 }
        };
        Dense { order: n, values: (0..n * n).map(|k| entry(k / n, k % n)).collect() }
    }

    #[test]
    fn pairs_are_reduced_and_the_matrix_is_theirs() {
        for seed in 0..20 {
            let energy = skewed(7, seed);
            let ReducedBasis { vectors, matrix } = ReducedBasis::new(&energy);
            let dense = |row: &Row| {
                let mut x = vec![0.0; 7];
                row.iter().for_each(|&(k, c)| x[k] = c as f64);
                x
            };
            let product = |m: &Dense, u: &Row, v: &Row| apply(u, &m.multiply(&dense(v)));
            for (i, u) in vectors.iter().enumerate() {
                for (j, v) in vectors.iter().enumerate() {
                    let off = product(&energy, u, v) - matrix.row(i)[j];
                    assert!(off.abs() < 1e-9, "seed {seed}");
                    let (shared, own) = (product(&energy, u, v), product(&energy, v, v));
                    assert!(i == j || shared.abs() <= (0.5 + 1e-6) * own, "seed {seed}");
                }
            }
            let size = |m: &Dense| (0..7).map(|k| m.row(k)[k]).sum::<f64>();
            assert!(size(&matrix) < 0.5 * size(&energy), "seed {seed}");
        }
    }

    #[test]
    fn they_are_a_basis() {
        for seed in 0..20 {
            let vectors = ReducedBasis::new(&skewed(5, seed)).vectors;
            let mut rows = vec![vec![0i64; 5]; 5];
            for (row, vector) in rows.iter_mut().zip(&vectors) {
                vector.iter().for_each(|&(k, c)| row[k] = c);
            }
            assert_eq!(determinant(rows).abs(), 1, "seed {seed}");
        }
    }

    /// By expansion along the first row.
    fn determinant(rows: Vec<Vec<i64>>) -> i64 {
        let Some((first, rest)) = rows.split_first() else { return 1 };
        let minor = |k: usize| -> Vec<Vec<i64>> {
            let without = |row: &Vec<i64>| [&row[..k], &row[k + 1..]].concat();
            rest.iter().map(without).collect()
        };
        let signed = |(k, c): (usize, &i64)| [*c, -*c][k % 2] * determinant(minor(k));
        first.iter().enumerate().map(signed).sum()
    }
}
