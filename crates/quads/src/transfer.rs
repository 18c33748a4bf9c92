//! What a surface carries, brought over to quads on it.
//!
//! Values of vertices are those of the surface where the vertex lies. A quad takes the values of its corners from one
//! side of a seam, the one that its middle lies on, and continues them linearly where a corner lies beyond; so no quad
//! is smeared over a seam. Values of faces are those of the triangles beneath a quad: the mean of numbers, of labels
//! the one with the largest share.

use crate::QuadMesh;
use crate::surface::{locate, nearest_in_triangle};
use crate::surface_point::SurfacePoint;
use crate::vector::{Point, cross, dot, norm, scale, sub, unit};
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use seamstress_mesh::{Face, TriMesh};
use seamstress_parallel::prelude::*;
use std::collections::{BTreeMap, HashSet};

/// Samples along each side of a quad.
const SAMPLES: usize = 4;
/// Distance from its source, as a share of the size of the surface, at which a vertex has been moved.
const MOVED: f64 = 1e-9;
/// Difference of values on the sides of an edge that is no seam, as a share of their range: files round numbers.
const SEAM: f64 = 1e-6;
/// Relative difference of distances that are taken for equal.
const TIE: f64 = 1e-12;

/// Quads on a surface, and which triangles lie beneath each.
#[derive(Debug)]
pub struct Transfer<'a> {
    mesh: &'a TriMesh,
    positions: &'a [Point],
    faces: &'a [[u32; 3]],
    quads: &'a QuadMesh,
    /// Where on the surface each vertex lies.
    places: Vec<SurfacePoint>,
    patches: Vec<Patch>,
}

/// The triangles around a quad.
#[derive(Debug)]
struct Patch {
    faces: Vec<u32>,
    /// The one that the middle of the quad lies on.
    home: u32,
}

impl<'a> Transfer<'a> {
    /// Finds the triangles beneath quads, whose vertices came from these places before they were moved.
    ///
    /// # Errors
    /// Where the surface cannot be searched, in words.
    pub fn new(
        mesh: &'a TriMesh,
        (positions, faces): (&'a [[f64; 3]], &'a [[u32; 3]]),
        quads: &'a QuadMesh,
        sources: &[SurfacePoint],
    ) -> Result<Self, String> {
        let places = places((positions, faces), quads, sources)?;
        let mut transfer = Self { mesh, positions, faces, quads, places, patches: Vec::new() };
        let all: Vec<u32> = (0..quads.quads().len() as u32).collect();
        transfer.patches = all.par_iter().map(|&quad| transfer.patch(quad)).collect();
        Ok(transfer)
    }

    /// An attribute of the triangles as one of the quads: of vertices or of corners, or of the quads one of triangles.
    #[must_use]
    pub fn carry(&self, attribute: &Attribute, to: AttributeDomain) -> Attribute {
        match (attribute.domain, to) {
            (AttributeDomain::Face, _) => self.carry_faces(attribute),
            (AttributeDomain::Corner, AttributeDomain::Corner) => self.carry_corners(attribute),
            (_, AttributeDomain::Corner) => {
                let vertices = self.quads.quads().as_flattened().iter().map(|&v| v as usize);
                self.carry_to_vertices(attribute).on(AttributeDomain::Corner, vertices)
            }
            _ => self.carry_to_vertices(attribute),
        }
    }

    fn carry_to_vertices(&self, attribute: &Attribute) -> Attribute {
        self.at(AttributeDomain::Vertex, attribute, &self.places)
    }

    /// An attribute of vertices or corners at points.
    fn at(
        &self,
        domain: AttributeDomain,
        attribute: &Attribute,
        points: &[SurfacePoint],
    ) -> Attribute {
        let elements = |point: &SurfacePoint| match attribute.domain {
            AttributeDomain::Vertex => self.faces[point.face as usize].map(|v| v as usize),
            _ => [0, 1, 2].map(|k| 3 * point.face as usize + k),
        };
        if attribute.kind == AttributeKind::Label {
            let nearest = points.iter().map(|p| elements(p)[heaviest(p.barycentric)]);
            return attribute.on(domain, nearest);
        }
        let mix = |p: &SurfacePoint| mixed(attribute, elements(p), p.barycentric);
        let values: Vec<f64> = points.iter().flat_map(mix).collect();
        attribute.with_values(domain, &finished(attribute, values))
    }

