//! Every rung of the ladder of layouts, and every metric, has a small surface that needs it.

mod common;

use common::mapped;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::layout::route::Route;
use seamstress_testkit as kit;

/// The rung that held, and how much longer the edges had to be, in mean edge lengths.
fn held(soup: &TriangleSoup) -> (Route, f64) {
    let stats = &mapped(soup).components[0];
    (stats.route, stats.lengthening)
}

/// A strip of needles, as long as 1e8 times their width.
fn needles() -> TriangleSoup {
    let points = (0..8).flat_map(|k| [[f64::from(k), 0.0, 0.0], [f64::from(k), 1e-8, 0.0]]);
    let squares =
        (0..7).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]]);
    TriangleSoup { positions: points.collect(), faces: squares.collect() }
}

/// With every third vertex moved to the origin.
fn with_coincident_vertices(mut soup: TriangleSoup) -> TriangleSoup {
    soup.positions.iter_mut().step_by(3).for_each(|p| *p = [0.0; 3]);
    soup
}

#[test]
fn a_surface_without_seams_is_its_isometric_layout() {
    assert_eq!(held(&needles()), (Route::Isometric, 0.0));
}

#[test]
fn most_layouts_are_rigid() {
    for soup in [kit::octahedron(), kit::random_surface(0), kit::l_bracket()] {
        assert_eq!(held(&soup), (Route::Rigid, 0.0));
    }
}

#[test]
fn flipped_triangles_are_untangled() {
    for seed in [2, 3] {
        let stretched = kit::stretch(&kit::random_surface(seed), [1.0, 1.0, 30.0]);
        assert_eq!(held(&stretched), (Route::Untangled, 0.0), "surface {seed}");
    }
}

#[test]
fn vertices_that_are_wound_too_often_are_unwound() {
    let stretched = kit::stretch(&kit::random_surface(44), [1.0, 1.0, 10.0]);
    assert_eq!(held(&stretched), (Route::Unwound, 0.0));
}

#[test]
fn what_cannot_be_untangled_is_left_to_the_barrier() {
    let stretched = kit::stretch(&kit::bumpy(&kit::tetrahedron(), 0.3, 0), [1.0, 1.0, 1e3]);
    assert_eq!(held(&stretched), (Route::Barrier, 0.0));
}

#[test]
fn triangles_without_area_are_opened_and_no_edge_is_longer() {
    for soup in [kit::tetrahedron(), kit::crown(5), kit::small_sphere(3)] {
        assert_eq!(held(&with_coincident_vertices(soup)), (Route::Rigid, 0.0));
    }
}

#[test]
fn flat_surfaces_may_need_edges_that_are_much_longer() {
    let torus = kit::bumpy(&kit::seven_vertex_torus(), 0.3, 5);
    let (_, lengthening) = held(&kit::stretch(&torus, [1.0, 1.0, 0.0]));
    assert!(lengthening > 0.1, "{lengthening}");
}
