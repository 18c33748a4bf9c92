//! Angles and matchings of a map that may have foldovers.

use super::error::ConsistencyError;
use super::input::{ConsistencyInput, ConsistencyOptions, Consistent, MatchingSet, SeamMatching};
use super::solve::make_consistent;
use crate::cut::DualTree;
use crate::features::Sectors;
use crate::layout::isometric::rotations;
use crate::progress::Watch;
use crate::rounding::MatchedCut;
use num_complex::Complex64;
use seamstress_surface::{HalfedgeData, Metric, TriMesh, VertexData};
use std::f64::consts::PI;

/// Corner angles of a map given by one UV per corner, three per face: in every triangle they sum to pi.
///
/// A flipped triangle has negative angles, which sum to -pi; a full turn more at its largest corner
/// makes up for it. (A vertex dragged across the opposite edge of its triangle has gone through a
/// straight angle there: its angle is a little more than pi, the other two a little less than zero.)
/// Around a vertex the angles of a seamless map sum to a multiple of a quarter turn then, flips or not,
/// and the indices to 4 chi.
pub fn lifted_angles(mesh: &TriMesh, corner_uvs: &[[f64; 2]]) -> HalfedgeData<f64> {
    let at = |k: usize| Complex64::new(corner_uvs[k][0], corner_uvs[k][1]);
    let mut angles = HalfedgeData::filled(mesh.n_halfedges(), 0.0);
    for f in mesh.faces() {
        let corners = f.halfedges();
        let [a, b, c] = corners.map(|h| at(h.at()));
        let between = |from: Complex64, to: Complex64| {
            let w = from.conj() * to;
            w.im.atan2(w.re)
        };
        let mut signed = [between(b - a, c - a), between(c - b, a - b), between(a - c, b - c)];
        let largest = (0..3).max_by(|&i, &j| signed[i].abs().total_cmp(&signed[j].abs()));
        let turns = ((PI - signed.iter().sum::<f64>()) / (2.0 * PI)).round();
        signed[largest.unwrap_or(0)] += 2.0 * PI * turns;
        // Nothing but rounding errors is left, or a triangle without area.
        let rest = (PI - signed.iter().sum::<f64>()) / 3.0;
        for (h, angle) in corners.into_iter().zip(signed) {
            let angle = angle + rest;
            angles[h] = if angle.is_finite() { angle } else { PI / 3.0 };
        }
    }
    angles
}

/// The cut along a dual tree with the matchings nearest to the rotations that given corner angles make:
/// those of the map, if they are the angles of a seamless one.
pub fn matched_by_angles(
    mesh: &TriMesh,
    metric: &Metric,
    tree: DualTree,
    angles: &HalfedgeData<f64>,
) -> MatchedCut {
    let mut matched = MatchedCut::new(&Sectors::unaligned(mesh), metric, tree);
    let rotations = rotations(mesh, angles, &matched.tree, &matched.cut.seams);
    matched.matching = rotations.iter().map(|r| r.round() as i32).collect();
    matched
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
    let pairs = matched.cut.seams.iter().zip(&matched.matching);
    let seams: Vec<SeamMatching> = pairs
        .map(|(&left, &r)| SeamMatching { left, matching: f64::from(r), set: MatchingSet::Integer })
        .collect();
    let indices: VertexData<f64> =
        matched.sector_indices(&Sectors::unaligned(mesh), metric).iter().map(|&k| f64::from(k)).collect();
    let input = ConsistencyInput { angles, indices: &indices, seams: &seams };
    let consistent = make_consistent(mesh, &input, options, watch)?;
    let matching = consistent.matchings.iter().map(|r| r.round() as i32).collect();
    Ok((MatchedCut { matching, ..matched.clone() }, consistent))
}
