//! The linear system behind the angles.
//!
//! Minimising `sum w^-1 delta^2` over changes of angles with given sums in triangles and groups leaves,
//! when the triangles are eliminated, a Laplacian over the groups: of each triangle
//! `diag(w) - w w' / sum w`.

use super::groups::FREE;
use crate::cut::DisjointSets;
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern, PatternBuilder};

/// By what share of itself a pinned group's diagonal grows: where the matrix is singular, and where it may
/// be nearly so. Steps of the interior point may be a little inexact.
const PIN: f64 = 1.0;
const LIGHT_PIN: f64 = 1e-9;
/// Right-hand sides solved together.
const BATCH: usize = 8;

/// Pattern and factor of the Laplacian over the groups.
pub(super) struct System {
    /// Group of each corner.
    pub(super) group: Vec<u32>,
    pub(super) pattern: Pattern,
    /// Groups that share a triangle.
    pub(super) graph: Graph,
    pinned: Vec<u32>,
    order: Vec<u32>,
    /// Entries of each face: 00, 10, 11, 20, 21, 22; `FREE` where a corner is free.
    slots: Vec<[u32; 6]>,
    values: Vec<f64>,
    cholesky: Cholesky<f64>,
}

impl System {
    /// Of triangles with the groups of their corners, three in a row; `n` groups in all.
    pub(super) fn new(group: Vec<u32>, n: usize) -> Result<Self, NotPositiveDefinite> {
        let mut builder = PatternBuilder::new(n);
        let mut edges = Vec::with_capacity(group.len());
        for corners in group.chunks_exact(3) {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (corners[a], corners[b]);
                if a != FREE && b != FREE && a != b {
                    builder.add_clique(&[a, b]);
                    edges.push((a, b));
                }
            }
        }
        let pattern = builder.build();
        let graph = Graph::from_edges(n, edges.into_iter());
        let order = fill_reducing_order(&graph);
        let slot = |a: u32, b: u32| pattern.slot(a, b).unwrap_or(FREE);
        let slots = group
            .chunks_exact(3)
            .map(|c| {
                let pairs = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];
                pairs.map(|(i, j)| slot(c[i], c[j]))
            })
            .collect();
        let cholesky = Cholesky::analyze(&pattern, &order)?;
        let values = vec![0.0; pattern.len()];
        let pinned = pinned(&group, n);
        Ok(Self { group, pattern, graph, pinned, order, slots, values, cholesky })
    }

    /// The same system with a factor of its own.
    pub(super) fn twin(&self) -> Result<Self, NotPositiveDefinite> {
        Ok(Self {
            group: self.group.clone(),
            pattern: self.pattern.clone(),
            graph: self.graph.clone(),
            pinned: self.pinned.clone(),
            order: self.order.clone(),
            slots: self.slots.clone(),
            values: self.values.clone(),
            cholesky: Cholesky::analyze(&self.pattern, &self.order)?,
        })
    }

    /// Factors the Laplacian of the corner weights plus a diagonal. A group of
    /// each closed component is pinned, as lightly as will do.
    pub(super) fn factorize(
        &mut self,
        weights: &[f64],
        slack: f64,
    ) -> Result<(), NotPositiveDefinite> {
        if self.values.is_empty() {
            return Ok(());
        }
        self.values.fill(0.0);
        for (f, slots) in self.slots.iter().enumerate() {
            let w = &weights[3 * f..3 * f + 3];
            let sum = w[0] + w[1] + w[2];
            for (&slot, (i, j)) in
                slots.iter().zip([(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)])
            {
                if slot == FREE {
                    continue;
                }
                let value = &mut self.values[slot as usize];
                if i == j {
                    // w - w^2 / sum without cancellation, for the weights differ by many orders.
                    *value += w[i] * ((w[(i + 1) % 3] + w[(i + 2) % 3]) / sum);
                } else {
                    // Two corners of one group meet on the diagonal, once from each side.
                    let twice = self.group[3 * f + i] == self.group[3 * f + j];
                    *value -= w[i] * w[j] / sum * if twice { 2.0 } else { 1.0 };
                }
            }
        }
        let diagonal = self.pattern.diagonal();
        diagonal.iter().for_each(|&k| self.values[k as usize] += slack);
        let pin = if slack == 0.0 { PIN } else { LIGHT_PIN };
        for &g in &self.pinned {
            let value = &mut self.values[diagonal[g as usize] as usize];
            *value = if *value > 0.0 { *value * (1.0 + pin) } else { 1.0 };
        }
        self.cholesky.factorize(&self.values)
    }

    /// Overwrites a right-hand side with the solution.
    pub(super) fn solve(&self, rhs: &mut [f64]) {
        self.cholesky.solve_columns(rhs, 1);
    }

    /// Columns of the inverse.
    pub(super) fn columns(&self, of: &[u32]) -> Vec<Vec<f64>> {
        let n = self.pattern.order();
        let mut columns = Vec::with_capacity(of.len());
        for chunk in of.chunks(BATCH) {
            let mut block = vec![0.0; n * chunk.len()];
            for (column, &g) in block.chunks_exact_mut(n).zip(chunk) {
                column[g as usize] = 1.0;
            }
            self.cholesky.solve_columns(&mut block, chunk.len());
            columns.extend(block.chunks_exact(n).map(<[f64]>::to_vec));
        }
        columns
    }

    /// The inverse at the entries of the pattern.
    pub(super) fn selected_inverse(&self) -> Vec<f64> {
        self.cholesky.selected_inverse(&self.pattern)
    }
}

/// The first group of every set of groups joined by triangles that no free corner grounds.
fn pinned(group: &[u32], n: usize) -> Vec<u32> {
    let mut joined = DisjointSets::new(n);
    for corners in group.chunks_exact(3) {
        let mut bound = corners.iter().copied().filter(|&g| g != FREE);
        if let Some(first) = bound.next() {
            bound.for_each(|other| {
                joined.unite(first, other);
            });
        }
    }
    let mut settled = vec![false; n];
    for corners in group.chunks_exact(3).filter(|corners| corners.contains(&FREE)) {
        for &g in corners.iter().filter(|&&g| g != FREE) {
            settled[joined.find(g) as usize] = true;
        }
    }
    let is_first = |g: &u32| !std::mem::replace(&mut settled[joined.find(*g) as usize], true);
    (0..n as u32).filter(is_first).collect()
}
