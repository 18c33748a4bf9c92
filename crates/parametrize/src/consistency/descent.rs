//! Descent over integer indices.

use super::candidates::{Dipole, Here};
use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::resistance::Resistances;
use super::system::System;
use crate::progress::Watch;
use std::collections::BTreeSet;

/// Moves tried together at first; doubled after a success, halved after a failure.
const FIRST_BATCH: usize = 64;
/// Gains below this share of the objective are rounding errors.
const LEAST_GAIN: f64 = 1e-9;
/// Peaks of each kind whose best partners are sought in a thorough round, and cones likewise.
const PEAKS: usize = 8;
const CONES: usize = 32;
/// Columns of the inverse a search may solve for: bounds its time on fields that are all noise.
const MOST_COLUMNS: usize = 1500;

/// The objective as a function of index changes.
pub(super) trait Landscape {
    /// Its value, and half its derivative by the angle sum of each group.
    fn at(&mut self, change: &[i32], watch: &mut Watch<'_, '_>)
    -> Result<Valley, ConsistencyError>;
}

/// The objective at one set of indices.
pub(super) struct Valley {
    pub(super) value: f64,
    pub(super) potential: Vec<f64>,
}

/// How far a descent goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Effort {
    /// Whether best partners of peaks and cones are sought when nothing simpler helps.
    pub(super) thorough: bool,
    /// Evaluations of the landscape.
    pub(super) trials: usize,
}

/// Index changes under way.
pub(super) struct Descent<'a> {
    pub(super) groups: &'a Groups,
    pub(super) system: &'a System,
    pub(super) resistances: Resistances,
    pub(super) change: Vec<i32>,
    /// Accepted batches of moves.
    pub(super) batches: usize,
    /// Units moved to bring indices into their bounds.
    pub(super) impossible_units: usize,
}

