//! The distortion metrics of reports (Levi 2021, suppl. sec. 3).

use super::measure::Measure;
use super::singular::SingularValues;
use super::summary::{Percentiles, summarize};
use seamstress_mesh::{Metric, TriMesh};

/// Distortion of a whole map.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Distortion {
    /// `sqrt(sigma_1 max / sigma_2 min)`, eq. (3); infinite when a triangle is flipped or collapsed,
    /// not a number when the source has no triangle with area.
    pub tau: f64,
    /// Percentiles of `max(s sigma_1, 1 / (s sigma_2))` at the scale `s` of eq. (3).
    pub tau_t: Percentiles,
    /// The largest singular value, UV units per mesh unit.
    pub sigma_1_max: f64,
    /// The smallest signed singular value, UV units per mesh unit.
    pub sigma_2_min: f64,
    /// Area-weighted mean of the symmetric Dirichlet energy at its best global scale; 4 at an isometry.
    pub symmetric_dirichlet: f64,
    /// Area-weighted mean of `(sigma_1 - 1)^2 + (sigma_2 - 1)^2` at its best global scale.
    pub arap: f64,
    /// Triangles of positive orientation that were measured.
    pub measured: usize,
    /// Triangles flipped or collapsed by the map.
    pub flipped: usize,
    /// Source triangles without area, left out.
    pub degenerate: usize,
}

/// Measures a map given by one UV per corner (three per face).
///
/// The means are taken over the unflipped triangles; `tau` is infinite when there are others.
pub fn distortion(mesh: &TriMesh, metric: &Metric, corner_uvs: &[[f64; 2]]) -> Distortion {
    Distortion::new(&SingularValues::new(mesh, metric, corner_uvs))
}

impl Distortion {
    /// From the singular values of the triangles.
    pub fn new(singular: &SingularValues) -> Self {
        let unflipped = SingularValues {
            values: singular.values.iter().map(|v| v.filter(|[_, s2]| *s2 > 0.0)).collect(),
            area: singular.area.clone(),
        };
        let (largest, smallest) = unflipped.extremes();
        let measured = unflipped.positive().count();
        let flipped = singular.flipped();
        Self {
            tau: match (flipped, measured) {
                (0, 0) => f64::NAN,
                (0, _) => (largest / smallest).sqrt(),
                _ => f64::INFINITY,
            },
            tau_t: summarize(Measure::Tau, &unflipped).percentiles,
            sigma_1_max: largest,
            sigma_2_min: smallest,
            symmetric_dirichlet: summarize(Measure::SymmetricDirichlet, &unflipped).mean,
            arap: summarize(Measure::Arap, &unflipped).mean,
            measured,
            flipped,
            degenerate: singular.degenerate(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(map: impl Fn([f64; 2]) -> [f64; 2]) -> Distortion {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let faces = [[0, 1, 2], [0, 2, 3]];
        let mesh = TriMesh::from_faces(4, &faces).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        let corner = |v: u32| map([positions[v as usize][0], positions[v as usize][1]]);
        let uvs: Vec<[f64; 2]> = faces.iter().flatten().map(|&v| corner(v)).collect();
        distortion(&mesh, &metric, &uvs)
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn similarities_have_no_distortion() {
        let d = measure(|[x, y]| [3.0 * x - 4.0 * y + 7.0, 4.0 * x + 3.0 * y - 1.0]);
        assert!(close(d.tau, 1.0) && close(d.symmetric_dirichlet, 4.0) && close(d.arap, 0.0));
        assert!(close(d.sigma_1_max, 5.0) && close(d.tau_t.p50, 1.0));
    }

    #[test]
    fn anisotropic_scaling_by_hand() {
        let d = measure(|[x, y]| [2.0 * x, 0.5 * y]);
        assert!(close(d.tau, 2.0) && close(d.symmetric_dirichlet, 8.5));
        // best scale s = (s1 + s2) / (s1^2 + s2^2); energy 2 - 2.5^2 / 4.25
        assert!(close(d.arap, 2.0 - 6.25 / 4.25));
    }

    #[test]
    fn reflection_is_infinite_and_counted() {
        let d = measure(|[x, y]| [x, -y]);
        assert!(d.tau.is_infinite() && d.flipped == 2 && d.measured == 0);
    }
}
