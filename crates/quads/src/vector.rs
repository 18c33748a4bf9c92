//! Vectors of space.

use parry3d_f64::math::Vector;

pub(crate) type Point = [f64; 3];

/// As the type of the geometry library.
pub(crate) fn vector([x, y, z]: Point) -> Vector {
    Vector::new(x, y, z)
}

pub(crate) fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scale(a: Point, s: f64) -> Point {
    a.map(|x| s * x)
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Length without overflow of the squares.
pub(crate) fn norm(a: Point) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// None if there is no length.
pub(crate) fn unit(a: Point) -> Option<Point> {
    let length = norm(a);
    (length > 0.0).then(|| a.map(|x| x / length))
}

/// Radians between 0 and π.
pub(crate) fn angle(a: Point, b: Point) -> f64 {
    norm(cross(a, b)).atan2(dot(a, b))
}

/// The sum of `p x q` along a polygon: twice its vector area.
pub(crate) fn vector_area(points: &[Point]) -> Point {
    let parts =
        points.windows(2).skip(1).map(|p| cross(sub(p[0], points[0]), sub(p[1], points[0])));
    parts.fold([0.0; 3], add)
}
