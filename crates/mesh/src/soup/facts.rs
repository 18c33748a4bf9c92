//! What a soup is: counts, topology and size.

use super::TriangleSoup;
use super::geometry::{distance, is_finite, shape};
use super::sets::SignedSets;
use super::topology::Topology;
use std::collections::BTreeMap;

/// Counts, topology and size of a soup.
///
/// Faces that refer to a missing vertex, repeat a vertex or copy another face count in `n_faces`
/// only. Lengths are in mesh units and may be infinite if they exceed the largest number.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Facts {
    /// #V: all vertices, in use or not.
    pub n_vertices: usize,
    /// #E: the different pairs of vertices that are sides of faces.
    pub n_edges: usize,
    /// #F: all faces.
    pub n_faces: usize,
    /// Vertices in the same place as one with a smaller index, joined by an edge or not.
    pub n_coincident_vertices: usize,
    /// The pieces connected across edges, in order of their lowest faces.
    pub components: Vec<ComponentFacts>,
    /// Smallest and largest coordinates of the vertices that faces use; `None` if there are none
    /// or one is not finite.
    pub bounding_box: Option<[[f64; 3]; 2]>,
    /// Length of the shortest edge.
    pub min_edge_length: Option<f64>,
    /// Length of the longest edge.
    pub max_edge_length: Option<f64>,
    /// Smallest corner angle in radians.
    pub min_angle: Option<f64>,
}

/// One piece of a soup, connected across edges. A vertex where several fans meet counts once for
/// each of them, as if it were split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct ComponentFacts {
    /// Its lowest face.
    pub first_face: u32,
    /// Number of vertices.
    pub n_vertices: usize,
    /// Number of edges.
    pub n_edges: usize,
    /// Number of faces.
    pub n_faces: usize,
    /// Number of boundary loops; 0 for a closed surface.
    pub boundary_loops: usize,
    /// Number of handles, if the component is manifold and orientable.
    pub genus: Option<usize>,
}

impl ComponentFacts {
    /// χ = #V − #E + #F, boundary loops unfilled.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        self.n_vertices as i64 - self.n_edges as i64 + self.n_faces as i64
    }
}

impl Facts {
    /// χ = #V − #E + #F over all components, boundary loops unfilled.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        self.components.iter().map(ComponentFacts::euler_characteristic).sum()
    }

    /// Boundary loops of all components.
    #[must_use]
    pub fn boundary_loops(&self) -> usize {
        self.components.iter().map(|c| c.boundary_loops).sum()
    }

    /// Handles of all components, if there are any and each is manifold and orientable.
    #[must_use]
    pub fn genus(&self) -> Option<usize> {
        let total = self.components.iter().map(|c| c.genus).sum();
        if self.components.is_empty() { None } else { total }
    }

    /// Whether there are faces and none has a free side.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        !self.components.is_empty() && self.boundary_loops() == 0
    }

    /// The counts of elements alone.
    pub(super) fn counting(soup: &TriangleSoup) -> Self {
        let (n_vertices, n_faces) = (soup.positions.len(), soup.faces.len());
        Self { n_vertices, n_faces, ..Self::default() }
    }

    pub(super) fn measure(topology: &Topology) -> Self {
        let mut facts = Self::counting(topology.soup);
        facts.n_edges = topology.connectivity.edges().count();
        facts.n_coincident_vertices = count_coincident(&topology.soup.positions);
        facts.components = components(topology);
        facts.measure_faces(topology);
        facts.measure_edges(topology);
        facts
    }

    fn measure_faces(&mut self, topology: &Topology) {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut all_finite = true;
        for (_, triple) in topology.live_faces() {
            let corners = topology.corners(triple);
            if !corners.into_iter().all(is_finite) {
                all_finite = false;
                continue;
            }
            for (axis, x) in corners.iter().flat_map(|p| p.iter().copied().enumerate()) {
                low[axis] = low[axis].min(x);
                high[axis] = high[axis].max(x);
            }
            let angle = shape(corners).min_angle;
            self.min_angle = Some(self.min_angle.map_or(angle, |least| least.min(angle)));
        }
        if all_finite && low[0] <= high[0] {
            self.bounding_box = Some([low, high]);
        }
    }

    fn measure_edges(&mut self, topology: &Topology) {
        for sides in topology.connectivity.edges() {
            let [p, q] = sides[0].edge.map(|v| topology.position(v));
            if is_finite(p) && is_finite(q) {
                let length = distance(p, q);
                self.min_edge_length = Some(self.min_edge_length.map_or(length, |l| l.min(length)));
                self.max_edge_length = Some(self.max_edge_length.map_or(length, |l| l.max(length)));
            }
        }
    }
}

fn count_coincident(positions: &[[f64; 3]]) -> usize {
    // Adding zero makes -0.0 and 0.0 the same bits.
    let mut keys: Vec<[u64; 3]> = positions
        .iter()
        .filter(|&&p| is_finite(p))
        .map(|p| p.map(|x| (x + 0.0).to_bits()))
        .collect();
    keys.sort_unstable();
    let n_finite = keys.len();
    keys.dedup();
    n_finite - keys.len()
}

/// What is counted of a component on the way to a [`ComponentFacts`].
#[derive(Default)]
struct Tally {
    n_vertices: usize,
    n_edges: usize,
    n_faces: usize,
    boundary_loops: usize,
    is_irregular: bool,
}

