//! Cross fields of maps, and maps of cross fields.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

mod common;

use common::{assert_seamless, mapped, mesh_of, surface};
use seamstress_mesh::components::FailedComponent;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{HalfedgeData, TriMesh};
use seamstress_parametrize::cut::{FramedCut, Unfolding};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::field::{
    ConePrescription, CrossField, FieldError, Homology, PrescriptionError, directions_in_space,
    extract, frames_from_directions, map_indices, matched_cut, matchings_from_rows, residual_field,
};
use seamstress_parametrize::{
    MapError, MapOptions, MapSolution, MethodError, Start, make_map_from,
};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

fn shapes() -> Vec<TriangleSoup> {
    vec![
        kit::tetrahedron(),
        kit::cube(),
        kit::bumpy(&kit::icosphere(2), 0.15, 1),
        kit::relabel(&kit::torus(16, 8, 1.0, 0.4), 5),
        kit::subdivide(&kit::double_torus()),
        kit::annulus(12, 4),
        kit::saddle(6),
        kit::with_boundaries(&kit::subdivide(&kit::double_torus()), 3, 5),
        kit::disjoint_union(&[kit::torus(9, 7, 2.0, 0.7), kit::l_bracket(), kit::disk_grid(3, 3)]),
    ]
}

fn start(soup: &TriangleSoup, start: &Start) -> Result<MapSolution, MapError> {
    let mut go_on = |_| ControlFlow::Continue(());
    make_map_from(&mesh_of(soup), &soup.positions, start, &MapOptions::default(), &mut go_on)
}

fn cones(solution: &MapSolution) -> Vec<(u32, i32)> {
    solution.map.cones().iter().map(|c| (c.vertex, c.index)).collect()
}

fn field_of(soup: &TriangleSoup, solution: &MapSolution) -> (TriMesh, Homology, CrossField) {
    let (mesh, metric) = surface(soup);
    let homology = Homology::new(&mesh);
    let field = extract(&mesh, &metric, &homology, &solution.map).unwrap();
    (mesh, homology, field)
}

fn loop_indices(mesh: &TriMesh, homology: &Homology, field: &CrossField) -> Vec<i32> {
    homology.loops().iter().map(|l| field.loop_index(mesh, l)).collect()
}

#[test]
fn the_field_of_a_map_has_its_cones_loops_and_transitions() {
    for soup in shapes() {
        let solution = mapped(&soup);
        let (mesh, homology, field) = field_of(&soup, &solution);
        let indices = field.indices(&mesh);
        let found: Vec<(u32, i32)> =
            indices.enumerate().filter(|(_, k)| **k != 0).map(|(v, &k)| (v.0, k)).collect();
        assert_eq!(found, cones(&solution));
        let (nodes, loops) = map_indices(&mesh, &homology, solution.map.corner_uvs());
        assert_eq!(field.node_indices(&mesh, &homology), nodes);
        assert_eq!(loop_indices(&mesh, &homology, &field), loops);
        assert_eq!(i64::from(nodes.0.iter().sum::<i32>()), 4 * mesh.euler_characteristic());
        let mut transitions = HalfedgeData::filled(mesh.n_halfedges(), 0);
        for seam in solution.map.seams() {
            transitions[seam.left] = seam.matching;
        }
        for h in mesh.interior_edges() {
            assert_eq!(field.matching()[h].rem_euclid(4), transitions[h]);
        }
    }
}

#[test]
fn a_map_of_the_field_of_a_map_has_the_same_cones_and_loop_indices() {
    for soup in shapes() {
        let first = mapped(&soup);
        let (mesh, homology, field) = field_of(&soup, &first);
        let second = start(&soup, &Start::Field(field.clone())).unwrap();
        assert_seamless(&soup, &second);
        assert_eq!(cones(&second), cones(&first));
        let (_, _, again) = field_of(&soup, &second);
        assert_eq!(loop_indices(&mesh, &homology, &again), loop_indices(&mesh, &homology, &field));
        assert_eq!(again.node_indices(&mesh, &homology), field.node_indices(&mesh, &homology));
    }
}

