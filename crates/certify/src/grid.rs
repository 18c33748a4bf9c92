//! The certificates of alignment, edges that run along the axes of a map, and of an integer-grid map.

use crate::exact::area;
use crate::manifold::Star;
use crate::map::Map;
use crate::plane::{Arrow, Point, degrees_off_axis, difference, largest, scaled, turned};
use crate::verdict::{ANGLE, Checked, Tolerance, Violation, Violations};
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

/// What was checked beyond the certificate of the seamless map, and what was found.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IntegerCertificate {
    /// Interior edges, all with an integer translation.
    pub edges: usize,
    /// Those of them across which a quarter turn and the integer translation are exact in doubles: all of an
    /// `IntegerGridMap`.
    pub exact_edges: usize,
    /// Cones, all of them at grid points in every face around them.
    pub integral_cones: usize,
    /// Aligned edges, both ends of all of them at the same integer on either side.
    pub isoline_edges: usize,
    /// Vertices without a cone at which aligned edges turn, all of them at grid points.
    pub integral_corners: usize,
    /// Largest distance from an integer of what is integral, grid units: 0 of an `IntegerGridMap`.
    pub integral_error: f64,
    /// The largest coordinate of a translation.
    pub largest_translation: f64,
    /// Area in the plane, grid units: the number of quads, exactly, of a mesh that is closed or whose boundary lies on
    /// grid lines.
    pub area: f64,
}