    fn carry_corners(&self, attribute: &Attribute) -> Attribute {
        let is_joined = self.joined(attribute);
        let quads: Vec<(&[u32; 4], &Patch)> =
            self.quads.quads().iter().zip(&self.patches).collect();
        let places = quads.par_iter().map(|(quad, patch)| {
            let island = self.island(patch, &is_joined);
            quad.map(|v| self.place_in(&island, v as usize))
        });
        let places: Vec<[SurfacePoint; 4]> = places.collect();
        self.at(AttributeDomain::Corner, attribute, places.as_flattened())
    }

    fn carry_faces(&self, attribute: &Attribute) -> Attribute {
        let domain = AttributeDomain::Face;
        let all: Vec<usize> = (0..self.patches.len()).collect();
        let beneath: Vec<Vec<u32>> = all.par_iter().map(|&quad| self.beneath(quad)).collect();
        if attribute.kind == AttributeKind::Label {
            let fullest = beneath.iter().map(|faces| fullest(attribute, faces));
            return attribute.on(domain, fullest);
        }
        let mean = |faces: &Vec<u32>| -> Vec<f64> {
            let share = 1.0 / faces.len() as f64;
            let sum = |k: usize| faces.iter().map(|&f| attribute.of(f as usize)[k]).sum::<f64>();
            (0..attribute.width).map(|k| share * sum(k)).collect()
        };
        let values: Vec<f64> = beneath.iter().flat_map(mean).collect();
        attribute.with_values(domain, &finished(attribute, values))
    }

    fn corners(&self, face: u32) -> [Point; 3] {
        self.faces[face as usize].map(|v| self.positions[v as usize])
    }

    fn quad_corners(&self, quad: usize) -> [Point; 4] {
        self.quads.quads()[quad].map(|v| self.quads.positions()[v as usize])
    }

    /// The triangles within reach of a quad, from those that its corners lie on.
    fn patch(&self, quad: u32) -> Patch {
        let corners = self.quad_corners(quad as usize);
        let middle = bilinear(corners, [0.5, 0.5]);
        let reach = corners.iter().map(|&p| norm(sub(p, middle))).fold(0.0, f64::max);
        let seeds = self.quads.quads()[quad as usize].map(|v| self.places[v as usize].face);
        let mut known: HashSet<u32> = HashSet::new();
        let mut faces: Vec<u32> = seeds.into_iter().filter(|&face| known.insert(face)).collect();
        let is_near = |face: u32| {
            let nearest = nearest_in_triangle(middle, self.corners(face)).0;
            norm(sub(nearest, middle)) <= reach
        };
        let mut at = 0;
        while let Some(&face) = faces.get(at) {
            at += 1;
            for next in self.neighbours(face, |_| true) {
                if known.insert(next) && is_near(next) {
                    faces.push(next);
                }
            }
        }
        let home = self.nearest(&faces, middle, normal(corners));
        Patch { faces, home }
    }

