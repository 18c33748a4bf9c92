//! Integer maps of aligned maps: features and boundaries on lines of the grid.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

#[path = "../../parametrize/tests/common/mod.rs"]
mod common;

use common::mesh_of;
use seamstress_mesh::features::{EdgeSet, sharp_edges};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{TriMesh, Vertex};
use seamstress_parametrize::{MapOptions, Tolerance, Violation, make_aligned_map, make_map};
use seamstress_quantize::{
    GridSize, IntegerGridMap, Quantization, QuantizeError, QuantizeOptions, RoundingMethod,
    quantize,
};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

/// The edges with an angle of 40 degrees or more, and the boundary.
fn features(mesh: &TriMesh, soup: &TriangleSoup) -> EdgeSet {
    let sharp = sharp_edges(mesh, &soup.positions, 40f64.to_radians());
    sharp.union(mesh, &EdgeSet::boundary(mesh))
}

/// The aligned map of a shape, rounded.
#[track_caller]
fn rounded(
    soup: &TriangleSoup,
    size: GridSize,
    rounding: RoundingMethod,
) -> (TriMesh, EdgeSet, Result<Quantization, QuantizeError>) {
    let mesh = mesh_of(soup);
    let edges = features(&mesh, soup);
    let mut go_on = |_| ControlFlow::Continue(());
    let positions = &soup.positions;
    let start = make_aligned_map(&mesh, positions, &edges, &MapOptions::default(), &mut go_on);
    let start = start.unwrap();
    // Cubes in a corner may have too few triangles; a boundary has no such excuse.
    assert!(start.released.is_empty() || !mesh.has_boundary(), "{:?}", start.released);
    let released = start.released.iter().map(|f| f.vertices.map(Vertex));
    let edges = edges.without(&mesh, released.map(|[a, b]| mesh.edge_between(a, b).unwrap()));
    let options = QuantizeOptions { size, rounding, ..Default::default() };
    let made = quantize(&mesh, positions, &start.map, &edges, &options, &mut go_on);
    (mesh, edges, made)
}

#[track_caller]
fn integer(soup: &TriangleSoup, size: GridSize) -> (TriMesh, EdgeSet, Quantization) {
    let (mesh, edges, made) = rounded(soup, size, RoundingMethod::Constrained);
    (mesh, edges, made.unwrap())
}

/// Ends of an aligned edge that do not share a whole number, and corners of the shape off the grid, found
/// without the certificate.
fn faults(mesh: &TriMesh, edges: &EdgeSet, uvs: &[[f64; 2]]) -> usize {
    let sides = mesh.halfedges().filter(|&h| edges.contains(h));
    sides
        .filter(|&h| {
            let (a, b) = (uvs[h.at()], uvs[h.next().at()]);
            !(0..2).any(|k| a[k] == b[k] && a[k] == a[k].round())
        })
        .count()
}

#[test]
fn quads_of_aligned_shapes_are_whole() {
    let frame = kit::slab_with_holes(1);
    let shapes = [
        ("box", kit::subdivide(&kit::stretch(&kit::cube(), [1.0, 1.37, 2.11])), 24),
        ("L", kit::subdivide(&kit::l_bracket()), 0),
        ("frame", kit::subdivide(&frame), 0),
        ("square", kit::disk_grid(5, 4), 0),
        ("annulus", kit::annulus(16, 3), 0),
        ("cylinder", kit::cylinder(12, 4), 0),
    ];
    for (name, soup, least_edges) in shapes {
        for quads in [40.0, 300.0, 2000.0] {
            let (mesh, edges, solution) = integer(&soup, GridSize::Quads(quads));
            let (uvs, certificate) = (solution.map.corner_uvs(), solution.map.certificate());
            assert_eq!(faults(&mesh, &edges, uvs), 0, "{name} at {quads}");
            assert_eq!(certificate.isoline_edges, edges.len(), "{name}");
            assert!(edges.len() >= least_edges && !edges.is_empty(), "{name}");
            // Everything is cut along lines of the grid: no partial cells.
            let whole = solution.quads();
            assert!((whole - whole.round()).abs() < 1e-9 && whole >= 1.0, "{name}: {whole}");
            if quads == 2000.0 {
                assert!((whole / quads - 1.0).abs() < 0.1, "{name}: {whole}");
                let [before, after] =
                    [&solution.before, &solution.distortion].map(|d| d.symmetric_dirichlet);
                assert!(after < before + 0.05, "{name}: {before} to {after}");
            }
        }
    }
}

#[test]
fn corners_of_shapes_are_grid_points() {
    let soup = kit::disk_grid(3, 3);
    let (mesh, edges, solution) = integer(&soup, GridSize::Quads(100.0));
    // A square has no cone, four corners, and all of its rim on the grid.
    let certificate = solution.map.certificate();
    assert_eq!((certificate.integral_cones, certificate.integral_corners), (0, 4));
    assert_eq!((certificate.isoline_edges, edges.len()), (12, 12));
    assert!((solution.quads() - 100.0).abs() < 1e-9);
    assert_eq!(mesh.n_boundary_loops(), 1);
    // Open loops of isolines turn nowhere.
    let (_, _, solution) = integer(&kit::cylinder(12, 2), GridSize::Quads(100.0));
    assert_eq!(solution.map.certificate().integral_corners, 0);
}

