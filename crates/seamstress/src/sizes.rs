//! Sizes of cells on a surface.

use crate::error::{Error, ErrorKind};
use crate::features::FeatureCurves;
use crate::options::MapOptions;
use crate::report::Distortion;
use crate::size_sources::SizeSource;
use crate::surface::{Sizes, Surface, Wishes};
use crate::words::rounded;
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::symmetry::{Mirror, Segments, images_of};
use seamstress_mesh::{Geometry, Metric};
use seamstress_parametrize::{SizeError, Sizing, quality, sizes};
use seamstress_quads::extract::SurfacePoint;
use seamstress_quads::quality::edge_lengths;
use seamstress_quads::{Extraction, locate};
use serde::Serialize;
use std::sync::Arc;

/// Cells have at least and at most so many times the mean size, unless it is said.
const BOUNDS: [f64; 2] = [0.01, 100.0];
/// A map has sizes as for so many cells along the side of a square with the area of the surface.
const TEXTURE_CELLS: f64 = 50.0;
/// How near to an edge vertices are on it, in cells: far more than rounding, and far less than a cell.
const ON_EDGE: f64 = 1e-4;

/// Sizes of cells asked for, and made.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SizeReport {
    /// The least edge length asked for, mesh units.
    pub least: f64,
    /// The largest.
    pub largest: f64,
    /// Distortion, if lengths on the surface are counted in those asked for there.
    pub distortion: Distortion,
    /// The median, over the quads, of the edge length made (the root of the area) by that asked for there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub median_ratio: Option<f64>,
    /// 95 of 100 quads are off by no more than this share of the edge length asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off_95: Option<f64>,
}

impl std::fmt::Display for SizeReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [least, largest] = [self.least, self.largest].map(rounded);
        write!(f, "edge lengths of {least} to {largest} asked for")?;
        if let (Some(ratio), Some(off)) = (self.median_ratio, self.off_95) {
            let off = 100.0 * off;
            write!(
                f,
                "; made {} times as long in the median, 95% within {off:.0} %",
                rounded(ratio)
            )?;
        }
        Ok(())
    }
}

