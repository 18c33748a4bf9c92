//! Infeasibility cuts: what the integers have to satisfy for a layout to reach them.

use crate::gauss::{Gauss, Overflow, add_scaled};
use crate::isolines::{part, tied};
use crate::linear::{Row, apply, apply_exactly};
use crate::rounding::Rule;
use crate::scene::{Carry, Scene};
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, Halfedge, VertexData};
use seamstress_parametrize::energy::{ProjectedHessian, SymmetricDirichlet, Triangle, at_corner};
use seamstress_parametrize::quarter::turn;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Triangles with less than this share of the strongest force are not what blocks the path.
const WEAK: f64 = 0.02;
/// Clusters of more faces give no cut: there the whole layout is in tension.
const MOST_FACES: usize = 5000;
/// How much further along the forces of a cut other integers have to be, grid units where the strongest is one.
const MINIMUM_GAIN: f64 = 0.25;
/// The share of the distance from the integers that failed back to where the path ended.
const WAY_BACK: f64 = 0.5;

/// A cluster of collapsing triangles as the grid points and isolines around it feel it.
///
/// Between them ordinary vertices are in balance, so that near the collapse the areas of the triangles, with
/// the forces as multipliers, add up to a linear form in the coordinates of the grid points and in the levels of the
/// isolines alone: these must move along the forces. It is a cut by Farkas' lemma, its multipliers found by a barrier.
#[derive(Debug, Clone)]
pub struct FarkasCut {
    /// What the coordinates of grid points and the levels of isolines are more than the first one, as exact forms in
    /// the coordinates of the space.
    pub differences: Vec<Row>,
    /// The force on each of these, the strongest one.
    pub forces: Arc<[f64]>,
    /// A face of the cluster.
    pub face: Face,
}

impl FarkasCut {
    /// What keeps a rounding away from integers `x` that led to the cut, with the coordinates `here` of the layout
    /// where the path ended and cells of size `h`, both in the layout's units.
    pub fn beyond(&self, x: &[i64], here: &[f64], h: f64) -> Rule {
        let along = |value: &dyn Fn(&Row) -> f64| -> f64 {
            self.differences.iter().zip(self.forces.iter()).map(|(row, f)| f * value(row)).sum()
        };
        let at_x = along(&|row| apply_exactly(row, x) as f64);
        let at_here = along(&|row| apply(row, here) / h);
        let bound = at_x + (WAY_BACK * (at_here - at_x)).max(MINIMUM_GAIN);
        Rule::Beyond { forces: self.forces.clone(), bound }
    }
}

/// A face of a cluster and how it is reached from the first one.
type Reached = (Face, Carry);

/// The cuts of all clusters of collapsing triangles.
///
/// # Errors
/// [`Overflow`].
pub fn farkas_cuts(scene: &Scene<'_>, triangles: &[Triangle]) -> Result<Vec<FarkasCut>, Overflow> {
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
                found.extend(cut(scene, &cluster, &forces)?);
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
fn cut(
    scene: &Scene<'_>,
    cluster: &[Reached],
    forces: &[[Complex64; 3]],
) -> Result<Option<FarkasCut>, Overflow> {
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
    // The forces add up to zero: only differences from the first one count. Several corners may share one.
    let mut sums: BTreeMap<Row, f64> = BTreeMap::new();
    for felt in felt {
        for (level, force) in &felt {
            let mut difference = level.clone();
            add_scaled(&mut difference, &felt[0].0, Gauss::ONE.negated())?;
            *sums.entry(scene.space.row(&difference)?).or_default() += force;
        }
    }
    sums.retain(|row, _| !row.is_empty());
    let strongest = sums.values().fold(0.0, |most: f64, force| most.max(force.abs()));
    let (differences, forces): (_, Vec<f64>) =
        sums.into_iter().map(|(row, force)| (row, force / strongest)).unzip();
    let face = cluster[0].0;
    Ok((strongest > 0.0).then_some(FarkasCut { differences, forces: forces.into(), face }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::Constraint;
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

        /// The only cut of that layout.
        fn cut_of(&self, height: f64) -> FarkasCut {
            let Self { mesh, metric, cut, matching, needs, space } = self;
            let z = self.layout(height);
            let scene = Scene { mesh, cut, matching, needs, space, z: &z };
            let mut cuts = farkas_cuts(&scene, &triangles(mesh, metric, cut)).unwrap();
            assert_eq!(cuts.len(), 1);
            cuts.remove(0)
        }

        /// The forces on the second and on the third vertex against the first.
        fn forces(&self, height: f64) -> [[f64; 2]; 2] {
            let cut = self.cut_of(height);
            let coordinates = self.space.read(&self.layout(height)).0;
            // Abscissae of 4 and 1; ordinates of 0 and three heights.
            [[4.0, 0.0], [1.0, 3.0 * height]].map(|place| {
                place.map(|x| {
                    let is_there = |row: &Row| (apply(row, &coordinates) - x).abs() < 1e-9;
                    let found: Vec<usize> = (0..cut.differences.len())
                        .filter(|&k| is_there(&cut.differences[k]))
                        .collect();
                    assert_eq!(found.len(), 1, "{x}");
                    cut.forces[found[0]]
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
        let FarkasCut { differences, forces, .. } = case.cut_of(0.01);
        let coordinates = case.space.read(&case.layout(0.01)).0;
        let height = apply(&differences[0], &coordinates);
        assert!(
            differences.len() == 1 && (height * forces[0] - 0.03).abs() < 1e-9,
            "{differences:?} {forces:?}"
        );
    }

    #[test]
    fn the_rounding_has_to_end_beyond() {
        let case = Case::new();
        let integers = |height: f64| -> Vec<i64> {
            let coordinates = case.space.read(&case.layout(height)).0;
            coordinates.iter().map(|x| x.round() as i64).collect()
        };
        let here = case.space.read(&case.layout(0.01)).0;
        let cut = case.cut_of(0.01);
        let rule = cut.beyond(&integers(0.0), &here, 1.0);
        let members: Vec<Constraint> = cut.differences.into_iter().map(Constraint::free).collect();
        let has_room = |x: &[i64]| {
            rule.allows(members.iter().map(|member| Some(member.at(x).map(|d| d as f64))))
        };
        assert!(!has_room(&integers(0.0)) && !has_room(&integers(-1.0)));
        // the tip a cell higher, then three
        assert!(has_room(&integers(1.0 / 3.0)) && has_room(&integers(1.0)));
    }
}
