//! What blocks the way to the integers.

use super::conditional::Row;
use super::gauss::{Gauss, Overflow, add_scaled};
use super::isolines::{part, tied};
use super::rounding::{Constraint, Room, along};
use super::scene::{Carry, Connection, Scene};
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, Halfedge, VertexData};
use seamstress_parametrize::energy::{ProjectedHessian, SymmetricDirichlet};
use seamstress_parametrize::energy::{Triangle, at_corner};
use seamstress_parametrize::quarter::turn;
use std::collections::BTreeMap;

/// Triangles with less than this share of the strongest force are not what blocks the way.
const WEAK: f64 = 0.02;
/// Clusters of more faces are no walls: there the whole layout is in tension.
const MOST_FACES: usize = 5000;
/// How much further along the forces of a wall other integers have to be, grid units where the strongest is one.
const LEAST_WAY: f64 = 0.25;

/// A cluster of collapsing triangles as the grid points and isolines around it feel it.
///
/// Between them ordinary vertices are in balance, so that near the collapse the areas of the triangles, with
/// the forces as multipliers, add up to a linear form in the coordinates of the grid points and in the levels of the
/// isolines alone: these must move along the forces. It is a cut by Farkas' lemma, its multipliers found by a barrier.
#[derive(Debug, Clone)]
pub struct Wall {
    /// What the coordinates of grid points and the levels of isolines are more than the first one, as exact forms in
    /// the coordinates of the space.
    pub ways: Vec<Row>,
    /// The force on each of these, the strongest one.
    pub forces: Vec<f64>,
}

impl Wall {
    /// What keeps a rounding beyond the wall: from integers `x` that led to it, with the coordinates `here` of the
    /// layout at the wall and grid size `h`, both in the layout's units.
    ///
    /// The condition is one half-space. Its ways are told apart so that the rounding can fix them one by one, after the
    /// connections shorter than a cell: with the half-space alone, which nothing heeds before it is determined, fewer
    /// roundings succeeded.
    pub fn beyond(&self, x: &[i64], here: &[f64], h: f64) -> (Vec<Constraint>, Room) {
        let way = |row: &Row| {
            // It may vanish.
            let rows = [row.clone(), Row::new()];
            Constraint::new(&Connection { length: 0.0, rows, least: 0 }, here, h)
        };
        let ways: Vec<Constraint> = self.ways.iter().map(way).collect();
        let at_x = along(&self.forces, ways.iter().map(|way| way.at(x)));
        let at_here = along(&self.forces, ways.iter().map(|way| way.start));
        let more_than = at_x + (0.5 * (at_here - at_x)).max(LEAST_WAY);
        (ways, Room::Wall { forces: self.forces.clone(), more_than })
    }
}

/// A face of a cluster and how it is reached from the first one.
type Reached = (Face, Carry);

/// The walls around clusters of collapsing triangles.
///
/// # Errors
/// [`Overflow`].
pub fn walls(scene: &Scene<'_>, triangles: &[Triangle]) -> Result<Vec<Wall>, Overflow> {
    let forces: Vec<[Complex64; 3]> = triangles.iter().map(|t| forces(t, scene.z)).collect();
    let strength: Vec<f64> =
        forces.iter().map(|p| p.iter().map(|f| f.norm()).fold(0.0, f64::max)).collect();
    let strongest = strength.iter().copied().fold(0.0, f64::max);
    let mut open = Open {
        faces: strength.iter().map(|&s| s > WEAK * strongest).collect(),
        vertices: scene.needs.is_point.iter().map(|is_point| !is_point).collect(),
    };
    let mut found = Vec::new();
    for f in scene.mesh.faces() {
        if open.faces[f] {
            let cluster = cluster(scene, f, &mut open)?;
            if cluster.len() <= MOST_FACES {
                found.extend(wall(scene, &cluster, &forces)?);
            }
        }
    }
    Ok(found)
}

/// The forces of a triangle's energy on its corners.
fn forces(t: &Triangle, z: &[Complex64]) -> [Complex64; 3] {
    let d = ProjectedHessian::new(&SymmetricDirichlet, &t.jacobian(z)).gradient;
    t.gradients.map(|g| {
        let [x, y] = at_corner(d, g);
        -t.weight * Complex64::new(x, y)
    })
}

/// What belongs to no cluster yet.
struct Open {
    /// Triangles with a force.
    faces: FaceData<bool>,
    /// Ordinary vertices.
    vertices: VertexData<bool>,
}

