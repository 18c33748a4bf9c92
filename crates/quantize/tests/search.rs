//! The search over grids and cuts: what ends it, and which of its means a mesh needs.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Component, TriMesh};
use seamstress_parametrize::{MapOptions, make_map};
use seamstress_quantize::{
    Decisions, GridSize, Quantization, QuantizationFailure, QuantizeError, QuantizeOptions,
    Refusal, quantize_deciding,
};
use seamstress_testkit as testkit;
use std::ops::ControlFlow;

fn run(
    soup: &TriangleSoup,
    size: GridSize,
    effort: usize,
    accept: impl FnMut() -> bool,
) -> Result<Quantization, QuantizeError> {
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    let options = QuantizeOptions { size, effort, ..Default::default() };
    let mut decisions = Accepting(accept);
    let nothing = EdgeSet::new(&mesh, []);
    quantize_deciding(&mesh, &soup.positions, &map, &nothing, &options, &mut decisions, &mut go_on)
}

struct Accepting<F>(F);

impl<F: FnMut() -> bool> Decisions for Accepting<F> {
    fn accept(&mut self, _: &Component, _: &[[f64; 2]]) -> Result<(), Refusal> {
        match (self.0)() {
            true => Ok(()),
            false => Err(Refusal { reason: "for the test".into(), faces: vec![] }),
        }
    }
}

fn found(soup: &TriangleSoup, quads: f64) -> Quantization {
    run(soup, GridSize::Quads(quads), QuantizeOptions::default().effort, || true).unwrap()
}

fn sphere() -> TriangleSoup {
    testkit::bumpy(&testkit::icosphere(2), 0.1, 1)
}

#[test]
fn grids_nearby_come_before_finer_ones() {
    let refused = |n: usize| {
        let mut asked = 0;
        let made = run(&sphere(), GridSize::EdgeLength(0.2), 200, || {
            asked += 1;
            asked > n
        });
        let made = made.unwrap();
        let component = &made.components[0];
        assert_eq!((component.grids, component.refined_because.is_some()), (n + 1, n > 0));
        (component.refinements, made.quads())
    };
    let (_, first) = refused(0);
    let (finer, quads) = refused(2);
    assert!(finer == 0 && (quads / first - 1.0).abs() < 0.1, "{first} and {quads} quads");
    let (finer, quads) = refused(7);
    assert!(finer == 1 && quads > first, "{first} and {quads} quads");
}

#[test]
fn the_search_ends_with_its_budget() {
    let mut grids = 0;
    let made = run(&sphere(), GridSize::Quads(300.0), 3, || {
        grids += 1;
        false
    });
    assert_eq!(grids, 3);
    match made {
        Err(QuantizeError::Components(failed)) => {
            assert!(matches!(failed[0].cause, QuantizationFailure::Refused(_)), "{}", failed[0]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_map_that_was_found_is_not_lost() {
    // Far from the number asked for at first, and no other size is accepted.
    let soup = testkit::random_voxels(3, 3);
    let first = found(&soup, 20.0);
    let mut is_first = true;
    let kept = run(&soup, GridSize::Quads(20.0), 200, || std::mem::take(&mut is_first)).unwrap();
    assert!(first.sizes_tried > 1 && kept.sizes_tried > 1);
    assert!(kept.components[0].grids > kept.sizes_tried);
}

/// Would rather have another map.
struct Wishing;

impl Decisions for Wishing {
    fn goes_on(&mut self, _: &QuantizationFailure) -> bool {
        false
    }
}

#[test]
fn lines_of_a_component_are_measured_by_its_own_cells() {
    let speck = testkit::scale(&testkit::icosphere(1), 0.01);
    let soup = testkit::disjoint_union(&[testkit::icosphere(2), speck]);
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    let options = QuantizeOptions { size: GridSize::Quads(30.0), ..Default::default() };
    let nothing = EdgeSet::new(&mesh, []);
    let (positions, decisions) = (&soup.positions, &mut Wishing);
    let made = quantize_deciding(&mesh, positions, &map, &nothing, &options, decisions, &mut go_on);
    let made = made.unwrap();
    // The small one has the fewest that a component has beside them.
    assert!(made.quads() > 1.1 * 30.0, "{} quads", made.quads());
    assert_eq!(made.crowded, [[0; 2]; 0]);
}

#[test]
fn a_map_with_too_many_cells_is_kept_though_the_caller_would_rather_have_another() {
    // Thinner than a cell, so that its two sides are short lines apart.
    let slab = testkit::subdivide(&testkit::slab_with_holes(6));
    let soup = testkit::stretch(&slab, [1.0, 1.0, 0.15]);
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let mut go_on = |_| ControlFlow::Continue(());
    let map = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut go_on).unwrap().map;
    let options = QuantizeOptions { size: GridSize::Quads(40.0), ..Default::default() };
    let nothing = EdgeSet::new(&mesh, []);
    let mut quantize = |decisions: &mut dyn Decisions| {
        let positions = &soup.positions;
        quantize_deciding(&mesh, positions, &map, &nothing, &options, decisions, &mut go_on)
    };
    let made = quantize(&mut Wishing).unwrap();
    assert!(made.quads() > 1.5 * 40.0 && !made.crowded.is_empty(), "{} quads", made.quads());
    assert!(quantize(&mut ()).unwrap().crowded.is_empty());
}

#[test]
fn what_is_hard_to_keep_comes_first_the_second_time() {
    let made = found(&testkit::random_voxels(3, 1), 30.0);
    assert!(made.components[0].second_roundings > 0);
    assert_eq!(made.refinements(), 0);
}
