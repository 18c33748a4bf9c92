//! From a seamless map to an integer-grid map: the grid, and all components on it.

use crate::certificate::IntegerGridMap;
use crate::error::{QuantizationFailure, QuantizeError};
use crate::options::{GridSize, QuantizeOptions};
use crate::search::{ComponentSearch, Decisions, Placement};
use crate::stats::QuantizationStats;
use seamstress_mesh::components::{self, FailedComponent};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Face, Geometry, TriMesh};
use seamstress_parametrize::map::{SeamlessMap, Tolerance};
use seamstress_parametrize::progress::{Observer, Stage, Watch};
use seamstress_parametrize::quality::{Distortion, distortion};

/// The number of quads asked for is met when it is this close.
const CLOSE_ENOUGH: f64 = 0.04;
/// Cell sizes tried to meet it.
const MOST_SIZES: usize = 4;
/// A number further off is worth up to as many sizes again, while they get better.
const FAR_OFF: f64 = 0.05;
/// Where a number is further off, a caller may want another map.
const TOO_FAR_OFF: f64 = 0.1;
/// So many times the cells asked for are no matter of their size if they do not follow it by this power of their area: the
/// caller is asked before more sizes are tried.
const FAR_TOO_MANY: f64 = 1.5;
const FOLLOWING: f64 = 0.5;
/// Cells of a size that is no better are followed by ones on the other side of the best, nearer by this power.
const NEARER: f64 = 0.7;
/// Most that a cell is lengthened or shortened by at once: where cones are dense, the count hardly follows the size.
const LARGEST_CHANGE: f64 = 1.2;

/// A certified integer-grid map and how it was made.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Quantization {
    /// The map; UVs in grid units.
    pub map: IntegerGridMap,
    /// Its distortion, against the mesh.
    pub distortion: Distortion,
    /// Distortion of the seamless map it comes from.
    pub before: Distortion,
    /// Cell size, mesh units, before any component needed a finer one.
    pub cell: f64,
    /// Cell sizes tried to meet a number of quads.
    pub sizes_tried: usize,
    /// Pairs of vertices with lines between them that are much shorter than a cell, where these are why a number of quads is
    /// missed and the caller would rather have another map.
    pub crowded: Vec<[u32; 2]>,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<QuantizationStats>,
}

impl Quantization {
    /// Area in the plane, grid units: the number of quads of a closed mesh.
    pub fn quads(&self) -> f64 {
        self.map.certificate().area
    }

    /// Finer grids that were needed, over all components.
    pub fn refinements(&self) -> usize {
        self.components.iter().map(|c| c.refinements).sum()
    }
}

/// Makes an integer-grid map that is close to a seamless map and takes its aligned edges to isolines at integers, so
/// that the quads of its grid follow them.
///
/// Positions are in any unit, with or without sizes of cells. Where cones are too close for the grid, a component gets a finer one; the
/// solution says so. A number of quads is met within a few percent if no component needed that.
/// The observer is called in every iteration of every long loop and may break to cancel.
///
/// # Errors
/// [`QuantizeError`], also when an edge is not aligned in the map; never an uncertified map.
///
/// # Source
/// Levi 2021, suppl. sec. 8, for what must be integral and for [`crate::RoundingMethod::Greedy`];
/// the constrained rounding is that of `docs/theory/08-integer-grid-maps.md`.
pub fn quantize<'a>(
    mesh: &TriMesh,
    geometry: impl Into<Geometry<'a>>,
    map: &SeamlessMap,
    aligned: &EdgeSet,
    options: &QuantizeOptions,
    observer: &mut Observer<'_>,
) -> Result<Quantization, QuantizeError> {
    quantize_deciding(mesh, geometry, map, aligned, options, &mut (), observer)
}