/// Open faces that hang together at ordinary vertices; they are closed.
fn cluster(scene: &Scene<'_>, first: Face, open: &mut Open) -> Result<Vec<Reached>, Overflow> {
    open.faces[first] = false;
    let mut cluster = vec![(first, Carry::default())];
    let mut next = 0;
    while let Some((face, path)) = cluster.get(next).cloned() {
        next += 1;
        for corner in face.halfedges() {
            let v = scene.mesh.origin(corner);
            if std::mem::take(&mut open.vertices[v]) {
                let around = faces_around(scene, corner, &path)?;
                let is_new = |(f, _): &Reached| std::mem::take(&mut open.faces[*f]);
                cluster.extend(around.into_iter().filter(is_new));
            }
        }
    }
    Ok(cluster)
}

/// The other faces at a vertex, for a path that ends at a corner there and goes on around it.
fn faces_around(
    scene: &Scene<'_>,
    corner: Halfedge,
    path: &Carry,
) -> Result<Vec<Reached>, Overflow> {
    let mesh = scene.mesh;
    let mut found = Vec::new();
    let mut walk = |next: &dyn Fn(Halfedge) -> (Halfedge, Option<Halfedge>)| {
        let (mut at, mut path) = (corner, path.clone());
        loop {
            let (edge, Some(beyond)) = next(at) else { return Ok(false) };
            if beyond == corner {
                return Ok(true);
            }
            path = scene.across(path, edge)?;
            at = beyond;
            found.push((at.face(), path.clone()));
        }
    };
    let is_closed = walk(&|h| (h.prev(), mesh.twin(h.prev())))?;
    if !is_closed {
        walk(&|h| (h, mesh.twin(h).map(Halfedge::next)))?;
    }
    Ok(found)
}

