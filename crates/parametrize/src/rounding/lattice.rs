//! Integer least squares in a few unknowns.

/// Passes of reduction and descent; they end by themselves long before.
const PASSES: usize = 50;
/// Passes of Gauss-Seidel for the real solution, which is only rounded.
const REAL_PASSES: usize = 200;
/// Squared lengths count as this at least.
const MINIMUM_SQUARE: f64 = 1e-12;
/// Multiples stay below this, whatever a degenerate system says.
const MAX_MULTIPLE: f64 = 1e6;
/// A change must lower the energy, or a squared length by such a part, by more than rounding errors would.
const MINIMUM_GAIN: f64 = 1e-9;

/// Integers that make `n' Q n - 2 b' n` small, `Q` positive semi-definite: in a reduced basis the rounded minimum or
/// zero, whichever leads lower by descent over single and pair moves.
pub(super) fn closest_integers(q: &[Vec<f64>], b: &[f64]) -> Vec<i32> {
    let Lattice { q, b, basis } = Lattice::new(q, b).reduced();
    let starts = [round_real_minimum(&q, &b), vec![0; b.len()]];
    let energy = |n: &[i32]| {
        let value = |i: usize| {
            let row: f64 = q[i].iter().zip(n).map(|(q, &n)| q * f64::from(n)).sum();
            f64::from(n[i]) * (row - 2.0 * b[i])
        };
        (0..n.len()).map(value).sum::<f64>()
    };
    let [first, second] = starts.map(|start| descend(&q, &b, start));
    let closest = if energy(&second) < energy(&first) { second } else { first };
    let mut integers = vec![0; closest.len()];
    for (vector, n) in basis.iter().zip(closest) {
        integers.iter_mut().zip(vector).for_each(|(sum, x)| *sum += n * x);
    }
    integers
}

/// A problem in some basis of its lattice.
struct Lattice {
    /// Products of the basis vectors with each other, and with what they are to come close to.
    q: Vec<Vec<f64>>,
    b: Vec<f64>,
    /// The vectors, in the unknowns.
    basis: Vec<Vec<i32>>,
}

impl Lattice {
    fn new(q: &[Vec<f64>], b: &[f64]) -> Self {
        let unit = |i: usize| (0..b.len()).map(|j| i32::from(i == j)).collect();
        Self { q: q.to_vec(), b: b.to_vec(), basis: (0..b.len()).map(unit).collect() }
    }

    /// With multiples of vectors taken off others as long as one becomes shorter: pairwise reduction, after Lagrange. The
    /// cycles of a spanning tree are long and run side by side; descent along them gets stuck.
    fn reduced(mut self) -> Self {
        let n = self.b.len();
        for _ in 0..PASSES {
            let mut is_reduced = true;
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|(i, j)| i != j) {
                let by = (self.q[i][j] / self.q[j][j].max(MINIMUM_SQUARE)).round();
                let gain = by * (2.0 * self.q[i][j] - by * self.q[j][j]);
                if gain > MINIMUM_GAIN * self.q[i][i] && by.abs() < MAX_MULTIPLE {
                    self.subtract(i, j, by);
                    is_reduced = false;
                }
            }
            if is_reduced {
                break;
            }
        }
        self
    }

    /// Takes a multiple of vector `j` off vector `i`.
    fn subtract(&mut self, i: usize, j: usize, by: f64) {
        let row = self.q[j].clone();
        self.q[i].iter_mut().zip(row).for_each(|(x, y)| *x -= by * y);
        self.q.iter_mut().for_each(|row| row[i] -= by * row[j]);
        self.b[i] -= by * self.b[j];
        let vector = self.basis[j].clone();
        self.basis[i].iter_mut().zip(vector).for_each(|(x, y)| *x -= by as i32 * y);
    }
}

/// Rounded solution of `Q n = b` (Gauss-Seidel: Q is well conditioned and small).
fn round_real_minimum(q: &[Vec<f64>], b: &[f64]) -> Vec<i32> {
    let mut x = vec![0.0; b.len()];
    for _ in 0..REAL_PASSES {
        for i in 0..b.len() {
            let row: f64 = q[i].iter().zip(&x).map(|(q, x)| q * x).sum();
            x[i] += (b[i] - row) / q[i][i].max(MINIMUM_SQUARE);
        }
    }
    x.into_iter().map(|x| x.round().clamp(-MAX_MULTIPLE, MAX_MULTIPLE) as i32).collect()
}

