//! A checker of seamless maps that shares no code with the library: connectivity from a table of
//! directed edges, orientation by exact sums, seams by lengths and products, angles by the arc cosine.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{FRAC_PI_2, PI};

type Uv = [f64; 2];

/// Largest mismatch of a seam, in lengths of the edge.
const SEAM: f64 = 1e-9;
/// Rounding allowed on top, as a share of the largest coordinate of the ends of the edge.
const ROUNDING: f64 = 4e-15;
/// Largest error of an angle sum, quarter turns.
const ANGLE: f64 = 1e-3;

/// What the checker found in a map without fault.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    /// Vertices inside with an angle other than a full turn, and their indices in quarters.
    pub(crate) cones: Vec<(u32, i32)>,
    /// Vertices less edges plus faces.
    pub(crate) euler_characteristic: i64,
    /// Whether no edge lacks a second face.
    pub(crate) is_closed: bool,
}

/// Everything that keeps corner UVs from being a seamless map.
pub(crate) fn check(faces: &[[u32; 3]], uvs: &[Uv]) -> Result<Found, Vec<String>> {
    let mut faults = Vec::new();
    if uvs.len() != 3 * faces.len() || uvs.iter().flatten().any(|x| !x.is_finite()) {
        return Err(vec!["UVs are missing or not finite".into()]);
    }
    let uvs = &to_order_one(uvs);
    for (f, corners) in uvs.chunks_exact(3).enumerate() {
        if exact_orientation(corners) != 1 {
            faults.push(format!("face {f} has no positive area"));
        }
    }
    let edges = directed_edges(faces);
    check_seams(&edges, uvs, &mut faults);
    let is_boundary = |e: &(u32, u32)| !edges.contains_key(&(e.1, e.0));
    let mut on_boundary: BTreeMap<u32, bool> =
        faces.iter().flatten().map(|&v| (v, false)).collect();
    for &(a, b) in edges.keys().filter(|e| is_boundary(e)) {
        on_boundary.extend([(a, true), (b, true)]);
    }
    let angles = angle_sums(faces, uvs);
    let (mut cones, mut total) = (Vec::new(), 0.0);
    for (&v, &outer) in &on_boundary {
        let quarters = angles[&v] / FRAC_PI_2;
        if outer {
            total += 2.0 - quarters;
            continue;
        }
        let nearest = quarters.round();
        if nearest < 1.0 || (quarters - nearest).abs() > ANGLE {
            faults.push(format!("vertex {v} has {quarters} quarter turns"));
        }
        total += 4.0 - nearest;
        if nearest != 4.0 {
            cones.push((v, 4 - nearest as i32));
        }
    }
    let n_boundary = edges.keys().filter(|e| is_boundary(e)).count();
    let n_edges = (edges.len() + n_boundary) / 2;
    let euler_characteristic = on_boundary.len() as i64 - n_edges as i64 + faces.len() as i64;
    if (total - 4.0 * euler_characteristic as f64).abs() > 0.01 {
        faults.push(format!("the indices sum to {total} at chi = {euler_characteristic}"));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    Ok(Found { cones, euler_characteristic, is_closed: n_boundary == 0 })
}

/// Scaled by a power of two, which changes no digit, to keep products in range.
fn to_order_one(uvs: &[Uv]) -> Vec<Uv> {
    let largest = uvs.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let (mut size, mut steps) = (largest, 0);
    while size > 0.0 && size < 1.0 {
        (size, steps) = (size * 2.0, steps + 1);
    }
    while size >= 2.0 {
        (size, steps) = (size / 2.0, steps - 1);
    }
    // In two factors: one may be out of range.
    let half = 2f64.powi(steps / 2);
    let rest = 2f64.powi(steps - steps / 2);
    uvs.iter().map(|p| p.map(|x| x * half * rest)).collect()
}

/// Corners at the start and the end of every directed edge.
fn directed_edges(faces: &[[u32; 3]]) -> HashMap<(u32, u32), [usize; 2]> {
    let mut edges = HashMap::new();
    for (f, face) in faces.iter().enumerate() {
        for k in 0..3 {
            let next = (k + 1) % 3;
            edges.insert((face[k], face[next]), [3 * f + k, 3 * f + next]);
        }
    }
    edges
}

/// Both images of an edge must have one length and be parallel or at right angles.
fn check_seams(edges: &HashMap<(u32, u32), [usize; 2]>, uvs: &[Uv], faults: &mut Vec<String>) {
    let vector = |[from, to]: [usize; 2]| minus(uvs[to], uvs[from]);
    for (&(a, b), &left) in edges {
        let Some(&[start, end]) = edges.get(&(b, a)) else {
            continue;
        };
        let (e, g) = (vector(left), vector([end, start]));
        let longer = length(e).max(length(g));
        let ends = [left[0], left[1], start, end].map(|corner| uvs[corner]);
        let largest = ends.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let allowed = (SEAM * longer + ROUNDING * largest).min(0.01 * longer);
        let skew = dot(e, g).abs().min(cross(e, g).abs()) / longer;
        if (length(e) - length(g)).abs() > allowed || skew > allowed {
            faults.push(format!("edge {a}-{b} does not close"));
        }
    }
}

fn angle_sums(faces: &[[u32; 3]], uvs: &[Uv]) -> BTreeMap<u32, f64> {
    let mut sums = BTreeMap::new();
    for (f, face) in faces.iter().enumerate() {
        let angle = |k: usize| {
            let at = uvs[3 * f + k];
            let p = minus(uvs[3 * f + (k + 1) % 3], at);
            let q = minus(uvs[3 * f + (k + 2) % 3], at);
            (dot(p, q) / (length(p) * length(q))).clamp(-1.0, 1.0).acos()
        };
        let angles = [angle(0), angle(1), angle(2)];
        // The arc cosine loses digits near 0 and pi; the largest angle follows from the others.
        let widest = (0..3).max_by(|&i, &j| angles[i].total_cmp(&angles[j])).unwrap();
        let others: f64 = (0..3).filter(|&k| k != widest).map(|k| angles[k]).sum();
        for k in 0..3 {
            let angle = if k == widest { PI - others } else { angles[k] };
            *sums.entry(face[k]).or_insert(0.0) += angle;
        }
    }
    sums
}

fn minus(p: Uv, q: Uv) -> Uv {
    [p[0] - q[0], p[1] - q[1]]
}

fn dot(p: Uv, q: Uv) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

fn cross(p: Uv, q: Uv) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

fn length(p: Uv) -> f64 {
    p[0].hypot(p[1])
}

/// Sign of `a x b + b x c + c x a` over three corners, without rounding.
fn exact_orientation(corners: &[Uv]) -> i32 {
    let mut terms = Vec::with_capacity(12);
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        for (x, y) in [(p[0], q[1]), (-p[1], q[0])] {
            let product = x * y;
            terms.extend([product, x.mul_add(y, -product)]);
        }
    }
    exact_sign(&terms)
}

