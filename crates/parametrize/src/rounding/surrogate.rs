//! What a set of cones costs, without laying anything out.

use crate::cotangent::edge_weight;
use crate::features::Sectors;
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern};
use seamstress_mesh::{Metric, Vertex, VertexData};
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
///
/// It is quadratic in the indices, so that the change for a unit of index that goes anywhere follows exactly from the
/// gradient, the responses to a unit at either end, and the diagonal of these.
pub struct Surrogate<'a> {
    sectors: &'a Sectors<'a>,
    area: VertexData<f64>,
    total: f64,
    pieces: Pieces,
    /// Sectors whose log scale is not solved for: free ones, and one of each piece without any.
    held: Vec<Vertex>,
    cholesky: Cholesky<f64>,
    /// Log scale of the present cones, negated.
    scale: Vec<f64>,
    /// `L^-1 M u`: half the gradient of the energy with respect to the curvature.
    gradient: Vec<f64>,
    /// `P m` for the areas m, where `P` is the inverse in which pins are held, and its mean over each piece.
    of_area: Vec<f64>,
    mean_of_area: Vec<f64>,
    /// Change of the gradient at every sector for a unit of index less there.
    own: VertexData<f64>,
}

/// What a unit of index less at one sector changes at all others: half the gradient of the energy, its value there taken
/// from that at the sector itself. (Single precision is enough: values are used in differences, and small near the
/// sector.)
pub struct Response(Vec<f32>);

