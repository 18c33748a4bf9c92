//! Ways to break a result.

use super::Case;
use seamstress_testkit::Rng;

/// What is broken, one of the reasons that have to be named, and how to break it.
pub type Mutation = (&'static str, &'static str, fn(&mut Case, &mut Rng));

pub const MUTATIONS: &[Mutation] = &[
    // Numbers.
    ("a UV that is no number", "NonFiniteUv", |case, rng| *coordinate(case, rng) = f64::NAN),
    ("an infinite UV", "NonFiniteUv", |case, rng| *coordinate(case, rng) = f64::INFINITY),
    ("a UV short", "UvCount", |case, _| case.uvs.truncate(case.uvs.len() - 1)),
    ("a UV too many", "UvCount", |case, _| case.uvs.push([0.0; 2])),
    ("a face without UVs", "UvCount", |case, _| case.uvs.truncate(case.uvs.len() - 3)),
    // Orientation.
    ("all mirrored", "FlippedTriangle", |case, _| case.uvs.iter_mut().for_each(|uv| uv.swap(0, 1))),
    ("all mirrored", "PoincareHopf", |case, _| case.uvs.iter_mut().for_each(|uv| uv[0] *= -1.0)),
    ("a face mirrored", "FlippedTriangle", |case, rng| {
        triangle(case, rng).iter_mut().for_each(|uv| uv.swap(0, 1));
    }),
    ("two corners of a face exchanged", "FlippedTriangle", |case, rng| {
        triangle(case, rng).swap(0, 1)
    }),
    ("a face in a point", "CollapsedTriangle", |case, rng| {
        let triangle = triangle(case, rng);
        triangle.fill(triangle[0]);
    }),
    ("a side in a point", "CollapsedTriangle", |case, rng| {
        let triangle = triangle(case, rng);
        triangle[1] = triangle[0];
    }),
    ("a face on a line", "CollapsedTriangle", |case, rng| {
        let triangle = triangle(case, rng);
        triangle[2] = [0, 1].map(|i| 2.0 * triangle[1][i] - triangle[0][i]);
    }),
    ("a face on a slanted line", "CollapsedTriangle", |case, rng| {
        triangle(case, rng).copy_from_slice(&[[0.1, 0.1], [0.7, 0.7], [0.3, 0.3]]);
    }),
    ("a face turned over by the last bit", "FlippedTriangle", |case, rng| {
        triangle(case, rng).copy_from_slice(&[[0.1, 0.1], [0.7, 0.7], [0.3, 0.3f64.next_down()]]);
    }),
    ("a vertex beyond the faces around it", "FlippedTriangle", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        case.move_vertex(vertex, [2.5, 0.25]);
    }),
    ("a vertex on the side of a face around it", "CollapsedTriangle", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        let corner = case.corners_at(vertex)[0];
        let [at, a, b] = [0, 1, 2].map(|j| case.uvs[corner - corner % 3 + (corner + j) % 3]);
        case.move_vertex(vertex, [0, 1].map(|i| 0.5 * (a[i] + b[i]) - at[i]));
    }),
    // Seams.
    ("a corner moved by a millionth", "OpenSeam", |case, rng| *coordinate(case, rng) += 1e-6),
    ("a corner moved by little more than is allowed", "OpenSeam", |case, rng| {
        *coordinate(case, rng) += 3e-9;
    }),
    ("a face scaled", "OpenSeam", |case, rng| scale(triangle(case, rng), 2.0)),
    ("a face scaled by little", "OpenSeam", |case, rng| scale(triangle(case, rng), 1.0 + 1e-8)),
    ("half of the faces scaled", "OpenSeam", |case, _| {
        let middle = case.uvs.len() / 6 * 3 + 3;
        scale(&mut case.uvs[..middle], 1.5);
    }),
    ("a face turned by an angle", "OpenSeam", |case, rng| rotate(triangle(case, rng), 0.8)),
    ("a face turned by little", "OpenSeam", |case, rng| rotate(triangle(case, rng), 1e-7)),
    ("the corners of a face moved on", "OpenSeam", |case, rng| triangle(case, rng).rotate_left(1)),
    ("all stretched along one axis", "OpenSeam", |case, _| {
        case.uvs.iter_mut().for_each(|uv| uv[0] *= 2.0);
    }),
    ("all sheared", "OpenSeam", |case, _| case.uvs.iter_mut().for_each(|uv| uv[0] += 0.5 * uv[1])),
    ("few digits", "OpenSeam", |case, _| {
        rotate(&mut case.uvs, 1.0);
        case.uvs.iter_mut().flatten().for_each(|x| *x = (*x * 1e4).round() / 1e4);
    }),
    ("single precision", "OpenSeam", |case, _| {
        rotate(&mut case.uvs, 1.0);
        case.uvs.iter_mut().flatten().for_each(|x| *x = f64::from(*x as f32));
    }),
    ("all so far away that few digits are left", "OpenSeam", |case, _| {
        rotate(&mut case.uvs, 1.0);
        case.uvs.iter_mut().for_each(|uv| uv[0] += 1e15);
    }),
    ("charts that a later step has moved, but for one corner", "OpenSeam", |case, rng| {
        let corner = rng.below(case.uvs.len());
        let uv = case.uvs[corner];
        case.uvs.iter_mut().for_each(|uv| uv[1] += 4.0);
        case.uvs[corner] = uv;
    }),
    // Angles.
    ("a cone without an eighth of its angle", "ConeAngle", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        lay_star(case, vertex, 7.0 / 8.0);
    }),
    ("a cone with a hundredth too much", "ConeAngle", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        lay_star(case, vertex, 1.01);
    }),
    ("a vertex that is wound backwards", "ConeAngle", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        lay_star(case, vertex, -1.0);
    }),
    // Connectivity.
    ("a face with a vertex that is not there", "BadFace", |case, rng| {
        let (face, n) = (rng.below(case.faces.len()), case.positions.len() as u32);
        set_face(case, face, |face| face[0] = n);
    }),
    ("a face with a vertex twice", "BadFace", |case, rng| {
        let face = rng.below(case.faces.len());
        set_face(case, face, |face| face[1] = face[0]);
    }),
    ("a face the other way round", "RepeatedEdge", |case, rng| {
        let face = rng.below(case.faces.len());
        set_face(case, face, |face| face.swap(1, 2));
        case.uvs.swap(3 * face + 1, 3 * face + 2);
    }),
    ("a face twice", "RepeatedEdge", |case, rng| {
        let face = rng.below(case.faces.len());
        case.faces.push(case.faces[face]);
        case.uvs.extend_from_within(3 * face..3 * face + 3);
        case.source.1 = case.faces.clone();
    }),
    ("a third face at an edge", "RepeatedEdge", |case, rng| {
        let [a, b, _] = case.faces[rng.below(case.faces.len())];
        case.faces.push([b, a, case.positions.len() as u32]);
        case.positions.push([9.0; 3]);
        case.uvs.extend([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        case.source = (case.positions.clone(), case.faces.clone());
    }),
    ("two vertices made one", "SplitVertex", |case, _| {
        let [from, to] = far_apart(&case.faces);
        case.faces.as_flattened_mut().iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
        case.source.1 = case.faces.clone();
    }),
    // The mesh that was given.
    ("a vertex moved", "MovedVertex", |case, rng| {
        let vertex = rng.below(case.positions.len());
        case.positions[vertex][2] += 0.1;
    }),
    ("a vertex moved by the last bit", "MovedVertex", |case, rng| {
        let x = &mut case.positions[rng.below(case.source.0.len())][1];
        *x = x.next_up();
    }),
    ("a vertex at no number", "MovedVertex", |case, rng| {
        case.positions[rng.below(case.source.0.len())][0] = f64::NAN;
    }),
    ("a vertex more", "VertexCount", |case, _| case.positions.push([0.0; 3])),
    ("a face less", "FaceCount", |case, _| case.faces.truncate(case.faces.len() - 1)),
    ("faces in another order", "ChangedFace", |case, _| case.faces.swap(0, 1)),
    ("a face from another corner", "ChangedFace", |case, rng| {
        case.faces[rng.below(case.source.1.len())].rotate_left(1);
    }),
    // Alignment.
    ("an aligned edge that is none", "NotAnEdge", |case, _| {
        let pair = far_apart(&case.faces);
        case.aligned.push(pair);
    }),
    ("an aligned edge of no vertex", "NotAnEdge", |case, _| case.aligned.push([0, 1_000_000])),
    ("a vertex off its isolines", "OffAxis", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        case.move_vertex(vertex, [0.125, 0.0625]);
    }),
    ("a vertex off its isolines by little", "OffAxis", |case, rng| {
        let vertex = case.ordinary_vertex(rng);
        case.move_vertex(vertex, [0.5f64.powi(30), 0.5f64.powi(30)]);
    }),
    ("all turned by little", "OffAxis", |case, _| rotate(&mut case.uvs, 1e-7)),
    ("a diagonal as an aligned edge", "OffAxis", |case, rng| push_diagonal(case, rng)),
    ("a diagonal as an aligned edge", "SectorAngle", |case, rng| push_diagonal(case, rng)),
    // Integers.
    ("a chart moved by half a cell", "FractionalTranslation", |case, rng| {
        triangle(case, rng).iter_mut().for_each(|uv| uv[0] += 0.5);
    }),
    ("a chart moved by little", "FractionalTranslation", |case, rng| {
        triangle(case, rng).iter_mut().for_each(|uv| uv[1] += 0.5f64.powi(30));
    }),
    ("cells that are too large", "FractionalTranslation", |case, _| scale(&mut case.uvs, 1.25)),
    ("a last bit", "InexactEdge", |case, rng| {
        let x = coordinate(case, rng);
        *x = if *x == 0.0 { 1e-17 } else { x.next_up() };
    }),
    ("cones at the middles of cells", "FractionalCone", |case, _| {
        case.uvs.iter_mut().flatten().for_each(|x| *x += 0.5);
    }),
    ("corners of aligned edges at the middles of cells", "FractionalCorner", |case, _| {
        case.uvs.iter_mut().flatten().for_each(|x| *x += 0.5);
    }),
    ("aligned edges between isolines", "OffIsoline", |case, _| {
        case.uvs.iter_mut().flatten().for_each(|x| *x += 0.25);
    }),
    // Quads.
    ("a quad with a vertex that is not there", "BadFace", |case, rng| {
        let n = case.sources.len() as u32;
        quad(case, rng)[2] = n;
    }),
    ("a quad with a vertex twice", "BadFace", |case, rng| {
        let quad = quad(case, rng);
        quad[2] = quad[0];
    }),
    ("a quad the other way round", "RepeatedEdge", |case, rng| quad(case, rng).reverse()),
    ("a quad twice", "RepeatedEdge", |case, rng| {
        let copy = *quad(case, rng);
        case.quads.push(copy);
    }),
    ("two vertices of quads made one", "SplitVertex", |case, _| {
        let [from, to] = far_apart(&case.quads);
        case.quads.as_flattened_mut().iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
    }),
    ("a quad less", "QuadTopology", |case, rng| {
        let n = case.sources.len() as u32;
        let inner = |quad: &[u32; 4]| quad.iter().all(|&v| v < n && !is_open(&case.quads, v));
        let all: Vec<usize> = (0..case.quads.len()).filter(|&k| inner(&case.quads[k])).collect();
        let gone = all[rng.below(all.len())];
        case.quads.remove(gone);
    }),
    ("a corner of a quad come off", "QuadTopology", |case, rng| {
        let is_inner = |vertex: &u32| {
            let around = case.quads.iter().filter(|quad| quad.contains(vertex)).flatten();
            !around.into_iter().any(|&v| is_open(&case.quads, v))
        };
        let inner: Vec<u32> = (0..case.sources.len() as u32).filter(is_inner).collect();
        let vertex = inner[rng.below(inner.len())];
        let corner = case.quads.as_flattened().iter().position(|&v| v == vertex).unwrap();
        case.quads.as_flattened_mut()[corner] = case.sources.len() as u32;
        case.sources.push(case.sources[vertex as usize]);
    }),
    ("a copy of all quads", "QuadPieces", |case, _| {
        let n = case.sources.len() as u32;
        case.sources.extend_from_within(..);
        let copies: Vec<_> = case.quads.iter().map(|quad| quad.map(|v| v + n)).collect();
        case.quads.extend(copies);
    }),
    ("a quad from nowhere", "StrayQuad", |case, rng| {
        let vertex = rng.below(case.sources.len());
        case.sources[vertex] = case.quad_surface.len() as u32;
    }),
    ("a quad to another component", "StrayQuad", |case, rng| {
        let n = case.positions.len() as u32;
        case.positions.extend([[7.0; 3], [8.0; 3], [7.5; 3]]);
        case.quad_surface.push([n, n + 1, n + 2]);
        case.source.0 = case.positions.clone();
        let vertex = rng.below(case.sources.len());
        case.sources[vertex] = case.quad_surface.len() as u32 - 1;
    }),
    ("quads inside of a quad", "QuadCount", |case, rng| {
        let quad = rng.below(case.quads.len());
        inset(case, quad);
    }),
    ("quads inside of all quads", "QuadIndex", |case, _| {
        (0..case.quads.len()).for_each(|quad| inset(case, quad));
    }),
    ("a cone that no vertex has", "QuadIndex", |case, _| case.cones.push(-3)),
    ("a cone of another index", "QuadIndex", |case, rng| {
        let cone = rng.below(case.cones.len());
        case.cones[cone] -= 1;
    }),
    ("a cell that has no quad", "QuadCount", |case, _| case.area += 1.0),
];

