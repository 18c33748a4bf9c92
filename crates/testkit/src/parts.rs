//! Parts as drawing programs export them: few triangles, long ones, flat faces and sharp edges.

use crate::l_bracket;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::soup::triangulate;
use std::f64::consts::TAU;

type Point2 = [f64; 2];
type Point3 = [f64; 3];

/// At least 200 parts with their names: plates, boxes, prisms of 3 to 64 sides, pyramids, wedges, gears, ribs, slots,
/// threads, tubes, stairs and houses. Closed but for the sheets, all connected.
#[must_use]
pub fn parts() -> Vec<(String, TriangleSoup)> {
    let mut all = Vec::new();
    let mut add = |name: String, part: TriangleSoup| all.push((name, part));
    for (k, [x, y, z]) in BOXES.into_iter().enumerate() {
        add(format!("box_{k}"), extruded(&rectangle(x, y), z));
    }
    for n in [3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 32, 40, 48, 64] {
        for height in [0.1, 1.0, 4.0] {
            add(format!("prism_{n}_{height}"), extruded(&regular(n, 1.0), height));
        }
    }
    for n in [3, 4, 5, 6, 8, 12, 16, 32] {
        for height in [0.5, 1.5, 4.0] {
            add(format!("pyramid_{n}_{height}"), pyramid(n, height));
        }
        add(format!("frustum_{n}"), revolved(&[[1.0, 0.0], [0.5, 1.2]], n));
    }
    for n in [6, 12, 24, 48] {
        for inner in [0.3, 0.8, 0.95] {
            let profile = [[inner, 0.0], [1.0, 0.0], [1.0, 1.0], [inner, 1.0]];
            add(format!("tube_{n}_{inner}"), ring(&profile, n));
            add(format!("washer_{n}_{inner}"), ring(&profile.map(|[r, z]| [r, 0.1 * z]), n));
        }
        let step = [[1.0, 0.0], [1.0, 0.5], [0.6, 0.5], [0.6, 1.5]];
        add(format!("stepped_shaft_{n}"), revolved(&step, n));
        let flange = [[0.3, 0.0], [1.2, 0.0], [1.2, 0.2], [0.6, 0.2], [0.6, 1.0], [0.3, 1.0]];
        add(format!("flange_{n}"), ring(&flange, n));
    }
    for teeth in [6, 8, 12, 16, 20] {
        for height in [0.2, 0.6] {
            add(format!("gear_{teeth}_{height}"), extruded(&gear(teeth), height));
        }
        add(format!("star_{teeth}"), extruded(&star(teeth, 0.6), 0.4));
    }
    for n in [2, 3, 5, 8] {
        for depth in [0.3, 1.0] {
            add(format!("ribs_{n}_{depth}"), extruded(&comb(n, depth), 1.0));
            add(format!("stairs_{n}_{depth}"), extruded(&stairs(n), depth));
        }
        add(format!("slots_{n}"), extruded(&comb(n, 0.15), 0.2));
    }
    for turns in [2, 4] {
        for n in [16, 32] {
            add(format!("thread_{turns}_{n}"), thread(turns, n));
        }
    }
    for (k, n) in [8, 16, 24, 32, 48, 64].into_iter().enumerate() {
        for hole in [0.2, 0.6] {
            add(format!("plate_hole_{n}_{hole}"), holed_plate(n, hole, 0.1 + 0.1 * k as f64));
        }
        add(format!("round_rectangle_{n}"), extruded(&round_rectangle(n), 0.3));
        add(format!("sheet_round_{n}"), sheet(&regular(n, 1.0)));
        add(format!("sheet_comb_{n}"), sheet(&comb(2 + k, 0.5)));
    }
    for angle in [10.0f64, 20.0, 30.0, 45.0, 60.0, 75.0] {
        let (sin, cos) = angle.to_radians().sin_cos();
        add(format!("wedge_{angle}"), extruded(&[[0.0, 0.0], [1.0, 0.0], [cos, sin]], 0.5));
        let slanted = [[0.0, 0.0], [1.5, 0.0], [1.5 + cos, sin], [cos, sin]];
        add(format!("slanted_{angle}"), extruded(&slanted, 0.7));
    }
    for (k, roof) in [0.2, 0.5, 1.0, 2.0].into_iter().enumerate() {
        let front = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [0.5, 0.8 + roof], [0.0, 0.8]];
        add(format!("house_{k}"), extruded(&front, 1.4));
    }
    for (k, [w, h]) in [[0.5, 0.5], [0.2, 0.2], [0.1, 0.6], [0.7, 0.3]].into_iter().enumerate() {
        let corner = [[0.0, 0.0], [1.0, 0.0], [1.0, h], [w, h], [w, 1.0], [0.0, 1.0]];
        add(format!("corner_{k}"), extruded(&corner, 0.8));
        let t = [[0.0, 0.0], [1.0, 0.0], [1.0, h], [0.6, h], [0.6, 1.0], [0.4, 1.0], [0.4, h]];
        let t: Vec<Point2> = t.into_iter().chain([[0.0, h]]).collect();
        add(format!("tee_{k}"), extruded(&t, 0.5));
    }
    add("bracket".into(), l_bracket());
    all
}

