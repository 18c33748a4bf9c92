//! From numbers that are nearly an integer map to an exact one.

use super::error::{ExtractError, MapFault, MapFaults};
use super::fixed::{LARGEST_COORDINATE, Point, Transition, Unit, turned};
use seamstress_mesh::{Complex64, Halfedge, HalfedgeData, TriMesh, Vertex, VertexData};
use seamstress_parallel::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// How far the numbers were from exactness, and what was done about it. Grid units.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Snapping {
    /// Largest mismatch of the two images of an edge.
    pub gap: f64,
    /// Largest distance of a translation from an integer.
    pub translation_error: f64,
    /// Largest change of a coordinate.
    pub largest_change: f64,
}

/// A boundary edge closer to an isoline than this, in grid units, is put on it. Coordinates up to a
/// hundred written with six digits are that good; quads of a millionth of the area do not matter.
const BOUNDARY_SNAP: f64 = 1e-4;
/// Boundary edges shorter than this do not tell their direction.
const SHORTEST_TELLING_EDGE: f64 = 10.0 * BOUNDARY_SNAP;

/// An integer map whose two images of every edge agree exactly.
#[derive(Debug, Clone)]
pub(super) struct GridMap {
    pub(super) unit: Unit,
    /// The image of every corner.
    pub(super) corners: HalfedgeData<Point>,
    /// From the face of a half-edge to that of its twin.
    pub(super) transitions: HalfedgeData<Transition>,
    /// Index of every interior vertex in quarters, zero at the boundary.
    pub(super) indices: VertexData<i32>,
    pub(super) snapping: Snapping,
}

impl GridMap {
    /// The images of the corners of a face.
    pub(super) fn triangle(&self, face: seamstress_mesh::Face) -> [Point; 3] {
        face.halfedges().map(|h| self.corners[h])
    }

    /// Both ends of a half-edge, in the chart of its face.
    pub(super) fn ends(&self, h: Halfedge) -> [Point; 2] {
        [self.corners[h], self.corners[h.next()]]
    }
}

/// Makes UVs an exact integer map.
///
/// # Errors
/// UVs that are no numbers or no integer map to within `tolerance` grid units.
pub(super) fn snap(
    mesh: &TriMesh,
    corner_uvs: &[[f64; 2]],
    tolerance: f64,
) -> Result<GridMap, ExtractError> {
    let unit = Unit::for_span(span(mesh, corner_uvs)?);
    let uv: HalfedgeData<Complex64> =
        corner_uvs.iter().map(|&[u, v]| Complex64::new(u, v)).collect();
    let edges = Edges::read(mesh, &uv, tolerance);
    if !edges.faults.is_empty() {
        return Err(ExtractError::NotInteger(MapFaults(edges.faults)));
    }
    let mut snapper = Snapper { mesh, unit, uv: &uv, edges, tolerance, faults: Vec::new() };
    let (corners, indices) = snapper.place_vertices();
    let Snapper { edges, faults, .. } = snapper;
    if !faults.is_empty() {
        return Err(ExtractError::NotInteger(MapFaults(faults)));
    }
    let changes = corners.0.par_iter().zip(corner_uvs).map(|(&corner, uv)| {
        let placed = unit.to_f64(corner);
        (placed[0] - uv[0]).abs().max((placed[1] - uv[1]).abs())
    });
    let changes: Vec<f64> = changes.collect();
    let largest_change = changes.into_iter().fold(0.0, f64::max);
    let snapping = Snapping { largest_change, ..edges.snapping };
    Ok(GridMap { unit, corners, transitions: edges.transitions, indices, snapping })
}

fn span(mesh: &TriMesh, corner_uvs: &[[f64; 2]]) -> Result<f64, ExtractError> {
    let (expected, found) = (mesh.n_halfedges(), corner_uvs.len());
    if expected != found {
        return Err(ExtractError::WrongCount { what: "corner UVs", expected, found });
    }
    let face = |corner: usize| (corner / 3) as u32;
    if let Some(corner) = corner_uvs.iter().position(|uv| !uv.iter().all(|x| x.is_finite())) {
        return Err(ExtractError::NonFiniteUv { face: face(corner) });
    }
    let is_large = |uv: &[f64; 2]| uv.iter().any(|x| x.abs() > LARGEST_COORDINATE);
    if let Some(corner) = corner_uvs.iter().position(is_large) {
        return Err(ExtractError::TooLarge { face: face(corner), limit: LARGEST_COORDINATE });
    }
    Ok(corner_uvs.iter().flatten().fold(0.0, |m, x| m.max(x.abs())))
}

