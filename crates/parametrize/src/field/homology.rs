//! Loops that generate the homology of a surface, by tree and cotree (Eppstein 2003).

use seamstress_mesh::{Face, FaceData, Halfedge, HalfedgeData, TriMesh, VertexData};
use std::collections::VecDeque;

/// A closed path of faces across edges: the half-edge by which each face is left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DualLoop {
    /// Exits, in order; the last leads back into the face of the first.
    pub exits: Vec<Halfedge>,
}

impl DualLoop {
    /// Entry and exit of each face passed, half-edges of that face.
    pub fn steps<'a>(
        &'a self,
        mesh: &'a TriMesh,
    ) -> impl Iterator<Item = (Halfedge, Halfedge)> + 'a {
        let before = self.exits.iter().cycle().skip(self.exits.len().max(1) - 1);
        before.zip(&self.exits).filter_map(|(&last, &exit)| Some((mesh.twin(last)?, exit)))
    }
}

/// One integer per node of a [`Homology`], in quarters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeIndices(pub Vec<i32>);

/// How the spanning forest of the nodes reaches one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Branch {
    /// Node of the outer end.
    pub(super) node: u32,
    /// Node nearer to the root.
    pub(super) parent: u32,
    /// The edge, as the half-edge that leaves the outer end.
    pub(super) edge: Halfedge,
}

/// A basis of the homology of a mesh in one or more components, each of its boundary loops filled.
///
/// *Nodes* are the interior vertices and the boundary loops. A forest of faces across edges (the cotree),
/// a forest of nodes along edges it does not cross (the tree), and 2 g edges left over: each closes one
/// loop of faces through the cotree.
#[derive(Debug, Clone)]
pub struct Homology {
    /// Node of each vertex; none for vertices without a face.
    node: VertexData<Option<u32>>,
    n_nodes: usize,
    branches: Vec<Branch>,
    roots: Vec<u32>,
    generators: Vec<Halfedge>,
    loops: Vec<DualLoop>,
}

impl Homology {
    /// Breadth first from the first faces and vertices; depends on connectivity only.
    pub fn new(mesh: &TriMesh) -> Self {
        let (parent, crossed) = cotree(mesh);
        let (node, n_nodes) = nodes(mesh);
        let free: Vec<Halfedge> = mesh.interior_edges().filter(|&h| !crossed[h]).collect();
        let (branches, roots, in_tree) = tree(mesh, &node, n_nodes, &free);
        let generators: Vec<Halfedge> =
            free.into_iter().zip(in_tree).filter(|(_, used)| !used).map(|(h, _)| h).collect();
        let loops = generators.iter().map(|&h| close(mesh, &parent, h)).collect();
        Self { node, n_nodes, branches, roots, generators, loops }
    }

    /// One loop per generator, 2 g in all.
    pub fn loops(&self) -> &[DualLoop] {
        &self.loops
    }

    /// The edge of each loop that the cotree does not cross, its left half-edge.
    pub fn generators(&self) -> &[Halfedge] {
        &self.generators
    }

    /// Number of interior vertices and boundary loops.
    pub fn n_nodes(&self) -> usize {
        self.n_nodes
    }

    /// Node of each vertex, none without a face.
    pub fn nodes(&self) -> &VertexData<Option<u32>> {
        &self.node
    }

    /// Adds up vertex values by node.
    pub fn gather(&self, values: &VertexData<i32>) -> NodeIndices {
        let mut sums = vec![0; self.n_nodes];
        for (node, value) in self.node.iter().zip(values.iter()) {
            if let Some(node) = node {
                sums[*node as usize] += value;
            }
        }
        NodeIndices(sums)
    }

    /// Edges of the spanning forest, parents first.
    pub(super) fn branches(&self) -> &[Branch] {
        &self.branches
    }

    /// Root of each tree of the forest.
    pub(super) fn roots(&self) -> &[u32] {
        &self.roots
    }
}

type Parents = FaceData<Option<Halfedge>>;

/// Half-edge of the parent face that leads into each face, and the edges crossed.
fn cotree(mesh: &TriMesh) -> (Parents, HalfedgeData<bool>) {
    let mut parent = FaceData::filled(mesh.n_faces(), None);
    let mut crossed = HalfedgeData::filled(mesh.n_halfedges(), false);
    let mut reached = FaceData::filled(mesh.n_faces(), false);
    for start in mesh.faces() {
        let mut queue = VecDeque::from([start]);
        if std::mem::replace(&mut reached[start], true) {
            continue;
        }
        while let Some(f) = queue.pop_front() {
            for (h, t) in f.halfedges().into_iter().filter_map(|h| Some((h, mesh.twin(h)?))) {
                if !std::mem::replace(&mut reached[t.face()], true) {
                    parent[t.face()] = Some(h);
                    (crossed[h], crossed[t]) = (true, true);
                    queue.push_back(t.face());
                }
            }
        }
    }
    (parent, crossed)
}