impl Surface {
    /// Positions, and the sizes of cells and the directions if it has some.
    pub(crate) fn geometry(&self) -> Geometry<'_> {
        Geometry {
            positions: self.positions(),
            sizes: self.sizes.as_deref().map(|sizes| &sizes.factors[..]),
            directions: self.directions.as_deref().map(Vec::as_slice),
        }
    }

    /// The same surface with cells that are all alike and lie anyhow.
    pub(crate) fn without_wishes(&self) -> Self {
        let mut surface = self.clone();
        (surface.sizes, surface.directions) = (None, None);
        surface
    }

    /// The metric in which all cells are alike.
    pub(crate) fn cell_metric(&self) -> &Metric {
        self.sizes.as_deref().map_or(self.metric(), |sizes| &sizes.metric)
    }

    /// The same surface with the sizes of cells that options ask for, if they do; `cell` is the length of one where all are
    /// alike, mesh units.
    ///
    /// # Errors
    /// [`ErrorKind::Options`](crate::ErrorKind::Options) and [`ErrorKind::Unreadable`](crate::ErrorKind::Unreadable).
    pub(crate) fn sized(
        &self,
        curves: &FeatureCurves,
        options: &MapOptions,
        cell: f64,
    ) -> Result<Self, Error> {
        if !options.has_sizes() {
            return Ok(self.clone());
        }
        let wishes = Wishes {
            painted: self.painted(&options.sizes)?,
            near: Arc::new(self.near_edges(&options.sizes, curves)),
        };
        let side = self.metric().side();
        self.clone().with_wishes(wishes, side, curves, options, cell)
    }

    /// The same for a map, which has no cells of its own, with directions too.
    ///
    /// # Errors
    /// Those of [`Surface::sized`].
    pub(crate) fn prepared_for_textures(
        &self,
        curves: &FeatureCurves,
        options: &MapOptions,
    ) -> Result<Self, Error> {
        self.sized(curves, options, self.texture_cell())?
            .directed(&options.directions, self.texture_cell())
    }

    /// The length of a cell for maps without cells.
    pub(crate) fn texture_cell(&self) -> f64 {
        self.metric().side() / TEXTURE_CELLS
    }

    /// A finer mesh of this surface with the sizes that options ask for there.
    ///
    /// # Errors
    /// Those of [`Surface::sized`].
    pub(crate) fn sized_finer(
        &self,
        finer: Self,
        curves: &FeatureCurves,
        options: &MapOptions,
        cell: f64,
    ) -> Result<Self, Error> {
        let Some(sizes) = &self.sizes else { return Ok(finer) };
        let wishes = Wishes {
            painted: self.painted_at(sizes, finer.positions().iter().copied())?,
            near: Arc::clone(&sizes.wishes.near),
        };
        finer.with_wishes(wishes, sizes.metric.side(), curves, options, cell)
    }

    /// A side of planes of symmetry of this surface with the sizes that options ask for there: the smaller ones of those
    /// of each vertex and of its images.
    ///
    /// # Errors
    /// Those of [`Surface::sized`].
    pub(crate) fn sized_side(
        &self,
        side: Self,
        mirrors: &[Mirror],
        curves: &FeatureCurves,
        options: &MapOptions,
        cell: f64,
    ) -> Result<Self, Error> {
        let Some(sizes) = &self.sizes else { return Ok(side) };
        let points = side.positions().iter().flat_map(|&p| images_of(p, mirrors));
        let of_images = self.painted_at(sizes, points)?;
        let smallest = |images: &[f64]| images.iter().copied().fold(f64::INFINITY, f64::min);
        let wishes = Wishes {
            painted: of_images.chunks(1 << mirrors.len()).map(smallest).collect(),
            near: Arc::clone(&sizes.wishes.near),
        };
        let goal = side.metric().side();
        side.with_wishes(wishes, goal, curves, options, cell)
    }

    /// What is painted at points of the surface.
    fn painted_at(
        &self,
        sizes: &Sizes,
        points: impl IntoIterator<Item = [f64; 3]>,
    ) -> Result<Vec<f64>, Error> {
        let places = locate(self.positions(), self.faces(), points.into_iter())
            .map_err(|cause| Error::new(ErrorKind::Internal, cause))?;
        let painted = &sizes.wishes.painted;
        Ok(places.iter().map(|at| at.interpolate(painted, self.faces())).collect())
    }

    /// The edges that make cells smaller, each with how much so.
    fn near_edges(&self, sources: &[SizeSource], curves: &FeatureCurves) -> Vec<(Segments, f64)> {
        let ends = |pair: [u32; 2]| pair.map(|v| self.positions()[v as usize]);
        let segments =
            |edges: &EdgeSet| Segments::new(edges.vertex_pairs(self.mesh()).into_iter().map(ends));
        let near = |source: &SizeSource| match source {
            SizeSource::Features(part) => Some((segments(&curves.edges), *part)),
            SizeSource::Boundary(part) => Some((segments(&EdgeSet::boundary(self.mesh())), *part)),
            _ => None,
        };
        sources.iter().filter_map(near).collect()
    }

    /// Some vertices of a surface, with their sizes.
    pub(crate) fn sized_part(&self, mut part: Self, vertices: &[u32]) -> Self {
        part.sizes = self.sizes.as_ref().map(|sizes| {
            let of = |values: &[f64]| vertices.iter().map(|&v| values[v as usize]).collect();
            let factors: Vec<f64> = of(&sizes.factors);
            let Wishes { painted, near } = &sizes.wishes;
            let wishes = Wishes { painted: of(painted), near: Arc::clone(near) };
            let metric = part.metric().scaled(part.mesh(), &factors);
            Arc::new(Sizes { wishes, factors, metric })
        });
        part
    }

    fn with_wishes(
        mut self,
        wishes: Wishes,
        side: f64,
        curves: &FeatureCurves,
        options: &MapOptions,
        cell: f64,
    ) -> Result<Self, Error> {
        let mut wanted = wishes.painted.clone();
        for (segments, part) in wishes.near.iter() {
            let is_on = |p| segments.nearest(p).is_some_and(|(_, away)| away <= ON_EDGE * cell);
            let those = wanted.iter_mut().zip(self.positions()).filter(|(_, p)| is_on(**p));
            those.for_each(|(wanted, _)| *wanted *= part);
        }
        let bound = |edge: Option<f64>, default| edge.map_or(default, |edge| edge / cell);
        let sizing = Sizing {
            cell,
            side,
            adaptive: options.adaptive,
            bounds: [bound(options.min_edge, BOUNDS[0]), bound(options.max_edge, BOUNDS[1])],
            growth: options.size_growth,
        };
        let made = sizes(self.mesh(), self.positions(), &curves.edges, &wanted, &sizing);
        let factors = made.map_err(|cause| match cause {
            SizeError::TooMany => Error::options(
                "max_edge: edges that short make more quads than asked for".to_owned(),
            ),
            SizeError::TooFew => Error::options(
                "min_edge: edges that long make fewer quads than asked for".to_owned(),
            ),
            other => Error::options(format!("sizes: {other}")),
        })?;
        let metric = self.metric().scaled(self.mesh(), &factors);
        self.sizes = Some(Arc::new(Sizes { wishes, factors, metric }));
        Ok(self)
    }

    /// The product of the sources that have a number for every vertex.
    fn painted(&self, sources: &[SizeSource]) -> Result<Vec<f64>, Error> {
        let mut painted = vec![1.0; self.positions().len()];
        for source in sources {
            let Some(values) = self.values_of(source)? else { continue };
            for (painted, value) in painted.iter_mut().zip(values) {
                if !(value.is_finite() && value > 0.0) {
                    let text = format!("sizes: {source} has {value}, which is no size above 0");
                    return Err(Error::options(text).of(self.input()));
                }
                *painted *= value;
            }
        }
        Ok(painted)
    }

    /// Relative edge lengths at the vertices of this surface.
    fn values_of(&self, source: &SizeSource) -> Result<Option<Vec<f64>>, Error> {
        let missing = |what: &str| Error::options(format!("sizes: the mesh has no {what}"));
        let attribute = match source {
            SizeSource::Features(_) | SizeSource::Boundary(_) => return Ok(None),
            SizeSource::Color(channel) => {
                let mut colors = self.attributes.of_kind(AttributeKind::Color);
                let colors = colors.find(|colors| colors.width > *channel);
                colors.ok_or_else(|| missing("such channel of colours"))?.clone()
            }
            SizeSource::Property(name) => {
                let is_it = |a: &&Attribute| {
                    a.name == *name && a.width == 1 && a.domain != AttributeDomain::Face
                };
                let found = self.attributes.all.iter().find(is_it);
                found.ok_or_else(|| missing(&format!("property `{name}` of vertices")))?.clone()
            }
            #[cfg(feature = "io")]
            SizeSource::Csv(file) => {
                let n_vertices = self.parts().n_input_vertices;
                let values = seamstress_io::read_vertex_values(file, n_vertices)?;
                let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Number);
                Attribute::new("size", domain, kind, 1, values)
            }
            #[cfg(not(feature = "io"))]
            SizeSource::Csv(_) => {
                return Err(Error::options("sizes: files are read with the feature `io`"));
            }
        };
        let here = self.on_triangles(&attribute);
        let here = match here.domain {
            AttributeDomain::Vertex => here,
            _ => here.averaged(self.faces().as_flattened(), self.positions().len()),
        };
        let value = |v: usize| match source {
            SizeSource::Color(channel) => (1.0 - 2.0 * here.of(v)[*channel]).exp2(),
            _ => here.of(v)[0],
        };
        Ok(Some((0..self.positions().len()).map(value).collect()))
    }

    /// What became of the sizes in a map; none if there are none.
    pub(crate) fn size_report(&self, corner_uvs: &[[f64; 2]], cell: f64) -> Option<SizeReport> {
        let sizes = self.sizes.as_deref()?;
        let of_all = |pick: fn(f64, f64) -> f64, start: f64| {
            cell * sizes.factors.iter().copied().fold(start, pick)
        };
        let distortion = quality::distortion(self.mesh(), &sizes.metric, corner_uvs);
        Some(SizeReport {
            least: of_all(f64::min, f64::INFINITY),
            largest: of_all(f64::max, 0.0),
            distortion: Distortion::from(&distortion),
            median_ratio: None,
            off_95: None,
        })
    }

    /// The same of quads, in the places of this surface.
    pub(crate) fn quad_size_report(
        &self,
        corner_uvs: &[[f64; 2]],
        extraction: &Extraction,
        cell: f64,
    ) -> Option<SizeReport> {
        let report = self.size_report(corner_uvs, cell)?;
        let sizes = self.sizes.as_deref()?;
        // Between vertices the inverse is linear, as in the lengths of edges.
        let inverse: Vec<f64> = sizes.factors.iter().map(|size| 1.0 / size).collect();
        let asked = |at: &SurfacePoint| cell / at.interpolate(&inverse, self.faces());
        let asked: Vec<f64> = extraction.sources.iter().map(asked).collect();
        let ratio = |(quad, made): (&[u32; 4], f64)| {
            let asked = quad.map(|v| asked[v as usize]).iter().sum::<f64>() / 4.0;
            made / asked
        };
        let quads = extraction.mesh.quads();
        let made = edge_lengths(&extraction.mesh);
        let ratios: Vec<f64> = quads.iter().zip(made).map(ratio).collect();
        let ranked = |mut values: Vec<f64>, share: f64| {
            values.sort_by(f64::total_cmp);
            values.get((share * values.len() as f64) as usize).copied()
        };
        let off = ratios.iter().map(|ratio| (ratio - 1.0).abs()).collect();
        Some(SizeReport { off_95: ranked(off, 0.95), median_ratio: ranked(ratios, 0.5), ..report })
    }
}