fn descend(q: &[Vec<f64>], b: &[f64], mut n: Vec<i32>) -> Vec<i32> {
    // Half the gradient.
    let mut g: Vec<f64> = (0..b.len())
        .map(|i| q[i].iter().zip(&n).map(|(q, &n)| q * f64::from(n)).sum::<f64>() - b[i])
        .collect();
    let step = |n: &mut [i32], g: &mut [f64], i: usize, by: i32| {
        n[i] += by;
        g.iter_mut().zip(q).for_each(|(g, row)| *g += f64::from(by) * row[i]);
    };
    for _ in 0..PASSES {
        let mut improved = false;
        for i in 0..b.len() {
            let by = (-g[i] / q[i][i].max(MINIMUM_SQUARE)).round() as i32;
            if by != 0 {
                step(&mut n, &mut g, i, by);
                improved = true;
            }
            for j in 0..i {
                for (si, sj) in [(1, 1), (1, -1), (-1, 1), (-1, -1)] {
                    let change = 2.0 * (f64::from(si) * g[i] + f64::from(sj) * g[j])
                        + q[i][i]
                        + q[j][j]
                        + 2.0 * f64::from(si * sj) * q[i][j];
                    if change < -MINIMUM_GAIN {
                        step(&mut n, &mut g, i, si);
                        step(&mut n, &mut g, j, sj);
                        improved = true;
                        break;
                    }
                }
            }
        }
        if !improved {
            break;
        }
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `n' Q n - 2 b' n` for the lattice of some vectors and a target.
    fn problem(vectors: &[[f64; 3]], target: [f64; 3]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let q = vectors.iter().map(|a| vectors.iter().map(|b| dot(a, b)).collect()).collect();
        (q, vectors.iter().map(|a| dot(a, &target)).collect())
    }

    fn squared_distance(vectors: &[[f64; 3]], target: [f64; 3], n: &[i32]) -> f64 {
        let along =
            |k: usize| vectors.iter().zip(n).map(|(v, &n)| f64::from(n) * v[k]).sum::<f64>();
        (0..3).map(|k| (along(k) - target[k]).powi(2)).sum()
    }

    #[test]
    fn a_point_of_the_lattice_is_found_in_a_basis_of_long_vectors() {
        // The cubic lattice, by vectors that nearly coincide.
        let vectors = [[1.0, 0.0, 0.0], [17.0, 1.0, 0.0], [40.0, 23.0, 1.0]];
        let target = [3.2, -5.1, 2.4];
        let (q, b) = problem(&vectors, target);
        let found = closest_integers(&q, &b);
        assert!((squared_distance(&vectors, target, &found) - 0.21).abs() < 1e-9, "{found:?}");
        // Without reduction descent from the rounded minimum stops far away.
        let stuck = descend(&q, &b, round_real_minimum(&q, &b));
        assert!(squared_distance(&vectors, target, &stuck) > 0.5, "{stuck:?}");
    }

    #[test]
    fn reduction_keeps_the_lattice() {
        let vectors = [[2.0, 1.0, 0.3], [3.0, 1.2, 0.1], [-1.0, 4.0, 2.0]];
        let (q, b) = problem(&vectors, [1.0, 2.0, 3.0]);
        let reduced = Lattice::new(&q, &b).reduced();
        let of = |row: &[i32]| -> [f64; 3] {
            std::array::from_fn(|k| {
                row.iter().zip(&vectors).map(|(&n, v)| f64::from(n) * v[k]).sum()
            })
        };
        let new: Vec<[f64; 3]> = reduced.basis.iter().map(|row| of(row)).collect();
        let (again, b) = problem(&new, [1.0, 2.0, 3.0]);
        for i in 0..3 {
            assert!((b[i] - reduced.b[i]).abs() < 1e-9);
            assert!((0..3).all(|j| (again[i][j] - reduced.q[i][j]).abs() < 1e-9));
            // No vector can be shortened by another.
            assert!((0..3).all(|j| i == j || 2.0 * again[i][j].abs() <= again[j][j] + 1e-6));
        }
        let [x, y, z] = [0, 1, 2].map(|k| reduced.basis[k].clone());
        let determinant = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0]);
        assert_eq!(determinant.abs(), 1);
    }

    #[test]
    fn nothing_is_closest_to_nothing() {
        assert!(closest_integers(&[], &[]).is_empty());
        assert_eq!(closest_integers(&[vec![0.0]], &[0.0]), [0]);
    }
}