#[test]
fn isometric_maps_have_parallel_fields() {
    for soup in [kit::tetrahedron(), kit::cube(), kit::subdivide(&kit::l_bracket())] {
        let (mesh, _, field) = field_of(&soup, &mapped(&soup));
        let (_, metric) = surface(&soup);
        assert!(field.effort(&mesh, &metric).iter().all(|x| x.abs() < 1e-5));
    }
}

#[test]
fn the_field_of_a_cube_by_hand() {
    // Along the edges on every side: three quads meet at each corner.
    let soup = kit::subdivide(&kit::cube());
    let (mesh, metric) = surface(&soup);
    let along = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| soup.positions[v.at()]);
        let is_flat = |i: usize| a[i] == b[i] && b[i] == c[i];
        let mut d = [0.0; 3];
        d[(0..3).find(|&i| !is_flat(i)).unwrap()] = 1.0;
        vec![d]
    };
    let directions: Vec<_> = mesh.faces().map(along).collect();
    let frames = frames_from_directions(&mesh, &soup.positions, &directions).unwrap();
    let field = CrossField::principal(&mesh, &metric, frames).unwrap();
    assert!(field.effort(&mesh, &metric).iter().all(|x| x.abs() < 1e-9));
    let indices = field.indices(&mesh);
    let expected = |v: usize| i32::from(v < 8);
    assert!(indices.iter().enumerate().all(|(v, &k)| k == expected(v)));
    let back = directions_in_space(&mesh, &soup.positions, &field);
    for (cross, given) in back.iter().zip(&directions) {
        assert!((0..3).all(|i| (cross[0][i] - given[0][i]).abs() < 1e-12));
        assert!((0..3).all(|i| (cross[0][i] + cross[2][i]).abs() < 1e-12));
    }
}

#[test]
fn the_field_around_a_torus_has_no_index_anywhere() {
    let soup = kit::relabel(&kit::torus(20, 12, 2.0, 0.7), 11);
    let (mesh, metric) = surface(&soup);
    let around = |f| {
        let corners = mesh.face_vertices(f).map(|v| soup.positions[v.at()]);
        let mean = |i: usize| corners.iter().map(|p| p[i]).sum::<f64>();
        vec![[-mean(1), mean(0), 0.0]]
    };
    let directions: Vec<_> = mesh.faces().map(around).collect();
    let frames = frames_from_directions(&mesh, &soup.positions, &directions).unwrap();
    let field = CrossField::principal(&mesh, &metric, frames).unwrap();
    assert!(field.indices(&mesh).iter().all(|&k| k == 0));
    // A simple loop that does not bound turns as often left as right against a parallel field.
    let homology = Homology::new(&mesh);
    assert_eq!(loop_indices(&mesh, &homology, &field), [0, 0]);
    let solution = start(&soup, &Start::Field(field)).unwrap();
    assert_eq!(cones(&solution), []);
}

#[test]
fn loop_indices_change_with_the_field_along_the_loop() {
    // A quarter turn more on a ring of edges around the tube is seen by loops that cross the ring.
    let soup = kit::torus(20, 12, 2.0, 0.7);
    let (mesh, homology, field) = field_of(&soup, &mapped(&soup));
    let ring = &homology.loops()[0].exits;
    let mut matching = field.matching().clone();
    for &h in ring {
        let t = mesh.twin(h).unwrap();
        matching[h] += 1;
        matching[t] -= 1;
    }
    let turned = CrossField::new(&mesh, field.frames().clone(), matching).unwrap();
    let before = loop_indices(&mesh, &homology, &field);
    let after = loop_indices(&mesh, &homology, &turned);
    assert_eq!(after[0] - before[0], ring.len() as i32);
}

