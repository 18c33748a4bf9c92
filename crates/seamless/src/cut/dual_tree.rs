//! Spanning trees of the faces: which edges a layout crosses, and so which become seams.

use seamstress_surface::{
    Face, FaceData, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData,
};
use std::cmp::Ordering;
use std::collections::{BinaryHeap, VecDeque};

/// A spanning tree of the faces of a connected mesh, across edges.
#[derive(Debug, Clone)]
pub struct DualTree {
    /// Faces from the root outwards.
    pub order: Vec<Face>,
    /// Half-edge of the parent face that leads into this face; `None` at the root.
    pub parent: FaceData<Option<Halfedge>>,
    /// Whether the tree crosses the edge; the same on twins.
    pub crossed: HalfedgeData<bool>,
}

impl DualTree {
    fn empty(mesh: &TriMesh) -> Self {
        Self {
            order: Vec::with_capacity(mesh.n_faces()),
            parent: FaceData::filled(mesh.n_faces(), None),
            crossed: HalfedgeData::filled(mesh.n_halfedges(), false),
        }
    }

    fn cross(&mut self, h: Halfedge, twin: Halfedge) {
        self.parent[twin.face()] = Some(h);
        self.crossed[h] = true;
        self.crossed[twin] = true;
    }

    /// The tree of least total weight (Prim), rooted at face 0; ties go to the smaller half-edge.
    pub fn lightest(mesh: &TriMesh, weight: impl Fn(Halfedge) -> f64) -> Self {
        let mut tree = Self::empty(mesh);
        let mut reached = FaceData::filled(mesh.n_faces(), false);
        let mut queue = BinaryHeap::new();
        let mut next = Some(Face(0));
        while let Some(f) = next {
            reached[f] = true;
            tree.order.push(f);
            for h in f.halfedges() {
                if mesh.twin(h).is_some_and(|t| !reached[t.face()]) {
                    queue.push(Candidate { weight: weight(h), halfedge: h });
                }
            }
            next = None;
            while let Some(Candidate { halfedge, .. }) = queue.pop() {
                if let Some(t) = mesh.twin(halfedge).filter(|t| !reached[t.face()]) {
                    tree.cross(halfedge, t);
                    next = Some(t.face());
                    break;
                }
            }
        }
        tree
    }

    /// A breadth-first tree that does not cross the edges marked; `None` when these separate faces.
    pub fn breadth_first(mesh: &TriMesh, forbidden: &HalfedgeData<bool>) -> Option<Self> {
        let mut tree = Self::empty(mesh);
        let mut reached = FaceData::filled(mesh.n_faces(), false);
        let mut queue = VecDeque::from([Face(0)]);
        reached[Face(0)] = true;
        while let Some(f) = queue.pop_front() {
            tree.order.push(f);
            for h in f.halfedges() {
                if forbidden[h] {
                    continue;
                }
                if let Some(t) = mesh.twin(h).filter(|t| !reached[t.face()]) {
                    reached[t.face()] = true;
                    tree.cross(h, t);
                    queue.push_back(t.face());
                }
            }
        }
        (tree.order.len() == mesh.n_faces()).then_some(tree)
    }
}

/// How curved the flatter end of a half-edge is, radians; the boundary counts as flat. Trees that cross
/// the edges of small weight leave the seams to curved vertices.
pub fn curvature_weight(mesh: &TriMesh, metric: &Metric) -> impl Fn(Halfedge) -> f64 {
    let bend = |(v, k): (Vertex, &f64)| if mesh.is_boundary(v) { 0.0 } else { k.abs() };
    let bend: VertexData<f64> = metric.curvature(mesh).enumerate().map(bend).collect();
    move |h| bend[mesh.origin(h)].min(bend[mesh.tip(h)])
}

/// Heap entry: the lightest comes out first, then the smallest half-edge.
struct Candidate {
    weight: f64,
    halfedge: Halfedge,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        other.weight.total_cmp(&self.weight).then(other.halfedge.cmp(&self.halfedge))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}
