//! Wrong windings undone where they are.

use super::barrier::barrier;
use super::exact::{Defects, ExactLayout};
use super::patch::Patch;
use crate::cut::MatchedCut;
use crate::features::Sectors;
use crate::progress::{SolveError, Watch};
use crate::quarter::direction;
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, Halfedge, Metric};

/// Rings of faces around a vertex with a wrong angle. The turn that it has too much lacks at a cone of negative index, which
/// is hardly ever farther away.
const RINGS: usize = 3;

/// From a layout without flips, but with vertices that are wound once too often: the one nearest to what the barrier homotopy
/// gives around those vertices, and to itself elsewhere; with the steps taken. It may flip triangles.
///
/// # Errors
/// [`SolveError`].
pub(super) fn unwound(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: &MatchedCut,
    space: &mut ExactLayout,
    y: &[f64],
    defects: &Defects,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<f64>, usize), SolveError> {
    let mesh = sectors.mesh();
    let patch = Patch::around(mesh, &matched.unfolding.cut, defects.vertices(mesh), RINGS);
    let local = barrier(sectors, metric, matched, &patch, watch)?;
    let mut corner = space.corners(mesh, y);
    // A piece without aligned edges may have turned as a whole.
    let pieces = patch.pieces(mesh);
    let mut back = FaceData::filled(mesh.n_faces(), Complex64::ZERO);
    let mut stands = FaceData::filled(mesh.n_faces(), false);
    let piece = |h: Halfedge| -> Face { pieces[h.face()] };
    for (h, _) in patch.corners() {
        let [a, b] = patch.ends(h).map(|w| local.z[w as usize]);
        back[piece(h)] += (corner[h.next()] - corner[h]) * (b - a).conj();
        stands[piece(h)] |= sectors.is_aligned(h);
    }
    for (h, w) in patch.corners() {
        let z = local.z[w as usize];
        corner[h] = if stands[piece(h)] { z } else { direction(back[piece(h)]) * z };
    }
    Ok((space.nearest(mesh, &corner)?, local.steps))
}
