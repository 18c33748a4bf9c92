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
fn values_that_do_not_fit_are_refused() {
    let (positions, polygons) = block();
    let surface = Surface::from_polygons(&positions, &polygons).unwrap();
    let quads = surface.quad_mesh(&QuadOptions::count(100)).unwrap();
    let values = attribute(AttributeDomain::Corner, AttributeKind::Number, 1, vec![0.0; 3]);
    let error = quads.transfer(&[values]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Options);
    assert_eq!(error.to_string(), "values: values for 3 corners; the mesh has 376");
}