/// Boxes by their sides, plates and bars among them.
const BOXES: [Point3; 16] = [
    [1.0, 1.0, 1.0],
    [2.0, 1.0, 1.0],
    [3.0, 2.0, 1.0],
    [1.0, 1.0, 0.3],
    [1.0, 1.0, 0.1],
    [1.0, 1.0, 0.03],
    [1.0, 1.0, 0.01],
    [4.0, 1.0, 0.1],
    [4.0, 1.0, 0.02],
    [10.0, 1.0, 1.0],
    [10.0, 1.0, 0.2],
    [20.0, 1.0, 0.5],
    [50.0, 1.0, 1.0],
    [1.618, 1.0, 0.618],
    [3.7, 1.3, 0.21],
    [7.1, 2.9, 0.07],
];

/// A simple polygon, counter-clockwise, raised to a solid.
///
/// # Panics
/// If it is not simple.
#[must_use]
pub fn extruded(outline: &[Point2], height: f64) -> TriangleSoup {
    let n = outline.len() as u32;
    let at = |z: f64| outline.iter().map(move |&[x, y]| [x, y, z]);
    let positions: Vec<Point3> = at(0.0).chain(at(height)).collect();
    let lid: Vec<u32> = (n..2 * n).collect();
    let floor: Vec<u32> = (0..n).rev().collect();
    let sides = (0..n).map(|i| vec![i, (i + 1) % n, n + (i + 1) % n, n + i]);
    polygons(positions, sides.chain([lid, floor]).collect())
}

/// A simple polygon, counter-clockwise, as an open surface.
///
/// # Panics
/// If it is not simple.
#[must_use]
pub fn sheet(outline: &[Point2]) -> TriangleSoup {
    let positions = outline.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    polygons(positions, vec![(0..outline.len() as u32).collect()])
}

/// A profile of radius and height, upwards, turned around the axis in `n` steps, with a lid and a floor.
#[must_use]
pub fn revolved(profile: &[Point2], n: u32) -> TriangleSoup {
    let rows = profile.len() as u32;
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for row in 0..rows - 1 {
        faces.extend((0..n).map(|i| {
            let (a, b) = (row * n + i, row * n + (i + 1) % n);
            vec![a, b, b + n, a + n]
        }));
    }
    faces.push(((rows - 1) * n..rows * n).collect());
    faces.push((0..n).rev().collect());
    polygons(turned(profile, n), faces)
}

