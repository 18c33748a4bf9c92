//! Making the indices of all vertices possible for triangles.

use super::matched::MatchedCut;
use seamstress_surface::{Metric, TriMesh, Vertex, VertexData};
use std::collections::VecDeque;

/// Smallest and largest index, in quarters, that an interior vertex of this valence should get: its
/// angle `(4 - k) pi / 2` is a quarter turn at least and less than 130 degrees per corner (a vertex of
/// valence 3 with k = -2 is impossible, and with -1 already costs dearly).
pub fn index_bounds(valence: usize) -> (i32, i32) {
    let most_quarters = (1.44 * valence as f64).ceil() as i32 - 1;
    (4 - most_quarters.max(1), 3)
}

/// Shifts matchings until every interior index is within its bounds; returns how many shifts it took,
/// and the vertices that stay out of bounds.
///
/// A vertex out of bounds passes one unit along the shortest path of seams to a vertex that can take
/// it, the boundary included.
pub fn repair(mesh: &TriMesh, metric: &Metric, matched: &mut MatchedCut) -> (usize, Vec<Vertex>) {
    let mut index = matched.cone_indices(mesh, metric);
    let bounds: VertexData<(i32, i32)> =
        mesh.vertices().map(|v| index_bounds(mesh.valence(v))).collect();
    let excess = |index: &VertexData<i32>, v: Vertex| {
        let (low, high) = bounds[v];
        if mesh.is_boundary(v) { 0 } else { (index[v] - high).max(0) - (low - index[v]).max(0) }
    };
    let mut seams_at = VertexData::filled(mesh.n_vertices(), Vec::new());
    for (s, &h) in matched.cut.seams.iter().enumerate() {
        // Raising the matching moves a unit of index from the origin to the tip.
        seams_at[mesh.origin(h)].push((s, mesh.tip(h), 1));
        seams_at[mesh.tip(h)].push((s, mesh.origin(h), -1));
    }
    let (mut shifts, mut hopeless) = (0, Vec::new());
    for start in mesh.vertices() {
        while excess(&index, start) != 0 {
            let unit = excess(&index, start).signum();
            let takes = |v: Vertex| {
                let after = index[v] + unit;
                mesh.is_boundary(v) || (bounds[v].0..=bounds[v].1).contains(&after)
            };
            let Some(path) = shortest_path(mesh, &seams_at, start, takes) else {
                hopeless.push(start);
                break;
            };
            for (s, from, to, sign) in path {
                matched.matching[s] += sign * unit;
                for (v, change) in [(from, -unit), (to, unit)] {
                    if !mesh.is_boundary(v) {
                        index[v] += change;
                    }
                }
                shifts += 1;
            }
        }
    }
    (shifts, hopeless)
}

type Step = (usize, Vertex, Vertex, i32);

/// Breadth-first path over seams from a vertex to the nearest other one that satisfies a condition.
fn shortest_path(
    mesh: &TriMesh,
    seams_at: &VertexData<Vec<(usize, Vertex, i32)>>,
    start: Vertex,
    goal: impl Fn(Vertex) -> bool,
) -> Option<Vec<Step>> {
    let mut from: VertexData<Option<Step>> = VertexData::filled(mesh.n_vertices(), None);
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
        for &(s, w, sign) in &seams_at[v] {
            if w != start && from[w].is_none() {
                from[w] = Some((s, v, w, sign));
                queue.push_back(w);
            }
        }
    }
    None
}
