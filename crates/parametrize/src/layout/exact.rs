//! Layouts whose seams are closed exactly: the cut through the cones and the space over it.

use super::alignment::{Level, leveled};
use super::arap::{Poisson, frames};
use super::newton::{NewtonOptions, NewtonSolution, minimize};
use super::problem::LayoutProblem;
use super::space::{LinearSpace, seamless_space};
use crate::cut::{Cut, MatchedCut, SeamGraph, connect_cones, in_gauge, regauge, turned_vertices};
use crate::energy::{Energy, Triangle, is_positive, triangles};
use crate::features::Sectors;
use crate::map::SeamlessMap;
use crate::progress::{Cancelled, SolveError, Watch};
use crate::quality::{Figures, SingularValues};
use crate::quarter::{turn, within};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{
    Face, FaceData, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData,
};
use std::f64::consts::FRAC_PI_2;

/// A cut through the cones, its matchings, and the layouts that close up to them.
pub struct ExactLayout {
    /// The cut; its seams end at cones or the boundary.
    pub cut: Cut,
    /// Matching per half-edge in the gauge of this cut, zero off the seams.
    pub matching: HalfedgeData<i32>,
    /// Quarter turns applied to each face against the gauge of the all-seam cut.
    pub gauge: FaceData<i32>,
    /// Index of each sector, in quarters, that the layout must have.
    pub index: VertexData<i32>,
    problem: LayoutProblem,
}

/// What is wrong with a layout, if anything.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Defects {
    /// Triangles whose orientation is not positive.
    pub flips: Vec<Face>,
    /// Vertices with a sector whose angle is not the whole number of quarters it has to be.
    pub wrong_angles: Vec<Vertex>,
}

impl Defects {
    /// Neither flips nor wrong angles.
    pub fn none(&self) -> bool {
        self.flips.is_empty() && self.wrong_angles.is_empty()
    }

    /// Marks the vertices of flipped triangles and those with wrong angles.
    pub fn vertices(&self, mesh: &TriMesh) -> VertexData<bool> {
        let mut marked = VertexData::filled(mesh.n_vertices(), false);
        for v in self.flips.iter().flat_map(|&f| mesh.face_vertices(f)) {
            marked[v] = true;
        }
        self.wrong_angles.iter().for_each(|&v| marked[v] = true);
        marked
    }
}

impl std::fmt::Display for Defects {
    /// Counts and the first few elements.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let list = |ids: Vec<u32>| {
            let shown: Vec<String> = ids.iter().take(5).map(u32::to_string).collect();
            let more = if ids.len() > 5 { ", ..." } else { "" };
            match ids.len() {
                0 => String::new(),
                _ => format!(" ({}{more})", shown.join(", ")),
            }
        };
        let (flips, wrong) = (self.flips.len(), self.wrong_angles.len());
        write!(f, "{flips} flipped triangles{}", list(self.flips.iter().map(|f| f.0).collect()))?;
        let vertices = list(self.wrong_angles.iter().map(|v| v.0).collect());
        write!(f, " and {wrong} vertices with a wrong angle{vertices}")
    }
}

impl ExactLayout {
    /// Cuts through the cones of the matchings and builds the exact space, aligned edges along the axes.
    ///
    /// # Errors
    /// When the system cannot be set up.
    pub fn new(
        sectors: &Sectors<'_>,
        metric: &Metric,
        matched: &MatchedCut,
    ) -> Result<Self, NotPositiveDefinite> {
        let index = matched.sector_indices(sectors, metric);
        Self::over(sectors, metric, &matched.matching_per_halfedge(sectors), index)
    }

    /// The exact layouts with the matchings (modulo 4) and cones of a map of a connected mesh, and the
    /// unknowns of the one nearest to it in the Jacobians; see [`Self::from_aligned_map`].
    ///
    /// # Errors
    /// When a system cannot be set up or factored.
    pub fn from_map(
        mesh: &TriMesh,
        metric: &Metric,
        map: &SeamlessMap,
    ) -> Result<(Self, Vec<f64>), NotPositiveDefinite> {
        Self::from_aligned_map(&Sectors::unaligned(mesh), metric, map)
    }

