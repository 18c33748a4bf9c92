//! A flat part of a surface, triangulated anew.

use super::{Face, HalfedgeData, Refinement, Source};
use crate::flat::corners;
use crate::vector::{cross, dot, norm, sub};
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, HasPosition, Point2, RefinementParameters,
    Triangulation,
};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// A part with its border.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) source: &'a Source<'a>,
    pub(super) faces: &'a [Face],
    /// Points on the sides of faces.
    pub(super) pieces: &'a HalfedgeData<Vec<u32>>,
    /// Length of edges wanted; none if only the border has changed.
    pub(super) size: Option<f64>,
}

impl Part<'_> {
    fn corners(&self, f: Face) -> [[f64; 3]; 3] {
        corners(self.source.mesh, self.source.positions, f)
    }

    /// The pieces of the border, with the part on their left.
    fn border(&self) -> Vec<[u32; 2]> {
        let sides = self.faces.iter().flat_map(|f| f.halfedges());
        let on_border = sides.filter(|&h| self.source.is_border(h));
        let chains = on_border.map(|h| self.source.chain(h, self.pieces));
        chains
            .flat_map(|chain| chain.windows(2).map(|e| [e[0], e[1]]).collect::<Vec<_>>())
            .collect()
    }
}

/// Smallest angle wanted, degrees: what refinement reaches with few points.
const ANGLE: f64 = 25.0;
/// Triangles of a part at a minimum, where features need room.
const FEWEST_TRIANGLES: f64 = 8.0;
/// Area of a triangle against that of a square over its sides.
const AREA_OF_SQUARE: f64 = 0.5;
/// Points added at most, for each one that was there.
const MOST_ADDED: usize = 20;
/// How far the area of the triangles may be from that of the part, as a part of it.
const AREA_TOLERANCE: f64 = 1e-6;

/// A point in the plane of the part, in units of its extent.
#[derive(Debug, Clone, Copy)]
struct Site {
    at: Point2<f64>,
    /// The vertex of the refined mesh; none for points that are added.
    vertex: Option<u32>,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

impl From<Point2<f64>> for Site {
    fn from(at: Point2<f64>) -> Self {
        Self { at, vertex: None }
    }
}

/// Adds the triangles of a part to a refined mesh: constrained Delaunay triangles with their border, refined inside if
/// it needs room. Where the arithmetic does not allow that, every face keeps its place and is split into a fan.
pub(super) fn triangulate(part: &Part<'_>, refined: &mut Refinement) {
    let Some(plane) = Plane::new(part) else { return fans(part, refined) };
    match plane.triangles(part, &refined.positions) {
        Some(found) => plane.add(&found, part, refined),
        None => fans(part, refined),
    }
}

/// Coordinates in the plane of a part.
struct Plane {
    origin: [f64; 3],
    /// Two orthogonal vectors, as long as one over the extent.
    axes: [[f64; 3]; 2],
    extent: f64,
    /// The largest face.
    largest: [Point2<f64>; 3],
}

/// Sites, and the triangles between them.
struct Found {
    sites: Vec<Site>,
    triangles: Vec<[usize; 3]>,
}

impl Plane {
    /// That of the largest face.
    fn new(part: &Part<'_>) -> Option<Self> {
        let doubled = |f: Face| {
            let [a, b, c] = part.corners(f);
            cross(sub(b, a), sub(c, a))
        };
        let area = |f: Face| norm(doubled(f));
        let largest = part.faces.iter().copied().max_by(|&f, &g| area(f).total_cmp(&area(g)))?;
        let [origin, b, _] = part.corners(largest);
        let points = part.faces.iter().flat_map(|&f| part.corners(f));
        let extent = points.map(|p| norm(sub(p, origin))).fold(0.0, f64::max);
        let unit = |v: [f64; 3]| {
            let length = norm(v);
            (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
        };
        let (normal, first) = (unit(doubled(largest))?, unit(sub(b, origin))?);
        let axes = [first, cross(normal, first)].map(|axis| axis.map(|x| x / extent));
        let plane = Self { origin, axes, extent, largest: [Point2::new(0.0, 0.0); 3] };
        let largest = part.corners(largest).map(|p| plane.project(p));
        Some(Self { largest, ..plane })
    }

    fn project(&self, p: [f64; 3]) -> Point2<f64> {
        let [x, y] = self.axes.map(|axis| dot(sub(p, self.origin), axis));
        Point2::new(x, y)
    }

    /// Constrained Delaunay triangles of a part; none if some of its border is not among their edges.
    fn triangles(&self, part: &Part<'_>, positions: &[[f64; 3]]) -> Option<Found> {
        let mut delaunay = ConstrainedDelaunayTriangulation::<Site>::new();
        let mut handles = HashMap::new();
        let border = part.border();
        let inner = part.faces.iter().flat_map(|&f| part.source.mesh.face_vertices(f)).map(|v| v.0);
        for vertex in inner.chain(border.as_flattened().iter().copied()) {
            if let Entry::Vacant(new) = handles.entry(vertex) {
                let at = self.project(positions[vertex as usize]);
                new.insert(delaunay.insert(Site { at, vertex: Some(vertex) }).ok()?);
            }
        }
        if delaunay.num_vertices() != handles.len() {
            return None;
        }
        for ends in &border {
            let [from, to] = ends.map(|v| handles[&v]);
            delaunay.try_add_constraint(from, to);
            if !delaunay.exists_constraint(from, to) {
                return None;
            }
        }
        let area = part.faces.iter().map(|&f| self.area(part.corners(f)));
        let area: f64 = area.sum();
        if let Some(size) = part.size {
            // Refinement alone adds none where that would be close to the border.
            let [a, b, c] = self.largest;
            let center = Point2::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0);
            delaunay.insert(Site { at: center, vertex: None }).ok()?;
            let size = size / self.extent;
            let largest = (AREA_OF_SQUARE * size * size).min(area / FEWEST_TRIANGLES);
            let wanted = MOST_ADDED * handles.len() + (4.0 * area / largest).min(1e6) as usize;
            let added = positions.len() - part.source.positions.len();
            let left = part.source.most_points().saturating_sub(added);
            let parameters = RefinementParameters::new()
                .exclude_outer_faces(true)
                .keep_constraint_edges()
                .with_angle_limit(AngleLimit::from_deg(ANGLE))
                .with_max_allowed_area(largest)
                .with_max_additional_vertices(wanted.min(left));
            delaunay.refine(parameters);
        }
        // Inside is what lies on the left of the border, and what hangs together with it.
        let border: HashSet<_> = border.iter().map(|ends| ends.map(|v| handles[&v])).collect();
        let mut is_inside = vec![false; delaunay.num_all_faces()];
        let mut stack: Vec<_> = delaunay
            .inner_faces()
            .filter(|face| {
                let ends = |e: &spade::handles::DirectedEdgeHandle<'_, _, _, _, _>| {
                    [e.from().fix(), e.to().fix()]
                };
                face.adjacent_edges().iter().any(|e| border.contains(&ends(e)))
            })
            .collect();
        stack.iter().for_each(|face| is_inside[face.fix().index()] = true);
        while let Some(face) = stack.pop() {
            for edge in face.adjacent_edges() {
                let is_constraint = edge.as_undirected().is_constraint_edge();
                let beyond = edge.rev().face().as_inner().filter(|_| !is_constraint);
                let new = beyond.filter(|face| !is_inside[face.fix().index()]);
                stack.extend(new.inspect(|face| is_inside[face.fix().index()] = true));
            }
        }
        let sites: Vec<Site> = delaunay.vertices().map(|v| *v.data()).collect();
        let inside = delaunay.inner_faces().filter(|face| is_inside[face.fix().index()]);
        let triangles: Vec<[usize; 3]> =
            inside.map(|face| face.vertices().map(|v| v.fix().index())).collect();
        let found: f64 = triangles.iter().map(|t| doubled_area(t.map(|k| sites[k].at)) / 2.0).sum();
        let is_whole = (found - area).abs() <= AREA_TOLERANCE * area;
        let is_proper = triangles.iter().all(|t| doubled_area(t.map(|k| sites[k].at)) > 0.0);
        (is_whole && is_proper).then_some(Found { sites, triangles })
    }