/// The exact transitions nearest to what the edges show.
struct Edges {
    transitions: HalfedgeData<Transition>,
    snapping: Snapping,
    faults: Vec<MapFault>,
}

/// What one edge shows.
struct Edge {
    transition: Transition,
    gap: f64,
    error: f64,
    fault: Option<MapFault>,
}

impl Edges {
    fn read(mesh: &TriMesh, uv: &HalfedgeData<Complex64>, tolerance: f64) -> Self {
        let halfedges: Vec<(Halfedge, Halfedge)> =
            mesh.interior_edges().filter_map(|h| Some((h, mesh.twin(h)?))).collect();
        let read: Vec<Edge> =
            halfedges.par_iter().map(|&(h, t)| Edge::read(mesh, uv, h, t, tolerance)).collect();
        let mut edges = Self {
            transitions: HalfedgeData::filled(mesh.n_halfedges(), Transition::IDENTITY),
            snapping: Snapping::default(),
            faults: Vec::new(),
        };
        for ((h, t), edge) in halfedges.into_iter().zip(read) {
            edges.transitions[h] = edge.transition;
            edges.transitions[t] = edge.transition.inverse();
            edges.snapping.gap = edges.snapping.gap.max(edge.gap);
            edges.snapping.translation_error = edges.snapping.translation_error.max(edge.error);
            edges.faults.extend(edge.fault);
        }
        edges
    }
}

impl Edge {
    fn read(
        mesh: &TriMesh,
        uv: &HalfedgeData<Complex64>,
        h: Halfedge,
        t: Halfedge,
        tolerance: f64,
    ) -> Self {
        let (left, right) = ([uv[h], uv[h.next()]], [uv[t.next()], uv[t]]);
        let (along_left, along_right) = (left[1] - left[0], right[1] - right[0]);
        let quarters = (along_right * along_left.conj()).arg() / FRAC_PI_2;
        let turns = (quarters.round() as i32).rem_euclid(4) as u8;
        let shift = |k: usize| right[k] - times_unit(turns, left[k]);
        let mean = 0.5 * (shift(0) + shift(1));
        let rounded = Complex64::new(mean.re.round(), mean.im.round());
        let gap = (along_right - times_unit(turns, along_left)).norm();
        let error = (mean - rounded).norm();
        let vertices = [mesh.origin(h).0, mesh.tip(h).0];
        let faces = [h.face().0, t.face().0];
        let fault = if gap > tolerance {
            Some(MapFault::OpenEdge { vertices, faces, gap })
        } else if error > tolerance {
            Some(MapFault::Translation { vertices, faces, translation: [mean.re, mean.im] })
        } else {
            None
        };
        let shift = [rounded.re as i64, rounded.im as i64];
        Self { transition: Transition { turns, shift }, gap, error, fault }
    }
}

fn times_unit(turns: u8, z: Complex64) -> Complex64 {
    let [re, im] = turned(turns, [z.re, z.im]);
    Complex64::new(re, im)
}

/// Places every vertex once, and its other images by the transitions.
struct Snapper<'a> {
    mesh: &'a TriMesh,
    unit: Unit,
    uv: &'a HalfedgeData<Complex64>,
    edges: Edges,
    tolerance: f64,
    faults: Vec<MapFault>,
}

/// A corner of a vertex, and the way to its chart from that of the first one.
type Spoke = (Halfedge, Transition);

