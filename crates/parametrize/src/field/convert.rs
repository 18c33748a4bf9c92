//! Directions in space and matchings by edge, as files hold them.

use super::cross_field::{CrossField, FieldError, antisymmetric, ends};
use crate::quarter::{direction, turn};
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, HalfedgeData, TriMesh};

/// A direction has this share of its length in the plane of its face, at least.
const TANGENT: f64 = 1e-3;

/// The four unit directions of the cross on each face, counter-clockwise, the first along `u`.
pub fn directions_in_space(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    field: &CrossField,
) -> Vec<[[f64; 3]; 4]> {
    let cross = |f: Face| {
        let [x, y] = axes(mesh, positions, f);
        [0, 1, 2, 3].map(|k| {
            let d = turn(field.frames()[f].conj(), k);
            [0, 1, 2].map(|i| d.re * x[i] + d.im * y[i])
        })
    };
    mesh.faces().map(cross).collect()
}

/// Frames of directions in space: one, or four counter-clockwise, per face.
///
/// Of four that are not at right angles the nearest cross is taken (the mean of their fourth powers).
///
/// # Errors
/// [`FieldError`] if counts do not fit or a direction does not lie in the plane of its face.
pub fn frames_from_directions(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    directions: &[Vec<[f64; 3]>],
) -> Result<FaceData<Complex64>, FieldError> {
    let (expected, found) = (mesh.n_faces(), directions.len());
    if expected != found {
        return Err(FieldError::Count { what: "faces", expected, found });
    }
    let frame = |f: Face| {
        let [x, y] = axes(mesh, positions, f);
        let mut flat = Vec::with_capacity(4);
        for &d in &directions[f.at()] {
            let d = to_order_one(d);
            let z = Complex64::new(dot(d, x), dot(d, y));
            // Not a number fails, too.
            let is_tangent = z.norm() > TANGENT * dot(d, d).sqrt();
            if !is_tangent {
                return Err(FieldError::NoDirection { face: f.0 });
            }
            flat.push(direction(z));
        }
        let first = *flat.first().ok_or(FieldError::NoDirection { face: f.0 })?;
        let power: Complex64 = flat.iter().map(|z| (z / first).powi(4)).sum();
        // The root nearest to the first direction; without a mean, that direction itself.
        let off = if power.norm() > TANGENT { power.arg() / 4.0 } else { 0.0 };
        Ok((first * Complex64::from_polar(1.0, off)).conj())
    };
    mesh.faces().map(frame).collect()
}

/// Matchings per half-edge of rows that name faces `f0, f1`, the ends of their common edge, and the
/// matching from `f0` to `f1`. Rows of the boundary (a negative face) are passed over.
///
/// # Errors
/// [`FieldError`] if a row names no interior edge, or an edge has no row or two.
pub fn matchings_from_rows(
    mesh: &TriMesh,
    rows: &[([i64; 2], [u32; 2], i32)],
) -> Result<HalfedgeData<i32>, FieldError> {
    let mut found = HalfedgeData::filled(mesh.n_halfedges(), None);
    for (row, &(faces, vertices, matching)) in rows.iter().enumerate() {
        if faces.iter().any(|&f| f < 0) {
            continue;
        }
        let bad = |repeated| FieldError::BadRow { row, faces, repeated };
        let face = u32::try_from(faces[0]).ok().filter(|&f| (f as usize) < mesh.n_faces());
        let face = Face(face.ok_or_else(|| bad(false))?);
        let mut sorted = vertices;
        sorted.sort_unstable();
        let is_named = |h: &seamstress_mesh::Halfedge| {
            let mut both = ends(mesh, *h);
            both.sort_unstable();
            both == sorted && mesh.twin(*h).is_some_and(|t| i64::from(t.face().0) == faces[1])
        };
        let h = face.halfedges().into_iter().find(is_named).ok_or_else(|| bad(false))?;
        let t = mesh.twin(h).ok_or_else(|| bad(false))?;
        if found[h].is_some() {
            return Err(bad(true));
        }
        let residue = matching.rem_euclid(4);
        (found[h], found[t]) = (Some(residue), Some((4 - residue) % 4));
    }
    if let Some(h) = mesh.interior_edges().find(|&h| found[h].is_none()) {
        return Err(FieldError::NoMatching { vertices: ends(mesh, h) });
    }
    Ok(antisymmetric(mesh, |h| found[h].unwrap_or(0)))
}

/// Unit axes of a face: along its first side, and a quarter turn counter-clockwise from it. Triangles
/// without area get some pair of axes, always the same.
pub(super) fn axes(mesh: &TriMesh, positions: &[[f64; 3]], f: Face) -> [[f64; 3]; 2] {
    let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.at()]);
    let largest = [a, b, c].as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let scale = if largest > 0.0 { 1.0 / largest.clamp(1e-300, 1e300) } else { 1.0 };
    let side = |p: [f64; 3]| to_order_one([0, 1, 2].map(|i| p[i] * scale - a[i] * scale));
    let (e, g) = (side(b), side(c));
    let x = unit(e).unwrap_or([1.0, 0.0, 0.0]);
    let least = (0..3).min_by(|&i, &j| x[i].abs().total_cmp(&x[j].abs())).unwrap_or(0);
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let normal = unit(cross(x, g)).or_else(|| unit(cross(x, other))).unwrap_or([0.0, 0.0, 1.0]);
    [x, cross(normal, x)]
}

/// Scaled to a largest coordinate of one; zero stays.
fn to_order_one(d: [f64; 3]) -> [f64; 3] {
    let largest = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest > 0.0 { d.map(|x| x / largest) } else { d }
}

fn unit(d: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(d, d).sqrt();
    (length > 0.0).then(|| d.map(|x| x / length))
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