    /// The triangles beside a triangle, across sides that may be crossed.
    fn neighbours(
        &self,
        face: u32,
        may_cross: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = u32> {
        let sides = Face(face).halfedges().into_iter().filter(move |h| may_cross(h.at()));
        sides.filter_map(|h| self.mesh.twin(h)).map(|twin| twin.face().0)
    }

    /// The triangle nearest to a point, if possible one that faces the same way; the first of equals.
    fn nearest(&self, faces: &[u32], point: Point, normal: Point) -> u32 {
        let rank = |&face: &u32| {
            let corners = self.corners(face);
            let way = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
            let distance = norm(sub(nearest_in_triangle(point, corners).0, point));
            (dot(way, normal) <= 0.0, distance, face)
        };
        let ranks = faces.iter().map(rank);
        let least =
            ranks.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        least.map_or(0, |(_, _, face)| face)
    }

    /// The triangles at samples of a quad.
    fn beneath(&self, quad: usize) -> Vec<u32> {
        let (patch, corners) = (&self.patches[quad], self.quad_corners(quad));
        if let [only] = patch.faces[..] {
            return vec![only];
        }
        let normal = normal(corners);
        let at = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let samples = (0..SAMPLES * SAMPLES).map(|k| [at(k / SAMPLES), at(k % SAMPLES)]);
        let point = |uv| bilinear(corners, uv);
        samples.map(|uv| self.nearest(&patch.faces, point(uv), normal)).collect()
    }

    /// For each half-edge whether an attribute of corners goes on across it.
    fn joined(&self, attribute: &Attribute) -> Vec<bool> {
        let width = attribute.width;
        let range = |k: usize| {
            let column = attribute.values.iter().skip(k).step_by(width.max(1));
            let (low, high) =
                column.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &x| (a.min(x), b.max(x)));
            SEAM * (high - low)
        };
        let tolerance: Vec<f64> = (0..width).map(range).collect();
        let is_label = attribute.kind == AttributeKind::Label;
        let is_same = |a: u32, b: u32| {
            let (a, b) = (attribute.rows[a as usize], attribute.rows[b as usize]);
            let close = || {
                let pairs = attribute.row(a).iter().zip(attribute.row(b)).zip(&tolerance);
                pairs.into_iter().all(|((a, b), tolerance)| (a - b).abs() <= *tolerance)
            };
            a == b || (!is_label && close())
        };
        let is_joined = |h| {
            self.mesh
                .twin(h)
                .is_some_and(|twin| is_same(h.0, twin.next().0) && is_same(h.next().0, twin.0))
        };
        self.mesh.halfedges().map(is_joined).collect()
    }

    /// The triangles of a patch on the side of seams that the middle of the quad lies on.
    fn island(&self, patch: &Patch, is_joined: &[bool]) -> Vec<u32> {
        let within: HashSet<u32> = patch.faces.iter().copied().collect();
        let mut known = HashSet::from([patch.home]);
        let mut island = vec![patch.home];
        let mut at = 0;
        while let Some(&face) = island.get(at) {
            at += 1;
            for next in self.neighbours(face, |h| is_joined[h]) {
                if within.contains(&next) && known.insert(next) {
                    island.push(next);
                }
            }
        }
        island
    }

    /// A vertex as a point of an island, or of the plane of its nearest triangle, of equally near ones the largest.
    fn place_in(&self, island: &[u32], vertex: usize) -> SurfacePoint {
        let place = self.places[vertex];
        if island.contains(&place.face) {
            return place;
        }
        let point = self.quads.positions()[vertex];
        let ranked = island.iter().map(|&face| {
            let corners = self.corners(face);
            let sides = [1, 2].map(|k| sub(corners[k], corners[0]));
            let (nearest, weights) = nearest_in_triangle(point, corners);
            (face, norm(sub(nearest, point)), norm(cross(sides[0], sides[1])), weights)
        });
        let ranked: Vec<(u32, f64, f64, [f64; 3])> = ranked.collect();
        let least = ranked.iter().map(|r| r.1).fold(f64::INFINITY, f64::min);
        let tie = least * (1.0 + TIE) + TIE * norm(point);
        let near = ranked.iter().filter(|r| r.1 <= tie);
        let largest = near.max_by(|a, b| a.2.total_cmp(&b.2).then(b.0.cmp(&a.0)));
        largest.map_or(place, |&(face, _, _, clamped)| {
            let barycentric = affine(point, self.corners(face)).unwrap_or(clamped);
            SurfacePoint { face, barycentric }
        })
    }
}

