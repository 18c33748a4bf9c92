//! Spanning trees of the faces: which edges a layout crosses, and so which become seams.

use seamstress_mesh::{
    Face, FaceData, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData,
};
use std::cmp::Ordering;
use std::collections::{BinaryHeap, VecDeque};

/// A spanning tree of the faces of a connected mesh, across edges.
///
/// On a mesh with aligned edges it spans one node more, the *ground*, on whose other side every aligned
/// edge lies along the u axis; a face may hang on it by one of its aligned half-edges. The faces then form
/// a forest.
#[derive(Debug, Clone)]
pub struct DualTree {
    /// Faces from the roots outwards.
    pub order: Vec<Face>,
    /// Half-edge of the parent face that leads into this face; `None` at the roots.
    pub parent: FaceData<Option<Halfedge>>,
    /// Aligned half-edge by which a root hangs on the ground.
    pub ground: FaceData<Option<Halfedge>>,
    /// Whether the tree crosses the edge; the same on twins.
    pub crossed: HalfedgeData<bool>,
}

impl DualTree {
    fn empty(mesh: &TriMesh) -> Self {
        Self {
            order: Vec::with_capacity(mesh.n_faces()),
            parent: FaceData::filled(mesh.n_faces(), None),
            ground: FaceData::filled(mesh.n_faces(), None),
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
        Self::grounded(mesh, std::iter::empty(), weight)
    }

    /// The tree of least total weight of the faces and the ground, for a mesh slit along its aligned
    /// edges; `grounding` gives the weights of the half-edges by which faces may hang on the ground.
    /// Without any it is the tree rooted at face 0. Ties go to the smaller half-edge.
    pub fn grounded(
        mesh: &TriMesh,
        grounding: impl Iterator<Item = (f64, Halfedge)>,
        weight: impl Fn(Halfedge) -> f64,
    ) -> Self {
        let mut tree = Self::empty(mesh);
        let mut reached = FaceData::filled(mesh.n_faces(), false);
        let mut queue: BinaryHeap<Branch> = grounding
            .map(|(weight, halfedge)| Branch { weight, halfedge, from: Support::Ground })
            .collect();
        let mut next =
            if queue.is_empty() { Some(Face(0)) } else { tree.pop(mesh, &reached, &mut queue) };
        while let Some(f) = next {
            reached[f] = true;
            tree.order.push(f);
            for h in f.halfedges() {
                if mesh.twin(h).is_some_and(|t| !reached[t.face()]) {
                    queue.push(Branch { weight: weight(h), halfedge: h, from: Support::Face });
                }
            }
            next = tree.pop(mesh, &reached, &mut queue);
        }
        tree
    }

    /// Takes the lightest candidate that leads to a new face, and hangs that face on.
    fn pop(
        &mut self,
        mesh: &TriMesh,
        reached: &FaceData<bool>,
        queue: &mut BinaryHeap<Branch>,
    ) -> Option<Face> {
        while let Some(Branch { halfedge, from, .. }) = queue.pop() {
            match from {
                Support::Ground if !reached[halfedge.face()] => {
                    self.ground[halfedge.face()] = Some(halfedge);
                    self.crossed[halfedge] = true;
                    return Some(halfedge.face());
                }
                Support::Ground => {}
                Support::Face => {
                    if let Some(t) = mesh.twin(halfedge).filter(|t| !reached[t.face()]) {
                        self.cross(halfedge, t);
                        return Some(t.face());
                    }
                }
            }
        }
        None
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
    flatter_end(mesh, metric.curvature(mesh).enumerate().map(bend).collect())
}

/// What there is at that end of a half-edge where there is less.
pub fn flatter_end(mesh: &TriMesh, bend: VertexData<f64>) -> impl Fn(Halfedge) -> f64 {
    move |h| bend[mesh.origin(h)].min(bend[mesh.tip(h)])
}

/// Heap entry: the lightest comes out first, then the smallest half-edge.
struct Branch {
    weight: f64,
    halfedge: Halfedge,
    from: Support,
}

/// What a branch hangs a face on.
#[derive(Clone, Copy)]
enum Support {
    /// The face of the half-edge; the new face is across it.
    Face,
    /// The ground; the new face is that of the half-edge.
    Ground,
}

impl Ord for Branch {
    fn cmp(&self, other: &Self) -> Ordering {
        other.weight.total_cmp(&self.weight).then(other.halfedge.cmp(&self.halfedge))
    }
}

impl PartialOrd for Branch {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Branch {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Branch {}
