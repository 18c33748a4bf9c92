//! What the problem is given and what it gives back.

use super::error::ConsistencyError;
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, VertexData};

/// The values a matching may take: the three sets of Levi 2021, suppl. sec. 9.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatchingSet {
    /// Stays as it is.
    Constant,
    /// Any integer.
    Integer,
    /// Any real number: not rounded yet.
    Real,
}

/// A seam and its matching.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeamMatching {
    /// Left half-edge of an interior edge.
    pub left: Halfedge,
    /// Lifted matching from left to right, quarter turns.
    pub matching: f64,
    /// Values it may take.
    pub set: MatchingSet,
}

/// Angles, indices and matchings that need not fit together.
#[derive(Debug, Clone, Copy)]
pub struct ConsistencyInput<'a> {
    /// Angle per corner to stay close to, radians; any finite numbers.
    pub angles: &'a HalfedgeData<f64>,
    /// Field index per vertex at the matchings given, quarters. Those of boundary vertices, and of
    /// vertices without a face, are not read. On a closed component they sum to 4 chi.
    pub indices: &'a VertexData<f64>,
    /// The matchings that move index; an edge that is not listed is constant.
    pub seams: &'a [SeamMatching],
}

impl ConsistencyInput<'_> {
    /// Whether everything is there, finite, and about this mesh.
    pub(super) fn check(&self, mesh: &TriMesh) -> Result<(), ConsistencyError> {
        let counts = [
            ("angles", mesh.n_halfedges(), self.angles.len()),
            ("indices", mesh.n_vertices(), self.indices.len()),
        ];
        for (what, expected, found) in counts {
            if expected != found {
                return Err(ConsistencyError::Count { what, expected, found });
            }
        }
        finite("angle of corner", self.angles.enumerate().map(|(h, &a)| (h.0, a)))?;
        let read = |v: &seamstress_mesh::Vertex| {
            mesh.outgoing(*v).next().is_some() && !mesh.is_boundary(*v)
        };
        let indices = mesh.vertices().filter(read).map(|v| (v.0, self.indices[v]));
        finite("index of vertex", indices)?;
        let matchings = self.seams.iter().map(|seam| (seam.left.0, seam.matching));
        finite("matching of half-edge", matchings)?;
        let mut seen = HalfedgeData::filled(mesh.n_halfedges(), false);
        for seam in self.seams {
            let halfedge = seam.left.0;
            let inside = seam.left.at() < mesh.n_halfedges();
            let twin = if inside { mesh.twin(seam.left) } else { None };
            let Some(twin) = twin.filter(|_| !seen[seam.left]) else {
                return Err(ConsistencyError::NoSeam { halfedge });
            };
            (seen[seam.left], seen[twin]) = (true, true);
        }
        Ok(())
    }
}

fn finite(
    what: &'static str,
    mut values: impl Iterator<Item = (u32, f64)>,
) -> Result<(), ConsistencyError> {
    match values.find(|(_, x)| !x.is_finite()) {
        Some((element, _)) => Err(ConsistencyError::NonFinite { what, element }),
        None => Ok(()),
    }
}

/// How the distance of angles is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AngleNorm {
    /// Sum of squares, which spreads the change.
    #[default]
    L2,
    /// Sum of absolute values, which concentrates it.
    L1,
}

impl AngleNorm {
    /// What the change of one angle adds to the distance.
    pub(super) fn cost(self, change: f64) -> f64 {
        match self {
            AngleNorm::L2 => change * change,
            AngleNorm::L1 => change.abs(),
        }
    }
}

/// Settings of [`super::make_consistent`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConsistencyOptions {
    /// The objective.
    pub norm: AngleNorm,
    /// A vertex gets less than this many quarters per corner on average: 2 (half a turn) is what
    /// triangles can have at all; 1.44 leaves room for a layout that is not thin.
    pub quarters_per_corner: f64,
    /// Memory for cached columns of the inverse, bytes.
    pub column_memory: usize,
    /// Most work on a search beyond local moves and on a proof that nothing is better, in visits of corners: some
    /// thirty million are a second. At 0 the result is that of the local moves.
    pub work: u64,
}

/// Default of [`ConsistencyOptions::work`]: enough to prove components of 20 vertices in either norm.
const WORK: u64 = 60_000_000;

impl Default for ConsistencyOptions {
    fn default() -> Self {
        Self { norm: AngleNorm::L2, quarters_per_corner: 2.0, column_memory: 256 << 20, work: WORK }
    }
}

/// Matchings, indices and angles that fit together.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Consistent {
    /// Lifted matching of each seam given, in the same order: integers for the integer set.
    pub matchings: Vec<f64>,
    /// Field index per vertex, quarters; boundary vertices are measured from a half turn.
    pub indices: VertexData<f64>,
    /// Angle per corner, radians, positive.
    pub angles: HalfedgeData<f64>,
    /// Distance of the angles from those given: radians squared in the l2 norm, radians in the l1 norm.
    pub objective: f64,
    /// No solution of the problem is closer than this.
    pub lower_bound: f64,
    /// Whether the bound proves that no solution is closer, to a part in ten million.
    pub optimal: bool,
    /// How it went.
    pub stats: ConsistencyStats,
}

impl Consistent {
    /// By what share of itself the objective may be above the optimum, at most: 0 if it is proven optimal.
    pub fn gap(&self) -> f64 {
        match self.optimal {
            true => 0.0,
            false => (self.objective - self.lower_bound) / self.objective,
        }
    }
}

/// How a consistent solution was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConsistencyStats {
    /// Units of index moved before the search because no triangles could have them.
    pub impossible_units: usize,
    /// Batches of index moves accepted.
    pub batches: usize,
    /// Columns of the inverse solved for.
    pub columns: usize,
    /// Quadratic programs solved: 0 when the angles came out positive by themselves.
    pub programs: usize,
    /// Interior-point iterations in all.
    pub interior_point_iterations: usize,
    /// Vertices, or groups of vertices joined by real matchings, whose index changed.
    pub changed_indices: usize,
    /// Integer matchings that changed.
    pub changed_matchings: usize,
}
