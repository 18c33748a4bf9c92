//! Planes of symmetry: which are asked for, and how far a surface is from them.

use crate::as_text::as_text;
use crate::error::{Error, ErrorKind, Stage};
use crate::surface::Surface;
use crate::words::rounded;
use seamstress_mesh::symmetry::{Mirror, images};
use seamstress_quads::extract::SurfacePoint;
use seamstress_quads::locate;
use serde::Serialize;
use std::fmt;
use std::str::FromStr;

/// Planes at which quads are to be symmetric: `none`, `auto`, axes such as `x` or `xz`, or `plane:NX,NY,NZ,D`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub enum Symmetry {
    /// None.
    #[default]
    None,
    /// Those across axes at which the surface is symmetric.
    Auto,
    /// Those across these axes, through the origin or the middle of the surface.
    Axes([bool; 3]),
    /// The plane of the points whose product with a normal is an offset. The side of the normal is made, and mirrored.
    Plane {
        /// The normal, of any length but zero.
        normal: [f64; 3],
        /// The offset, in lengths of the normal.
        offset: f64,
    },
}

/// What made quads symmetric.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SymmetryReport {
    /// The planes.
    pub planes: Vec<SymmetryPlane>,
    /// Triangles of the surface that cross a plane, and were split there.
    pub split_triangles: usize,
    /// Triangles of the side that was made and mirrored; features, components and distortion are those of this side.
    pub side_triangles: usize,
}

/// A plane of symmetry of a surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SymmetryPlane {
    /// Its unit normal, towards the side that was made.
    pub normal: [f64; 3],
    /// The product of its points with the normal, mesh units.
    pub offset: f64,
    /// How far the image of the surface is from the surface at most, mesh units.
    pub error: f64,
    /// Whether the polygons are symmetric, too, and not only the shape; then the error is that of the vertices.
    pub of_polygons: bool,
}

const NAMES: [char; 3] = ['x', 'y', 'z'];
const EXPECTED: &str = "expected none, auto, axes such as x or xz, or plane:NX,NY,NZ,D";

impl Symmetry {
    /// Refuses planes where no side can be made.
    pub(crate) fn refuse(self) -> Result<(), Error> {
        match self {
            Self::None => Ok(()),
            _ => {
                Err(Error::options("symmetry: only maps and quads of a mesh can be made symmetric"))
            }
        }
    }
}

impl FromStr for Symmetry {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if let Some(plane) = text.strip_prefix("plane:") {
            let numbers: Result<Vec<f64>, _> = plane.split(',').map(str::parse).collect();
            let [x, y, z, offset] = numbers.unwrap_or_default()[..] else { return Err(EXPECTED) };
            let normal = [x, y, z];
            return Mirror::new(normal, offset)
                .map(|_| Self::Plane { normal, offset })
                .ok_or(EXPECTED);
        }
        match text {
            "none" => Ok(Self::None),
            "auto" => Ok(Self::Auto),
            "" => Err(EXPECTED),
            axes => {
                let mut is_chosen = [false; 3];
                for axis in axes.chars() {
                    let k = NAMES.iter().position(|&name| name == axis).ok_or(EXPECTED)?;
                    is_chosen[k] = true;
                }
                Ok(Self::Axes(is_chosen))
            }
        }
    }
}

impl fmt::Display for Symmetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Auto => f.write_str("auto"),
            Self::Axes([false, false, false]) => f.write_str("none"),
            Self::Axes(axes) => {
                let chosen = NAMES.iter().zip(axes).filter(|(_, is_chosen)| **is_chosen);
                f.write_str(&chosen.map(|(name, _)| name).collect::<String>())
            }
            Self::Plane { normal: [x, y, z], offset } => write!(f, "plane:{x},{y},{z},{offset}"),
        }
    }
}

as_text!(Symmetry, "none, auto, axes such as x or xz, or plane:NX,NY,NZ,D");

impl fmt::Display for SymmetryPlane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = self.normal.iter().position(|&x| x == 1.0);
        match axis {
            Some(k) => write!(f, "{} = {}", NAMES[k], rounded(self.offset)),
            None => {
                let [x, y, z] = self.normal.map(rounded);
                write!(f, "({x}, {y}, {z}) p = {}", rounded(self.offset))
            }
        }
    }
}

