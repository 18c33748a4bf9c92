//! The energy of a patch: finite for tangled quads, and a barrier against them in the limit.

use super::Site;
use super::patch::Patch;
use crate::quality::Orientation;
use crate::surface::nearest_in_triangle;
use crate::vector::{Point, add, cross, dot, scale, sub, unit, vector_area};

/// The sum is of this power of the corners' energy: high enough for the worst to lead, low enough for the others to
/// have a say. With 2 more corners stayed beyond the bound; with 6 minimisation became slow.
const POWER: i32 = 4;
/// Weight of a corner's area against its angle. It keeps edges from vanishing while the regularisation is large; much
/// more of it makes squares of stretched quads.
const AREA_WEIGHT: f64 = 0.2;
/// Added to the squared relative length of an edge, so that one of no length has a gradient.
const SMALL_SQUARE: f64 = 1e-4;
/// Weight of the evenness of edges along curves. With none, angles became better by edges of next to no length; with
/// 1, more curves stayed uneven.
const EVEN_WEIGHT: f64 = 4.0;
/// Slope of the pull on the corners of a bent quad, energy per edge: a few times what the corners of a fair quad exert.
const PULL: f64 = 4.0;

/// What the free vertices of a patch minimise.
///
/// With `u` and `v` the edges at a corner in units of what they should be, `N` a unit normal of the quad and
/// `D = N . (u x v)`, each corner counts
///
/// `((|u| |v| + AREA_WEIGHT (D^2 + 1) / 2) / chi(D))^POWER`, `chi(D) = (D + sqrt(eps^2 + D^2)) / 2`:
///
/// for small eps a power of the inverse sine of its angle, and infinite as it becomes reflex. Each vertex counts
/// `d^2 / (r^2 - d^2)`, with `d` the distance of its quads from the point it comes from and `r` how large that may
/// become; each edge along a curve `EVEN_WEIGHT (x^2 + 1 / x^2 - 2)`, with `x` its length in units of what it would be
/// if the edges of the curve were even. Bent quads, whose corners see no common side of the surface, are drawn towards the edge of the thin sheet
/// they lie over, or to the bottom of the slot that they span: there they are on one side.
///
/// Normals are those of the sites that the energy was made for.
pub(super) struct Energy<'a> {
    pub(super) patch: &'a Patch,
    eps: f64,
    normals: Vec<Point>,
    /// The pull on each corner of the quads that are bent, and their number.
    pulls: Vec<(usize, Point)>,
}

impl<'a> Energy<'a> {
    pub(super) fn new(patch: &'a Patch, sites: &[Site], eps: f64) -> Self {
        let corners = |q: &[u32; 4]| q.map(|v| sites[v as usize]);
        let pull = |q: &[u32; 4]| Some(scale(outward(corners(q))?, PULL / patch.edge));
        let pulls = patch.quads.iter().enumerate().filter_map(|(i, q)| Some((i, pull(q)?)));
        Self {
            patch,
            eps,
            normals: patch.quads.iter().map(|q| direction(corners(q))).collect(),
            pulls: pulls.collect(),
        }
    }

    /// The energy, and its gradient along the surface at the vertices that move. Infinite where a tether is torn.
    pub(super) fn evaluate(&self, sites: &[Site]) -> (f64, Vec<Point>) {
        let mut gradient = vec![[0.0; 3]; self.patch.tethers.len()];
        let mut slope = |v: u32, part: Point| {
            if let Some(sum) = gradient.get_mut(v as usize) {
                *sum = add(*sum, part);
            }
        };
        let corners = self.corners(sites, &mut slope);
        let tethers = self.tethers(sites, &mut slope) + self.pull(sites, &mut slope);
        let energy = corners + tethers + self.curve_edges(sites, &mut slope);
        for (part, site) in gradient.iter_mut().zip(sites) {
            *part = sub(*part, scale(site.normal, dot(site.normal, *part)));
        }
        (energy, gradient)
    }

