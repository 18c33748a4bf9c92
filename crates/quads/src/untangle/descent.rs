//! Minimisation of a patch's energy along the surface.

use super::Site;
use super::energy::Energy;
use super::patch::Patch;
use super::score::Score;
use crate::constraints::Domain;
use crate::vector::{Point, add, dot, norm, scale, sub};
use std::collections::VecDeque;

/// The first regularisation, in areas of a quad: about where a corner begins to feel that it is reflex. Larger ones
/// let patches collapse.
const FIRST_EPS: f64 = 0.25;
/// How often it is halved: to 0.002, when corners of a tenth of a degree are still apart from reflex ones.
const HALVINGS: usize = 7;
/// Steps for each. Most patches need fewer; twice as many cost half as much again and improved few.
const STEPS: usize = 30;
/// Pairs of differences that the inverse Hessian is made from.
const MEMORY: usize = 10;
/// The first step, and the longest, of the vertex that moves most; in mean edges.
const FIRST_STEP: f64 = 0.1;
const LONGEST_STEP: f64 = 0.3;
/// Halvings of a step before it is given up.
const SHORTENINGS: usize = 10;
/// The part of the decrease that the gradient promises which a step must bring (Armijo's condition).
const SUFFICIENT: f64 = 1e-4;
/// A smaller decrease, relative to the energy, ends the minimisation.
const STALL: f64 = 1e-7;
/// Differences whose cosine is below this say nothing of the curvature.
const FLAT: f64 = 1e-12;

/// The best sites for the vertices of a patch that were found on the way to ever smaller regularisations; none if no
/// better than those it has. Quads better than the bound are good enough.
pub(super) fn untangled(domain: &Domain, patch: &Patch, bound: f64) -> Option<Vec<Site>> {
    let score = |sites: &[Site]| {
        Score::new(patch.quads.iter().map(|q| q.map(|v| sites[v as usize])), bound)
    };
    let (mut best, mut found) = (score(&patch.sites), None);
    let mut sites = patch.sites.clone();
    for k in 0..=HALVINGS {
        let eps = FIRST_EPS * 0.5f64.powi(k as i32);
        let mut descent = Descent::new(domain, Energy::new(patch, &sites, eps), sites);
        for _ in 0..STEPS {
            let Some(decrease) = descent.step() else { break };
            let now = score(&descent.sites);
            if now.is_better_than(&best) {
                (best, found) = (now, Some(descent.sites.clone()));
            }
            if now.is_good() {
                return found;
            }
            if decrease < STALL * descent.energy_here.abs() {
                break;
            }
        }
        sites = descent.sites;
    }
    found
}

/// L-BFGS (Nocedal 1980) in space, its steps projected to where the vertices may be.
struct Descent<'a> {
    domain: &'a Domain,
    energy: Energy<'a>,
    sites: Vec<Site>,
    energy_here: f64,
    /// Along the surface.
    gradient: Vec<Point>,
    history: VecDeque<Pair>,
}

/// What a step did.
struct Pair {
    step: Vec<Point>,
    /// Of the gradient.
    change: Vec<Point>,
    /// Of the two.
    product: f64,
}

fn inner(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| dot(a, b)).sum()
}

/// Adds a multiple of the second to the first.
fn add_scaled(a: &mut [Point], b: &[Point], factor: f64) {
    a.iter_mut().zip(b).for_each(|(a, &b)| *a = add(*a, scale(b, factor)));
}

impl<'a> Descent<'a> {
    fn new(domain: &'a Domain, energy: Energy<'a>, sites: Vec<Site>) -> Self {
        let (energy_here, gradient) = energy.evaluate(&sites);
        Self { domain, energy, sites, energy_here, gradient, history: VecDeque::new() }
    }

    /// Makes a step; says how much the energy fell, or nothing if no step lowers it.
    fn step(&mut self) -> Option<f64> {
        let decrease = self.search();
        if decrease.is_some() || self.history.is_empty() {
            return decrease;
        }
        // What was learned of the curvature may be wrong: at edges of the surface it changes at once.
        self.history.clear();
        self.search()
    }

    fn search(&mut self) -> Option<f64> {
        let direction = self.direction();
        let longest = direction.iter().map(|&d| norm(d)).fold(0.0, f64::max);
        if !(longest > 0.0 && longest.is_finite()) {
            return None;
        }
        let edge = self.energy.patch.edge;
        let mut factor = match self.history.is_empty() {
            true => FIRST_STEP * edge / longest,
            false => (LONGEST_STEP * edge / longest).min(1.0),
        };
        for _ in 0..SHORTENINGS {
            let sites = self.moved(&direction, factor);
            let moves = sites.iter().zip(&self.sites).map(|(to, from)| sub(to.at, from.at));
            let step: Vec<Point> = moves.collect();
            let slope = inner(&self.gradient, &step);
            if slope < 0.0 {
                let (energy, gradient) = self.energy.evaluate(&sites);
                if energy <= self.energy_here + SUFFICIENT * slope {
                    let decrease = self.energy_here - energy;
                    self.learn(step, &gradient);
                    (self.sites, self.energy_here, self.gradient) = (sites, energy, gradient);
                    return Some(decrease);
                }
            }
            factor *= 0.5;
        }
        None
    }

    /// Vertices that do not move stay where they are.
    fn moved(&self, direction: &[Point], factor: f64) -> Vec<Site> {
        let mut sites = self.sites.clone();
        let vertices = &self.energy.patch.vertices;
        for ((site, &v), &d) in sites.iter_mut().zip(vertices).zip(direction) {
            let (at, normal) = self.domain.place(v, add(site.at, scale(d, factor)));
            *site = Site { at, normal };
        }
        sites
    }

    /// Keeps what a step to a new gradient tells of the curvature.
    fn learn(&mut self, step: Vec<Point>, gradient: &[Point]) {
        let change: Vec<Point> =
            gradient.iter().zip(&self.gradient).map(|(&new, &old)| sub(new, old)).collect();
        let product = inner(&step, &change);
        if product > FLAT * (inner(&step, &step) * inner(&change, &change)).sqrt() {
            self.history.push_back(Pair { step, change, product });
            if self.history.len() > MEMORY {
                self.history.pop_front();
            }
        }
    }

    /// The two-loop recursion.
    fn direction(&self) -> Vec<Point> {
        let mut direction: Vec<Point> = self.gradient.iter().map(|&g| scale(g, -1.0)).collect();
        let mut parts = Vec::with_capacity(self.history.len());
        for pair in self.history.iter().rev() {
            let part = inner(&pair.step, &direction) / pair.product;
            add_scaled(&mut direction, &pair.change, -part);
            parts.push(part);
        }
        if let Some(last) = self.history.back() {
            let curvature = last.product / inner(&last.change, &last.change);
            direction.iter_mut().for_each(|d| *d = scale(*d, curvature));
        }
        for (pair, part) in self.history.iter().zip(parts.into_iter().rev()) {
            let by = inner(&pair.change, &direction) / pair.product;
            add_scaled(&mut direction, &pair.step, part - by);
        }
        direction
    }
}
