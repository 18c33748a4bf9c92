//! The linear space of seamless layouts: wedge positions as exact functions of free unknowns.

use crate::cut::{Cut, SeamGraph};
use crate::quarter::{turn, unit};
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, Vertex};
use seamstress_parallel::prelude::*;
use std::collections::BTreeMap;

/// `z = N y`: the two coordinates of every wedge as sparse real functions of the unknowns `y`.
///
/// Row `2 w` gives u and row `2 w + 1` gives v of wedge `w`. The unknowns of a *node* belong together: the
/// coordinates of a point or of a translation, as far as they are free.
#[derive(Debug, Clone)]
pub struct LinearSpace {
    /// Node of each unknown, ascending without gaps.
    nodes: Vec<u32>,
    offsets: Vec<u32>,
    columns: Vec<u32>,
    coefficients: Vec<f64>,
}

impl LinearSpace {
    /// Every wedge free: `y` holds the coordinates themselves.
    pub fn free(n_wedges: usize) -> Self {
        let n = 2 * n_wedges as u32;
        Self {
            nodes: (0..n).map(|unknown| unknown / 2).collect(),
            offsets: (0..=n).collect(),
            columns: (0..n).collect(),
            coefficients: vec![1.0; n as usize],
        }
    }

    /// From rows over pairs of unknowns, one complex coefficient each.
    pub(crate) fn from_complex(rows: &[Expression], n_pairs: usize) -> Self {
        let parts = |row: &Expression, imaginary: bool| {
            let part = move |(&pair, &c): (&u32, &Complex64)| {
                let (re, im) = if imaginary { (c.im, c.re) } else { (c.re, -c.im) };
                [(2 * pair, re), (2 * pair + 1, im)]
            };
            row.iter().flat_map(part).filter(|(_, c)| *c != 0.0).collect()
        };
        let rows = rows.iter().flat_map(|row| [parts(row, false), parts(row, true)]);
        Self::from_rows((0..2 * n_pairs as u32).map(|unknown| unknown / 2).collect(), rows)
    }

    /// From the node of each unknown and the rows, columns with coefficients.
    pub fn from_rows(nodes: Vec<u32>, rows: impl Iterator<Item = Vec<(u32, f64)>>) -> Self {
        let mut space =
            Self { nodes, offsets: vec![0], columns: Vec::new(), coefficients: Vec::new() };
        for row in rows {
            space.columns.extend(row.iter().map(|(column, _)| column));
            space.coefficients.extend(row.iter().map(|(_, coefficient)| coefficient));
            space.offsets.push(space.columns.len() as u32);
        }
        space
    }

    /// Number of real unknowns.
    pub fn n_unknowns(&self) -> usize {
        self.nodes.len()
    }

    /// Node of each unknown, ascending without gaps.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Number of wedges.
    pub fn n_wedges(&self) -> usize {
        (self.offsets.len() - 1) / 2
    }

    /// Columns and coefficients of a row.
    #[inline]
    pub fn row(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.offsets[row] as usize..self.offsets[row + 1] as usize;
        (&self.columns[range.clone()], &self.coefficients[range])
    }

    /// Wedge positions of the unknowns.
    pub fn expand(&self, y: &[f64]) -> Vec<Complex64> {
        let mut z = vec![Complex64::ZERO; self.n_wedges()];
        self.expand_into(y, &mut z);
        z
    }

    /// The same, into a buffer of one position per wedge.
    pub fn expand_into(&self, y: &[f64], z: &mut [Complex64]) {
        let coordinate = |row: usize| {
            let (columns, coefficients) = self.row(row);
            columns.iter().zip(coefficients).map(|(&j, c)| c * y[j as usize]).sum::<f64>()
        };
        z.par_iter_mut().with_min_len(8192).enumerate().for_each(|(w, z)| {
            *z = Complex64::new(coordinate(2 * w), coordinate(2 * w + 1));
        });
    }

    /// The unknowns of wedge positions in a space without seams, which is every wedge but the pinned one:
    /// everything is moved so that the pinned wedge lies at the origin.
    pub fn restrict(&self, z: &[Complex64]) -> Vec<f64> {
        let free = |w: usize| !self.row(2 * w).0.is_empty();
        let origin = (0..z.len()).find(|&w| !free(w)).map_or(Complex64::ZERO, |w| z[w]);
        let mut y = vec![0.0; self.n_unknowns()];
        for (w, z) in z.iter().enumerate() {
            for (row, value) in [(2 * w, (z - origin).re), (2 * w + 1, (z - origin).im)] {
                if let ([column], [c]) = self.row(row) {
                    y[*column as usize] = value / c;
                }
            }
        }
        y
    }

