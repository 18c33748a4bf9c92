//! What layouts keep: seams that close whatever the unknowns, areas, angles, energies, frames.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{surface, unwatched};
use num_complex::Complex64;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use seamstress_parametrize::Sectors;
use seamstress_parametrize::cut::{
    Cut, DualTree, FramedCut, MatchedCut, SeamGraph, Unfolding, connect_cones, regauge,
    turned_vertices, unfold,
};
use seamstress_parametrize::energy::{
    Energy, Jacobian, SymmetricDirichlet, Triangle, is_positive, largest_step, triangles,
};
use seamstress_parametrize::field::{ConePrescription, impose};
use seamstress_parametrize::layout::arap::frames;
use seamstress_parametrize::layout::barrier::barrier;
use seamstress_parametrize::layout::exact::{ExactLayout, angle_sums};
use seamstress_parametrize::layout::ladder::{LayoutEffort, SeamlessLayout, lay_out};
use seamstress_parametrize::layout::newton::{NewtonOptions, Stop, minimize};
use seamstress_parametrize::layout::patch::Patch;
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::layout::space::{LinearSpace, seam_residual, seamless_space};
use seamstress_parametrize::progress::{Watch, go_on};
use seamstress_parametrize::quarter::{rotation, turn};
use seamstress_parametrize::rounding::{RoundingOptions, repair, round};
use seamstress_parametrize::{MapOptions, make_map};
use seamstress_testkit as kit;
use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

fn shapes() -> Vec<TriangleSoup> {
    let mut shapes = vec![
        kit::tetrahedron(),
        kit::cube(),
        kit::seven_vertex_torus(),
        kit::icosphere(2),
        kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.1, 1),
        kit::disk_grid(5, 4),
        kit::with_boundaries(&kit::subdivide(&kit::double_torus()), 2, 1),
    ];
    shapes.extend((0..4).map(kit::random_surface));
    shapes
}

/// Rounded and repaired matchings over a plain tree, with the last frames of the rounding.
fn rounded(mesh: &TriMesh, metric: &Metric) -> FramedCut {
    let sectors = Sectors::unaligned(mesh);
    let tree = DualTree::lightest(mesh, |h| metric.length[h]);
    let unfolding = Unfolding::new(&sectors, metric, tree);
    let options = RoundingOptions::default();
    let rounding = unwatched(|watch| round(&sectors, metric, unfolding, None, &options, watch));
    let FramedCut { matched, frames } = rounding.unwrap().start;
    FramedCut { matched: repair(&sectors, metric, matched).matched, frames }
}

/// The isometric layout of a cut mesh: its triangles and positions.
fn isometric(mesh: &TriMesh, metric: &Metric) -> (Cut, Vec<Triangle>, Vec<Complex64>) {
    let tree = DualTree::lightest(mesh, |h| metric.length[h]);
    let cut = Cut::new(mesh, |h| tree.crossed[h]);
    let z = unfold(mesh, metric, &tree, &cut);
    (cut.clone(), triangles(mesh, metric, &cut), z)
}

/// The exact space over the cut through the cones.
struct Space {
    cut: Cut,
    graph: SeamGraph,
    matching: HalfedgeData<i32>,
    cones: VertexData<bool>,
    space: LinearSpace,
}

fn space_of(mesh: &TriMesh, metric: &Metric) -> Space {
    let full = rounded(mesh, metric).matched.matching_per_halfedge(&Sectors::unaligned(mesh));
    let cones = turned_vertices(mesh, &full);
    let (cut, tree) = connect_cones(mesh, metric, &cones).unwrap();
    let (mut matching, _) = regauge(mesh, &tree, &full);
    for h in mesh.halfedges().filter(|&h| !cut.is_seam[h]) {
        assert_eq!(matching[h].rem_euclid(4), 0, "a turn across an edge that is no seam");
        matching[h] = 0;
    }
    let graph = SeamGraph::new(mesh, &cut, &cones);
    let space = seamless_space(mesh, &cut, &graph, &matching);
    Space { cut, graph, matching, cones, space }
}

fn noise(n: usize, seed: u64) -> Vec<f64> {
    let mut rng = kit::Rng::new(seed);
    (0..n).map(|_| 2.0 * rng.unit() - 1.0).collect()
}

#[test]
fn seams_close_whatever_the_unknowns() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let s = space_of(&mesh, &metric);
        let z = s.space.expand(&noise(s.space.n_unknowns(), seed as u64));
        let size = z.iter().map(|z| z.norm()).fold(1.0, f64::max);
        assert!(seam_residual(&mesh, &s.cut, &s.matching, &z) < 1e-12 * size);
    }
}

