//! The classical way, as a baseline: a smooth cross field, then the Poisson layout that follows it.

use super::components::by_component;
use super::domain::corner_uvs;
use super::log::StageLog;
use super::{ComponentStats, MapError, MethodError};
use crate::cut::Unfolding;
use crate::features::Sectors;
use crate::field::smooth_field;
use crate::layout::exact::ExactLayout;
use crate::layout::route::Route;
use crate::map::{Cone, SeamlessMap, Tolerance, Violations};
use crate::progress::{Observer, Stage, Watch};
use crate::quality::{Distortion, distortion};
use seamstress_mesh::{Component, Metric, TriMesh};

/// Settings of the baseline.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FieldMapOptions {
    /// Local/global iterations after the Poisson layout (Myles and Zorin 2012); none in the original.
    pub iterations: usize,
    /// Tolerance of the certificate.
    pub tolerance: Tolerance,
}

/// A layout that closes up but is no seamless map.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct UncertifiedMap {
    /// One UV per corner, three per face, mesh units.
    pub corner_uvs: Vec<[f64; 2]>,
    /// What is wrong with it: flipped or collapsed triangles, wrong angles.
    pub violations: Violations,
}

/// The result of the baseline.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FieldMap {
    /// The map if it passes the certificate, else the layout as it is.
    pub map: Result<SeamlessMap, UncertifiedMap>,
    /// Its distortion; `tau` is infinite with flips.
    pub distortion: Distortion,
    /// Cones of the field, ascending.
    pub field_cones: Vec<Cone>,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<ComponentStats>,
}

/// Makes a map the classical way (Bommes, Zimmer, Kobbelt 2009): a smooth cross field by mixed-integer
/// rounding, then the layout that minimises eq. (6) for its frames, with exact seams. Nothing keeps
/// triangles from flipping.
///
/// # Errors
/// [`MapError`], but not for a layout that fails the certificate.
pub fn make_field_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    options: &FieldMapOptions,
    observer: &mut Observer<'_>,
) -> Result<FieldMap, MapError> {
    let mut field_cones = Vec::new();
    let (corner_uvs, components) = by_component(mesh, positions, observer, |piece, watch| {
        let (uvs, stats, cones) = lay_out_field(piece, positions, options, watch)?;
        field_cones.extend(cones);
        Ok((uvs, stats))
    })?;
    field_cones.sort_unstable_by_key(|cone| cone.vertex);
    let metric = Metric::from_positions(mesh, positions);
    let distortion = distortion(mesh, &metric, &corner_uvs);
    let map = match SeamlessMap::certify(mesh, corner_uvs.clone(), &options.tolerance) {
        Ok(map) => Ok(map),
        Err(violations) => Err(UncertifiedMap { corner_uvs, violations }),
    };
    Ok(FieldMap { map, distortion, field_cones, components })
}

type Baseline = (Vec<[f64; 2]>, ComponentStats, Vec<Cone>);

fn lay_out_field(
    piece: &Component,
    positions: &[[f64; 3]],
    options: &FieldMapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Baseline, MethodError> {
    let mesh = &piece.mesh;
    let positions = piece.positions(positions);
    let metric = Metric::from_positions(mesh, &positions);
    let mut log = StageLog::default();

    log.enter(Stage::Rounding, watch)?;
    let sectors = Sectors::unaligned(mesh);
    let unfolding = Unfolding::through_curved_sectors(&sectors, &metric);
    let (start, field) = smooth_field(mesh, &metric, unfolding, watch)?;
    log.count(field.solves);

    log.enter(Stage::Layout, watch)?;
    let mut layout = ExactLayout::new(&sectors, &metric, &start.matched)?;
    // The first global step is the Poisson layout.
    let mut y = layout.arap(&start.frames, options.iterations, watch)?;
    layout.rescale(&mut y);
    log.count(1 + options.iterations);

    let cones = layout.index.enumerate().filter(|(_, k)| **k != 0);
    let cones = cones.map(|(v, &index)| Cone { vertex: piece.vertices[v].0, index }).collect();
    let stats = ComponentStats {
        faces: mesh.n_faces(),
        genus: mesh.genus(),
        boundary_loops: mesh.n_boundary_loops(),
        route: Route::Poisson,
        lengthening: 0.0,
        rounding_rounds: field.rounds,
        repaired_seams: 0,
        mixed_integer: None,
        stages: log.finish(),
    };
    Ok((corner_uvs(mesh, &metric, &layout, &y), stats, cones))
}
