//! What each stage keeps before anything is laid out exactly: cuts, unfoldings, indices, roundings.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{real_indices, surface, unwatched};
use seamstress_mesh::Complex64;
use seamstress_mesh::features::sharp_edges;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{
    Face, FaceData, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData,
};
use seamstress_parametrize::Sectors;
use seamstress_parametrize::cut::{
    Cut, DualTree, FramedCut, MatchedCut, SeamGraph, Unfolding, connect_cones, turned_vertices,
    unfold,
};
use seamstress_parametrize::features::index_bounds;
use seamstress_parametrize::rounding::{
    CleanUpOptions, ConeCount, Holonomy, Repair, RoundingOptions, Surrogate, clean_up, repair,
    round,
};
use seamstress_testkit as kit;

fn shapes() -> Vec<TriangleSoup> {
    let mut shapes = vec![
        kit::tetrahedron(),
        kit::cube(),
        kit::seven_vertex_torus(),
        kit::icosphere(2),
        kit::bumpy(&kit::torus(14, 9, 2.0, 0.8), 0.2, 1),
        kit::subdivide(&kit::double_torus()),
        kit::disk_grid(6, 5),
        kit::annulus(9, 3),
        kit::uv_sphere(40, 4),
    ];
    shapes.extend((0..6).map(kit::random_surface));
    shapes
}

/// A weight per edge without pattern or ties.
fn noise(mesh: &TriMesh) -> impl Fn(Halfedge) -> f64 + '_ {
    |h| {
        let (a, b) = (mesh.origin(h).0.min(mesh.tip(h).0), mesh.origin(h).0.max(mesh.tip(h).0));
        kit::Rng::new(u64::from(a) << 32 | u64::from(b)).unit()
    }
}

fn trees(mesh: &TriMesh) -> [DualTree; 2] {
    let nothing = HalfedgeData::filled(mesh.n_halfedges(), false);
    [DualTree::lightest(mesh, noise(mesh)), DualTree::breadth_first(mesh, &nothing).unwrap()]
}

fn rounded_with_frames(mesh: &TriMesh, metric: &Metric) -> FramedCut {
    let sectors = Sectors::unaligned(mesh);
    let unfolding = Unfolding::new(&sectors, metric, DualTree::lightest(mesh, noise(mesh)));
    let options = RoundingOptions::default();
    let rounding = unwatched(|watch| round(&sectors, metric, unfolding, None, &options, watch));
    let FramedCut { matched, frames } = rounding.unwrap().start;
    let Repair { matched, hopeless, .. } = repair(&sectors, metric, matched);
    assert_eq!(hopeless, []);
    FramedCut { matched, frames }
}

fn rounded(mesh: &TriMesh, metric: &Metric) -> MatchedCut {
    rounded_with_frames(mesh, metric).matched
}

#[test]
fn dual_trees_span_the_faces() {
    for soup in shapes() {
        let (mesh, _) = surface(&soup);
        for tree in trees(&mesh) {
            let mut reached = FaceData::filled(mesh.n_faces(), false);
            for (i, &f) in tree.order.iter().enumerate() {
                match tree.parent[f] {
                    None => assert_eq!(i, 0),
                    Some(h) => {
                        assert!(reached[h.face()] && tree.crossed[h]);
                        assert_eq!(mesh.twin(h).unwrap().face(), f);
                    }
                }
                assert!(!std::mem::replace(&mut reached[f], true));
            }
            assert_eq!(tree.order.len(), mesh.n_faces());
            let crossed = mesh.edges().filter(|&h| tree.crossed[h]).count();
            assert_eq!(crossed, mesh.n_faces() - 1);
        }
    }
}

#[test]
fn no_edge_left_out_is_lighter_than_the_tree_between_its_faces() {
    let (mesh, _) = surface(&kit::random_surface(3));
    let weight = noise(&mesh);
    let tree = DualTree::lightest(&mesh, noise(&mesh));
    let to_root = |f: Face| {
        let mut edges = Vec::new();
        let mut next = tree.parent[f];
        while let Some(h) = next {
            edges.push(h);
            next = tree.parent[h.face()];
        }
        edges
    };
    for h in mesh.interior_edges().filter(|&h| !tree.crossed[h]) {
        let (left, right) = (to_root(h.face()), to_root(mesh.twin(h).unwrap().face()));
        let path = left.iter().filter(|e| !right.contains(e));
        let path = path.chain(right.iter().filter(|e| !left.contains(e)));
        assert!(path.into_iter().all(|&e| weight(e) <= weight(h)));
    }
}

