//! Quads from an integer map, exactly.
//!
//! The grid of the plane, pulled back to the surface, cuts it into quads. All decisions are made in
//! integer arithmetic: the map is put into fixed point ([`Snapping`] says how little that changes),
//! every face is cut into its pieces of cells, and the pieces of one cell are glued across the
//! edges of the mesh. A quad is what comes together; its corners are the grid points found on it.
//! No line is traced, so that none can miss its end.

mod assemble;
mod error;
mod features;
mod fixed;
mod patches;
mod pieces;
mod points;
mod snap;
mod sweep;
mod winding;

pub use crate::surface_point::SurfacePoint;
pub use error::{ExtractError, MapFault, MapFaults};
pub use snap::Snapping;

use crate::QuadMesh;
use crate::pinches::split_pinches;
use assemble::{Quads, assemble};
use fixed::Point;
use patches::Patches;
use pieces::Pieces;
use points::{GridPoints, Site};
use seamstress_mesh::{Face, Halfedge, TriMesh};
use seamstress_parametrize::progress::{Observer, Stage, Watch};
use snap::{GridMap, snap};

/// How to extract.
#[derive(Debug, Clone, PartialEq)]
pub struct ExtractOptions {
    /// How far translations and cones may be from integers and seams from closing, grid units.
    /// Maps written with few digits are off by `1e-6` or so; a map that is not integral, by anything.
    pub tolerance: f64,
    /// Extract what can be extracted from a map that folds, instead of refusing it.
    pub best_effort: bool,
}

impl Default for ExtractOptions {
    fn default() -> Self {
        Self { tolerance: 1e-3, best_effort: false }
    }
}

/// A quad mesh and where it comes from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Extraction {
    /// The quads, counter-clockwise as the faces of the source.
    pub mesh: QuadMesh,
    /// Where each vertex of the quad mesh lies on the source.
    pub sources: Vec<SurfacePoint>,
    /// The map's cones that are vertices of the quad mesh, ascending.
    pub cones: Vec<QuadCone>,
    /// How far the map was from exactness.
    pub snapping: Snapping,
    /// Edges of the source that lie on lines of the grid on either side, by their ends: chains of edges of quads
    /// run along them. Features that are not among them are not followed.
    pub edges_on_grid_lines: Vec<[u32; 2]>,
    /// Area of the map in grid units: as many quads are expected of a closed surface.
    pub uv_area: f64,
    /// Cells that the boundary cuts; they give no quad.
    pub trimmed: usize,
    /// Copies made of vertices at which quads met in a point only, after cells had been left out.
    pub split_vertices: usize,
    /// What became of the folds; nothing for a map without.
    pub folds: Option<Folds>,
}

/// A cone of the map in the quad mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadCone {
    /// The vertex of the quad mesh.
    pub vertex: u32,
    /// The vertex of the source; none where quads were made on a finer mesh of it, with a cone at a point added.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<u32>,
    /// Its index in quarters: an interior vertex has 4 less this many quads.
    pub index: i32,
}

/// What was found and done where a map folds.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Folds {
    /// Faces of negative orientation.
    pub flipped: Vec<u32>,
    /// Faces without area.
    pub collapsed: Vec<u32>,
    /// Cells without a quad because folds cover them a wrong number of times, or collapse them.
    pub lost: usize,
    /// Grid points that were merged with another because folds cover them several times.
    pub merged: usize,
}

/// Extracts the quads of an integer map.
///
/// `corner_uvs` are in grid units, three per face in the order of its vertices; across an interior edge
/// they may jump by a quarter turn and an integer translation, cones are at grid points. For a closed
/// surface without folds the quads are an oriented manifold of the same topology, as many as the
/// map's area, and their irregular vertices are the cones. At a boundary that follows isolines there
/// are quads up to it; elsewhere the cells it cuts are left out and counted.
///
/// # Errors
/// Maps that are not integral to within the tolerance, and maps that fold unless
/// [`ExtractOptions::best_effort`]; see [`ExtractError`]. It stops where the observer breaks.
///
/// # Source
/// The problem is that of Ebke, Bommes, Campen and Kobbelt 2013, *QEx*; the method is another.
pub fn extract(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    corner_uvs: &[[f64; 2]],
    options: &ExtractOptions,
    observer: &mut Observer<'_>,
) -> Result<Extraction, ExtractError> {
    let mut watch = Watch::new(observer, 0, 1);
    watch.enter(Stage::Extraction)?;
    let (expected, found) = (mesh.n_vertices(), positions.len());
    if expected != found {
        return Err(ExtractError::WrongCount { what: "positions", expected, found });
    }
    let map = snap(mesh, corner_uvs, options.tolerance)?;
    let (flipped, collapsed) = folds(mesh, &map);
    let has_folds = !(flipped.is_empty() && collapsed.is_empty());
    if has_folds && !options.best_effort {
        return Err(ExtractError::Folds { flipped, collapsed });
    }
    watch.tick(0.2)?;
    let pieces = Pieces::new(mesh, &map)?;
    watch.tick(0.4)?;
    let points = GridPoints::new(mesh, &map);
    watch.tick(0.6)?;
    let patches = Patches::new(mesh, &map, &pieces);
    watch.tick(0.8)?;
    let quads = assemble(mesh, &map, &pieces, &points, &patches, has_folds);
    watch.tick(1.0)?;
    if quads.quads.is_empty() {
        return Err(ExtractError::NoQuads { partial: quads.trimmed });
    }
    let folds =
        has_folds.then_some(Folds { flipped, collapsed, lost: quads.lost, merged: quads.merged });
    Ok(build(&Source { mesh, positions, map: &map, points: &points }, &quads, folds))
}

