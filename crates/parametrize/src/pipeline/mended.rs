//! A second try for a layout step that failed: with consistent matchings.

use super::start::Begun;
use crate::consistency::{ConsistencyOptions, consistent_cut};
use crate::cut::frames_of_angles;
use crate::features::Sectors;
use crate::layout::safeguards::{Laid, LayoutError, lay_out};
use crate::progress::Watch;
use seamstress_mesh::Metric;

/// Quarters per corner: 130 degrees, which leave room below a half turn for triangles that are not thin.
const QUARTERS_PER_CORNER: f64 = 1.44;

/// Lays out with nothing aligned; where no route leads to a layout, rolls back, makes the matchings consistent with the
/// angles of the surface (Levi 2021, supplement, section 9) and lays out once more. Returns how many
/// matchings that changed as well.
///
/// # Errors
/// [`LayoutError`]; that of the first try if the second fails too.
pub(super) fn lay_out_or_mend(
    sectors: &Sectors<'_>,
    metric: &Metric,
    begun: Begun,
    watch: &mut Watch<'_, '_>,
) -> Result<(Laid, usize), LayoutError> {
    let mesh = sectors.mesh();
    let kept = begun.matched.clone();
    let failure = match lay_out(sectors, metric, begun.matched, Some(&begun.frames), watch) {
        Ok(laid) => return Ok((laid, 0)),
        Err(LayoutError::Defective(defects)) => LayoutError::Defective(defects),
        Err(other) => return Err(other),
    };
    let options =
        ConsistencyOptions { quarters_per_corner: QUARTERS_PER_CORNER, ..Default::default() };
    let mended = consistent_cut(mesh, metric, &kept, &metric.angle, &options, watch);
    let (matched, consistent) = match mended.map_err(LayoutError::from) {
        Ok(mended) => mended,
        Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
        Err(_) => return Err(failure),
    };
    let frames = frames_of_angles(mesh, metric, &consistent.angles, &matched.tree);
    match lay_out(sectors, metric, matched, Some(&frames), watch) {
        Ok(laid) => Ok((laid, consistent.stats.changed_matchings)),
        Err(LayoutError::Cancelled(cancelled)) => Err(cancelled.into()),
        Err(_) => Err(failure),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::{DualTree, MatchedCut, curvature_weight};
    use seamstress_mesh::TriMesh;
    use seamstress_testkit as testkit;
    use std::ops::ControlFlow;

    #[test]
    fn matchings_no_layout_can_have_are_mended() {
        let soup = testkit::icosphere(1);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let tree = DualTree::lightest(&mesh, curvature_weight(&mesh, &metric));
        let sectors = Sectors::unaligned(&mesh);
        let mut matched = MatchedCut::new(&sectors, &metric, tree);
        // A vertex with more index than a full turn has no angle left.
        let seam = matched.cut.seams[3];
        matched.matching[3] += 5 - matched.sector_indices(&sectors, &metric)[mesh.tip(seam)];
        assert_eq!(matched.sector_indices(&sectors, &metric)[mesh.tip(seam)], 5);
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        assert!(lay_out(&sectors, &metric, matched.clone(), None, &mut watch).is_err());
        let frames = frames_of_angles(&mesh, &metric, &metric.angle, &matched.tree);
        let begun =
            Begun { matched, frames, rounds: 0, layouts: 0, shifted_seams: 0, mixed_integer: None };
        let (laid, changed) = lay_out_or_mend(&sectors, &metric, begun, &mut watch).unwrap();
        assert!(changed > 0);
        assert!(laid.layout.defects(&sectors, &laid.y).none());
    }
}
