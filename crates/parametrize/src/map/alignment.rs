//! The certificate of alignment: edges that run along the axes of a map.

use super::certificate::SeamlessMap;
use super::tolerance::AlignmentTolerance;
use super::violation::{Violation, Violations};
use crate::features::{ReleaseReason, ReleasedFeature, released};
use crate::quarter::within;
use num_complex::Complex64;
use seamstress_mesh::features::{EdgeSet, Sector, sectors};
use seamstress_mesh::{Halfedge, TriMesh, Vertex};
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

impl Alignment {
    /// Checks that edges, given by their end vertices, run along the axes of a map of this mesh.
    ///
    /// Nothing but the numbers of the map is read. The image of each edge on either side must be
    /// parallel to an axis, and around each of its ends the angles between such edges must be positive
    /// multiples of a quarter turn.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn certify(
        mesh: &TriMesh,
        map: &SeamlessMap,
        edges: &[[u32; 2]],
        tolerance: &AlignmentTolerance,
    ) -> Result<Self, Violations> {
        let (expected, found) = (mesh.n_halfedges(), map.corner_uvs().len());
        if expected != found {
            return Err(Violations(vec![Violation::UvCount { expected, found }]));
        }
        let mut check = Check { mesh, corner_uvs: map.corner_uvs(), violations: Vec::new() };
        let aligned = check.find(edges);
        let mut figures = Self {
            edges: aligned.len(),
            boundary_edges: 0,
            sides: 0,
            exact_sides: 0,
            axis_error: 0.0,
            sectors: 0,
            sectors_by_quarters: BTreeMap::new(),
            sector_error: 0.0,
        };
        check.check_axes(&aligned, tolerance.axis(), &mut figures);
        check.check_sectors(&aligned, tolerance.sector(), &mut figures);
        if check.violations.is_empty() { Ok(figures) } else { Err(Violations(check.violations)) }
    }
}

/// The features that run along the axes of a map on either side, and the others: dropped, since the map does not
/// follow them.
///
/// # Errors
/// Sectors of the former whose angle is no positive number of quarter turns.
pub fn followed(
    mesh: &TriMesh,
    map: &SeamlessMap,
    features: &EdgeSet,
    tolerance: &AlignmentTolerance,
) -> Result<(EdgeSet, Vec<ReleasedFeature>), Violations> {
    let check = Check { mesh, corner_uvs: map.corner_uvs(), violations: Vec::new() };
    let is_along = |&edge: &Halfedge| {
        let mut sides = std::iter::once(edge).chain(mesh.twin(edge));
        sides.all(|side| within(degrees_off_axis(check.image(side)), tolerance.axis()))
    };
    let (along, off): (Vec<Halfedge>, Vec<Halfedge>) =
        features.edges().iter().copied().partition(is_along);
    let kept = EdgeSet::new(mesh, along);
    Alignment::certify(mesh, map, &kept.vertex_pairs(mesh), tolerance)?;
    Ok((kept, released(mesh, &off, ReleaseReason::NotInMap)))
}

struct Check<'a> {
    mesh: &'a TriMesh,
    corner_uvs: &'a [[f64; 2]],
    violations: Vec<Violation>,
}

impl Check<'_> {
    fn find(&mut self, pairs: &[[u32; 2]]) -> EdgeSet {
        let mut found = Vec::new();
        for &vertices in pairs {
            match self.mesh.edge_between(Vertex(vertices[0]), Vertex(vertices[1])) {
                Some(h) => found.push(h),
                None => self.violations.push(Violation::NotAnEdge { vertices }),
            }
        }
        EdgeSet::new(self.mesh, found)
    }

    /// The image of a half-edge, halved so that it does not overflow.
    fn image(&self, h: Halfedge) -> Complex64 {
        let [from, to] = [h, h.next()].map(|corner| self.corner_uvs[corner.at()]);
        Complex64::new(0.5 * to[0] - 0.5 * from[0], 0.5 * to[1] - 0.5 * from[1])
    }

    fn check_axes(&mut self, aligned: &EdgeSet, tolerance: f64, figures: &mut Alignment) {
        for &edge in aligned.edges() {
            let twin = self.mesh.twin(edge);
            figures.boundary_edges += usize::from(twin.is_none());
            for side in std::iter::once(edge).chain(twin) {
                let image = self.image(side);
                let degrees = degrees_off_axis(image);
                figures.sides += 1;
                figures.exact_sides += usize::from(image.re == 0.0 || image.im == 0.0);
                figures.axis_error = figures.axis_error.max(degrees);
                if !within(degrees, tolerance) {
                    let vertices = [self.mesh.origin(edge).0, self.mesh.tip(edge).0];
                    let face = side.face().0;
                    self.violations.push(Violation::OffAxis { vertices, face, degrees });
                }
            }
        }
    }

    fn check_sectors(&mut self, aligned: &EdgeSet, tolerance: f64, figures: &mut Alignment) {
        for vertex in self.mesh.vertices() {
            if aligned.around(self.mesh, vertex).next().is_none() {
                continue;
            }
            for sector in sectors(self.mesh, aligned, vertex) {
                if sector.is_free {
                    continue;
                }
                let quarters = self.quarters(&sector);
                let nearest = quarters.round();
                let off = (quarters - nearest).abs() * FRAC_PI_2;
                figures.sectors += 1;
                *figures.sectors_by_quarters.entry(nearest as u32).or_default() += 1;
                figures.sector_error = figures.sector_error.max(off);
                if !within(off, tolerance) || nearest < 1.0 {
                    let between = self.ends(&sector);
                    let vertex = vertex.0;
                    self.violations.push(Violation::SectorAngle { vertex, between, quarters });
                }
            }
        }
    }

    /// The sum of the angles of the map in a sector, quarter turns.
    fn quarters(&self, sector: &Sector) -> f64 {
        let angle = |&corner: &Halfedge| {
            let [right, left] = [self.image(corner), -self.image(corner.prev())].map(normalised);
            let w = right.conj() * left;
            w.im.atan2(w.re)
        };
        sector.corners.iter().map(angle).sum::<f64>() / FRAC_PI_2
    }

    /// The other ends of the edges on the two sides of a sector.
    fn ends(&self, sector: &Sector) -> [u32; 2] {
        let right = sector.corners.first().map(|&corner| self.mesh.tip(corner).0);
        let left = sector.corners.last().map(|&corner| self.mesh.origin(corner.prev()).0);
        [right, left].map(Option::unwrap_or_default)
    }
}

/// A vector of about length one in the direction of another.
fn normalised(z: Complex64) -> Complex64 {
    let size = z.re.abs().max(z.im.abs());
    if size > 0.0 { z / size } else { z }
}

fn degrees_off_axis(z: Complex64) -> f64 {
    let (u, v) = (z.re.abs(), z.im.abs());
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
            let z = Complex64::from_polar(3.0, f64::to_radians(degrees));
            assert!((degrees_off_axis(z) - off).abs() < 1e-13, "{degrees}");
        }
        assert_eq!(degrees_off_axis(Complex64::new(0.0, -2.0)), 0.0);
    }
}
