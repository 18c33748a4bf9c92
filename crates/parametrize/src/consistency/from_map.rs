//! Angles and matchings of a map that may have foldovers.

use super::error::ConsistencyError;
use super::input::{ConsistencyInput, ConsistencyOptions, Consistent, MatchingSet, SeamMatching};
use super::solve::make_consistent;
use crate::cut::{DualTree, MatchedCut, Unfolding, rotations};
use crate::features::Sectors;
use crate::progress::Watch;
use num_complex::Complex64;
use seamstress_mesh::components::components;
use seamstress_mesh::{Face, Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use std::f64::consts::{FRAC_PI_2, PI};

/// Passes over the flipped triangles; each lowers the sum, and few do.
const PASSES: usize = 20;
/// Smaller gains are rounding errors, quarters squared.
const GAIN: f64 = 1e-6;

/// Corner angles of a map given by one UV per corner, three per face: in every triangle they sum to pi.
///
/// A flipped triangle has negative angles, which sum to -pi; a full turn more at one of its corners makes
/// up for it. (A vertex dragged across the opposite edge of its triangle has gone through a straight
/// angle there: its angle is a little more than pi, the other two a little less than zero.) Around a
/// vertex the angles of a seamless map sum to a multiple of a quarter turn then, flips or not, and the
/// indices to 4 chi. The corner is the one that leaves the indices smallest, as a sum of squares.
pub fn lifted_angles(mesh: &TriMesh, corner_uvs: &[[f64; 2]]) -> HalfedgeData<f64> {
    let mut angles: HalfedgeData<f64> = mesh
        .halfedges()
        .map(|h| {
            let [z, after, before] = [h, h.next(), h.prev()].map(|h| at(corner_uvs, h));
            let w = (after - z).conj() * (before - z);
            let angle = w.im.atan2(w.re);
            if angle.is_finite() { angle } else { PI / 3.0 }
        })
        .collect();
    let turns = |f: Face| {
        let sum: f64 = f.halfedges().map(|h| angles[h]).iter().sum();
        ((PI - sum) / (2.0 * PI)).round()
    };
    let lacking: Vec<(Face, f64)> =
        mesh.faces().map(|f| (f, turns(f))).filter(|&(_, turns)| turns != 0.0).collect();
    for (h, turns) in places_of_turns(mesh, &angles, &lacking) {
        angles[h] += 2.0 * PI * turns;
    }
    for f in mesh.faces() {
        // Nothing but rounding errors is left, or a triangle without area.
        let rest = (PI - f.halfedges().map(|h| angles[h]).iter().sum::<f64>()) / 3.0;
        f.halfedges().iter().for_each(|&h| angles[h] += rest);
    }
    angles
}

/// The corner of each face given that gets its full turns: at first the largest, then moved about while
/// that makes the sum of squared indices smaller. The boundary has none.
fn places_of_turns(
    mesh: &TriMesh,
    angles: &HalfedgeData<f64>,
    lacking: &[(Face, f64)],
) -> Vec<(Halfedge, f64)> {
    let mut index: VertexData<f64> = VertexData::filled(mesh.n_vertices(), 4.0);
    for (h, angle) in angles.enumerate() {
        index[mesh.origin(h)] -= angle / FRAC_PI_2;
    }
    let size = |h: Halfedge| angles[h].abs();
    let largest = |f: Face| f.halfedges().into_iter().max_by(|&a, &b| size(a).total_cmp(&size(b)));
    let mut places: Vec<(Halfedge, f64)> =
        lacking.iter().map(|&(f, turns)| (largest(f).unwrap_or(f.halfedge(0)), turns)).collect();
    for &(h, turns) in &places {
        index[mesh.origin(h)] -= 4.0 * turns;
    }
    for _ in 0..PASSES {
        let mut moved = false;
        for (place, turns) in &mut places {
            let step = 4.0 * *turns;
            index[mesh.origin(*place)] += step;
            // What the turns cost at a corner: (k - step)^2 - k^2.
            let cost = |h: Halfedge| match mesh.is_boundary(mesh.origin(h)) {
                true => 0.0,
                false => step * (step - 2.0 * index[mesh.origin(h)]),
            };
            let mut best = *place;
            for other in place.face().halfedges() {
                if cost(other) < cost(best) - GAIN {
                    best = other;
                }
            }
            moved |= best != *place;
            *place = best;
            index[mesh.origin(best)] -= step;
        }
        if !moved {
            break;
        }
    }
    places
}

fn at(corner_uvs: &[[f64; 2]], corner: Halfedge) -> Complex64 {
    let [u, v] = corner_uvs[corner.at()];
    Complex64::new(u, v)
}

/// The cut along a dual tree with the matchings nearest to the rotations that given corner angles make:
/// those of the map, if they are the angles of a seamless one.
pub fn matched_by_angles(
    mesh: &TriMesh,
    metric: &Metric,
    tree: DualTree,
    angles: &HalfedgeData<f64>,
) -> MatchedCut {
    let unfolding = Unfolding::new(&Sectors::unaligned(mesh), metric, tree);
    let rotations = rotations(mesh, angles, &unfolding.tree, &unfolding.cut.seams);
    let matching = rotations.iter().map(|r| r.round() as i32).collect();
    MatchedCut { unfolding, matching }
}

/// Lifted angles of a map of any mesh, the index of every interior vertex that goes with them (zero
/// elsewhere), and the matching of every half-edge: the nearest quarter turns across its edge, negated
/// on twins, zero on the boundary. Of a map that is not seamless, indices that go with the nearest
/// matchings.
pub fn transitions(
    mesh: &TriMesh,
    corner_uvs: &[[f64; 2]],
) -> (HalfedgeData<f64>, VertexData<i32>, HalfedgeData<i32>) {
    let angles = lifted_angles(mesh, corner_uvs);
    let mut indices = VertexData::filled(mesh.n_vertices(), 0);
    for piece in components(mesh).unwrap_or_default() {
        // Any metric shows the indices of lifted matchings.
        let metric = Metric::from_positions(&piece.mesh, &vec![[0.0; 3]; piece.mesh.n_vertices()]);
        let tree = DualTree::lightest(&piece.mesh, |_| 0.0);
        let corners = piece.faces.iter().flat_map(|f| f.halfedges());
        let local: HalfedgeData<f64> = corners.map(|h| angles[h]).collect();
        let matched = matched_by_angles(&piece.mesh, &metric, tree, &local);
        for (v, &k) in matched.sector_indices(&Sectors::unaligned(&piece.mesh), &metric).enumerate()
        {
            indices[piece.vertices[v]] = k;
        }
    }
    let side = |h: Halfedge| {
        let [a, b] = [h, h.next()].map(|h| at(corner_uvs, h));
        b - a
    };
    let mut matching = HalfedgeData::filled(mesh.n_halfedges(), 0);
    for h in mesh.interior_edges() {
        if let Some(t) = mesh.twin(h) {
            let turn = -side(t) * side(h).conj();
            matching[h] = (turn.arg() / FRAC_PI_2).round() as i32;
            matching[t] = -matching[h];
        }
    }
    (angles, indices, matching)
}

/// Makes the matchings of a cut consistent, all of them integers, by angles to stay close to.
///
/// # Errors
/// As [`make_consistent`].
pub fn consistent_cut(
    mesh: &TriMesh,
    metric: &Metric,
    matched: &MatchedCut,
    angles: &HalfedgeData<f64>,
    options: &ConsistencyOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(MatchedCut, Consistent), ConsistencyError> {
    let pairs = matched.unfolding.cut.seams.iter().zip(&matched.matching);
    let seams: Vec<SeamMatching> = pairs
        .map(|(&left, &r)| SeamMatching { left, matching: f64::from(r), set: MatchingSet::Integer })
        .collect();
    let indices: VertexData<f64> = matched
        .sector_indices(&Sectors::unaligned(mesh), metric)
        .iter()
        .map(|&k| f64::from(k))
        .collect();
    let input = ConsistencyInput { angles, indices: &indices, seams: &seams };
    let consistent = make_consistent(mesh, &input, options, watch)?;
    let matching = consistent.matchings.iter().map(|r| r.round() as i32).collect();
    Ok((MatchedCut { unfolding: matched.unfolding.clone(), matching }, consistent))
}
