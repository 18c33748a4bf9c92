//! Vertices that share one index.

use super::error::ConsistencyError;
use super::input::{ConsistencyInput, ConsistencyOptions, MatchingSet, SeamMatching};
use crate::cut::DisjointSets;
use seamstress_mesh::{TriMesh, Vertex, VertexData};
use std::f64::consts::PI;

/// Group of a vertex whose angle sum nothing constrains.
pub(super) const FREE: u32 = u32::MAX;
/// Angle sums are positive by more than rounding errors, quarters.
const POSITIVE: f64 = 1e-6;
/// A sum of indices may be off by this much, quarters.
const SUM_TOLERANCE: f64 = 1e-6;

/// Interior vertices, those joined by real matchings together: only the sum of their indices is
/// constrained. Boundary vertices, and all that real matchings join to them, are free.
pub(super) struct Groups {
    pub(super) of: VertexData<u32>,
    pub(super) list: Vec<Group>,
    /// Groups of each basin, ascending; integer matchings move index anywhere within a basin.
    pub(super) basins: Vec<Basin>,
    /// Whether the mesh component of a group has a boundary.
    pub(super) open: Vec<bool>,
    /// Mesh component of each group.
    pub(super) component: Vec<u32>,
}

/// One group.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// Angle sum at index zero, radians.
    pub(super) full_angle: f64,
    /// Index at the start, quarters.
    pub(super) index: f64,
    /// Least and largest change of the index that triangles can have.
    pub(super) change: (i32, i32),
    pub(super) vertices: u32,
    pub(super) corners: u32,
    pub(super) basin: u32,
}

/// Groups among which index moves.
#[derive(Debug, Clone, Default)]
pub(super) struct Basin {
    pub(super) groups: Vec<u32>,
    /// Whether index can also leave to a free vertex.
    pub(super) open: bool,
}

impl Groups {
    /// Contracts real seams. `indices` are those at rounded integer matchings.
    pub(super) fn new(
        mesh: &TriMesh,
        input: &ConsistencyInput<'_>,
        indices: &VertexData<f64>,
        options: &ConsistencyOptions,
    ) -> Result<Self, ConsistencyError> {
        let (label, n_components) = mesh.connected_faces();
        let has_face = |v: Vertex| mesh.outgoing(v).next();
        let mut joined = united(mesh, input.seams, |set| set == MatchingSet::Real);
        let mut flooded = united(mesh, input.seams, |set| set != MatchingSet::Constant);
        let mut free = vec![false; mesh.n_vertices()];
        let mut flows_out = vec![false; mesh.n_vertices()];
        for v in mesh.vertices().filter(|&v| mesh.is_boundary(v)) {
            free[joined.find(v.0) as usize] = true;
        }
        let mut of = VertexData::filled(mesh.n_vertices(), FREE);
        let mut root_group = vec![FREE; mesh.n_vertices()];
        let (mut list, mut component) = (Vec::<Group>::new(), Vec::new());
        for v in mesh.vertices() {
            let root = joined.find(v.0) as usize;
            let Some(h) = has_face(v) else { continue };
            if free[root] {
                flows_out[flooded.find(v.0) as usize] = true;
                continue;
            }
            if root_group[root] == FREE {
                root_group[root] = list.len() as u32;
                component.push(label[h.face()]);
                let basin = flooded.find(v.0);
                list.push(Group { basin, ..Group::default() });
            }
            of[v] = root_group[root];
            let group = &mut list[of[v] as usize];
            group.full_angle += 2.0 * PI;
            group.vertices += 1;
            group.index += indices[v];
            group.corners += mesh.valence(v) as u32;
        }
        let mut basins = Vec::<Basin>::new();
        let mut root_basin = vec![FREE; mesh.n_vertices()];
        for (g, group) in list.iter_mut().enumerate() {
            let root = group.basin as usize;
            if root_basin[root] == FREE {
                root_basin[root] = basins.len() as u32;
                basins.push(Basin { groups: Vec::new(), open: flows_out[root] });
            }
            group.basin = root_basin[root];
            basins[group.basin as usize].groups.push(g as u32);
            group.change = group.bounds(options.quarters_per_corner);
        }
        for basin in basins.iter().filter(|basin| !basin.open && basin.groups.len() == 1) {
            // Nothing can flow; if that is impossible, the bounds stay and the search will say so.
            let change = &mut list[basin.groups[0] as usize].change;
            if (change.0..=change.1).contains(&0) {
                *change = (0, 0);
            }
        }
        let mut closed = vec![true; n_components];
        for v in mesh.vertices().filter(|&v| mesh.is_boundary(v)) {
            has_face(v).into_iter().for_each(|h| closed[label[h.face()] as usize] = false);
        }
        let mut groups = Self { of, list, basins, open: Vec::new(), component };
        groups.check_sums(mesh, &closed)?;
        groups.open = groups.component.iter().map(|&c| !closed[c as usize]).collect();
        Ok(groups)
    }

    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    fn check_sums(&self, mesh: &TriMesh, closed: &[bool]) -> Result<(), ConsistencyError> {
        let (label, _) = mesh.connected_faces();
        let mut expected = vec![0i64; closed.len()];
        for f in mesh.faces() {
            expected[label[f] as usize] += 4;
        }
        mesh.edges().for_each(|h| expected[label[h.face()] as usize] -= 4);
        for h in mesh.vertices().filter_map(|v| mesh.outgoing(v).next()) {
            expected[label[h.face()] as usize] += 4;
        }
        let (mut sums, mut sizes) = (vec![0.0; closed.len()], vec![0.0; closed.len()]);
        for (group, &c) in self.list.iter().zip(&self.component) {
            sums[c as usize] += group.index;
            sizes[c as usize] += f64::from(group.corners);
        }
        for (component, (&sum, &expected)) in sums.iter().zip(&expected).enumerate() {
            let allowed = SUM_TOLERANCE * (1.0 + sizes[component]).sqrt();
            let off = (sum - expected as f64).abs();
            if closed[component] && (off.is_nan() || off > allowed) {
                return Err(ConsistencyError::IndexSum { component, sum, expected });
            }
        }
        Ok(())
    }
}

impl Group {
    /// Changes that leave an angle sum above zero and below the limit per corner.
    fn bounds(&self, quarters_per_corner: f64) -> (i32, i32) {
        let quarters = self.full_angle / std::f64::consts::FRAC_PI_2 - self.index;
        let most = quarters_per_corner * f64::from(self.corners);
        let high = (quarters - POSITIVE).ceil() as i32 - 1;
        let low = (quarters - most + POSITIVE).floor() as i32 + 1;
        (low.min(high), high)
    }

    /// Units out of bounds after a change: positive if the index is too large.
    pub(super) fn excess(&self, change: i32) -> i32 {
        (change - self.change.1).max(0) - (self.change.0 - change).max(0)
    }
}

fn united(
    mesh: &TriMesh,
    seams: &[SeamMatching],
    which: impl Fn(MatchingSet) -> bool,
) -> DisjointSets {
    let mut sets = DisjointSets::new(mesh.n_vertices());
    for seam in seams.iter().filter(|seam| which(seam.set)) {
        sets.unite(mesh.origin(seam.left).0, mesh.tip(seam.left).0);
    }
    sets
}
