//! Problem (14) from start to end.

use super::error::ConsistencyError;
use super::flow::{move_units, settle_real};
use super::groups::{FREE, Groups};
use super::input::{ConsistencyInput, ConsistencyOptions, Consistent, MatchingSet, SeamMatching};
use super::problem::Problem;
use super::refine::{Refined, State};
use super::system::System;
use crate::progress::Watch;
use seamstress_mesh::{HalfedgeData, TriMesh, VertexData};
use std::f64::consts::{FRAC_PI_2, PI};

/// An index this near to an integer is one, quarters.
const SNAP: f64 = 1e-6;

/// Finds matchings, indices and angles that fit together and are close to those given.
///
/// They satisfy problem (14): the matchings move index along their seams, each in its own set; the
/// angles are positive and sum to pi in a triangle and to `(4 - k) pi / 2` around an interior vertex of
/// index `k < 4`; the indices of a component sum to 4 chi. Boundary angle sums are free: the boundary
/// takes and gives any amount of index. The index of a loop around a handle changes only by the paths
/// that cross it. Several components are solved in one go.
///
/// Indices are found by descent, then by exact search: of the whole component where few indices are undecided, else of
/// small patches, as far as [`ConsistencyOptions::work`] goes. The angles are the best for the indices found. Only where
/// [`Consistent::optimal`] is true is nothing nearer; elsewhere [`Consistent::gap`] says by how much it may be.
///
/// # Errors
/// [`ConsistencyError`]: faulty input, no positive angles for any indices tried, or cancelled.
///
/// # Source
/// Levi 2021, supplement, section 9 (14); how it is solved: `docs/theory/11-matching-consistency.md`.
pub fn make_consistent(
    mesh: &TriMesh,
    input: &ConsistencyInput<'_>,
    options: &ConsistencyOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Consistent, ConsistencyError> {
    input.check(mesh)?;
    let given: Vec<f64> = input.seams.iter().map(|seam| seam.matching).collect();
    let rounded: Vec<f64> = input.seams.iter().map(rounded).collect();
    let start = shifted(mesh, input.seams, input.indices, &given, &rounded);
    let groups = Groups::new(mesh, input, &start, options)?;
    let group = mesh.halfedges().map(|h| groups.of[mesh.origin(h)]).collect();
    let system = System::new(group, groups.len())?;
    let components = triangles_by_component(mesh);
    let mut problem = Problem::new(&groups, system, &input.angles.0, &components)?;
    let Refined { state: State { change, angles }, bound, proven: optimal } =
        problem.solve(options, watch)?;

    let mut stats = problem.stats();
    let mut matchings = rounded.clone();
    stats.changed_indices = change.iter().filter(|&&n| n != 0).count();
    stats.changed_matchings = move_units(mesh, &groups, &change, input.seams, &mut matchings);
    let indices = final_indices(mesh, &groups, &change, &angles);
    let moved = shifted(mesh, input.seams, &start, &rounded, &matchings);
    settle_real(mesh, &moved, &indices, input.seams, &mut matchings);

    let changes = angles.iter().zip(input.angles.iter()).map(|(a, b)| a - b);
    let objective = changes.map(|change| options.norm.cost(change)).sum();
    let lower_bound = bound.min(objective);
    let angles = HalfedgeData(angles);
    Ok(Consistent { matchings, indices, angles, objective, lower_bound, optimal, stats })
}

fn triangles_by_component(mesh: &TriMesh) -> Vec<Vec<u32>> {
    let (label, n_components) = mesh.connected_faces();
    let mut components = vec![Vec::new(); n_components];
    for f in mesh.faces() {
        components[label[f] as usize].push(f.0);
    }
    components
}

fn rounded(seam: &SeamMatching) -> f64 {
    match seam.set {
        MatchingSet::Integer => seam.matching.round(),
        _ => seam.matching,
    }
}

/// Indices after the matchings went from some values to others: each unit goes from the origin of the
/// left half-edge to its tip.
fn shifted(
    mesh: &TriMesh,
    seams: &[SeamMatching],
    indices: &VertexData<f64>,
    from: &[f64],
    to: &[f64],
) -> VertexData<f64> {
    let mut shifted = indices.clone();
    for (seam, (from, to)) in seams.iter().zip(from.iter().zip(to)) {
        shifted[mesh.origin(seam.left)] -= to - from;
        shifted[mesh.tip(seam.left)] += to - from;
    }
    let snap = |k: &mut f64| *k = if (*k - k.round()).abs() < SNAP { k.round() } else { *k };
    shifted.iter_mut().for_each(snap);
    shifted
}

/// Of a vertex that is alone, what was found for it; of all others, what the angles say.
fn final_indices(
    mesh: &TriMesh,
    groups: &Groups,
    change: &[i32],
    angles: &[f64],
) -> VertexData<f64> {
    let mut sums = VertexData::filled(mesh.n_vertices(), 0.0);
    for h in mesh.halfedges() {
        sums[mesh.origin(h)] += angles[h.at()];
    }
    let index = |(v, sum): (seamstress_mesh::Vertex, &f64)| {
        let group = groups.of[v];
        if group != FREE && groups.list[group as usize].vertices == 1 {
            return groups.list[group as usize].index + f64::from(change[group as usize]);
        }
        let full = if mesh.is_boundary(v) { PI } else { 2.0 * PI };
        if mesh.outgoing(v).next().is_none() { 0.0 } else { (full - sum) / FRAC_PI_2 }
    };
    sums.enumerate().map(index).collect()
}
