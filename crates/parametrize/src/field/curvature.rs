//! Curvature of a surface, at a scale.

use super::convert::{axes, cross, dot};
use crate::cotangent::edge_weight;
use num_complex::Complex64;
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern};
use seamstress_mesh::{Face, FaceData, Halfedge, Metric, TriMesh, VertexData};

/// Entries of a symmetric tensor of space, by their places.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// How a face bends, in the units of the metric.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Curvature {
    /// The mean of the principal curvatures.
    pub(crate) mean: f64,
    /// Half their difference, as a number whose argument is twice the angle from the face's first edge to the direction of
    /// least curvature.
    pub(crate) anisotropy: Complex64,
}

/// The bends of the edges of a surface, to average over cells of any size.
pub(crate) struct Bending<'a> {
    mesh: &'a TriMesh,
    axes: FaceData<[[f64; 3]; 2]>,
    /// Columns of integrals over the vertices' cells, one for each entry of a tensor.
    tensors: Vec<f64>,
    diffusion: Diffusion<'a>,
}

impl<'a> Bending<'a> {
    /// The curvature of an edge is its dihedral angle, along it (Cohen-Steiner and Morvan 2003).
    ///
    /// # Errors
    /// When the diffusion cannot be solved.
    pub(crate) fn new(
        mesh: &'a TriMesh,
        positions: &[[f64; 3]],
        metric: &Metric,
    ) -> Result<Self, NotPositiveDefinite> {
        let edges = mesh.edges().map(|h| (mesh.origin(h).0, mesh.tip(h).0));
        let graph = Graph::from_edges(mesh.n_vertices(), edges);
        Self::ordered(mesh, positions, metric, &fill_reducing_order(&graph))
    }

    /// The same where an elimination order of the vertices is known.
    ///
    /// # Errors
    /// When the diffusion cannot be solved.
    pub(crate) fn ordered(
        mesh: &'a TriMesh,
        positions: &[[f64; 3]],
        metric: &Metric,
        order: &[u32],
    ) -> Result<Self, NotPositiveDefinite> {
        let n = mesh.n_vertices();
        let edge = |h: Halfedge| {
            let (a, b) = (positions[mesh.origin(h).at()], positions[mesh.tip(h).at()]);
            [0, 1, 2].map(|k| b[k] / metric.unit - a[k] / metric.unit)
        };
        let axes: FaceData<[[f64; 3]; 2]> =
            mesh.faces().map(|f| axes(mesh, positions, f)).collect();
        let normal = |f: Face| cross(axes[f][0], axes[f][1]);
        let mut tensors = vec![0.0; ENTRIES.len() * n];
        for h in mesh.interior_edges() {
            let Some(t) = mesh.twin(h) else { continue };
            let (edge, left, right) = (edge(h), normal(h.face()), normal(t.face()));
            let length = dot(edge, edge).sqrt();
            if length == 0.0 {
                continue;
            }
            let along = edge.map(|x| x / length);
            let bend = dot(cross(left, right), along).atan2(dot(left, right));
            for (k, (p, q)) in ENTRIES.into_iter().enumerate() {
                let entry = 0.5 * bend * length * along[p] * along[q];
                tensors[k * n + mesh.origin(h).at()] += entry;
                tensors[k * n + mesh.tip(h).at()] += entry;
            }
        }
        let diffusion = Diffusion::new(mesh, metric, order)?;
        Ok(Self { mesh, axes, tensors, diffusion })
    }

    /// The curvature of every face: tensors are averaged over about `radius` by a step of diffusion.
    ///
    /// # Errors
    /// When the diffusion cannot be solved.
    pub(crate) fn averaged(
        &mut self,
        radius: f64,
    ) -> Result<FaceData<Curvature>, NotPositiveDefinite> {
        let (mesh, n) = (self.mesh, self.mesh.n_vertices());
        let mut tensors = self.tensors.clone();
        self.diffusion.spread(radius * radius, &mut tensors)?;
        let of_face = |f: Face| {
            let [x, y] = self.axes[f];
            let corners = mesh.face_vertices(f);
            let mean =
                |k: usize| corners.iter().map(|v| tensors[k * n + v.at()]).sum::<f64>() / 3.0;
            let tensor: [f64; 6] = std::array::from_fn(mean);
            let form = |a: [f64; 3], b: [f64; 3]| {
                let term = |(k, (p, q)): (usize, (usize, usize))| {
                    tensor[k] * if p == q { a[p] * b[p] } else { a[p] * b[q] + a[q] * b[p] }
                };
                ENTRIES.into_iter().enumerate().map(term).sum::<f64>()
            };
            let (xx, yy) = (form(x, x), form(y, y));
            let anisotropy = Complex64::new((xx - yy) / 2.0, form(x, y));
            Curvature { mean: (xx + yy) / 2.0, anisotropy }
        };
        Ok(mesh.faces().map(of_face).collect())
    }
}

/// Turns integrals over cells of vertices into densities, spread by a step of diffusion.
struct Diffusion<'a> {
    mesh: &'a TriMesh,
    pattern: Pattern,
    cholesky: Cholesky<f64>,
    area: VertexData<f64>,
    /// At each edge, in the order of the mesh.
    weights: Vec<f64>,
}

impl<'a> Diffusion<'a> {
    fn new(mesh: &'a TriMesh, metric: &Metric, order: &[u32]) -> Result<Self, NotPositiveDefinite> {
        let n = mesh.n_vertices();
        let ends = |h| [mesh.origin(h).0, mesh.tip(h).0];
        let pattern = Pattern::of_cliques(n, mesh.edges().map(ends));
        let (cotangent, area) = (metric.cotangent(), metric.vertex_area(mesh));
        let weights = mesh.edges().map(|h| edge_weight(mesh, &cotangent, h)).collect();
        let cholesky = Cholesky::analyze(&pattern, order)?;
        Ok(Self { mesh, pattern, cholesky, area, weights })
    }

    fn spread(&mut self, time: f64, columns: &mut [f64]) -> Result<(), NotPositiveDefinite> {
        let (mesh, pattern) = (self.mesh, &self.pattern);
        let mut matrix = vec![0.0; pattern.len()];
        for v in mesh.vertices() {
            // Vertices without a face have a row of their own.
            let area = if self.area[v] > 0.0 { self.area[v] } else { 1.0 };
            matrix[pattern.diagonal()[v.at()] as usize] += area;
        }
        for (h, weight) in mesh.edges().zip(&self.weights) {
            let weight = time * weight;
            let [a, b] = [mesh.origin(h), mesh.tip(h)];
            for v in [a, b] {
                matrix[pattern.diagonal()[v.at()] as usize] += weight;
            }
            if let Some(slot) = pattern.slot(a.0, b.0) {
                matrix[slot as usize] -= weight;
            }
        }
        self.cholesky.factorize(&matrix)?;
        self.cholesky.solve_columns(columns, columns.len() / mesh.n_vertices().max(1));
        Ok(())
    }
}
