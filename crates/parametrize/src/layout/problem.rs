//! A layout problem: triangles, the space their corners live in, and one factorisation for both.

mod local;

use super::anisotropy::Anisotropy;
use super::element::ElementMap;
use super::penalty::SeamPenalty;
use super::space::LinearSpace;
use crate::cut::Cut;
use crate::energy::{
    Alignment, Energy, ProjectedHessian, Triangle, at_corner, sum_over, triangles,
};
use crate::field::Guide;
use num_complex::Complex64;
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Assembly, Buckets, Cholesky, NotPositiveDefinite, Pattern};
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parallel::both;
use seamstress_parallel::prelude::*;

/// Triangles over a linear space, with everything that is prepared once: element maps, assembly,
/// ordering and symbolic factorisation, workspaces.
pub struct LayoutProblem {
    space: LinearSpace,
    triangles: Vec<Triangle>,
    maps: Vec<ElementMap>,
    assembly: Assembly,
    cholesky: Cholesky<f64>,
    blocks: Vec<f64>,
    locals: Vec<f64>,
    matrix: Vec<f64>,
    /// The block of the matrix that is factored, when the last unknowns are held.
    leading: Option<LeadingBlock>,
    /// Soft seams, only with a free space.
    pub penalty: Option<SeamPenalty>,
}

/// The leading block of a matrix: a pattern of its own, and where its entries lie in the whole.
struct LeadingBlock {
    pattern: Pattern,
    slots: Vec<u32>,
    values: Vec<f64>,
}

impl LeadingBlock {
    fn new(whole: &Pattern, order: usize) -> Self {
        let mut pattern = Pattern { column_offsets: vec![0], rows: Vec::new() };
        let mut slots = Vec::new();
        for column in 0..order {
            for slot in whole.column_offsets[column]..whole.column_offsets[column + 1] {
                let row = whole.rows[slot as usize];
                if (row as usize) < order {
                    pattern.rows.push(row);
                    slots.push(slot);
                }
            }
            pattern.column_offsets.push(pattern.rows.len() as u32);
        }
        Self { values: vec![0.0; slots.len()], pattern, slots }
    }
}

impl LayoutProblem {
    /// Prepares the problem. A penalty needs [`LinearSpace::free`], where unknown pair = wedge.
    ///
    /// # Errors
    /// When the factorisation cannot be set up (memory).
    pub fn new(
        space: LinearSpace,
        triangles: Vec<Triangle>,
        penalty: Option<SeamPenalty>,
    ) -> Result<Self, NotPositiveDefinite> {
        Self::prepared(space, triangles, penalty, None, |space, elements| {
            order_by_nodes(space.nodes(), elements)
        })
    }

    /// The same with a given order of the nodes of the space, and without a penalty.
    ///
    /// # Errors
    /// As [`LayoutProblem::new`].
    pub(crate) fn ordered(
        space: LinearSpace,
        triangles: Vec<Triangle>,
        order: impl FnOnce(&LinearSpace) -> Vec<u32> + Send,
    ) -> Result<Self, NotPositiveDefinite> {
        Self::prepared(space, triangles, None, None, |space, _| {
            by_node(space.nodes(), &order(space))
        })
    }

    /// With an order of the unknowns that follows from the space and the unknowns of the elements; of the first ones
    /// alone, if only so many are free.
    fn prepared(
        space: LinearSpace,
        triangles: Vec<Triangle>,
        penalty: Option<SeamPenalty>,
        n_free: Option<usize>,
        order: impl FnOnce(&LinearSpace, &[Vec<u32>]) -> Vec<u32> + Send,
    ) -> Result<Self, NotPositiveDefinite> {
        let (maps, mut elements): (Vec<_>, Vec<_>) =
            triangles.par_iter().map(|t| ElementMap::new(&space, t)).unzip();
        for wedges in penalty.iter().flat_map(SeamPenalty::elements) {
            elements.push(wedges.iter().flat_map(|&w| [2 * w, 2 * w + 1]).collect());
        }
        let cliques = || elements.iter().map(Vec::as_slice);
        let pattern = Pattern::of_cliques(space.n_unknowns(), cliques());
        let leading = n_free.map(|n_free| LeadingBlock::new(&pattern, n_free));
        let solved = leading.as_ref().map_or(&pattern, |block| &block.pattern);
        let analyze = || Cholesky::analyze(solved, &order(&space, &elements));
        let (cholesky, assembly) = both(analyze, || Assembly::new(pattern.clone(), cliques()));
        let cholesky = cholesky?;
        Ok(Self {
            blocks: vec![0.0; assembly.blocks_len()],
            locals: vec![0.0; assembly.locals_len()],
            matrix: vec![0.0; assembly.pattern().len()],
            space,
            triangles,
            maps,
            assembly,
            cholesky,
            leading,
            penalty,
        })
    }

