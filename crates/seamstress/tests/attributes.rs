//! What a mesh carries comes over to its quads.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test, with helpers")]

use seamstress::{
    Attribute, AttributeDomain, AttributeKind, ErrorKind, QuadMesh, QuadOptions, Surface,
};
use seamstress_testkit as testkit;

type Point = [f64; 3];

/// A block of 5 by 4 by 3 cubes: its squares as polygons.
fn block() -> (Vec<Point>, Vec<[u32; 4]>) {
    let cells = (0..60).map(|k| [k % 5, k / 5 % 4, k / 20]);
    let soup = testkit::voxel_surface(&cells.collect::<Vec<_>>());
    let squares =
        soup.faces.chunks_exact(2).map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]);
    (soup.positions, squares.collect())
}

/// Which side of the block a polygon lies on, 0 to 5.
fn side(corners: &[Point]) -> usize {
    let is_in = |axis: usize, x: f64| corners.iter().all(|p| (p[axis] - x).abs() < 1e-9);
    let sides = [0.0, 5.0, 0.0, 4.0, 0.0, 3.0];
    (0..6).find(|&k| is_in(k / 2, sides[k])).unwrap()
}

/// UVs that are linear on each side of the block, with seams at all of its edges.
fn box_uv(side: usize, p: Point) -> [f64; 2] {
    let axis = side / 2;
    [p[(axis + 1) % 3] + 10.0 * side as f64, 0.5 * p[(axis + 2) % 3] - p[(axis + 1) % 3]]
}

fn quad_corners(quads: &QuadMesh, quad: usize) -> [Point; 4] {
    quads.quads()[quad].map(|v| quads.positions()[v as usize])
}

fn attribute(
    domain: AttributeDomain,
    kind: AttributeKind,
    width: usize,
    values: Vec<f64>,
) -> Attribute {
    Attribute::new("values", domain, kind, width, values)
}

fn area(corners: &[Point; 4]) -> f64 {
    let cross = |a: Point, b: Point| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let to = |k: usize, l: usize| [0, 1, 2].map(|i| corners[k][i] - corners[l][i]);
    cross(to(2, 0), to(3, 1)).iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
}

#[test]
fn polygons_with_seams_and_materials_come_over() {
    let (positions, polygons) = block();
    let surface = Surface::from_polygons(&positions, &polygons).unwrap();
    let quads = surface.quad_mesh(&QuadOptions::count(600).smooth(3)).unwrap();
    let corners_of = |polygon: &[u32; 4]| polygon.map(|v| positions[v as usize]);
    let uvs = polygons.iter().map(corners_of).flat_map(|c| c.map(|p| box_uv(side(&c), p)));
    let uvs: Vec<f64> = uvs.flatten().collect();
    let colours = positions.iter().flat_map(|p| [p[0] / 5.0, p[1] / 4.0, p[2] / 3.0]).collect();
    let materials = polygons.iter().map(|p| u32::from(side(&corners_of(p)) == 5)).collect();
    let names = ["rust", "chrome"].map(String::from).to_vec();
    let asked = [
        attribute(AttributeDomain::Corner, AttributeKind::Uv, 2, uvs),
        attribute(AttributeDomain::Vertex, AttributeKind::Color, 3, colours),
        Attribute::labels("material", AttributeDomain::Face, names, materials),
    ];
    let carried = quads.transfer(&asked).unwrap();
    let [uv, colour, material] = &carried[..] else { panic!("three for three") };
    let mut chrome = 0.0;
    for quad in 0..quads.quads().len() {
        let corners = quad_corners(&quads, quad);
        let side = side(&corners);
        for (k, &corner) in corners.iter().enumerate() {
            let (found, expected) = (uv.of(4 * quad + k), box_uv(side, corner));
            let gap = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
            assert!(gap < 1e-9, "quad {quad}, corner {k}: {found:?}, not {expected:?}");
        }
        assert_eq!(material.rows[quad] == 1, side == 5);
        chrome += f64::from(material.rows[quad]) * area(&corners);
    }
    assert!((chrome - 20.0).abs() < 0.01 * 20.0, "{chrome}");
    assert_eq!(material.names, ["rust", "chrome"]);
    for (v, p) in quads.positions().iter().enumerate() {
        let expected = [p[0] / 5.0, p[1] / 4.0, p[2] / 3.0];
        let near = colour.of(v).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(near, "{v}: {:?}, {expected:?}", colour.of(v));
    }
}

