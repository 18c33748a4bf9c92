//! A seamless map of one connected mesh, read as a layout in the exact space.

use crate::energy::{couple, schur_complement};
use crate::error::QuantizationFailure;
use crate::gauss::{Gauss, Overflow};
use crate::isolines::turning_points;
use crate::linear::Dense;
use crate::path::SHIFT;
use crate::rounding::ReducedEnergy;
use crate::scene::Scene;
use crate::snap::snap;
use crate::space::{GridNeeds, IntegerSpace};
use num_complex::Complex64;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use seamstress_parallel::prelude::*;
use seamstress_parametrize::cut::Cut;
use seamstress_parametrize::energy::{SymmetricDirichlet, Triangle, keep_directions, triangles};
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::map::SeamlessMap;
use seamstress_parametrize::progress::Watch;

/// The area does not depend on free unknowns if its derivatives by them are below this part of the others: rounding.
const FREE_OF_AREA: f64 = 1e-9;

/// A seamless map in the exact space of integer-grid maps, its coordinates not integral as yet.
pub(crate) struct SeamlessLayout<'a> {
    pub(crate) mesh: &'a TriMesh,
    /// The ends of the aligned edges.
    pub(crate) aligned: Vec<[u32; 2]>,
    /// The triangles over the space, prepared for solves.
    pub(crate) problem: LayoutProblem,
    pub(crate) space: IntegerSpace,
    /// The unknowns, in mean edge lengths.
    pub(crate) y: Vec<f64>,
    /// The integral coordinates.
    pub(crate) coordinates: Vec<f64>,
    /// Mesh length of a mean edge.
    pub(crate) unit: f64,
    cut: Cut,
    matching: HalfedgeData<i32>,
    needs: GridNeeds,
}

/// How much directions count here against what they count in a map: with all of it, whole numbers leave less room between
/// features.
const DIRECTIONS: f64 = 0.25;

