//! Consistent matchings near given ones.

use super::start::{read_corner_uvs, read_cross_field};
use crate::error::{Error, ErrorKind};
use crate::field::{EdgeMatching, matchings};
use crate::report::{SurfaceReport, VERSION};
use crate::surface::Surface;
use seamstress_mesh::{Halfedge, HalfedgeData, VertexData};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyError, ConsistencyInput, ConsistencyOptions, ConsistencyStats,
    MatchingSet, SeamMatching, make_consistent, transitions,
};
use seamstress_parametrize::map::Cone;
use seamstress_parametrize::progress::{Stage, Watch};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What consistent matchings are looked for near, and how.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct MatchingOptions {
    /// Take angles and matchings from this map, which may have foldovers
    #[cfg_attr(feature = "clap", arg(long, value_name = "MAP.obj",
        required_unless_present_any = ["field", "matching"], conflicts_with_all = ["field", "matching"]))]
    pub from: Option<PathBuf>,

    /// Take the matchings of this cross field, and the angles of the surface
    #[cfg_attr(feature = "clap", arg(long, value_name = "FIELD"))]
    pub field: Option<PathBuf>,

    /// Take these matchings modulo 4, with the frames of `--field` or the smoothest ones
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.matching"))]
    pub matching: Option<PathBuf>,

    /// How the distance to the angles is measured [default: l1 for a map, l2 for a field]
    #[cfg_attr(feature = "clap", arg(long, value_enum))]
    pub norm: Option<Norm>,
}

/// How the change of angles is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Norm {
    /// Sum of absolute values: concentrates the change
    L1,
    /// Sum of squares: spreads the change
    L2,
}

/// Matchings that triangles can have.
#[derive(Debug, Clone)]
pub struct ConsistentMatchings {
    matchings: Vec<EdgeMatching>,
    report: ConsistencyReport,
}

/// How far matchings, indices and angles moved.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConsistencyReport {
    /// The version that made them.
    pub seamstress: &'static str,
    /// The surface.
    pub input: SurfaceReport,
    /// Vertices with an index other than zero before.
    pub cones_before: usize,
    /// Interior vertices with an index other than zero now, in quarters.
    pub cones: Vec<Cone>,
    /// Interior edges.
    pub seams: usize,
    /// How far the angles moved.
    pub objective: f64,
    /// How far they must at least.
    pub lower_bound: f64,
    /// What changed.
    pub stats: ConsistencyStats,
}

impl MatchingOptions {
    /// The files that are read.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let files = [&self.from, &self.field, &self.matching];
        files.into_iter().flatten().map(PathBuf::as_path)
    }

    fn read(&self, surface: &Surface) -> Result<Given, Error> {
        let mesh = surface.mesh();
        let (angles, indices, matching) = match &self.from {
            Some(path) => transitions(mesh, &read_corner_uvs(path, surface)?),
            None => {
                let (field, matching) = (self.field.as_deref(), self.matching.as_deref());
                let field = read_cross_field(field, matching, surface)?.ok_or_else(|| {
                    Error::options("give a map with `from`, or a field with `field`")
                })?;
                let angles = surface.metric().angle.clone();
                (angles, field.indices(mesh), field.matching().clone())
            }
        };
        let seam = |left: Halfedge| SeamMatching {
            left,
            matching: f64::from(matching[left]),
            set: MatchingSet::Integer,
        };
        Ok(Given { angles, indices, seams: mesh.interior_edges().map(seam).collect() })
    }
}

/// Angles, indices, and a matching per interior edge.
struct Given {
    angles: HalfedgeData<f64>,
    indices: VertexData<i32>,
    seams: Vec<SeamMatching>,
}

impl ConsistentMatchings {
    /// The matchings of all edges.
    pub fn matchings(&self) -> &[EdgeMatching] {
        &self.matchings
    }

    /// Interior vertices with an index other than zero, in quarters.
    pub fn cones(&self) -> &[Cone] {
        &self.report.cones
    }

    /// How far matchings, indices and angles moved.
    pub fn report(&self) -> &ConsistencyReport {
        &self.report
    }
}

impl Surface {
    /// Finds matchings, indices and angles that triangles can have near those that are given.
    ///
    /// # Errors
    /// [`ErrorKind::Inconsistent`] where there are none, and those of reading the files.
    ///
    /// # Source
    /// Levi 2021, suppl. sec. 9.
    pub fn consistent_matchings(
        &self,
        options: &MatchingOptions,
    ) -> Result<ConsistentMatchings, Error> {
        let made = self.context().run(|watcher| {
            let mesh = self.mesh();
            let given = options.read(self)?;
            let indices: VertexData<f64> = given.indices.iter().map(|&k| f64::from(k)).collect();
            let input =
                ConsistencyInput { angles: &given.angles, indices: &indices, seams: &given.seams };
            let norm = match (options.norm, &options.from) {
                (Some(Norm::L1), _) | (None, Some(_)) => AngleNorm::L1,
                _ => AngleNorm::L2,
            };
            let settings = ConsistencyOptions { norm, ..ConsistencyOptions::default() };
            let mut observe = |progress| watcher.observe(progress);
            let mut watch = Watch::new(&mut observe, 0, 1);
            let entered = watch.enter(Stage::Rounding).map_err(ConsistencyError::from);
            let made = entered.and_then(|()| make_consistent(mesh, &input, &settings, &mut watch));
            let consistent = made.map_err(|cause| match cause {
                ConsistencyError::Cancelled(_) => {
                    Error::new(ErrorKind::Cancelled, "stopped on request")
                }
                cause => {
                    Error::new(ErrorKind::Inconsistent, format!("no consistent matchings: {cause}"))
                }
            })?;
            let mut matching = HalfedgeData::filled(mesh.n_halfedges(), 0);
            for (seam, r) in given.seams.iter().zip(&consistent.matchings) {
                matching[seam.left] = r.round() as i32;
            }
            let cones = consistent.indices.enumerate();
            let cones = cones.filter(|(v, k)| !mesh.is_boundary(*v) && **k != 0.0);
            let report = ConsistencyReport {
                seamstress: VERSION,
                input: self.report().clone(),
                cones_before: given.indices.iter().filter(|&&k| k != 0).count(),
                cones: cones.map(|(v, k)| Cone { vertex: v.0, index: k.round() as i32 }).collect(),
                seams: given.seams.len(),
                objective: consistent.objective,
                lower_bound: consistent.lower_bound,
                stats: consistent.stats,
            };
            Ok(ConsistentMatchings { matchings: matchings(self, &matching), report })
        });
        made.map_err(|error| error.of(self.input()))
    }
}