/// As [`quantize`], with a caller who accepts maps component by component, and may give up early.
///
/// # Errors
/// As [`quantize`]; [`QuantizationFailure::Refused`] if no map of a component was accepted.
pub fn quantize_deciding<'a>(
    mesh: &TriMesh,
    geometry: impl Into<Geometry<'a>>,
    map: &SeamlessMap,
    aligned: &EdgeSet,
    options: &QuantizeOptions,
    decisions: &mut dyn Decisions,
    observer: &mut Observer<'_>,
) -> Result<Quantization, QuantizeError> {
    let (corners, vertices, faces) = (map.corner_uvs().len(), mesh.n_vertices(), mesh.n_faces());
    let geometry = geometry.into();
    let positions = geometry.positions.len();
    if positions != vertices || corners != 3 * faces {
        return Err(QuantizeError::Mismatch { positions, corners, vertices, faces });
    }
    let size = options.size.value();
    if !(size.is_finite() && size > 0.0) {
        return Err(QuantizeError::BadSize);
    }
    let pairs = aligned.vertex_pairs(mesh);
    map.alignment(mesh, &pairs, &Tolerance::of_seams(options.given.seams))
        .map_err(QuantizeError::Misaligned)?;
    let pieces = components::components(mesh).unwrap_or_default();
    let mut all = Components { pieces: &pieces, searches: Vec::new(), decisions, observer };
    all.read(geometry, map, aligned, options)?;
    let (Sized { cell, placements, tried, .. }, crowded) = all.meet(options)?;
    let mut corner_uvs = vec![[0.0; 2]; mesh.n_halfedges()];
    let mut stats = Vec::with_capacity(pieces.len());
    for ((piece, search), placement) in pieces.iter().zip(&all.searches).zip(placements) {
        for (corners, &Face(f)) in placement.corner_uvs.chunks_exact(3).zip(&piece.faces) {
            corner_uvs[3 * f as usize..3 * f as usize + 3].copy_from_slice(corners);
        }
        stats.push(search.stats(placement));
    }
    let metric = geometry.metric(mesh);
    let before = distortion(mesh, &metric, map.corner_uvs());
    let after = distortion(mesh, &metric, &corner_uvs);
    let map = IntegerGridMap::certify_aligned(mesh, corner_uvs, &pairs, &options.tolerance)?;
    let (distortion, sizes_tried, components) = (after, tried, stats);
    Ok(Quantization { map, distortion, before, cell, sizes_tried, crowded, components })
}

/// All components on cells of one size.
struct Sized {
    cell: f64,
    placements: Vec<Placement>,
    /// How far the number of quads is off, as a share.
    off: f64,
    /// Sizes tried.
    tried: usize,
}

/// All components of a mesh.
struct Components<'p, 'a, 'b> {
    pieces: &'p [Component],
    searches: Vec<ComponentSearch<'p>>,
    decisions: &'a mut dyn Decisions,
    observer: &'a mut Observer<'b>,
}

impl<'p> Components<'p, '_, '_> {
    /// Something of every component, or all that failed.
    fn each<T>(
        &mut self,
        mut make: impl FnMut(&mut Self, usize) -> Result<T, QuantizationFailure>,
    ) -> Result<Vec<T>, QuantizeError> {
        let (mut all, mut failed) = (Vec::with_capacity(self.pieces.len()), Vec::new());
        for k in 0..self.pieces.len() {
            Watch::new(self.observer, k, self.pieces.len()).enter(Stage::Integers)?;
            match make(self, k) {
                Ok(made) => all.push(made),
                Err(QuantizationFailure::Cancelled(cancelled)) => return Err(cancelled.into()),
                Err(cause) => {
                    let face = self.pieces[k].faces[0].0;
                    failed.push(FailedComponent { component: k, face, cause });
                }
            }
        }
        if failed.is_empty() { Ok(all) } else { Err(QuantizeError::Components(failed)) }
    }