    /// A problem in which the unknowns from `n_free` on (an even number) are held where they are: the
    /// matrix and gradient are of all unknowns, solves move the first ones only.
    ///
    /// # Errors
    /// As [`LayoutProblem::new`].
    pub fn with_held(
        space: LinearSpace,
        triangles: Vec<Triangle>,
        n_free: usize,
    ) -> Result<Self, NotPositiveDefinite> {
        Self::prepared(space, triangles, None, Some(n_free), |space, elements| {
            let is_free = |&k: &u32| (k as usize) < n_free;
            let free = |unknowns: &Vec<u32>| unknowns.iter().copied().filter(is_free).collect();
            let free: Vec<Vec<u32>> = elements.iter().map(free).collect();
            order_by_nodes(&space.nodes()[..n_free], &free)
        })
    }

    /// Number of unknowns that solves move.
    pub fn n_free(&self) -> usize {
        self.leading.as_ref().map_or(self.space.n_unknowns(), |block| block.pattern.order())
    }

    /// Pattern and values of the assembled matrix, held unknowns included (lower triangle).
    pub fn matrix(&self) -> (&Pattern, &[f64]) {
        (self.assembly.pattern(), &self.matrix)
    }

    /// The space of the unknowns.
    pub fn space(&self) -> &LinearSpace {
        &self.space
    }

    /// The triangles.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Replaces the triangles' shapes and weights (another metric on the same cut).
    pub fn set_metric(&mut self, mesh: &TriMesh, metric: &Metric, cut: &Cut) {
        self.triangles = triangles(mesh, metric, cut);
    }

    /// Pulls the triangles towards the directions of a guide from now on; `strength` is the mean energy that turning all of
    /// them by 45 degrees costs where these count fully.
    pub fn follow(&mut self, guide: &Guide, strength: f64) {
        for ((t, &rotation), weight) in
            self.triangles.iter_mut().zip(guide.rotation.iter()).zip(guide.weight.iter())
        {
            t.wanted = rotation * (strength * weight);
        }
    }

    /// Measures the Jacobians from stretched faces from now on.
    pub fn stretch(&mut self, anisotropy: &Anisotropy) {
        anisotropy.apply(&mut self.triangles);
    }

    /// Entries of the Cholesky factor.
    pub fn factor_len(&self) -> usize {
        self.cholesky.factor_len()
    }

    /// Total energy, penalty included; infinite when a triangle is flipped or collapsed.
    pub fn value(&self, energy: &impl Energy, z: &[Complex64]) -> f64 {
        let sum = sum_over(&self.triangles, |t| {
            let jacobian = t.jacobian(z);
            let (s1, s2) = jacobian.singular_values();
            if energy.allows_flips() || (s2 > 0.0 && t.doubled_area(z) > 0.0) {
                let pull = Alignment::new(t, &jacobian).map_or(0.0, |pull| pull.value(&jacobian));
                t.weight * (energy.value(s1, s2) + pull)
            } else {
                f64::INFINITY
            }
        });
        sum + self.penalty.as_ref().map_or(0.0, |p| p.value(z))
    }

    /// Assembles gradient and projected Hessian; returns the gradient in the unknowns.
    pub fn linearize(&mut self, energy: &impl Energy, z: &[Complex64]) -> Vec<f64> {
        self.fill_triangles(|t, local, block| {
            let jacobian = t.jacobian(z);
            let hessian = ProjectedHessian::new(energy, &jacobian);
            let (mut gradient, mut matrix) = (hessian.gradient, hessian.matrix());
            if let Some(pull) = Alignment::new(t, &jacobian) {
                pull.add_to(&jacobian, &mut gradient, &mut matrix);
            }
            for (k, &g) in t.gradients.iter().enumerate() {
                let [x, y] = at_corner(gradient, g);
                (local[2 * k], local[2 * k + 1]) = (t.weight * x, t.weight * y);
            }
            // Corner coordinates change a row of the Jacobian by their gradient.
            let along = |row: &[f64; 4], i: usize| {
                let ([x, y], at) = (t.gradients[i / 2], 2 * (i % 2));
                row[at] * x + row[at + 1] * y
            };
            let mut at = 0;
            for i in 0..6 {
                let product = matrix.each_ref().map(|row| t.weight * along(row, i));
                for j in 0..=i {
                    block[at] = along(&product, j);
                    at += 1;
                }
            }
        });
        if let Some(penalty) = &self.penalty {
            let first = self.triangles.len();
            penalty.fill(z, &self.assembly, first, &mut self.blocks, &mut self.locals);
        }
        self.assembly.sum_matrix(&self.blocks, &mut self.matrix);
        let mut gradient = vec![0.0; self.space.n_unknowns()];
        self.assembly.sum_vector(&self.locals, &mut gradient);
        gradient
    }