    fn area(&self, corners: [[f64; 3]; 3]) -> f64 {
        doubled_area(corners.map(|p| self.project(p))) / 2.0
    }

    fn add(&self, found: &Found, part: &Part<'_>, refined: &mut Refinement) {
        let flat: Vec<[Point2<f64>; 3]> =
            part.faces.iter().map(|&f| part.corners(f).map(|p| self.project(p))).collect();
        let mut vertex: Vec<Option<u32>> = found.sites.iter().map(|site| site.vertex).collect();
        for triangle in &found.triangles {
            for &k in triangle {
                vertex[k].get_or_insert_with(|| {
                    let (face, weights) = locate(found.sites[k].at, &flat);
                    let corners = part.corners(part.faces[face]);
                    let at = |axis: usize| (0..3).map(|i| weights[i] * corners[i][axis]).sum();
                    refined.positions.push([0, 1, 2].map(at));
                    (refined.positions.len() - 1) as u32
                });
            }
            let [a, b, c] = triangle.map(|k| found.sites[k].at);
            let center = Point2::new((a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0);
            refined.face_origin.push(part.faces[locate(center, &flat).0].0);
            refined.faces.push(triangle.map(|k| vertex[k].unwrap_or_default()));
        }
    }
}

fn doubled_area([a, b, c]: [Point2<f64>; 3]) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The triangle that a point is in, or nearly, and the weights of its corners there.
fn locate(at: Point2<f64>, triangles: &[[Point2<f64>; 3]]) -> (usize, [f64; 3]) {
    let weights = |&[a, b, c]: &[Point2<f64>; 3]| {
        let parts = [[at, b, c], [a, at, c], [a, b, at]].map(doubled_area);
        parts.map(|part| part / doubled_area([a, b, c]))
    };
    let least = |w: &[f64; 3]| match w.iter().all(|x| x.is_finite()) {
        true => w[0].min(w[1]).min(w[2]),
        false => f64::NEG_INFINITY,
    };
    let all = triangles.iter().map(weights).enumerate();
    all.max_by(|(_, v), (_, w)| least(v).total_cmp(&least(w))).unwrap_or_default()
}

/// Every face as it is, or as a fan around its center if there are points on its sides.
pub(super) fn fans(part: &Part<'_>, refined: &mut Refinement) {
    for &f in part.faces {
        let chains = f.halfedges().map(|h| part.source.chain(h, part.pieces));
        let ring: Vec<u32> =
            chains.iter().flat_map(|chain| &chain[..chain.len() - 1]).copied().collect();
        if let &[a, b, c] = ring.as_slice() {
            refined.faces.push([a, b, c]);
            refined.face_origin.push(f.0);
            continue;
        }
        let corners = part.corners(f);
        let center = refined.positions.len() as u32;
        let mean = |axis: usize| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0;
        refined.positions.push([0, 1, 2].map(mean));
        for (k, &v) in ring.iter().enumerate() {
            refined.faces.push([v, ring[(k + 1) % ring.len()], center]);
            refined.face_origin.push(f.0);
        }
    }
}