#[test]
fn copies_of_a_vertex_keep_their_values_when_they_are_merged() {
    // Every square has vertices of its own, and a colour of its own.
    let (positions, polygons) = block();
    let copies: Vec<Point> =
        polygons.as_flattened().iter().map(|&v| positions[v as usize]).collect();
    let squares: Vec<[u32; 4]> =
        (0..polygons.len() as u32).map(|k| [0, 1, 2, 3].map(|i| 4 * k + i)).collect();
    let surface = Surface::from_polygons(&copies, &squares).unwrap();
    assert_eq!(surface.report().boundary_loops, 0);
    let quads = surface.quad_mesh(&QuadOptions::count(400)).unwrap();
    let of_square = |k: usize| side(&squares[k].map(|v| copies[v as usize])) as f64;
    let values = (0..copies.len()).map(|v| of_square(v / 4)).collect();
    let values = attribute(AttributeDomain::Vertex, AttributeKind::Number, 1, values);
    let carried = &quads.transfer(&[values]).unwrap()[0];
    assert_eq!(carried.rows.len(), quads.positions().len());
    for quad in 0..quads.quads().len() {
        let corners = quad_corners(&quads, quad);
        let is_inner = |p: &Point| {
            p.iter()
                .zip([5.0, 4.0, 3.0])
                .filter(|(x, high)| **x > 1e-9 && *x < &(high - 1e-9))
                .count()
                == 2
        };
        for (k, p) in corners.iter().enumerate().filter(|(_, p)| is_inner(p)) {
            let v = quads.quads()[quad][k] as usize;
            assert!((carried.of(v)[0] - side(&corners) as f64).abs() < 1e-9, "{p:?}");
        }
    }
}

#[test]
fn vertices_say_where_they_come_from() {
    let (positions, squares) = block();
    let surface = Surface::from_polygons(&positions, &squares).unwrap();
    let mut options = QuadOptions::count(150);
    (options.shape.raw, options.shape.source_points) = (true, true);
    let quads = surface.quad_mesh(&options).unwrap();
    let carried = quads.attributes().unwrap().all;
    let [face, vertex, weight] = &carried[..] else { panic!("{} attributes", carried.len()) };
    let names = [face, vertex, weight].map(|attribute| attribute.name.as_str());
    assert_eq!(names, ["source_face", "source_vertex", "source_weight"]);
    for (v, p) in quads.positions().iter().enumerate() {
        let square = squares[face.of(v)[0] as usize].map(f64::from);
        let (corners, weights) = (vertex.of(v), weight.of(v));
        assert!(corners.iter().all(|corner| square.contains(corner)), "{corners:?} {square:?}");
        for k in 0..3 {
            let corners = corners.iter().map(|&corner| positions[corner as usize][k]);
            let at: f64 = corners.zip(weights).map(|(x, weight)| x * weight).sum();
            assert!((at - p[k]).abs() < 1e-9, "{v}: {at} {}", p[k]);
        }
    }
    options.shape.source_points = false;
    let quads = surface.quad_mesh(&options).unwrap();
    assert_eq!(quads.attributes().unwrap().all.len(), 0);
}

#[test]
fn values_that_do_not_fit_are_refused() {
    let (positions, polygons) = block();
    let surface = Surface::from_polygons(&positions, &polygons).unwrap();
    let quads = surface.quad_mesh(&QuadOptions::count(100)).unwrap();
    let values = attribute(AttributeDomain::Corner, AttributeKind::Number, 1, vec![0.0; 3]);
    let error = quads.transfer(&[values]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Options);
    assert_eq!(error.to_string(), "values: values for 3 corners; the mesh has 376");
}

#[cfg(feature = "io")]
mod files {
    use super::*;
    use seamstress::{Inspection, MapOptions, SurfaceOptions, UvSet};
    use std::fmt::Write;

    fn read(content: &[u8], name: &str) -> Surface {
        let options = SurfaceOptions::default();
        Inspection::of_file_content(content, name, &options).unwrap().surface().unwrap()
    }