/// How far the image of a surface may be from the surface, as a share of the diagonal of its bounding box.
const TOLERANCE: f64 = 1e-3;
/// How near to a plane vertices are on it, as such a share.
const ON_PLANE: f64 = 1e-6;
/// How much of the area may lie in the plane: folds between quads that have three vertices there. They are left out.
const IN_PLANE: f64 = 1e-3;

/// A plane at which a surface is symmetric.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub(crate) mirror: Mirror,
    error: f64,
    /// The vertex at the image of each vertex, if the polygons are symmetric.
    pub(crate) images: Option<Vec<u32>>,
}

impl Found {
    pub(crate) fn report(&self) -> SymmetryPlane {
        SymmetryPlane {
            normal: self.mirror.normal(),
            offset: self.mirror.offset(),
            error: self.error,
            of_polygons: self.images.is_some(),
        }
    }
}

impl Surface {
    /// The planes at which the surface is to be symmetric.
    ///
    /// # Errors
    /// [`ErrorKind::NotSymmetric`] where it is not, with how far it is from it.
    pub(crate) fn symmetry_planes(&self, symmetry: Symmetry) -> Result<Vec<Found>, Error> {
        let axes = |is_chosen: [bool; 3]| {
            (0..3).filter(move |&axis| is_chosen[axis]).map(|axis| self.plane_across(axis))
        };
        match symmetry {
            Symmetry::None => Ok(Vec::new()),
            Symmetry::Auto => {
                Ok(axes([true; 3]).filter(|found| self.is_symmetric(found)).collect())
            }
            Symmetry::Axes(chosen) => axes(chosen).map(|found| self.required(found)).collect(),
            Symmetry::Plane { normal, offset } => {
                let mirror = Mirror::new(normal, offset).ok_or_else(|| {
                    Error::options("symmetry: the normal of a plane is no direction")
                })?;
                Ok(vec![self.required(self.measured(mirror))?])
            }
        }
    }

    fn required(&self, found: Found) -> Result<Found, Error> {
        if self.is_symmetric(&found) {
            return Ok(found);
        }
        let (plane, error) = (found.report(), found.error);
        let text = match error <= self.symmetry_tolerance() {
            true => format!(
                "the surface has triangles in the plane {plane}, which has no two sides there"
            ),
            false => format!(
                "the surface is not symmetric at the plane {plane}: its image is off by {}, {:.2} % of its diagonal; \
                 at most {} % is taken",
                rounded(error),
                100.0 * error / self.diagonal(),
                100.0 * TOLERANCE,
            ),
        };
        Err(Error::new(ErrorKind::NotSymmetric, text)
            .at_stage(Some(Stage::Check))
            .with_hint("`symmetry none` makes quads that need not be symmetric"))
    }

    fn is_symmetric(&self, found: &Found) -> bool {
        let positions = self.settled_on(std::slice::from_ref(found));
        let is_on = |&v: &u32| found.mirror.height(positions[v as usize]).abs() <= self.on_plane();
        let areas = self.faces().iter().zip(self.metric().area.iter());
        let in_plane = areas.filter(|(face, _)| face.iter().all(is_on)).map(|(_, area)| area);
        found.error <= self.symmetry_tolerance()
            && in_plane.sum::<f64>() <= IN_PLANE * self.metric().total_area()
    }

    /// The plane across an axis through the origin, or through the middle of the surface if it is nearer to that.
    fn plane_across(&self, axis: usize) -> Found {
        let [low, high] = self.bounds().map(|corner| corner[axis]);
        let at_origin = self.measured(Mirror::across(axis, 0.0));
        let middle = 0.5 * (low + high);
        if middle.abs() <= ON_PLANE * self.diagonal() {
            return at_origin;
        }
        let in_middle = self.measured(Mirror::across(axis, middle));
        match in_middle.error + ON_PLANE * self.diagonal() < at_origin.error {
            true => in_middle,
            false => at_origin,
        }
    }

    /// How far the surface is from its image across a plane.
    fn measured(&self, mirror: Mirror) -> Found {
        let tolerance = self.symmetry_tolerance();
        match images(self.positions(), self.faces(), &self.parts().face_origin, &mirror, tolerance)
        {
            Some(found) => Found { mirror, error: found.error, images: Some(found.of) },
            None => Found { mirror, error: self.distance_of_image(&mirror), images: None },
        }
    }