fn components(topology: &Topology) -> Vec<ComponentFacts> {
    let component_of_face = topology.connectivity.components();
    let component = |face: u32| component_of_face[face as usize];
    let loops = boundary_loops(topology);
    let mut tallies = BTreeMap::<u32, Tally>::new();
    for (face, triple) in topology.live_faces() {
        let tally = tallies.entry(component(face)).or_default();
        tally.n_faces += 1;
        for (corner, vertex) in (3 * face..).zip(triple) {
            tally.n_vertices += usize::from(topology.fans[corner as usize] == corner);
            tally.boundary_loops += usize::from(loops[corner as usize] == Some(corner));
            tally.is_irregular |= topology.fans_at_vertex[vertex as usize] > 1;
        }
    }
    for sides in topology.connectivity.edges() {
        let tally = tallies.entry(component(sides[0].face())).or_default();
        tally.n_edges += 1;
        tally.is_irregular |= sides.len() > 2;
    }
    for &(face, _) in &topology.patches.not_orientable {
        tallies.entry(component(face)).or_default().is_irregular = true;
    }
    tallies.into_iter().map(|(first_face, tally)| tally.finish(first_face)).collect()
}

/// For each corner that is the lowest of a fan on the boundary, the lowest such corner of its
/// boundary loop.
fn boundary_loops(topology: &Topology) -> Vec<Option<u32>> {
    let mut loops = SignedSets::new(topology.fans.len());
    let mut on_boundary = vec![false; topology.fans.len()];
    for sides in topology.connectivity.edges() {
        if let [side] = *sides {
            let corners = topology.connectivity.corners_at_ends(side);
            let [a, b] = corners.map(|corner| topology.fans[corner as usize]);
            loops.join(a, b, false);
            on_boundary[a as usize] = true;
            on_boundary[b as usize] = true;
        }
    }
    let named = |(root, on_boundary): (u32, bool)| on_boundary.then_some(root);
    loops.into_roots().into_iter().zip(on_boundary).map(named).collect()
}

impl Tally {
    fn finish(self, first_face: u32) -> ComponentFacts {
        let Self { n_vertices, n_edges, n_faces, boundary_loops, is_irregular } = self;
        let mut component = ComponentFacts {
            first_face,
            n_vertices,
            n_edges,
            n_faces,
            boundary_loops,
            genus: None,
        };
        if !is_irregular {
            // χ = 2 − 2 genus − loops.
            let handles = 2 - component.euler_characteristic() - boundary_loops as i64;
            component.genus = usize::try_from(handles / 2).ok();
        }
        component
    }
}

#[cfg(test)]
mod tests {
    use super::{Facts, TriangleSoup};
    use crate::soup::check;
    use std::f64::consts::FRAC_PI_4;

    fn facts(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> Facts {
        check(&TriangleSoup { positions: positions.to_vec(), faces: faces.to_vec() }).facts
    }

    const SQUARE: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 3.0, 1.0], [0.0, 3.0, 0.0]];

    #[test]
    fn a_tetrahedron_is_a_sphere() {
        let found = facts(&SQUARE, &[[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]);
        assert_eq!((found.n_vertices, found.n_edges, found.n_faces), (4, 6, 4));
        assert_eq!(found.euler_characteristic(), 2);
        assert_eq!(found.genus(), Some(0));
        assert!(found.is_closed());
    }

    #[test]
    fn a_triangle_is_a_disk_with_measures() {
        let found = facts(&[[0.0; 3], [3.0, 0.0, 0.0], [3.0, 3.0, 0.0]], &[[0, 1, 2]]);
        assert_eq!(found.euler_characteristic(), 1);
        assert_eq!((found.boundary_loops(), found.genus()), (1, Some(0)));
        assert!(!found.is_closed());
        assert_eq!(found.bounding_box, Some([[0.0; 3], [3.0, 3.0, 0.0]]));
        assert_eq!(found.min_edge_length, Some(3.0));
        assert!((found.max_edge_length.unwrap() - 18f64.sqrt()).abs() < 1e-15);
        assert!((found.min_angle.unwrap() - FRAC_PI_4).abs() < 1e-15);
    }

    #[test]
    fn an_annulus_has_two_loops() {
        // A triangular tube: inner ring 0 1 2, outer ring 3 4 5.
        let positions: Vec<[f64; 3]> =
            (0..6).map(|i| [i as f64, (i * i) as f64, (i * i * i) as f64]).collect();
        let faces = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];
        let found = facts(&positions, &faces);
        assert_eq!((found.euler_characteristic(), found.boundary_loops()), (0, 2));
        assert_eq!(found.genus(), Some(0));
    }

    #[test]
    fn two_fans_at_a_vertex_count_as_split() {
        let mut positions = SQUARE.to_vec();
        positions.push([5.0, 5.0, 5.0]);
        let found = facts(&positions, &[[0, 1, 2], [2, 3, 4]]);
        assert_eq!(found.components.len(), 2);
        assert_eq!(found.euler_characteristic(), 2);
        assert_eq!(found.boundary_loops(), 2);
        assert_eq!(found.genus(), None, "no genus before the vertex is split");
    }

    #[test]
    fn coinciding_vertices_are_counted() {
        let zero = [[0.0; 3], [-0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]];
        assert_eq!(facts(&zero, &[]).n_coincident_vertices, 2);
    }

    #[test]
    fn an_empty_soup_has_no_measures() {
        let found = facts(&[], &[]);
        assert_eq!(found, Facts::default());
        assert!(!found.is_closed());
        assert_eq!(found.genus(), None);
    }
}
