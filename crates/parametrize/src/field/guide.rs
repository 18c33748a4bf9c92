//! Directions that a map is to follow.

use super::convert::{axes, dot};
use super::cross_field::rotations;
use super::curvature::Bending;
use super::face_laplacian::FaceMatrix;
use crate::cut::isometric::turning;
use crate::features::Sectors;
use crate::quarter::{direction, rotation};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{Face, FaceData, Geometry, Metric, TriMesh};

/// Difference of the principal curvatures, times the length of a cell, at which directions count half.
const HALF_ANISOTROPY: f64 = 0.15;
/// Cells are this part of the side of a surface at least where directions are weighed: some thousand. Finer ones need them no
/// less.
pub(crate) const LEAST_CELL: f64 = 0.02;
/// Curvature is averaged over this part of a cell.
const RADIUS: f64 = 0.5;
/// The guide is smoothed over this part of a cell where directions count fully.
const SMOOTHING: f64 = 0.5;
/// What given directions count, against at most 1 for those of curvature.
const GIVEN_WEIGHT: f64 = 5.0;
/// What the directions of aligned edges count, against at most 1 for those of curvature.
const ALIGNED_WEIGHT: f64 = 10.0;

/// Directions that a map is to follow, up to quarter turns, and how much they count.
#[derive(Debug, Clone)]
pub struct Guide {
    /// Per face a rotation that lays its directions along the axes: one of four.
    pub rotation: FaceData<Complex64>,
    /// Per face how much its directions count, from 0 to 1.
    pub weight: FaceData<f64>,
    /// The length of a cell, in the unit of the metric.
    pub cell: f64,
}

impl Guide {
    /// The principal directions of a surface at the size of a cell, as far as they are certain: with `a` the difference of
    /// the principal curvatures times the cell, they count `strength a^2 / (a^2 + 0.15^2)`; there cells are a fiftieth of the
    /// side of the surface at least.
    ///
    /// Curvature is that of the slit surface: creases that are aligned bend nothing.
    /// Fourth powers of the directions are smoothed by one linear solve (after Knöppel et al. 2013); beside aligned
    /// edges they are those of the edges. Directions that are given count fully, whatever the strength.
    ///
    /// # Errors
    /// When a system cannot be solved.
    pub fn along_curvature<'a>(
        sectors: &Sectors<'_>,
        geometry: impl Into<Geometry<'a>>,
        metric: &Metric,
        cell: f64,
        strength: f64,
    ) -> Result<Self, NotPositiveDefinite> {
        let slit = sectors.slit();
        let geometry = geometry.into();
        let positions: Vec<[f64; 3]> =
            slit.vertices().map(|s| geometry.positions[sectors.vertex(s).at()]).collect();
        let order = sectors.order();
        let mut bending = Bending::ordered(slit, &positions, metric, &order)?;
        let bent = bending.averaged(RADIUS * cell)?;
        let bent: FaceData<Complex64> = bent.iter().map(|bent| bent.anisotropy).collect();
        let reach = cell.max(LEAST_CELL * metric.total_area().sqrt());
        let certainty = |(f, half): (Face, &Complex64)| {
            // Lengths of edges are those of the surface, areas count cells.
            let size = geometry.size(slit.face_vertices(f).map(|s| sectors.vertex(s)));
            let a = 2.0 * half.norm() * reach / size;
            a * a / (a * a + HALF_ANISOTROPY * HALF_ANISOTROPY)
        };
        let mut weight: FaceData<f64> = match strength > 0.0 {
            true => bent.enumerate().map(certainty).collect(),
            false => FaceData::filled(slit.n_faces(), 0.0),
        };
        // What lays a direction along an axis is the rotation back.
        let back = |(half, weight): (&Complex64, &f64)| direction(*half).powi(2).conj() * *weight;
        let mut stiffness = weight.clone();
        let mut pull: FaceData<Complex64> = bent.iter().zip(weight.iter()).map(back).collect();
        weight.iter_mut().for_each(|weight| *weight *= strength);
        for (f, along) in given(slit, &positions, geometry.directions) {
            pull[f] = GIVEN_WEIGHT * along.powi(4).conj();
            stiffness[f] = GIVEN_WEIGHT;
            weight[f] = 1.0;
        }
        for h in sectors.aligned() {
            let along = Complex64::from_polar(1.0, -4.0 * turning(&metric.angle, h));
            pull[h.face()] += ALIGNED_WEIGHT * along;
            stiffness[h.face()] += ALIGNED_WEIGHT;
        }
        let rotation = smoothed(sectors, metric, &pull, &stiffness, SMOOTHING * cell)?;
        Ok(Self { rotation, weight, cell })
    }
}

/// The faces that a direction is given for, with it, seen from their first side.
fn given<'a>(
    slit: &'a TriMesh,
    positions: &'a [[f64; 3]],
    directions: Option<&'a [[f64; 3]]>,
) -> impl Iterator<Item = (Face, Complex64)> + 'a {
    let directions = directions.unwrap_or_default();
    slit.faces().zip(directions).filter_map(|(f, &d)| {
        let [x, y] = axes(slit, positions, f);
        let flat = Complex64::new(dot(d, x), dot(d, y));
        (flat != Complex64::ZERO).then(|| (f, direction(flat)))
    })
}

