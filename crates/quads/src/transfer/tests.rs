use super::*;
use seamstress_mesh::soup::TriangleSoup;

/// A surface and quads on it, with their sources where the quads were made.
struct Case {
    soup: TriangleSoup,
    mesh: TriMesh,
    quads: QuadMesh,
    sources: Vec<SurfacePoint>,
}

impl Case {
    fn new(soup: TriangleSoup, quads: QuadMesh) -> Self {
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let points = quads.positions().iter().copied();
        let sources = locate(&soup.positions, &soup.faces, points).unwrap();
        Self { soup, mesh, quads, sources }
    }

    fn carry(&self, attribute: &Attribute) -> Attribute {
        let surface = (&self.soup.positions[..], &self.soup.faces[..]);
        let transfer = Transfer::new(&self.mesh, surface, &self.quads, &self.sources).unwrap();
        transfer.carry(attribute, attribute.domain)
    }

    /// Values of corners of the triangles: a function of the middle of the triangle and the corner.
    fn of_corners(
        &self,
        kind: AttributeKind,
        value: impl Fn(Point, Point) -> [f64; 2],
    ) -> Attribute {
        let corners = |face: &[u32; 3]| {
            let corners = face.map(|v| self.soup.positions[v as usize]);
            let middle = [0, 1, 2].map(|k| corners.iter().map(|p| p[k] / 3.0).sum());
            corners.map(|p| value(middle, p))
        };
        let values: Vec<[f64; 2]> = self.soup.faces.iter().flat_map(corners).collect();
        Attribute::new("uv", AttributeDomain::Corner, kind, 2, values.into_flattened())
    }

    fn quad_middle(&self, quad: usize) -> Point {
        bilinear(self.quads.quads()[quad].map(|v| self.quads.positions()[v as usize]), [0.5; 2])
    }
}

/// Squares of a rectangle of the plane, `n` by `m`, moved to space by a function.
fn squares(n: u32, m: u32, place: impl Fn([f64; 2]) -> Point) -> QuadMesh {
    let at = |i: u32, j: u32| place([f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)]);
    let positions = (0..=m).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| at(i, j));
    let index = |i: u32, j: u32| j * (n + 1) + i;
    let square = |i, j| [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
    let quads = (0..m).flat_map(|j| (0..n).map(move |i| square(i, j)));
    QuadMesh::new(positions.collect(), quads.collect()).unwrap()
}

/// Triangles of the unit square.
fn sheet(n: u32) -> TriangleSoup {
    let grid = squares(n, n, |[x, y]| [x, y, 0.0]);
    let faces = grid.quads().iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleSoup { positions: grid.positions().to_vec(), faces }
}

