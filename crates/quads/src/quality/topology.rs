//! Counts of a polygon mesh, and what is irregular.

use std::collections::BTreeMap;

/// Counts of a polygon mesh.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Topology {
    /// Vertices that a polygon has.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Polygons by number of corners.
    pub polygons: BTreeMap<usize, usize>,
    /// `vertices - edges + polygons`.
    pub euler_characteristic: i64,
    /// Edges with one polygon.
    pub boundary_edges: usize,
    /// Edges with more than two polygons, or with two that turn the same way there.
    pub bad_edges: usize,
    /// Vertices off the boundary whose number of edges is not four, by that number.
    pub irregular: BTreeMap<usize, usize>,
    /// These vertices and their numbers of edges, ascending.
    #[serde(skip)]
    pub irregular_vertices: Vec<(u32, usize)>,
    /// Vertices on the boundary by number of polygons; two is regular.
    pub boundary_vertices: BTreeMap<usize, usize>,
}

/// Polygons on either side of an edge, told by the way they run along it.
#[derive(Debug, Clone, Copy, Default)]
struct Sides {
    forward: u32,
    backward: u32,
}

impl Topology {
    /// Counts; corners must be below `n_vertices`.
    pub fn new<'a>(n_vertices: usize, polygons: impl Iterator<Item = &'a [u32]>) -> Self {
        let mut edges: BTreeMap<(u32, u32), Sides> = BTreeMap::new();
        let mut sizes = BTreeMap::new();
        let mut polygons_at = vec![0usize; n_vertices];
        for polygon in polygons {
            *sizes.entry(polygon.len()).or_insert(0) += 1;
            for (k, &a) in polygon.iter().enumerate() {
                polygons_at[a as usize] += 1;
                let b = polygon[(k + 1) % polygon.len()];
                let sides = edges.entry((a.min(b), a.max(b))).or_default();
                *if a < b { &mut sides.forward } else { &mut sides.backward } += 1;
            }
        }
        let mut edges_at = vec![0usize; n_vertices];
        let mut on_boundary = vec![false; n_vertices];
        let (mut boundary_edges, mut bad_edges) = (0, 0);
        for (&(a, b), sides) in &edges {
            let is_boundary = sides.forward + sides.backward == 1;
            boundary_edges += usize::from(is_boundary);
            bad_edges += usize::from(sides.forward > 1 || sides.backward > 1);
            for v in [a as usize, b as usize] {
                edges_at[v] += 1;
                on_boundary[v] |= is_boundary;
            }
        }
        let (mut irregular, mut boundary_vertices) = (BTreeMap::new(), BTreeMap::new());
        let mut irregular_vertices = Vec::new();
        let used = |v: &usize| polygons_at[*v] > 0;
        for v in (0..n_vertices).filter(used) {
            if on_boundary[v] {
                *boundary_vertices.entry(polygons_at[v]).or_insert(0) += 1;
            } else if edges_at[v] != 4 {
                *irregular.entry(edges_at[v]).or_insert(0) += 1;
                irregular_vertices.push((v as u32, edges_at[v]));
            }
        }
        let vertices = (0..n_vertices).filter(used).count();
        let n_polygons: usize = sizes.values().sum();
        Self {
            vertices,
            edges: edges.len(),
            euler_characteristic: vertices as i64 - edges.len() as i64 + n_polygons as i64,
            polygons: sizes,
            boundary_edges,
            bad_edges,
            irregular,
            irregular_vertices,
            boundary_vertices,
        }
    }

    /// Irregular vertices off the boundary.
    pub fn n_irregular(&self) -> usize {
        self.irregular.values().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [[u32; 4]; 6] =
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

    #[test]
    fn a_cube_by_hand() {
        let topology = Topology::new(9, CUBE.iter().map(<[u32; 4]>::as_slice));
        assert_eq!((topology.vertices, topology.edges), (8, 12));
        assert_eq!(topology.euler_characteristic, 2);
        assert_eq!(topology.irregular, BTreeMap::from([(3, 8)]));
        assert_eq!(topology.irregular_vertices, (0..8).map(|v| (v, 3)).collect::<Vec<_>>());
        assert_eq!((topology.boundary_edges, topology.bad_edges), (0, 0));
    }

    #[test]
    fn an_open_cube_and_a_polygon_turned_over() {
        let open = Topology::new(8, CUBE[1..].iter().map(<[u32; 4]>::as_slice));
        assert_eq!(open.boundary_edges, 4);
        assert_eq!(open.boundary_vertices, BTreeMap::from([(2, 4)]));
        let mut turned = CUBE;
        turned[0].reverse();
        let turned = Topology::new(8, turned.iter().map(<[u32; 4]>::as_slice));
        assert_eq!(turned.bad_edges, 4);
    }
}
