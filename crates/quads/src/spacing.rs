//! Vertices evenly spaced along curves.
//!
//! Between the places where a vertex has to stay, the vertices on a curve go, in a few steps, to where they are the
//! same arc length apart. The quads beside follow: the steps are continued into the surface by harmonic functions
//! that end some rings away ([`Surroundings`]). A vertex takes no step that does harm ([`Moves`]).

use crate::constraints::Domain;
use crate::curve::Curve;
use crate::moves::{Fair, Moves};
use crate::smooth::SmoothError;
use crate::stretch::Stretch;
use crate::vector::{Point, add, norm, sub};
use crate::{QuadConnectivity, QuadMesh};
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern};
use seamstress_parallel::prelude::*;
use seamstress_parametrize::progress::Watch;
use std::collections::{BTreeMap, BTreeSet};

/// The longest step, in mean edges of a stretch: quads half as high as wide are slanted by eleven degrees until their
/// other vertices follow.
const STEP: f64 = 0.1;
/// The most steps, for goals several edges away. Those refused are made up for by later ones.
const STEPS: usize = 60;
/// Rings of vertices around curves that follow: quads are slanted by a twelfth of a cell for a move by a cell.
const RINGS: usize = 12;
/// The part of its arc length that two edges along a curve have together if they follow it: on a circle, edges of 40
/// degrees do.
const FOLLOWED: f64 = 0.98;
/// What quads may become in exchange for even edges: corners within 30 degrees of a right angle, and no slivers.
const FAIR: Fair = Fair { corner: 0.5, thinness: 3.0 };
/// Edges of a stretch that differ no more than by this factor are even enough: what the surface asks for beside
/// the curve is left of their differences.
const EVEN: f64 = 2.0;

/// Positions with the vertices on curves moved along these until they are evenly spaced; those around follow along the
/// surface.
///
/// A move is made only if no more of the quads around the vertex are inverted or crossed afterwards, and their worst
/// corner is no worse or within 30 degrees of a right angle. Moves are made one by one in the order of the vertices.
///
/// # Errors
/// If there is no memory to solve for the moves, and where the observer breaks.
pub(crate) fn evenly_spaced(
    mesh: &QuadMesh,
    connectivity: &QuadConnectivity,
    domain: &Domain,
    stretches: &[Stretch<'_>],
    watch: &mut Watch<'_, '_>,
) -> Result<Vec<Point>, SmoothError> {
    let positions = mesh.positions();
    let sliders: Vec<Slider<'_>> = stretches.iter().flat_map(sliders).collect();
    if sliders.is_empty() {
        return Ok(positions.to_vec());
    }
    let surroundings = Surroundings::new(domain, connectivity, &sliders)?;
    let normals = positions.par_iter().map(|&p| domain.normal(p)).collect();
    let mut moves = Moves::new(connectivity, mesh.quads(), positions.to_vec(), normals);
    let farthest = sliders.iter().map(|slider| slider.way(positions).abs() / slider.edge);
    let steps = (farthest.fold(0.0, f64::max) / STEP).ceil().min(STEPS as f64) as usize;
    for left in (1..=steps).rev() {
        watch.pulse()?;
        let at = |slider: &Slider| slider.after(&moves.positions, 1.0 / left as f64);
        let on_curves: Vec<Point> = sliders.par_iter().map(at).collect();
        let steps: Vec<Point> = sliders
            .iter()
            .zip(&on_curves)
            .map(|(slider, &to)| sub(to, moves.positions[slider.vertex as usize]))
            .collect();
        let followers = surroundings.steps(&steps);
        let on_surface = |(&v, step): (&u32, Point)| {
            (v, domain.place(v, add(moves.positions[v as usize], step)))
        };
        let followed: Vec<(u32, (Point, Point))> =
            surroundings.followers.par_iter().zip(followers).map(on_surface).collect();
        let slid = sliders.iter().zip(on_curves);
        let slid = slid.map(|(slider, to)| (slider.vertex, (to, domain.normal(to))));
        let mut wanted: Vec<(u32, (Point, Point))> = slid.chain(followed).collect();
        wanted.sort_unstable_by_key(|&(v, _)| v);
        // What was in the way may have gone.
        for _ in 0..2 {
            wanted.retain(|&(v, to)| {
                let may_go = |&k: &usize| sliders[k].may_go(&moves.positions, to.0);
                let is_refused = !surroundings.sliders.get(&v).is_none_or(may_go);
                is_refused || !moves.try_move(v, to, FAIR)
            });
        }
    }
    Ok(moves.positions)
}

/// A vertex on a curve, and the arc length at which it should be.
struct Slider<'a> {
    vertex: u32,
    curve: &'a Curve,
    goal: f64,
    /// The vertices before and after it along the curve.
    beside: [u32; 2],
    /// The length that edges there would have if all of the stretch were even.
    edge: f64,
}