    /// Transposed product: a vector per wedge pulled back to the unknowns.
    pub fn pull_back(&self, b: &[Complex64]) -> Vec<f64> {
        let mut out = vec![0.0; self.n_unknowns()];
        for (w, value) in b.iter().enumerate() {
            for (row, x) in [(2 * w, value.re), (2 * w + 1, value.im)] {
                let (columns, coefficients) = self.row(row);
                for (&j, c) in columns.iter().zip(coefficients) {
                    out[j as usize] += c * x;
                }
            }
        }
        out
    }
}

/// A complex linear form over wedges (ids below the number of wedges) and chain translations (above).
pub(crate) type Expression = BTreeMap<u32, Complex64>;

fn add_scaled(target: &mut Expression, source: &Expression, factor: Complex64) {
    for (&variable, &c) in source {
        let sum = target.entry(variable).or_default();
        *sum += factor * c;
        if sum.norm_sqr() < 1e-24 {
            target.remove(&variable);
        }
    }
}

/// The exact space of layouts whose seams close up to the given matchings.
///
/// `matching[h]` is the integer r of half-edge `h` with `uv_right = i^r uv_left + t`, negated on
/// twins, zero off the seams; `t` is one translation per chain. The conditions at the nodes are
/// eliminated, with coefficients that are sums of quarter turns divided by `1 - i^k`, exact in floating
/// point for all but the most entangled graphs; one wedge is pinned at the origin against translations.
pub fn seamless_space(
    mesh: &TriMesh,
    cut: &Cut,
    graph: &SeamGraph,
    matching: &HalfedgeData<i32>,
) -> LinearSpace {
    let mut builder = Builder {
        mesh,
        cut,
        graph,
        matching,
        rows: (0..cut.n_wedges as u32).map(|w| Expression::from([(w, Complex64::ONE)])).collect(),
        conditions: Vec::new(),
    };
    for v in mesh.vertices() {
        if graph.is_node[v] {
            builder.walk_node(v);
        } else if graph.degree[v] > 0 {
            builder.link_sides(v);
        }
    }
    builder.eliminate()
}

struct Builder<'a> {
    mesh: &'a TriMesh,
    cut: &'a Cut,
    graph: &'a SeamGraph,
    matching: &'a HalfedgeData<i32>,
    rows: Vec<Expression>,
    conditions: Vec<Expression>,
}

