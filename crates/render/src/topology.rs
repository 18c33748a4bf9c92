//! Edges of the faces, found by sorting.

/// One side of an edge: the directed edge from corner `corner` of the face list to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    /// The vertices, smaller first.
    pub(crate) vertices: [u32; 2],
    /// Three times the face, plus the place in it where the side starts.
    pub(crate) corner: u32,
}

/// The corner after this one in its face.
pub(crate) fn next_corner(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// All sides of all faces, sorted so that the sides of one edge are neighbours: by counting to their smaller vertices,
/// then the few of each vertex among themselves.
pub(crate) fn sorted_sides(faces: &[[u32; 3]]) -> Vec<Side> {
    let all = || {
        (0..).zip(faces).flat_map(|(face, corners): (u32, _)| {
            (0..3).map(move |k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                Side { vertices: [a.min(b), a.max(b)], corner: 3 * face + k as u32 }
            })
        })
    };
    let vertices = faces.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let mut ends = vec![0; vertices + 1];
    all().for_each(|side| ends[side.vertices[0] as usize + 1] += 1);
    for vertex in 0..vertices {
        ends[vertex + 1] += ends[vertex];
    }
    let mut sides = vec![Side { vertices: [0; 2], corner: 0 }; 3 * faces.len()];
    // What starts as the place of a vertex's first side comes to be the end of its last.
    for side in all() {
        let end = &mut ends[side.vertices[0] as usize];
        sides[*end] = side;
        *end += 1;
    }
    let mut start = 0;
    for &end in &ends[..vertices] {
        sides[start..end].sort_unstable();
        start = end;
    }
    sides
}

/// The sides of each edge in turn.
pub(crate) fn edges(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|a, b| a.vertices == b.vertices)
}

/// The corners of two faces that meet along an edge, matched vertex by vertex.
pub(crate) fn matched_corners(faces: &[[u32; 3]], a: Side, b: Side) -> [[u32; 2]; 2] {
    let vertex = |corner: u32| faces[corner as usize / 3][corner as usize % 3];
    let (a0, a1) = (a.corner, next_corner(a.corner));
    let (b0, b1) = (b.corner, next_corner(b.corner));
    if vertex(a0) == vertex(b0) { [[a0, b0], [a1, b1]] } else { [[a0, b1], [a1, b0]] }
}