impl Map<'_> {
    /// Certifies that edges of a seamless map, given by their end vertices, run along its axes.
    ///
    /// The image of each edge on either side must be parallel to an axis, and around each of its ends the angles
    /// between such edges must be positive multiples of a quarter turn.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn alignment(&self, edges: &[[u32; 2]], tolerance: &Tolerance) -> Checked<Alignment> {
        let (aligned, mut violations) = self.edges_between(edges);
        let mut figures = Alignment::default();
        for (edge, side) in self.sides(&aligned) {
            let [from, to] = scaled(self.image(side)).0;
            let degrees = degrees_off_axis(difference(to, from));
            figures.edges += usize::from(edge == side);
            figures.boundary_edges += usize::from(self.mesh.twin[side].is_none());
            figures.sides += 1;
            figures.exact_sides += usize::from(from[0] == to[0] || from[1] == to[1]);
            figures.axis_error = figures.axis_error.max(degrees);
            if !tolerance.allows(degrees, |t| t.axes) {
                let (vertices, face) = (self.mesh.ends(edge), (side / 3) as u32);
                violations.push(Violation::OffAxis { vertices, face, degrees });
            }
        }
        for star in self.mesh.stars() {
            for (between, quarters) in self.sectors(&star, &aligned) {
                let (vertex, nearest) = (star.vertex, quarters.round());
                let off = (quarters - nearest).abs() * FRAC_PI_2;
                figures.sectors += 1;
                *figures.sectors_by_quarters.entry(nearest as u32).or_default() += 1;
                figures.sector_error = figures.sector_error.max(off);
                if !(off <= ANGLE && nearest >= 1.0) {
                    violations.push(Violation::SectorAngle { vertex, between, quarters });
                }
            }
        }
        Violations::unless_none(violations).map(|()| figures)
    }

    /// Certifies that a seamless map in grid units is an integer-grid map: translations across edges and the places of
    /// cones are integers, and the two ends of every aligned edge lie at the same integer on either side, with grid
    /// points where these edges turn.
    ///
    /// Whether the map is seamless at all, and the edges, given by their end vertices, run along its axes, is for
    /// [`Map::seamless`] and [`Map::alignment`] to say.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn integers(
        &self,
        aligned: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Checked<IntegerCertificate> {
        let (mut figures, mut violations) = (IntegerCertificate::default(), Vec::new());
        let mut look_at = |off: f64, violation: Violation| {
            figures.integral_error = figures.integral_error.max(off);
            if !tolerance.allows(off, |t| t.integers) {
                violations.push(violation);
            }
        };
        for (h, t) in self.mesh.interior_edges() {
            let (translation, off, is_exact) = self.translation(h, t);
            let (vertices, faces) = (self.mesh.ends(h), [h, t].map(|h| (h / 3) as u32));
            let is_rounding = tolerance.integers == 0.0 && off < Tolerance::LARGEST.integers;
            let violation = match is_rounding && !is_exact {
                true => Violation::InexactEdge { vertices, faces },
                false => Violation::FractionalTranslation { vertices, faces, translation },
            };
            look_at(off, violation);
            let size = largest(&[translation.map(f64::round)]);
            figures.largest_translation = figures.largest_translation.max(size);
            figures.exact_edges += usize::from(off == 0.0);
            figures.edges += 1;
        }
        let aligned = self.edges_between(aligned).0;
        for (edge, side) in self.sides(&aligned) {
            let (vertices, face) = (self.mesh.ends(edge), (side / 3) as u32);
            look_at(off_isolines(self.image(side)), Violation::OffIsoline { vertices, face });
            figures.isoline_edges += usize::from(edge == side);
        }
        for star in self.mesh.stars() {
            let is_cone = star.is_closed && self.turning(&star).0 != 4;
            let is_corner = !is_cone && self.is_turning_point(&star, &aligned);
            let off = |uv: &Point| from_integer(uv[0]).max(from_integer(uv[1]));
            let places = star.corners.iter().map(|&corner| self.uvs[corner]);
            let vertex = star.vertex;
            match places.max_by(|a, b| off(a).total_cmp(&off(b))) {
                Some(uv) if is_cone => look_at(off(&uv), Violation::FractionalCone { vertex, uv }),
                Some(uv) if is_corner => {
                    look_at(off(&uv), Violation::FractionalCorner { vertex, uv });
                }
                _ => {}
            }
            figures.integral_cones += usize::from(is_cone);
            figures.integral_corners += usize::from(is_corner);
        }
        Violations::unless_none(violations)?;
        figures.area = area(self.uvs);
        Ok(figures)
    }

    /// The translation across an interior edge; the largest distance from the integers next to it at an end of the edge, 0 if
    /// these are exact in doubles; and whether it is the same at both ends to the last bit.
    fn translation(&self, h: usize, t: usize) -> (Point, f64, bool) {
        let [a, b, c, d] = self.images(h, t);
        let ends = [(a, c), (b, d)].map(|(left, right)| {
            let left = turned(left, self.quarters[h]);
            [0, 1].map(|k| exact_difference(right[k], left[k]))
        });
        let translation = ends[0].map(|[rounded, _]| rounded);
        let distances = ends.map(|end| {
            [0, 1].map(|k| (end[k][0] - translation[k].round()).abs() + end[k][1].abs())
        });
        let is_exact = ends[0] == ends[1] && ends[0].iter().all(|[_, rest]| *rest == 0.0);
        (translation, largest(&distances), is_exact)
    }

    /// Whether each half-edge lies between one of some pairs of vertices, and the pairs without an edge.
    fn edges_between(&self, pairs: &[[u32; 2]]) -> (Vec<bool>, Vec<Violation>) {
        let (mut edges, mut violations) = (vec![false; self.uvs.len()], Vec::new());
        for &vertices in pairs {
            match self.mesh.edge_between(vertices) {
                Some(h) => self.mesh.sides(h).for_each(|side| edges[side] = true),
                None => violations.push(Violation::NotAnEdge { vertices }),
            }
        }
        (edges, violations)
    }

    /// Each edge of a set, by its smaller half-edge, with each of its half-edges.
    fn sides(&self, edges: &[bool]) -> impl Iterator<Item = (usize, usize)> {
        let edges = self.mesh.edges().filter(|&edge| edges[edge]);
        edges.flat_map(|edge| self.mesh.sides(edge).map(move |side| (edge, side)))
    }

    /// Whether edges turn at a vertex: two of them end there, with a sector that is not straight, or with more than one at a
    /// boundary, which then turns back.
    fn is_turning_point(&self, star: &Star, edges: &[bool]) -> bool {
        let sectors = self.sectors(star, edges);
        // At the boundary two edges have one sector between them.
        match (star.is_closed, sectors.len()) {
            (_, 0) | (true, 1) => false,
            (false, 2..) => true,
            _ => sectors.iter().any(|(_, quarters)| quarters.round() != 2.0),
        }
    }

    /// The sectors around a vertex between each edge of a set that ends there and the next one, counter-clockwise, by the
    /// other ends of the two and the quarter turns from one to the other; the whole turn around the end of a single edge. What
    /// lies between such an edge and a boundary edge that is not in the set is no sector: nothing fixes its angle.
    fn sectors(&self, star: &Star, edges: &[bool]) -> Vec<([u32; 2], f64)> {
        let mut corners = star.corners.clone();
        if star.is_closed {
            let start = corners.iter().position(|&h| edges[h]);
            corners.rotate_left(start.unwrap_or(0));
        }
        let sector = |corners: &[usize]| {
            let (right, left) = (*corners.first()?, self.mesh.prev(*corners.last()?));
            let between = [self.mesh.ends(right)[1], self.mesh.ends(left)[0]];
            (edges[right] && edges[left]).then(|| (between, self.angle_sum(corners)))
        };
        corners.chunk_by(|_, &h| !edges[h]).filter_map(sector).collect()
    }
}

/// The distance of an arrow from the isoline at an integer that is nearest to its start: of its farther end.
fn off_isolines([a, b]: Arrow) -> f64 {
    let off = |k: usize| from_integer(a[k]).max((b[k] - a[k].round()).abs());
    off(0).min(off(1))
}

/// `a - b` as the nearest double and what it lacks (Knuth's two-sum).
fn exact_difference(a: f64, b: f64) -> [f64; 2] {
    let rounded = a - b;
    let b_part = a - rounded;
    let a_part = rounded + b_part;
    [rounded, (a - a_part) + (b_part - b)]
}

/// Distance from the nearest integer.
fn from_integer(x: f64) -> f64 {
    (x - x.round()).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_keep_what_rounding_takes() {
        assert_eq!(exact_difference(0.75, 0.25), [0.5, 0.0]);
        assert_eq!(exact_difference(3.0 + 0.5f64.powi(40), 0.5f64.powi(40)), [3.0, 0.0]);
        assert_eq!(exact_difference(1.0, 1e-30), [1.0, -1e-30]);
        assert_eq!(exact_difference(1e-30, 1.0), [-1.0, 1e-30]);
        assert!(exact_difference(1000.1, 0.1)[1] != 0.0);
    }
}