fn coordinate<'a>(case: &'a mut Case, rng: &mut Rng) -> &'a mut f64 {
    let corner = rng.below(case.uvs.len());
    &mut case.uvs[corner][rng.below(2)]
}

fn triangle<'a>(case: &'a mut Case, rng: &mut Rng) -> &'a mut [[f64; 2]] {
    let face = rng.below(case.faces.len());
    &mut case.uvs[3 * face..3 * face + 3]
}

fn quad<'a>(case: &'a mut Case, rng: &mut Rng) -> &'a mut [u32; 4] {
    let k = rng.below(case.quads.len());
    &mut case.quads[k]
}

/// Changes a face of the map and of its source alike.
fn set_face(case: &mut Case, face: usize, change: impl FnOnce(&mut [u32; 3])) {
    change(&mut case.faces[face]);
    case.source.1 = case.faces.clone();
}

fn scale(uvs: &mut [[f64; 2]], factor: f64) {
    uvs.iter_mut().flatten().for_each(|x| *x *= factor);
}

fn rotate(uvs: &mut [[f64; 2]], angle: f64) {
    let (sin, cos) = angle.sin_cos();
    uvs.iter_mut().for_each(|uv| *uv = [cos * uv[0] - sin * uv[1], sin * uv[0] + cos * uv[1]]);
}

