//! Splitting polygons into triangles.

use super::copies::{Copy, copies};
use super::ear_clipping::clip_ears;
use super::edges::Edges;
use super::fault::Fault;
use super::geometry::{Local, unit_normal};
use super::{MAX_FACES, MAX_VERTICES};

/// Triangles made from polygons.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Triangulation {
    /// Vertex triples, in order of the polygons they come from.
    pub faces: Vec<[u32; 3]>,
    /// For each face its polygon.
    pub polygon_of_face: Vec<u32>,
    /// What was done.
    pub notes: TriangulationNotes,
}

/// What [`triangulate`] did with polygons of more than three corners.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct TriangulationNotes {
    /// Quads split.
    pub quads: usize,
    /// Polygons of five and more corners split.
    pub larger: usize,
    /// Polygons split otherwise than as the fan from their first corner.
    pub other_choice: usize,
    /// Polygons for which no split with triangles of positive area and new diagonals was found, in
    /// increasing order. Their triangles overlap, are flat or double an edge.
    pub unresolved: Vec<u32>,
}

/// Splits polygons into triangles on the same vertices.
///
/// `polygons` gives each polygon's vertices in order around it. Triangles pass through as they
/// are. A larger polygon becomes the fan from its first corner if that is valid: every triangle
/// has positive area seen against the polygon's mean (Newell) normal, and no diagonal is an edge
/// of a polygon or a diagonal chosen before, which would give that edge more than two faces.
/// Otherwise the fans from the other corners are tried in order, then the clipping of ears. If
/// nothing is valid the polygon becomes the first fan without such a diagonal, at worst the fan
/// from the first corner, and is listed in the notes.
///
/// A polygon that copies an earlier one becomes the same triangles, and so does one that reverses it
/// where other polygons share their sides: triangles then tell that one of the two is too many.
///
/// # Errors
/// All polygons that have fewer than three corners or refer to a missing vertex, those of more
/// than three corners that repeat a vertex, and counts too large to number. The `face` of a fault
/// is the polygon.
pub fn triangulate<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]>,
) -> Result<Triangulation, Vec<Fault>> {
    let polygons: Vec<&[u32]> = polygons.collect();
    let faults = polygon_faults(positions.len(), &polygons);
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut edges = Edges::default();
    if polygons.iter().any(|polygon| polygon.len() > 3) {
        edges.add_sides(&polygons);
    }
    let copies = copies(&polygons);
    let mut result = Triangulation::default();
    for (&polygon, id) in polygons.iter().zip(0u32..) {
        if let &[a, b, c] = polygon {
            result.push([a, b, c], id);
            continue;
        }
        if let Some(&copy) = copies.get(&id) {
            result.push_copy(copy, id, polygon.len());
            continue;
        }
        let split = split(positions, polygon, &edges);
        for &triangle in &split.triangles {
            edges.add_triangle(triangle.map(|i| polygon[i]));
            result.push(triangle.map(|i| polygon[i]), id);
        }
        result.notes.record(id, polygon.len(), &split);
    }
    Ok(result)
}

impl Triangulation {
    fn push(&mut self, face: [u32; 3], polygon: u32) {
        self.faces.push(face);
        self.polygon_of_face.push(polygon);
    }

    /// The triangles of a polygon that copies or reverses an earlier one.
    fn push_copy(&mut self, copy: Copy, polygon: u32, corners: usize) {
        let start = self.polygon_of_face.partition_point(|&of| of < copy.first);
        for face in start..start + corners - 2 {
            let [a, b, c] = self.faces[face];
            self.push(if copy.reversed { [a, c, b] } else { [a, b, c] }, polygon);
        }
        *if corners == 4 { &mut self.notes.quads } else { &mut self.notes.larger } += 1;
    }
}

impl TriangulationNotes {
    fn record(&mut self, polygon: u32, corners: usize, split: &Split) {
        if corners == 4 {
            self.quads += 1;
        } else {
            self.larger += 1;
        }
        self.other_choice += usize::from(!split.is_first_fan);
        if !split.is_valid {
            self.unresolved.push(polygon);
        }
    }
}

