//! Index moves worth trying.

use super::groups::{FREE, Groups};
use super::resistance::Resistances;
use super::system::System;
use std::f64::consts::FRAC_PI_2;

/// One unit of index from one group to another; [`FREE`] stands for the boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dipole {
    /// How much the objective falls, by a quadratic model.
    pub(super) gain: f64,
    pub(super) raise: u32,
    pub(super) lower: u32,
}

impl Dipole {
    pub(super) fn ends(&self) -> impl Iterator<Item = (u32, i32)> {
        [(self.raise, 1), (self.lower, -1)].into_iter().filter(|&(g, _)| g != FREE)
    }
}

/// The state that moves are judged in.
pub(super) struct Here<'a> {
    pub(super) groups: &'a Groups,
    pub(super) system: &'a System,
    pub(super) change: &'a [i32],
    /// Half the derivative of the objective by the angle sums.
    pub(super) potential: &'a [f64],
    /// Least gain of interest.
    pub(super) least: f64,
}

impl Here<'_> {
    fn may_rise(&self, g: usize) -> bool {
        self.change[g] < self.groups.list[g].change.1
    }

    fn may_fall(&self, g: usize) -> bool {
        self.change[g] > self.groups.list[g].change.0
    }

    /// Gain of a move across a resistance: `pi (y_raise - y_lower) - (pi / 2)^2 R`.
    fn gain(&self, raise: f64, lower: f64, resistance: f64) -> f64 {
        2.0 * FRAC_PI_2 * (raise - lower) - FRAC_PI_2 * FRAC_PI_2 * resistance
    }

    /// Moves between groups that share a triangle, and to and from the boundary.
    pub(super) fn short(&self, resistances: &Resistances, found: &mut Vec<Dipole>) {
        let pattern = &self.system.pattern;
        let list = &self.groups.list;
        for j in 0..list.len() {
            let begin = pattern.column_offsets[j] as usize;
            let end = pattern.column_offsets[j + 1] as usize;
            let y = self.potential[j];
            if self.groups.basins[list[j].basin as usize].open {
                let (raise, lower) = if y > 0.0 { (j as u32, FREE) } else { (FREE, j as u32) };
                self.add(y.abs(), 0.0, resistances.diagonal[j], [raise, lower], found);
            }
            for slot in begin + 1..end {
                let i = pattern.rows[slot];
                if list[i as usize].basin == list[j].basin {
                    let resistance = resistances.adjacent(i, j as u32, slot);
                    let (up, down) =
                        if self.potential[i as usize] > y { (i, j as u32) } else { (j as u32, i) };
                    let [a, b] = [up, down].map(|g| self.potential[g as usize]);
                    self.add(a, b, resistance, [up, down], found);
                }
            }
        }
    }

    fn add(&self, a: f64, b: f64, resistance: f64, ends: [u32; 2], found: &mut Vec<Dipole>) {
        let gain = self.gain(a, b, resistance);
        let [raise, lower] = ends;
        if gain > self.least
            && (raise == FREE || self.may_rise(raise as usize))
            && (lower == FREE || self.may_fall(lower as usize))
        {
            found.push(Dipole { gain, raise, lower });
        }
    }

    /// Groups where one end of a long move pays most: local maxima of the score of raising (`1`) or
    /// lowering (`-1`), best first.
    pub(super) fn peaks(&self, resistances: &Resistances, sign: i32) -> Vec<(f64, u32)> {
        let graph = &self.system.graph;
        let score = |g: usize| {
            let allowed = if sign > 0 { self.may_rise(g) } else { self.may_fall(g) };
            let slope = 2.0 * FRAC_PI_2 * f64::from(sign) * self.potential[g];
            let score = slope - FRAC_PI_2 * FRAC_PI_2 * resistances.centred[g];
            if allowed { score } else { f64::NEG_INFINITY }
        };
        let scores: Vec<f64> = (0..self.change.len()).map(score).collect();
        let is_peak = |g: usize| {
            let (begin, end) = (graph.offsets[g] as usize, graph.offsets[g + 1] as usize);
            graph.neighbours[begin..end].iter().all(|&other| scores[other as usize] <= scores[g])
        };
        let mut peaks: Vec<(f64, u32)> = (0..self.change.len())
            .filter(|&g| scores[g] > f64::NEG_INFINITY && is_peak(g))
            .map(|g| (scores[g], g as u32))
            .collect();
        peaks.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        peaks
    }

    /// Long moves from the peaks of one kind to those of the other, best to best in each basin; their
    /// interaction is left out.
    pub(super) fn paired(&self, up: &[(f64, u32)], down: &[(f64, u32)], found: &mut Vec<Dipole>) {
        let mut waiting = vec![std::collections::VecDeque::new(); self.groups.basins.len()];
        let basin = |g: u32| self.groups.list[g as usize].basin as usize;
        down.iter().for_each(|&(score, g)| waiting[basin(g)].push_back((score, g)));
        for &(score, raise) in up {
            let partner = waiting[basin(raise)].pop_front().filter(|&(_, g)| g != raise);
            let Some((other, lower)) = partner else { continue };
            if score + other > self.least {
                found.push(Dipole { gain: score + other, raise, lower });
            }
        }
    }

    /// The best partner of each source within its basin, exactly: a source above zero raises its index.
    pub(super) fn best_partners(
        &self,
        resistances: &mut Resistances,
        sources: &[(u32, i32)],
        found: &mut Vec<Dipole>,
    ) {
        let ids: Vec<u32> = sources.iter().map(|&(g, _)| g).collect();
        resistances.columns(self.system, &ids);
        for &(source, sign) in sources {
            let allowed = match sign {
                1 => self.may_rise(source as usize),
                _ => self.may_fall(source as usize),
            };
            if !allowed {
                continue;
            }
            if let Some(dipole) = self.best_partner(resistances, source, sign) {
                found.push(dipole);
            }
        }
    }

    /// The best partner of one source, above the least gain.
    pub(super) fn best_partner(
        &self,
        resistances: &mut Resistances,
        source: u32,
        sign: i32,
    ) -> Option<Dipole> {
        resistances.columns(self.system, &[source]);
        let column = resistances.column(source)?;
        let y = self.potential[source as usize];
        let mut best: Option<Dipole> = None;
        let basin = &self.groups.basins[self.groups.list[source as usize].basin as usize];
        for &other in basin.groups.iter().filter(|&&g| g != source) {
            let allowed = match sign {
                1 => self.may_fall(other as usize),
                _ => self.may_rise(other as usize),
            };
            let resistance = resistances.between(column, source, other);
            let slope = f64::from(sign) * (y - self.potential[other as usize]);
            let gain = self.gain(slope, 0.0, resistance);
            if allowed && gain > best.map_or(self.least, |b| b.gain) {
                let (raise, lower) = if sign > 0 { (source, other) } else { (other, source) };
                best = Some(Dipole { gain, raise, lower });
            }
        }
        best
    }
}
