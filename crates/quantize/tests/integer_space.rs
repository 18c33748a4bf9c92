//! The exact space of integer maps: whatever integers its coordinates are given, the layout fits, and the
//! other way round.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

#[path = "../../parametrize/tests/common/mod.rs"]
mod common;

use common::mesh_of;
use num_complex::Complex64;
use seamstress_mesh::features::{EdgeSet, sharp_edges};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{HalfedgeData, Metric, TriMesh, Vertex, VertexData};
use seamstress_parametrize::cut::{Cut, connect_cones};
use seamstress_parametrize::cut::{regauge, turned_vertices};
use seamstress_parametrize::{MapOptions, SeamlessMap, make_aligned_map};
use seamstress_quantize::internals::{GridNeeds, IntegerSpace, turning_points};
use seamstress_testkit::{self as kit, Rng};
use std::ops::ControlFlow;

struct Case {
    mesh: TriMesh,
    edges: EdgeSet,
    cut: Cut,
    matching: HalfedgeData<i32>,
    needs: GridNeeds,
    space: IntegerSpace,
    z: Vec<Complex64>,
}

fn case(soup: &TriangleSoup) -> Case {
    let mesh = mesh_of(soup);
    let sharp = sharp_edges(&mesh, &soup.positions, 40f64.to_radians());
    let edges = sharp.union(&mesh, &EdgeSet::boundary(&mesh));
    let mut go_on = |_| ControlFlow::Continue(());
    let options = MapOptions { cone_price: Some(0.0), ..Default::default() };
    let made = make_aligned_map(&mesh, &soup.positions, &edges, &options, &mut go_on).unwrap();
    let released = made.released.iter().map(|f| f.vertices.map(Vertex));
    let edges = edges.without(&mesh, released.map(|[a, b]| mesh.edge_between(a, b).unwrap()));
    over(mesh, soup, edges, &made.map)
}

/// The cut through the cones of a map, its layout on it, and the space.
fn over(mesh: TriMesh, soup: &TriangleSoup, edges: EdgeSet, map: &SeamlessMap) -> Case {
    let metric = Metric::from_positions(&mesh, &soup.positions);
    let mut full = HalfedgeData::filled(mesh.n_halfedges(), 0);
    for seam in map.seams() {
        full[seam.left] = seam.matching;
        full[mesh.twin(seam.left).unwrap()] = -seam.matching;
    }
    let mut is_cone = VertexData::filled(mesh.n_vertices(), false);
    map.cones().iter().for_each(|cone| is_cone[Vertex(cone.vertex)] = true);
    let (cut, tree) = connect_cones(&mesh, &metric, &turned_vertices(&mesh, &full)).unwrap();
    let (mut matching, gauge) = regauge(&mesh, &tree, &full);
    mesh.halfedges().filter(|&h| !cut.is_seam[h]).for_each(|h| matching[h] = 0);
    // Faces one after the other, each moved to meet the one it hangs on.
    let turned = |h: seamstress_mesh::Halfedge| {
        let [u, v] = map.corner_uvs()[h.at()];
        Complex64::new(u, v) * Complex64::I.powi(gauge[h.face()])
    };
    let mut z = vec![Complex64::ZERO; cut.n_wedges];
    for &f in &tree.order {
        let shift = tree.parent[f].map_or(Complex64::ZERO, |h| {
            let t = mesh.twin(h).unwrap();
            let (here, there) = if h.face() == f { (h, t) } else { (t, h) };
            z[cut.wedge[there.next()] as usize] - turned(here)
        });
        f.halfedges().iter().for_each(|&h| z[cut.wedge[h] as usize] = turned(h) + shift);
    }
    let turns = turning_points(&mesh, &edges, |h| z[cut.wedge[h] as usize]);
    let mut needs = GridNeeds::cones(is_cone);
    mesh.vertices().filter(|&v| turns[v]).for_each(|v| needs.is_point[v] = true);
    let at = |h: seamstress_mesh::Halfedge| z[cut.wedge[h] as usize];
    needs.levels = mesh
        .halfedges()
        .filter(|&h| edges.contains(h))
        .map(|h| {
            let way = at(h.next()) - at(h);
            (h, u32::from(way.re.abs() > way.im.abs()))
        })
        .collect();
    let space = IntegerSpace::new(&mesh, &cut, &matching, &needs).unwrap();
    Case { mesh, edges, cut, matching, needs, space, z }
}