fn folds(mesh: &TriMesh, map: &GridMap) -> (Vec<u32>, Vec<u32>) {
    let (mut flipped, mut collapsed) = (Vec::new(), Vec::new());
    for face in mesh.faces() {
        let [a, b, c] = map.triangle(face);
        match Point::orientation(a, b, c).signum() {
            -1 => flipped.push(face.0),
            0 => collapsed.push(face.0),
            _ => {}
        }
    }
    (flipped, collapsed)
}

/// What vertices are made from.
struct Source<'a> {
    mesh: &'a TriMesh,
    positions: &'a [[f64; 3]],
    map: &'a GridMap,
    points: &'a GridPoints,
}

impl Source<'_> {
    fn position(&self, at: &SurfacePoint) -> [f64; 3] {
        let mut position = [0.0; 3];
        let corners = self.mesh.face_vertices(Face(at.face));
        for (vertex, weight) in corners.into_iter().zip(at.barycentric) {
            let corner = self.positions[vertex.at()];
            // A weight of zero keeps even a huge coordinate out.
            for k in (0..3).filter(|_| weight != 0.0) {
                position[k] += weight * corner[k];
            }
        }
        position
    }
}

fn build(source: &Source<'_>, quads: &Quads, folds: Option<Folds>) -> Extraction {
    let (used, mut faces) = compact(&quads.quads, source.points.sites.len());
    let (mut numbers, mut split_vertices) = (used, 0);
    if quads.trimmed > 0 || quads.lost > 0 {
        let copied = split_pinches(numbers.len(), &mut faces);
        split_vertices = copied.len();
        numbers.extend(copied.into_iter().map(|v| numbers[v as usize]).collect::<Vec<_>>());
    }
    let sources: Vec<SurfacePoint> =
        numbers.iter().map(|&n| source.points.locate(source.mesh, source.map, n)).collect();
    let positions = sources.iter().map(|at| source.position(at)).collect();
    Extraction {
        mesh: QuadMesh::from_parts(positions, faces),
        sources,
        cones: cones(source, &numbers),
        snapping: source.map.snapping,
        edges_on_grid_lines: edges_on_grid_lines(source.mesh, source.map),
        uv_area: uv_area(source.mesh, source.map),
        trimmed: quads.trimmed,
        split_vertices,
        folds,
    }
}

/// Numbers the points that are used, in their order.
fn compact(quads: &[[u32; 4]], n_points: usize) -> (Vec<u32>, Vec<[u32; 4]>) {
    let mut is_used = vec![false; n_points];
    quads.iter().flatten().for_each(|&number| is_used[number as usize] = true);
    let used: Vec<u32> = (0..n_points as u32).filter(|&n| is_used[n as usize]).collect();
    let mut vertex = vec![0; n_points];
    used.iter().enumerate().for_each(|(v, &number)| vertex[number as usize] = v as u32);
    let faces = quads.iter().map(|quad| quad.map(|number| vertex[number as usize])).collect();
    (used, faces)
}

fn cones(source: &Source<'_>, numbers: &[u32]) -> Vec<QuadCone> {
    let cone = |(vertex, &number): (usize, &u32)| match source.points.sites[number as usize] {
        Site::Vertex(v) if source.map.indices[v] != 0 => Some(QuadCone {
            vertex: vertex as u32,
            source: Some(v.0),
            index: source.map.indices[v],
        }),
        _ => None,
    };
    numbers.iter().enumerate().filter_map(cone).collect()
}

fn edges_on_grid_lines(mesh: &TriMesh, map: &GridMap) -> Vec<[u32; 2]> {
    let is_on_line = |h: Halfedge| {
        let [a, b] = map.ends(h);
        map.unit.is_on_line(a, b)
    };
    let edges = mesh.edges().filter(|&h| is_on_line(h) && mesh.twin(h).is_none_or(is_on_line));
    edges.map(|h| [mesh.origin(h).0, mesh.tip(h).0]).collect()
}

fn uv_area(mesh: &TriMesh, map: &GridMap) -> f64 {
    let one = map.unit.one() as f64;
    let twice = mesh.faces().map(|face| {
        let [a, b, c] = map.triangle(face);
        Point::orientation(a, b, c)
    });
    // Exact: the area is at most the number of pieces, which is limited.
    twice.fold(0i128, i128::saturating_add) as f64 / (2.0 * one * one)
}