#[test]
fn breadth_first_trees_respect_what_is_forbidden() {
    let (mesh, _) = surface(&kit::cube());
    let all = HalfedgeData::filled(mesh.n_halfedges(), true);
    assert!(DualTree::breadth_first(&mesh, &all).is_none());
    let (mesh, metric) = surface(&kit::icosphere(2));
    let cones = mesh.vertices().map(|v| v.0 % 11 == 0).collect();
    let (cut, tree) = connect_cones(&mesh, &metric, &cones).unwrap();
    assert!(mesh.halfedges().all(|h| !(cut.is_seam[h] && tree.crossed[h])));
}

/// Wedges less edges, seams counted twice, plus faces.
fn characteristic(mesh: &TriMesh, cut: &Cut) -> i64 {
    cut.n_wedges as i64 - (mesh.n_edges() + cut.seams.len()) as i64 + mesh.n_faces() as i64
}

#[test]
fn cutting_off_the_tree_leaves_a_disk() {
    for soup in shapes() {
        let (mesh, _) = surface(&soup);
        for tree in trees(&mesh) {
            let cut = Cut::new(&mesh, |h| tree.crossed[h]);
            assert_eq!(characteristic(&mesh, &cut), 1);
            assert_eq!(cut.wedge.iter().max(), Some(&(cut.n_wedges as u32 - 1)));
            for h in mesh.halfedges().filter(|&h| mesh.twin(h).is_some()) {
                let t = mesh.twin(h).unwrap();
                let glued =
                    cut.wedge[h] == cut.wedge[t.next()] && cut.wedge[h.next()] == cut.wedge[t];
                assert!(cut.is_seam[h] || glued);
            }
        }
    }
}

#[test]
fn seams_through_cones_cut_to_a_disk_and_end_nowhere_else() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let mut rng = kit::Rng::new(seed as u64);
        let cones: VertexData<bool> =
            mesh.vertices().map(|v| !mesh.is_boundary(v) && rng.unit() < 0.1).collect();
        let two = cones.iter().filter(|&&c| c).count() >= 2;
        let (cut, _) = connect_cones(&mesh, &metric, &cones).unwrap();
        if two || mesh.genus() > 0 || mesh.has_boundary() {
            assert_eq!(characteristic(&mesh, &cut), 1);
        }
        let graph = SeamGraph::new(&mesh, &cut, &cones);
        for v in mesh.vertices() {
            assert!(!cones[v] || graph.degree[v] > 0 || !two, "cone {} is off the seams", v.0);
            assert!(graph.degree[v] != 1 || cones[v] || mesh.is_boundary(v));
        }
    }
}

#[test]
fn chains_hold_every_seam_once_and_run_between_nodes() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        let cones = turned_vertices(
            &mesh,
            &rounded(&mesh, &metric).matching_per_halfedge(&Sectors::unaligned(&mesh)),
        );
        let (cut, _) = connect_cones(&mesh, &metric, &cones).unwrap();
        let graph = SeamGraph::new(&mesh, &cut, &cones);
        let total: usize = graph.chains.iter().map(|c| c.left.len()).sum();
        assert_eq!(total, cut.seams.len());
        for (id, chain) in graph.chains.iter().enumerate() {
            for pair in chain.left.windows(2) {
                assert_eq!(mesh.tip(pair[0]), mesh.origin(pair[1]));
                assert!(!graph.is_node[mesh.tip(pair[0])]);
            }
            let (first, last) = (chain.left[0], chain.left[chain.left.len() - 1]);
            assert!(graph.is_node[mesh.origin(first)] && graph.is_node[mesh.tip(last)]);
            for &h in &chain.left {
                assert_eq!(graph.chain_of[h], Some((id as u32, true)));
                assert_eq!(graph.chain_of[mesh.twin(h).unwrap()], Some((id as u32, false)));
            }
        }
    }
}

