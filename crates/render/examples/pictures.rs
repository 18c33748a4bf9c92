//! Draws the pictures of an OBJ file: `pictures MESH.obj OUTPUT_PREFIX [PERIOD]`.
//!
//! Vertices whose angle in the plane of the UVs is not a full turn are shown as cones, edges whose
//! sides have different UVs as seams.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use seamstress_render::{
    LayoutOptions, Paint, Scene, SurfaceOptions, View, render_layout, render_surface,
};

#[derive(Default)]
struct Mesh {
    positions: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    uvs: Vec<[f64; 2]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path, prefix, rest @ ..] = &arguments[..] else {
        return Err("usage: pictures MESH.obj OUTPUT_PREFIX [PERIOD]".into());
    };
    let period = rest.first().map(|p| p.parse()).transpose()?;
    let mesh = read_obj(&std::fs::read_to_string(path)?)?;
    let textured = mesh.uvs.len() == 3 * mesh.faces.len();
    let (cones, seams) = if textured { (cones(&mesh), seams(&mesh)) } else { Default::default() };
    let scene = Scene {
        positions: &mesh.positions,
        faces: &mesh.faces,
        corner_uvs: textured.then_some(&mesh.uvs[..]),
        cones: &cones,
        seams: &seams,
        ..Scene::default()
    };
    for (name, view) in [("front", View::Front), ("back", View::Back)] {
        let paint = match textured {
            true => Paint::checker(period),
            false => Paint::plain(),
        };
        let options = SurfaceOptions { view, paint, ..SurfaceOptions::default() };
        let file = File::create(format!("{prefix}_{name}.png"))?;
        render_surface(&scene, &options)?.write_png(BufWriter::new(file))?;
    }
    if textured {
        let file = File::create(format!("{prefix}_layout.png"))?;
        let options = LayoutOptions::default();
        render_layout(&scene, &options)?.write_png(BufWriter::new(file))?;
    }
    Ok(())
}

/// Reads vertices, UVs and triangles; polygons are split into fans.
fn read_obj(text: &str) -> Result<Mesh, Box<dyn Error>> {
    let (mut mesh, mut uvs) = (Mesh::default(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let key = words.next();
        let mut number = || -> Result<f64, Box<dyn Error>> {
            Ok(words.next().ok_or("a number is missing")?.parse()?)
        };
        match key {
            Some("v") => mesh.positions.push([number()?, number()?, number()?]),
            Some("vt") => uvs.push([number()?, number()?]),
            Some("f") => {
                let corners: Vec<[u32; 2]> = words.map(corner).collect::<Result<_, _>>()?;
                for pair in corners[1..].windows(2) {
                    let triangle = [corners[0], pair[0], pair[1]];
                    mesh.faces.push(triangle.map(|c| c[0] - 1));
                    mesh.uvs.extend(
                        triangle.iter().filter_map(|c| uvs.get((c[1] as usize).wrapping_sub(1))),
                    );
                }
            }
            _ => {}
        }
    }
    Ok(mesh)
}

/// The one-based vertex and UV of a corner; zero for a missing UV.
fn corner(word: &str) -> Result<[u32; 2], Box<dyn Error>> {
    let mut parts = word.split('/');
    let vertex = parts.next().unwrap_or_default().parse()?;
    let uv = parts.next().filter(|p| !p.is_empty()).map_or(Ok(0), str::parse)?;
    Ok([vertex, uv])
}

/// Vertices inside the mesh whose angles in the UVs do not add up to a full turn.
fn cones(mesh: &Mesh) -> Vec<(u32, i32)> {
    let mut angles = vec![0.0; mesh.positions.len()];
    let mut turns = vec![[0_i64; 2]; mesh.positions.len()];
    for (face, uv) in mesh.faces.iter().zip(mesh.uvs.chunks_exact(3)) {
        for k in 0..3 {
            let [a, b, c] = [uv[k], uv[(k + 1) % 3], uv[(k + 2) % 3]];
            let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
            angles[face[k] as usize] +=
                (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]);
            turns[face[k] as usize][0] += i64::from(face[(k + 1) % 3]);
            turns[face[k] as usize][1] += i64::from(face[(k + 2) % 3]);
        }
    }
    (0..mesh.positions.len())
        .filter(|&v| turns[v][0] == turns[v][1] && turns[v][0] > 0)
        .map(|v| {
            let quarters = angles[v] / std::f64::consts::FRAC_PI_2;
            (v as u32, 4 - quarters.round() as i32)
        })
        .filter(|cone| cone.1 != 0)
        .collect()
}

/// Edges whose two sides have different UVs.
fn seams(mesh: &Mesh) -> Vec<[u32; 2]> {
    let mut sides = BTreeMap::new();
    let mut seams = Vec::new();
    for (face, uv) in mesh.faces.iter().zip(mesh.uvs.chunks_exact(3)) {
        for k in 0..3 {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            let ends = [uv[k], uv[(k + 1) % 3]];
            if sides.get(&[b, a]).is_some_and(|across| *across != [ends[1], ends[0]]) {
                seams.push([a, b]);
            }
            sides.insert([a, b], ends);
        }
    }
    seams
}