    /// The same where edges are aligned: they keep their axes and senses, and sectors their angles.
    ///
    /// The map's UVs are in mesh units, and the aligned edges run along the axes in it. Its own gauge is
    /// that of the all-seam cut here.
    ///
    /// # Errors
    /// When a system cannot be set up or factored.
    pub fn from_aligned_map(
        sectors: &Sectors<'_>,
        metric: &Metric,
        map: &SeamlessMap,
    ) -> Result<(Self, Vec<f64>), NotPositiveDefinite> {
        let (mesh, slit) = (sectors.mesh(), sectors.slit());
        let corner = |h: Halfedge| {
            let [u, v] = map.corner_uvs()[h.at()];
            Complex64::new(u, v) / metric.unit
        };
        let mut full = HalfedgeData::filled(mesh.n_halfedges(), 0);
        for seam in map.seams() {
            full[seam.left] = seam.matching;
            if let Some(t) = mesh.twin(seam.left) {
                full[t] = -seam.matching;
            }
        }
        for h in sectors.aligned() {
            let direction = (corner(h.next()) - corner(h)).arg() / FRAC_PI_2;
            full[h] = -direction.round() as i32;
        }
        let mut angle = VertexData::filled(slit.n_vertices(), 0.0);
        for h in mesh.halfedges() {
            let [right, left] = [h.next(), h.prev()].map(|other| corner(other) - corner(h));
            angle[slit.origin(h)] += (right.conj() * left).arg() / FRAC_PI_2;
        }
        // The index for an angle is what the angle is for an index.
        let index =
            |s| if sectors.is_free(s) { 0 } else { sectors.quarters(s, angle[s]).round() as i32 };
        let index = slit.vertices().map(index).collect();
        let mut layout = Self::over(sectors, metric, &full, index)?;
        let targets = layout.jacobians(mesh, corner);
        let y = Poisson::new(&mut layout.problem)?.follow(&targets);
        Ok((layout, y))
    }

    /// The layouts of a mesh, its boundary free, that close up to a matching per half-edge, zero across the
    /// tree of an all-seam cut. Of what [`ExactLayout::defects`] tells only the flips mean something.
    ///
    /// # Errors
    /// When the system cannot be set up.
    pub(crate) fn closing(
        mesh: &TriMesh,
        metric: &Metric,
        matching: &HalfedgeData<i32>,
    ) -> Result<Self, NotPositiveDefinite> {
        let index = VertexData::filled(mesh.n_vertices(), 0);
        Self::over(&Sectors::unaligned(mesh), metric, matching, index)
    }

    /// Over the matching of every half-edge of the slit mesh, which counts modulo 4, and the index of
    /// every sector.
    fn over(
        sectors: &Sectors<'_>,
        metric: &Metric,
        slit_matching: &HalfedgeData<i32>,
        index: VertexData<i32>,
    ) -> Result<Self, NotPositiveDefinite> {
        let mesh = sectors.mesh();
        let full = sectors.glue(slit_matching);
        let is_cone = turned_vertices(mesh, &full);
        let (cut, tree) = connect_cones(mesh, metric, &is_cone).ok_or(NotPositiveDefinite)?;
        let (mut matching, gauge) = regauge(mesh, &tree, &full);
        for h in mesh.halfedges() {
            // Off the seams the matchings are multiples of four: the same rotation as none.
            matching[h] = if cut.is_seam[h] { matching[h] } else { 0 };
        }
        let graph = SeamGraph::new(mesh, &cut, &is_cone);
        let mut space = seamless_space(mesh, &cut, &graph, &matching);
        if sectors.any_aligned() {
            let direction = |h: Halfedge| gauge[h.face()] - slit_matching[h];
            let levels: Vec<Level> = sectors
                .aligned()
                .map(|h| Level {
                    ends: cut.ends(h),
                    // An edge along u (an even direction) is level in v.
                    coordinate: 1 - direction(h).rem_euclid(2) as u32,
                })
                .collect();
            space = leveled(&space, &levels);
        }
        let problem = LayoutProblem::ordered(space, triangles(mesh, metric, &cut), |space| {
            node_order(sectors, &cut, space)
        })?;
        Ok(Self { cut, matching, gauge, index, problem })
    }

