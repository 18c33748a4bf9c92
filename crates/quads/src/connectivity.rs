//! Who is whose neighbour in a quad mesh, and what keeps it from being a manifold.

use crate::mesh::QuadMesh;
use std::collections::BTreeMap;
use std::fmt;

/// No half-edge.
const NONE: u32 = u32::MAX;

/// One reason why quads are not an oriented manifold (ids from 0).
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum QuadFault {
    /// A quad has a vertex twice.
    #[error("quad {quad} has vertex {vertex} twice")]
    RepeatedVertex {
        /// The quad.
        quad: u32,
        /// Its vertex.
        vertex: u32,
    },
    /// Several quads run along an edge in the same direction.
    #[error("quads {quads:?} run along edge {from}-{to} in the same direction")]
    RepeatedHalfedge {
        /// Where the half-edges start.
        from: u32,
        /// Where they end.
        to: u32,
        /// The quads.
        quads: Vec<u32>,
    },
    /// The quads around a vertex do not form one fan.
    #[error("vertex {vertex} has {fans} fans of quads")]
    NonManifoldVertex {
        /// The vertex.
        vertex: u32,
        /// Number of fans.
        fans: usize,
    },
}

/// All faults of a quad mesh.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct QuadFaults(pub Vec<QuadFault>);

impl fmt::Display for QuadFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.as_slice() {
            [] => write!(f, "no fault"),
            [one] => one.fmt(f),
            [first, rest @ ..] => write!(f, "{first} (and {} more faults)", rest.len()),
        }
    }
}

impl std::error::Error for QuadFaults {}

/// A vertex that is not regular.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IrregularVertex {
    /// The vertex.
    pub vertex: u32,
    /// Index in quarters: 4 less the quads around an interior vertex, 2 less those at a boundary one.
    pub index: i32,
}

/// Connectivity of an oriented quad manifold, possibly with boundary.
///
/// Half-edge `4 q + k` runs from the `k`-th to the next corner of quad `q`; the same number names the
/// corner where it starts. Vertices without a quad are allowed, and count for nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct QuadConnectivity {
    origin: Vec<u32>,
    twin: Vec<u32>,
    /// The first half-edge of a vertex: at the boundary, of its fan.
    outgoing: Vec<u32>,
    valence: Vec<u32>,
    boundary: Vec<bool>,
}

/// The next half-edge of the quad.
fn next(h: u32) -> u32 {
    if h % 4 == 3 { h - 3 } else { h + 1 }
}

/// The previous half-edge of the quad.
fn prev(h: u32) -> u32 {
    if h.is_multiple_of(4) { h + 3 } else { h - 1 }
}

impl QuadMesh {
    /// Who is whose neighbour.
    ///
    /// # Errors
    /// Everything that keeps the quads from being an oriented manifold.
    pub fn connectivity(&self) -> Result<QuadConnectivity, QuadFaults> {
        QuadConnectivity::new(self)
    }
}

impl QuadConnectivity {
    /// Finds all neighbours.
    ///
    /// # Errors
    /// Everything that keeps the quads from being an oriented manifold.
    pub fn new(mesh: &QuadMesh) -> Result<Self, QuadFaults> {
        let repeated = repeated_vertices(mesh.quads());
        if !repeated.is_empty() {
            return Err(QuadFaults(repeated));
        }
        let connectivity = Self::unchecked(mesh.positions().len(), mesh.quads())?;
        let faults = connectivity.vertices_with_several_fans();
        if faults.is_empty() { Ok(connectivity) } else { Err(QuadFaults(faults)) }
    }

    /// A vertex may have several fans.
    fn unchecked(n_vertices: usize, quads: &[[u32; 4]]) -> Result<Self, QuadFaults> {
        let origin = quads.as_flattened().to_vec();
        let twin = twins(&origin)?;
        let mut connectivity = Self {
            outgoing: vec![NONE; n_vertices],
            valence: vec![0; n_vertices],
            boundary: vec![false; n_vertices],
            origin,
            twin,
        };
        connectivity.look_around();
        Ok(connectivity)
    }

