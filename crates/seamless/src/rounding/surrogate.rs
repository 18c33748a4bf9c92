//! What a set of cones costs, without laying anything out.

use rayon::prelude::*;
use seamstress_numerics::ordering::{Graph, nested_dissection};
use seamstress_numerics::{Cholesky, Kernel, NotPositiveDefinite, PatternBuilder};
use seamstress_surface::{Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use std::f64::consts::FRAC_PI_2;

/// Estimate of the excess distortion of the best map with given cones.
///
/// `E(k) = 8 / A |u|^2_M` with `L u = K - k pi / 2`: -u is the logarithmic scale of the conformal map with
/// these cones, L the cotangent Laplacian, M the vertex areas. Scaling by `e^u` costs `8 u^2` of
/// symmetric Dirichlet energy to second order; the best isometric map costs half as much, by the theory
/// of thin plates, which changes the price of a cone but not the order of preference. u vanishes on the
/// boundary; on a closed surface its mean does.
pub struct Surrogate<'a> {
    mesh: &'a TriMesh,
    area: VertexData<f64>,
    total: f64,
    closed: bool,
    cholesky: Cholesky<f64>,
    /// Log scale of the present cones, negated.
    scale: Vec<f64>,
    /// `L^-1 M u`: half the gradient of the energy with respect to the curvature.
    gradient: Vec<f64>,
}

/// What happens when one unit of index goes from one vertex to another.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// Second-order change of the energy.
    pub quadratic: f64,
    /// Change of the negated log scale at the first and the second vertex.
    pub scale: [f64; 2],
}

/// Cotangent weights of edges are kept in this range: needles would drown everything else.
const WEIGHT_RANGE: (f64, f64) = (0.02, 20.0);
/// Right-hand sides solved together.
const BATCH: usize = 8;

impl<'a> Surrogate<'a> {
    /// Factors the Laplacian and evaluates the present cones.
    ///
    /// # Errors
    /// When the Laplacian cannot be factored.
    pub fn new(
        mesh: &'a TriMesh,
        metric: &Metric,
        index: &VertexData<i32>,
    ) -> Result<Self, NotPositiveDefinite> {
        let n = mesh.n_vertices();
        let ends = |h| [mesh.origin(h).0, mesh.tip(h).0];
        let mut builder = PatternBuilder::new(n);
        mesh.edges().for_each(|h| builder.add_clique(&ends(h)));
        let pattern = builder.build();
        let edges = mesh.edges().map(|h| (mesh.origin(h).0, mesh.tip(h).0)).collect::<Vec<_>>();
        let order = nested_dissection(&Graph::from_edges(n, edges.into_iter()));
        let mut cholesky = Cholesky::analyze_for(Kernel::Simplicial, &pattern, &order)?;
        let cotangent = metric.cotangent();
        let closed = !mesh.has_boundary();
        // Fixed vertices keep a row of their own with a large diagonal.
        let fixed = |v: Vertex| {
            if closed { v.0 == 0 } else { mesh.is_boundary(v) }
        };
        let mut matrix = vec![0.0; pattern.len()];
        for h in mesh.edges() {
            let weight = edge_weight(mesh, &cotangent, h);
            let [a, b] = ends(h);
            for v in [a, b] {
                matrix[pattern.diagonal()[v as usize] as usize] += weight;
            }
            if let Some(slot) =
                pattern.slot(a, b).filter(|_| !fixed(Vertex(a)) && !fixed(Vertex(b)))
            {
                matrix[slot as usize] -= weight;
            }
        }
        cholesky.factorize(&pattern, &matrix)?;
        let area = metric.vertex_area(mesh);
        let total = area.iter().sum();
        let mut surrogate =
            Self { mesh, area, total, closed, cholesky, scale: Vec::new(), gradient: Vec::new() };
        let excess: Vec<f64> = metric
            .curvature(mesh)
            .enumerate()
            .map(|(v, k)| k - f64::from(index[v]) * FRAC_PI_2)
            .collect();
        surrogate.scale = surrogate.solve(excess);
        surrogate.gradient = surrogate.solve(surrogate.weighted(&surrogate.scale));
        Ok(surrogate)
    }

    fn is_fixed(&self, v: Vertex) -> bool {
        if self.closed { v.0 == 0 } else { self.mesh.is_boundary(v) }
    }

    fn weighted(&self, u: &[f64]) -> Vec<f64> {
        u.iter().zip(self.area.iter()).map(|(u, m)| u * m).collect()
    }