    /// The problem behind it.
    pub fn problem(&self) -> &LayoutProblem {
        &self.problem
    }

    /// The problem behind it, to be solved.
    pub fn problem_mut(&mut self) -> &mut LayoutProblem {
        &mut self.problem
    }

    /// Positions of the wedges for the unknowns.
    pub fn expand(&self, y: &[f64]) -> Vec<Complex64> {
        self.problem.space().expand(y)
    }

    /// The unknowns of a layout of another cut that has no seams: they are the positions themselves, up
    /// to the translation that is pinned.
    pub fn adopt(&self, other: &Cut, z: &[Complex64]) -> Vec<f64> {
        let mut here = vec![Complex64::ZERO; self.cut.n_wedges];
        for (there, wedge) in other.wedge.iter().zip(self.cut.wedge.iter()) {
            here[*wedge as usize] = z[*there as usize];
        }
        self.problem.space().restrict(&here)
    }

    /// The exact layout nearest to one of the all-seam cut, in the Jacobians (one Poisson solve).
    ///
    /// # Errors
    /// When the system cannot be factored.
    pub fn project(
        &mut self,
        mesh: &TriMesh,
        all_seams: &Cut,
        z: &[Complex64],
    ) -> Result<Vec<f64>, NotPositiveDefinite> {
        let targets = self.jacobians(mesh, |h| z[all_seams.wedge[h] as usize]);
        Ok(Poisson::new(&mut self.problem)?.solve(&targets))
    }

    /// The exact layout nearest to one given by the corners of its faces, in the gauge of the all-seam cut.
    ///
    /// # Errors
    /// When the system cannot be factored.
    pub(crate) fn nearest(
        &mut self,
        mesh: &TriMesh,
        corner: &HalfedgeData<Complex64>,
    ) -> Result<Vec<f64>, NotPositiveDefinite> {
        let targets = self.jacobians(mesh, |h| corner[h]);
        Ok(Poisson::new(&mut self.problem)?.solve(&targets))
    }

    /// Corners of the faces of a layout, in the gauge of the all-seam cut.
    pub(crate) fn corners(&self, mesh: &TriMesh, y: &[f64]) -> HalfedgeData<Complex64> {
        let z = self.expand(y);
        let corner = |h: Halfedge| turn(z[self.cut.wedge[h] as usize], -self.gauge[h.face()]);
        mesh.halfedges().map(corner).collect()
    }