/// Image of a point carried across a half-edge by the transition of its seam.
fn carry(s: &Space, mesh: &TriMesh, z: &[Complex64], h: Halfedge, p: Complex64) -> Complex64 {
    let Some(t) = mesh.twin(h).filter(|_| s.cut.is_seam[h]) else { return p };
    let [here, _] = s.cut.ends(h).map(|w| z[w as usize]);
    let [_, there] = s.cut.ends(t).map(|w| z[w as usize]);
    there + turn(p - here, s.matching[h])
}

#[test]
fn transitions_around_vertices_compose_to_identity_or_turn_about_the_cone() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let s = space_of(&mesh, &metric);
        let z = s.space.expand(&noise(s.space.n_unknowns(), seed as u64));
        let size = z.iter().map(|z| z.norm()).fold(1.0, f64::max);
        for v in mesh.vertices().filter(|&v| !mesh.is_boundary(v)) {
            // Clockwise across the outgoing half-edges: each leads to the face on its right.
            let mut fan: Vec<Halfedge> = mesh.outgoing(v).collect();
            fan.reverse();
            let start = z[s.cut.wedge[fan[0]] as usize];
            let around = |p| fan.iter().fold(p, |p, &h| carry(&s, &mesh, &z, h, p));
            assert!((around(start) - start).norm() < 1e-11 * size);
            let (from, to) = (start + 1.0, around(start + 1.0));
            assert_eq!((to - from).norm() > 1e-9 * size, s.cones[v]);
        }
    }
}

#[test]
fn chains_have_one_translation() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let s = space_of(&mesh, &metric);
        let z = s.space.expand(&noise(s.space.n_unknowns(), seed as u64));
        let size = z.iter().map(|z| z.norm()).fold(1.0, f64::max);
        for chain in &s.graph.chains {
            let turns = |h: Halfedge| s.matching[h].rem_euclid(4);
            let translations = chain.left.iter().map(|&h| carry(&s, &mesh, &z, h, Complex64::ZERO));
            let all: Vec<_> = translations.collect();
            assert!(all.iter().all(|t| (t - all[0]).norm() < 1e-11 * size));
            assert!(chain.left.iter().all(|&h| turns(h) == turns(chain.left[0])));
        }
    }
}

#[test]
fn pulling_back_is_the_adjoint_of_expanding() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let space = space_of(&mesh, &metric).space;
        let y = noise(space.n_unknowns(), seed as u64);
        let b: Vec<Complex64> =
            noise(2 * space.n_wedges(), 99).chunks(2).map(|c| Complex64::new(c[0], c[1])).collect();
        let expanded: f64 = space.expand(&y).iter().zip(&b).map(|(z, b)| (z.conj() * b).re).sum();
        let pulled: f64 = space.pull_back(&b).iter().zip(&y).map(|(x, y)| x * y).sum();
        assert!((expanded - pulled).abs() < 1e-9 * (1.0 + expanded.abs()));
    }
}

/// Lays matchings out by the barrier alone: no flips, and the angles of the cones.
fn assert_the_barrier_closes(mesh: &TriMesh, metric: &Metric, matched: &MatchedCut) {
    let sectors = Sectors::unaligned(mesh);
    let whole = Patch::whole(mesh, &matched.unfolding.cut);
    let layout = unwatched(|watch| barrier(&sectors, metric, matched, &whole, watch)).unwrap();
    assert!(layout.gap < 0.05, "a gap of {} edges", layout.gap);
    let triangles = triangles(mesh, metric, &matched.unfolding.cut);
    assert!(triangles.iter().all(|t| t.doubled_area(&layout.z) > 0.0));
    let sums = angle_sums(mesh, &triangles, &layout.z);
    let index = matched.sector_indices(&sectors, metric);
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary(v)) {
        let expected = f64::from(4 - index[v]) * FRAC_PI_2;
        assert!((sums[v] - expected).abs() < 0.7, "vertex {}: {} {expected}", v.0, sums[v]);
    }
}

#[test]
fn the_barrier_ends_with_the_angles_of_the_cones() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        assert_the_barrier_closes(&mesh, &metric, &rounded(&mesh, &metric).matched);
    }
}

#[test]
fn the_barrier_turns_seams_by_more_than_a_half_turn_the_right_way() {
    // Eight cones side by side on a sphere: several units of index cross the same edges.
    let (mesh, metric) = surface(&kit::uv_sphere(16, 10));
    let sectors = Sectors::unaligned(&mesh);
    for (ring, wide) in [(1, 4), (4, 4), (4, 8), (3, 2)] {
        let cone = |k: u32| (1 + 16 * (ring + k / wide) + k % wide, 1);
        let cones: Vec<(u32, i32)> = (0..8).map(cone).collect();
        let prescription = ConePrescription::exactly(&mesh, &cones).unwrap();
        let rounded = rounded(&mesh, &metric).matched;
        let (matched, _) = impose(&sectors, &metric, &rounded, &prescription).unwrap();
        assert!(matched.excess().any(|excess| excess.abs() > 3.0));
        assert_the_barrier_closes(&mesh, &metric, &matched);
    }
}

