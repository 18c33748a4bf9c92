//! Where the vertices of a quad mesh may go on a surface.

use crate::QuadConnectivity;
use crate::curve::Curve;
use crate::surface::Surface;
use crate::vector::Point;

/// Vertices that may not go everywhere on the surface. Those on the boundary of the quads that are on no curve stay
/// where they are, too.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Constraints {
    /// Vertices that stay where they are, whatever else is said of them.
    pub fixed: Vec<u32>,
    /// Vertices that slide along curves.
    pub curves: Vec<SlideCurve>,
    /// The sizes that quads are to have at the vertices, as multiples of one length; nothing if all are alike.
    pub sizes: Vec<f64>,
}

impl Constraints {
    /// The size at a vertex.
    pub(crate) fn size(&self, v: u32) -> f64 {
        self.sizes.get(v as usize).copied().unwrap_or(1.0)
    }
}

/// A curve on a surface, such as a feature, and the vertices that do not leave it.
#[derive(Debug, Clone, PartialEq)]
pub struct SlideCurve {
    /// The corners of the curve in order; of a closed one, the first comes again. Without two, the vertices are fixed.
    pub points: Vec<[f64; 3]>,
    /// The sizes that quads are to have at these; nothing if all are alike.
    pub sizes: Vec<f64>,
    /// The vertices of the quad mesh on it, in any order; also those at its ends, which may be fixed.
    pub vertices: Vec<u32>,
}

/// A surface, and where on it each vertex may go.
pub(crate) struct Domain {
    surface: Surface,
    curves: Vec<Curve>,
    places: Vec<Place>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Anywhere,
    OnCurve(u32),
    Fixed,
}

impl Domain {
    pub(crate) fn new(
        surface: Surface,
        connectivity: &QuadConnectivity,
        n_vertices: usize,
        constraints: &Constraints,
    ) -> Self {
        let unconstrained = |v: u32| match connectivity.is_boundary(v) {
            true => Place::Fixed,
            false => Place::Anywhere,
        };
        let mut places: Vec<Place> = (0..n_vertices as u32).map(unconstrained).collect();
        let mut put = |v: u32, at: Place| {
            if let Some(place) = places.get_mut(v as usize) {
                *place = at;
            }
        };
        let mut curves = Vec::new();
        for curve in &constraints.curves {
            let mut place = Place::Fixed;
            if let Some(curve) = Curve::new(&curve.points, &curve.sizes) {
                place = Place::OnCurve(curves.len() as u32);
                curves.push(curve);
            }
            curve.vertices.iter().for_each(|&v| put(v, place));
        }
        let unused = (0..n_vertices as u32).filter(|&v| connectivity.valence(v) == 0);
        constraints.fixed.iter().copied().chain(unused).for_each(|v| put(v, Place::Fixed));
        Self { surface, curves, places }
    }

    pub(crate) fn is_fixed(&self, v: u32) -> bool {
        self.places[v as usize] == Place::Fixed
    }

    /// Whether a vertex may go everywhere on the surface.
    pub(crate) fn is_free(&self, v: u32) -> bool {
        self.places[v as usize] == Place::Anywhere
    }

    /// The point nearest to a target among those where a vertex may be, and the unit normal of the surface there; of
    /// fixed ones, on the surface.
    pub(crate) fn place(&self, v: u32, target: Point) -> (Point, Point) {
        let Place::OnCurve(curve) = self.places[v as usize] else {
            return self.surface.nearest(target);
        };
        let at = self.curves[curve as usize].nearest(target);
        (at, self.surface.normal(at))
    }

    /// The unit normal of the surface at a point of it.
    pub(crate) fn normal(&self, at: Point) -> Point {
        self.surface.normal(at)
    }
}
