//! The few operations on vectors of space that drawing needs.

pub(crate) type Vec3 = [f64; 3];

pub(crate) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Vec3, s: f64) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along `a`; `None` for the zero vector and for one that is not finite.
pub(crate) fn unit(a: Vec3) -> Option<Vec3> {
    let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && a.iter().all(|x| x.is_finite())) {
        return None;
    }
    let a = a.map(|x| x / largest);
    Some(scale(a, 1.0 / dot(a, a).sqrt()))
}

/// Twice the vector area of a triangle: its normal, as long as twice its area.
pub(crate) fn area_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    cross(sub(b, a), sub(c, a))
}