/// Two vertices without a face or a neighbour in common.
fn far_apart<const N: usize>(faces: &[[u32; N]]) -> [u32; 2] {
    let neighbours = |v: u32| -> Vec<u32> {
        let around =
            faces.iter().filter_map(|face| Some((face, face.iter().position(|&w| w == v)?)));
        around.flat_map(|(face, k)| [face[(k + 1) % N], face[(k + N - 1) % N]]).collect()
    };
    let all: Vec<u32> = faces.as_flattened().to_vec();
    let is_apart = |a: u32, b: u32| {
        let (of_a, of_b) = (neighbours(a), neighbours(b));
        a != b
            && !faces.iter().any(|face| face.contains(&a) && face.contains(&b))
            && !of_a.iter().any(|v| of_b.contains(v))
    };
    let mut pairs = all.iter().flat_map(|&a| all.iter().map(move |&b| [a, b]));
    pairs.find(|&[a, b]| is_apart(a, b)).unwrap()
}

/// Whether a vertex of quads lies on their boundary.
fn is_open(quads: &[[u32; 4]], vertex: u32) -> bool {
    let sides = |q: &[u32; 4]| [0, 1, 2, 3].map(|k| [q[k], q[(k + 1) % 4]]);
    let all: Vec<[u32; 2]> = quads.iter().flat_map(sides).filter(|e| e.contains(&vertex)).collect();
    all.iter().any(|&[a, b]| !all.contains(&[b, a]))
}