fn is_whole(x: f64) -> bool {
    (x - x.round()).abs() < 1e-9
}

#[test]
fn integral_coordinates_are_integral_seams_points_and_isolines() {
    let mut tied = 0;
    for seed in 0..12 {
        let soup = match seed {
            0 => kit::annulus(12, 3),
            1 => kit::saddle(5),
            2 => kit::slab_with_holes(2),
            seed => kit::subdivide(&kit::random_voxels(5, seed)),
        };
        let case = case(&soup);
        let (mesh, space) = (&case.mesh, &case.space);
        let linear = space.linear().unwrap();
        assert_eq!(linear.n_unknowns(), space.n_free() + space.n_held());
        tied += case.needs.levels.len();
        let mut rng = Rng::new(seed);
        for _ in 0..4 {
            let integers: Vec<i64> =
                (0..space.n_coordinates()).map(|_| rng.below(41) as i64 - 20).collect();
            let held = space.expand(&integers).unwrap();
            let free = (0..space.n_free()).map(|_| 10.0 * rng.unit());
            let y: Vec<f64> = free.chain(held.iter().map(|&k| k as f64)).collect();
            let z = linear.expand(&y);
            let at = |h: seamstress_mesh::Halfedge| z[case.cut.wedge[h] as usize];
            for &h in &case.cut.seams {
                let t = mesh.twin(h).unwrap();
                let turn = |z: Complex64| z * Complex64::I.powi(case.matching[h].rem_euclid(4));
                let [first, second] = [at(t.next()) - turn(at(h)), at(t) - turn(at(h.next()))];
                assert!((first - second).norm() < 1e-9, "seed {seed}");
                assert!(is_whole(first.re) && is_whole(first.im), "seed {seed}: {first}");
            }
            for h in mesh.halfedges() {
                if case.needs.is_point[mesh.origin(h)] {
                    assert!(is_whole(at(h).re) && is_whole(at(h).im), "seed {seed}");
                }
            }
            for &(h, coordinate) in &case.needs.levels {
                let [a, b] =
                    [at(h), at(h.next())].map(|z| if coordinate == 0 { z.re } else { z.im });
                assert!(is_whole(a) && (a - b).abs() < 1e-9, "seed {seed}");
            }
            // And what is read from such a layout are the same integers.
            let (coordinates, _) = space.read(&z);
            for (found, &given) in coordinates.iter().zip(&integers) {
                assert!((found - given as f64).abs() < 1e-6, "seed {seed}: {found} for {given}");
            }
        }
    }
    assert!(tied > 100);
}

#[test]
fn layouts_come_back_from_their_unknowns() {
    for soup in [kit::subdivide(&kit::l_bracket()), kit::annulus(12, 3), kit::disk_grid(3, 4)] {
        let case = case(&soup);
        let (_, y) = case.space.read(&case.z);
        let z = case.space.linear().unwrap().expand(&y);
        let shift = z[0] - case.z[0];
        for (found, given) in z.iter().zip(&case.z) {
            assert!((found - given - shift).norm() < 1e-7, "{found} for {given}");
        }
        assert!(!case.edges.is_empty());
    }
}

#[test]
fn unknown_counts() {
    // A square has one vertex more than its four corners can tell of: width and height, with one corner
    // at zero.
    let square = case(&kit::disk_grid(3, 3));
    assert_eq!((square.space.n_coordinates(), square.needs.levels.len()), (2, 12));
    // Of 16 vertices four are held, and eight keep one coordinate.
    assert_eq!(square.space.n_free(), 4 * 2 + 8);
    // A box has length, width and height.
    let cuboid = case(&kit::subdivide(&kit::stretch(&kit::cube(), [1.0, 1.5, 2.0])));
    assert_eq!(cuboid.space.n_coordinates(), 3);
}
