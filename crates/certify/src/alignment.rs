//! The certificate of alignment: edges that run along the axes of a map.

use crate::manifold::Manifold;
use crate::map::Map;
use crate::plane::{degrees_off_axis, difference, scaled};
use crate::tolerance::{ANGLE, AlignmentTolerance, within};
use crate::violation::{Violation, Violations};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// What was checked of the edges of a map that have to run along its axes, and what was found.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
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

/// What lies around a vertex between two edges of a set.
struct Sector {
    /// The other ends of the edges, counter-clockwise.
    between: [u32; 2],
    /// The angle from one to the other, quarter turns.
    quarters: f64,
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
        let mut figures = Alignment { edges: aligned.edges.len(), ..Alignment::default() };
        for (edge, side) in aligned.edges.iter().flat_map(|&edge| self.mesh.sides(edge)) {
            let [from, to] = scaled(self.image(side)).0;
            let degrees = degrees_off_axis(difference(to, from));
            figures.boundary_edges += usize::from(self.mesh.twin(side).is_none());
            figures.sides += 1;
            figures.exact_sides += usize::from(from[0] == to[0] || from[1] == to[1]);
            figures.axis_error = figures.axis_error.max(degrees);
            if !within(degrees, tolerance.axis()) {
                let (vertices, face) = (self.mesh.ends(edge), Manifold::<3>::face(side));
                violations.push(Violation::OffAxis { vertices, face, degrees });
            }
        }
        for vertex in self.mesh.vertices() {
            for Sector { between, quarters } in self.sectors(vertex, &aligned) {
                let nearest = quarters.round();
                let off = (quarters - nearest).abs() * FRAC_PI_2;
                figures.sectors += 1;
                *figures.sectors_by_quarters.entry(nearest as u32).or_default() += 1;
                figures.sector_error = figures.sector_error.max(off);
                if !within(off, ANGLE) || nearest < 1.0 {
                    violations.push(Violation::SectorAngle { vertex, between, quarters });
                }
            }
        }
        Violations::unless_none(violations).map(|()| figures)
    }

    /// The edges between pairs of vertices, and the pairs without one.
    pub(crate) fn edges_between(&self, pairs: &[[u32; 2]]) -> (Edges, Vec<Violation>) {
        let mut contains = vec![false; self.mesh.halfedges().count()];
        let mut violations = Vec::new();
        for &vertices in pairs {
            match self.mesh.edge_between(vertices[0], vertices[1]) {
                Some(h) => self.mesh.sides(h).for_each(|(_, side)| contains[side] = true),
                None => violations.push(Violation::NotAnEdge { vertices }),
            }
        }
        let edges = self.mesh.edges().filter(|&h| contains[h]).collect();
        (Edges { edges, contains }, violations)
    }

    /// Whether edges turn at a vertex: two of them end there, with a sector that is not straight, or with more than one at a
    /// boundary, which then turns back.
    pub(crate) fn is_turning_point(&self, vertex: u32, edges: &Edges) -> bool {
        let sectors = self.sectors(vertex, edges);
        let is_straight = |sector: &Sector| sector.quarters.round() == 2.0;
        // At the boundary two edges have one sector between them.
        match (self.mesh.is_interior(vertex), sectors.len()) {
            (_, 0) | (Some(true), 1) => false,
            (Some(false), 2..) => true,
            _ => !sectors.iter().all(is_straight),
        }
    }

    /// The sectors around a vertex between each edge of a set that ends there and the next one, counter-clockwise; the
    /// whole turn around the end of a single edge. What lies between such an edge and a boundary edge that is not in the
    /// set is no sector: nothing fixes its angle.
    fn sectors(&self, vertex: u32, edges: &Edges) -> Vec<Sector> {
        let mut corners: Vec<usize> = self.mesh.fan(vertex).collect();
        if self.mesh.is_interior(vertex) == Some(true) {
            let start = corners.iter().position(|&h| edges.contains[h]);
            corners.rotate_left(start.unwrap_or(0));
        }
        let sector = |corners: &[usize]| {
            let (right, left) = (*corners.first()?, self.mesh.prev(*corners.last()?));
            (edges.contains[right] && edges.contains[left]).then(|| Sector {
                between: [self.mesh.tip(right), self.mesh.origin[left]],
                quarters: self.angle_sum(corners),
            })
        };
        corners.chunk_by(|_, &h| !edges.contains[h]).filter_map(sector).collect()
    }
}
