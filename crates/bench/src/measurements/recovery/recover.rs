//! One mesh: its good map, damaged, made consistent, laid out.

use super::damage::{Damage, count_flips, folded_angles, noisy_angles, wrong_matchings};
use crate::meshes::Mesh;
use crate::process::Clock;
use seamstress_mesh::{HalfedgeData, Metric, TriMesh, components::components};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyError, ConsistencyOptions, Consistent, consistent_cut, lifted_angles,
    matched_by_angles,
};
use seamstress_parametrize::cut::{
    DualTree, FramedCut, MatchedCut, curvature_weight, frames_of_angles,
};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::layout::ladder::{LayoutEffort, lay_out};
use seamstress_parametrize::progress::Watch;
use seamstress_parametrize::{
    FieldMapOptions, MapError, MapOptions, SeamlessMap, Tolerance, make_field_map, make_map,
};
use seamstress_testkit::{CheckedSeam, Rng, consistency_faults};
use std::ops::ControlFlow;

/// A component with the corner UVs of its good map, and of the layout of a smooth field.
struct Piece {
    mesh: TriMesh,
    metric: Metric,
    corner_uvs: Vec<[f64; 2]>,
    field_uvs: Vec<[f64; 2]>,
}

/// A mesh with a good map.
pub(super) struct Subject {
    pieces: Vec<Piece>,
}

/// What became of a damaged map.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    triangles: usize,
    flips: usize,
    cones: [usize; 2],
    moved: usize,
    objective: f64,
    lower_bound: f64,
    columns: usize,
    programs: usize,
    seconds: f64,
    pub(super) faults: usize,
    pub(super) mapped: bool,
    note: String,
}

impl Outcome {
    pub(super) const TITLES: [&'static str; 13] = [
        "mesh",
        "damage",
        "triangles",
        "flips",
        "cones",
        "cones after",
        "indices moved",
        "objective",
        "bound",
        "columns",
        "programs",
        "CPU s",
        "result",
    ];

    pub(super) fn cells(&self, name: &str, damage: Damage) -> Vec<String> {
        let result = match (self.faults, self.mapped) {
            (0, true) => "certified".to_owned(),
            (0, false) if self.note.is_empty() => "consistent".to_owned(),
            _ => self.note.clone(),
        };
        vec![
            name.to_owned(),
            damage.to_string(),
            self.triangles.to_string(),
            self.flips.to_string(),
            self.cones[0].to_string(),
            self.cones[1].to_string(),
            self.moved.to_string(),
            format!("{:.4}", self.objective),
            format!("{:.4}", self.lower_bound),
            self.columns.to_string(),
            self.programs.to_string(),
            format!("{:.2}", self.seconds),
            result,
        ]
    }

    fn fail(&mut self, faults: usize, note: String) {
        self.faults += faults;
        self.mapped = false;
        self.note = note;
    }
}

impl Subject {
    pub(super) fn new(mesh: &Mesh) -> Result<Self, MapError> {
        let mut go_on = |_| ControlFlow::Continue(());
        let options = MapOptions::default();
        let made = make_map(&mesh.connectivity, &mesh.positions, &options, &mut go_on)?;
        let field_options = FieldMapOptions::default();
        let field =
            make_field_map(&mesh.connectivity, &mesh.positions, &field_options, &mut go_on)?;
        let field = match &field.map {
            Ok(map) => map.corner_uvs(),
            Err(layout) => &layout.corner_uvs,
        };
        let uvs = made.map.corner_uvs();
        let pieces = components(&mesh.connectivity).unwrap_or_default();
        let piece = |piece: seamstress_mesh::Component| {
            let positions: Vec<_> = piece.vertices.iter().map(|v| mesh.positions[v.at()]).collect();
            let metric = Metric::from_positions(&piece.mesh, &positions);
            let corners = || piece.faces.iter().flat_map(|f| f.halfedges());
            let corner_uvs = corners().map(|h| uvs[h.at()]).collect();
            let field_uvs = corners().map(|h| field[h.at()]).collect();
            Piece { metric, corner_uvs, field_uvs, mesh: piece.mesh }
        };
        Ok(Self { pieces: pieces.into_iter().map(piece).collect() })
    }