/// Where vertices lie on a surface: at their sources, or nearby if they were moved.
fn places(
    (positions, faces): (&[Point], &[[u32; 3]]),
    quads: &QuadMesh,
    sources: &[SurfacePoint],
) -> Result<Vec<SurfacePoint>, String> {
    let size = positions.as_flattened().iter().fold(0.0f64, |size, x| size.max(x.abs()));
    let is_moved = |(source, &position): (&SurfacePoint, &Point)| {
        norm(sub(source.position(positions, faces), position)) > MOVED * size
    };
    let moved = |(v, pair)| is_moved(pair).then_some(v);
    let moved = sources.iter().zip(quads.positions()).enumerate().filter_map(moved);
    let moved: Vec<usize> = moved.collect();
    let mut places = sources.to_vec();
    if !moved.is_empty() {
        let points = moved.iter().map(|&v| quads.positions()[v]);
        for (&v, place) in moved.iter().zip(locate(positions, faces, points)?) {
            places[v] = place;
        }
    }
    Ok(places)
}

/// The point of a quad at two coordinates from 0 to 1.
fn bilinear(corners: [Point; 4], [s, t]: [f64; 2]) -> Point {
    let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
    [0, 1, 2].map(|axis| (0..4).map(|k| weights[k] * corners[k][axis]).sum())
}

/// The direction across a quad.
fn normal(corners: [Point; 4]) -> Point {
    cross(sub(corners[2], corners[0]), sub(corners[3], corners[1]))
}

/// The weights of the corners of a triangle at the foot of a point in its plane; none if it has no area.
fn affine(point: Point, [a, b, c]: [Point; 3]) -> Option<[f64; 3]> {
    let (across, along, to) = (cross(sub(b, a), sub(c, a)), unit(sub(b, a))?, sub(point, a));
    let normal = unit(across)?;
    let area = norm(across);
    let foot = sub(to, scale(normal, dot(to, normal)));
    let second = dot(cross(sub(b, a), foot), normal) / area;
    let first = (dot(foot, along) - second * dot(sub(c, a), along)) / norm(sub(b, a));
    Some([1.0 - first - second, first, second])
}

/// The corner with the largest weight.
fn heaviest(weights: [f64; 3]) -> usize {
    (0..3).rev().max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or_default()
}

/// Values of three elements with weights.
fn mixed(attribute: &Attribute, elements: [usize; 3], weights: [f64; 3]) -> Vec<f64> {
    let rows = elements.map(|element| attribute.of(element));
    // Equal values stay as they are, to the bit.
    if rows[0] == rows[1] && rows[1] == rows[2] {
        return rows[0].to_vec();
    }
    let column =
        |k: usize| (0..3).filter(|&i| weights[i] != 0.0).map(|i| weights[i] * rows[i][k]).sum();
    (0..attribute.width).map(column).collect()
}

/// The element, among some, whose label most of them have; of equals the first.
fn fullest(labels: &Attribute, faces: &[u32]) -> usize {
    let mut counts: BTreeMap<u32, (usize, u32)> = BTreeMap::new();
    for &face in faces {
        counts.entry(labels.rows[face as usize]).or_insert((0, face)).0 += 1;
    }
    let most = counts.values().rev().max_by_key(|(count, _)| *count);
    most.map_or(0, |&(_, face)| face as usize)
}

/// Mixed values as what they are: normals of length one, colours in the range of those of the surface.
fn finished(attribute: &Attribute, mut values: Vec<f64>) -> Vec<f64> {
    match attribute.kind {
        AttributeKind::Normal => {
            for row in values.chunks_exact_mut(attribute.width.max(1)) {
                let length = row.iter().map(|x| x * x).sum::<f64>().sqrt();
                if length > 0.0 {
                    row.iter_mut().for_each(|x| *x /= length);
                }
            }
        }
        AttributeKind::Color => {
            let of_surface = attribute.values.iter();
            let high = of_surface.fold(1.0f64, |high, &x| high.max(x));
            values.iter_mut().for_each(|x| *x = x.clamp(0.0, high));
        }
        _ => {}
    }
    values
}

#[cfg(test)]
mod tests;