/// Right-hand sides solved together.
const BATCH: usize = 4;
/// The diagonal of `L^-1 M L^-1` is a difference quotient of that of `(L + t M)^-1` with t this over the whole area: a
/// thousandth of the least eigenvalue, far above rounding errors.
const QUOTIENT_STEP: f64 = 2e-4;

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
        let pattern = Pattern::of_cliques(n, mesh.edges().map(ends));
        let mut cholesky = Cholesky::analyze(&pattern, &sectors.order())?;
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
            held: mesh.vertices().filter(|&s| fixed(s)).collect(),
            pieces,
            cholesky,
            scale: Vec::new(),
            gradient: Vec::new(),
            of_area: Vec::new(),
            mean_of_area: Vec::new(),
            own: VertexData::filled(n, 0.0),
        };
        surrogate.of_area = surrogate.held_solution(surrogate.area.to_vec());
        let weighted = surrogate.weighted(&surrogate.of_area);
        surrogate.mean_of_area = surrogate.pieces.means(weighted.into_iter());
        surrogate.own = surrogate.own_responses(&pattern, &matrix)?;
        surrogate.refresh(metric, index);
        Ok(surrogate)
    }

    /// The diagonal of `T M T` with `T` what [`Self::solve`] does, for a unit, from that of `P M P` with `P` the inverse in
    /// which pins are held.
    fn own_responses(
        &mut self,
        pattern: &Pattern,
        matrix: &[f64],
    ) -> Result<VertexData<f64>, NotPositiveDefinite> {
        let t = QUOTIENT_STEP / self.total;
        let sectors = || self.sectors.slit().vertices();
        let mut held = VertexData::filled(self.area.len(), false);
        self.held.iter().for_each(|&s| held[s] = true);
        let slot = |s: Vertex| pattern.diagonal()[s.at()] as usize;
        let [low, high] = [-t, t].map(|t| {
            let mut shifted = matrix.to_vec();
            for s in sectors().filter(|&s| !held[s]) {
                shifted[slot(s)] += t * self.area[s];
            }
            self.cholesky.factorize(&shifted).map(|()| self.cholesky.selected_inverse(pattern))
        });
        let (low, high) = (low?, high?);
        self.cholesky.factorize(matrix)?;
        // h = P m and p = P M h, with their means over each piece.
        let (h, mean_h) = (&self.of_area, &self.mean_of_area);
        let p = self.held_solution(self.weighted(h));
        let mean_p = &self.pieces.means(self.weighted(&p).into_iter());
        let of = |s: Vertex| {
            let slope = (low[slot(s)] - high[slot(s)]) / (2.0 * t);
            let held = if held[s] { 0.0 } else { slope };
            let means = self.pieces.floating_area(s).map_or(0.0, |area| {
                let (h, p) = (h[s.at()], p[s.at()]);
                let [mean_h, mean_p] =
                    [mean_h, mean_p].map(|m| m[self.pieces.of_sector[s] as usize]);
                (mean_p - mean_h * mean_h - h * h - 2.0 * (p - h * mean_h)) / area
            });
            (held + means) * FRAC_PI_2
        };
        Ok(sectors().map(of).collect())
    }

    fn weighted(&self, u: &[f64]) -> Vec<f64> {
        u.iter().zip(self.area.iter()).map(|(u, m)| u * m).collect()
    }

    /// Overwrites columns b with `L^-1 b`, zero at free sectors; the mean of both sides is taken off where there are
    /// none.
    fn solve(&self, columns: &mut [f64]) {
        let n = self.area.len();
        for b in columns.chunks_exact_mut(n) {
            let means = self.pieces.means(b.iter().copied());
            for ((b, piece), area) in
                b.iter_mut().zip(self.pieces.of_sector.iter()).zip(self.area.iter())
            {
                *b -= means[*piece as usize] * area;
            }
            self.hold(b);
        }
        self.cholesky.solve_columns(columns, columns.len() / n);
        for u in columns.chunks_exact_mut(n) {
            let means = self.pieces.means(u.iter().zip(self.area.iter()).map(|(u, m)| u * m));
            for (u, piece) in u.iter_mut().zip(self.pieces.of_sector.iter()) {
                *u -= means[*piece as usize];
            }
        }
    }

    /// `P b`.
    fn held_solution(&self, mut b: Vec<f64>) -> Vec<f64> {
        self.hold(&mut b);
        self.cholesky.solve_columns(&mut b, 1);
        b
    }

    fn solved(&self, mut b: Vec<f64>) -> Vec<f64> {
        self.solve(&mut b);
        b
    }

    fn hold(&self, b: &mut [f64]) {
        self.held.iter().for_each(|s| b[s.at()] = 0.0);
    }

    /// The energy.
    pub fn energy(&self) -> f64 {
        let squares = self.scale.iter().zip(self.area.iter()).map(|(u, m)| m * u * u);
        8.0 / self.total * squares.sum::<f64>()
    }

    /// Change of the energy when a unit of index leaves `near` for `far`, or the other way if `sign` is negative: exact,
    /// with the response to a unit at `near`.
    pub fn change(&self, sign: i32, [near, far]: [Vertex; 2], of_near: &Response) -> f64 {
        let linear = f64::from(sign) * (self.gradient[near.at()] - self.gradient[far.at()]);
        // Of the diagonal a difference, in which its error is the same on both sides.
        let own = self.own[far] - self.own[near];
        let quadratic = 2.0 * f64::from(of_near.0[far.at()]) + own;
        8.0 / self.total * FRAC_PI_2 * (2.0 * linear + quadratic)
    }

    /// Responses to a unit at each of some sectors.
    pub fn responses(&self, at: &[Vertex]) -> Vec<Response> {
        let n = self.area.len();
        let of_chunk = |chunk: &[Vertex]| {
            let mut columns = vec![0.0; n * chunk.len()];
            for (column, v) in columns.chunks_exact_mut(n).zip(chunk) {
                column[v.at()] = FRAC_PI_2;
                self.hold(column);
            }
            // The way forwards is short for columns that are zero but for one sector.
            self.cholesky.solve_columns(&mut columns, chunk.len());
            let each = columns.chunks_exact_mut(n).zip(chunk);
            let means: Vec<f64> = each.map(|(column, &v)| self.weigh(column, v)).collect();
            self.cholesky.solve_columns(&mut columns, chunk.len());
            let each = columns.chunks_exact(n).zip(chunk).zip(means);
            let falls = each.map(|((column, v), mean)| {
                let (own, piece) = (column[v.at()], self.pieces.of_sector[*v]);
                let here = column.iter().zip(self.pieces.of_sector.iter());
                let at = |(g, &of)| own - if of == piece { g } else { &mean };
                Response(here.map(|g| at(g) as f32).collect())
            });
            falls.collect::<Vec<_>>()
        };
        at.par_chunks(BATCH).flat_map_iter(of_chunk).collect()
    }

    /// Overwrites `P e`, for a unit of index at a sector, with `M T e`, where `T` is what [`Self::solve`] does: the means of both
    /// sides follow from `P m`. Pins are left out; returns the mean of the solution for what is left, on the sector's piece.
    fn weigh(&self, column: &mut [f64], v: Vertex) -> f64 {
        let (piece, floating) = (self.pieces.of_sector[v], self.pieces.floating_area(v));
        let (share, at_v) = floating.map_or((0.0, 0.0), |whole| {
            let mean = self.mean_of_area[piece as usize];
            (FRAC_PI_2 / whole, self.of_area[v.at()] - mean)
        });
        let sectors = self.area.iter().zip(&self.of_area).zip(self.pieces.of_sector.iter());
        let mut sum = 0.0;
        for (u, ((m, h), &of)) in column.iter_mut().zip(sectors) {
            *u = if of == piece { m * (*u - share * (h + at_v)) } else { 0.0 };
            sum += h * *u;
        }
        self.hold(column);
        floating.map_or(0.0, |whole| sum / whole)
    }

    /// Moves one unit of index between two sectors with these responses. The gradient is then off by a constant and by
    /// single precision, and the energy is that of before, until [`Self::refresh`].
    pub fn transport(&mut self, from: &Response, to: &Response) {
        for ((g, a), b) in self.gradient.iter_mut().zip(&from.0).zip(&to.0) {
            *g += f64::from(*b) - f64::from(*a);
        }
    }

    /// Evaluates cones.
    pub fn refresh(&mut self, metric: &Metric, index: &VertexData<i32>) {
        let curvature = metric.curvature(self.sectors.slit());
        let excess = curvature.iter().zip(index.iter());
        let excess = excess.map(|(k, &index)| k - f64::from(index) * FRAC_PI_2).collect();
        self.scale = self.solved(excess);
        self.gradient = self.solved(self.weighted(&self.scale));
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

    /// The area of the piece of a sector, if it floats.
    fn floating_area(&self, s: Vertex) -> Option<f64> {
        self.floating[self.of_sector[s] as usize].map(|(_, area)| area)
    }

    /// Sums of a value per sector over each piece, by its area; zero for pieces that do not float.
    fn means(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut sums = vec![0.0; self.floating.len()];
        for (value, piece) in values.zip(self.of_sector.iter()) {
            sums[*piece as usize] += value;
        }
        let means = sums.iter().zip(&self.floating);
        means.map(|(sum, floating)| floating.map_or(0.0, |(_, area)| sum / area)).collect()
    }
}