#[test]
fn matchings_alone_or_with_frames_give_the_field_back() {
    for soup in [kit::bumpy(&kit::icosphere(2), 0.1, 4), kit::subdivide(&kit::double_torus())] {
        let solution = mapped(&soup);
        let (mesh, homology, field) = field_of(&soup, &solution);
        let (_, metric) = surface(&soup);
        let frames = field.frames().clone();
        let same = CrossField::with_residues(&mesh, &metric, frames, field.matching()).unwrap();
        assert_eq!(same.indices(&mesh), field.indices(&mesh));
        let alone = residual_field(&mesh, &metric, field.matching()).unwrap();
        assert_eq!(alone.indices(&mesh), field.indices(&mesh));
        assert_eq!(loop_indices(&mesh, &homology, &alone), loop_indices(&mesh, &homology, &field));
    }
}

#[test]
fn a_cut_of_a_field_has_its_indices() {
    for soup in [kit::bumpy(&kit::icosphere(2), 0.1, 4), kit::random_surface(12)] {
        let (mesh, metric) = surface(&soup);
        let (_, _, field) = field_of(&soup, &mapped(&soup));
        let sectors = Sectors::unaligned(&mesh);
        let unfolding = Unfolding::through_curved_sectors(&sectors, &metric);
        let FramedCut { matched, frames } = matched_cut(&mesh, unfolding, &field);
        assert_eq!(matched.sector_indices(&sectors, &metric), field.indices(&mesh));
        assert_eq!(frames.len(), mesh.n_faces());
    }
}

#[test]
fn what_is_no_field_is_refused() {
    let soup = kit::octahedron();
    let (mesh, metric) = surface(&soup);
    let (_, _, field) = field_of(&soup, &mapped(&soup));
    let refused = |frames: &seamstress_mesh::FaceData<_>, matching: &HalfedgeData<i32>| {
        CrossField::new(&mesh, frames.clone(), matching.clone()).unwrap_err()
    };
    let mut short = field.frames().clone();
    short.0.pop();
    let count = FieldError::Count { what: "frames", expected: 8, found: 7 };
    assert_eq!(refused(&short, field.matching()), count);
    let mut long = field.frames().clone();
    long.0[3] *= 2.0;
    assert_eq!(refused(&long, field.matching()), FieldError::NoDirection { face: 3 });
    let mut odd = field.matching().clone();
    odd.0[5] += 1;
    assert!(matches!(refused(field.frames(), &odd), FieldError::BadMatching { .. }));
    let normal = vec![vec![[1.0, 1.0, 1.0]]; 8];
    let error = frames_from_directions(&mesh, &soup.positions, &normal).unwrap_err();
    assert_eq!(error, FieldError::NoDirection { face: 0 });
    let few = HalfedgeData::filled(7, 0);
    assert!(residual_field(&mesh, &metric, &few).is_err());
}

#[test]
fn rows_of_matchings_name_interior_edges_once() {
    let soup = kit::disk_grid(1, 1);
    let mesh = mesh_of(&soup);
    let h = mesh.interior_edges().next().unwrap();
    let ends = [mesh.origin(h).0, mesh.tip(h).0];
    let rows = |rows: &[([i64; 2], [u32; 2], i32)]| matchings_from_rows(&mesh, rows);
    let found = rows(&[([1, 0], ends, 1), ([0, -1], [0, 1], 7)]).unwrap();
    // From face 1 to face 0 by 1 is from face 0 to face 1 by 3.
    assert_eq!(found[h], 3);
    assert_eq!(found[mesh.twin(h).unwrap()], -3);
    assert!(matches!(rows(&[]), Err(FieldError::NoMatching { .. })));
    let twice = rows(&[([0, 1], ends, 1), ([1, 0], ends, 3)]);
    assert!(matches!(twice, Err(FieldError::BadRow { row: 1, repeated: true, .. })));
    for wrong in [([0, 2], ends, 0), ([5, 0], ends, 0), ([0, 1], [9, 9], 0)] {
        assert!(matches!(rows(&[wrong]), Err(FieldError::BadRow { row: 0, repeated: false, .. })));
    }
}

