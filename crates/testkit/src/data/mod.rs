//! The small meshes of `tests/data`: made here, so that everyone may have them.

pub(crate) mod implicit;
pub(crate) mod planar;
mod shapes;

use seamstress_mesh::soup::{TriangleSoup, triangulate};
use std::fmt::Write as _;

/// Coordinates are multiples of this, far above what the libraries of two systems differ by.
const GRAIN: f64 = 1e-5;

/// Positions and polygons, counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PolygonSoup {
    /// One per vertex.
    pub positions: Vec<[f64; 3]>,
    /// Three corners or more each.
    pub polygons: Vec<Vec<u32>>,
}

impl PolygonSoup {
    /// The polygons split into triangles.
    #[must_use]
    pub fn triangles(&self) -> TriangleSoup {
        let polygons = self.polygons.iter().map(Vec::as_slice);
        let faces = triangulate(&self.positions, polygons).unwrap().faces;
        TriangleSoup { positions: self.positions.clone(), faces }
    }

    fn rounded(mut self) -> Self {
        for x in self.positions.iter_mut().flatten() {
            // Adding zero makes a negative zero positive.
            *x = (*x / GRAIN).round() / (1.0 / GRAIN).round() + 0.0;
        }
        self
    }
}

/// A mesh of `tests/data` and what must be true of it.
#[derive(Debug, Clone)]
pub struct DataMesh {
    /// Name of the file; its ending is the format.
    pub file: &'static str,
    /// What it is there for.
    pub kind: &'static str,
    /// The mesh.
    pub soup: PolygonSoup,
    /// Number of components.
    pub components: usize,
    /// Handles of all components.
    pub genus: usize,
    /// Boundary loops of all components.
    pub boundary_loops: usize,
}

impl DataMesh {
    /// Euler characteristic, from components, handles and boundary loops.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        2 * self.components as i64 - 2 * self.genus as i64 - self.boundary_loops as i64
    }

    /// The content of the file.
    #[must_use]
    pub fn text(&self) -> String {
        match self.file.rsplit('.').next() {
            Some("obj") => obj(&self.soup),
            Some("off") => off(&self.soup),
            Some("ply") => ply(&self.soup),
            Some("stl") => stl(&self.soup.triangles()),
            _ => panic!("{} has an unknown format", self.file),
        }
    }
}

/// All meshes of `tests/data`.
#[must_use]
pub fn data_meshes() -> Vec<DataMesh> {
    let mesh = |file, kind, soup: PolygonSoup, [components, genus, boundary_loops]: [usize; 3]| {
        DataMesh { file, kind, soup: soup.rounded(), components, genus, boundary_loops }
    };
    vec![
        mesh("plate_with_holes.obj", "CAD: holes", shapes::plate_with_holes(), [1, 4, 0]),
        mesh("gear.obj", "CAD: many sharp corners", shapes::gear(), [1, 1, 0]),
        mesh("l_beam.stl", "CAD: planes, a concave edge", shapes::l_beam(), [1, 0, 0]),
        mesh("angle_bracket.obj", "CAD: bent sheet metal", shapes::angle_bracket(), [1, 3, 0]),
        mesh("shell.obj", "open, three rims", shapes::shell(), [1, 0, 3]),
        mesh("thin_plate.obj", "two sides close together", shapes::thin_plate(), [1, 1, 0]),
        mesh("needles.obj", "needles", shapes::needles(), [1, 0, 0]),
        mesh("trefoil.ply", "a knotted handle", shapes::trefoil(), [1, 1, 0]),
        mesh("linked_rings.off", "four components", shapes::linked_rings(), [4, 2, 1]),
        mesh("blob.obj", "organic, no symmetry", shapes::blob(), [1, 0, 0]),
        mesh("cube_frame.off", "high genus", shapes::cube_frame(), [1, 5, 0]),
        mesh("goldberg.obj", "pentagons and hexagons", shapes::goldberg(), [1, 0, 0]),
    ]
}

fn obj(soup: &PolygonSoup) -> String {
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for polygon in &soup.polygons {
        writeln!(text, "f{}", joined(polygon, 1)).unwrap();
    }
    text
}

fn off(soup: &PolygonSoup) -> String {
    let mut text = format!("OFF\n{} {} 0\n", soup.positions.len(), soup.polygons.len());
    text.push_str(&lists(soup));
    text
}

fn ply(soup: &PolygonSoup) -> String {
    let coordinates = ["x", "y", "z"].map(|name| format!("property double {name}\n")).concat();
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\n{coordinates}element face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        soup.positions.len(),
        soup.polygons.len()
    );
    text.push_str(&lists(soup));
    text
}

/// Positions, then polygons after their lengths, a line each.
fn lists(soup: &PolygonSoup) -> String {
    let mut text = String::new();
    for [x, y, z] in &soup.positions {
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    for polygon in &soup.polygons {
        writeln!(text, "{}{}", polygon.len(), joined(polygon, 0)).unwrap();
    }
    text
}

fn stl(soup: &TriangleSoup) -> String {
    let mut text = "solid mesh\n".to_owned();
    for face in &soup.faces {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in face.map(|v| soup.positions[v as usize]) {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid mesh\n"
}

fn joined(polygon: &[u32], first: u32) -> String {
    polygon.iter().map(|v| format!(" {}", v + first)).collect()
}