    fn look_around(&mut self) {
        for h in 0..self.origin.len() as u32 {
            let (from, to) = (self.origin(h) as usize, self.tip(h) as usize);
            let is_open = self.twin[h as usize] == NONE;
            self.valence[from] += 1;
            if is_open || self.outgoing[from] == NONE {
                self.outgoing[from] = h;
            }
            if is_open {
                self.boundary[from] = true;
                self.boundary[to] = true;
            }
        }
    }

    fn vertices_with_several_fans(&self) -> Vec<QuadFault> {
        let mut fans = vec![0; self.outgoing.len()];
        for (&vertex, fan) in self.origin.iter().zip(self.fans()) {
            fans[vertex as usize] = (fan as usize + 1).max(fans[vertex as usize]);
        }
        let several = fans.iter().enumerate().filter(|&(_, &fans)| fans > 1);
        several
            .map(|(vertex, &fans)| QuadFault::NonManifoldVertex { vertex: vertex as u32, fans })
            .collect()
    }

    /// The fan of every corner, counted from zero at each vertex.
    fn fans(&self) -> Vec<u32> {
        let mut fan_of_corner = vec![NONE; self.origin.len()];
        let mut fans = vec![0; self.outgoing.len()];
        let is_first = |h: u32| self.twin[h as usize] == NONE;
        // Open fans from their first half-edges, then closed ones from anywhere.
        let halfedges = 0..self.origin.len() as u32;
        let starts = halfedges.clone().filter(|&h| is_first(h)).chain(halfedges);
        for start in starts {
            if fan_of_corner[start as usize] != NONE {
                continue;
            }
            let vertex = self.origin(start) as usize;
            let mut h = start;
            while h != NONE && fan_of_corner[h as usize] == NONE {
                fan_of_corner[h as usize] = fans[vertex];
                h = self.twin[prev(h) as usize];
            }
            fans[vertex] += 1;
        }
        fan_of_corner
    }

    /// The fan of every corner of quads, counted from zero at each vertex; `None` if they are no
    /// manifold along an edge.
    pub(crate) fn fans_of_corners(n_vertices: usize, quads: &[[u32; 4]]) -> Option<Vec<u32>> {
        if !repeated_vertices(quads).is_empty() {
            return None;
        }
        Some(Self::unchecked(n_vertices, quads).ok()?.fans())
    }

    /// Number of vertices with a quad.
    pub fn n_vertices(&self) -> usize {
        self.valence.iter().filter(|&&n| n > 0).count()
    }

    /// Number of quads.
    pub fn n_quads(&self) -> usize {
        self.origin.len() / 4
    }

    /// Number of half-edges, four per quad.
    pub fn n_halfedges(&self) -> usize {
        self.origin.len()
    }

