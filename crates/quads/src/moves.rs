//! Moves of single vertices that are taken back if they do harm.

use crate::QuadConnectivity;
use crate::badness;
use crate::quality::Orientation;
use crate::vector::{Point, norm, sub};

/// How bad quads may become, even if they were better.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fair {
    /// Cosine of a corner, see [`badness`].
    pub(crate) corner: f64,
    /// The longest side of a quad by its shortest.
    pub(crate) thinness: f64,
}

/// Quads whose vertices move one by one.
pub(crate) struct Moves<'a> {
    connectivity: &'a QuadConnectivity,
    quads: &'a [[u32; 4]],
    pub(crate) positions: Vec<Point>,
    /// Of the surface, where the vertices are.
    normals: Vec<Point>,
}

impl<'a> Moves<'a> {
    pub(crate) fn new(
        connectivity: &'a QuadConnectivity,
        quads: &'a [[u32; 4]],
        positions: Vec<Point>,
        normals: Vec<Point>,
    ) -> Self {
        Self { connectivity, quads, positions, normals }
    }

    /// Moves a vertex, with the normal there, unless more of its quads become inverted or crossed, or the worst of
    /// their corners or the thinnest of them worse than it is and than what is fair.
    pub(crate) fn try_move(&mut self, v: u32, to: (Point, Point), fair: Fair) -> bool {
        let before = self.around(v);
        let from = self.put(v, to);
        let after = self.around(v);
        let does_no_harm = after.faults <= before.faults
            && after.corner <= before.corner.max(fair.corner)
            && after.thinness <= before.thinness.max(fair.thinness);
        if !does_no_harm {
            self.put(v, from);
        }
        does_no_harm
    }

    /// Puts a vertex somewhere; from where, is returned.
    fn put(&mut self, v: u32, (at, normal): (Point, Point)) -> (Point, Point) {
        let from = std::mem::replace(&mut self.positions[v as usize], at);
        (from, std::mem::replace(&mut self.normals[v as usize], normal))
    }

    fn around(&self, v: u32) -> Around {
        let quads = self.connectivity.outgoing(v).map(|h| self.quads[(h / 4) as usize]);
        quads.fold(Around { faults: 0, corner: 0.0, thinness: 0.0 }, |worst, quad| {
            let points = quad.map(|v| self.positions[v as usize]);
            let normals = quad.map(|v| self.normals[v as usize]);
            let corners = badness::on_surface(points, normals);
            Around {
                faults: worst.faults + Orientation::of_polygon(&points, &normals).faults(),
                corner: corners.into_iter().fold(worst.corner, f64::max),
                thinness: thinness(points).max(worst.thinness),
            }
        })
    }
}

/// The quads around a vertex.
struct Around {
    /// How many are inverted or crossed.
    faults: usize,
    /// Badness of the worst corner.
    corner: f64,
    /// Of the thinnest.
    thinness: f64,
}

/// How much longer the longest side of a quad is than the shortest.
fn thinness(quad: [Point; 4]) -> f64 {
    let sides = [0, 1, 2, 3].map(|k| norm(sub(quad[(k + 1) % 4], quad[k])));
    let longest = sides.into_iter().fold(0.0, f64::max);
    longest / sides.into_iter().fold(f64::INFINITY, f64::min).max(f64::MIN_POSITIVE)
}
