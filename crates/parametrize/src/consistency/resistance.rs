//! What it costs to send one unit of index from one group to another: effective resistances.

use super::groups::Groups;
use super::system::System;
use std::collections::{BTreeMap, BTreeSet};

/// Effective resistances of the Laplacian over the groups, from its selected inverse and from columns
/// that are kept while there is memory for them.
pub(super) struct Resistances {
    /// The inverse at the entries of the pattern.
    selected: Vec<f64>,
    /// Diagonal of the inverse.
    pub(super) diagonal: Vec<f64>,
    /// Diagonal of the pseudo-inverse: of closed components it does not depend on the pinned group.
    pub(super) centred: Vec<f64>,
    columns: BTreeMap<u32, Vec<f64>>,
    capacity: usize,
    /// Columns solved for so far.
    pub(super) solved: usize,
}

impl Resistances {
    pub(super) fn new(system: &System, groups: &Groups, memory: usize) -> Self {
        let n = groups.len();
        let selected = system.selected_inverse();
        let diagonal: Vec<f64> =
            system.pattern.diagonal().iter().map(|&k| selected[k as usize]).collect();
        let centred = centre(system, groups, &diagonal);
        let capacity = memory / (8 * n.max(1));
        Self { selected, diagonal, centred, columns: BTreeMap::new(), capacity, solved: 0 }
    }

    /// Resistance between two groups that share a triangle, by their place in the pattern.
    pub(super) fn adjacent(&self, i: u32, j: u32, slot: usize) -> f64 {
        self.diagonal[i as usize] + self.diagonal[j as usize] - 2.0 * self.selected[slot]
    }

    /// Resistance between a group and one whose column is given.
    pub(super) fn between(&self, column: &[f64], of: u32, other: u32) -> f64 {
        self.diagonal[of as usize] + self.diagonal[other as usize] - 2.0 * column[other as usize]
    }

    /// A column that was asked for last.
    pub(super) fn column(&self, of: u32) -> Option<&[f64]> {
        self.columns.get(&of).map(Vec::as_slice)
    }

    /// Sees to it that the columns of some groups are there; when memory is short, all others go.
    pub(super) fn columns(&mut self, system: &System, of: &[u32]) {
        let missing: BTreeSet<u32> =
            of.iter().copied().filter(|g| !self.columns.contains_key(g)).collect();
        let missing: Vec<u32> = missing.into_iter().collect();
        if self.columns.len() + missing.len() > self.capacity {
            self.columns.retain(|g, _| of.contains(g));
        }
        self.solved += missing.len();
        self.columns.extend(missing.iter().copied().zip(system.columns(&missing)));
    }
}

/// Diagonal of the pseudo-inverse, `G_gg - 2 (G 1)_g / n + 1' G 1 / n^2` in a closed component.
fn centre(system: &System, groups: &Groups, diagonal: &[f64]) -> Vec<f64> {
    let mut sums = vec![1.0; groups.len()];
    system.solve(&mut sums);
    let n_components = groups.component.iter().max().map_or(0, |&c| c as usize + 1);
    let (mut totals, mut sizes) = (vec![0.0; n_components], vec![0.0; n_components]);
    for (&c, sum) in groups.component.iter().zip(&sums) {
        totals[c as usize] += sum;
        sizes[c as usize] += 1.0;
    }
    let value = |g: usize| {
        let c = groups.component[g] as usize;
        if groups.open[g] {
            return diagonal[g];
        }
        diagonal[g] - 2.0 * sums[g] / sizes[c] + totals[c] / (sizes[c] * sizes[c])
    };
    (0..groups.len()).map(value).collect()
}