#[test]
fn prescribed_cones_are_those_of_the_map() {
    // Index 1 at eight corners of the octahedron's dual, wherever curvature is.
    let soup = kit::bumpy(&kit::icosphere(3), 0.05, 2);
    let mesh = mesh_of(&soup);
    let corner = |signs: usize| {
        let toward = |v: &usize| {
            let p = soup.positions[*v];
            let sign = |i: usize| if signs >> i & 1 == 1 { 1.0 } else { -1.0 };
            (0..3).map(|i| sign(i) * p[i]).sum::<f64>()
        };
        let far = |a: &usize, b: &usize| toward(a).total_cmp(&toward(b));
        (0..soup.positions.len()).max_by(far).unwrap() as u32
    };
    let mut wanted: Vec<(u32, i32)> = (0..8).map(|s| (corner(s), 1)).collect();
    wanted.sort_unstable();
    let exactly = ConePrescription::exactly(&mesh, &wanted).unwrap();
    let solution = start(&soup, &Start::Cones(exactly)).unwrap();
    assert_seamless(&soup, &solution);
    assert_eq!(cones(&solution), wanted);
    assert!(solution.distortion.tau < 2.5, "tau {}", solution.distortion.tau);
}

#[test]
fn prescribed_cones_on_handles_and_beside_boundaries() {
    for soup in [kit::subdivide(&kit::double_torus()), kit::random_surface(12)] {
        let mesh = mesh_of(&soup);
        let wanted = cones(&mapped(&soup));
        let exactly = ConePrescription::exactly(&mesh, &wanted).unwrap();
        let solution = start(&soup, &Start::Cones(exactly)).unwrap();
        assert_eq!(cones(&assert_found(&soup, solution)), wanted);
    }
}

#[track_caller]
fn assert_found(soup: &TriangleSoup, solution: MapSolution) -> MapSolution {
    assert_seamless(soup, &solution);
    solution
}

#[test]
fn some_cones_may_be_prescribed_and_the_rest_left_free() {
    let soup = kit::bumpy(&kit::icosphere(3), 0.1, 6);
    let mesh = mesh_of(&soup);
    let free = cones(&mapped(&soup));
    let plain = (0..).find(|v| free.iter().all(|(c, _)| c != v)).unwrap();
    let wanted = [(plain, -1), (free[0].0, 0)];
    let some = ConePrescription::among_others(&mesh, &wanted).unwrap();
    let solution = assert_found(&soup, start(&soup, &Start::Cones(some)).unwrap());
    let found = cones(&solution);
    assert!(found.contains(&(plain, -1)));
    assert!(found.iter().all(|(v, _)| *v != free[0].0));
}

#[test]
fn angles_prescribe_every_vertex_inside() {
    let soup = kit::cube();
    let mesh = mesh_of(&soup);
    let quarter = std::f64::consts::FRAC_PI_2;
    let angles = vec![3.0 * quarter; 8];
    let cube = ConePrescription::from_angles(&mesh, &angles).unwrap();
    assert!(cube.index().iter().all(|k| *k == Some(1)));
    let error = |angles: &[f64]| ConePrescription::from_angles(&mesh, angles).unwrap_err();
    assert_eq!(error(&angles[1..]), PrescriptionError::AngleCount { expected: 8, found: 7 });
    let mut odd = angles.clone();
    odd[2] = 2.0;
    assert_eq!(error(&odd), PrescriptionError::NotQuarters { vertex: 2, angle: 2.0 });
    odd[2] = f64::NAN;
    assert!(matches!(error(&odd), PrescriptionError::NotQuarters { vertex: 2, .. }));
    odd[2] = 0.0;
    assert_eq!(error(&odd), PrescriptionError::NoAngle { vertex: 2, index: 4 });
}