impl Snapper<'_> {
    fn place_vertices(&mut self) -> (HalfedgeData<Point>, VertexData<i32>) {
        let mut corners = HalfedgeData::filled(self.mesh.n_halfedges(), Point { u: 0, v: 0 });
        let mut indices = VertexData::filled(self.mesh.n_vertices(), 0);
        let mut spokes = Vec::new();
        for v in self.mesh.vertices() {
            let around = self.walk_around(v, &mut spokes);
            let Some(&(first, _)) = spokes.first() else { continue };
            let placed = if self.mesh.is_boundary(v) {
                self.place_on_boundary(&spokes)
            } else {
                indices[v] = self.index(around, &spokes);
                self.place_inside(v, first, around, indices[v])
            };
            for &(h, way) in &spokes {
                corners[h] = way.point(self.unit, placed);
            }
        }
        (corners, indices)
    }

    /// Lists the corners of a vertex; returns the transition all the way around.
    fn walk_around(&self, v: Vertex, spokes: &mut Vec<Spoke>) -> Transition {
        spokes.clear();
        let mut way = Transition::IDENTITY;
        for h in self.mesh.outgoing(v) {
            spokes.push((h, way));
            way = way.then(self.edges.transitions[h.prev()]);
        }
        way
    }

    /// The index, whose remainder modulo 4 the transitions tell exactly.
    ///
    /// Where faces around the vertex are turned over and the transitions are those of a regular vertex it
    /// is taken for one: what is left of its angle sum counts folds.
    fn index(&self, around: Transition, spokes: &[Spoke]) -> i32 {
        let angles = spokes.iter().map(|&(h, _)| self.angle(h));
        if around.turns == 0 && angles.clone().any(|(angle, is_over)| is_over || angle <= 0.0) {
            return 0;
        }
        let index = 4.0 - angles.map(|(angle, _)| angle).sum::<f64>() / FRAC_PI_2;
        let turns = f64::from(around.turns);
        (turns + 4.0 * ((index - turns) / 4.0).round()) as i32
    }

    /// The angle of a corner, and whether its face is turned over.
    ///
    /// The angles of a face that is turned over are negative. Its corner of the largest one has passed
    /// through the opposite side, and is counted a full turn higher: then the angles of every face sum
    /// to half a turn, and the indices to four times the Euler characteristic.
    fn angle(&self, h: Halfedge) -> (f64, bool) {
        let at = |h: Halfedge| {
            let (a, b) = (self.uv[h.next()] - self.uv[h], self.uv[h.prev()] - self.uv[h]);
            (b * a.conj()).arg()
        };
        let (angle, next, prev) = (at(h), at(h.next()), at(h.prev()));
        let is_over = angle < 0.0;
        let is_largest = angle < next && angle < prev;
        (if is_over && is_largest { angle + TAU } else { angle }, is_over)
    }

    fn place_inside(&mut self, v: Vertex, h: Halfedge, around: Transition, index: i32) -> Point {
        let at = [self.uv[h].re, self.uv[h].im];
        if index == 0 {
            if around.shift != [0, 0] {
                self.faults.push(MapFault::OpenVertex { vertex: v.0 });
            }
            return self.unit.round(at);
        }
        let nearest = at.map(|x| x.round() as i64);
        let place = if around.turns == 0 { Some(nearest) } else { around.fixed_point() };
        let is_near = |p: &[i64; 2]| (0..2).all(|k| (p[k] as f64 - at[k]).abs() <= self.tolerance);
        match place.filter(is_near) {
            Some(p) => self.unit.grid_point(p),
            None => {
                self.faults.push(MapFault::ConeOffGrid { vertex: v.0, index, at });
                self.unit.round(at)
            }
        }
    }

    /// At the boundary a vertex is put on the isolines its boundary edges follow.
    fn place_on_boundary(&self, spokes: &[Spoke]) -> Point {
        let (first, _) = spokes[0];
        let (last, way) = spokes[spokes.len() - 1];
        let outgoing = self.isolines(first, first.next());
        let incoming = self.isolines(last, last.prev());
        // An isoline keeps its direction under an even number of turns.
        let incoming = if way.turns % 2 == 0 { incoming } else { [incoming[1], incoming[0]] };
        let at = [self.uv[first].re, self.uv[first].im];
        let snapped = |k: usize| if outgoing[k] || incoming[k] { at[k].round() } else { at[k] };
        self.unit.round([snapped(0), snapped(1)])
    }

    /// Whether the edge between two corners of a face lies on an isoline of `u`, and of `v`.
    fn isolines(&self, a: Halfedge, b: Halfedge) -> [bool; 2] {
        let (p, q) = (self.uv[a], self.uv[b]);
        let is_on = |x: f64, y: f64| {
            let line = x.round();
            (x - line).abs() <= BOUNDARY_SNAP && (y - line).abs() <= BOUNDARY_SNAP
        };
        let is_telling = (q - p).norm() > SHORTEST_TELLING_EDGE;
        [is_telling && is_on(p.re, q.re), is_telling && is_on(p.im, q.im)]
    }
}
