//! From changes of indices to changes of matchings.

use super::groups::{FREE, Groups};
use super::input::{MatchingSet, SeamMatching};
use seamstress_mesh::{TriMesh, Vertex, VertexData};
use std::collections::VecDeque;

/// Adds integers to the integer matchings so that the index of each group changes as asked. Each unit
/// goes from a group that loses one along a shortest path, counted in seams, to one that gains one, or
/// to the boundary. Returns how many matchings changed.
pub(super) fn move_units(
    mesh: &TriMesh,
    groups: &Groups,
    change: &[i32],
    seams: &[SeamMatching],
    matchings: &mut [f64],
) -> usize {
    let outside = groups.len();
    let node = |v: Vertex| match groups.of[v] {
        FREE => outside,
        g => g as usize,
    };
    let mut at = vec![Vec::new(); outside + 1];
    for (s, seam) in seams.iter().enumerate().filter(|(_, s)| s.set == MatchingSet::Integer) {
        // Raising the matching moves a unit of index from the origin to the tip.
        let (from, to) = (node(mesh.origin(seam.left)), node(mesh.tip(seam.left)));
        at[from].push(Step { seam: s, node: to, sign: 1 });
        at[to].push(Step { seam: s, node: from, sign: -1 });
    }
    let mut open = change.to_vec();
    let mut paths = Paths { at: &at, from: vec![None; outside + 1], reached: Vec::new() };
    let mut moved = vec![0i32; seams.len()];
    // Those that lose units first; what is still missing after that comes from the boundary.
    for sign in [-1, 1] {
        for g in 0..outside {
            while open[g] * sign > 0 {
                let ends = |n: usize| n == outside || open[n] * sign < 0;
                let Some((end, path)) = paths.shortest(g, ends) else { break };
                for (seam, direction) in path {
                    moved[seam] -= sign * direction;
                }
                open[g] -= sign;
                if end != outside {
                    open[end] += sign;
                }
            }
        }
    }
    matchings.iter_mut().zip(&moved).for_each(|(r, &m)| *r += f64::from(m));
    moved.iter().filter(|&&m| m != 0).count()
}

#[derive(Clone, Copy)]
struct Step {
    seam: usize,
    node: usize,
    sign: i32,
}

struct Paths<'a> {
    at: &'a [Vec<Step>],
    /// Node before, seam and direction walked; of the nodes reached.
    from: Vec<Option<(usize, usize, i32)>>,
    reached: Vec<usize>,
}

impl Paths<'_> {
    /// Breadth-first path to the nearest end: where it ends, and its seams with the direction walked.
    fn shortest(
        &mut self,
        start: usize,
        ends: impl Fn(usize) -> bool,
    ) -> Option<(usize, Vec<(usize, i32)>)> {
        self.reached.drain(..).for_each(|n| self.from[n] = None);
        let mut queue = VecDeque::from([start]);
        while let Some(n) = queue.pop_front() {
            if n != start && ends(n) {
                let mut path = Vec::new();
                let mut node = n;
                while let Some((before, seam, sign)) = self.from[node].filter(|_| node != start) {
                    path.push((seam, sign));
                    node = before;
                }
                return Some((n, path));
            }
            for step in &self.at[n] {
                if step.node != start && self.from[step.node].is_none() {
                    self.from[step.node] = Some((n, step.seam, step.sign));
                    self.reached.push(step.node);
                    queue.push_back(step.node);
                }
            }
        }
        None
    }
}

/// Changes the real matchings so that every vertex has the index wanted, within each group along a tree
/// of its real seams; groups on the boundary send what is left over there.
pub(super) fn settle_real(
    mesh: &TriMesh,
    index: &VertexData<f64>,
    wanted: &VertexData<f64>,
    seams: &[SeamMatching],
    matchings: &mut [f64],
) {
    let n = mesh.n_vertices();
    let mut at = VertexData::filled(n, Vec::new());
    for (s, seam) in seams.iter().enumerate().filter(|(_, s)| s.set == MatchingSet::Real) {
        let (from, to) = (mesh.origin(seam.left), mesh.tip(seam.left));
        at[from].push((s, to, 1.0));
        at[to].push((s, from, -1.0));
    }
    let mut parent: VertexData<Option<(usize, Vertex, f64)>> = VertexData::filled(n, None);
    let mut reached = VertexData::filled(n, false);
    let mut order = Vec::new();
    let mut lack: VertexData<f64> = mesh.vertices().map(|v| wanted[v] - index[v]).collect();
    let mut flood = |start: Vertex| {
        if std::mem::replace(&mut reached[start], true) {
            return;
        }
        let mut queue = VecDeque::from([start]);
        while let Some(v) = queue.pop_front() {
            order.push(v);
            for &(s, w, sign) in &at[v] {
                if !std::mem::replace(&mut reached[w], true) {
                    parent[w] = Some((s, v, sign));
                    queue.push_back(w);
                }
            }
        }
    };
    mesh.vertices().filter(|&v| mesh.is_boundary(v)).for_each(&mut flood);
    mesh.vertices().for_each(&mut flood);
    for &v in order.iter().rev() {
        // What a vertex lacks comes from its parent; boundary vertices lack nothing.
        if let Some((s, up, sign)) = parent[v].filter(|_| !mesh.is_boundary(v)) {
            matchings[s] += sign * lack[v];
            lack[up] += lack[v];
        }
    }
}
