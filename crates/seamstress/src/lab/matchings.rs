//! Consistent matchings near given ones.

use super::start::{read_corner_uvs, read_cross_field};
use crate::error::{Error, ErrorKind};
use crate::feature_edges::named_edges;
use crate::feature_sources::FeatureSource;
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

    /// Keep the matchings of these edges; sources as in `map --features`, may be given several times
    #[cfg_attr(feature = "clap", arg(long, value_name = "SOURCE"))]
    pub constant_edges: Vec<FeatureSource>,

    /// Let the matchings of these edges be any real numbers: not rounded yet
    #[cfg_attr(feature = "clap", arg(long, value_name = "SOURCE"))]
    pub real_edges: Vec<FeatureSource>,
}

/// An index this near to an integer is one, quarters.
const SETTLED: f64 = 1e-6;

/// How the change of angles is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
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
    /// Interior vertices with an index other than zero now, in quarters; without those whose index real matchings
    /// leave between two integers.
    pub cones: Vec<Cone>,
    /// Interior edges.
    pub seams: usize,
    /// How far the angles moved: the sum of squared changes, radians squared, or of absolute ones, radians.
    pub objective: f64,
    /// No solution is nearer than this.
    pub lower_bound: f64,
    /// Whether that proves the solution nearest, to a part in ten million. If not, a nearer one may exist.
    pub optimal: bool,
    /// By what share of the objective a nearer solution could at most be nearer.
    pub gap: f64,
    /// The real matchings, which are rounded in files.
    pub real_matchings: Vec<RealMatching>,
    /// What changed.
    pub stats: ConsistencyStats,
}

/// A matching that is not rounded.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RealMatching {
    /// The ends of the edge, as the face on its left has them.
    pub vertices: [u32; 2],
    /// Quarter turns from left to right.
    pub matching: f64,
}

impl MatchingOptions {
    /// The files that are read.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let files = [&self.from, &self.field, &self.matching];
        let sources = self.constant_edges.iter().chain(&self.real_edges);
        let files = files.into_iter().flatten().map(PathBuf::as_path);
        files.chain(sources.filter_map(FeatureSource::file))
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
        let constant = named_edges(surface, &self.constant_edges)?;
        let real = named_edges(surface, &self.real_edges)?;
        if let Some(&h) = constant.edges().iter().find(|&&h| real.contains(h)) {
            let (a, b) = (mesh.origin(h).0, mesh.tip(h).0);
            let text = format!("the matching of edge {a}-{b} cannot be both constant and real");
            return Err(Error::options(text));
        }
        let set = |h: Halfedge| match (constant.contains(h), real.contains(h)) {
            (true, _) => MatchingSet::Constant,
            (_, true) => MatchingSet::Real,
            _ => MatchingSet::Integer,
        };
        let seam = |left: Halfedge| {
            let matching = f64::from(matching[left]);
            SeamMatching { left, matching, set: set(left) }
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
    /// Finds matchings, indices and angles that triangles can have near those that are given. They are the nearest
    /// ones where the report says that they are optimal; its bound says how much nearer others may be.
    ///
    /// # Errors
    /// [`ErrorKind::Inconsistent`] where there are none, [`ErrorKind::Options`] if an edge is both constant and
    /// real, and those of reading the files.
    ///
    /// # Source
    /// Levi 2021, suppl. sec. 9.
    pub fn consistent_matchings(
        &self,
        options: &MatchingOptions,
    ) -> Result<ConsistentMatchings, Error> {
        let made = self.context().run(self.expected_for_map(), |watcher| {
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
            let settled = |k: f64| (k - k.round()).abs() < SETTLED && k.round() != 0.0;
            let cones = consistent.indices.enumerate();
            let cones = cones.filter(|(v, k)| !mesh.is_boundary(*v) && settled(**k));
            let seams = given.seams.iter().zip(&consistent.matchings);
            let real = seams.filter(|(seam, _)| seam.set == MatchingSet::Real);
            let real = real.map(|(seam, &matching)| RealMatching {
                vertices: [mesh.origin(seam.left).0, mesh.tip(seam.left).0],
                matching,
            });
            let report = ConsistencyReport {
                seamstress: VERSION,
                input: self.report().clone(),
                cones_before: given.indices.iter().filter(|&&k| k != 0).count(),
                cones: cones.map(|(v, k)| Cone { vertex: v.0, index: k.round() as i32 }).collect(),
                seams: given.seams.len(),
                objective: consistent.objective,
                lower_bound: consistent.lower_bound,
                optimal: consistent.optimal,
                gap: consistent.gap(),
                real_matchings: real.collect(),
                stats: consistent.stats,
            };
            Ok(ConsistentMatchings { matchings: matchings(self, &matching), report })
        });
        made.map_err(|error| error.of(self.input()))
    }
}