impl Slider<'_> {
    /// The arc length that is left to go.
    fn way(&self, positions: &[Point]) -> f64 {
        let way = self.goal - self.curve.parameter(positions[self.vertex as usize]);
        match self.curve.is_closed() {
            true => way - self.curve.length() * (way / self.curve.length()).round(),
            false => way,
        }
    }

    /// The place after a part of the way that is left.
    fn after(&self, positions: &[Point], part: f64) -> Point {
        let way = part * self.way(positions);
        self.curve.point(self.curve.parameter(positions[self.vertex as usize]) + way)
    }

    /// Whether neither edge along the curve becomes shorter or longer than it and all those that are even, nor the two
    /// cut off more of the curve than they do and is fair.
    fn may_go(&self, positions: &[Point], to: Point) -> bool {
        let beside = self.beside.map(|v| positions[v as usize]);
        let lengths = |at: Point| beside.map(|p| norm(sub(p, at)));
        let ([a, b], [c, d]) = (lengths(positions[self.vertex as usize]), lengths(to));
        let [from, end] = beside.map(|p| self.curve.parameter(p));
        let arc = match self.curve.is_closed() {
            true => (end - from).rem_euclid(self.curve.length()),
            false => end - from,
        };
        let slack = EVEN.sqrt();
        c.min(d) >= a.min(b).min(self.edge / slack)
            && c.max(d) <= a.max(b).max(self.edge * slack)
            && c + d >= (a + b).min(FOLLOWED * arc)
    }
}

/// The vertices of a stretch that have to slide, and where to; none if they are even enough.
fn sliders<'a>(stretch: &'a Stretch<'a>) -> Vec<Slider<'a>> {
    let n = stretch.vertices.len() - 1;
    let vertex = |k: usize| stretch.vertices[k].0;
    let curve = stretch.curve;
    let places: Vec<f64> = stretch.vertices.iter().map(|&(_, at)| curve.count(at)).collect();
    let goals = evened(&places, stretch.is_loop).unwrap_or_default();
    let sliders = (0..n).zip(goals).skip(usize::from(!stretch.is_loop));
    let slider = |(k, goal)| {
        let before = if k == 0 { n - 1 } else { k - 1 };
        let beside = [vertex(before), vertex(k + 1)];
        let goal = curve.parameter_of(goal);
        Slider { vertex: vertex(k), curve, goal, beside, edge: stretch.edge_at(goal) }
    };
    sliders.map(slider).collect()
}

/// Ascending numbers, moved towards even gaps until these differ by no more than [`EVEN`]; none if they do not. The
/// first and the last stay, or on a loop, where these are the same place, the mean.
fn evened(numbers: &[f64], is_loop: bool) -> Option<Vec<f64>> {
    let n = numbers.len() - 1;
    let gaps = || numbers.windows(2).map(|pair| pair[1] - pair[0]);
    let (shortest, longest) = (gaps().fold(f64::INFINITY, f64::min), gaps().fold(0.0, f64::max));
    let excess = longest - EVEN * shortest;
    if excess <= 0.0 {
        return None;
    }
    let mean = (numbers[n] - numbers[0]) / n as f64;
    // Gaps become (1 - part) gap + part mean.
    let part = excess / (excess + (EVEN - 1.0) * mean);
    let even = |k: usize| numbers[0] + k as f64 * mean;
    let shift = match is_loop {
        true => (0..n).map(|k| numbers[k] - even(k)).sum::<f64>() / n as f64,
        false => 0.0,
    };
    let moved = |(k, &number): (usize, &f64)| number + part * (even(k) + shift - number);
    Some(numbers.iter().enumerate().map(moved).collect())
}