fn close(a: &[f64], b: [f64; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
}

#[test]
fn a_quad_takes_the_side_of_a_seam_that_its_middle_lies_on() {
    // The seam at x = 0.4 cuts the third of seven columns of quads, and the second of three.
    for columns in [7, 3] {
        let case = Case::new(sheet(10), squares(columns, 4, |[x, y]| [x, y, 0.0]));
        let shift = |middle: Point| if middle[0] < 0.4 { 0.0 } else { 5.0 };
        let uv = |middle, [x, y, _]: Point| [2.0 * x - y + shift(middle), x + y];
        let carried = case.carry(&case.of_corners(AttributeKind::Uv, uv));
        for quad in 0..case.quads.quads().len() {
            let middle = case.quad_middle(quad);
            for k in 0..4 {
                let v = case.quads.quads()[quad][k] as usize;
                let expected = uv(middle, case.quads.positions()[v]);
                let found = carried.of(4 * quad + k);
                assert!(close(found, expected), "quad {quad}, corner {k}: {found:?}, {expected:?}");
            }
        }
        // Corners with equal values share a row: five rows of vertices, and one more at the seam.
        assert_eq!(carried.n_rows(), 5 * (columns as usize + 2));
    }
}

#[test]
fn one_island_may_lie_on_both_sides_of_its_seam() {
    // A tube of twelve sides, cut along one line; its quads are a quarter of a side out of step.
    let around = |turn: f64, z: f64| {
        // On the sides, not on the circle.
        let (side, part) = ((12.0 * turn).floor(), (12.0 * turn).fract());
        let corner = |k: f64| (std::f64::consts::TAU * k / 12.0).sin_cos();
        let ((s, c), (s1, c1)) = (corner(side), corner(side + 1.0));
        [c + part * (c1 - c), s + part * (s1 - s), z]
    };
    let ring = |n: u32, shift: f64| {
        let at = |k: u32| f64::from(k) / f64::from(n) + shift;
        let positions = (0..2 * n).map(|k| around(at(k % n), f64::from(k / n)));
        let square = |k: u32| [k, (k + 1) % n, (k + 1) % n + n, k + n];
        QuadMesh::new(positions.collect(), (0..n).map(square).collect()).unwrap()
    };
    let tube = ring(12, 0.0);
    let faces = tube.quads().iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let soup = TriangleSoup { positions: tube.positions().to_vec(), faces };
    let case = Case::new(soup, ring(12, 1.0 / 48.0));
    // The number of the side and the part of it, for corners: 12 at the seam from below, 0 from above.
    let values = (0..12).flat_map(|k| [k, k + 1, k + 1, k, k + 1, k].map(f64::from));
    let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
    let turns = Attribute::new("turn", domain, kind, 1, values.collect());
    let carried = case.carry(&turns);
    for quad in 0..12 {
        let width = carried.of(4 * quad + 1)[0] - carried.of(4 * quad)[0];
        // Quads go around a bend of the tube: along its last side the rest is a little shorter.
        assert!((0.9..=1.1).contains(&width), "quad {quad}: {width}");
    }
    assert!(carried.of(4 * 11 + 1)[0] > 12.0 && carried.of(0)[0] > 0.0);
}

#[test]
fn values_of_vertices_are_those_where_they_lie() {
    let case = Case::new(sheet(6), squares(4, 4, |[x, y]| [x, y, 0.0]));
    let values = case.soup.positions.iter().map(|[x, y, _]| 3.0 * x - y + 1.0).collect();
    let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Number);
    let carried = case.carry(&Attribute::new("heat", domain, kind, 1, values));
    for (v, [x, y, _]) in case.quads.positions().iter().enumerate() {
        assert!((carried.of(v)[0] - (3.0 * x - y + 1.0)).abs() < 1e-12);
    }
    // Whole numbers that stand for something are not mixed.
    let names = ["low", "high"].map(String::from).to_vec();
    let rows = case.soup.positions.iter().map(|p| u32::from(p[0] > 0.45)).collect();
    let carried = case.carry(&Attribute::labels("side", domain, names, rows));
    let found: Vec<u32> = (0..5).map(|v| carried.rows[v]).collect();
    assert_eq!(found, [0, 0, 1, 1, 1]);
}

#[test]
fn vertices_that_were_moved_have_the_values_of_their_new_places() {
    let mut case = Case::new(sheet(6), squares(4, 4, |[x, y]| [x, y, 0.0]));
    case.quads = squares(4, 4, |[x, y]| [x * (2.0 - x), y, 0.0]);
    let values = case.soup.positions.iter().map(|p| p[0]).collect();
    let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Number);
    let carried = case.carry(&Attribute::new("x", domain, kind, 1, values));
    for (v, p) in case.quads.positions().iter().enumerate() {
        assert!((carried.of(v)[0] - p[0]).abs() < 1e-12);
    }
}

