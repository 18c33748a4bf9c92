//! The shapes of `tests/data`.

use super::PolygonSoup;
use super::implicit::surface;
use super::planar::Planar;
use crate::{disjoint_union, icosphere, saddle, scale, torus, uv_sphere, voxel_surface};
use seamstress_mesh::soup::TriangleSoup;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A flat plate with two large and two small round holes.
pub(super) fn plate_with_holes() -> PolygonSoup {
    let hole = |x, y| match (x, y) {
        (1 | 3, 1) => Some(0.4),
        (0, 0) | (4, 2) => Some(0.2),
        _ => None,
    };
    Planar::blocks([5, 3], 3, hole).extruded(&[0.0, 0.25, 0.5])
}

/// A wheel with twelve teeth and a bore.
pub(super) fn gear() -> PolygonSoup {
    const TEETH: u32 = 12;
    const STEPS: u32 = 4 * TEETH;
    let at = |radius: f64, step: f64| {
        let angle = step / f64::from(STEPS) * TAU;
        [radius * angle.cos(), radius * angle.sin()]
    };
    let mut planar = Planar::default();
    for step in (0..STEPS).map(f64::from) {
        for (low, high) in [(0.35, 0.55), (0.55, 0.75)] {
            planar.face(&[
                at(low, step),
                at(high, step),
                at(high, step + 1.0),
                at(low, step + 1.0),
            ]);
        }
    }
    for tooth in (0..TEETH).map(|t| 4.0 * f64::from(t)) {
        for half in [0.0, 1.0] {
            // Teeth get narrower: their outer points lie a quarter step further in.
            let outer = |step: f64| tooth + 1.0 + 0.75 * (step - 1.0);
            let [a, b] = [tooth + half, tooth + half + 1.0];
            let [c, d] = [half, half + 1.0].map(outer);
            planar.face(&[at(0.75, a), at(1.0, c), at(1.0, d), at(0.75, b)]);
        }
    }
    planar.extruded(&[0.0, 0.15, 0.3])
}

/// A beam with an L as its section.
pub(super) fn l_beam() -> PolygonSoup {
    let mut planar = Planar::default();
    let arms = (0..4).map(|x| [x, 0]).chain((1..4).map(|y| [0, y]));
    for [x, y] in arms.map(|cell| cell.map(f64::from)) {
        planar.face(&[[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]]);
    }
    let heights: Vec<f64> = (0..=12).map(f64::from).collect();
    scaled(planar.extruded(&heights), 0.25)
}

/// A strip of sheet metal with three holes, bent by a right angle.
pub(super) fn angle_bracket() -> PolygonSoup {
    const BEND: [f64; 2] = [2.5, 4.0];
    let hole = |x, y| matches!((x, y), (0 | 1 | 5, 1)).then_some(0.3);
    let flat = Planar::blocks([7, 3], 3, hole).extruded(&[0.0, 0.2]);
    let radius = (BEND[1] - BEND[0]) / FRAC_PI_2;
    let bent = |[x, y, z]: [f64; 3]| {
        let angle = (x.clamp(BEND[0], BEND[1]) - BEND[0]) / radius;
        let beyond = if x > BEND[1] { x - BEND[1] } else { (x - BEND[0]).min(0.0) };
        let (sin, cos) = angle.sin_cos();
        let [right, up] = [(radius - z) * sin, radius - (radius - z) * cos];
        [BEND[0] + right + beyond * cos, y, up + beyond * sin]
    };
    moved(flat, bent)
}

/// A barrel vault with two holes: an open surface with three rims, curved both ways.
pub(super) fn shell() -> PolygonSoup {
    let hole = |x, y| matches!((x, y), (1, 1) | (4, 2)).then_some(0.35);
    Planar::blocks([6, 4], 3, hole).lifted(|[x, y]| {
        let radius = 3.0 - 0.12 * (y - 2.0) * (y - 2.0);
        let angle = (x - 3.0) / 3.0;
        [radius * angle.sin(), y, radius * angle.cos()]
    })
}