    fn corners(&self, sites: &[Site], slope: &mut impl FnMut(u32, Point)) -> f64 {
        let mut sum = 0.0;
        let quads = self.patch.quads.iter().zip(&self.patch.sides);
        for ((q, sides), &normal) in quads.zip(&self.normals) {
            for k in 0..4 {
                let corner = [q[k], q[(k + 1) % 4], q[(k + 3) % 4]];
                let [at, next, previous] = corner.map(|v| sites[v as usize].at);
                let [a, b] = [k, k + 1].map(|side| sides[side % 2].recip());
                let (u, v) = (scale(sub(next, at), a), scale(sub(previous, at), b));
                let (value, along_u, along_v) = corner_energy(u, v, normal, self.eps);
                let (out, back) = (scale(along_u, a), scale(along_v, b));
                slope(corner[1], out);
                slope(corner[2], back);
                slope(corner[0], scale(add(out, back), -1.0));
                sum += value;
            }
        }
        sum
    }

    fn tethers(&self, sites: &[Site], slope: &mut impl FnMut(u32, Point)) -> f64 {
        let mut sum = 0.0;
        for tether in &self.patch.tethers {
            let (half, distance) = tether.nearest(sites);
            let square = tether.radius * tether.radius;
            let left = square - distance * distance;
            // Zero on the quads, or less by a rounding.
            if distance <= 0.0 {
                continue;
            }
            if left <= 0.0 {
                return f64::INFINITY;
            }
            sum += distance * distance / left;
            let corners = half.map(|v| sites[v as usize].at);
            let (point, weights) = nearest_in_triangle(tether.home, corners);
            let away = scale(sub(point, tether.home), 2.0 * square / (left * left));
            half.iter().zip(weights).for_each(|(&v, weight)| slope(v, scale(away, weight)));
        }
        sum
    }

    fn curve_edges(&self, sites: &[Site], slope: &mut impl FnMut(u32, Point)) -> f64 {
        let mut sum = 0.0;
        for edge in &self.patch.curve_edges {
            let [from, to] = edge.ends.map(|v| sites[v as usize].at);
            let along = scale(sub(to, from), edge.length.recip());
            let square = dot(along, along) + SMALL_SQUARE;
            sum += EVEN_WEIGHT * (square + square.recip() - 2.0);
            let by_square = EVEN_WEIGHT * (1.0 - (square * square).recip());
            let by_end = scale(along, 2.0 * by_square / edge.length);
            slope(edge.ends[1], by_end);
            slope(edge.ends[0], scale(by_end, -1.0));
        }
        sum
    }

    fn pull(&self, sites: &[Site], slope: &mut impl FnMut(u32, Point)) -> f64 {
        let mut sum = 0.0;
        for &(quad, pull) in &self.pulls {
            for v in self.patch.quads[quad] {
                let moved = sub(sites[v as usize].at, self.patch.sites[v as usize].at);
                sum -= dot(pull, moved);
                slope(v, scale(pull, -1.0));
            }
        }
        sum
    }
}

/// The energy of a corner, and its derivatives by the two edges.
fn corner_energy(u: Point, v: Point, normal: Point, eps: f64) -> (f64, Point, Point) {
    let determinant = dot(normal, cross(u, v));
    let root = eps.hypot(determinant);
    let chi = match determinant >= 0.0 {
        true => 0.5 * (determinant + root),
        false => 0.5 * eps * eps / (root - determinant),
    };
    let (uu, vv) = (dot(u, u) + SMALL_SQUARE, dot(v, v) + SMALL_SQUARE);
    let lengths = (uu * vv).sqrt();
    let ratio = (lengths + 0.5 * AREA_WEIGHT * (determinant * determinant + 1.0)) / chi;
    let power = ratio.powi(POWER - 1);
    let by_lengths = f64::from(POWER) * power / chi;
    let by_determinant = by_lengths * (AREA_WEIGHT * determinant - ratio * chi / root);
    (
        power * ratio,
        add(scale(u, by_lengths * lengths / uu), scale(cross(v, normal), by_determinant)),
        add(scale(v, by_lengths * lengths / vv), scale(cross(normal, u), by_determinant)),
    )
}