#[test]
fn parallel_features_stay_a_cell_apart() {
    // Two rims without a corner, a fiftieth of a cell apart, and the sides of a thin plate.
    let low = kit::stretch(&kit::cylinder(16, 2), [1.0, 1.0, 0.02]);
    let plate = kit::subdivide(&kit::stretch(&kit::cube(), [1.0, 1.0, 0.03]));
    for (soup, cell, least) in [(low, 1.0, 6.0), (plate, 0.5, 16.0)] {
        let (mesh, edges, solution) = integer(&soup, GridSize::EdgeLength(cell));
        assert_eq!(faults(&mesh, &edges, solution.map.corner_uvs()), 0);
        assert_eq!(solution.refinements(), 0);
        assert!(solution.quads().round() >= least, "{}", solution.quads());
    }
}

#[test]
fn greedy_rounding_keeps_features_too_where_the_grid_is_fine() {
    let soup = kit::subdivide(&kit::l_bracket());
    let (mesh, edges, made) = rounded(&soup, GridSize::Quads(5000.0), RoundingMethod::Greedy);
    let solution = made.unwrap();
    assert_eq!(faults(&mesh, &edges, solution.map.corner_uvs()), 0);
}

#[test]
fn the_certificate_refuses_features_off_the_grid() {
    let tolerance = Tolerance::default();
    let moved = |solution: &Quantization, by: [f64; 2]| {
        let shift = |uv: &[f64; 2]| [uv[0] + by[0], uv[1] + by[1]];
        solution.map.corner_uvs().iter().map(shift).collect::<Vec<_>>()
    };
    // A square moved by half a cell: no edge between charts notices, the rim and the corners do.
    let (mesh, edges, solution) = integer(&kit::disk_grid(3, 3), GridSize::Quads(100.0));
    let pairs = edges.vertex_pairs(&mesh);
    let half = moved(&solution, [0.5, 0.0]);
    assert!(IntegerGridMap::certify(&mesh, half.clone(), &tolerance).is_ok());
    let found = IntegerGridMap::certify_aligned(&mesh, half, &pairs, &tolerance).unwrap_err().0;
    let off = found.iter().filter(|v| matches!(v, Violation::OffIsoline { .. })).count();
    let corners = found.iter().filter(|v| matches!(v, Violation::FractionalCorner { .. })).count();
    assert_eq!((off, corners, found.len()), (6, 4, 10), "{found:?}");
    let whole = moved(&solution, [-7.0, 3.0]);
    assert!(IntegerGridMap::certify_aligned(&mesh, whole, &pairs, &tolerance).is_ok());

    // The last bit of one end of an edge on the rim.
    let mut nudged = solution.map.corner_uvs().to_vec();
    let h = edges.edges()[1];
    let level = usize::from(nudged[h.at()][1] == nudged[h.next().at()][1]);
    let vertex = mesh.origin(h);
    for corner in mesh.outgoing(vertex) {
        let x = nudged[corner.at()][level];
        nudged[corner.at()][level] = if x == 0.0 { 1e-17 } else { f64::from_bits(x.to_bits() + 1) };
    }
    let found = IntegerGridMap::certify_aligned(&mesh, nudged, &pairs, &tolerance).unwrap_err().0;
    assert!(found.iter().any(|v| matches!(v, Violation::OffIsoline { .. })), "{found:?}");

    // A slanted edge is not aligned at all.
    let soup = kit::disk_grid(3, 3);
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    let diagonal = mesh.edges().find(|&h| !edges.contains(h) && mesh.twin(h).is_some());
    let all = EdgeSet::new(&mesh, mesh.edges());
    assert!(diagonal.is_some());
    let options = QuantizeOptions::default();
    let made = quantize(&mesh, &soup.positions, &map, &all, &options, &mut go_on);
    assert!(matches!(made, Err(QuantizeError::Misaligned(_))), "{made:?}");
}

#[test]
fn isolines_behind_a_cut_are_rounded_again() {
    // Boundaries that leave less than a cell between them.
    let torus = kit::with_boundaries(&kit::torus(16, 10, 2.0, 0.8), 6, 5);
    let soup = kit::bumpy(&torus, 0.1, 6);
    let (mesh, edges, solution) = integer(&soup, GridSize::Quads(60.0));
    let component = &solution.components[0];
    assert!(component.cuts > 0, "the path is free from the start");
    assert_eq!(component.refinements, 0);
    assert_eq!(faults(&mesh, &edges, solution.map.corner_uvs()), 0);
}
