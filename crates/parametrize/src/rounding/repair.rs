//! Making the indices of all sectors possible for triangles.

use crate::cut::MatchedCut;
use crate::features::Sectors;
use seamstress_mesh::{Metric, Vertex, VertexData};
use std::collections::VecDeque;

/// Matchings whose indices are within their bounds as far as possible.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Repair {
    /// The matchings.
    pub matched: MatchedCut,
    /// Shifts of matchings by one quarter turn that it took.
    pub shifts: usize,
    /// Sectors that stay out of bounds.
    pub hopeless: Vec<Vertex>,
}

/// Shifts matchings until every index is within its bounds.
///
/// A sector out of bounds passes one unit along the shortest path of turning edges to a sector that can
/// take it; free ones always can.
pub fn repair(sectors: &Sectors<'_>, metric: &Metric, mut matched: MatchedCut) -> Repair {
    let slit = sectors.slit();
    let mut index = matched.sector_indices(sectors, metric);
    let bounds: VertexData<(i32, i32)> = slit.vertices().map(|s| sectors.bounds(s)).collect();
    let excess = |index: &VertexData<i32>, s: Vertex| {
        let (low, high) = bounds[s];
        if sectors.is_free(s) { 0 } else { (index[s] - high).max(0) - (low - index[s]).max(0) }
    };
    let mut turning_at = VertexData::filled(slit.n_vertices(), Vec::new());
    for (e, &h) in matched.unfolding.turning.iter().enumerate() {
        // Raising the matching moves a unit of index from the origin to the tip.
        turning_at[slit.origin(h)].push((e, slit.tip(h), 1));
        turning_at[slit.tip(h)].push((e, slit.origin(h), -1));
    }
    let (mut shifts, mut hopeless) = (0, Vec::new());
    for start in slit.vertices() {
        while excess(&index, start) != 0 {
            let unit = excess(&index, start).signum();
            let takes = |s: Vertex| {
                let after = index[s] + unit;
                sectors.is_free(s) || (bounds[s].0..=bounds[s].1).contains(&after)
            };
            let Some(path) = shortest_path(&turning_at, start, takes) else {
                hopeless.push(start);
                break;
            };
            for (e, from, to, sign) in path {
                matched.matching[e] += sign * unit;
                for (s, change) in [(from, -unit), (to, unit)] {
                    if !sectors.is_free(s) {
                        index[s] += change;
                    }
                }
                shifts += 1;
            }
        }
    }
    Repair { matched, shifts, hopeless }
}

type Shift = (usize, Vertex, Vertex, i32);

/// Breadth-first path over turning edges from a sector to the nearest other one that satisfies a
/// condition.
fn shortest_path(
    turning_at: &VertexData<Vec<(usize, Vertex, i32)>>,
    start: Vertex,
    goal: impl Fn(Vertex) -> bool,
) -> Option<Vec<Shift>> {
    let mut from: VertexData<Option<Shift>> = VertexData::filled(turning_at.len(), None);
    let mut queue = VecDeque::from([start]);
    while let Some(v) = queue.pop_front() {
        if v != start && goal(v) {
            let mut path = Vec::new();
            let mut at = v;
            while let Some(step) = from[at].filter(|_| at != start) {
                path.push(step);
                at = step.1;
            }
            path.reverse();
            return Some(path);
        }
        for &(e, w, sign) in &turning_at[v] {
            if w != start && from[w].is_none() {
                from[w] = Some((e, v, w, sign));
                queue.push_back(w);
            }
        }
    }
    None
}