    /// Reads all components.
    fn read(
        &mut self,
        geometry: Geometry<'_>,
        map: &SeamlessMap,
        aligned: &EdgeSet,
        options: &'p QuantizeOptions,
    ) -> Result<(), QuantizeError> {
        self.searches = self.each(|all, k| {
            let piece = &all.pieces[k];
            let metric = geometry.of_piece(piece).whole().metric(&piece.mesh);
            let uvs = piece.corner_uvs(map.corner_uvs());
            let map = SeamlessMap::certify(&piece.mesh, uvs, &options.given)?;
            let mut watch = Watch::new(all.observer, k, all.pieces.len());
            watch.enter(Stage::Integers)?;
            let aligned = aligned.restrict(piece);
            ComponentSearch::new(piece, &metric, &map, &aligned, options, &mut watch)
        })?;
        Ok(())
    }

    /// Meets the size asked for: a number of quads by changing the size of the cells by what it is off; where that was
    /// no better, on the other side of the best size, since where cones are dense the number does not always fall when
    /// cells grow. Names the lines for which the caller would rather have another map.
    fn meet(&mut self, options: &QuantizeOptions) -> Result<(Sized, Vec<[u32; 2]>), QuantizeError> {
        let size = options.size;
        let side = self.searches.iter().map(ComponentSearch::side).fold(0.0, f64::hypot);
        let mut cell = size.cell(side);
        let mut best: Option<Sized> = None;
        let (mut crowded, mut last) = (Vec::new(), None);
        for tried in 1..=2 * MOST_SIZES {
            let placements = self.place(cell)?;
            let quads: f64 = placements.iter().map(|p| p.quads).sum();
            let ratio = match size {
                GridSize::Quads(asked) => quads / asked,
                GridSize::EdgeLength(_) | GridSize::Scale(_) => 1.0,
            };
            let off = (ratio - 1.0).abs();
            let is_better = best.as_ref().is_none_or(|best| off < best.off);
            if is_better {
                best = Some(Sized { cell, placements, off, tried });
            }
            let follows = |(larger, before): (f64, f64)| {
                (before / ratio).ln() > FOLLOWING * 2.0 * f64::ln(larger)
            };
            if ratio > FAR_TOO_MANY && !last.is_none_or(follows) {
                crowded = self.crowded(cell);
            }
            if let Some(best) = &mut best {
                best.tried = tried;
                let is_worth_more = tried < MOST_SIZES || (is_better && off > FAR_OFF);
                let is_over =
                    !crowded.is_empty() || self.searches.iter().any(ComponentSearch::is_spent);
                if off < CLOSE_ENOUGH || !is_worth_more || is_over {
                    break;
                }
                let next = match is_better {
                    true => cell * ratio.sqrt().clamp(1.0 / LARGEST_CHANGE, LARGEST_CHANGE),
                    false => best.cell * (best.cell / cell).powf(NEARER),
                };
                last = Some((next / cell, ratio));
                cell = next;
            }
        }
        let best = best.ok_or(QuantizeError::BadSize)?;
        if best.off > TOO_FAR_OFF && crowded.is_empty() {
            crowded = self.crowded(best.cell);
        }
        Ok((best, crowded))
    }

    /// The lines much shorter than a cell of components for which the caller would rather have another map.
    fn crowded(&mut self, cell: f64) -> Vec<[u32; 2]> {
        let mut crowded = Vec::new();
        for search in &mut self.searches {
            if let Some(cause) = search.short_lines(cell)
                && !self.decisions.goes_on(&cause)
                && let QuantizationFailure::TooCoarse { pairs, .. } = cause
            {
                crowded.extend(pairs);
            }
        }
        crowded
    }

    /// All components on cells of one size, side by side.
    fn place(&mut self, cell: f64) -> Result<Vec<Placement>, QuantizeError> {
        let mut column = 0;
        self.each(|all, k| {
            let mut watch = Watch::new(all.observer, k, all.pieces.len());
            let placement = all.searches[k].place(cell, column, all.decisions, &mut watch)?;
            // One empty column between components.
            column += placement.columns + 1;
            Ok(placement)
        })
    }
}