/// Lays the faces around a vertex anew, each in a chart of its own, with all angles there by a factor.
fn lay_star(case: &mut Case, vertex: u32, factor: f64) {
    let mut from = 0.0;
    let mut corner = case.corners_at(vertex)[0];
    for _ in case.corners_at(vertex) {
        let ends = [0, 1, 2].map(|j| corner - corner % 3 + (corner + j) % 3);
        let [at, next, prev] = ends.map(|k| case.uvs[k]);
        let [p, q] = [next, prev].map(|end| [end[0] - at[0], end[1] - at[1]]);
        let angle = (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1]);
        let to = from + factor * angle;
        let place = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
        case.uvs[ends[0]] = [0.0; 2];
        case.uvs[ends[1]] = place(p[0].hypot(p[1]), from);
        case.uvs[ends[2]] = place(q[0].hypot(q[1]), to);
        from = to;
        corner = case.next_around(corner);
    }
}

/// A side of a face that is not along an axis.
fn push_diagonal(case: &mut Case, rng: &mut Rng) {
    let [a, b, c] = case.faces[rng.below(case.faces.len())];
    let sides = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
    case.aligned.extend(sides.iter().copied().find(|side| !case.aligned.contains(side)));
}

/// Puts a quad into the middle of another one, with four around it.
fn inset(case: &mut Case, quad: usize) {
    let (outer, first) = (case.quads[quad], case.sources.len() as u32);
    let inner = [0, 1, 2, 3].map(|k| first + k);
    case.sources.extend([case.sources[outer[0] as usize]; 4]);
    case.quads[quad] = inner;
    case.quads.extend([0, 1, 2, 3].map(|k| {
        let next = (k + 1) % 4;
        [outer[k], outer[next], inner[next], inner[k]]
    }));
}
