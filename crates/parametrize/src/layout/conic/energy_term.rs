//! The mean energy as a quadratic term of a program's objective.

use crate::energy::SymmetricDirichlet;
use crate::layout::problem::LayoutProblem;

/// The rise of the mean symmetric Dirichlet energy over its minimum, to second order, with a weight.
///
/// At a layout `y` whose best global scale is `s` it is `weight / 2 x' (H - w w' / (r' w)) x` with `x = s y - r`, where
/// `r` is the layout of minimum energy, `H` the Hessian there and `w = H r`: scaling `r` costs nothing, as in the energy
/// at its best scale. The first part of the matrix has the pattern of the problem; the second, of rank one, is carried
/// along by the formula of Sherman and Morrison.
pub(crate) struct EnergyTerm {
    hessian: Vec<f64>,
    minimum: Vec<f64>,
    pull: Vec<f64>,
    size: f64,
    weight: f64,
    scale: f64,
    gradient: Vec<f64>,
    pull_solution: Vec<f64>,
    correction: f64,
}

impl EnergyTerm {
    /// Around a layout of minimum energy, at its best scale.
    pub(crate) fn new(problem: &mut LayoutProblem, minimum: Vec<f64>) -> Self {
        let z = problem.space().expand(&minimum);
        problem.linearize(&SymmetricDirichlet, &z);
        let (pattern, values) = problem.matrix();
        let hessian = values.to_vec();
        let mut pull = vec![0.0; minimum.len()];
        pattern.multiply(&hessian, &minimum, &mut pull);
        let size = dot(&pull, &minimum);
        let n = minimum.len();
        let [gradient, pull_solution] = [(); 2].map(|()| vec![0.0; n]);
        let (weight, scale, correction) = (0.0, 1.0, 0.0);
        Self { hessian, minimum, pull, size, weight, scale, gradient, pull_solution, correction }
    }

    /// Moves to a layout of this best scale, with a weight, and adds the part with a pattern to the problem's matrix.
    pub(super) fn add_to(
        &mut self,
        problem: &mut LayoutProblem,
        y: &[f64],
        scale: f64,
        weight: f64,
    ) {
        (self.scale, self.weight) = (scale, weight);
        let x: Vec<f64> = y.iter().zip(&self.minimum).map(|(y, r)| scale * y - r).collect();
        problem.matrix().0.multiply(&self.hessian, &x, &mut self.gradient);
        let along = dot(&self.pull, &x) / self.size;
        for (g, w) in self.gradient.iter_mut().zip(&self.pull) {
            *g = weight * scale * (*g - along * w);
        }
        problem.add_to_matrix(&self.hessian, weight * scale * scale);
    }

    /// Solves with the whole matrix, whose part with a pattern the problem has factored: overwrites the border with its
    /// solution, and returns that for the negated gradient of the term.
    pub(super) fn solve(&mut self, problem: &LayoutProblem, border: &mut [f64]) -> Vec<f64> {
        let n = border.len();
        let mut columns = [&self.pull, &*border, &self.gradient].concat();
        problem.solve_columns(&mut columns, 3);
        self.pull_solution.copy_from_slice(&columns[..n]);
        let part = self.weight * self.scale * self.scale / self.size;
        let rest = 1.0 - part * dot(&self.pull, &self.pull_solution);
        self.correction = if rest > 0.0 { part / rest } else { 0.0 };
        border.copy_from_slice(&columns[n..2 * n]);
        self.correct(border);
        let mut forward: Vec<f64> = columns[2 * n..].iter().map(|x| -x).collect();
        self.correct(&mut forward);
        forward
    }

    /// Turns a solution of the part with a pattern into one of the whole.
    pub(super) fn correct(&self, x: &mut [f64]) {
        let along = self.correction * dot(&self.pull, x);
        x.iter_mut().zip(&self.pull_solution).for_each(|(x, b)| *x += along * b);
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::Cut;
    use crate::energy::triangles;
    use crate::layout::space::LinearSpace;
    use seamstress_mesh::{Metric, TriMesh};
    use seamstress_testkit as kit;

    /// A flat disk: the energy is least where it is laid out as it is.
    fn disk() -> (LayoutProblem, Vec<f64>) {
        let soup = kit::disk_grid(4, 3);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let cut = Cut::new(&mesh, |_| true);
        let space = LinearSpace::free(cut.n_wedges);
        let mut y = vec![0.0; 2 * cut.n_wedges];
        for h in mesh.halfedges() {
            let [u, v, _] = soup.positions[mesh.origin(h).at()];
            let w = 2 * cut.wedge[h] as usize;
            (y[w], y[w + 1]) = (u / metric.unit, v / metric.unit);
        }
        (LayoutProblem::new(space, triangles(&mesh, &metric, &cut), None).unwrap(), y)
    }

    #[test]
    fn a_solution_is_one_of_the_whole_matrix() {
        let (mut problem, minimum) = disk();
        let mut term = EnergyTerm::new(&mut problem, minimum.clone());
        let n = minimum.len();
        let bent: Vec<f64> = (0..n).map(|k| minimum[k] + 0.1 * (k as f64).sin()).collect();
        problem.assemble_dirichlet();
        let (scale, weight) = (1.3, 20.0);
        term.add_to(&mut problem, &bent, scale, weight);
        problem.factorize(1e-6).unwrap();
        let rhs: Vec<f64> = (0..n).map(|k| (3.0 * k as f64).cos()).collect();
        let mut solution = rhs.clone();
        let forward = term.solve(&problem, &mut solution);
        let whole = |x: &[f64]| {
            let (pattern, values) = problem.matrix();
            let mut out = vec![0.0; n];
            pattern.multiply(values, x, &mut out);
            let part = weight * scale * scale / term.size * dot(&term.pull, x);
            out.iter_mut().zip(&term.pull).for_each(|(y, w)| *y -= part * w);
            out
        };
        let minus: Vec<f64> = term.gradient.iter().map(|g| -g).collect();
        for (x, b) in [(&solution, &rhs), (&forward, &minus)] {
            for (y, b) in whole(x).iter().zip(b) {
                assert!((y - b).abs() < 1e-8 * (1.0 + b.abs()), "{y} {b}");
            }
        }
    }

    #[test]
    fn scaling_the_minimum_costs_nothing_and_bending_it_does() {
        let (mut problem, minimum) = disk();
        let mut term = EnergyTerm::new(&mut problem, minimum.clone());
        let gradient = |term: &mut EnergyTerm, problem: &mut LayoutProblem, y: &[f64]| {
            term.add_to(problem, y, 1.0, 1.0);
            term.gradient.iter().fold(0.0, |largest: f64, g| largest.max(g.abs()))
        };
        let larger: Vec<f64> = minimum.iter().map(|y| 1.1 * y).collect();
        assert!(gradient(&mut term, &mut problem, &larger) < 1e-12);
        let mut bent = minimum;
        bent[3] += 0.1;
        assert!(gradient(&mut term, &mut problem, &bent) > 1e-3);
    }
}
