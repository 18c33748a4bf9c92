use super::*;

/// A strip of quads, two triangles each, in the plane by the corners of its cuts.
fn strip(cuts: &[[[f64; 2]; 2]]) -> (TriMesh, Vec<[f64; 2]>) {
    let points = cuts.as_flattened();
    let quads = (0..cuts.len() as u32 - 1).map(|k| 2 * k);
    let faces: Vec<[u32; 3]> = quads.flat_map(|a| [[a, a + 3, a + 1], [a, a + 2, a + 3]]).collect();
    let mesh = TriMesh::from_faces(points.len(), &faces).unwrap();
    (mesh, faces.as_flattened().iter().map(|&v| points[v as usize]).collect())
}

/// The area that two triangles have in common: one is clipped by the sides of the other.
fn common_area(a: [[f64; 2]; 3], b: [[f64; 2]; 3]) -> f64 {
    let mut rest = a.to_vec();
    for k in 0..3 {
        let ([x, y], [to_x, to_y]) = (b[k], b[(k + 1) % 3]);
        let side = |p: [f64; 2]| (to_x - x) * (p[1] - y) - (to_y - y) * (p[0] - x);
        let mut kept = Vec::new();
        for i in 0..rest.len() {
            let (p, q) = (rest[i], rest[(i + 1) % rest.len()]);
            let (s, t) = (side(p), side(q));
            if s >= 0.0 {
                kept.push(p);
            }
            if s * t < 0.0 {
                let share = s / (s - t);
                kept.push([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])]);
            }
        }
        rest = kept;
    }
    let doubled = (0..rest.len()).map(|i| {
        let (p, q) = (rest[i], rest[(i + 1) % rest.len()]);
        p[0] * q[1] - p[1] * q[0]
    });
    0.5 * doubled.sum::<f64>()
}

/// Checks what is promised of an atlas: no two triangles have area in common, charts are apart and in the square, and every
/// triangle is that of the map, turned by quarters and scaled.
fn check(mesh: &TriMesh, before: &[[f64; 2]], atlas: &Atlas, [texels, margin]: [f64; 2]) {
    let gap = margin / texels - 1e-12;
    let mut sides =
        vec![[f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]; atlas.n_charts];
    for f in mesh.faces() {
        let corners = triangle(&atlas.corner_uvs, f);
        for [u, v] in corners {
            assert!(u.min(v) >= gap && u.max(v) <= 1.0 - gap, "{f:?} at {u}, {v}");
            let [a, b, c, d] = &mut sides[atlas.chart[f] as usize];
            (*a, *b, *c, *d) = (a.min(u), b.min(v), c.max(u), d.max(v));
        }
        for g in mesh.faces().filter(|&g| g > f) {
            let area = common_area(corners, triangle(&atlas.corner_uvs, g));
            assert!(area < 1e-12, "{f:?} and {g:?} have {area} in common");
        }
        let [a, b, c] = triangle(before, f);
        let edge = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
        let scaled = [edge(a, b), edge(a, c)].map(|e| e.map(|x| x * atlas.density / texels));
        let made = [edge(corners[0], corners[1]), edge(corners[0], corners[2])];
        let is_turned = |turn: fn([f64; 2]) -> [f64; 2]| {
            scaled.iter().zip(made).all(|(&e, m)| {
                let t = turn(e);
                (t[0] - m[0]).abs().max((t[1] - m[1]).abs()) < 1e-12
            })
        };
        assert!(is_turned(|e| e) || is_turned(|[x, y]| [-y, x]), "{f:?}");
    }
    for (i, a) in sides.iter().enumerate() {
        for b in &sides[..i] {
            let apart = [b[0] - a[2], a[0] - b[2], b[1] - a[3], a[1] - b[3]];
            assert!(apart.iter().any(|&d| d >= gap), "charts are {apart:?} from each other");
        }
    }
}

#[test]
fn two_squares_fill_half_of_the_texture() {
    // Two squares apart: strips of one quad, in one mesh.
    let faces = [[0u32, 2, 1], [2, 3, 1], [4, 6, 5], [6, 7, 5]];
    let mesh = TriMesh::from_faces(8, &faces).unwrap();
    let square = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    // Both at the same place: charts lie over each other in maps.
    let uvs: Vec<_> = faces.as_flattened().iter().map(|&v| square[v as usize % 4]).collect();
    let atlas = Atlas::new(&mesh, &uvs, 64, 2).unwrap();
    assert_eq!((atlas.n_islands, atlas.n_charts, atlas.overlapping.len()), (2, 2, 0));
    // Two of them and three margins in 64 texels.
    assert!((atlas.density - 29.0).abs() < 0.02, "{}", atlas.density);
    check(&mesh, &uvs, &atlas, [64.0, 2.0]);
}

#[test]
fn a_strip_that_winds_over_its_beginning_is_cut() {
    // Ten eighths of a ring: the last two lie over the first two.
    let cuts: Vec<_> = (0..=10)
        .map(|k| {
            let (sin, cos) = (f64::from(k % 8) * std::f64::consts::FRAC_PI_4).sin_cos();
            [[2.0 * cos, 2.0 * sin], [cos, sin]]
        })
        .collect();
    let (mesh, uvs) = strip(&cuts);
    let atlas = Atlas::new(&mesh, &uvs, 512, 4).unwrap();
    let expected: Vec<Face> = (0..4).chain(16..20).map(Face::from).collect();
    assert_eq!(atlas.overlapping, expected);
    assert_eq!((atlas.n_islands, atlas.n_charts), (1, 2));
    assert_eq!(atlas.chart.enumerate().filter(|&(_, &chart)| chart == 1).count(), 4);
    check(&mesh, &uvs, &atlas, [512.0, 4.0]);
}

#[test]
fn long_charts_are_turned() {
    // Two bars across each other: side by side they need a quarter of the square only.
    let bar = |wide: f64, high: f64| [[0.0, 0.0], [wide, 0.0], [wide, high], [0.0, high]];
    let corners = [bar(4.0, 1.0), bar(1.0, 4.0)].concat();
    let faces = [[0u32, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let mesh = TriMesh::from_faces(8, &faces).unwrap();
    let uvs: Vec<_> = faces.as_flattened().iter().map(|&v| corners[v as usize]).collect();
    let atlas = Atlas::new(&mesh, &uvs, 100, 0).unwrap();
    assert!((atlas.density - 25.0).abs() < 0.02, "{}", atlas.density);
    check(&mesh, &uvs, &atlas, [100.0, 0.0]);
}

#[test]
fn too_many_margins_do_not_fit() {
    let (mesh, uvs) = strip(&[[[0.0, 0.0], [0.0, 1.0]], [[1.0, 0.0], [1.0, 1.0]]]);
    let refused = |texels, margin| Atlas::new(&mesh, &uvs, texels, margin).unwrap_err();
    let error = AtlasError { n_charts: 1, texels: 8, margin: 4 };
    assert_eq!(refused(8, 4), error);
    assert_eq!(refused(8, 9).margin, 9);
    assert!(Atlas::new(&mesh, &uvs, 9, 4).is_ok());
}
