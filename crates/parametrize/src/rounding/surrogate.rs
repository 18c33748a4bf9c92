//! What a set of cones costs, without laying anything out.

use crate::features::Sectors;
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, NotPositiveDefinite, PatternBuilder};
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use seamstress_parallel::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Estimate of the excess distortion of the best map with given cones.
///
/// `E(k) = 8 / A |u|^2_M` with `L u = K - k pi / 2`: -u is the logarithmic scale of the conformal map with
/// these cones, L the cotangent Laplacian, M the vertex areas. Scaling by `e^u` costs `8 u^2` of
/// symmetric Dirichlet energy to second order; the best isometric map costs half as much, by the theory
/// of thin plates, which changes the price of a cone but not the order of preference. u vanishes at free
/// sectors; on a piece of the slit surface without any, its mean does. Pieces do not feel each other
/// across features, which makes the estimate too low there.
pub struct Surrogate<'a> {
    sectors: &'a Sectors<'a>,
    area: VertexData<f64>,
    total: f64,
    pieces: Pieces,
    cholesky: Cholesky<f64>,
    /// Log scale of the present cones, negated.
    scale: Vec<f64>,
    /// `L^-1 M u`: half the gradient of the energy with respect to the curvature.
    gradient: Vec<f64>,
}

/// What happens when one unit of index goes from one sector to another.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// Second-order change of the energy.
    pub quadratic: f64,
    /// Change of the negated log scale at the first and the second sector.
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
        sectors: &'a Sectors<'a>,
        metric: &Metric,
        index: &VertexData<i32>,
    ) -> Result<Self, NotPositiveDefinite> {
        let mesh = sectors.slit();
        let n = mesh.n_vertices();
        let ends = |h| [mesh.origin(h).0, mesh.tip(h).0];
        let mut builder = PatternBuilder::new(n);
        mesh.edges().for_each(|h| builder.add_clique(&ends(h)));
        let pattern = builder.build();
        let edges = mesh.edges().map(|h| (mesh.origin(h).0, mesh.tip(h).0)).collect::<Vec<_>>();
        let order = fill_reducing_order(&Graph::from_edges(n, edges.into_iter()));
        let mut cholesky = Cholesky::analyze(&pattern, &order)?;
        let cotangent = metric.cotangent();
        let area = metric.vertex_area(mesh);
        let pieces = Pieces::new(sectors, &area);
        // Fixed sectors keep a row of their own with a large diagonal.
        let fixed = |s: Vertex| sectors.is_free(s) || pieces.pins(s);
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
        cholesky.factorize(&matrix)?;
        let total = area.iter().sum();
        let mut surrogate = Self {
            sectors,
            area,
            total,
            pieces,
            cholesky,
            scale: Vec::new(),
            gradient: Vec::new(),
        };
        let excess: Vec<f64> = metric
            .curvature(mesh)
            .enumerate()
            .map(|(v, k)| k - f64::from(index[v]) * FRAC_PI_2)
            .collect();
        surrogate.scale = surrogate.solve(excess);
        surrogate.gradient = surrogate.solve(surrogate.weighted(&surrogate.scale));
        Ok(surrogate)
    }

    fn weighted(&self, u: &[f64]) -> Vec<f64> {
        u.iter().zip(self.area.iter()).map(|(u, m)| u * m).collect()
    }

    /// `L^-1 b`, zero at free sectors; the mean of both sides is taken off where there are none.
    fn solve(&self, mut b: Vec<f64>) -> Vec<f64> {
        let sums = self.pieces.sums(b.iter().copied());
        for (s, b) in self.sectors.slit().vertices().zip(&mut b) {
            *b -= self.pieces.mean(&sums, s) * self.area[s];
        }
        self.hold(&mut b);
        self.cholesky.solve_columns(&mut b, 1);
        self.center(&mut b);
        b
    }

    fn hold(&self, b: &mut [f64]) {
        for s in self.sectors.slit().vertices() {
            if self.sectors.is_free(s) || self.pieces.pins(s) {
                b[s.at()] = 0.0;
            }
        }
    }

    fn center(&self, u: &mut [f64]) {
        let sums = self.pieces.sums(u.iter().zip(self.area.iter()).map(|(u, m)| u * m));
        for (s, u) in self.sectors.slit().vertices().zip(u) {
            *u -= self.pieces.mean(&sums, s);
        }
    }

    fn add_dipole(&self, from: Vertex, to: Vertex, b: &mut [f64]) {
        for (v, sign) in [(from, 1.0), (to, -1.0)] {
            if !self.sectors.is_free(v) {
                b[v.at()] += sign * FRAC_PI_2;
            }
        }
    }

    /// The energy.
    pub fn energy(&self) -> f64 {
        let squares = self.scale.iter().zip(self.area.iter()).map(|(u, m)| m * u * u);
        8.0 / self.total * squares.sum::<f64>()
    }

    /// First-order change of the energy when one unit of index goes from one sector to another.
    pub fn linear(&self, from: Vertex, to: Vertex) -> f64 {
        let at = |v: Vertex| {
            if self.sectors.is_free(v) { 0.0 } else { self.gradient[v.at()] }
        };
        8.0 / self.total * 2.0 * FRAC_PI_2 * (at(from) - at(to))
    }

    /// Responses to a unit sent from the first to the second sector of several pairs; they do not depend
    /// on the present cones.
    pub fn responses(&self, pairs: &[(Vertex, Vertex)]) -> Vec<Response> {
        let n = self.sectors.slit().n_vertices();
        pairs
            .par_chunks(BATCH)
            .flat_map_iter(|chunk| {
                let mut columns = vec![0.0; n * chunk.len()];
                for (column, &(from, to)) in columns.chunks_mut(n).zip(chunk) {
                    self.add_dipole(from, to, column);
                    self.hold(column);
                }
                self.cholesky.solve_columns(&mut columns, chunk.len());
                let area = &self.area;
                let values: Vec<Response> = columns
                    .chunks_mut(n)
                    .zip(chunk)
                    .map(|(column, (from, to))| {
                        self.center(column);
                        let squares = column.iter().zip(area.iter()).map(|(u, m)| m * u * u);
                        Response {
                            quadratic: 8.0 / self.total * squares.sum::<f64>(),
                            scale: [column[from.at()], column[to.at()]],
                        }
                    })
                    .collect();
                values
            })
            .collect()
    }

    /// Log scale at a sector, negated.
    pub fn scale(&self, v: Vertex) -> f64 {
        self.scale[v.at()]
    }

    /// Moves one unit of index from one sector to another.
    pub fn transport(&mut self, from: Vertex, to: Vertex) {
        let mut curvature = vec![0.0; self.sectors.slit().n_vertices()];
        self.add_dipole(from, to, &mut curvature);
        let change = self.solve(curvature);
        self.scale.iter_mut().zip(&change).for_each(|(u, d)| *u += d);
        let second = self.solve(self.weighted(&change));
        self.gradient.iter_mut().zip(&second).for_each(|(g, d)| *g += d);
    }
}