    /// `L^-1 b` with the boundary at zero or, on a closed surface, the mean of both sides.
    fn solve(&self, mut b: Vec<f64>) -> Vec<f64> {
        self.prepare(&mut b);
        // The only failure is memory, which the factor needed far more of.
        let _ = self.cholesky.solve_columns(&mut b, 1);
        self.center(&mut b);
        b
    }

    fn prepare(&self, b: &mut [f64]) {
        if self.closed {
            let mean = b.iter().sum::<f64>() / self.total;
            b.iter_mut().zip(self.area.iter()).for_each(|(b, m)| *b -= mean * m);
        }
        self.hold(b);
    }

    fn hold(&self, b: &mut [f64]) {
        for v in self.mesh.vertices().filter(|&v| self.is_fixed(v)) {
            b[v.at()] = 0.0;
        }
    }

    fn center(&self, u: &mut [f64]) {
        if self.closed {
            let mean = u.iter().zip(self.area.iter()).map(|(u, m)| u * m).sum::<f64>() / self.total;
            u.iter_mut().for_each(|u| *u -= mean);
        }
    }

    fn add_dipole(&self, from: Vertex, to: Vertex, b: &mut [f64]) {
        for (v, sign) in [(from, 1.0), (to, -1.0)] {
            if !self.mesh.is_boundary(v) {
                b[v.at()] += sign * FRAC_PI_2;
            }
        }
    }

    /// The energy.
    pub fn energy(&self) -> f64 {
        let squares = self.scale.iter().zip(self.area.iter()).map(|(u, m)| m * u * u);
        8.0 / self.total * squares.sum::<f64>()
    }

    /// First-order change of the energy when one unit of index goes from one vertex to another.
    pub fn linear(&self, from: Vertex, to: Vertex) -> f64 {
        let at = |v: Vertex| {
            if self.mesh.is_boundary(v) { 0.0 } else { self.gradient[v.at()] }
        };
        8.0 / self.total * 2.0 * FRAC_PI_2 * (at(from) - at(to))
    }

    /// Responses to a unit sent from the first to the second vertex of several pairs; they do not depend
    /// on the present cones.
    pub fn responses(&self, pairs: &[(Vertex, Vertex)]) -> Vec<Response> {
        let n = self.mesh.n_vertices();
        pairs
            .par_chunks(BATCH)
            .flat_map_iter(|chunk| {
                let mut columns = vec![0.0; n * chunk.len()];
                for (column, &(from, to)) in columns.chunks_mut(n).zip(chunk) {
                    self.add_dipole(from, to, column);
                    self.hold(column);
                }
                let solved = self.cholesky.solve_columns(&mut columns, chunk.len()).is_ok();
                let area = &self.area;
                let values: Vec<Response> = columns
                    .chunks_mut(n)
                    .zip(chunk)
                    .map(|(column, (from, to))| {
                        self.center(column);
                        let squares = column.iter().zip(area.iter()).map(|(u, m)| m * u * u);
                        let quadratic = 8.0 / self.total * squares.sum::<f64>();
                        Response {
                            quadratic: if solved { quadratic } else { f64::INFINITY },
                            scale: [column[from.at()], column[to.at()]],
                        }
                    })
                    .collect();
                values
            })
            .collect()
    }

    /// Log scale at a vertex, negated.
    pub fn scale(&self, v: Vertex) -> f64 {
        self.scale[v.at()]
    }

    /// Moves one unit of index from one vertex to another.
    pub fn transport(&mut self, from: Vertex, to: Vertex) {
        let mut curvature = vec![0.0; self.mesh.n_vertices()];
        self.add_dipole(from, to, &mut curvature);
        let change = self.solve(curvature);
        self.scale.iter_mut().zip(&change).for_each(|(u, d)| *u += d);
        let second = self.solve(self.weighted(&change));
        self.gradient.iter_mut().zip(&second).for_each(|(g, d)| *g += d);
    }
}

/// Cotangent weight of an edge, kept within [`WEIGHT_RANGE`].
pub(super) fn edge_weight(mesh: &TriMesh, cotangent: &HalfedgeData<f64>, h: Halfedge) -> f64 {
    let sum = cotangent[h] + mesh.twin(h).map_or(0.0, |t| cotangent[t]);
    (sum / 2.0).clamp(WEIGHT_RANGE.0, WEIGHT_RANGE.1)
}
