//! Polygons around edges and vertices.

use crate::verdict::{Checked, Violation, Violations};
use std::iter::{once, successors};

/// Polygons of `N` corners that form an oriented manifold, possibly with boundary.
///
/// Number `N f + k` names the `k`-th corner of face `f`, and the half-edge from there to the next corner. Vertices
/// without a face count for nothing.
#[derive(Debug)]
pub(crate) struct Manifold<const N: usize> {
    /// The vertex at each corner.
    pub(crate) origin: Vec<u32>,
    /// The half-edge on the other side of each; none at the boundary.
    pub(crate) twin: Vec<Option<usize>>,
    /// A half-edge of each vertex: at the boundary, the first of its fan.
    first: Vec<Option<usize>>,
}

/// What is around a vertex with a face.
pub(crate) struct Star {
    pub(crate) vertex: u32,
    /// The corners at the vertex, counter-clockwise; at the boundary from one side to the other.
    pub(crate) corners: Vec<usize>,
    /// Whether the vertex is off the boundary.
    pub(crate) is_closed: bool,
}

impl<const N: usize> Manifold<N> {
    pub(crate) fn new(n_vertices: usize, faces: &[[u32; N]]) -> Checked<Self> {
        let is_bad = |face: &[u32; N]| {
            (0..N).any(|k| face[k] as usize >= n_vertices || face[..k].contains(&face[k]))
        };
        let bad = (0..).zip(faces).filter(|(_, face)| is_bad(face));
        Violations::unless_none(bad.map(|(face, _)| Violation::BadFace { face }))?;
        let origin = faces.as_flattened().to_vec();
        let n = origin.len();
        let mut all = Self { origin, twin: vec![None; n], first: vec![None; n_vertices] };
        all.join()?;
        let mut corners_at = vec![0; n_vertices];
        for h in 0..n {
            let vertex = all.origin[h] as usize;
            corners_at[vertex] += 1;
            if all.first[vertex].is_none() || all.twin[h].is_none() {
                all.first[vertex] = Some(h);
            }
        }
        let n_corners = |star: &Star| corners_at[star.vertex as usize];
        let split = all.stars().filter(|star| star.corners.len() != n_corners(star));
        Violations::unless_none(split.map(|star| Violation::SplitVertex { vertex: star.vertex }))?;
        Ok(all)
    }

    /// Makes twins of the two half-edges between the same vertices.
    fn join(&mut self) -> Checked<()> {
        let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut sides: Vec<_> = (0..self.twin.len()).map(|h| (sorted(self.ends(h)), h)).collect();
        sides.sort_unstable();
        let mut repeated = Vec::new();
        for sides in sides.chunk_by(|a, b| a.0 == b.0) {
            match *sides {
                [(_, h), (_, t)] if self.origin[h] != self.origin[t] => {
                    (self.twin[h], self.twin[t]) = (Some(t), Some(h));
                }
                [(vertices, _), _, ..] => repeated.push(Violation::RepeatedEdge { vertices }),
                _ => {}
            }
        }
        Violations::unless_none(repeated)
    }

    /// The smaller half-edge of each edge, or the only one, ascending.
    pub(crate) fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.twin.len()).filter(|&h| self.twin[h].is_none_or(|t| h < t))
    }

    /// Both half-edges of each edge with two sides, the smaller first.
    pub(crate) fn interior_edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.edges().filter_map(|h| Some((h, self.twin[h]?)))
    }

    /// The half-edge of an edge, and that on its other side if it has two.
    pub(crate) fn sides(&self, h: usize) -> impl Iterator<Item = usize> + use<N> {
        once(h).chain(self.twin[h])
    }

    pub(crate) fn next(&self, h: usize) -> usize {
        h - h % N + (h + 1) % N
    }

    pub(crate) fn prev(&self, h: usize) -> usize {
        h - h % N + (h + N - 1) % N
    }

    pub(crate) fn ends(&self, h: usize) -> [u32; 2] {
        [h, self.next(h)].map(|corner| self.origin[corner])
    }

    /// The corners at a vertex from one of them on, counter-clockwise.
    fn fan(&self, first: usize) -> impl Iterator<Item = usize> + '_ {
        successors(Some(first), move |&h| self.twin[self.prev(h)].filter(|&t| t != first))
    }

    /// What is around each vertex.
    pub(crate) fn stars(&self) -> impl Iterator<Item = Star> + '_ {
        (0..).zip(&self.first).filter_map(|(vertex, first)| {
            let (corners, twin) = (self.fan((*first)?).collect(), self.twin[(*first)?]);
            Some(Star { vertex, corners, is_closed: twin.is_some() })
        })
    }

    /// The smaller half-edge of the edge between two vertices.
    pub(crate) fn edge_between(&self, [a, b]: [u32; 2]) -> Option<usize> {
        let from = |v: u32| self.first.get(v as usize).copied().flatten();
        let fans = [a, b].into_iter().filter_map(from).flat_map(|first| self.fan(first));
        fans.filter(|&h| [[a, b], [b, a]].contains(&self.ends(h))).min()
    }

    /// The connected components in order of their first faces: the one of each face, and of each the Euler characteristic
    /// and whether it is closed.
    pub(crate) fn components(&self) -> (Vec<usize>, Vec<(i64, bool)>) {
        let mut component_of = vec![None; self.origin.len() / N];
        let mut components = Vec::new();
        for start in 0..component_of.len() {
            let mut stack = vec![start];
            let is_new = component_of[start].is_none();
            while let Some(face) = stack.pop() {
                if component_of[face].is_none() {
                    component_of[face] = Some(components.len());
                    let sides = N * face..N * face + N;
                    stack.extend(sides.filter_map(|h| self.twin[h]).map(|t| t / N));
                }
            }
            components.extend(is_new.then_some((0, true)));
        }
        let component_of: Vec<usize> = component_of.into_iter().flatten().collect();
        component_of.iter().for_each(|&c| components[c].0 += 1);
        for h in self.edges() {
            let (characteristic, is_closed) = &mut components[component_of[h / N]];
            *characteristic -= 1;
            *is_closed &= self.twin[h].is_some();
        }
        self.first.iter().flatten().for_each(|h| components[component_of[h / N]].0 += 1);
        (component_of, components)
    }
}
