//! Listing everything that keeps a soup from being an oriented manifold.

use super::connectivity::{Connectivity, Side, twins};
use super::fault::{Fault, Severity};
use super::geometry::{is_finite, shape};
use super::topology::Topology;
use super::{Facts, MAX_FACES, MAX_VERTICES, TriangleSoup};

/// What [`check`] found.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// All faults, in the order of the variants of [`Fault`] and then by element.
    pub faults: Vec<Fault>,
    /// Counts and measures.
    pub facts: Facts,
}

impl Report {
    /// The faults that keep the soup from being a mesh.
    pub fn errors(&self) -> impl Iterator<Item = &Fault> {
        self.of_severity(Severity::Error)
    }

    /// The faults a map can be made in spite of.
    pub fn warnings(&self) -> impl Iterator<Item = &Fault> {
        self.of_severity(Severity::Warning)
    }

    /// Whether the soup is an oriented manifold, warnings or not.
    #[must_use]
    pub fn is_mesh(&self) -> bool {
        self.errors().next().is_none()
    }

    fn of_severity(&self, severity: Severity) -> impl Iterator<Item = &Fault> {
        self.faults.iter().filter(move |fault| fault.severity() == severity)
    }
}

/// Lists all faults of a soup, and measures it.
///
/// A face that refers to a missing vertex, repeats a vertex or copies another face is named for
/// that alone: the faults of edges and vertices, and all [`Facts`] but the numbers of faces and
/// vertices, leave it out.
///
/// Without errors the soup is an oriented manifold with boundary whose every ordered pair of
/// vertices is a side of at most one face. Two opposite triangles on the same three vertices, and
/// nothing else, pass: they are a sphere in that sense. Time is that of sorting the sides.
#[must_use]
pub fn check(soup: &TriangleSoup) -> Report {
    let mut faults = size_faults(soup.positions.len(), soup.faces.len());
    if faults.iter().any(|fault| *fault != Fault::NoFaces) {
        return Report { faults, facts: Facts::counting(soup) };
    }
    let mut live = face_faults(soup, &mut faults);
    let mut opposite = Vec::new();
    for twin in twins(&soup.faces, &live) {
        if twin.reversed {
            opposite.push(twin);
        } else {
            live[twin.face as usize] = false;
            faults.push(Fault::DuplicateFace { face: twin.face, first: twin.first });
        }
    }
    let topology = Topology::new(soup, &live);
    let crowded = crowded_faces(&topology.connectivity, soup.faces.len());
    faults.extend(
        opposite
            .iter()
            .filter(|twin| crowded[twin.face as usize])
            .map(|twin| Fault::OppositeFace { face: twin.face, first: twin.first }),
    );
    faults_of_edges_and_fans(&topology, &mut faults);
    geometric_warnings(&topology, &mut faults);
    let facts = Facts::measure(&topology);
    Report { faults, facts }
}

fn size_faults(n_vertices: usize, n_faces: usize) -> Vec<Fault> {
    let mut faults = Vec::new();
    if n_faces == 0 {
        faults.push(Fault::NoFaces);
    }
    if n_faces > MAX_FACES {
        faults.push(Fault::TooManyFaces { n_faces, limit: MAX_FACES });
    }
    if n_vertices > MAX_VERTICES {
        faults.push(Fault::TooManyVertices { n_vertices, limit: MAX_VERTICES });
    }
    faults
}

/// Faults of single faces and vertices. Returns which faces have three different vertices.
fn face_faults(soup: &TriangleSoup, faults: &mut Vec<Fault>) -> Vec<bool> {
    let n_vertices = soup.positions.len();
    for (&triple, face) in soup.faces.iter().zip(0u32..) {
        for index in triple.into_iter().filter(|&v| v as usize >= n_vertices) {
            faults.push(Fault::IndexOutOfRange { face, index, n_vertices });
        }
    }
    for (&position, vertex) in soup.positions.iter().zip(0u32..) {
        if !is_finite(position) {
            faults.push(Fault::NonFiniteCoordinate { vertex });
        }
    }
    for (&triple, face) in soup.faces.iter().zip(0u32..) {
        if let Some(vertex) = repeated(triple) {
            faults.push(Fault::RepeatedVertex { face, vertex });
        }
    }
    let is_live = |&triple: &[u32; 3]| {
        triple.iter().all(|&v| (v as usize) < n_vertices) && repeated(triple).is_none()
    };
    soup.faces.iter().map(is_live).collect()
}

/// The vertex that a face uses more than once.
pub(super) fn repeated([a, b, c]: [u32; 3]) -> Option<u32> {
    if a == b || a == c {
        Some(a)
    } else if b == c {
        Some(b)
    } else {
        None
    }
}

/// Which faces have an edge that more than two faces share.
pub(super) fn crowded_faces(connectivity: &Connectivity, n_faces: usize) -> Vec<bool> {
    let mut crowded = vec![false; n_faces];
    for side in connectivity.edges().filter(|sides| sides.len() > 2).flatten() {
        crowded[side.face() as usize] = true;
    }
    crowded
}

fn faults_of_edges_and_fans(topology: &Topology, faults: &mut Vec<Fault>) {
    let connectivity = &topology.connectivity;
    for sides in connectivity.edges().filter(|sides| sides.len() > 2) {
        let faces = sides.iter().map(|side| side.face()).collect();
        faults.push(Fault::NonManifoldEdge { vertices: sides[0].edge, faces });
    }
    for (&fans, vertex) in topology.fans_at_vertex.iter().zip(0u32..) {
        if fans > 1 {
            faults.push(Fault::NonManifoldVertex { vertex, fans: fans as usize });
        }
    }
    let clash = |sides: &[Side]| match connectivity.pair(sides) {
        Some((a, b, true)) => {
            let faces = [a.face(), b.face()];
            Some(Fault::InconsistentOrientation { edge: a.edge, faces })
        }
        _ => None,
    };
    faults.extend(connectivity.edges().filter_map(clash));
    for &(face, edge) in &topology.patches.not_orientable {
        faults.push(Fault::NonOrientable { face, edge });
    }
}

fn geometric_warnings(topology: &Topology, faults: &mut Vec<Fault>) {
    for (face, triple) in topology.live_faces() {
        let corners = topology.corners(triple);
        if corners.into_iter().all(is_finite) && shape(corners).is_flat {
            faults.push(Fault::ZeroAreaFace { face });
        }
    }
    for sides in topology.connectivity.edges() {
        let vertices = sides[0].edge;
        let [p, q] = vertices.map(|v| topology.position(v));
        if p == q && is_finite(p) {
            faults.push(Fault::ZeroLengthEdge { vertices });
        }
    }
    for (used, vertex) in referenced(topology.soup).into_iter().zip(0u32..) {
        if !used {
            faults.push(Fault::UnreferencedVertex { vertex });
        }
    }
}

/// Which vertices belong to some face, live or not.
pub(super) fn referenced(soup: &TriangleSoup) -> Vec<bool> {
    let mut used = vec![false; soup.positions.len()];
    for &vertex in soup.faces.iter().flatten() {
        if let Some(entry) = used.get_mut(vertex as usize) {
            *entry = true;
        }
    }
    used
}

#[cfg(test)]
mod tests;