/// Numbers interior vertices and boundary loops, in order of their first vertices.
fn nodes(mesh: &TriMesh) -> (VertexData<Option<u32>>, usize) {
    let mut node = VertexData::filled(mesh.n_vertices(), None);
    let mut count = 0u32;
    for v in mesh.vertices() {
        let Some(mut h) = mesh.outgoing(v).next().filter(|_| node[v].is_none()) else { continue };
        node[v] = Some(count);
        // The boundary leaves a vertex along its first outgoing half-edge.
        while mesh.is_boundary(v) && node[mesh.tip(h)].is_none() {
            node[mesh.tip(h)] = Some(count);
            match mesh.outgoing(mesh.tip(h)).next() {
                Some(next) => h = next,
                None => break,
            }
        }
        count += 1;
    }
    (node, count as usize)
}

/// Spanning forest of the nodes along free edges: branches, roots, and which free edges it uses.
fn tree(
    mesh: &TriMesh,
    node: &VertexData<Option<u32>>,
    n_nodes: usize,
    free: &[Halfedge],
) -> (Vec<Branch>, Vec<u32>, Vec<bool>) {
    let mut at = vec![Vec::new(); n_nodes];
    for (k, &h) in free.iter().enumerate() {
        if let (Some(a), Some(b), Some(t)) = (node[mesh.origin(h)], node[mesh.tip(h)], mesh.twin(h))
        {
            // To walk from a to b, the half-edge that leaves b.
            at[a as usize].push((b, t, k));
            at[b as usize].push((a, h, k));
        }
    }
    let mut used = vec![false; free.len()];
    let mut reached = vec![false; n_nodes];
    let (mut branches, mut roots) = (Vec::new(), Vec::new());
    for root in 0..n_nodes as u32 {
        if std::mem::replace(&mut reached[root as usize], true) {
            continue;
        }
        roots.push(root);
        let mut queue = VecDeque::from([root]);
        while let Some(parent) = queue.pop_front() {
            for &(node, edge, k) in &at[parent as usize] {
                if !std::mem::replace(&mut reached[node as usize], true) {
                    used[k] = true;
                    branches.push(Branch { node, parent, edge });
                    queue.push_back(node);
                }
            }
        }
    }
    (branches, roots, used)
}

/// The loop that leaves its first face across `h` and returns through the cotree.
fn close(mesh: &TriMesh, parent: &Parents, h: Halfedge) -> DualLoop {
    let upwards = |mut f: Face| {
        let mut path = vec![];
        while let Some(p) = parent[f] {
            path.push(p);
            f = p.face();
        }
        path
    };
    let Some(t) = mesh.twin(h) else { return DualLoop { exits: Vec::new() } };
    let (mut home, mut away) = (upwards(h.face()), upwards(t.face()));
    while let (Some(a), Some(b)) = (home.last(), away.last()) {
        if a != b {
            break;
        }
        home.pop();
        away.pop();
    }
    let up = away.into_iter().filter_map(|p| mesh.twin(p));
    DualLoop { exits: std::iter::once(h).chain(up).chain(home.into_iter().rev()).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit as testkit;

    fn homology(soup: &seamstress_mesh::soup::TriangleSoup) -> (TriMesh, Homology) {
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let homology = Homology::new(&mesh);
        (mesh, homology)
    }

    #[test]
    fn there_are_two_loops_to_a_handle_and_they_close() {
        let shapes = [
            (testkit::tetrahedron(), 0, 4),
            (testkit::seven_vertex_torus(), 1, 7),
            (testkit::double_torus(), 2, testkit::double_torus().positions.len()),
            (testkit::annulus(12, 4), 0, 2 + 12 * 3),
            (testkit::disjoint_union(&[testkit::torus(8, 6, 2.0, 0.5), testkit::cube()]), 1, 56),
        ];
        for (soup, genus, n_nodes) in shapes {
            let (mesh, homology) = homology(&soup);
            assert_eq!((homology.loops().len(), homology.n_nodes()), (2 * genus, n_nodes));
            for dual_loop in homology.loops() {
                let steps: Vec<_> = dual_loop.steps(&mesh).collect();
                assert_eq!(steps.len(), dual_loop.exits.len());
                assert!(steps.iter().all(|(a, b)| a.face() == b.face() && a != b));
            }
        }
    }

    #[test]
    fn the_forest_reaches_every_node_once() {
        let (_, homology) = homology(&testkit::with_boundaries(&testkit::double_torus(), 2, 1));
        let mut reached: Vec<u32> = homology.branches().iter().map(|b| b.node).collect();
        reached.extend(homology.roots());
        reached.sort_unstable();
        assert_eq!(reached, (0..homology.n_nodes() as u32).collect::<Vec<_>>());
    }
}