impl Descent<'_> {
    /// Sends the units that no triangles could have to the best partners.
    pub(super) fn enter_bounds(
        &mut self,
        landscape: &mut impl Landscape,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), ConsistencyError> {
        for g in 0..self.groups.len() {
            while self.groups.list[g].excess(self.change[g]) != 0 {
                let sign = -self.groups.list[g].excess(self.change[g]).signum();
                let valley = landscape.at(&self.change, watch)?;
                let (groups, system) = (self.groups, self.system);
                let potential = &valley.potential;
                let least = f64::NEG_INFINITY;
                let here = Here { groups, system, change: &self.change, potential, least };
                let partner = here.best_partner(&mut self.resistances, g as u32, sign);
                let open = self.groups.basins[self.groups.list[g].basin as usize].open;
                match partner {
                    Some(dipole) => self.apply(&dipole, 1),
                    None if open => self.change[g] += sign,
                    None => {
                        let vertices = self.groups.of.enumerate();
                        let vertices = vertices.filter(|&(_, &of)| of == g as u32);
                        let vertices = vertices.map(|(v, _)| v.0).collect();
                        return Err(ConsistencyError::Infeasible { vertices });
                    }
                }
                self.impossible_units += 1;
            }
        }
        Ok(())
    }

    /// Lowers the objective by batches of moves until no move known helps.
    pub(super) fn descend(
        &mut self,
        landscape: &mut impl Landscape,
        effort: Effort,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Valley, ConsistencyError> {
        let mut valley = landscape.at(&self.change, watch)?;
        let mut batch = FIRST_BATCH;
        let mut refused = BTreeSet::new();
        let mut sweep = Sweep::default();
        let mut trials = 0;
        while trials < effort.trials {
            watch.pulse()?;
            let mut found = self.candidates(&valley, &mut sweep)?;
            found.retain(|d| !refused.contains(&(d.raise, d.lower)));
            let moves = self.apart(found, batch);
            if moves.is_empty() {
                if !effort.thorough || sweep.is_over() {
                    break;
                }
                sweep.go_on();
                continue;
            }
            moves.iter().for_each(|dipole| self.apply(dipole, 1));
            let next = landscape.at(&self.change, watch)?;
            trials += 1;
            if next.value < valley.value - LEAST_GAIN * (1.0 + valley.value.abs()) {
                valley = next;
                self.batches += 1;
                batch = (2 * moves.len()).max(2);
                refused.clear();
                sweep.success();
            } else {
                moves.iter().for_each(|dipole| self.apply(dipole, -1));
                if let [only] = moves[..] {
                    refused.insert((only.raise, only.lower));
                }
                batch = (moves.len() / 2).max(1);
            }
        }
        Ok(valley)
    }

    fn apply(&mut self, dipole: &Dipole, times: i32) {
        dipole.ends().for_each(|(g, sign)| self.change[g as usize] += times * sign);
    }

    /// Simple moves; in a thorough round also those of peaks and of the next few cones.
    fn candidates(
        &mut self,
        valley: &Valley,
        sweep: &mut Sweep,
    ) -> Result<Vec<Dipole>, ConsistencyError> {
        let mut found = Vec::new();
        let (groups, system, potential) = (self.groups, self.system, &valley.potential);
        let least = LEAST_GAIN * (1.0 + valley.value.abs());
        let here = Here { groups, system, change: &self.change, potential, least };
        here.short(&self.resistances, &mut found);
        let [up, down] = [1, -1].map(|sign| here.peaks(&self.resistances, sign));
        here.paired(&up, &down, &mut found);
        if sweep.thorough && self.resistances.solved < MOST_COLUMNS {
            let mut sources: Vec<(u32, i32)> = Vec::new();
            sources.extend(up.iter().take(PEAKS).map(|&(_, g)| (g, 1)));
            sources.extend(down.iter().take(PEAKS).map(|&(_, g)| (g, -1)));
            sources.extend(sweep.next_cones(self.groups, &self.change));
            here.best_partners(&mut self.resistances, &sources, &mut found);
        } else if sweep.thorough {
            sweep.finish();
        }
        found.sort_by(|a, b| {
            b.gain.total_cmp(&a.gain).then((a.raise, a.lower).cmp(&(b.raise, b.lower)))
        });
        Ok(found)
    }

    /// The best moves, at most `most`, that share no group and no triangle.
    fn apart(&self, found: Vec<Dipole>, most: usize) -> Vec<Dipole> {
        let graph = &self.system.graph;
        let mut taken = vec![false; self.groups.len()];
        let mut chosen = Vec::new();
        for dipole in found {
            if chosen.len() >= most {
                break;
            }
            if dipole.ends().any(|(g, _)| taken[g as usize]) {
                continue;
            }
            for (g, _) in dipole.ends().filter(|&(g, _)| g != FREE) {
                let g = g as usize;
                taken[g] = true;
                let around = graph.offsets[g] as usize..graph.offsets[g + 1] as usize;
                graph.neighbours[around].iter().for_each(|&other| taken[other as usize] = true);
            }
            chosen.push(dipole);
        }
        chosen
    }
}

/// A walk over all cones, a few at a time, that starts anew after each success.
#[derive(Debug, Default)]
struct Sweep {
    thorough: bool,
    cursor: u32,
    /// Rounds since the last success, and how many make a whole walk.
    fruitless: usize,
    rounds: usize,
}

impl Sweep {
    fn go_on(&mut self) {
        if self.thorough {
            self.fruitless += 1;
        }
        self.thorough = true;
    }

    fn success(&mut self) {
        self.fruitless = 0;
    }

    fn finish(&mut self) {
        self.fruitless = self.rounds;
    }

    fn is_over(&self) -> bool {
        self.thorough && self.fruitless >= self.rounds
    }

    /// The next cones as sources: a cone may lose its index to any other place.
    fn next_cones(&mut self, groups: &Groups, change: &[i32]) -> Vec<(u32, i32)> {
        let index = |g: usize| groups.list[g].index + f64::from(change[g]);
        let cones: Vec<u32> =
            (0..change.len()).filter(|&g| index(g).abs() > 0.5).map(|g| g as u32).collect();
        self.rounds = cones.len().div_ceil(CONES).max(1);
        let start = cones.partition_point(|&g| g < self.cursor);
        let count = CONES.min(cones.len());
        let block: Vec<u32> = cones.iter().cycle().skip(start).take(count).copied().collect();
        self.cursor = block.last().map_or(0, |&g| g + 1);
        if self.cursor as usize >= change.len() {
            self.cursor = 0;
        }
        block.into_iter().map(|g| (g, if index(g as usize) > 0.0 { -1 } else { 1 })).collect()
    }
}