#[test]
fn a_quad_has_the_label_of_most_of_its_area_and_the_mean_of_numbers() {
    let case = Case::new(sheet(40), squares(8, 8, |[x, y]| [x, y, 0.0]));
    // Red below the line y = 0.3 + 0.4 x, whose part of the square is one half.
    let middle = |face: &[u32; 3]| {
        let y = |v: &u32| {
            case.soup.positions[*v as usize][1] - 0.4 * case.soup.positions[*v as usize][0]
        };
        face.iter().map(|v| y(v) / 3.0).sum::<f64>()
    };
    let is_red: Vec<bool> = case.soup.faces.iter().map(|face| middle(face) < 0.3).collect();
    let names = ["blue", "red"].map(String::from).to_vec();
    let rows = is_red.iter().map(|&red| u32::from(red)).collect();
    let carried = case.carry(&Attribute::labels("material", AttributeDomain::Face, names, rows));
    let share = carried.rows.iter().sum::<u32>() as f64 / 64.0;
    assert!((share - 0.5).abs() <= 0.04, "{share}");
    assert_eq!(carried.names, ["blue", "red"]);
    assert_eq!((carried.rows[0], carried.rows[63]), (1, 0));

    let values = is_red.iter().map(|&red| f64::from(u8::from(red))).collect();
    let (domain, kind) = (AttributeDomain::Face, AttributeKind::Number);
    let carried = case.carry(&Attribute::new("redness", domain, kind, 1, values));
    let mean = (0..64).map(|quad| carried.of(quad)[0]).sum::<f64>() / 64.0;
    assert!((mean - 0.5).abs() < 0.01, "{mean}");
}

#[test]
fn the_sheets_of_a_thin_plate_keep_apart() {
    // Two sheets with their backs to each other, nearer than the quads on them are large, joined at their rims.
    let (n, thin) = (12u32, 0.01);
    let top = sheet(n);
    let below = top.positions.len() as u32;
    let mut soup = top.clone();
    soup.positions.extend(top.positions.iter().map(|&[x, y, _]| [x, y, -thin]));
    soup.faces.extend(top.faces.iter().map(|&[a, b, c]| [b + below, a + below, c + below]));
    let rim = |k: u32| [k, (k + 1) * (n + 1) - 1, below - 1 - k, n * (n + 1) - k * (n + 1)];
    for k in 0..n {
        for (a, b) in rim(k).into_iter().zip([
            k + 1,
            (k + 2) * (n + 1) - 1,
            below - 2 - k,
            (n - 1 - k) * (n + 1),
        ]) {
            soup.faces.extend([[b, a, a + below], [b, a + below, b + below]]);
        }
    }
    let quads = squares(3, 3, |[x, y]| [x, y, -thin]);
    let turned = quads.quads().iter().map(|&[a, b, c, d]| [d, c, b, a]).collect();
    let case = Case::new(soup, QuadMesh::new(quads.positions().to_vec(), turned).unwrap());
    let names = ["top", "bottom", "rim"].map(String::from).to_vec();
    let n_sheet = top.faces.len();
    let row = |face: usize| (face / n_sheet).min(2) as u32;
    let rows = (0..case.soup.faces.len()).map(row).collect();
    let carried = case.carry(&Attribute::labels("side", AttributeDomain::Face, names, rows));
    assert_eq!(carried.rows, [1; 9]);
}

#[test]
fn mixed_normals_have_length_one_and_colours_stay_in_range() {
    let case = Case::new(sheet(3), squares(4, 4, |[x, y]| [x, y, 0.0]));
    let bend = |v: usize| case.soup.positions[v][0];
    let n = case.soup.positions.len();
    let values = (0..n).flat_map(|v| [bend(v).sin(), 0.0, bend(v).cos()]).collect();
    let domain = AttributeDomain::Vertex;
    let carried = case.carry(&Attribute::new("normal", domain, AttributeKind::Normal, 3, values));
    for v in 0..25 {
        let length = carried.of(v).iter().map(|x| x * x).sum::<f64>();
        assert!((length - 1.0).abs() < 1e-12);
    }
    // Continued beyond the seam the colour would be negative.
    let shade = |middle: Point, [x, y, _]: Point| {
        if middle[0] < 0.4 { [1.0, y] } else { [x - 1.0 / 3.0, y] }
    };
    let carried = case.carry(&case.of_corners(AttributeKind::Color, shade));
    assert!(carried.values.iter().all(|&x| (0.0..=1.0).contains(&x)));
    let continued = case.carry(&case.of_corners(AttributeKind::Uv, shade));
    assert!(continued.values.iter().any(|&x| x < -0.05));
}