/// Sign of a sum, by an expansion whose parts do not overlap.
fn exact_sign(terms: &[f64]) -> i32 {
    let mut parts: Vec<f64> = Vec::new();
    for &term in terms {
        let mut carry = term;
        let mut next = Vec::with_capacity(parts.len() + 1);
        for part in parts {
            let sum = carry + part;
            let virtual_part = sum - carry;
            next.push((carry - (sum - virtual_part)) + (part - virtual_part));
            carry = sum;
        }
        next.push(carry);
        parts = next;
    }
    let leading = parts.into_iter().rev().find(|&x| x != 0.0);
    leading.map_or(0, |x| if x > 0.0 { 1 } else { -1 })
}

#[test]
fn the_checker_decides_orientation_exactly() {
    let (a, c) = ([0.1, 0.1], [0.7, 0.7]);
    assert_eq!(exact_orientation(&[a, [0.3, 0.3], c]), 0);
    assert_eq!(exact_orientation(&[a, [0.3, 0.3f64.next_down()], c]), 1);
    assert_eq!(exact_orientation(&[a, [0.3, 0.3f64.next_up()], c]), -1);
    assert_eq!(exact_sign(&[1e16, 1.0, -1e16, -1.0, 1e-300]), 1);
}

#[test]
fn the_checker_refuses_broken_maps() {
    let faces = [[0, 1, 2], [0, 2, 3]];
    let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let fault = |uvs: [Uv; 6]| check(&faces, &uvs).unwrap_err();
    assert!(check(&faces, &[a, b, c, a, c, d]).is_ok());
    assert_eq!(check(&faces, &[a, b, c, a, c, d]).unwrap().euler_characteristic, 1);
    assert_eq!(fault([a, c, b, a, c, d])[0], "face 0 has no positive area");
    assert!(fault([a, b, c, a, [1.0, 1.001], d])[0].ends_with("does not close"));
    assert_eq!(check(&faces, &[a, b, c]).unwrap_err().len(), 1);
}