#[test]
fn impossible_cones_are_refused_by_name() {
    let sphere = mesh_of(&kit::octahedron());
    let refuse = |cones: &[(u32, i32)]| ConePrescription::exactly(&sphere, cones).unwrap_err();
    let sum = PrescriptionError::Sum { component: 0, sum: 7, expected: 8 };
    assert_eq!(refuse(&[(0, 3), (1, 2), (2, 2)]), sum);
    assert_eq!(refuse(&[(0, 4)]), PrescriptionError::NoAngle { vertex: 0, index: 4 });
    let valence = PrescriptionError::Valence { vertex: 0, index: -4, quarters: 8, valence: 4 };
    assert_eq!(refuse(&[(0, -4)]), valence);
    assert_eq!(refuse(&[(6, 1)]), PrescriptionError::NoVertex { vertex: 6 });
    assert_eq!(refuse(&[(2, 1), (2, 1)]), PrescriptionError::Repeated { vertex: 2 });
    let disk = mesh_of(&kit::disk_grid(2, 2));
    let boundary = ConePrescription::exactly(&disk, &[(0, 1)]).unwrap_err();
    assert_eq!(boundary, PrescriptionError::Boundary { vertex: 0, index: 1 });
    let torus = mesh_of(&kit::torus(9, 7, 2.0, 0.7));
    let pair = ConePrescription::exactly(&torus, &[(3, 1), (8, -1)]).unwrap_err();
    assert_eq!(pair, PrescriptionError::TorusPair { component: 0, plus: 3, minus: 8 });
    assert!(ConePrescription::exactly(&torus, &[(3, 2), (8, -2)]).is_ok());
    // Every vertex fixed but by a list that leaves the sum open.
    let all: Vec<(u32, i32)> = (0..6).map(|v| (v, 1)).collect();
    let sum = ConePrescription::among_others(&sphere, &all).unwrap_err();
    assert_eq!(sum, PrescriptionError::Sum { component: 0, sum: 6, expected: 8 });
}

#[test]
fn cones_that_leave_too_much_are_refused_in_the_ids_of_the_whole_mesh() {
    let soup = kit::disjoint_union(&[kit::cube(), kit::tetrahedron()]);
    // The fourth vertex of the tetrahedron would have to take 11 quarters.
    let cones = [(8, -1), (9, -1), (10, -1)];
    let some = ConePrescription::among_others(&mesh_of(&soup), &cones).unwrap();
    let error = start(&soup, &Start::Cones(some)).unwrap_err();
    let MapError::Components(failed) = error else { panic!("{error}") };
    let [FailedComponent { component: 1, face: 12, cause }] = &failed[..] else {
        panic!("{failed:?}")
    };
    assert!(
        matches!(
            cause,
            MethodError::Cones(PrescriptionError::NoTaker { vertex }) if (8..11).contains(vertex)
        ),
        "{cause}"
    );
}

#[test]
fn fields_that_no_map_follows_are_refused_by_name() {
    let soup = kit::bumpy(&kit::icosphere(1), 0.1, 3);
    let (mesh, _, field) = field_of(&soup, &mapped(&soup));
    // Three units more at one end of an edge are too many.
    let h = mesh.interior_edges().next().unwrap();
    let t = mesh.twin(h).unwrap();
    let mut matching = field.matching().clone();
    matching[h] += 6;
    matching[t] -= 6;
    let broken = CrossField::new(&mesh, field.frames().clone(), matching).unwrap();
    let error = start(&soup, &Start::Field(broken)).unwrap_err();
    assert!(
        matches!(
            error,
            MapError::Cones(PrescriptionError::NoAngle { .. } | PrescriptionError::Valence { .. })
        ),
        "{error}"
    );
    let other = kit::cube();
    let error = start(&other, &Start::Field(field)).unwrap_err();
    assert!(matches!(error, MapError::Field(FieldError::Count { .. })), "{error}");
}

#[test]
fn fields_of_random_surfaces_lead_back() {
    for seed in 100..112 {
        let soup = kit::random_surface(seed);
        let first = mapped(&soup);
        let (mesh, homology, field) = field_of(&soup, &first);
        let second = start(&soup, &Start::Field(field.clone())).unwrap();
        assert_eq!(cones(&second), cones(&first), "seed {seed}");
        let (_, _, again) = field_of(&soup, &second);
        let loops = |field| loop_indices(&mesh, &homology, field);
        assert_eq!(loops(&again), loops(&field), "seed {seed}");
        let nodes = |field: &CrossField| field.node_indices(&mesh, &homology);
        assert_eq!(nodes(&again), nodes(&field), "seed {seed}");
    }
}