/// What keeps polygons from being split into triangles, as [`triangulate`] reports it.
pub fn polygon_faults(n_vertices: usize, polygons: &[&[u32]]) -> Vec<Fault> {
    let n_faces = polygons.iter().map(|polygon| polygon.len().saturating_sub(2)).sum();
    if n_faces > MAX_FACES || polygons.len() > MAX_FACES {
        return vec![Fault::TooManyFaces { n_faces, limit: MAX_FACES }];
    }
    if n_vertices > MAX_VERTICES {
        return vec![Fault::TooManyVertices { n_vertices, limit: MAX_VERTICES }];
    }
    let mut faults = Vec::new();
    for (&polygon, face) in polygons.iter().zip(0u32..) {
        if polygon.len() < 3 {
            faults.push(Fault::TooFewCorners { face, corners: polygon.len() });
        }
        for &index in polygon.iter().filter(|&&v| v as usize >= n_vertices) {
            faults.push(Fault::IndexOutOfRange { face, index, n_vertices });
        }
        if polygon.len() > 3
            && let Some(vertex) = first_repeated(polygon)
        {
            faults.push(Fault::RepeatedVertex { face, vertex });
        }
    }
    faults
}

/// The smallest vertex that a polygon has more than once.
fn first_repeated(polygon: &[u32]) -> Option<u32> {
    let mut sorted = polygon.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

/// A polygon split into triangles of its corners.
struct Split {
    triangles: Vec<[usize; 3]>,
    is_first_fan: bool,
    is_valid: bool,
}

fn split(positions: &[[f64; 3]], polygon: &[u32], edges: &Edges) -> Split {
    let n = polygon.len();
    let local = Local::new(polygon.iter().map(|&v| positions[v as usize]));
    let normal = unit_normal(&local.points);
    let is_new = |corner: usize| {
        (2..n - 1).all(|i| !edges.contain(polygon[corner], polygon[(corner + i) % n]))
    };
    if let Some(normal) = normal {
        let is_positive = |triangle| local.is_positive(triangle, normal);
        let is_valid = |&corner: &usize| fan(n, corner).all(is_positive) && is_new(corner);
        // The fans from opposite corners of a quad are the same.
        let distinct = if n == 4 { 2 } else { n };
        if let Some(corner) = (0..distinct).find(is_valid) {
            let triangles = fan(n, corner).collect();
            return Split { triangles, is_first_fan: corner == 0, is_valid: true };
        }
        if let Some(triangles) = clip_ears(&local, normal, polygon, edges) {
            return Split { triangles, is_first_fan: false, is_valid: true };
        }
    }
    let corner = (0..n).find(|&corner| is_new(corner)).unwrap_or(0);
    let triangles = fan(n, corner).collect();
    Split { triangles, is_first_fan: corner == 0, is_valid: false }
}

/// The triangles of a polygon of `n` corners around one of them.
fn fan(n: usize, corner: usize) -> impl Iterator<Item = [usize; 3]> {
    (1..n - 1).map(move |i| [corner, (corner + i) % n, (corner + i + 1) % n])
}

#[cfg(test)]
mod tests {
    use super::{Fault, Triangulation, triangulate};
    use crate::soup::{TriangleSoup, check};

    fn split(positions: &[[f64; 3]], polygons: &[&[u32]]) -> Triangulation {
        triangulate(positions, polygons.iter().copied()).unwrap()
    }

    const SQUARE: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn a_convex_quad_is_the_fan_from_its_first_corner() {
        let done = split(&SQUARE, &[&[0, 1, 2, 3]]);
        assert_eq!(done.faces, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(done.polygon_of_face, [0, 0]);
        assert_eq!((done.notes.quads, done.notes.larger, done.notes.other_choice), (1, 0, 0));
        let rotated = split(&SQUARE, &[&[1, 2, 3, 0]]);
        assert_eq!(rotated.faces, [[1, 2, 3], [1, 3, 0]]);
    }

    #[test]
    fn triangles_pass_through_as_they_are() {
        let done = split(&SQUARE, &[&[2, 1, 0], &[0, 0, 3], &[2, 1, 0]]);
        assert_eq!(done.faces, [[2, 1, 0], [0, 0, 3], [2, 1, 0]]);
        assert_eq!(done.polygon_of_face, [0, 1, 2]);
        assert_eq!(done.notes, super::TriangulationNotes::default());
    }

    #[test]
    fn an_arrowhead_is_split_at_its_notch() {
        // Corner 3 is reflex: only the diagonal 1-3 stays inside.
        let arrow = [[0.0, 0.0, 0.0], [4.0, 1.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 0.0]];
        let done = split(&arrow, &[&[0, 1, 2, 3]]);
        assert_eq!(done.faces, [[1, 2, 3], [1, 3, 0]]);
        assert_eq!(done.notes.other_choice, 1);
        // The same at scales where squares leave the range of numbers.
        for scale in [1e200, 1e-200, 1e307] {
            let scaled = arrow.map(|p| p.map(|x| x * scale));
            assert_eq!(split(&scaled, &[&[0, 1, 2, 3]]).faces, done.faces);
        }
    }

    #[test]
    fn a_corner_on_a_straight_side_makes_no_flat_triangle() {
        let with_midpoint =
            [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let done = split(&with_midpoint, &[&[0, 1, 2, 3, 4]]);
        assert_eq!(done.faces, [[1, 2, 3], [1, 3, 4], [1, 4, 0]]);
        assert_eq!((done.notes.larger, done.notes.other_choice), (1, 1));
    }

    #[test]
    fn an_existing_edge_is_not_doubled() {
        // The edge 0-2 is taken by a triangle below the square.
        let mut positions = SQUARE.to_vec();
        positions.push([0.5, 0.5, -1.0]);
        let done = split(&positions, &[&[0, 1, 2, 3], &[2, 0, 4]]);
        assert_eq!(done.faces, [[1, 2, 3], [1, 3, 0], [2, 0, 4]]);
        assert_eq!(done.notes.other_choice, 1);
    }

    #[test]
    fn both_sides_of_a_square_get_different_diagonals() {
        let done = split(&SQUARE, &[&[0, 1, 2, 3], &[3, 2, 1, 0]]);
        assert_eq!(done.faces, [[0, 1, 2], [0, 2, 3], [3, 2, 1], [3, 1, 0]]);
        let soup = TriangleSoup { positions: SQUARE.to_vec(), faces: done.faces };
        let report = check(&soup);
        assert_eq!(report.faults, []);
        assert_eq!(report.facts.genus(), Some(0));
    }

    #[test]
    fn a_copy_becomes_the_same_triangles() {
        let done = split(&SQUARE, &[&[0, 1, 2, 3], &[2, 3, 0, 1], &[1, 2, 3, 0]]);
        assert_eq!(done.faces, [[0, 1, 2], [0, 2, 3]].repeat(3));
        assert_eq!(done.polygon_of_face, [0, 0, 1, 1, 2, 2]);
        assert_eq!((done.notes.quads, done.notes.other_choice), (3, 0));
    }

    #[test]
    fn a_reverse_beside_other_polygons_becomes_the_same_triangles() {
        let mut positions = SQUARE.to_vec();
        positions.push([0.5, 0.5, -1.0]);
        let done = split(&positions, &[&[1, 0, 4], &[0, 1, 2, 3], &[1, 0, 3, 2]]);
        assert_eq!(done.faces[1..], [[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]);
    }

    #[test]
    fn a_comb_needs_its_ears_clipped() {
        // Two teeth: no corner sees all others.
        let flat =
            [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [4.0, 1.0], [3.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        let positions = flat.map(|[x, y]| [x, y, 0.0]);
        let done = split(&positions, &[&[0, 1, 2, 3, 4, 5, 6]]);
        assert_eq!(done.faces.len(), 5);
        assert_eq!((done.notes.other_choice, done.notes.unresolved.len()), (1, 0));
        // Shoelace: 24 minus the notches (2,5 to 4: base 3, depth 3 each).
        let area = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| flat[v as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        assert!(done.faces.iter().all(|face| area(face) > 0.0));
        assert!((done.faces.iter().map(area).sum::<f64>() - 15.0).abs() < 1e-12);
        let report = check(&TriangleSoup { positions: positions.to_vec(), faces: done.faces });
        assert_eq!(report.faults, []);
    }

    #[test]
    fn a_flat_polygon_becomes_a_fan_and_is_listed() {
        let line: Vec<[f64; 3]> = (0..4).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let done = split(&line, &[&[0, 1, 2, 3]]);
        assert_eq!(done.faces, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(done.notes.unresolved, [0]);
        // With 0-2 taken the other diagonal is chosen.
        let done = split(&line, &[&[0, 2, 3], &[0, 1, 2, 3]]);
        assert_eq!(done.faces, [[0, 2, 3], [1, 2, 3], [1, 3, 0]]);
        assert_eq!((done.notes.other_choice, done.notes.unresolved), (1, vec![1]));
    }

    #[test]
    fn faults_name_their_polygons() {
        let polygons: [&[u32]; 5] = [&[0, 1], &[0, 1, 2, 9], &[0, 1, 2, 1], &[0, 0, 1], &[]];
        let found = triangulate(&SQUARE, polygons.into_iter()).unwrap_err();
        let expected = [
            Fault::TooFewCorners { face: 0, corners: 2 },
            Fault::IndexOutOfRange { face: 1, index: 9, n_vertices: 4 },
            Fault::RepeatedVertex { face: 2, vertex: 1 },
            Fault::TooFewCorners { face: 4, corners: 0 },
        ];
        assert_eq!(found, expected);
    }
}
