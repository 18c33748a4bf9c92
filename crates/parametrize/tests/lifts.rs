//! Eq. (13) of Levi 2021 by elimination, against the mixed-integer program as written.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

mod common;

use common::{mapped, surface};
use microlp::{ComparisonOp, OptimizationDirection, Problem};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{HalfedgeData, TriMesh};
use seamstress_parametrize::field::{
    CrossField, Homology, LiftError, NodeIndices, extract, lift, map_indices,
};
use seamstress_testkit as kit;

fn shapes() -> Vec<TriangleSoup> {
    vec![
        kit::tetrahedron(),
        kit::octahedron(),
        kit::cube(),
        kit::l_bracket(),
        kit::icosphere(1),
        kit::seven_vertex_torus(),
        kit::torus(8, 6, 1.0, 0.4),
        kit::double_torus(),
        kit::annulus(8, 2),
        kit::disjoint_union(&[kit::torus(6, 5, 2.0, 0.7), kit::cube()]),
    ]
}

/// Matchings modulo 4 with any lift, and the indices they should have.
struct Case {
    mesh: TriMesh,
    homology: Homology,
    matching: HalfedgeData<i32>,
    found: NodeIndices,
    nodes: NodeIndices,
    loops: Vec<i32>,
}

fn case(soup: &TriangleSoup, seed: u64) -> Case {
    let solution = mapped(soup);
    let (mesh, metric) = surface(soup);
    let homology = Homology::new(&mesh);
    let field = extract(&mesh, &metric, &homology, &solution.map).unwrap();
    let mut rng = kit::Rng::new(seed);
    let mut matching = field.matching().clone();
    for h in mesh.interior_edges() {
        let t = mesh.twin(h).unwrap();
        let turns = 4 * (rng.below(3) as i32 - 1);
        matching[h] += turns;
        matching[t] -= turns;
    }
    let shaken = CrossField::new(&mesh, field.frames().clone(), matching.clone()).unwrap();
    let found = shaken.node_indices(&mesh, &homology);
    let (nodes, loops) = map_indices(&mesh, &homology, solution.map.corner_uvs());
    Case { mesh, homology, matching, found, nodes, loops }
}

impl Case {
    fn lift(&self) -> Result<HalfedgeData<i32>, LiftError> {
        let Self { mesh, homology, matching, found, nodes, loops } = self;
        lift(mesh, homology, matching, found, nodes, loops)
    }

    /// The indices with these full turns added.
    fn indices(&self, turns: &HalfedgeData<i32>) -> (NodeIndices, Vec<i32>) {
        let full = self.matching.iter().zip(turns.iter()).map(|(r, k)| r + 4 * k).collect();
        let frames = vec![num_complex::Complex64::ONE; self.mesh.n_faces()];
        let frames = seamstress_mesh::FaceData(frames);
        let field = CrossField::new(&self.mesh, frames, full).unwrap();
        let index = |l| field.loop_index(&self.mesh, l);
        let loops = self.homology.loops().iter().map(index).collect();
        (field.node_indices(&self.mesh, &self.homology), loops)
    }

    /// (13) as written: integers on all edges, a condition per node and per loop, nothing to minimise.
    fn by_program(&self) -> Option<HalfedgeData<i32>> {
        let mut problem = Problem::new(OptimizationDirection::Minimize);
        let edges: Vec<_> = self.mesh.interior_edges().collect();
        let mut variable: HalfedgeData<Option<(microlp::Variable, f64)>> =
            HalfedgeData::filled(self.mesh.n_halfedges(), None);
        let mut conditions: Vec<Vec<(microlp::Variable, f64)>> =
            vec![Vec::new(); self.homology.n_nodes()];
        for &h in &edges {
            let k = problem.add_integer_var(0.0, (-50, 50));
            let t = self.mesh.twin(h).unwrap();
            (variable[h], variable[t]) = (Some((k, 1.0)), Some((k, -1.0)));
            let node = |v| self.homology.nodes()[v].unwrap() as usize;
            let ends = [node(self.mesh.origin(h)), node(self.mesh.tip(h))];
            if ends[0] != ends[1] {
                conditions[ends[0]].push((k, -4.0));
                conditions[ends[1]].push((k, 4.0));
            }
        }
        for (node, terms) in conditions.iter().enumerate() {
            let wanted = f64::from(self.nodes.0[node] - self.found.0[node]);
            problem.add_constraint(terms, ComparisonOp::Eq, wanted);
        }
        let (_, at_start) = self.indices(&HalfedgeData::filled(self.mesh.n_halfedges(), 0));
        for (l, dual_loop) in self.homology.loops().iter().enumerate() {
            let terms: Vec<_> = dual_loop
                .exits
                .iter()
                .map(|&h| variable[h].unwrap())
                .map(|(k, sign)| (k, 4.0 * sign))
                .collect();
            let wanted = f64::from(self.loops[l] - at_start[l]);
            problem.add_constraint(&terms, ComparisonOp::Eq, wanted);
        }
        let solution = match problem.solve() {
            Ok(outcome) => outcome.into_solution().unwrap(),
            Err(microlp::Error::Infeasible) => return None,
            Err(error) => panic!("{error}"),
        };
        let mut turns = HalfedgeData::filled(self.mesh.n_halfedges(), 0);
        for &h in &edges {
            let k = solution.var_value(variable[h].unwrap().0).round() as i32;
            turns[h] = k;
            turns[self.mesh.twin(h).unwrap()] = -k;
        }
        Some(turns)
    }
}

#[test]
fn elimination_finds_what_the_program_finds() {
    for (seed, soup) in shapes().iter().enumerate() {
        let case = case(soup, seed as u64);
        let wanted = (case.nodes.clone(), case.loops.clone());
        assert_eq!(case.indices(&case.lift().unwrap()), wanted);
        assert_eq!(case.indices(&case.by_program().unwrap()), wanted, "shape {seed}");
    }
}

#[test]
fn what_cannot_be_lifted_is_refused() {
    for (seed, soup) in shapes().iter().enumerate() {
        let mut broken = case(soup, seed as u64);
        // A full turn more at one node breaks the sum.
        broken.nodes.0[0] += 4;
        assert_eq!(broken.lift(), Err(LiftError::Sum { by: 4 }), "shape {seed}");
        assert!(broken.by_program().is_none());
        // Half a turn more at one and less at another are no full turns.
        broken.nodes.0[0] -= 2;
        broken.nodes.0[1] -= 2;
        // (The program would have to branch on every edge to see that.)
        assert!(matches!(broken.lift(), Err(LiftError::Node { node: 0, .. })));
    }
    let mut broken = case(&kit::seven_vertex_torus(), 1);
    broken.loops[1] += 1;
    assert!(matches!(broken.lift(), Err(LiftError::Loop { index: 1, .. })));
}