/// What a cluster asks of the grid points and isolines at its corners, if there are any.
fn wall(
    scene: &Scene<'_>,
    cluster: &[Reached],
    forces: &[[Complex64; 3]],
) -> Result<Option<Wall>, Overflow> {
    // Levels of both coordinates and the forces on them, in the plane of the first face.
    let mut felt = [Vec::new(), Vec::new()];
    for (f, Carry { turns, form: carried }) in cluster {
        for (corner, force) in f.halfedges().into_iter().zip(forces[f.at()]) {
            let force = turn(force, *turns);
            for (coordinate, force) in [force.re, force.im].into_iter().enumerate() {
                let (there, sign) = tied(coordinate as u32, *turns);
                if let Some(level) = scene.space.level(scene.cut.wedge[corner], there)? {
                    let mut sum = part(carried, coordinate as u32);
                    add_scaled(&mut sum, &level, sign)?;
                    felt[coordinate].push((sum, force));
                }
            }
        }
    }
    // The forces add up to zero: only ways from the first one count. Several corners may be at the end of one.
    let mut ways: BTreeMap<Row, f64> = BTreeMap::new();
    for felt in felt {
        for (level, force) in &felt {
            let mut way = level.clone();
            add_scaled(&mut way, &felt[0].0, Gauss::ONE.negated())?;
            *ways.entry(scene.space.row(&way)?).or_default() += force;
        }
    }
    ways.retain(|row, _| !row.is_empty());
    let strongest = ways.values().fold(0.0, |most: f64, force| most.max(force.abs()));
    let (ways, forces) = ways.into_iter().map(|(row, force)| (row, force / strongest)).unzip();
    Ok((strongest > 0.0).then_some(Wall { ways, forces }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditional::apply;
    use crate::rounding::Span;
    use crate::space::{GridNeeds, IntegerSpace};
    use seamstress_mesh::{HalfedgeData, Metric, TriMesh, Vertex};
    use seamstress_parametrize::cut::{Cut, connect_cones};
    use seamstress_parametrize::energy::triangles;

    /// Four vertices, the last in the middle of the others, which are grid points.
    struct Case {
        mesh: TriMesh,
        metric: Metric,
        cut: Cut,
        matching: HalfedgeData<i32>,
        needs: GridNeeds,
        space: IntegerSpace,
    }

    const POSITIONS: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [5.0 / 3.0, 1.0, 0.0]];

    impl Case {
        /// Three grid points.
        fn new() -> Self {
            Self::with(&[0, 1, 2], Vec::new())
        }

        fn with(points: &[usize], levels: Vec<(Halfedge, u32)>) -> Self {
            let mesh = TriMesh::from_faces(4, &[[0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
            let metric = Metric::from_positions(&mesh, &POSITIONS);
            let no_cones = VertexData::filled(4, false);
            let (cut, _) = connect_cones(&mesh, &metric, &no_cones).unwrap();
            let matching = HalfedgeData::filled(mesh.n_halfedges(), 0);
            let mut needs = GridNeeds { levels, ..GridNeeds::cones(no_cones) };
            let is_point = |v: &Vertex| points.contains(&v.at());
            mesh.vertices().filter(is_point).for_each(|v| needs.is_point[v] = true);
            let space = IntegerSpace::new(&mesh, &cut, &matching, &needs).unwrap();
            Self { mesh, metric, cut, matching, needs, space }
        }

        /// The layout `height` times as high as the surface.
        fn layout(&self, height: f64) -> Vec<Complex64> {
            let mut z = vec![Complex64::ZERO; self.cut.n_wedges];
            for h in self.mesh.halfedges() {
                let [x, y, _] = POSITIONS[self.mesh.origin(h).at()];
                z[self.cut.wedge[h] as usize] = Complex64::new(x, height * y);
            }
            z
        }

        /// The only wall of that layout.
        fn wall(&self, height: f64) -> Wall {
            let Self { mesh, metric, cut, matching, needs, space } = self;
            let z = self.layout(height);
            let scene = Scene { mesh, cut, matching, needs, space, z: &z };
            let mut walls = walls(&scene, &triangles(mesh, metric, cut)).unwrap();
            assert_eq!(walls.len(), 1);
            walls.remove(0)
        }

        /// The forces on the second and on the third vertex against the first.
        fn forces(&self, height: f64) -> [[f64; 2]; 2] {
            let wall = self.wall(height);
            let coordinates = self.space.read(&self.layout(height)).0;
            // Abscissae of 4 and 1; ordinates of 0 and three heights.
            [[4.0, 0.0], [1.0, 3.0 * height]].map(|place| {
                place.map(|x| {
                    let is_there = |row: &Row| (apply(row, &coordinates) - x).abs() < 1e-9;
                    let found: Vec<usize> =
                        (0..wall.ways.len()).filter(|&k| is_there(&wall.ways[k])).collect();
                    assert_eq!(found.len(), 1, "{x}");
                    wall.forces[found[0]]
                })
            })
        }
    }

    #[test]
    fn a_flat_triangle_of_grid_points_pushes_its_tip_away() {
        // Twice the area is 4 y_tip - 1 y_second for these abscissae: multipliers 4 and -1.
        let [second, tip] = Case::new().forces(0.01);
        let off = |force: [f64; 2], y: f64| force[0].hypot(force[1] - y);
        assert!(off(tip, 1.0) < 0.01 && off(second, -0.25) < 0.01, "{second:?} {tip:?}");
    }

    #[test]
    fn a_stretched_triangle_pulls() {
        let [_, tip] = Case::new().forces(100.0);
        assert!(tip[1] < -0.9, "{tip:?}");
    }

    #[test]
    fn an_isoline_is_pushed_away_too() {
        // The tip is the only grid point; the side from the first vertex to the second is on an isoline.
        let case = Case::with(&[2], vec![(Halfedge(0), 1)]);
        let Wall { ways, forces } = case.wall(0.01);
        let coordinates = case.space.read(&case.layout(0.01)).0;
        let height = apply(&ways[0], &coordinates);
        assert!(ways.len() == 1 && (height * forces[0] - 0.03).abs() < 1e-9, "{ways:?} {forces:?}");
    }

    #[test]
    fn the_rounding_has_to_end_beyond() {
        let case = Case::new();
        let integers = |height: f64| -> Vec<i64> {
            let coordinates = case.space.read(&case.layout(height)).0;
            coordinates.iter().map(|x| x.round() as i64).collect()
        };
        let here = case.space.read(&case.layout(0.01)).0;
        let (ways, room) = case.wall(0.01).beyond(&integers(0.0), &here, 1.0);
        let span = Span { ways: 0..ways.len(), room };
        let has_room = |x: &[i64]| span.has_room(|k| ways[k].at(x));
        assert!(!has_room(&integers(0.0)) && !has_room(&integers(-1.0)));
        // the tip a cell higher, then three
        assert!(has_room(&integers(1.0 / 3.0)) && has_room(&integers(1.0)));
    }
}
