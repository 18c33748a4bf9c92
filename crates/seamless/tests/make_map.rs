//! Maps of shapes whose answer is known, in figures or in structure.
#![allow(clippy::unwrap_used)]

mod common;

use common::{cone_sum, mapped, mesh_of};
use seamstress::MapSolution;
use seamstress_surface::soup::TriangleSoup;
use seamstress_testkit as kit;

#[test]
fn explore() {
    let mut shapes: Vec<(String, TriangleSoup)> = vec![
        ("grid".into(), kit::disk_grid(7, 5)),
        ("cyl".into(), kit::cylinder(12, 4)),
        ("annulus".into(), kit::annulus(12, 4)),
        ("cube".into(), kit::cube()),
        ("cube4".into(), kit::subdivide(&kit::subdivide(&kit::cube()))),
        ("l".into(), kit::l_bracket()),
        ("tet".into(), kit::tetrahedron()),
        ("oct".into(), kit::octahedron()),
        ("ico".into(), kit::icosahedron()),
        ("ico2".into(), kit::icosphere(2)),
        ("torus".into(), kit::torus(24, 12, 2.0, 0.7)),
        ("torus33".into(), kit::torus(3, 3, 2.0, 0.7)),
        ("seven".into(), kit::seven_vertex_torus()),
        ("uv100".into(), kit::uv_sphere(100, 6)),
        ("uv100_2".into(), kit::uv_sphere(100, 2)),
        ("uv3_2".into(), kit::uv_sphere(3, 2)),
        ("saddle".into(), kit::saddle(8)),
        ("monkey".into(), kit::monkey_saddle(8)),
        ("tri".into(), kit::fan(1, 1.0, false)),
        ("doubleb".into(), kit::with_boundaries(&kit::subdivide(&kit::double_torus()), 3, 5)),
        ("two".into(), kit::disjoint_union(&[kit::cube(), kit::torus(12, 8, 2.0, 0.5)])),
    ];
    for g in 0..7 {
        shapes.push((format!("slab{g}"), kit::slab_with_holes(g)));
        shapes.push((format!("slabf{g}"), kit::subdivide(&kit::slab_with_holes(g))));
    }
    for v in [3, 4, 5, 6, 7, 20, 200] {
        for h in [0.0, 0.3, 1.0, 5.0] {
            shapes.push((format!("fan{v} {h}"), kit::fan(v, h, true)));
            shapes.push((format!("ofan{v} {h}"), kit::fan(v, h, false)));
        }
    }
    for (n, s) in [
        ("ico2", kit::icosphere(2)),
        ("torus", kit::torus(20, 12, 2.0, 0.7)),
        ("slab", kit::subdivide(&kit::slab_with_holes(2))),
    ] {
        for h in [0.1, 1.0, 3.0] {
            shapes.push((format!("klee {n} {h}"), kit::klee(&s, h)));
        }
        for f in [
            [1e3, 1.0, 1.0],
            [1.0, 1.0, 1e3],
            [1e-3, 1.0, 1.0],
            [1e4, 1.0, 1.0],
            [1e5, 1.0, 1.0],
            [1.0, 1.0, 1e-5],
        ] {
            shapes.push((format!("stretch {n} {f:?}"), kit::stretch(&s, f)));
        }
        for k in 0..4 {
            shapes.push((
                format!("flips {n} {k}"),
                kit::random_flips(&kit::bumpy(&s, 0.2, k), 5000, k),
            ));
        }
    }
    for (name, soup) in shapes {
        let t = std::time::Instant::now();
        let r = std::panic::catch_unwind(|| mapped(&soup));
        match r {
            Ok(s) => println!(
                "{name}: F {} tau {:.6} sd {:.6} cones {} sum {} route {:?} {:.2}s",
                soup.faces.len(),
                s.distortion.tau,
                s.distortion.symmetric_dirichlet,
                s.map.cones().len(),
                cone_sum(&s),
                s.components[0].route,
                t.elapsed().as_secs_f64()
            ),
            Err(_) => {
                println!("{name}: F {} FAILED {:.2}s", soup.faces.len(), t.elapsed().as_secs_f64())
            }
        }
    }
}