    /// Adds a multiple of other values of the pattern to the assembled matrix.
    pub(crate) fn add_to_matrix(&mut self, values: &[f64], factor: f64) {
        self.matrix.iter_mut().zip(values).for_each(|(sum, x)| *sum += factor * x);
    }

    /// Assembles the Dirichlet form `sum of area |J|^2 / 2` of each coordinate.
    pub fn assemble_dirichlet(&mut self) {
        self.fill_triangles(|t, _, block| {
            let mut at = 0;
            for i in 0..6 {
                for j in 0..=i {
                    let (g, h) = (t.gradients[i / 2], t.gradients[j / 2]);
                    let same = (i % 2 == j % 2) as u8 as f64;
                    block[at] = same * t.weight * (g[0] * h[0] + g[1] * h[1]);
                    at += 1;
                }
            }
        });
        self.assembly.sum_matrix(&self.blocks, &mut self.matrix);
    }

    /// Assembles the conformal form `sum of area (sigma_1 - sigma_2)^2 / 2`, twice the squared
    /// anti-similarity part of the Jacobian.
    pub fn assemble_conformal(&mut self) {
        self.fill_triangles(|t, _, block| {
            // Coefficients of j00 - j11 and j01 + j10 in the corner coordinates.
            let coefficient = |i: usize| {
                let [x, y] = t.gradients[i / 2];
                if i.is_multiple_of(2) { [x, y] } else { [-y, x] }
            };
            let mut at = 0;
            for i in 0..6 {
                for j in 0..=i {
                    let (a, b) = (coefficient(i), coefficient(j));
                    block[at] = t.weight * (a[0] * b[0] + a[1] * b[1]);
                    at += 1;
                }
            }
        });
        self.assembly.sum_matrix(&self.blocks, &mut self.matrix);
    }

    /// Factors the assembled matrix (of the unknowns that are not held), shifted by a fraction of its
    /// mean diagonal that grows until it is positive definite.
    ///
    /// # Errors
    /// When no reasonable shift helps (values that are not finite).
    pub fn factorize(&mut self, shift: f64) -> Result<(), NotPositiveDefinite> {
        let (pattern, values) = match &mut self.leading {
            None => (self.assembly.pattern(), &mut self.matrix),
            Some(block) => {
                for (value, &slot) in block.values.iter_mut().zip(&block.slots) {
                    *value = self.matrix[slot as usize];
                }
                (&block.pattern, &mut block.values)
            }
        };
        let diagonal = pattern.diagonal();
        let mean = diagonal.iter().map(|&k| values[k as usize]).sum::<f64>()
            / diagonal.len().max(1) as f64;
        let mut shift = shift * mean;
        for _ in 0..8 {
            for &k in diagonal {
                values[k as usize] += shift;
            }
            if self.cholesky.factorize(values).is_ok() {
                return Ok(());
            }
            shift = (shift * 100.0).max(1e-12 * mean);
        }
        Err(NotPositiveDefinite)
    }

    /// Factors the assembled matrix, each diagonal entry raised by the given part of itself.
    ///
    /// # Errors
    /// When it is not positive definite to working precision; nothing else is tried.
    pub fn factorize_as_is(&mut self, raise: f64) -> Result<(), NotPositiveDefinite> {
        let pattern = self.assembly.pattern();
        for &k in pattern.diagonal() {
            self.matrix[k as usize] *= 1.0 + raise;
        }
        self.cholesky.factorize(&self.matrix)
    }

    /// Solves with the last factor in place; held unknowns become zero.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let (free, held) = rhs.split_at_mut(self.n_free());
        self.cholesky.solve(free);
        held.fill(0.0);
    }

    /// Solves for several right-hand sides of the free unknowns at once, column after column.
    pub fn solve_columns(&self, rhs: &mut [f64], columns: usize) {
        self.cholesky.solve_columns(rhs, columns);
    }
}

/// Elimination order of the unknowns: nested dissection of the graph of their nodes.
fn order_by_nodes(nodes: &[u32], elements: &[Vec<u32>]) -> Vec<u32> {
    let edges = elements.iter().flat_map(|unknowns| {
        let node = move |k: usize| nodes[unknowns[k] as usize];
        (0..unknowns.len()).flat_map(move |i| (0..i).map(move |j| (node(i), node(j))))
    });
    let n_nodes = nodes.last().map_or(0, |&last| last as usize + 1);
    by_node(nodes, &fill_reducing_order(&Graph::from_edges(n_nodes, edges)))
}

/// The order of unknowns that follows from an order of their nodes.
fn by_node(nodes: &[u32], order: &[u32]) -> Vec<u32> {
    let unknowns = Buckets::new(order.len(), nodes);
    order.iter().flat_map(|&node| unknowns.of(node as usize).iter().copied()).collect()
}