impl<'a> SeamlessLayout<'a> {
    /// Reads a seamless map of a connected mesh with its aligned edges; its directions count by `alignment`.
    ///
    /// # Errors
    /// [`QuantizationFailure::Unreadable`] if the map flips when its seams are closed exactly, and where the observer
    /// breaks.
    pub(crate) fn new(
        mesh: &'a TriMesh,
        metric: &Metric,
        map: &SeamlessMap,
        aligned: &EdgeSet,
        alignment: f64,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Self, QuantizationFailure> {
        let (layout, mut y) = ExactLayout::from_map(mesh, metric, map)?;
        watch.pulse()?;
        layout.rescale(&mut y);
        let z = layout.expand(&y);
        let ExactLayout { cut, matching, index, .. } = layout;
        let needs = grid_needs(mesh, &index, aligned, |h| z[cut.wedge[h] as usize]);
        let space = IntegerSpace::new(mesh, &cut, &matching, &needs)?;
        let (coordinates, y) = space.read(&z);
        watch.pulse()?;
        let mut triangles = triangles(mesh, metric, &cut);
        keep_directions(&mut triangles, &z, DIRECTIONS * alignment);
        let problem = LayoutProblem::with_held(space.linear()?, triangles, space.n_free())?;
        let aligned = aligned.vertex_pairs(mesh);
        let unit = metric.unit;
        let this =
            Self { mesh, aligned, problem, space, y, coordinates, unit, cut, matching, needs };
        match this.problem.value(&SymmetricDirichlet, &this.z()).is_finite() {
            true => Ok(this),
            false => Err(QuantizationFailure::Unreadable),
        }
    }

    /// The layout with the size of the map itself, where the metric's is of no use; UVs in mesh units.
    pub(crate) fn with_size_of(mut self, map: &SeamlessMap) -> Self {
        let doubled = |uvs: &[[f64; 2]]| {
            let [a, b, c] = [uvs[0], uvs[1], uvs[2]].map(|[u, v]| Complex64::new(u, v) / self.unit);
            ((b - a).conj() * (c - a)).im
        };
        let area = 0.5 * map.corner_uvs().chunks_exact(3).map(doubled).sum::<f64>();
        self.unit *= area.sqrt() * self.unit / self.side();
        self
    }

    /// Side of a square with the area of the layout, mesh units.
    pub(crate) fn side(&self) -> f64 {
        let z = self.z();
        let doubled = self.problem.triangles().iter().map(|t| t.doubled_area(&z));
        (0.5 * doubled.sum::<f64>()).sqrt() * self.unit
    }

    /// Positions of the wedges.
    pub(crate) fn z(&self) -> Vec<Complex64> {
        self.problem.space().expand(&self.y)
    }

    /// A layout in the same space.
    pub(crate) fn scene<'s>(&'s self, z: &'s [Complex64]) -> Scene<'s> {
        let (mesh, cut, matching) = (self.mesh, &self.cut, &self.matching);
        Scene { mesh, cut, matching, needs: &self.needs, space: &self.space, z }
    }

    /// The symmetric Dirichlet energy around the layout as a function of the coordinates, perhaps with what it costs to miss
    /// the area.
    ///
    /// # Errors
    /// When a linear system cannot be solved, and where the observer breaks.
    pub(crate) fn reduced_energy(
        &mut self,
        keeps_area: bool,
        watch: &mut Watch<'_, '_>,
    ) -> Result<ReducedEnergy, QuantizationFailure> {
        let z = self.z();
        self.problem.linearize(&SymmetricDirichlet, &z);
        self.reduce(keeps_area, watch)
    }

    /// The energy that preserves Jacobians as a function of the coordinates; it stays factored.
    ///
    /// # Errors
    /// When a linear system cannot be solved, and where the observer breaks.
    pub(crate) fn reduced_dirichlet(
        &mut self,
        watch: &mut Watch<'_, '_>,
    ) -> Result<ReducedEnergy, QuantizationFailure> {
        self.problem.assemble_dirichlet();
        self.reduce(false, watch)
    }

    fn reduce(
        &mut self,
        keeps_area: bool,
        watch: &mut Watch<'_, '_>,
    ) -> Result<ReducedEnergy, QuantizationFailure> {
        watch.pulse()?;
        self.problem.factorize(SHIFT)?;
        let matrix = schur_complement(&self.problem, &self.space, watch)?;
        watch.pulse()?;
        let turnable = self.aligned.is_empty().then_some(self.coordinates.as_slice());
        let area = if keeps_area { self.area_form() } else { None };
        Ok(ReducedEnergy::new(&matrix, turnable, area)?)
    }

    /// The matrix G of the area as a function of the coordinates, half of `x' G x`; none if the free unknowns
    /// have a part in it, as where a boundary is not aligned.
    fn area_form(&self) -> Option<Dense> {
        let space = self.problem.space();
        let n_free = self.problem.n_free();
        let pulled = space.pull_back(&area_gradient(self.problem.triangles(), &self.z()));
        let largest = |part: &[f64]| part.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        if largest(&pulled[..n_free]) > FREE_OF_AREA * largest(&pulled[n_free..]) {
            return None;
        }
        // The others have wedges that the integral coordinates do not move.
        let moves = |w: u32| {
            let rows = [2 * w as usize, 2 * w as usize + 1];
            rows.iter().any(|&row| space.row(row).0.iter().any(|&k| k as usize >= n_free))
        };
        let triangles = self.problem.triangles().iter();
        let triangles: Vec<Triangle> =
            triangles.filter(|t| t.wedges.iter().any(|&w| moves(w))).copied().collect();
        let order = self.space.n_coordinates();
        let column = |k: usize| {
            let mut coordinates = vec![0.0; order];
            coordinates[k] = 1.0;
            let mut y = vec![0.0; n_free];
            y.extend(self.space.expand_real(&coordinates));
            let pulled = space.pull_back(&area_gradient(&triangles, &space.expand(&y)));
            let mut column = vec![0.0; order];
            for (row, x) in self.space.held().iter().zip(&pulled[n_free..]) {
                row.iter().for_each(|&(i, c)| column[i] += c as f64 * x);
            }
            column
        };
        let columns: Vec<Vec<f64>> = (0..order).into_par_iter().map(column).collect();
        Some(Dense { order, values: columns.concat() })
    }

    /// Where the free unknowns go when the held ones move to a target and the last factored energy, a
    /// quadratic one, is minimised.
    pub(crate) fn follow(&mut self, target: &[f64]) -> Vec<f64> {
        let held = self.problem.n_free();
        let way: Vec<f64> = target.iter().zip(&self.y[held..]).map(|(t, y)| t - y).collect();
        let mut step = couple(&self.problem, &way);
        step.resize(self.y.len(), 0.0);
        self.problem.solve(&mut step);
        let mut y: Vec<f64> = self.y.iter().zip(&step).map(|(y, s)| y - s).collect();
        y[held..].copy_from_slice(target);
        y
    }

    /// Exact corner UVs in grid units, for held unknowns that are integers and cells of size `h` in the layout's
    /// units, their box beginning at a column and at row 0; and its width.
    ///
    /// # Errors
    /// [`Overflow`].
    pub(crate) fn corner_uvs(
        &self,
        held: &[i64],
        y: &[f64],
        h: f64,
        column: i64,
    ) -> Result<(Vec<[f64; 2]>, i64), Overflow> {
        let free: Vec<f64> = y[..self.problem.n_free()].iter().map(|x| x / h).collect();
        let z = self.problem.space().expand(y);
        let bound = |start: f64, pick: fn(f64, f64) -> f64, part: fn(&Complex64) -> f64| {
            z.iter().map(part).fold(start, pick) / h
        };
        let (re, im) = (|z: &Complex64| z.re, |z: &Complex64| z.im);
        let [left, bottom] =
            [re, im].map(|part| bound(f64::INFINITY, f64::min, part).floor() as i64);
        let right = bound(f64::NEG_INFINITY, f64::max, re).ceil() as i64;
        let shift = Gauss { re: column, im: 0 }.plus(Gauss { re: left, im: bottom }.negated())?;
        let z = snap(&self.space, held, &free, shift)?;
        let uv = |&w: &u32| [z[w as usize].re, z[w as usize].im];
        Ok((self.cut.wedge.iter().map(uv).collect(), right - left))
    }
}

/// The area's derivatives by the positions of wedges.
fn area_gradient(triangles: &[Triangle], z: &[Complex64]) -> Vec<Complex64> {
    let mut gradient = vec![Complex64::ZERO; z.len()];
    for triangle in triangles {
        let wedges = triangle.wedges.map(|w| w as usize);
        for k in 0..3 {
            let opposite = z[wedges[(k + 2) % 3]] - z[wedges[(k + 1) % 3]];
            gradient[wedges[k]] += 0.5 * Complex64::i() * opposite;
        }
    }
    gradient
}

/// What has to come to lie on the grid: cones, and with aligned edges their corners and isolines.
///
/// There is always a grid point where translations are free, so that lines that close up, around a torus or between
/// two boundaries, begin and end at one.
fn grid_needs(
    mesh: &TriMesh,
    index: &VertexData<i32>,
    aligned: &EdgeSet,
    position: impl Fn(Halfedge) -> Complex64,
) -> GridNeeds {
    let mut needs = GridNeeds::cones(index.iter().map(|&k| k != 0).collect());
    let turns = turning_points(mesh, aligned, &position);
    mesh.vertices().filter(|&v| turns[v]).for_each(|v| needs.is_point[v] = true);
    if !needs.is_point.iter().any(|&is_point| is_point) {
        let on_isoline = aligned.edges().first().map(|&h| mesh.origin(h));
        let anywhere = (!mesh.has_boundary()).then_some(Vertex(0));
        on_isoline.or(anywhere).into_iter().for_each(|v| needs.is_point[v] = true);
    }
    let sides = mesh.halfedges().filter(|&h| aligned.contains(h));
    needs.levels = sides
        .map(|h| {
            let way = position(h.next()) - position(h);
            (h, u32::from(way.re.abs() > way.im.abs()))
        })
        .collect();
    needs
}