#[test]
fn unfolding_is_isometric() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        for tree in trees(&mesh) {
            let cut = Cut::new(&mesh, |h| tree.crossed[h]);
            let z = unfold(&mesh, &metric, &tree, &cut);
            for f in mesh.faces() {
                let [a, b, c] = f.halfedges().map(|h| z[cut.wedge[h] as usize]);
                let area = ((b - a).conj() * (c - a)).im / 2.0;
                assert!((area - metric.area[f]).abs() < 1e-9 * metric.area[f].max(1.0));
            }
            for h in mesh.halfedges() {
                let [a, b] = cut.ends(h).map(|w| z[w as usize]);
                assert!(((b - a).norm() - metric.length[h]).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn indices_sum_to_four_times_chi_whatever_the_rotations() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        for tree in trees(&mesh) {
            let unfolding = Unfolding::new(&Sectors::unaligned(&mesh), &metric, tree);
            let mut rng = kit::Rng::new(seed as u64);
            let r: Vec<f64> =
                unfolding.cut.seams.iter().map(|_| 20.0 * rng.unit() - 10.0).collect();
            let sum: f64 = unfolding.indices(&Sectors::unaligned(&mesh), &metric, &r).iter().sum();
            assert!((sum - 4.0 * mesh.euler_characteristic() as f64).abs() < 1e-8);
            // At the isometric rotations the index is the curvature.
            let sectors = Sectors::unaligned(&mesh);
            let index = unfolding.indices(&sectors, &metric, &unfolding.isometric);
            for (k, defect) in index.iter().zip(metric.curvature(&mesh).iter()) {
                assert!((k * std::f64::consts::FRAC_PI_2 - defect).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn rounding_and_repair_leave_possible_integers() {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        let matched = rounded(&mesh, &metric);
        let real = real_indices(&mesh, &metric, &matched);
        assert!((real.iter().sum::<f64>() - 4.0 * mesh.euler_characteristic() as f64).abs() < 1e-8);
        let index = matched.sector_indices(&Sectors::unaligned(&mesh), &metric);
        for v in mesh.vertices().filter(|&v| !mesh.is_boundary(v)) {
            assert!((real[v.at()] - f64::from(index[v])).abs() < 1e-8);
            let (low, high) = index_bounds(mesh.valence(v));
            assert!(
                (low..=high).contains(&index[v]),
                "{} at valence {}",
                index[v],
                mesh.valence(v)
            );
        }
        let turned =
            turned_vertices(&mesh, &matched.matching_per_halfedge(&Sectors::unaligned(&mesh)));
        for v in mesh.vertices() {
            assert_eq!(turned[v], index[v].rem_euclid(4) != 0);
        }
    }
}

#[test]
fn repair_brings_any_matching_within_bounds() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let mut matched = MatchedCut::new(
            &Sectors::unaligned(&mesh),
            &metric,
            DualTree::lightest(&mesh, noise(&mesh)),
        );
        let mut rng = kit::Rng::new(seed as u64);
        matched.matching.iter_mut().for_each(|r| *r += rng.below(7) as i32 - 3);
        let Repair { matched, hopeless, .. } = repair(&Sectors::unaligned(&mesh), &metric, matched);
        let index = matched.sector_indices(&Sectors::unaligned(&mesh), &metric);
        for v in mesh.vertices().filter(|&v| !mesh.is_boundary(v)) {
            let (low, high) = index_bounds(mesh.valence(v));
            assert!((low..=high).contains(&index[v]) || hopeless.contains(&v));
        }
        let sum: f64 = real_indices(&mesh, &metric, &matched).iter().sum();
        assert!((sum - 4.0 * mesh.euler_characteristic() as f64).abs() < 1e-7);
    }
}

#[test]
fn the_bounds_of_indices_leave_room_in_the_corners() {
    for valence in 3..300 {
        let (low, high) = index_bounds(valence);
        assert_eq!(high, 3);
        let widest = f64::from(4 - low) * 90.0 / valence as f64;
        assert!(widest < 130.0, "corners of {widest} degrees at valence {valence}");
        assert!(low <= 0 && f64::from(5 - low) * 90.0 / valence as f64 >= 129.0);
    }
}

#[test]
fn new_holonomy_keeps_every_index() {
    for (seed, soup) in shapes().iter().enumerate() {
        let (mesh, metric) = surface(soup);
        let sectors = Sectors::unaligned(&mesh);
        let mut matched = rounded(&mesh, &metric);
        let mut rng = kit::Rng::new(seed as u64);
        matched.matching.iter_mut().for_each(|r| *r += rng.below(3) as i32 - 1);
        let before = matched.sector_indices(&Sectors::unaligned(&mesh), &metric);
        let sum: f64 = real_indices(&mesh, &metric, &matched).iter().sum();
        let frames = vec![Complex64::ONE; mesh.n_faces()];
        let start = FramedCut { matched, frames };
        let fixed = Holonomy::new(&sectors, &metric, None).unwrap().fix(start);
        let FramedCut { matched, frames } = fixed.clone();
        assert_eq!(frames.len(), mesh.n_faces());
        assert_eq!(matched.sector_indices(&Sectors::unaligned(&mesh), &metric), before);
        let after: f64 = real_indices(&mesh, &metric, &matched).iter().sum();
        assert!((sum - after).abs() < 1e-8);
        // What is best is not changed again.
        let again = Holonomy::new(&sectors, &metric, None).unwrap().fix(fixed);
        assert_eq!(again.matched.matching, matched.matching);
    }
}

/// Sectors of a surface with nothing aligned, and of one slit into pieces that are closed, open or bounded by features.
fn with_sectors(test: impl Fn(&Sectors<'_>, &Metric)) {
    for soup in shapes() {
        let (mesh, metric) = surface(&soup);
        test(&Sectors::unaligned(&mesh), &metric);
    }
    for soup in [kit::subdivide(&kit::cube()), kit::subdivide(&kit::l_bracket())] {
        let (mesh, metric) = surface(&soup);
        let creases = sharp_edges(&mesh, &soup.positions, 0.7);
        test(&Sectors::new(&mesh, &metric, &creases), &metric);
    }
}

#[test]
fn the_surrogate_tells_exactly_what_a_unit_of_index_changes() {
    with_sectors(|sectors, metric| {
        let slit = sectors.slit();
        let fixed: Vec<Vertex> = slit.vertices().filter(|&s| !sectors.is_free(s)).collect();
        let mut rng = kit::Rng::new(7);
        let mut index = VertexData::filled(slit.n_vertices(), 0);
        fixed.iter().for_each(|&s| index[s] = rng.below(3) as i32 - 1);
        let mut surrogate = Surrogate::new(sectors, metric, &index).unwrap();
        let energy = surrogate.energy();
        for _ in 0..5 {
            let [near, far] = [(); 2].map(|()| fixed[rng.below(fixed.len())]);
            let response = surrogate.responses(&[near]).pop().unwrap();
            for sign in [1, -1] {
                let told = surrogate.change(sign, [near, far], &response);
                let mut moved = index.clone();
                moved[near] -= sign;
                moved[far] += sign;
                surrogate.refresh(metric, &moved);
                let change = surrogate.energy() - energy;
                surrogate.refresh(metric, &index);
                assert!((told - change).abs() < 1e-4 * (energy + change.abs()), "{told} {change}");
            }
        }
    });
}

#[test]
fn clean_up_never_makes_cones() {
    with_sectors(|sectors, metric| {
        let unfolding = Unfolding::through_curved_sectors(sectors, metric);
        let options = RoundingOptions::default();
        let rounding = unwatched(|watch| round(sectors, metric, unfolding, None, &options, watch));
        let mut start = rounding.unwrap().start;
        let Repair { matched, hopeless, .. } = repair(sectors, metric, start.matched);
        start.matched = matched;
        assert_eq!(hopeless, []);
        let cost = |matched: &MatchedCut| {
            let index = matched.sector_indices(sectors, metric);
            let cones = index.enumerate().filter(|&(s, &k)| k != sectors.preferred(s)).count();
            (cones as i32, Surrogate::new(sectors, metric, &index).unwrap().energy())
        };
        let (before, energy_before) = cost(&start.matched);
        let [nowhere, everywhere] =
            [false, true].map(|held| VertexData::filled(sectors.mesh().n_vertices(), held));
        for price in [0.0006, 0.01, 1.0] {
            let count = ConeCount::Cones;
            let options = CleanUpOptions { price, count, largest_deviation: 1.5 };
            let (FramedCut { matched, .. }, stats) = unwatched(|watch| {
                clean_up(sectors, metric, &start, None, &nowhere, &options, watch)
            })
            .unwrap();
            let (after, energy) = cost(&matched);
            assert_eq!(stats.saved, before - after);
            assert!(stats.saved >= 0);
            assert!((energy - stats.energy).abs() <= 1e-9 * (1.0 + energy));
            // The cones saved pay for what the energy rises.
            let most = energy_before + price * f64::from(stats.saved);
            assert!(energy <= most * (1.0 + 1e-6) + 1e-9, "{energy} {most}");
            let index = matched.sector_indices(sectors, metric);
            for s in sectors.slit().vertices().filter(|&s| !sectors.is_free(s)) {
                let (low, high) = sectors.bounds(s);
                assert!((low..=high).contains(&index[s]));
            }
            // Where cones went from they stay when held, and elsewhere they still go.
            let rounded = start.matched.sector_indices(sectors, metric);
            let mut held = nowhere.clone();
            let gone = sectors.slit().vertices().filter(|&s| rounded[s] != index[s]);
            gone.step_by(2).for_each(|s| held[sectors.vertex(s)] = true);
            for held in [held, everywhere.clone()] {
                let (FramedCut { matched, .. }, stats) = unwatched(|watch| {
                    clean_up(sectors, metric, &start, None, &held, &options, watch)
                })
                .unwrap();
                let cleaned = matched.sector_indices(sectors, metric);
                let is_held = |s: &Vertex| held[sectors.vertex(*s)];
                assert!(
                    sectors.slit().vertices().filter(is_held).all(|s| cleaned[s] == rounded[s])
                );
                if held.iter().all(|&held| held) {
                    assert_eq!(stats.cancelled + stats.moved, 0);
                }
            }
        }
    });
}
