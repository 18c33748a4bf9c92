//! From a seamless map to an integer map: the grid, and all components on it.

use super::certificate::IntegerMap;
use super::component::{IntegerProblem, Placed};
use super::outcome::{IntegerFailure, IntegerStats};
use super::{GridSize, IntegerOptions};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Face, Metric, TriMesh, components};
use seamstress_parametrize::map::{Alignment, AlignmentTolerance, SeamlessMap, Violations};
use seamstress_parametrize::progress::{Cancelled, Observer, Stage, Watch};
use seamstress_parametrize::quality::{Distortion, distortion};

/// The number of quads asked for is met when it is this close.
const CLOSE_ENOUGH: f64 = 0.02;
/// Cell sizes tried to meet it.
const MOST_SIZES: usize = 4;
/// A number further off is worth up to as many sizes again, while they get better.
const FAR_OFF: f64 = 0.05;
/// Most that a cell is lengthened by at once. Where cones are dense, their number sets the least number of quads,
/// whatever is asked for.
const LARGEST_CHANGE: f64 = 1.2;

/// Slack of the triangle inequality, in mean edge lengths, of the metric for meshes with triangles that have no area:
/// most triangles become nearly regular.
const SLACK: f64 = 0.3;

/// A certified integer map and how it was made.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct IntegerSolution {
    /// The map; UVs in grid units.
    pub map: IntegerMap,
    /// Its distortion, against the mesh.
    pub distortion: Distortion,
    /// Distortion of the seamless map it comes from.
    pub before: Distortion,
    /// Cell size, mesh units, before any component needed a finer one.
    pub cell: f64,
    /// Cell sizes tried to meet a number of quads.
    pub sizes_tried: usize,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<IntegerStats>,
}

impl IntegerSolution {
    /// Area in the plane, grid units: the number of quads, exactly, unless a boundary cuts cells.
    pub fn quads(&self) -> f64 {
        self.map.certificate().area
    }

    /// Finer grids that were needed, over all components.
    pub fn refinements(&self) -> usize {
        self.components.iter().map(|c| c.refinements).sum()
    }
}

/// Why there is no integer map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IntegerError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The size of the grid is not a positive number.
    #[error("the size of the grid is not a positive number")]
    BadSize,
    /// Positions or UVs do not fit the mesh.
    #[error(
        "{positions} positions and {corners} corners of UVs for a mesh of {vertices} vertices and {faces} faces"
    )]
    Mismatch {
        /// Positions given.
        positions: usize,
        /// UVs given.
        corners: usize,
        /// Vertices of the mesh.
        vertices: usize,
        /// Faces of the mesh.
        faces: usize,
    },
    /// A component has no integer map on this grid, nor on finer ones.
    #[error("component {component} (with face {face}): {cause}")]
    Component {
        /// The component, in order of first faces.
        component: usize,
        /// Its first face.
        face: u32,
        /// What failed.
        #[source]
        cause: IntegerFailure,
    },
    /// The edges given are not aligned in the map.
    #[error("the map is not aligned: {0}")]
    Misaligned(#[source] Violations),
    /// The result did not pass the certificate. Nothing is returned then.
    #[error("the integer map failed its certificate: {0}")]
    Uncertified(#[from] Violations),
}

/// Makes an integer map that is close to a seamless map.
///
/// Positions are in any unit. Where cones are too close for the grid, a component gets a finer one; the
/// solution says so. A number of quads is met within a few percent if no component needed that.
/// The observer is called in every iteration of every long loop and may break to cancel.
///
/// # Errors
/// [`IntegerError`]; never an uncertified map.
///
/// # Source
/// Levi 2021, supplement, section 8, for what must be integral and for [`super::IntegerRounding::Greedy`];
/// the constrained rounding is that of `docs/theory/08-integer-grid-maps.md`.
pub fn to_integer_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    map: &SeamlessMap,
    options: &IntegerOptions,
    observer: &mut Observer<'_>,
) -> Result<IntegerSolution, IntegerError> {
    to_aligned_integer_map(mesh, positions, map, &EdgeSet::new(mesh, []), options, observer)
}

/// Makes an integer map that is close to a seamless map whose aligned edges it takes to isolines at
/// integers, so that the quads of its grid follow them.
///
/// Otherwise as [`to_integer_map`].
///
/// # Errors
/// [`IntegerError`], also when an edge is not aligned in the map; never an uncertified map.
pub fn to_aligned_integer_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    map: &SeamlessMap,
    aligned: &EdgeSet,
    options: &IntegerOptions,
    observer: &mut Observer<'_>,
) -> Result<IntegerSolution, IntegerError> {
    let (corners, vertices, faces) = (map.corner_uvs().len(), mesh.n_vertices(), mesh.n_faces());
    if positions.len() != vertices || corners != 3 * faces {
        let positions = positions.len();
        return Err(IntegerError::Mismatch { positions, corners, vertices, faces });
    }
    let size = options.size.value();
    if !(size.is_finite() && size > 0.0) {
        return Err(IntegerError::BadSize);
    }
    let pairs = aligned.vertex_pairs(mesh);
    Alignment::certify(mesh, map, &pairs, &AlignmentTolerance::default())
        .map_err(IntegerError::Misaligned)?;
    let pieces = components::components(mesh).unwrap_or_default();
    let mut run = Run { pieces: &pieces, problems: Vec::new(), observer };
    for k in 0..pieces.len() {
        run.prepare(k, positions, map, aligned, options)?;
    }
    let (cell, placed, sizes_tried) = run.solve(options.size)?;
    let mut corner_uvs = vec![[0.0; 2]; mesh.n_halfedges()];
    let mut stats = Vec::with_capacity(pieces.len());
    for (piece, placed) in pieces.iter().zip(placed) {
        for (corners, &Face(f)) in placed.corner_uvs.chunks_exact(3).zip(&piece.faces) {
            corner_uvs[3 * f as usize..3 * f as usize + 3].copy_from_slice(corners);
        }
        stats.push(placed.stats);
    }
    let metric = Metric::from_positions(mesh, positions);
    let before = distortion(mesh, &metric, map.corner_uvs());
    let after = distortion(mesh, &metric, &corner_uvs);
    let map = IntegerMap::certify_aligned(mesh, corner_uvs, &pairs, &options.tolerance)?;
    Ok(IntegerSolution { map, distortion: after, before, cell, sizes_tried, components: stats })
}