    /// One half-edge per edge: the smaller of the two, or the only one.
    pub fn edges(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.twin.len() as u32).filter(|&h| h < self.twin[h as usize])
    }

    /// Number of edges.
    pub fn n_edges(&self) -> usize {
        self.edges().count()
    }

    /// The half-edge on the other side, or `None` on the boundary.
    pub fn twin(&self, h: u32) -> Option<u32> {
        let t = self.twin[h as usize];
        (t != NONE).then_some(t)
    }

    /// Where a half-edge starts.
    pub fn origin(&self, h: u32) -> u32 {
        self.origin[h as usize]
    }

    /// Where a half-edge ends.
    pub fn tip(&self, h: u32) -> u32 {
        self.origin[next(h) as usize]
    }

    /// Outgoing half-edges of a vertex counter-clockwise; at the boundary from the first to the last
    /// quad of its fan, which has one more edge, the previous half-edge of its last quad.
    pub fn outgoing(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.outgoing[vertex as usize];
        let start = (first != NONE).then_some(first);
        std::iter::successors(start, move |&h| {
            let t = self.twin[prev(h) as usize];
            (t != NONE && t != first).then_some(t)
        })
    }

    /// Vertices joined to a vertex by an edge, counter-clockwise.
    pub fn neighbours(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let last = self.outgoing(vertex).last().filter(|_| self.is_boundary(vertex));
        let end = last.map(|h| self.origin(prev(h)));
        self.outgoing(vertex).map(|h| self.tip(h)).chain(end)
    }

    /// Number of quads at a vertex.
    pub fn valence(&self, vertex: u32) -> u32 {
        self.valence[vertex as usize]
    }

    /// Whether a vertex lies on the boundary.
    pub fn is_boundary(&self, vertex: u32) -> bool {
        self.boundary[vertex as usize]
    }

    /// Whether there is a boundary.
    pub fn has_boundary(&self) -> bool {
        self.boundary.contains(&true)
    }

    /// Interior vertices without four quads, ascending.
    pub fn irregular_vertices(&self) -> Vec<IrregularVertex> {
        self.indices(|vertex| !self.is_boundary(vertex))
    }

    /// Boundary vertices without two quads, ascending.
    pub fn boundary_corners(&self) -> Vec<IrregularVertex> {
        self.indices(|vertex| self.is_boundary(vertex))
    }

    fn indices(&self, is_asked: impl Fn(u32) -> bool) -> Vec<IrregularVertex> {
        let vertices = 0..self.valence.len() as u32;
        let used = vertices.filter(|&v| self.valence(v) > 0 && is_asked(v));
        let with_index = used.map(|vertex| {
            let regular = if self.is_boundary(vertex) { 2 } else { 4 };
            IrregularVertex { vertex, index: regular - self.valence(vertex) as i32 }
        });
        with_index.filter(|irregular| irregular.index != 0).collect()
    }

    /// #V - #E + #F, boundaries unfilled.
    pub fn euler_characteristic(&self) -> i64 {
        self.n_vertices() as i64 - self.n_edges() as i64 + self.n_quads() as i64
    }

    /// Number of boundary loops.
    pub fn n_boundary_loops(&self) -> usize {
        let mut seen = vec![false; self.origin.len()];
        let mut loops = 0;
        for start in (0..self.twin.len() as u32).filter(|&h| self.twin[h as usize] == NONE) {
            if seen[start as usize] {
                continue;
            }
            loops += 1;
            let mut h = start;
            while !seen[h as usize] {
                seen[h as usize] = true;
                h = self.outgoing[self.tip(h) as usize];
            }
        }
        loops
    }

    /// Quads joined across edges: a label per quad, and how many labels there are.
    pub fn connected_quads(&self) -> (Vec<u32>, usize) {
        let mut label = vec![NONE; self.n_quads()];
        let mut count = 0;
        let mut stack = Vec::new();
        for start in 0..label.len() {
            if label[start] != NONE {
                continue;
            }
            label[start] = count;
            stack.push(start as u32);
            while let Some(quad) = stack.pop() {
                for t in (4 * quad..4 * quad + 4).filter_map(|h| self.twin(h)) {
                    let other = (t / 4) as usize;
                    if label[other] == NONE {
                        label[other] = count;
                        stack.push(t / 4);
                    }
                }
            }
            count += 1;
        }
        (label, count as usize)
    }
}

fn repeated_vertices(quads: &[[u32; 4]]) -> Vec<QuadFault> {
    let mut faults = Vec::new();
    for (quad, corners) in quads.iter().enumerate() {
        let repeated = (1..4).find(|&k| corners[..k].contains(&corners[k]));
        if let Some(k) = repeated {
            faults.push(QuadFault::RepeatedVertex { quad: quad as u32, vertex: corners[k] });
        }
    }
    faults
}

