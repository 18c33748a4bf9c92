//! The certificate of alignment: edges that run along the axes of a map.

use crate::manifold::Manifold;
use crate::map::Map;
use crate::plane::{Point, angle};
use crate::tolerance::{AlignmentTolerance, within};
use crate::violation::{Violation, Violations};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// What was checked of the edges of a map that have to run along its axes, and what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Alignment {
    /// Aligned edges, each once.
    pub edges: usize,
    /// Those of them on the boundary.
    pub boundary_edges: usize,
    /// Images of these edges: two of an interior edge, one of a boundary edge.
    pub sides: usize,
    /// Images whose ends have one coordinate in common to the last bit.
    pub exact_sides: usize,
    /// Largest angle between an image and the nearer axis, degrees.
    pub axis_error: f64,
    /// Sectors at the ends of these edges whose angle has to be a multiple of a quarter turn: all
    /// but those that end at a boundary edge that is not aligned.
    pub sectors: usize,
    /// How many of them there are of each number of quarter turns.
    pub sectors_by_quarters: BTreeMap<u32, usize>,
    /// Largest error of the angle of such a sector, radians.
    pub sector_error: f64,
}

/// Edges of a mesh, without repetition.
pub(crate) struct Edges {
    /// The smaller half-edge of each, ascending.
    pub(crate) edges: Vec<usize>,
    /// Set on every half-edge of each.
    contains: Vec<bool>,
}

/// The corners around a vertex between two edges of a set, counter-clockwise.
struct Sector {
    corners: Vec<usize>,
    /// Whether it ends at a boundary edge that does not belong to the set: then nothing fixes its angle.
    is_free: bool,
}