#[test]
fn exact_layouts_have_the_angles_asked_for() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        let sectors = Sectors::unaligned(&mesh);
        let start = rounded(&mesh, &metric);
        let effort = LayoutEffort::Thorough;
        let layout = unwatched(|watch| lay_out(&sectors, &metric, &start, effort, watch));
        let SeamlessLayout { space, y, .. } = layout.unwrap().unwrap();
        assert!(space.defects(&sectors, &y).none());
        let z = space.expand(&y);
        assert!(seam_residual(&mesh, &space.cut, &space.matching, &z) < 1e-11);
        let sums = angle_sums(&mesh, space.problem().triangles(), &z);
        let index = start.matched.sector_indices(&sectors, &metric);
        for v in mesh.vertices().filter(|&v| !mesh.is_boundary(v)) {
            let expected = f64::from(4 - index[v]) * FRAC_PI_2;
            assert!((sums[v] - expected).abs() < 1e-6);
        }
    }
}

#[test]
fn a_mirrored_layout_is_all_defects() {
    let (mesh, metric) = surface(&kit::cube());
    let FramedCut { matched, frames } = rounded(&mesh, &metric);
    let mut layout = ExactLayout::new(&Sectors::unaligned(&mesh), &metric, &matched).unwrap();
    let y = layout.arap(&frames, 20, &mut Watch::new(&mut go_on, 0, 1)).unwrap();
    assert!(layout.defects(&Sectors::unaligned(&mesh), &y).none());
    let nothing = vec![0.0; y.len()];
    assert_eq!(layout.defects(&Sectors::unaligned(&mesh), &nothing).flips.len(), 12);
    let corners = [Complex64::ZERO, Complex64::ONE, Complex64::I];
    assert!(is_positive(corners) && !is_positive(corners.map(|z| z.conj())));
}

#[test]
fn newton_neither_raises_the_energy_nor_flips() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let (cut, triangles, z) = isometric(&mesh, &metric);
        // Shears every triangle and lets the free space relax it again.
        let sheared: Vec<f64> = z.iter().flat_map(|z| [z.re + 0.8 * z.im, 0.3 * z.im]).collect();
        let space = LinearSpace::free(cut.n_wedges);
        let mut problem = LayoutProblem::new(space, triangles.clone(), None).unwrap();
        let options = NewtonOptions { max_iterations: 1, tolerance: 1e-12 };
        let (mut y, mut energy) = (sheared, f64::INFINITY);
        for _ in 0..30 {
            let step = unwatched(|watch| {
                minimize(&mut problem, y, &SymmetricDirichlet, &options, watch).unwrap()
            });
            assert!(step.energy <= energy, "shape {seed}: {energy} to {}", step.energy);
            assert!(triangles.iter().all(|t| t.doubled_area(&step.z) > 0.0));
            (y, energy) = (step.y, step.energy);
            if step.stop != Stop::IterationLimit {
                break;
            }
        }
        assert!((energy - 4.0).abs() < 1e-6, "shape {seed} stops at {energy}");
    }
}

/// Where the energy is convex, in a layout that is a little too large, its Hessian is assembled as it is.
#[test]
fn the_assembled_hessian_is_the_derivative_of_the_gradient() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let (cut, triangles, z) = isometric(&mesh, &metric);
        let space = LinearSpace::free(cut.n_wedges);
        let mut problem = LayoutProblem::new(space, triangles, None).unwrap();
        let size = z.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let direction: Vec<Complex64> = noise(2 * z.len(), 31 + seed as u64)
            .chunks(2)
            .map(|c| Complex64::new(c[0], c[1]))
            .collect();
        let step = 1e-7 * size;
        let mut gradient = |t: f64| {
            let moved: Vec<_> = z.iter().zip(&direction).map(|(z, d)| 1.1 * z + d * t).collect();
            problem.linearize(&SymmetricDirichlet, &moved)
        };
        let (up, down) = (gradient(step), gradient(-step));
        gradient(0.0);
        let (pattern, values) = problem.matrix();
        let d: Vec<f64> = direction.iter().flat_map(|d| [d.re, d.im]).collect();
        let mut product = vec![0.0; d.len()];
        pattern.multiply(values, &d, &mut product);
        let largest = product.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for ((up, down), product) in up.iter().zip(&down).zip(&product) {
            let slope = (up - down) / (2.0 * step);
            assert!((slope - product).abs() < 1e-4 * largest, "shape {seed}: {slope}, {product}");
        }
    }
}

