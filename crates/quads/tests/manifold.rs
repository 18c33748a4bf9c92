//! Coarse grids, whose quads could easily be neighbours twice.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::{MapOptions, Purpose, make_map};
use seamstress_quads::manifold_quads;
use seamstress_quantize::{GridSize, QuantizeOptions};
use seamstress_testkit as testkit;
use std::ops::ControlFlow;

/// By how much a grid had to be finer for the quads of a mesh to be a manifold of its topology.
fn refinements(soup: &TriangleSoup, quads: f64) -> usize {
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let size = GridSize::Quads(quads);
    let edge_length = size.cell(Metric::from_positions(&mesh, &soup.positions).side());
    let options = MapOptions { purpose: Purpose::Quads { edge_length }, ..MapOptions::default() };
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &options, &mut go_on).unwrap().map;
    let (nothing, options) =
        (EdgeSet::new(&mesh, []), QuantizeOptions { size, ..QuantizeOptions::default() });
    let made =
        manifold_quads(&mesh, &soup.positions, &map, &nothing, &options, &mut |_| true, &mut go_on);
    let made = made.unwrap();
    assert_eq!(made.connectivity.euler_characteristic(), mesh.euler_characteristic());
    made.quantization.refinements()
}

#[test]
fn no_two_edges_join_the_same_points() {
    let slab = testkit::subdivide(&testkit::slab_with_holes(6));
    let thin = testkit::stretch(&slab, [1.0, 1.0, 0.15]);
    let shapes = [
        testkit::bumpy(&slab, 0.05, 3),
        thin,
        testkit::bumpy(&testkit::subdivide(&testkit::double_torus()), 0.05, 1),
        testkit::bumpy(&testkit::torus(24, 12, 3.0, 0.5), 0.05, 2),
    ];
    for (k, shape) in shapes.iter().enumerate() {
        for quads in [60.0, 120.0, 240.0] {
            assert_eq!(refinements(shape, quads), 0, "shape {k}, {quads} quads");
        }
    }
}
