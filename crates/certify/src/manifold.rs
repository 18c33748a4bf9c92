//! Polygons around edges and vertices.

use crate::violation::{Violation, Violations};

/// No half-edge.
const NONE: usize = usize::MAX;

/// Polygons of `N` corners that form an oriented manifold, possibly with boundary.
///
/// Number `N f + k` names the `k`-th corner of face `f`, and the half-edge from there to the next corner. Vertices
/// without a face count for nothing.
#[derive(Debug)]
pub(crate) struct Manifold<const N: usize> {
    /// The vertex at each corner.
    pub(crate) origin: Vec<u32>,
    twin: Vec<usize>,
    /// A half-edge of each vertex: at the boundary, the first of its fan.
    first: Vec<usize>,
}

impl<const N: usize> Manifold<N> {
    pub(crate) fn new(n_vertices: usize, faces: &[[u32; N]]) -> Result<Self, Violations> {
        let is_bad = |face: &[u32; N]| {
            (0..N).any(|k| face[k] as usize >= n_vertices || face[..k].contains(&face[k]))
        };
        let bad = faces.iter().zip(0..).filter(|(face, _)| is_bad(face));
        Violations::unless_none(bad.map(|(_, face)| Violation::BadFace { face }))?;
        let origin = faces.as_flattened().to_vec();
        let mut all = Self { twin: Vec::new(), first: vec![NONE; n_vertices], origin };
        all.twin = all.twins()?;
        let mut faces_at = vec![0usize; n_vertices];
        for h in all.halfedges() {
            let vertex = all.origin[h] as usize;
            faces_at[vertex] += 1;
            if all.first[vertex] == NONE || all.twin[h] == NONE {
                all.first[vertex] = h;
            }
        }
        let split = (0..n_vertices as u32).filter(|&v| all.fan(v).count() != faces_at[v as usize]);
        Violations::unless_none(split.map(|vertex| Violation::SplitVertex { vertex }))?;
        Ok(all)
    }

    /// The half-edges on the other sides.
    fn twins(&self) -> Result<Vec<usize>, Violations> {
        let ends = |h: usize| [self.origin[h], self.tip(h)];
        let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut edges: Vec<_> = self.halfedges().map(|h| (sorted(ends(h)), h)).collect();
        edges.sort_unstable();
        let mut twin = vec![NONE; self.origin.len()];
        let mut repeated = Vec::new();
        for sides in edges.chunk_by(|a, b| a.0 == b.0) {
            match *sides {
                [] | [_] => {}
                [(_, h), (_, t)] if ends(h) != ends(t) => (twin[h], twin[t]) = (t, h),
                [(vertices, _), ..] => repeated.push(Violation::RepeatedEdge { vertices }),
            }
        }
        Violations::unless_none(repeated).map(|()| twin)
    }

    pub(crate) fn n_faces(&self) -> usize {
        self.origin.len() / N
    }

    pub(crate) fn vertices(&self) -> impl Iterator<Item = u32> + use<N> {
        0..self.first.len() as u32
    }

    pub(crate) fn halfedges(&self) -> impl Iterator<Item = usize> + use<N> {
        0..self.origin.len()
    }

    /// The smaller half-edge of each edge, or the only one, ascending.
    pub(crate) fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        self.halfedges().filter(|&h| h < self.twin[h])
    }

    /// Both half-edges of each edge with two sides, the smaller first.
    pub(crate) fn interior_edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.edges().filter_map(|h| Some((h, self.twin(h)?)))
    }

    /// The half-edges at the boundary.
    pub(crate) fn boundary(&self) -> impl Iterator<Item = usize> + '_ {
        self.halfedges().filter(|&h| self.twin[h] == NONE)
    }

    /// The half-edge of an edge, and that on its other side if it has two; with the first of them.
    pub(crate) fn sides(&self, h: usize) -> impl Iterator<Item = (usize, usize)> + use<N> {
        std::iter::once(h).chain(self.twin(h)).map(move |side| (h, side))
    }

    /// The half-edge on the other side; none at the boundary.
    pub(crate) fn twin(&self, h: usize) -> Option<usize> {
        Some(self.twin[h]).filter(|&t| t != NONE)
    }

    pub(crate) fn next(&self, h: usize) -> usize {
        h - h % N + (h + 1) % N
    }

    pub(crate) fn prev(&self, h: usize) -> usize {
        h - h % N + (h % N + N - 1) % N
    }

    pub(crate) fn tip(&self, h: usize) -> u32 {
        self.origin[self.next(h)]
    }

    pub(crate) fn ends(&self, h: usize) -> [u32; 2] {
        [self.origin[h], self.tip(h)]
    }

    pub(crate) fn face(h: usize) -> u32 {
        (h / N) as u32
    }

    /// The corners at a vertex, counter-clockwise; at the boundary from one side to the other.
    pub(crate) fn fan(&self, vertex: u32) -> impl Iterator<Item = usize> + '_ {
        let first = Some(self.first[vertex as usize]).filter(|&h| h != NONE);
        std::iter::successors(first, move |&h| {
            self.twin(self.prev(h)).filter(|&t| Some(t) != first)
        })
    }

    /// Whether a vertex has faces all around it; nothing of one without a face.
    pub(crate) fn is_interior(&self, vertex: u32) -> Option<bool> {
        let first = self.first[vertex as usize];
        (first != NONE).then(|| self.twin[first] != NONE)
    }

    /// The smaller half-edge of the edge between two vertices.
    pub(crate) fn edge_between(&self, a: u32, b: u32) -> Option<usize> {
        let is_there = [a, b].iter().all(|&v| (v as usize) < self.first.len());
        let towards = |from, to| self.fan(from).filter(move |&h| self.tip(h) == to);
        is_there.then(|| towards(a, b).chain(towards(b, a)).min()).flatten()
    }

    /// The connected components in order of their first faces: the one of each face, and the Euler characteristic of
    /// each.
    pub(crate) fn components(&self) -> (Vec<usize>, Vec<i64>) {
        let mut component = vec![NONE; self.n_faces()];
        let mut characteristic = Vec::new();
        for start in 0..self.n_faces() {
            if component[start] != NONE {
                continue;
            }
            let mut stack = vec![start];
            while let Some(face) = stack.pop() {
                if component[face] == NONE {
                    component[face] = characteristic.len();
                    let sides = N * face..N * (face + 1);
                    stack.extend(sides.filter_map(|h| self.twin(h)).map(|t| t / N));
                }
            }
            characteristic.push(0);
        }
        component.iter().for_each(|&c| characteristic[c] += 1);
        self.edges().for_each(|h| characteristic[component[h / N]] -= 1);
        let used = self.first.iter().filter(|&&h| h != NONE);
        used.for_each(|h| characteristic[component[h / N]] += 1);
        (component, characteristic)
    }
}