impl Map<'_> {
    /// Certifies that edges of a seamless map, given by their end vertices, run along its axes.
    ///
    /// The image of each edge on either side must be parallel to an axis, and around each of its ends the angles
    /// between such edges must be positive multiples of a quarter turn.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn alignment(
        &self,
        edges: &[[u32; 2]],
        tolerance: &AlignmentTolerance,
    ) -> Result<Alignment, Violations> {
        let (aligned, mut violations) = self.edges_between(edges);
        let mut figures = Alignment {
            edges: aligned.edges.len(),
            boundary_edges: 0,
            sides: 0,
            exact_sides: 0,
            axis_error: 0.0,
            sectors: 0,
            sectors_by_quarters: BTreeMap::new(),
            sector_error: 0.0,
        };
        self.axes(&aligned, tolerance.axis(), &mut figures, &mut violations);
        self.angles(&aligned, tolerance.sector(), &mut figures, &mut violations);
        Violations::unless_none(violations).map(|()| figures)
    }

    /// The edges between pairs of vertices, and the pairs without one.
    pub(crate) fn edges_between(&self, pairs: &[[u32; 2]]) -> (Edges, Vec<Violation>) {
        let mut contains = vec![false; self.mesh.halfedges().count()];
        let mut violations = Vec::new();
        for &vertices in pairs {
            let [a, b] = vertices;
            let Some(h) = self.mesh.edge_between(a, b) else {
                violations.push(Violation::NotAnEdge { vertices });
                continue;
            };
            std::iter::once(h).chain(self.mesh.twin(h)).for_each(|side| contains[side] = true);
        }
        (
            Edges { edges: self.mesh.edges().filter(|&h| contains[h]).collect(), contains },
            violations,
        )
    }

    /// The image of a half-edge, halved so that it does not overflow.
    fn image(&self, h: usize) -> Point {
        let [from, to] = [h, self.mesh.next(h)].map(|corner| self.uv(corner));
        [0, 1].map(|k| 0.5 * to[k] - 0.5 * from[k])
    }

    fn axes(
        &self,
        aligned: &Edges,
        tolerance: f64,
        figures: &mut Alignment,
        violations: &mut Vec<Violation>,
    ) {
        for &edge in &aligned.edges {
            let twin = self.mesh.twin(edge);
            figures.boundary_edges += usize::from(twin.is_none());
            for side in std::iter::once(edge).chain(twin) {
                let image = self.image(side);
                let degrees = degrees_off_axis(image);
                figures.sides += 1;
                figures.exact_sides += usize::from(image.contains(&0.0));
                figures.axis_error = figures.axis_error.max(degrees);
                if !within(degrees, tolerance) {
                    let (vertices, face) = (self.mesh.ends(edge), Manifold::<3>::face(side));
                    violations.push(Violation::OffAxis { vertices, face, degrees });
                }
            }
        }
    }

    fn angles(
        &self,
        aligned: &Edges,
        tolerance: f64,
        figures: &mut Alignment,
        violations: &mut Vec<Violation>,
    ) {
        for vertex in self.mesh.vertices().filter(|&v| self.edges_around(v, aligned) > 0) {
            for sector in self.sectors(vertex, aligned).iter().filter(|sector| !sector.is_free) {
                let quarters = self.quarters_of(sector);
                let nearest = quarters.round();
                let off = (quarters - nearest).abs() * FRAC_PI_2;
                figures.sectors += 1;
                *figures.sectors_by_quarters.entry(nearest as u32).or_default() += 1;
                figures.sector_error = figures.sector_error.max(off);
                if !within(off, tolerance) || nearest < 1.0 {
                    let between = self.sides(sector);
                    violations.push(Violation::SectorAngle { vertex, between, quarters });
                }
            }
        }
    }

    /// Whether edges turn at a vertex: two of them end there, with a sector that is not straight, or with more than one at a
    /// boundary, which then turns back.
    pub(crate) fn is_turning_point(&self, vertex: u32, edges: &Edges) -> bool {
        let sectors = self.sectors(vertex, edges);
        let between: Vec<&Sector> = sectors.iter().filter(|sector| !sector.is_free).collect();
        let turns = between.iter().any(|sector| self.quarters_of(sector).round() != 2.0);
        let turns_back = self.mesh.is_boundary(vertex) && between.len() > 1;
        self.edges_around(vertex, edges) > 1 && (turns || turns_back)
    }

    /// How many edges of a set end at a vertex.
    fn edges_around(&self, vertex: u32, edges: &Edges) -> usize {
        let ends = |corner: usize| {
            let last = self.mesh.prev(corner);
            usize::from(edges.contains[corner])
                + usize::from(edges.contains[last] && self.mesh.twin(last).is_none())
        };
        self.mesh.fan(vertex).map(ends).sum()
    }

    /// The sectors around a vertex, counter-clockwise; one with all corners if a single edge of the set ends there.
    fn sectors(&self, vertex: u32, edges: &Edges) -> Vec<Sector> {
        let mut corners: Vec<usize> = self.mesh.fan(vertex).collect();
        let is_boundary = self.mesh.is_boundary(vertex);
        if !is_boundary {
            let start = corners.iter().position(|&h| edges.contains[h]);
            corners.rotate_left(start.unwrap_or(0));
        }
        let ends = |h: &usize| is_boundary && !edges.contains[*h];
        let (first, last) = (corners.first().copied(), corners.last().map(|&h| self.mesh.prev(h)));
        let mut found: Vec<Sector> = Vec::new();
        for corner in corners {
            match found.last_mut() {
                Some(sector) if !edges.contains[corner] => sector.corners.push(corner),
                _ => found.push(Sector { corners: vec![corner], is_free: false }),
            }
        }
        if let Some(sector) = found.first_mut() {
            sector.is_free |= first.as_ref().is_some_and(ends);
        }
        if let Some(sector) = found.last_mut() {
            sector.is_free |= last.as_ref().is_some_and(ends);
        }
        found
    }

    /// The sum of the angles of the map in a sector, quarter turns.
    fn quarters_of(&self, sector: &Sector) -> f64 {
        let angle_at = |&corner: &usize| {
            let right = normalised(self.image(corner));
            let left = normalised(self.image(self.mesh.prev(corner)).map(|x| -x));
            angle(right, left)
        };
        sector.corners.iter().map(angle_at).sum::<f64>() / FRAC_PI_2
    }

    /// The other ends of the edges on the two sides of a sector.
    fn sides(&self, sector: &Sector) -> [u32; 2] {
        let right = sector.corners.first().map(|&corner| self.mesh.tip(corner));
        let left = sector.corners.last().map(|&corner| self.mesh.origin(self.mesh.prev(corner)));
        [right, left].map(Option::unwrap_or_default)
    }
}

/// A vector of about length one in the direction of another.
fn normalised(vector: Point) -> Point {
    let size = vector[0].abs().max(vector[1].abs());
    if size > 0.0 { vector.map(|x| x / size) } else { vector }
}

fn degrees_off_axis([u, v]: Point) -> f64 {
    let (u, v) = (u.abs(), v.abs());
    u.min(v).atan2(u.max(v)).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_axis_counts() {
        for (degrees, off) in
            [(0.0, 0.0), (90.0, 0.0), (180.0, 0.0), (30.0, 30.0), (100.0, 10.0), (225.0, 45.0)]
        {
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            assert!((degrees_off_axis([3.0 * cos, 3.0 * sin]) - off).abs() < 1e-13, "{degrees}");
        }
        assert_eq!(degrees_off_axis([0.0, -2.0]), 0.0);
    }
}