/// The unit normal along which a quad's corners are judged: half way between its own and the surface's where these
/// agree, since over a crease or a tip the surface's alone says little.
fn direction(corners: [Site; 4]) -> Point {
    let mean = scale(corners.map(|site| site.normal).into_iter().fold([0.0; 3], add), 0.25);
    let own = unit(vector_area(&corners.map(|site| site.at))).unwrap_or_default();
    let surface = unit(mean).unwrap_or_default();
    let sum = match dot(own, mean) > 0.0 {
        true => add(surface, own),
        // The less the normals agree, the less they say of where the quad should face.
        false => add(mean, scale(own, (1.0 - dot(mean, mean).sqrt()).max(0.0).powi(2))),
    };
    unit(sum).unwrap_or(surface)
}

/// Of a bent quad, the unit direction to where its corners see one side of the surface: along its own normal if the
/// surface's normals at its corners spread out, as over a thin sheet, and against it if they face each other.
fn outward(corners: [Site; 4]) -> Option<Point> {
    let (points, normals) = (corners.map(|site| site.at), corners.map(|site| site.normal));
    if Orientation::of_polygon(&points, &normals).bent == 0 {
        return None;
    }
    let pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let spread = pairs.map(|[i, j]| dot(sub(normals[i], normals[j]), sub(points[i], points[j])));
    Some(scale(unit(vector_area(&points))?, spread.iter().sum::<f64>().signum()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn site(at: Point, normal: Point) -> Site {
        Site { at, normal }
    }

    #[test]
    fn corners_by_hand() {
        let up = [0.0, 0.0, 1.0];
        let (value, along_u, along_v) = corner_energy([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], up, 1e-9);
        assert!((value - (1.0f64 + AREA_WEIGHT).powi(POWER)).abs() < 1e-2, "{value}");
        // A square is at rest.
        assert!(along_u.iter().chain(&along_v).all(|x| x.abs() < 1e-2), "{along_u:?} {along_v:?}");
        let (sharp, ..) = corner_energy([1.0, 0.0, 0.0], [1.0, 0.01, 0.0], up, 1e-9);
        let (inverted, ..) = corner_energy([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], up, 0.1);
        assert!(sharp > 1e7 && inverted.is_finite() && inverted > 1e7);
    }

    #[test]
    fn derivatives_of_corners_are_those_of_differences() {
        let normal = unit([0.3, -0.2, 1.0]).unwrap();
        let step = 1e-6;
        for (u, v, eps) in [
            ([1.0, 0.2, 0.1], [-0.3, 0.8, 0.0], 0.1),
            ([0.4, 0.9, -0.2], [1.1, 0.1, 0.3], 0.5),
            ([0.1, 0.0, 0.0], [0.0, 0.0, 0.2], 0.25),
        ] {
            let (value, along_u, along_v) = corner_energy(u, v, normal, eps);
            for k in 0..3 {
                let moved =
                    |p: Point, by: f64| [0, 1, 2].map(|i| p[i] + if i == k { by } else { 0.0 });
                let slope = |f: &dyn Fn(f64) -> f64| (f(step) - f(-step)) / (2.0 * step);
                let by_u = slope(&|by| corner_energy(moved(u, by), v, normal, eps).0);
                let by_v = slope(&|by| corner_energy(u, moved(v, by), normal, eps).0);
                for (difference, exact) in [(by_u, along_u[k]), (by_v, along_v[k])] {
                    assert!(
                        (difference - exact).abs() < 1e-5 * (1.0 + value),
                        "{difference} {exact}"
                    );
                }
            }
        }
    }

    #[test]
    fn quads_over_sheets_are_drawn_out_and_those_in_slots_in() {
        let square = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.1], [0.0, 0.0, 0.1]];
        let (up, down) = ([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
        let corners = |normals: [Point; 4]| [0, 1, 2, 3].map(|k| site(square[k], normals[k]));
        assert_eq!(outward(corners([down, down, up, up])), Some([1.0, 0.0, 0.0]));
        assert_eq!(outward(corners([up, up, down, down])), Some([-1.0, 0.0, 0.0]));
        assert_eq!(outward(corners([[1.0, 0.0, 0.0]; 4])), None);
    }
}