/// The connected pieces of the slit surface. Those without a free sector float: their log scale is known
/// up to a constant.
struct Pieces {
    of_sector: VertexData<u32>,
    /// First sector and area of each piece that floats.
    floating: Vec<Option<(Vertex, f64)>>,
}

impl Pieces {
    fn new(sectors: &Sectors<'_>, area: &VertexData<f64>) -> Self {
        let slit = sectors.slit();
        let (of_face, count) = slit.connected_faces();
        let mut of_sector = VertexData::filled(slit.n_vertices(), 0);
        for h in slit.halfedges() {
            of_sector[slit.origin(h)] = of_face[h.face()];
        }
        let mut floating = vec![Some((None, 0.0)); count];
        for s in slit.vertices() {
            let piece = &mut floating[of_sector[s] as usize];
            *piece = match *piece {
                Some((first, sum)) if !sectors.is_free(s) => {
                    Some((first.or(Some(s)), sum + area[s]))
                }
                _ => None,
            };
        }
        let floating = floating.into_iter().map(|piece| Some((piece?.0?, piece?.1))).collect();
        Self { of_sector, floating }
    }

    /// Whether a sector is the one that holds its floating piece.
    fn pins(&self, s: Vertex) -> bool {
        self.floating[self.of_sector[s] as usize].is_some_and(|(first, _)| first == s)
    }

    /// Sum of a value per sector over each piece.
    fn sums(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut sums = vec![0.0; self.floating.len()];
        for (value, piece) in values.zip(self.of_sector.iter()) {
            sums[*piece as usize] += value;
        }
        sums
    }

    /// Sum over the area for the piece of a sector, zero if it does not float.
    fn mean(&self, sums: &[f64], s: Vertex) -> f64 {
        let piece = self.of_sector[s] as usize;
        self.floating[piece].map_or(0.0, |(_, area)| sums[piece] / area)
    }
}

/// Cotangent weight of an edge, kept within [`WEIGHT_RANGE`].
pub(super) fn edge_weight(mesh: &TriMesh, cotangent: &HalfedgeData<f64>, h: Halfedge) -> f64 {
    let sum = cotangent[h] + mesh.twin(h).map_or(0.0, |t| cotangent[t]);
    (sum / 2.0).clamp(WEIGHT_RANGE.0, WEIGHT_RANGE.1)
}
