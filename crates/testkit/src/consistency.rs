//! A checker of consistent matchings that shares no code with the library.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

/// Largest error of a sum of angles, radians, or of indices, quarters.
const SUM: f64 = 1e-6;

/// A matching before and after, quarters, on the half-edge `3 face + side`.
#[derive(Debug, Clone, Copy)]
pub struct CheckedSeam {
    /// Left half-edge.
    pub left: u32,
    /// Before.
    pub before: f64,
    /// After.
    pub after: f64,
    /// What it may be: `'c'`onstant, `'i'`nteger, `'r'`eal.
    pub set: char,
}

/// Everything in which angles (per corner), indices (per vertex, quarters) and matchings fail the
/// conditions of problem (14) of Levi 2021: positive angles, sums in triangles and around vertices,
/// indices below 4 that sum to 4 chi and change as the matchings move them, and the sets of matchings.
#[must_use]
pub fn consistency_faults(
    faces: &[[u32; 3]],
    indices_before: &[f64],
    indices: &[f64],
    angles: &[f64],
    seams: &[CheckedSeam],
) -> Vec<String> {
    let mut faults = Vec::new();
    let directed: HashMap<(u32, u32), usize> = faces
        .iter()
        .enumerate()
        .flat_map(|(f, v)| (0..3).map(move |k| ((v[k], v[(k + 1) % 3]), 3 * f + k)))
        .collect();
    let n = indices.len();
    let (mut used, mut boundary) = (vec![false; n], vec![false; n]);
    for &(a, b) in directed.keys() {
        used[a as usize] = true;
        if !directed.contains_key(&(b, a)) {
            (boundary[a as usize], boundary[b as usize]) = (true, true);
        }
    }
    let mut sums = vec![0.0; n];
    for (f, v) in faces.iter().enumerate() {
        let of_face = &angles[3 * f..3 * f + 3];
        if is_off(of_face.iter().sum::<f64>() - PI, SUM) {
            faults.push(format!("the angles of face {f} are {of_face:?}"));
        }
        for k in 0..3 {
            sums[v[k] as usize] += of_face[k];
            if of_face[k].is_nan() || of_face[k] <= 0.0 {
                faults.push(format!("corner {} has angle {}", 3 * f + k, of_face[k]));
            }
        }
    }
    let mut moved = indices_before.to_vec();
    let mut has_real = vec![false; n];
    for seam in seams {
        let (f, k) = (seam.left as usize / 3, seam.left as usize % 3);
        let ends = [faces[f][k] as usize, faces[f][(k + 1) % 3] as usize];
        moved[ends[0]] -= seam.after - seam.before;
        moved[ends[1]] += seam.after - seam.before;
        match seam.set {
            'c' if seam.after != seam.before => faults.push(format!("{seam:?} is not constant")),
            'i' if seam.after.fract() != 0.0 => faults.push(format!("{seam:?} is no integer")),
            'r' => ends.iter().for_each(|&v| has_real[v] = true),
            _ => {}
        }
    }
    for v in (0..n).filter(|&v| used[v]) {
        let full = if boundary[v] { PI } else { 2.0 * PI };
        if is_off(sums[v] - full + indices[v] * FRAC_PI_2, SUM) {
            faults.push(format!("vertex {v}: index {} but angle {}", indices[v], sums[v]));
        }
        if boundary[v] {
            continue;
        }
        if indices[v].is_nan() || indices[v] >= 4.0 {
            faults.push(format!("vertex {v} has index {}", indices[v]));
        }
        if is_off(indices[v] - moved[v], SUM) {
            faults.push(format!("vertex {v}: index {}, moved {}", indices[v], moved[v]));
        }
        let was_integer = (indices_before[v] - indices_before[v].round()).abs() < SUM;
        let integral = |s: &CheckedSeam| s.before.fract() == 0.0;
        if was_integer && !has_real[v] && seams.iter().all(integral) && indices[v].fract() != 0.0 {
            faults.push(format!("vertex {v} has the fractional index {}", indices[v]));
        }
    }
    check_sums(faces, &used, indices, &mut faults);
    faults
}

/// Whether a difference is too large, or no number.
fn is_off(difference: f64, allowed: f64) -> bool {
    difference.is_nan() || difference.abs() > allowed
}

/// Poincare-Hopf in every component.
fn check_sums(faces: &[[u32; 3]], used: &[bool], indices: &[f64], faults: &mut Vec<String>) {
    let mut label: Vec<usize> = (0..indices.len()).collect();
    loop {
        let mut settled = true;
        for face in faces {
            let least = face.iter().map(|&v| label[v as usize]).min().unwrap();
            for &v in face {
                settled &= label[v as usize] == least;
                label[v as usize] = least;
            }
        }
        if settled {
            break;
        }
    }
    let mut edges: Vec<[u32; 2]> =
        faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    edges.iter_mut().for_each(|e| e.sort_unstable());
    edges.sort_unstable();
    edges.dedup();
    let mut sums: HashMap<usize, (f64, i64)> = HashMap::new();
    for v in (0..indices.len()).filter(|&v| used[v]) {
        let sum = sums.entry(label[v]).or_default();
        *sum = (sum.0 + indices[v], sum.1 + 4);
    }
    faces.iter().for_each(|f| sums.entry(label[f[0] as usize]).or_default().1 += 4);
    edges.iter().for_each(|e| sums.entry(label[e[0] as usize]).or_default().1 -= 4);
    for (first, (sum, expected)) in sums {
        if is_off(sum - expected as f64, SUM * indices.len() as f64) {
            faults.push(format!("the component of vertex {first} has {sum}, not {expected}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACES: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];

    #[test]
    fn a_tetrahedron_with_two_quarters_everywhere_and_its_faults() {
        let (indices, angles) = ([2.0; 4], [PI / 3.0; 12]);
        let seam = CheckedSeam { left: 0, before: 0.0, after: 0.0, set: 'i' };
        let faults = |indices: &[f64; 4], angles: &[f64; 12], seam| {
            consistency_faults(&FACES, &[2.0; 4], indices, angles, &[seam]).len()
        };
        assert_eq!(faults(&indices, &angles, seam), 0);
        // Too much index: the sum, the vertex against its angle, and against its matchings.
        assert_eq!(faults(&[3.0, 2.0, 2.0, 2.0], &angles, seam), 3);
        // A negative angle: its sign, the face, the vertex.
        let mut negative = angles;
        negative[0] = -0.1;
        assert_eq!(faults(&indices, &negative, seam), 3);
        // A unit moved by a constant seam: the set and two vertices.
        assert_eq!(faults(&indices, &angles, CheckedSeam { after: 1.0, set: 'c', ..seam }), 3);
        assert_eq!(faults(&indices, &angles, CheckedSeam { after: 0.5, ..seam }), 3);
        // Of each vertex three conditions fail and its integrality; and the sum.
        assert_eq!(faults(&[f64::NAN; 4], &angles, seam), 17);
    }
}