fn twins(origin: &[u32]) -> Result<Vec<u32>, QuadFaults> {
    let tip = |h: u32| origin[next(h) as usize];
    let mut order: Vec<u32> = (0..origin.len() as u32).collect();
    order.sort_unstable_by_key(|&h| (origin[h as usize], tip(h), h));
    let ends = |h: u32| (origin[h as usize], tip(h));
    let mut repeated: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
    for pair in order.windows(2).filter(|pair| ends(pair[0]) == ends(pair[1])) {
        let quads = repeated.entry(ends(pair[0])).or_insert_with(|| vec![pair[0] / 4]);
        quads.push(pair[1] / 4);
    }
    if !repeated.is_empty() {
        let fault = |((from, to), quads)| QuadFault::RepeatedHalfedge { from, to, quads };
        return Err(QuadFaults(repeated.into_iter().map(fault).collect()));
    }
    let twin = |h: u32| {
        let wanted = (tip(h), origin[h as usize]);
        order.binary_search_by_key(&wanted, |&t| ends(t)).map_or(NONE, |at| order[at])
    };
    Ok((0..origin.len() as u32).map(twin).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(n_vertices: usize, quads: &[[u32; 4]]) -> QuadMesh {
        QuadMesh::new(vec![[0.0; 3]; n_vertices], quads.to_vec()).unwrap()
    }

    /// A cube: corners 0 to 3 below, 4 to 7 above.
    const CUBE: [[u32; 4]; 6] =
        [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

    #[test]
    fn a_cube() {
        let cube = QuadConnectivity::new(&mesh(9, &CUBE)).unwrap();
        assert_eq!((cube.n_vertices(), cube.n_edges(), cube.n_quads()), (8, 12, 6));
        assert_eq!(cube.euler_characteristic(), 2);
        assert!(!cube.has_boundary());
        assert_eq!(cube.n_boundary_loops(), 0);
        assert_eq!(cube.connected_quads(), (vec![0; 6], 1));
        let irregular = cube.irregular_vertices();
        assert_eq!(irregular.len(), 8);
        assert!(irregular.iter().all(|v| v.index == 1));
        let mut around: Vec<u32> = cube.neighbours(0).collect();
        around.sort_unstable();
        assert_eq!(around, [1, 3, 4]);
        for h in 0..24 {
            let t = cube.twin(h).unwrap();
            assert_eq!((cube.twin(t), cube.origin(t)), (Some(h), cube.tip(h)));
        }
    }

    #[test]
    fn a_cube_without_its_lid() {
        let open = [&CUBE[..1], &CUBE[2..]].concat();
        let open = QuadConnectivity::new(&mesh(8, &open)).unwrap();
        assert_eq!((open.euler_characteristic(), open.n_boundary_loops()), (1, 1));
        assert_eq!(open.irregular_vertices().len(), 4);
        assert_eq!(open.boundary_corners(), []);
        // Along the rim, and down: first along the boundary, last back along it.
        let [first, down, last] = open.neighbours(5).collect::<Vec<_>>()[..] else {
            panic!("three neighbours")
        };
        assert_eq!(down, 1);
        assert!(
            open.edges().any(|h| (open.origin(h), open.tip(h), open.twin(h)) == (5, first, None))
        );
        assert!(
            open.edges().any(|h| (open.origin(h), open.tip(h), open.twin(h)) == (last, 5, None))
        );
    }

    #[test]
    fn one_quad_has_four_corners() {
        let quad = QuadConnectivity::new(&mesh(4, &[[0, 1, 2, 3]])).unwrap();
        assert_eq!(quad.boundary_corners().iter().map(|c| c.index).collect::<Vec<_>>(), [1; 4]);
        assert_eq!((quad.euler_characteristic(), quad.n_boundary_loops()), (1, 1));
    }

    #[test]
    fn every_fault_is_named() {
        let faults = |n, quads: &[[u32; 4]]| QuadConnectivity::new(&mesh(n, quads)).unwrap_err().0;
        let repeated = QuadFault::RepeatedVertex { quad: 1, vertex: 5 };
        assert_eq!(faults(6, &[[0, 1, 2, 3], [3, 5, 4, 5]]), [repeated]);
        let along = QuadFault::RepeatedHalfedge { from: 0, to: 1, quads: vec![0, 1, 2] };
        assert_eq!(faults(8, &[[0, 1, 2, 3], [0, 1, 4, 5], [0, 1, 6, 7]]), [along]);
        let pinched = QuadFault::NonManifoldVertex { vertex: 2, fans: 2 };
        assert_eq!(faults(7, &[[0, 1, 2, 3], [2, 4, 5, 6]]), [pinched]);
        // Two cubes that share a corner: closed fans.
        let mut cubes = CUBE.to_vec();
        cubes.extend(CUBE.map(|quad| quad.map(|v| if v == 0 { 0 } else { v + 7 })));
        let message = QuadConnectivity::new(&mesh(15, &cubes)).unwrap_err().to_string();
        assert_eq!(message, "vertex 0 has 2 fans of quads");
    }
}
