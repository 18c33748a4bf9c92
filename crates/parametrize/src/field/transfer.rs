//! Moving indices to where they are prescribed.

use super::prescription::{ConePrescription, PrescriptionError};
use crate::cut::MatchedCut;
use crate::features::{Sectors, index_bounds};
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use std::collections::VecDeque;

/// How far, in edges, a free cone may lie that takes a unit and vanishes; beyond, a new pair of cones
/// distorts less than a cone torn from its place.
const REACH: u32 = 12;

/// Shifts matchings of a connected mesh without aligned edges until every prescribed index is met; counts the
/// shifts.
///
/// A vertex with a unit too many or too few passes it along a shortest path of edges. It goes to the
/// nearest vertex that needs it, to a free cone near by that it cancels, or over the boundary; else to the
/// nearest free vertex within its bounds.
///
/// # Errors
/// [`PrescriptionError::NoTaker`].
pub fn impose(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: &MatchedCut,
    prescription: &ConePrescription,
) -> Result<(MatchedCut, usize), PrescriptionError> {
    let mesh = sectors.mesh();
    let mut transfer = Transfer {
        mesh,
        index: matched.sector_indices(sectors, metric),
        target: prescription.index(),
        transport: HalfedgeData::filled(mesh.n_halfedges(), 0),
    };
    let mut shifts = 0;
    for v in mesh.vertices() {
        while let Some(unit) = transfer.surplus(v) {
            let path = transfer.path(v, unit);
            if path.is_empty() {
                if prescription.index()[v].is_none() {
                    // As in the repair of indices: the layout must show whether it can be met.
                    break;
                }
                return Err(PrescriptionError::NoTaker { vertex: v.0 });
            }
            shifts += path.len();
            transfer.send(&path, unit);
        }
    }
    let (matched, _) = matched.turned(sectors, &transfer.transport);
    Ok((matched, shifts))
}

struct Transfer<'a> {
    mesh: &'a TriMesh,
    index: VertexData<i32>,
    target: &'a VertexData<Option<i32>>,
    /// Units sent across each half-edge, negated on twins.
    transport: HalfedgeData<i32>,
}

impl Transfer<'_> {
    /// The unit that has to leave a vertex: 1 if it has too much, -1 if too little. Free vertices only when
    /// out of bounds.
    fn surplus(&self, v: Vertex) -> Option<i32> {
        let k = self.index[v];
        let wanted = match self.target[v] {
            _ if self.mesh.is_boundary(v) => k,
            Some(target) => target,
            None => {
                let (low, high) = index_bounds(self.mesh.valence(v));
                k.clamp(low.min(high), high)
            }
        };
        (k != wanted).then(|| (k - wanted).signum())
    }

    /// Shortest path along which the unit leaves a vertex; empty if there is none.
    fn path(&self, start: Vertex, unit: i32) -> Vec<Halfedge> {
        let mut reached: VertexData<Option<(u32, Option<Halfedge>)>> =
            VertexData::filled(self.mesh.n_vertices(), None);
        reached[start] = Some((0, None));
        let mut queue = VecDeque::from([(start, 0)]);
        let (mut second_best, mut goal) = (None, None);
        while let Some((v, depth)) = queue.pop_front() {
            if depth > REACH && second_best.is_some() {
                break;
            }
            if v != start {
                match self.willingness(v, unit) {
                    Willingness::Gladly => {
                        goal = Some(v);
                        break;
                    }
                    Willingness::Willingly => second_best = second_best.or(Some(v)),
                    Willingness::Not => {}
                }
            }
            let across = |h: &Halfedge| self.mesh.twin(*h).is_some();
            for h in self.mesh.outgoing(v).filter(across) {
                let w = self.mesh.tip(h);
                if reached[w].is_none() {
                    reached[w] = Some((depth + 1, Some(h)));
                    queue.push_back((w, depth + 1));
                }
            }
        }
        let mut path = Vec::new();
        let mut at = goal.or(second_best);
        while let Some((_, Some(h))) = at.and_then(|v| reached[v]) {
            path.push(h);
            at = Some(self.mesh.origin(h));
        }
        path
    }

    fn willingness(&self, v: Vertex, unit: i32) -> Willingness {
        if self.mesh.is_boundary(v) {
            return Willingness::Gladly;
        }
        let after = self.index[v] + unit;
        match self.target[v] {
            Some(target) if (target - self.index[v]).signum() == unit => Willingness::Gladly,
            Some(_) => Willingness::Not,
            None => {
                let (low, high) = index_bounds(self.mesh.valence(v));
                match (low..=high).contains(&after) {
                    true if after.abs() < self.index[v].abs() => Willingness::Gladly,
                    true => Willingness::Willingly,
                    false => Willingness::Not,
                }
            }
        }
    }

    fn send(&mut self, path: &[Halfedge], unit: i32) {
        for &h in path {
            self.transport[h] += unit;
            if let Some(t) = self.mesh.twin(h) {
                self.transport[t] -= unit;
            }
            for (v, change) in [(self.mesh.origin(h), -unit), (self.mesh.tip(h), unit)] {
                if !self.mesh.is_boundary(v) {
                    self.index[v] += change;
                }
            }
        }
    }
}

/// Whether a vertex takes a unit.
enum Willingness {
    /// It needs it, or is rid of a cone by it, or is on the boundary.
    Gladly,
    /// It becomes a cone.
    Willingly,
    Not,
}