/// A closed profile of radius and height, counter-clockwise, turned around the axis in `n` steps.
#[must_use]
pub fn ring(profile: &[Point2], n: u32) -> TriangleSoup {
    let rows = profile.len() as u32;
    let face = |row: u32, i: u32| {
        let (a, b) = (row * n, (row + 1) % rows * n);
        vec![a + i, a + (i + 1) % n, b + (i + 1) % n, b + i]
    };
    let faces = (0..rows).flat_map(|row| (0..n).map(move |i| face(row, i))).collect();
    polygons(turned(profile, n), faces)
}

/// A regular pyramid.
#[must_use]
pub fn pyramid(n: u32, height: f64) -> TriangleSoup {
    let mut positions: Vec<Point3> = regular(n, 1.0).iter().map(|&[x, y]| [x, y, 0.0]).collect();
    positions.push([0.0, 0.0, height]);
    let sides = (0..n).map(|i| vec![i, (i + 1) % n, n]);
    polygons(positions, sides.chain([(0..n).rev().collect()]).collect())
}

/// A rod whose radius rises and falls along a helix, with flat ends.
fn thread(turns: u32, n: u32) -> TriangleSoup {
    let rows = 12 * turns + 1;
    let positions = (0..rows * n).map(|k| {
        let (row, i) = (f64::from(k / n), f64::from(k % n) / f64::from(n));
        let phase = (row / 12.0 - i).rem_euclid(1.0);
        let radius = 0.8 + 0.4 * (phase - 0.5).abs();
        let (sin, cos) = (TAU * i).sin_cos();
        [radius * cos, radius * sin, 0.04 * row]
    });
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for k in 0..(rows - 1) * n {
        let (a, b) = (k, k / n * n + (k + 1) % n);
        faces.extend([vec![a, b, b + n], vec![a, b + n, a + n]]);
    }
    faces.push(((rows - 1) * n..rows * n).collect());
    faces.push((0..n).rev().collect());
    polygons(positions.collect(), faces)
}

/// A square plate with a round hole.
fn holed_plate(n: u32, hole: f64, height: f64) -> TriangleSoup {
    let square = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let most = sin.abs().max(cos.abs());
        [cos / most, sin / most]
    };
    // A corner of the square at every eighth turn.
    let angles: Vec<f64> = (0..n).map(|i| TAU * f64::from(i) / f64::from(n)).collect();
    let outer = angles.iter().map(|&a| square(a));
    let inner = angles.iter().map(|&a| [hole * a.cos(), hole * a.sin()]);
    let plane: Vec<Point2> = outer.chain(inner).collect();
    let at = |z: f64| plane.iter().map(move |&[x, y]| [x, y, z]);
    let positions: Vec<Point3> = at(0.0).chain(at(height)).collect();
    let mut faces = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        let [bottom, top] = [0, 2 * n];
        faces.push(vec![top + i, top + j, top + n + j, top + n + i]);
        faces.push(vec![bottom + j, bottom + i, bottom + n + i, bottom + n + j]);
        faces.push(vec![bottom + i, bottom + j, top + j, top + i]);
        faces.push(vec![bottom + n + j, bottom + n + i, top + n + i, top + n + j]);
    }
    polygons(positions, faces)
}

fn rectangle(x: f64, y: f64) -> [Point2; 4] {
    [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]]
}

fn regular(n: u32, radius: f64) -> Vec<Point2> {
    let corner = |i: u32| (TAU * f64::from(i) / f64::from(n)).sin_cos();
    (0..n).map(corner).map(|(sin, cos)| [radius * cos, radius * sin]).collect()
}

fn star(n: u32, inner: f64) -> Vec<Point2> {
    let radius = |i: usize| if i.is_multiple_of(2) { 1.0 } else { inner };
    let corners = regular(2 * n, 1.0).into_iter().enumerate();
    corners.map(|(i, p)| p.map(|x| x * radius(i))).collect()
}

