//! A measure over a whole map.

use super::measure::{Aggregate, Measure};
use super::singular::SingularValues;
use seamstress_mesh::{Face, FaceData};

/// Median, 95th and 99th percentile over triangles.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Percentiles {
    /// Half of the triangles are below.
    pub p50: f64,
    /// 95 of 100 are below.
    pub p95: f64,
    /// 99 of 100 are below.
    pub p99: f64,
}

impl Percentiles {
    /// Of values in any order; not a number if there is none.
    pub(super) fn new(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| {
            let last = values.len().saturating_sub(1) as f64;
            values.get((share * last) as usize).copied().unwrap_or(f64::NAN)
        };
        Self { p50: at(0.5), p95: at(0.95), p99: at(0.99) }
    }
}

/// A measure over the measured triangles of a map (those whose source has area).
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// The measure.
    pub measure: Measure,
    /// The global scale at which all of this was taken, a factor on the UVs in mesh units.
    pub scale: f64,
    /// Mean over the source's area; not a number if no triangle was measured.
    pub mean: f64,
    /// The largest value; not a number if no triangle was measured.
    pub max: f64,
    /// The triangle that has it, if any.
    #[serde(serialize_with = "as_id")]
    pub worst: Option<Face>,
    /// Percentiles by number of triangles.
    pub percentiles: Percentiles,
    /// Triangles whose value is infinite, because they are flipped or collapsed.
    pub infinite: usize,
    /// The value of every triangle; not a number where the source has no area.
    #[serde(skip)]
    pub values: FaceData<f64>,
}

fn as_id<S: serde::Serializer>(face: &Option<Face>, serializer: S) -> Result<S::Ok, S::Error> {
    match face {
        Some(face) => serializer.serialize_some(&face.0),
        None => serializer.serialize_none(),
    }
}

impl Summary {
    /// The figure by which maps are compared: the mean or the maximum.
    pub fn figure(&self) -> f64 {
        match self.measure.aggregate() {
            Aggregate::Mean => self.mean,
            Aggregate::Max => self.max,
        }
    }
}

/// A measure at its own global scale.
pub fn summarize(measure: Measure, singular: &SingularValues) -> Summary {
    let scale = measure.scale(singular);
    let value = |[s1, s2]: [f64; 2]| measure.value(scale * s1, scale * s2);
    let values: FaceData<f64> =
        singular.values.iter().map(|pair| pair.map_or(f64::NAN, value)).collect();
    let worst = singular.measured().map(|(f, ..)| f).max_by(|&f, &g| {
        // Of equal ones the first.
        values[f].total_cmp(&values[g]).then(g.cmp(&f))
    });
    let finite: Vec<f64> = singular.measured().map(|(f, ..)| values[f]).collect();
    Summary {
        measure,
        scale,
        mean: SingularValues::mean(singular.measured(), value),
        max: worst.map_or(f64::NAN, |f| values[f]),
        worst,
        infinite: finite.iter().filter(|x| x.is_infinite()).count(),
        percentiles: Percentiles::new(finite),
        values,
    }
}

/// All measures, each at its own global scale, in the order of [`Measure::ALL`].
pub fn measure_all(singular: &SingularValues) -> Vec<Summary> {
    Measure::ALL.into_iter().map(|measure| summarize(measure, singular)).collect()
}