#[test]
fn the_largest_step_collapses_a_triangle_and_flips_none() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let (_, triangles, z) = isometric(&mesh, &metric);
        for k in 0..5 {
            let dz: Vec<Complex64> = noise(2 * z.len(), 7 * seed as u64 + k)
                .chunks(2)
                .map(|c| Complex64::new(c[0], c[1]))
                .collect();
            let t = largest_step(&triangles, &z, &dz);
            assert!(t > 0.0 && t.is_finite());
            let smallest = |t: f64| {
                let moved: Vec<_> = z.iter().zip(&dz).map(|(z, d)| z + d * t).collect();
                let areas = triangles.iter().map(|t| t.doubled_area(&moved));
                areas.fold(f64::INFINITY, f64::min)
            };
            assert!(smallest(t).abs() < 1e-9, "area {} at the step", smallest(t));
            for part in [0.1, 0.5, 0.9, 0.999] {
                assert!(smallest(part * t) > 0.0);
            }
        }
        // A translation collapses nothing, a contraction everything at once.
        assert_eq!(
            largest_step(&triangles, &z, &vec![Complex64::new(1.0, 2.0); z.len()]),
            f64::INFINITY
        );
        let inwards: Vec<_> = z.iter().map(|z| -z / 4.0).collect();
        assert!((largest_step(&triangles, &z, &inwards) - 4.0).abs() < 1e-6);
    }
}

#[test]
fn singular_values_see_neither_rotation() {
    let mut rng = kit::Rng::new(5);
    let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
        [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
    };
    let turned = |angle: f64| [[angle.cos(), -angle.sin()], [angle.sin(), angle.cos()]];
    for _ in 0..200 {
        let j = [(); 2].map(|()| [(); 2].map(|()| 4.0 * rng.unit() - 2.0));
        let (s1, s2) = Jacobian::from_rows(j).singular_values();
        let [[a, b], [c, d]] = j;
        assert!((s1 * s2 - (a * d - b * c)).abs() < 1e-12);
        assert!((s1 * s1 + s2 * s2 - (a * a + b * b + c * c + d * d)).abs() < 1e-12);
        assert!(s1 >= s2.abs());
        let (left, right) = (turned(7.0 * rng.unit()), turned(7.0 * rng.unit()));
        let around = product(left, product(j, right));
        let (t1, t2) = Jacobian::from_rows(around).singular_values();
        assert!((s1 - t1).abs() < 1e-12 && (s2 - t2).abs() < 1e-12);
        let mirrored = product([[1.0, 0.0], [0.0, -1.0]], j);
        let (m1, m2) = Jacobian::from_rows(mirrored).singular_values();
        assert!((m1 - s1).abs() < 1e-12 && (m2 + s2).abs() < 1e-12);
    }
}

#[test]
fn frames_turn_with_the_layout_and_the_energy_does_not() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        let (_, triangles, z) = isometric(&mesh, &metric);
        let frames_before = frames(&triangles, &z);
        for quarters in [0.0, 0.3, 1.0, 2.0, -1.7] {
            let r = rotation(quarters);
            let turned: Vec<_> = z.iter().map(|z| r * z + Complex64::new(3.0, -1.0)).collect();
            for ((t, before), after) in
                triangles.iter().zip(&frames_before).zip(frames(&triangles, &turned))
            {
                assert!((after - r * before).norm() < 1e-9);
                let (s1, s2) = t.jacobian(&turned).singular_values();
                assert!((SymmetricDirichlet.value(s1, s2) - 4.0).abs() < 1e-9);
            }
        }
        let mirrored: Vec<_> = z.iter().map(|z| z.conj()).collect();
        assert!(triangles.iter().all(|t| t.jacobian(&mirrored).singular_values().1 < 0.0));
    }
}

#[test]
fn a_map_is_its_own_exact_layout() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        let options = MapOptions::default();
        let solution =
            make_map(&mesh, &soup.positions, &options, &mut |_| ControlFlow::Continue(())).unwrap();
        let (layout, y) = ExactLayout::from_map(&mesh, &metric, &solution.map).unwrap();
        assert!(layout.defects(&Sectors::unaligned(&mesh), &y).none());
        let z = layout.expand(&y);
        for f in mesh.faces() {
            let corner = |h: Halfedge| {
                let [u, v] = solution.map.corner_uvs()[h.at()];
                Complex64::new(u, v) / metric.unit
            };
            let [a, b, c] = f.halfedges();
            for (p, q) in [(a, b), (b, c)] {
                let given = turn(corner(q) - corner(p), layout.gauge[f]);
                let here = z[layout.cut.wedge[q] as usize] - z[layout.cut.wedge[p] as usize];
                assert!((given - here).norm() < 1e-9);
            }
        }
    }
}