/// A wheel with square teeth.
fn gear(teeth: u32) -> Vec<Point2> {
    let radius = |i: usize| if i % 4 < 2 { 1.0 } else { 0.8 };
    let corners = regular(4 * teeth, 1.0).into_iter().enumerate();
    corners.map(|(i, p)| p.map(|x| x * radius(i))).collect()
}

/// A bar with `n` teeth upwards.
fn comb(n: usize, depth: f64) -> Vec<Point2> {
    let width = 2.0 / (2 * n - 1) as f64;
    let mut outline = vec![[0.0, 0.0], [2.0, 0.0]];
    for tooth in (0..n).rev() {
        let left = 2.0 * tooth as f64 * width;
        outline.extend([[left + width, 0.3 + depth], [left, 0.3 + depth]]);
        if tooth > 0 {
            outline.extend([[left, 0.3], [left - width, 0.3]]);
        }
    }
    outline
}

fn stairs(n: usize) -> Vec<Point2> {
    let step = 1.0 / n as f64;
    let mut outline = vec![[0.0, 0.0], [1.0, 0.0]];
    for k in (0..n).rev() {
        let (x, z) = (k as f64 * step, (k + 1) as f64 * step);
        outline.extend([[x + step, z], [x, z]].map(|[x, z]| [x, z]));
    }
    outline.dedup();
    outline
}

/// A rectangle with round corners of `n` segments in all.
fn round_rectangle(n: u32) -> Vec<Point2> {
    let center =
        |[x, y]: Point2| [if x > 0.0 { 1.0 } else { 0.0 }, if y > 0.0 { 0.5 } else { 0.0 }];
    let mut outline = Vec::new();
    for i in 0..n {
        for turn in [0.0, 1.0] {
            // Both ends of every segment, so that the sides are there.
            let angle = TAU * (f64::from(i) + turn) / f64::from(n);
            let middle = TAU * (f64::from(i) + 0.5) / f64::from(n);
            let [x, y] = center([middle.cos(), middle.sin()]);
            outline.push([x + 0.3 * angle.cos(), y + 0.3 * angle.sin()]);
        }
    }
    let close = |a: &Point2, b: &Point2| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9;
    outline.dedup_by(|a, b| close(a, b));
    if outline.len() > 1 && close(&outline[0], &outline[outline.len() - 1]) {
        outline.pop();
    }
    outline
}

fn turned(profile: &[Point2], n: u32) -> Vec<Point3> {
    let row = |&[r, z]: &Point2| regular(n, r).into_iter().map(move |[x, y]| [x, y, z]);
    profile.iter().flat_map(row).collect()
}

fn polygons(positions: Vec<Point3>, polygons: Vec<Vec<u32>>) -> TriangleSoup {
    let faces = triangulate(&positions, polygons.iter().map(Vec::as_slice)).unwrap().faces;
    TriangleSoup { positions, faces }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::TriMesh;
    use seamstress_mesh::soup::check;
    use std::collections::HashSet;

    #[test]
    fn parts_are_surfaces_with_their_outsides_out() {
        let all = parts();
        assert!(all.len() >= 200, "{}", all.len());
        let names: HashSet<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names.len(), all.len());
        for (name, part) in &all {
            assert!(check(part).faults.is_empty(), "{name}");
            let mesh = TriMesh::from_faces(part.positions.len(), &part.faces).unwrap();
            assert_eq!(mesh.connected_faces().1, 1, "{name}");
            assert_eq!(mesh.has_boundary(), name.starts_with("sheet"), "{name}");
            let volume: f64 = part
                .faces
                .iter()
                .map(|face| {
                    let [a, b, c] = face.map(|v| part.positions[v as usize]);
                    let cross = |k: usize| {
                        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                        b[i] * c[j] - b[j] * c[i]
                    };
                    (0..3).map(|k| a[k] * cross(k)).sum::<f64>()
                })
                .sum();
            assert!(volume > 0.0 || mesh.has_boundary(), "{name}");
        }
    }
}