    /// The block with UVs, colours, an object, two materials and their file.
    fn painted() -> Surface {
        let (positions, polygons) = block();
        let mut text = String::from("mtllib paint.mtl\no block\n");
        for [x, y, z] in &positions {
            writeln!(text, "v {x} {y} {z} {} {} {}", x / 5.0, y / 4.0, z / 3.0).unwrap();
        }
        let mut n_uvs = 0;
        for polygon in &polygons {
            let corners = polygon.map(|v| positions[v as usize]);
            let side = side(&corners);
            writeln!(text, "usemtl {}", if side == 5 { "chrome" } else { "rust" }).unwrap();
            for p in corners {
                let [u, v] = box_uv(side, p);
                writeln!(text, "vt {u} {v}").unwrap();
            }
            let [a, b, c, d] =
                [0, 1, 2, 3].map(|k| format!("{}/{}", polygon[k] + 1, n_uvs + k + 1));
            writeln!(text, "f {a} {b} {c} {d}").unwrap();
            n_uvs += 4;
        }
        read(text.as_bytes(), "block.obj")
    }

    fn named<'a>(surface: &'a Surface, name: &str) -> &'a Attribute {
        surface.attributes().all.iter().find(|a| a.name == name).unwrap()
    }

    /// Checks what has been read, whose polygons have these corners, three or four each.
    fn check(surface: &Surface, corners: &[Point], size: usize, name: &str) {
        let uv = named(surface, "uv");
        let (mut chrome, mut whole) = (0.0, 0.0);
        for (face, polygon) in corners.chunks_exact(size).enumerate() {
            let side = side(polygon);
            for (k, &p) in polygon.iter().enumerate() {
                let (found, expected) = (uv.of(size * face + k), box_uv(side, p));
                let gap = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                assert!(gap < 1e-5, "{name}: polygon {face}: {found:?}, not {expected:?}");
            }
            let last = polygon[size - 1];
            let area = area(&[polygon[0], polygon[1], polygon[2], last]);
            let material = named(surface, "material");
            // A PLY file tells names by their numbers, in their order.
            let label = match material.names.get(material.rows[face] as usize) {
                Some(name) => f64::from(u8::from(name == "chrome")),
                None => material.of(face)[0],
            };
            chrome += if label == 1.0 { area } else { 0.0 };
            whole += area;
        }
        // The share of the top in the surface.
        assert!((chrome / whole - 20.0 / 94.0).abs() < 0.01 * 20.0 / 94.0, "{name}: {chrome}");
        let colour = named(surface, "color");
        let of = |face: usize, k: usize| match colour.domain {
            AttributeDomain::Corner => colour.of(size * face + k),
            _ => colour.of(surface.faces()[face][k] as usize),
        };
        for face in 0..surface.faces().len() {
            for k in (0..3).filter(|_| size == 3 || colour.domain == AttributeDomain::Vertex) {
                let p = surface.positions()[surface.faces()[face][k] as usize];
                let expected = [p[0] / 5.0, p[1] / 4.0, p[2] / 3.0];
                let near = of(face, k).iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.003);
                assert!(near, "{name}: {:?}, not {expected:?}", of(face, k));
            }
        }
    }

    #[test]
    fn quads_carry_what_the_file_said_in_each_format() {
        let surface = painted();
        let quads = surface.quad_mesh(&QuadOptions::count(400)).unwrap();
        let corners = quads.quads().as_flattened().iter().map(|&v| quads.positions()[v as usize]);
        let corners: Vec<Point> = corners.collect();
        for name in ["q.obj", "q.ply", "q.glb"] {
            let mut bytes = Vec::new();
            quads.write_as(name, &mut bytes).unwrap();
            let again = read(&bytes, name);
            match name {
                "q.glb" => {
                    let of_faces = again.faces().as_flattened();
                    let corners = of_faces.iter().map(|&v| again.positions()[v as usize]);
                    let corners: Vec<Point> =
                        corners.map(|p| p.map(|x| (x * 1e6).round() / 1e6)).collect();
                    check(&again, &corners, 3, name);
                }
                _ => check(&again, &corners, 4, name),
            }
            if name == "q.obj" {
                assert_eq!(again.attributes().material_files, ["paint.mtl"]);
                assert_eq!(again.attributes().labels("object").unwrap().names, ["block"]);
            }
        }
    }

    #[test]
    fn maps_keep_what_the_file_said() {
        let surface = painted();
        let map = surface.parametrize(&MapOptions::default()).unwrap();
        let mut text = Vec::new();
        map.write_as("m.obj", UvSet::Second, &mut text).unwrap();
        let obj = read(&text, "m.obj");
        // OBJ has one set of UVs: the map.
        let uv = named(&obj, "uv");
        for (corner, expected) in map.corner_uvs().iter().enumerate() {
            assert_eq!(uv.of(corner), expected);
        }
        assert_eq!(named(&obj, "color").values, named(&surface, "color").values);
        let mut bytes = Vec::new();
        map.write_as("m.ply", UvSet::First, &mut bytes).unwrap();
        let ply = read(&bytes, "m.ply");
        assert_eq!((ply.positions(), ply.faces()), (surface.positions(), surface.faces()));
        let uv = named(&ply, "uv");
        for (corner, expected) in map.corner_uvs().iter().enumerate() {
            assert_eq!(uv.of(corner), expected.map(|x| f64::from(x as f32)));
        }
        let chrome = named(&obj, "material").rows.iter().filter(|&&row| row == 1).count();
        assert_eq!(chrome, 2 * 20);
        assert_eq!(obj.attributes().material_files, ["paint.mtl"]);
        for (set, ours, theirs) in [(UvSet::First, "uv", "uv1"), (UvSet::Second, "uv1", "uv")] {
            let mut bytes = Vec::new();
            map.write_as("m.glb", set, &mut bytes).unwrap();
            let glb = read(&bytes, "m.glb");
            assert_eq!(glb.faces().len(), surface.faces().len());
            // Faces of a material come together; each is found by its corners.
            let key = |surface: &Surface, f: usize| {
                surface.faces()[f].map(|v| surface.positions()[v as usize].map(f64::to_bits))
            };
            let place: std::collections::HashMap<_, _> =
                (0..glb.faces().len()).map(|f| (key(&glb, f), f)).collect();
            for f in 0..surface.faces().len() {
                let other = place[&key(&surface, f)];
                let corners = surface.faces()[f].map(|v| surface.positions()[v as usize]);
                for (k, &p) in corners.iter().enumerate() {
                    let near = |found: &[f64], expected: [f64; 2]| {
                        let gap =
                            (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                        assert!(gap < 1e-5, "{set:?}: {found:?}, not {expected:?}");
                    };
                    near(named(&glb, ours).of(3 * other + k), map.corner_uvs()[3 * f + k]);
                    near(named(&glb, theirs).of(3 * other + k), box_uv(side(&corners), p));
                }
            }
        }
    }

    #[test]
    fn a_file_that_says_nothing_more_becomes_one_that_does_not_either() {
        let (positions, polygons) = block();
        let surface = Surface::from_polygons(&positions, &polygons).unwrap();
        let mut text = Vec::new();
        surface.quad_mesh(&QuadOptions::count(100)).unwrap().write_as("q", &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let is_plain = |line: &str| {
            line.starts_with('#')
                || line.split(' ').count() == [4, 5][usize::from(line.starts_with("f "))]
        };
        assert!(
            text.lines().all(|line| is_plain(line) && !line.contains('/') || line.starts_with('#')),
            "{text}"
        );
    }

    #[test]
    fn attributes_may_be_given() {
        let (positions, polygons) = block();
        let surface = Surface::from_polygons(&positions, &polygons).unwrap();
        let heat = positions.iter().map(|p| p[0]).collect();
        let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Number);
        let heat = Attribute::new("heat", domain, kind, 1, heat);
        let warm = surface.clone().with_attributes(vec![heat.clone()].into()).unwrap();
        let mut bytes = Vec::new();
        let quads = warm.quad_mesh(&QuadOptions::count(300)).unwrap();
        quads.write_as("q.ply", &mut bytes).unwrap();
        let again = read(&bytes, "q.ply");
        for (v, p) in again.positions().iter().enumerate() {
            assert!((named(&again, "heat").of(v)[0] - p[0]).abs() < 1e-9);
        }
        let short = heat.on(domain, 0..3);
        let error = surface.with_attributes(vec![short].into()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Options);
    }
}