    /// The largest distance from the surface of the images of its vertices and of the centres of its triangles.
    fn distance_of_image(&self, mirror: &Mirror) -> f64 {
        let (positions, faces) = (self.positions(), self.faces());
        let centre = |face: &[u32; 3]| {
            let corners = face.map(|v| positions[v as usize]);
            [0, 1, 2].map(|k| corners.iter().map(|p| p[k] / 3.0).sum())
        };
        let points = positions.iter().copied().chain(faces.iter().map(centre));
        let images: Vec<[f64; 3]> = points.map(|p| mirror.image(p)).collect();
        let Ok(nearest) = locate(positions, faces, images.iter().copied()) else {
            return f64::INFINITY;
        };
        let distance = |(place, image): (&SurfacePoint, &[f64; 3])| {
            let at = place.position(positions, faces);
            (0..3).map(|k| at[k] - image[k]).fold(0.0, f64::hypot)
        };
        nearest.iter().zip(&images).map(distance).fold(0.0, f64::max)
    }

    /// The positions of the vertices, with those that lie on planes but for noise put there.
    pub(crate) fn settled_on(&self, planes: &[Found]) -> Vec<[f64; 3]> {
        let mut positions = self.positions().to_vec();
        for found in planes {
            for (v, p) in positions.iter_mut().enumerate() {
                let is_image = |images: &Vec<u32>| images[images[v] as usize] == images[v];
                if found.mirror.height(*p).abs() <= self.on_plane()
                    || found.images.as_ref().is_some_and(is_image)
                {
                    *p = found.mirror.onto(*p);
                }
            }
        }
        positions
    }

    /// How far the image of the surface may be from the surface, mesh units.
    pub(crate) fn symmetry_tolerance(&self) -> f64 {
        TOLERANCE * self.diagonal()
    }

    /// How near to a plane vertices are on it, mesh units.
    pub(crate) fn on_plane(&self) -> f64 {
        ON_PLANE * self.diagonal()
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        self.report().bounding_box.unwrap_or_default()
    }

    fn diagonal(&self) -> f64 {
        let [low, high] = self.bounds();
        (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::hypot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit::{bumpy, cube, stretch, subdivide};

    #[test]
    fn names_are_read_and_written_alike() {
        for text in ["none", "auto", "x", "xz", "xyz", "plane:0,0.5,1,-2"] {
            assert_eq!(text.parse::<Symmetry>().unwrap().to_string(), text);
        }
        for text in ["", "w", "xa", "plane:", "plane:1,0,0", "plane:0,0,0,1", "plane:1,0,nan,0"] {
            assert!(text.parse::<Symmetry>().is_err(), "{text}");
        }
    }

    #[test]
    fn planes_are_found_where_the_surface_is_symmetric() {
        let shape = subdivide(&cube());
        let moved: Vec<[f64; 3]> =
            shape.positions.iter().map(|&[x, y, z]| [x + 3.0, y, z + 0.4 * y]).collect();
        let surface = Surface::from_triangles(&moved, &shape.faces).unwrap();
        let found = surface.symmetry_planes(Symmetry::Auto).unwrap();
        let names: Vec<String> = found.iter().map(|found| found.report().to_string()).collect();
        assert_eq!(names.len(), 1, "{names:?}");
        assert!(names[0].starts_with("x = "), "{names:?}");
        // A sheared cube is far from symmetric at the others.
        let error = surface.symmetry_planes(Symmetry::Axes([false, true, false])).unwrap_err();
        assert_eq!(error.code(), "not-symmetric");
        assert!(error.message().contains("% of its diagonal"), "{error}");
    }

    #[test]
    fn noise_is_measured_and_tolerated_up_to_a_bound() {
        let block = stretch(&subdivide(&subdivide(&cube())), [1.0, 2.0, 3.0]);
        for (noise, is_symmetric) in [(1e-4, true), (0.1, false)] {
            let noisy = bumpy(&block, noise, 5);
            let surface = Surface::from_triangles(&noisy.positions, &noisy.faces).unwrap();
            let found = surface.symmetry_planes(Symmetry::Axes([true, false, false]));
            assert_eq!(found.is_ok(), is_symmetric, "{noise}");
        }
    }
}