    /// As-rigid-as-possible layout that starts from frames in the gauge of the all-seam cut.
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn arap(
        &mut self,
        frames: &[Complex64],
        iterations: usize,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Vec<f64>, SolveError> {
        let turned = in_gauge(frames, &self.gauge);
        Ok(Poisson::new(&mut self.problem)?.arap(turned, iterations, watch)?)
    }

    /// The layout that follows given frames as well as the space allows: one linear system.
    ///
    /// # Errors
    /// When it cannot be factored.
    pub fn poisson(&mut self, frames: &[Complex64]) -> Result<Vec<f64>, NotPositiveDefinite> {
        let turned = in_gauge(frames, &self.gauge);
        Ok(Poisson::new(&mut self.problem)?.follow_frames(&turned))
    }

    /// Images of the axes under a map given by its corners, turned into this gauge.
    fn jacobians(
        &self,
        mesh: &TriMesh,
        corner: impl Fn(Halfedge) -> Complex64,
    ) -> Vec<[Complex64; 2]> {
        mesh.faces()
            .zip(self.problem.triangles())
            .map(|(f, t)| t.axes(f.halfedges().map(|h| turn(corner(h), self.gauge[f]))))
            .collect()
    }

    /// Rotations of the triangles of a layout, in the gauge of the all-seam cut.
    pub fn frames(&self, y: &[f64]) -> Vec<Complex64> {
        let here = frames(self.problem.triangles(), &self.expand(y));
        here.into_iter().zip(self.gauge.iter()).map(|(r, &k)| turn(r, -k)).collect()
    }

    /// Minimises an energy; the start must be free of flips.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn minimize(
        &mut self,
        y: Vec<f64>,
        energy: &impl Energy,
        options: &NewtonOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<NewtonSolution, Cancelled> {
        minimize(&mut self.problem, y, energy, options, watch)
    }

    /// Replaces the metric, keeping cut and space.
    pub fn set_metric(&mut self, mesh: &TriMesh, metric: &Metric) {
        self.problem.set_metric(mesh, metric, &self.cut);
    }

    /// Scales the unknowns to the best global scale of the symmetric Dirichlet energy.
    pub fn rescale(&self, y: &mut [f64]) {
        let scale = self.figures(y).scale;
        y.iter_mut().for_each(|x| *x *= scale);
    }

    /// Mean symmetric Dirichlet energy at its best scale, and tau.
    pub fn figures(&self, y: &[f64]) -> Figures {
        Figures::of_layout(self.problem.triangles(), &self.expand(y))
    }

    /// Singular values of the triangles.
    pub fn singular_values(&self, y: &[f64]) -> SingularValues {
        SingularValues::of_layout(self.problem.triangles(), &self.expand(y))
    }

    /// Lists flips and wrong angles.
    pub fn defects(&self, sectors: &Sectors<'_>, y: &[f64]) -> Defects {
        let z = self.expand(y);
        let slit = sectors.slit();
        let flipped =
            |f: &Face| !is_positive(self.problem.triangles()[f.at()].wedges.map(|w| z[w as usize]));
        let sums = angle_sums(slit, self.problem.triangles(), &z);
        let wrong = slit.vertices().filter(|&s| {
            let expected = sectors.quarters(s, f64::from(self.index[s])) * FRAC_PI_2;
            // A wrong angle is off by a quarter turn at least.
            !sectors.is_free(s) && !within((sums[s] - expected).abs(), 0.1)
        });
        let mut wrong_angles: Vec<Vertex> = wrong.map(|s| sectors.vertex(s)).collect();
        wrong_angles.sort_unstable();
        wrong_angles.dedup();
        Defects { flips: slit.faces().filter(flipped).collect(), wrong_angles }
    }
}

/// The order of the nodes of a space that follows from that of the vertices: a node lies at every vertex at one of whose
/// wedges its unknowns count.
fn node_order(sectors: &Sectors<'_>, cut: &Cut, space: &LinearSpace) -> Vec<u32> {
    let (mesh, nodes) = (sectors.mesh(), space.nodes());
    let n_nodes = nodes.last().map_or(0, |&last| last as usize + 1);
    let lies = mesh.halfedges().flat_map(|h| {
        let row = 2 * cut.wedge[h] as usize;
        let columns = [row, row + 1].into_iter().flat_map(|row| space.row(row).0);
        columns.map(move |&unknown| (nodes[unknown as usize], mesh.origin(h).0))
    });
    sectors.dissection().induced(n_nodes, lies)
}

/// Sum of the layout's corner angles around each vertex of a mesh or sector of a slit one, radians; a flipped corner counts negative.
pub fn angle_sums(mesh: &TriMesh, triangles: &[Triangle], z: &[Complex64]) -> VertexData<f64> {
    let mut sums = VertexData::filled(mesh.n_vertices(), 0.0);
    for (f, t) in mesh.faces().zip(triangles) {
        let p = t.wedges.map(|w| z[w as usize]);
        for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
            let w = (p[(k + 1) % 3] - p[k]).conj() * (p[(k + 2) % 3] - p[k]);
            sums[v] += w.im.atan2(w.re);
        }
    }
    sums
}
