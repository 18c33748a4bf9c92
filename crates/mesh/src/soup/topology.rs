//! The structure that the faults and the facts of a soup are read from.

use super::TriangleSoup;
use super::connectivity::{Connectivity, Patches};

/// How the live faces of a soup meet.
#[derive(Debug)]
pub(super) struct Topology<'a> {
    pub(super) soup: &'a TriangleSoup,
    live: &'a [bool],
    pub(super) connectivity: Connectivity<'a>,
    /// For each corner the lowest corner of its fan.
    pub(super) fans: Vec<u32>,
    /// For each vertex the number of fans its live faces form; 0 if it has none.
    pub(super) fans_at_vertex: Vec<u32>,
    pub(super) patches: Patches,
}

impl<'a> Topology<'a> {
    /// Reads the faces that are `live`; these must have three different vertices of the soup.
    pub(super) fn new(soup: &'a TriangleSoup, live: &'a [bool]) -> Self {
        let connectivity = Connectivity::new(&soup.faces, live);
        let fans = connectivity.fans();
        let patches = connectivity.patches();
        let fans_at_vertex = vec![0; soup.positions.len()];
        let mut topology = Self { soup, live, connectivity, fans, fans_at_vertex, patches };
        for (face, triple) in topology.live_faces() {
            for (corner, vertex) in (3 * face..).zip(triple) {
                if topology.fans[corner as usize] == corner {
                    topology.fans_at_vertex[vertex as usize] += 1;
                }
            }
        }
        topology
    }

    /// The live faces and their vertices.
    pub(super) fn live_faces(&self) -> impl Iterator<Item = (u32, [u32; 3])> + use<'a> {
        let live = self.live;
        let faces = (0u32..).zip(self.soup.faces.iter().copied());
        faces.filter(move |&(face, _)| live[face as usize])
    }

    /// Positions of the corners of a live face.
    pub(super) fn corners(&self, triple: [u32; 3]) -> [[f64; 3]; 3] {
        triple.map(|vertex| self.position(vertex))
    }

    /// Position of a vertex of a live face.
    pub(super) fn position(&self, vertex: u32) -> [f64; 3] {
        self.soup.positions[vertex as usize]
    }
}