/// Rotations, up to quarter turns, whose fourth powers `g` minimise `sum |g_right - c g_left|^2 + sum stiffness area / length^2
/// |g - pull / stiffness|^2`, where `c` carries them across edges.
fn smoothed(
    sectors: &Sectors<'_>,
    metric: &Metric,
    pull: &FaceData<Complex64>,
    stiffness: &FaceData<f64>,
    length: f64,
) -> Result<FaceData<Complex64>, NotPositiveDefinite> {
    let slit = sectors.slit();
    let bare = rotations(slit, metric, &FaceData::filled(slit.n_faces(), Complex64::ONE));
    let across: Vec<Complex64> = slit.interior_edges().map(|h| rotation(-4.0 * bare[h])).collect();
    let share = |f: usize| metric.area[Face(f as u32)] / (length * length);
    let mut matrix =
        FaceMatrix::<Complex64>::ordered(slit, &sectors.order_of_faces(slit.n_faces()))?;
    matrix.factorize_near(
        |e| (1.0, -across[e]),
        |f| share(f) * stiffness[Face(f as u32)],
        |x| x.conj(),
    )?;
    let mut fourth: Vec<Complex64> =
        pull.iter().enumerate().map(|(f, pull)| share(f) * pull).collect();
    matrix.solve(&mut fourth);
    Ok(fourth.iter().map(|z| Complex64::from_polar(1.0, z.arg() / 4.0)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::features::EdgeSet;
    use seamstress_testkit as testkit;

    #[test]
    fn follows_the_circles_of_a_torus() {
        let soup = testkit::torus(48, 24, 3.0, 1.0);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let sectors = Sectors::unaligned(&mesh);
        let guide = Guide::along_curvature(&sectors, &soup.positions, &metric, 1.0, 1.0).unwrap();
        for f in mesh.faces() {
            let [a, b, c] = mesh.face_vertices(f).map(|v| soup.positions[v.at()]);
            let middle = [0, 1, 2].map(|k| (a[k] + b[k] + c[k]) / 3.0);
            let around = [-middle[1], middle[0], 0.0];
            let [x, y] = axes(&mesh, &soup.positions, f);
            let direction = direction(Complex64::new(dot(around, x), dot(around, y)));
            let off = ((guide.rotation[f] * direction).powi(4).arg() / 4.0).to_degrees();
            assert!(off.abs() < 3.0, "face {f:?} is off by {off} degrees");
            assert!(guide.weight[f] > 0.5);
        }
    }

    #[test]
    fn given_directions_are_followed_and_continued() {
        let grid = testkit::disk_grid(16, 16);
        let mesh = TriMesh::from_faces(grid.positions.len(), &grid.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &grid.positions);
        let sectors = Sectors::unaligned(&mesh);
        let (sin, cos) = 0.3f64.sin_cos();
        let is_given = |f: Face| f.0.is_multiple_of(37);
        let give = |f| if is_given(f) { [cos, sin, 0.0] } else { [0.0; 3] };
        let directions: Vec<[f64; 3]> = mesh.faces().map(give).collect();
        let geometry =
            Geometry { directions: Some(&directions), ..Geometry::from(&grid.positions) };
        let guide = Guide::along_curvature(&sectors, geometry, &metric, 1.0, 0.0).unwrap();
        for f in mesh.faces() {
            let [x, y] = axes(&mesh, &grid.positions, f);
            let along = Complex64::new(dot([cos, sin, 0.0], x), dot([cos, sin, 0.0], y));
            let off = ((guide.rotation[f] * along).powi(4).arg() / 4.0).abs();
            assert!(off < 1e-6, "{off}");
            assert_eq!(guide.weight[f], if is_given(f) { 1.0 } else { 0.0 });
        }
    }

    #[test]
    fn aligned_creases_are_followed_and_bend_nothing() {
        let soup = testkit::subdivide(&testkit::cube());
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let guide = |features: &EdgeSet| {
            let sectors = Sectors::new(&mesh, &metric, features);
            Guide::along_curvature(&sectors, &soup.positions, &metric, 1.0, 1.0).unwrap()
        };
        let creases = seamstress_mesh::features::creases(&mesh, &soup.positions, &metric, 1.0);
        assert_eq!(creases.edges().len(), 24);
        let aligned = guide(&creases);
        assert!(aligned.weight.iter().all(|&weight| weight < 1e-12));
        for f in mesh.faces() {
            let off = f.halfedges().map(|h| {
                let along = Complex64::from_polar(1.0, turning(&metric.angle, h));
                ((aligned.rotation[f] * along).powi(4).arg() / 4.0).abs()
            });
            // Two of its sides are parallel to edges of the cube.
            assert_eq!(off.iter().filter(|&&off| off < 1e-6).count(), 2);
        }
        let free = guide(&EdgeSet::new(&mesh, []));
        assert!(free.weight.iter().any(|&weight| weight > 0.5));
    }
}
