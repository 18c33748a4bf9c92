//! What can be wrong with a map or a quad mesh, as data that others put into words, and how far from exact a map may be.

use std::fmt;

/// One reason why a map is not a seamless map, naming its element (ids from 0).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[allow(missing_docs, reason = "kinds say what their fields are")]
pub enum Violation {
    /// The map has another number of vertices than the source.
    VertexCount { source_count: usize, map: usize },
    /// The map has another number of faces than the source.
    FaceCount { source_count: usize, map: usize },
    /// A vertex was moved, by a distance in mesh units.
    MovedVertex { vertex: u32, distance: f64 },
    /// A face has other vertices, or the same in another order.
    ChangedFace { face: u32 },
    /// The number of UVs does not fit the faces: three of each.
    UvCount { expected: usize, found: usize },
    /// A UV is not finite.
    NonFiniteUv { face: u32 },
    /// A triangle of negative orientation.
    FlippedTriangle { face: u32 },
    /// A triangle without area.
    CollapsedTriangle { face: u32 },
    /// The two images of an edge do not differ by a quarter turn and a translation. The mismatch is in lengths of the edge,
    /// of the longer of its two images. Faces are those on the left and on the right.
    OpenSeam { vertices: [u32; 2], faces: [u32; 2], residual: f64 },
    /// An interior angle sum that is not a positive multiple of a quarter turn.
    ConeAngle { vertex: u32, quarters: f64 },
    /// The two images of an edge differ in the last bits from a quarter turn and a translation.
    InexactEdge { vertices: [u32; 2], faces: [u32; 2] },
    /// A translation across an edge, from left to right, is not integral.
    FractionalTranslation { vertices: [u32; 2], faces: [u32; 2], translation: [f64; 2] },
    /// A cone is not at a grid point in one of its faces.
    FractionalCone { vertex: u32, uv: [f64; 2] },
    /// A vertex at which aligned edges turn is not at a grid point in one of its faces.
    FractionalCorner { vertex: u32, uv: [f64; 2] },
    /// The image of an aligned edge, in the face on one side, does not lie on an isoline at an integer.
    OffIsoline { vertices: [u32; 2], face: u32 },
    /// The indices of a component (in order of first faces) do not add up to four times its Euler characteristic.
    PoincareHopf { component: usize, sum: f64, expected: i64 },
    /// A pair of vertices that should name an aligned edge does not.
    NotAnEdge { vertices: [u32; 2] },
    /// The image of an aligned edge, in the face on one side, is not parallel to an axis.
    OffAxis { vertices: [u32; 2], face: u32, degrees: f64 },
    /// The angle between two aligned edges is not a positive multiple of a quarter turn. They are named by their other ends,
    /// counter-clockwise: the same vertex for the full turn at the end of a single edge.
    SectorAngle { vertex: u32, between: [u32; 2], quarters: f64 },
    /// A face names a vertex that is not there, or one twice.
    BadFace { face: u32 },
    /// More than two faces share an edge, or two run along it in the same direction.
    RepeatedEdge { vertices: [u32; 2] },
    /// The faces around a vertex do not form one fan.
    SplitVertex { vertex: u32 },
    /// A quad joins points of several components of the surface.
    StrayQuad { quad: u32 },
    /// The quads of a component of the surface are not in one piece.
    QuadPieces { component: usize, pieces: usize },
    /// The quads of a component of the surface have another Euler characteristic.
    QuadTopology { component: usize, quads: i64, surface: i64 },
    /// Of a component of the surface and its quads, only one is closed.
    QuadBoundary { component: usize },
    /// The irregular vertices of quads are not the cones of their map: so many off the boundary have an index, in quarters.
    QuadIndex { index: i32, irregular: usize, cones: usize },
    /// The number of quads is not the area of their map, in grid units.
    QuadCount { quads: usize, area: f64 },
}

/// What was found, or everything that is wrong.
pub type Checked<T> = Result<T, Violations>;

/// All violations found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Violations(pub Vec<Violation>);

impl Violations {
    /// An error with these, if there is any.
    pub(crate) fn unless_none(found: impl IntoIterator<Item = Violation>) -> Checked<()> {
        let found: Vec<_> = found.into_iter().collect();
        if found.is_empty() { Ok(()) } else { Err(Self(found)) }
    }
}

impl fmt::Display for Violations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl std::error::Error for Violations {}

/// How far rounding may take a map from exactness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Seam mismatch, in lengths of the edge. The rounding of the coordinates of its own four ends is
    /// allowed on top, but never more than the largest in all.
    pub seams: f64,
    /// Angle between the image of an aligned edge and the nearer axis, degrees.
    pub axes: f64,
    /// How far from an integer may be what has to be integral, grid units: nothing by default. Then integers are integers,
    /// and the two images of an edge fit to the last bit.
    pub integers: f64,
}

impl Tolerance {
    /// The most that can be allowed. More is refused, whatever the tolerance.
    ///
    /// Seams: at a hundredth the two images of an edge still agree in two digits, and every crossing of a seam
    /// turns by half a degree from a quarter turn at most, so that matchings and the angle sums of all
    /// vertices with fewer than 80 faces stay unambiguous. Coordinates of four digits on a layout of
    /// fifty edges are that good. What is open by more is a gap, not a rounding error.
    ///
    /// Axes: at one degree the ends of the edge are apart by 1.7 % of its length, about as much.
    ///
    /// Integers: a hundredth of a cell, as much as a seam may be open by. A number that has nothing to do with integers is
    /// that close to one in one of 50 cases, and no map is without a dozen of them.
    pub const LARGEST: Self = Self { seams: 0.01, axes: 1.0, integers: 0.01 };

    /// That of seams in lengths of the edge, and of axes in keeping: what may be off an edge by a part of its length may turn
    /// it as much.
    pub fn of_seams(seams: f64) -> Self {
        let axes = seams.to_degrees().clamp(Self::default().axes, Self::LARGEST.axes);
        Self { seams, axes, ..Self::default() }
    }

    /// Whether figures are within a tolerance and its ceiling, by which of the numbers; what is no number is not.
    pub(crate) fn allows(&self, figure: f64, number: impl Fn(&Self) -> f64) -> bool {
        figure <= number(self) && figure <= number(&Self::LARGEST)
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { seams: 1e-9, axes: 1e-9, integers: 0.0 }
    }
}

/// Largest error of the angle around a vertex or between two aligned edges, radians. A wrong angle is off by a quarter
/// turn; needles lose digits.
pub(crate) const ANGLE: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alignment_allows_what_seams_do() {
        let of = |seams| Tolerance::of_seams(seams).axes;
        assert_eq!((of(0.0), of(1e-3), of(1.0)), (1e-9, 1e-3f64.to_degrees(), 1.0));
        assert_eq!(Tolerance::default(), Tolerance { axes: 1e-9, ..Tolerance::of_seams(1e-9) });
    }

    #[test]
    fn tolerances_have_a_ceiling() {
        let allows = |seams, figure| Tolerance::of_seams(seams).allows(figure, |t| t.seams);
        assert!(allows(1e-9, 1e-9) && !allows(1e-9, 1.1e-9));
        assert!(allows(0.01, 0.01) && !allows(10.0, 0.011) && allows(10.0, 0.01));
        assert!(!allows(f64::NAN, 0.0) && !allows(-1.0, 0.0) && !allows(1e-9, f64::NAN));
    }
}