/// A sheet a hundredth as thick as it is wide, with a hole.
pub(super) fn thin_plate() -> PolygonSoup {
    let hole = |x, y| ((x, y) == (1, 2)).then_some(0.4);
    Planar::blocks([4, 4], 3, hole).extruded(&[0.0, 0.04])
}

/// A spindle whose triangles at the ends have angles of a degree or two.
pub(super) fn needles() -> PolygonSoup {
    let sphere = uv_sphere(48, 6);
    moved(of_triangles(sphere), |[x, y, z]| [0.4 * x, 0.4 * y, 1.6 * z])
}

/// A tube along a trefoil knot.
pub(super) fn trefoil() -> PolygonSoup {
    const ALONG: u32 = 96;
    const AROUND: u32 = 8;
    const RADII: [f64; 3] = [2.0, 0.9, 0.35];
    let [ring, reach, tube] = RADII;
    let knot = |t: f64| {
        let (long, round) = (2.0 * t, 3.0 * t);
        let from_axis = ring + reach * round.cos();
        [from_axis * long.cos(), from_axis * long.sin(), reach * round.sin()]
    };
    let position = |i: u32, j: u32| {
        let t = f64::from(i) / f64::from(ALONG) * TAU;
        let (ahead, behind, here) = (knot(t + 1e-3), knot(t - 1e-3), knot(t));
        let tangent = unit([0, 1, 2].map(|k| ahead[k] - behind[k]));
        let (long, round) = (2.0 * t, 3.0 * t);
        let outwards = [round.cos() * long.cos(), round.cos() * long.sin(), round.sin()];
        let side = unit(cross(tangent, outwards));
        let (sin, cos) = (f64::from(j) / f64::from(AROUND) * TAU).sin_cos();
        [0, 1, 2].map(|k| here[k] + tube * (cos * outwards[k] + sin * side[k]))
    };
    let positions = (0..ALONG).flat_map(|i| (0..AROUND).map(move |j| position(i, j))).collect();
    let at = |i: u32, j: u32| i % ALONG * AROUND + j % AROUND;
    let quad = |i: u32, j: u32| vec![at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
    let polygons = (0..ALONG).flat_map(|i| (0..AROUND).map(move |j| quad(i, j))).collect();
    PolygonSoup { positions, polygons }
}

/// Two rings that hang in each other, a ball and an open saddle: four components.
pub(super) fn linked_rings() -> PolygonSoup {
    let ring = torus(20, 9, 1.0, 0.3);
    let place = |soup: &TriangleSoup, place: fn([f64; 3]) -> [f64; 3]| TriangleSoup {
        positions: soup.positions.iter().map(|&p| place(p)).collect(),
        faces: soup.faces.clone(),
    };
    of_triangles(disjoint_union(&[
        ring.clone(),
        place(&ring, |[x, y, z]| [x + 1.0, -z, y]),
        place(&scale(&icosphere(2), 0.4), |[x, y, z]| [x + 0.5, y + 2.0, z]),
        place(&saddle(6), |[x, y, z]| [x - 2.0, y + 2.0, z]),
    ]))
}

/// Four balls that flow together: a smooth surface without any symmetry.
pub(super) fn blob() -> PolygonSoup {
    const BALLS: [([f64; 3], f64); 4] = [
        ([-0.32, -0.11, 0.05], 0.40),
        ([0.30, -0.23, -0.14], 0.33),
        ([0.13, 0.36, 0.11], 0.30),
        ([-0.14, 0.18, -0.40], 0.25),
    ];
    surface(19, |p| {
        let part = |(centre, radius): &([f64; 3], f64)| {
            let square: f64 = (0..3).map(|k| (p[k] - centre[k]).powi(2)).sum();
            radius * radius / square.max(1e-9)
        };
        BALLS.iter().map(part).sum::<f64>() - 1.6
    })
}

/// The twelve edges of a cube as rounded bars: genus 5.
pub(super) fn cube_frame() -> PolygonSoup {
    const SIDE: i32 = 5;
    let is_end = |k: &&i32| **k == 0 || **k == SIDE - 1;
    let cells =
        (0..SIDE).flat_map(|x| (0..SIDE).flat_map(move |y| (0..SIDE).map(move |z| [x, y, z])));
    let bars: Vec<[i32; 3]> = cells.filter(|c| c.iter().filter(is_end).count() >= 2).collect();
    let soup = voxel_surface(&bars);
    let pairs = soup.faces.chunks_exact(2);
    let polygons = pairs.map(|pair| vec![pair[0][0], pair[0][1], pair[0][2], pair[1][2]]).collect();
    let mut frame = PolygonSoup { positions: soup.positions, polygons };
    (0..2).for_each(|_| frame = smoothed(&frame));
    scaled(frame, 0.2)
}

/// Twelve pentagons and 150 hexagons on a sphere: the dual of a subdivided icosahedron.
pub(super) fn goldberg() -> PolygonSoup {
    let sphere = icosphere(2);
    let centre = |face: &[u32; 3]| {
        let corners = face.map(|v| sphere.positions[v as usize]);
        unit([0, 1, 2].map(|k| corners.iter().map(|p| p[k]).sum::<f64>()))
    };
    let positions = sphere.faces.iter().map(centre).collect();
    // Around each vertex: from a face to the one across its side that arrives there.
    let next = |v: u32, face: usize| {
        let at = sphere.faces[face].iter().position(|&w| w == v).unwrap();
        let last = sphere.faces[face][(at + 2) % 3];
        let leaves = |f: &[u32; 3]| (0..3).any(|k| f[k] == v && f[(k + 1) % 3] == last);
        sphere.faces.iter().position(leaves).unwrap()
    };
    let around = |v: u32| {
        let first = sphere.faces.iter().position(|face| face.contains(&v)).unwrap();
        let mut polygon = vec![first as u32];
        let mut face = next(v, first);
        while face != first {
            polygon.push(face as u32);
            face = next(v, face);
        }
        polygon
    };
    let polygons = (0..sphere.positions.len() as u32).map(around).collect();
    PolygonSoup { positions, polygons }
}

/// Every vertex half the way to the mean of its neighbours.
fn smoothed(soup: &PolygonSoup) -> PolygonSoup {
    let mut sums = vec![([0.0; 3], 0.0); soup.positions.len()];
    for polygon in &soup.polygons {
        for k in 0..polygon.len() {
            let (v, w) = (polygon[k] as usize, polygon[(k + 1) % polygon.len()] as usize);
            (0..3).for_each(|c| sums[v].0[c] += soup.positions[w][c]);
            sums[v].1 += 1.0;
        }
    }
    let place = |(p, (sum, count)): (&[f64; 3], &([f64; 3], f64))| {
        [0, 1, 2].map(|k| 0.5 * (p[k] + sum[k] / count))
    };
    let positions = soup.positions.iter().zip(&sums).map(place).collect();
    PolygonSoup { positions, polygons: soup.polygons.clone() }
}

fn moved(soup: PolygonSoup, place: impl Fn([f64; 3]) -> [f64; 3]) -> PolygonSoup {
    let positions = soup.positions.into_iter().map(place).collect();
    PolygonSoup { positions, polygons: soup.polygons }
}

fn scaled(soup: PolygonSoup, factor: f64) -> PolygonSoup {
    moved(soup, |p| p.map(|x| factor * x))
}

fn of_triangles(soup: TriangleSoup) -> PolygonSoup {
    let polygons = soup.faces.iter().map(|face| face.to_vec()).collect();
    PolygonSoup { positions: soup.positions, polygons }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}
