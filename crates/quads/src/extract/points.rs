//! The grid points of a map on the surface, each with one number.

use super::fixed::Point;
use super::snap::GridMap;
use super::sweep::{points_between, points_inside};
use crate::surface_point::SurfacePoint;
use seamstress_mesh::{Face, FaceData, Halfedge, HalfedgeData, TriMesh, Vertex, VertexData};
use seamstress_parallel::prelude::*;

const NONE: u32 = u32::MAX;

/// Where a grid point lies; grid coordinates are those of the face named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Site {
    /// At a vertex.
    Vertex(Vertex),
    /// Strictly inside an edge, which is named by its smaller half-edge.
    Edge(Halfedge, [i64; 2]),
    /// Strictly inside a face.
    Face(Face, [i64; 2]),
}

/// All grid points: those at vertices first, then on edges, then in faces.
pub(super) struct GridPoints {
    pub(super) sites: Vec<Site>,
    at_vertex: VertexData<u32>,
    /// Numbers of the first point and behind the last one, at the smaller half-edge.
    on_edge: HalfedgeData<[u32; 2]>,
    in_face: FaceData<[u32; 2]>,
}

impl GridPoints {
    pub(super) fn new(mesh: &TriMesh, map: &GridMap) -> Self {
        let mut sites = Vec::new();
        let mut at_vertex = VertexData::filled(mesh.n_vertices(), NONE);
        for v in mesh.vertices() {
            let corner = mesh.outgoing(v).next();
            if corner.and_then(|h| map.unit.as_grid_point(map.corners[h])).is_some() {
                at_vertex[v] = sites.len() as u32;
                sites.push(Site::Vertex(v));
            }
        }
        let mut on_edge = HalfedgeData::filled(mesh.n_halfedges(), [0; 2]);
        let edges: Vec<Halfedge> = mesh.edges().collect();
        let between: Vec<Vec<[i64; 2]>> =
            edges.par_iter().map(|&h| points_between(map.unit, map.ends(h))).collect();
        for (&h, points) in edges.iter().zip(between) {
            let first = sites.len();
            sites.extend(points.into_iter().map(|p| Site::Edge(h, p)));
            on_edge[h] = [first as u32, sites.len() as u32];
        }
        let mut in_face = FaceData::filled(mesh.n_faces(), [0; 2]);
        let faces: Vec<Face> = mesh.faces().collect();
        let inside: Vec<Vec<[i64; 2]>> = faces.par_iter().map(|&f| inside(map, f)).collect();
        for (&f, points) in faces.iter().zip(inside) {
            let first = sites.len();
            sites.extend(points.into_iter().map(|p| Site::Face(f, p)));
            in_face[f] = [first as u32, sites.len() as u32];
        }
        Self { sites, at_vertex, on_edge, in_face }
    }

    /// Puts the grid points of a face and its boundary, in its own coordinates, and their numbers
    /// into `found`.
    pub(super) fn of_closed_face(
        &self,
        mesh: &TriMesh,
        map: &GridMap,
        face: Face,
        found: &mut Vec<([i64; 2], u32)>,
    ) {
        found.clear();
        for h in face.halfedges() {
            let number = self.at_vertex[mesh.origin(h)];
            if number != NONE {
                found.extend(map.unit.as_grid_point(map.corners[h]).map(|p| (p, number)));
            }
            let other = mesh.twin(h).filter(|t| t.0 < h.0);
            let [first, end] = self.on_edge[other.unwrap_or(h)];
            for number in first..end {
                if let Site::Edge(_, p) = self.sites[number as usize] {
                    let here = other.map_or(p, |t| map.transitions[t].grid_point(p));
                    found.push((here, number));
                }
            }
        }
        let [first, end] = self.in_face[face];
        for number in first..end {
            if let Site::Face(_, p) = self.sites[number as usize] {
                found.push((p, number));
            }
        }
    }

    /// Where a grid point lies on the surface.
    pub(super) fn locate(&self, mesh: &TriMesh, map: &GridMap, number: u32) -> SurfacePoint {
        match self.sites[number as usize] {
            Site::Vertex(v) => at_vertex(mesh, v),
            Site::Edge(h, p) => on_edge(map, h, map.unit.grid_point(p)),
            Site::Face(f, p) => in_face(map, f, map.unit.grid_point(p)),
        }
    }
}

fn inside(map: &GridMap, face: Face) -> Vec<[i64; 2]> {
    let triangle = map.triangle(face);
    // A collapsed face has no inside, and a level crossed where its sides meet would tell otherwise.
    match Point::orientation(triangle[0], triangle[1], triangle[2]) {
        0 => Vec::new(),
        _ => points_inside(map.unit, &triangle),
    }
}

fn at_vertex(mesh: &TriMesh, v: Vertex) -> SurfacePoint {
    let corner = mesh.outgoing(v).next().unwrap_or(Halfedge(0));
    let mut barycentric = [0.0; 3];
    barycentric[corner.side()] = 1.0;
    SurfacePoint { face: corner.face().0, barycentric }
}

fn on_edge(map: &GridMap, h: Halfedge, at: Point) -> SurfacePoint {
    let [a, b] = map.ends(h);
    // The longer coordinate tells the place best.
    let (part, whole) = if (b.u - a.u).abs() >= (b.v - a.v).abs() {
        (at.u - a.u, b.u - a.u)
    } else {
        (at.v - a.v, b.v - a.v)
    };
    let t = part as f64 / whole as f64;
    let mut barycentric = [0.0; 3];
    barycentric[h.side()] = 1.0 - t;
    barycentric[h.next().side()] = t;
    SurfacePoint { face: h.face().0, barycentric }
}

fn in_face(map: &GridMap, face: Face, at: Point) -> SurfacePoint {
    let [a, b, c] = map.triangle(face);
    let area = Point::orientation(a, b, c) as f64;
    let parts = [(at, b, c), (a, at, c), (a, b, at)];
    let barycentric = parts.map(|(a, b, c)| Point::orientation(a, b, c) as f64 / area);
    SurfacePoint { face: face.0, barycentric }
}
