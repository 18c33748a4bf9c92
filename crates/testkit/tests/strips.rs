//! Which features a grid has no room for because they run side by side.
#![allow(clippy::unwrap_used)]

use seamstress_mesh::features::{EdgeSet, sharp_edges, strips, strips_and_slivers};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh, Vertex};
use seamstress_testkit::{extruded, subdivide};

/// The lengths of the sharp edges that are kept, and of those that are given up, for cells of an edge length.
fn kept_and_given_up(soup: &TriangleSoup, cell: f64) -> (Vec<f64>, Vec<f64>) {
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let metric = Metric::from_positions(&mesh, &soup.positions);
    let all = sharp_edges(&mesh, &soup.positions, 0.5);
    let strips = strips(&mesh, &soup.positions, &metric, &all, cell);
    let lengths = |edges: &EdgeSet| {
        let mut lengths: Vec<f64> =
            edges.edges().iter().map(|&h| metric.length[h] * metric.unit).collect();
        lengths.sort_by(f64::total_cmp);
        lengths
    };
    (lengths(&all.without(&mesh, strips.edges().iter().copied())), lengths(&strips))
}

/// A cube, one of its edges cut off by this much.
fn chamfered(by: f64) -> TriangleSoup {
    extruded(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0 - by], [1.0 - by, 1.0], [0.0, 1.0]], 1.0)
}

#[test]
fn a_tiny_chamfer_keeps_one_of_its_edges() {
    let (kept, given_up) = kept_and_given_up(&chamfered(0.005), 0.1);
    assert_eq!(given_up, [1.0]);
    assert_eq!(kept.len(), 14);
    // The same of finer meshes.
    let (_, given_up) = kept_and_given_up(&subdivide(&subdivide(&chamfered(0.005))), 0.1);
    assert_eq!(given_up, [0.25; 4]);
}

#[test]
fn a_chamfer_keeps_both_edges_where_cells_are_small() {
    assert!(kept_and_given_up(&chamfered(0.005), 0.05).1.is_empty());
    assert!(kept_and_given_up(&chamfered(0.1), 0.1).1.is_empty());
}

#[test]
fn a_shallow_step_keeps_one_of_its_edges() {
    let outline = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.5, 0.5], [0.5, 0.51], [0.0, 0.51]];
    let (kept, given_up) = kept_and_given_up(&extruded(&outline, 1.0), 0.1);
    assert_eq!(given_up, [1.0]);
    assert_eq!(kept.len(), 17);
}

#[test]
fn a_thin_plate_keeps_its_rims() {
    let plate = extruded(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 0.01);
    assert!(kept_and_given_up(&plate, 0.2).1.is_empty());
}

#[test]
fn a_wedge_keeps_the_edges_that_meet() {
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let wedge = extruded(&[[0.0, 0.0], [1.0, 0.0], [cos, sin]], 0.5);
    let fine = (0..4).fold(wedge, |wedge, _| subdivide(&wedge));
    assert!(kept_and_given_up(&fine, 0.5).1.is_empty());
}

#[test]
fn what_is_left_of_a_chain_beside_a_sliver_is_given_up() {
    // The chain 0-1-2-3 is straight but for the sliver 0-2-1.
    let positions = [[0.0, 0.0], [1.0, 1e-3], [2.0, 0.0], [3.0, 0.0], [1.5, 1.0], [1.5, -1.0]];
    let positions = positions.map(|[x, y]| [x, y, 0.0]);
    let faces = [[0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [0, 5, 2], [2, 5, 3]];
    let mesh = TriMesh::from_faces(6, &faces).unwrap();
    let metric = Metric::from_positions(&mesh, &positions);
    let edges = |pairs: &[[u32; 2]]| {
        let edge = |&[a, b]: &[u32; 2]| mesh.edge_between(Vertex(a), Vertex(b)).unwrap();
        EdgeSet::new(&mesh, pairs.iter().map(edge))
    };
    let given_up =
        |features: &EdgeSet| strips_and_slivers(&mesh, &positions, &metric, features, 1.0);
    assert!(given_up(&edges(&[[0, 1], [1, 2], [2, 3]])).is_empty());
    // Without the middle, both ends would be on lines of their own, a cell apart.
    assert_eq!(given_up(&edges(&[[0, 1], [2, 3]])), edges(&[[0, 1]]));
}