    pub(super) fn recover(&self, damage: Damage, norm: AngleNorm, lays_out: bool) -> Outcome {
        let mut outcome = Outcome { mapped: lays_out, ..Outcome::default() };
        let mut rng = Rng::new(damage as u64);
        for piece in &self.pieces {
            outcome.triangles += piece.mesh.n_faces();
            let (matched, angles) = piece.damaged(damage, &mut rng, &mut outcome);
            let clock = Clock::start();
            let made = piece.consistent(&matched, &angles, norm);
            outcome.seconds += clock.seconds();
            match made {
                Ok((consistent_cut, consistent)) => {
                    outcome.objective += consistent.objective;
                    outcome.lower_bound += consistent.lower_bound;
                    outcome.columns += consistent.stats.columns;
                    outcome.programs += consistent.stats.programs;
                    outcome.moved += consistent.stats.changed_indices;
                    outcome.cones[1] += piece.cones(&consistent_cut);
                    let faults = piece.faults(&matched, &consistent);
                    if let Some(first) = faults.first() {
                        outcome.fail(faults.len(), first.clone());
                    }
                    if lays_out {
                        piece.lay_out(consistent_cut, &consistent, &mut outcome);
                    }
                }
                Err(error) => outcome.fail(1, error.to_string()),
            }
        }
        outcome
    }
}

impl Piece {
    fn damaged(
        &self,
        damage: Damage,
        rng: &mut Rng,
        outcome: &mut Outcome,
    ) -> (MatchedCut, HalfedgeData<f64>) {
        let good = lifted_angles(&self.mesh, &self.corner_uvs);
        let tree = DualTree::lightest(&self.mesh, curvature_weight(&self.mesh, &self.metric));
        let mut matched = matched_by_angles(&self.mesh, &self.metric, tree, &good);
        outcome.cones[0] += self.cones(&matched);
        let angles = match damage {
            Damage::Naive => {
                matched = MatchedCut::new(
                    &Sectors::unaligned(&self.mesh),
                    &self.metric,
                    matched.unfolding.tree,
                );
                self.metric.angle.clone()
            }
            Damage::Matchings => {
                wrong_matchings(&mut matched.matching, rng);
                good
            }
            Damage::Angles => noisy_angles(&good, rng),
            Damage::Foldovers => {
                let (angles, flips) = folded_angles(&self.mesh, &self.corner_uvs, rng);
                outcome.flips += flips;
                matched =
                    matched_by_angles(&self.mesh, &self.metric, matched.unfolding.tree, &angles);
                angles
            }
            Damage::Field => {
                outcome.flips += count_flips(&self.mesh, &self.field_uvs);
                let angles = lifted_angles(&self.mesh, &self.field_uvs);
                matched =
                    matched_by_angles(&self.mesh, &self.metric, matched.unfolding.tree, &angles);
                angles
            }
        };
        (matched, angles)
    }

    fn cones(&self, matched: &MatchedCut) -> usize {
        matched
            .sector_indices(&Sectors::unaligned(&self.mesh), &self.metric)
            .iter()
            .filter(|&&k| k != 0)
            .count()
    }

    fn consistent(
        &self,
        matched: &MatchedCut,
        angles: &HalfedgeData<f64>,
        norm: AngleNorm,
    ) -> Result<(MatchedCut, Consistent), ConsistencyError> {
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let options = ConsistencyOptions { norm, ..Default::default() };
        consistent_cut(&self.mesh, &self.metric, matched, angles, &options, &mut watch)
    }

    /// All conditions of problem (14), by the checker.
    fn faults(&self, before: &MatchedCut, after: &Consistent) -> Vec<String> {
        let faces: Vec<[u32; 3]> =
            self.mesh.faces().map(|f| self.mesh.face_vertices(f).map(|v| v.0)).collect();
        let pairs = before.matching.iter().zip(&after.matchings);
        let seams: Vec<CheckedSeam> = before
            .unfolding
            .cut
            .seams
            .iter()
            .zip(pairs)
            .map(|(h, (&r, &after))| CheckedSeam {
                left: h.0,
                before: f64::from(r),
                after,
                set: 'i',
            })
            .collect();
        let indices = before.sector_indices(&Sectors::unaligned(&self.mesh), &self.metric);
        let indices: Vec<f64> = indices.iter().map(|&k| f64::from(k)).collect();
        consistency_faults(&faces, &indices, &after.indices, &after.angles, &seams)
    }

    fn lay_out(&self, matched: MatchedCut, consistent: &Consistent, outcome: &mut Outcome) {
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let tree = &matched.unfolding.tree;
        let frames = frames_of_angles(&self.mesh, &self.metric, &consistent.angles, tree);
        let sectors = Sectors::unaligned(&self.mesh);
        let start = FramedCut { matched, frames };
        let effort = LayoutEffort::Thorough;
        match lay_out(&sectors, &self.metric, &start, effort, &mut watch) {
            Ok(Ok(layout)) => {
                let z = layout.space.expand(&layout.y);
                let uv = |h| z[layout.space.cut.wedge[h] as usize];
                let uvs = self.mesh.halfedges().map(|h| [uv(h).re, uv(h).im]).collect();
                if let Err(error) = SeamlessMap::certify(&self.mesh, uvs, &Tolerance::default()) {
                    outcome.fail(0, error.to_string());
                }
            }
            Ok(Err(defects)) => outcome.fail(0, defects.to_string()),
            Err(error) => outcome.fail(0, error.to_string()),
        }
    }
}