impl Builder<'_> {
    fn translation(&self, chain: u32) -> u32 {
        self.cut.n_wedges as u32 + chain
    }

    /// The expression of the wedge left of an outgoing seam from that of the wedge on its right.
    fn across(&self, seam: Halfedge, right: &Expression) -> Expression {
        let mut left = Expression::new();
        let Some((chain, along)) = self.graph.chain_of[seam] else {
            return right.clone();
        };
        let back = unit(-self.matching[seam]);
        add_scaled(&mut left, right, back);
        let t = Expression::from([(self.translation(chain), Complex64::ONE)]);
        // along the chain: right = i^r left + t; against it: left = i^-r right + t
        add_scaled(&mut left, &t, if along { -back } else { Complex64::ONE });
        left
    }

    /// A vertex inside a chain: its right wedge follows from the left one.
    fn link_sides(&mut self, v: Vertex) {
        for h in self.mesh.outgoing(v) {
            let Some((chain, true)) = self.graph.chain_of[h] else {
                continue;
            };
            let Some(t) = self.mesh.twin(h) else { continue };
            let (left, right) = (self.cut.wedge[h], self.cut.wedge[t.next()]);
            self.rows[right as usize] = Expression::from([
                (left, unit(self.matching[h])),
                (self.translation(chain), Complex64::ONE),
            ]);
        }
    }

    /// A node: walk its fan counter-clockwise from one wedge; an interior one must close.
    fn walk_node(&mut self, v: Vertex) {
        let mut fan: Vec<Halfedge> = self.mesh.outgoing(v).collect();
        let closed = !self.mesh.is_boundary(v);
        if closed {
            let first = fan.iter().position(|&h| self.cut.is_seam[h]).unwrap_or(0);
            fan.rotate_left(first);
        }
        let start = self.cut.wedge[fan[0]];
        let mut current = Expression::from([(start, Complex64::ONE)]);
        for &h in &fan[1..] {
            if self.cut.is_seam[h] {
                current = self.across(h, &current);
                self.rows[self.cut.wedge[h] as usize] = current.clone();
            }
        }
        if closed {
            let mut condition = self.across(fan[0], &current);
            add_scaled(
                &mut condition,
                &Expression::from([(start, Complex64::ONE)]),
                -Complex64::ONE,
            );
            if !condition.is_empty() {
                self.conditions.push(condition);
            }
        }
    }

    /// Solves the conditions for one variable each and numbers what is left.
    fn eliminate(self) -> LinearSpace {
        let n_wedges = self.cut.n_wedges as u32;
        let weight = |variable: u32| {
            // Prefer wedges of cones, then the translation that the fewest rows use.
            if variable < n_wedges {
                0
            } else {
                self.graph.chains[(variable - n_wedges) as usize].left.len()
            }
        };
        let mut solved: BTreeMap<u32, Expression> = BTreeMap::new();
        let mut sequence = Vec::new();
        for condition in self.conditions {
            let mut condition = substitute(condition, &solved);
            // Large coefficients first: quarter turns, 2 and 1 + i keep everything exact.
            let size = |c: Complex64| (c.norm_sqr() * 16.0).round() as i64;
            let Some(pivot) = condition
                .iter()
                .min_by_key(|(v, c)| (-size(**c).min(16), weight(**v), **v))
                .map(|(&v, _)| v)
            else {
                continue;
            };
            let Some(c) = condition.remove(&pivot) else {
                continue;
            };
            let mut value = Expression::new();
            add_scaled(&mut value, &condition, -Complex64::ONE / c);
            solved.insert(pivot, value);
            sequence.push(pivot);
        }
        // Later solutions hold no earlier pivot, so resolving backwards takes one pass.
        for &pivot in sequence.iter().rev() {
            if let Some(value) = solved.remove(&pivot) {
                let value = substitute(value, &solved);
                solved.insert(pivot, value);
            }
        }
        let mut rows: Vec<Expression> =
            self.rows.into_iter().map(|row| substitute(row, &solved)).collect();
        if let Some(pinned) = pinned_variable(&rows, n_wedges, self.graph, self.matching) {
            rows.iter_mut().for_each(|row| {
                row.remove(&pinned);
            });
        }
        let mut number = BTreeMap::new();
        for &variable in rows.iter().flat_map(|row| row.keys()) {
            number.insert(variable, 0u32);
        }
        for (k, id) in number.values_mut().enumerate() {
            *id = k as u32;
        }
        for row in &mut rows {
            *row = row.iter().map(|(v, &c)| (number[v], c)).collect();
        }
        LinearSpace::from_complex(&rows, number.len())
    }
}

/// Replaces solved variables until none is left.
fn substitute(mut expression: Expression, solved: &BTreeMap<u32, Expression>) -> Expression {
    loop {
        let hit = expression.keys().copied().find(|v| solved.contains_key(v));
        let Some(variable) = hit else {
            return expression;
        };
        if let Some(c) = expression.remove(&variable) {
            add_scaled(&mut expression, &solved[&variable], c);
        }
    }
}

/// A variable that moves when the whole layout is translated: an ordinary wedge if there is one, else
/// the translation of a chain with a rotation.
fn pinned_variable(
    rows: &[Expression],
    n_wedges: u32,
    graph: &SeamGraph,
    matching: &HalfedgeData<i32>,
) -> Option<u32> {
    let mut uses = vec![0u32; rows.len()];
    for &variable in rows.iter().flat_map(|row| row.keys()) {
        if variable < n_wedges {
            uses[variable as usize] += 1;
        }
    }
    let alone = uses.iter().position(|&n| n == 1).or_else(|| uses.iter().position(|&n| n > 0));
    alone.map(|w| w as u32).or_else(|| {
        let used: std::collections::BTreeSet<u32> =
            rows.iter().flat_map(|row| row.keys().copied()).collect();
        used.into_iter().find(|&variable| {
            let chain = &graph.chains[(variable - n_wedges) as usize];
            chain.left.first().is_some_and(|&h| matching[h].rem_euclid(4) != 0)
        })
    })
}

/// Residual of the seam conditions: the largest mismatch `|e_right - i^r e_left|`.
pub fn seam_residual(
    mesh: &TriMesh,
    cut: &Cut,
    matching: &HalfedgeData<i32>,
    z: &[Complex64],
) -> f64 {
    let mismatch = |&h: &Halfedge| {
        let [a, b, c, d] = cut.seam_wedges(mesh, h).map(|w| z[w as usize]);
        ((d - c) - turn(b - a, matching[h])).norm()
    };
    cut.seams.iter().map(mismatch).fold(0.0, f64::max)
}