/// Vertices near those that slide, free to follow them: the steps of the sliders continued by harmonic functions.
struct Surroundings {
    /// The numbers of the sliders by vertex.
    sliders: BTreeMap<u32, usize>,
    /// Ascending.
    followers: Vec<u32>,
    /// Followers by number and the numbers of the sliders next to them.
    beside: Vec<(usize, usize)>,
    laplacian: Cholesky<f64>,
}

impl Surroundings {
    fn new(
        domain: &Domain,
        connectivity: &QuadConnectivity,
        sliders: &[Slider<'_>],
    ) -> Result<Self, NotPositiveDefinite> {
        let sliders: BTreeMap<u32, usize> =
            sliders.iter().enumerate().map(|(k, slider)| (slider.vertex, k)).collect();
        let mut followers = BTreeSet::new();
        let mut rim: BTreeSet<u32> = sliders.keys().copied().collect();
        for _ in 0..RINGS {
            let beside = rim.iter().flat_map(|&v| connectivity.neighbours(v));
            let is_new = |v: &u32| domain.is_free(*v) && !followers.contains(v);
            rim = beside.filter(is_new).collect();
            followers.extend(&rim);
        }
        let followers: Vec<u32> = followers.into_iter().collect();
        let mut beside = Vec::new();
        let mut edges = Vec::new();
        for (i, &v) in followers.iter().enumerate() {
            for w in connectivity.neighbours(v) {
                beside.extend(sliders.get(&w).map(|&slider| (i, slider)));
                let other = followers.binary_search(&w).ok();
                edges.extend(other.filter(|&j| j < i).map(|j| [j as u32, i as u32]));
            }
        }
        let pattern = Pattern::of_cliques(followers.len(), edges.iter());
        let mut matrix = vec![0.0; pattern.len()];
        for (&slot, &v) in pattern.diagonal().iter().zip(&followers) {
            matrix[slot as usize] = connectivity.neighbours(v).count() as f64;
        }
        for slot in edges.iter().filter_map(|&[i, j]| pattern.slot(i, j)) {
            matrix[slot as usize] -= 1.0;
        }
        let graph = Graph::from_edges(followers.len(), edges.iter().map(|&[i, j]| (i, j)));
        let order = fill_reducing_order(&graph);
        let mut laplacian = Cholesky::analyze(&pattern, &order)?;
        laplacian.factorize(&matrix)?;
        Ok(Self { sliders, followers, beside, laplacian })
    }

    /// The steps of the followers when the sliders make these.
    fn steps(&self, sliders: &[Point]) -> Vec<Point> {
        let n = self.followers.len();
        let mut columns = vec![0.0; 3 * n];
        for &(follower, slider) in &self.beside {
            for axis in 0..3 {
                columns[axis * n + follower] += sliders[slider][axis];
            }
        }
        self.laplacian.solve_columns(&mut columns, 3);
        (0..n).map(|k| [0, 1, 2].map(|axis| columns[axis * n + k])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_by_hand() {
        assert_eq!(evened(&[0.0, 1.0, 3.0, 4.5], false), None);
        // Gaps of 1 and 5 become 2 and 4.
        let expected = [0.0, 2.0, 6.0];
        let found = evened(&[0.0, 1.0, 6.0], false).unwrap();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        // On a loop the mean stays.
        let found = evened(&[0.0, 1.0, 6.0], true).unwrap();
        assert!((found[0] + found[1] - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found[1] - found[0] - 2.0).abs() < 1e-12 && found[2] - found[0] == 6.0);
        let found = evened(&[0.0, 0.0, 0.0, 3.0], false).unwrap();
        let gaps: Vec<f64> = found.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(gaps.iter().all(|gap| (0.6..=1.6).contains(gap)), "{gaps:?}");
    }
}