struct Run<'p, 'a, 'b> {
    pieces: &'p [Component],
    problems: Vec<IntegerProblem<'p>>,
    observer: &'a mut Observer<'b>,
}

impl<'p> Run<'p, '_, '_> {
    fn error(&self, k: usize, cause: IntegerFailure) -> IntegerError {
        match cause {
            IntegerFailure::Cancelled(cancelled) => IntegerError::Cancelled(cancelled),
            IntegerFailure::Uncertified(violations) => {
                IntegerError::Uncertified(violations.in_whole(&self.pieces[k]))
            }
            cause => {
                IntegerError::Component { component: k, face: self.pieces[k].faces[0].0, cause }
            }
        }
    }

    fn prepare(
        &mut self,
        k: usize,
        positions: &[[f64; 3]],
        map: &SeamlessMap,
        aligned: &EdgeSet,
        options: &'p IntegerOptions,
    ) -> Result<(), IntegerError> {
        Watch::new(self.observer, k, self.pieces.len()).enter(Stage::Integers)?;
        let piece = &self.pieces[k];
        let positions: Vec<_> = piece.vertices.iter().map(|v| positions[v.at()]).collect();
        let metric = Metric::from_positions(&piece.mesh, &positions);
        let uvs = piece.faces.iter().flat_map(|f| f.halfedges().map(|h| map.corner_uvs()[h.at()]));
        let aligned = aligned.restrict(piece);
        let map = SeamlessMap::certify(&piece.mesh, uvs.collect(), &options.tolerance)
            .map_err(|cause| self.error(k, cause.into()))?;
        let read =
            |metric: &Metric| IntegerProblem::new(&piece.mesh, metric, &map, &aligned, options);
        let problem = match read(&metric) {
            // Triangles too thin for arithmetic open up where every edge is longer.
            Err(IntegerFailure::Unreadable) => {
                let by = metric.lengthening(&piece.mesh, SLACK);
                let metric = metric.lengthened(&piece.mesh, by);
                read(&metric).map(|problem| problem.with_size_of(&map))
            }
            problem => problem,
        };
        self.problems.push(problem.map_err(|cause| self.error(k, cause))?);
        Ok(())
    }

    /// Meets the size asked for; the cell size, the components and the number of cell sizes tried.
    fn solve(&mut self, size: GridSize) -> Result<(f64, Vec<Placed>, usize), IntegerError> {
        let side = self.problems.iter().map(IntegerProblem::side).fold(0.0, f64::hypot);
        let mut cell = size.cell(side);
        let GridSize::Quads(quads) = size else {
            return Ok((cell, self.place_all(cell, true)?, 1));
        };
        let mut best: Option<(f64, f64, Vec<Placed>)> = None;
        let mut tried = 0;
        // Whether the last size was the best so far, and still far off.
        let mut is_promising = false;
        while tried < MOST_SIZES || (tried < 2 * MOST_SIZES && is_promising) {
            tried += 1;
            let placed = match (self.place_all(cell, best.is_none()), &best) {
                // Where there is nothing, go only half as far.
                (Err(IntegerError::Component { .. }), Some(best)) => {
                    cell = (best.1 * cell).sqrt();
                    is_promising = false;
                    continue;
                }
                (placed, _) => placed?,
            };
            let ratio = placed.iter().map(|p| p.stats.quads).sum::<f64>() / quads;
            let off = (ratio - 1.0).abs();
            let is_refined = placed.iter().any(|p| p.stats.refinements > 0);
            is_promising = off > FAR_OFF && best.as_ref().is_some_and(|b| off < b.0);
            if best.as_ref().is_none_or(|b| off < b.0) {
                best = Some((off, cell, placed));
            }
            if off < CLOSE_ENOUGH || is_refined {
                break;
            }
            cell *= ratio.sqrt().clamp(1.0 / LARGEST_CHANGE, LARGEST_CHANGE);
        }
        let (_, cell, placed) = best.ok_or(IntegerError::BadSize)?;
        Ok((cell, placed, tried))
    }

    /// All components on one grid, side by side, each on a finer one if that is allowed and needed.
    fn place_all(&mut self, cell: f64, may_be_finer: bool) -> Result<Vec<Placed>, IntegerError> {
        let mut column = 0;
        let mut all = Vec::with_capacity(self.pieces.len());
        for k in 0..self.pieces.len() {
            let mut watch = Watch::new(self.observer, k, self.pieces.len());
            watch.enter(Stage::Integers)?;
            let placed = self.problems[k].solve(cell, may_be_finer, column, &mut watch);
            let placed = placed.map_err(|cause| self.error(k, cause))?;
            // One empty column between components.
            column += placed.columns + 1;
            all.push(placed);
        }
        Ok(all)
    }
}
