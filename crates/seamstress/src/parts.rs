//! The connected parts of a surface: which are left out, and which fail.

use crate::error::{Error, ErrorKind, FailedPart};
use crate::features::{FeatureCurves, FeatureReport, edges_of};
use crate::finding::Elements;
use crate::grid_size::GridSize;
use crate::surface::Surface;
use crate::words::counted;
use seamstress_mesh::components::{Component, components};
use seamstress_quads::Extraction;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A closed part with the area of fewer cells than a cube of one cell on each side is smaller than a cell.
const FEWEST_CELLS: f64 = 6.0;
/// An open part with less area than a cell.
const FEWEST_OPEN_CELLS: f64 = 1.0;

/// What becomes of parts of a surface: the pieces connected across edges.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[non_exhaustive]
pub struct PartOptions {
    /// Where a connected part fails, make the others all the same, and name it
    #[cfg_attr(feature = "clap", arg(long))]
    pub partial: bool,

    /// What becomes of connected parts that are smaller than a cell
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "WHAT",
        default_value_t = SmallParts::Keep))]
    pub small_parts: SmallParts,
}

/// What becomes of parts that are smaller than a cell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum SmallParts {
    /// They get a few quads of their own size
    #[default]
    Keep,
    /// They are left out
    Drop,
}

/// The parts of a surface that are small, and those that failed.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PartReport {
    /// Parts smaller than a cell.
    pub small: usize,
    /// Their faces in the input.
    pub small_faces: usize,
    /// Whether they were left out.
    pub small_left_out: bool,
    /// Parts that failed, and were left out.
    pub failed: Vec<FailedPart>,
}

impl Surface {
    /// A component that failed with an error, which says why.
    pub(crate) fn failed_part(&self, component: usize, error: &Error) -> FailedPart {
        let pieces = components(self.mesh()).unwrap_or_default();
        let faces = pieces.get(component).map(|piece| self.input_faces(piece));
        let faces = faces.unwrap_or_default();
        let first_face = faces.first().copied().unwrap_or_default();
        let elements = match error.elements() {
            none if none.is_empty() => Elements { faces: vec![first_face], ..Elements::default() },
            elements => elements.clone(),
        };
        FailedPart {
            component: component as u32,
            first_face,
            faces: faces.len(),
            code: error.code(),
            stage: error.stage(),
            message: error.message().to_owned(),
            elements,
            hint: error.hint().map(str::to_owned),
        }
    }

    fn input_faces(&self, piece: &Component) -> BTreeSet<u32> {
        piece.faces.iter().filter_map(|face| self.input_face(face.0)).collect()
    }

    /// The error of components that failed, of all that there are; `what` says what was to be made.
    pub(crate) fn no_parts(&self, kind: ErrorKind, what: &str, failed: Vec<FailedPart>) -> Error {
        let n_components = self.mesh().connected_faces().1;
        let text = match (&failed[..], n_components) {
            ([only], 1) => format!("{what} could be made: {}", only.message),
            _ => {
                let lines = failed.iter().map(|part| format!("{part}: {}", part.message));
                let lines = lines.collect::<Vec<_>>().join("\n  ");
                let all = counted(n_components, "component");
                format!("{what} could be made of {} of {all}:\n  {lines}", failed.len())
            }
        };
        Error::new(kind, text).with_failed_parts(failed)
    }

    /// Makes something of the parts of a surface that are not too small for cells of a size; if one fails and that is
    /// allowed, of the others with cells as large.
    ///
    /// # Errors
    /// That of the making, which is called with a selection of parts and the size for it, and
    /// [`ErrorKind::Options`] if all are too small.
    pub(crate) fn make_parts<T>(
        &self,
        curves: &FeatureCurves,
        size: GridSize,
        options: PartOptions,
        mut make: impl FnMut(&Selection, GridSize) -> Result<T, Error>,
    ) -> Result<(T, PartReport), Error> {
        // Each of them has been a mesh as part of the whole.
        let pieces = components(self.mesh()).unwrap_or_default();
        let small = self.small_parts(&pieces, size);
        let mut report = PartReport {
            small: small.len(),
            small_faces: small.iter().map(|&k| self.input_faces(&pieces[k]).len()).sum(),
            small_left_out: options.small_parts == SmallParts::Drop,
            failed: Vec::new(),
        };
        let is_kept = |k: &usize| !(report.small_left_out && small.contains(k));
        let mut kept: Vec<usize> = (0..pieces.len()).filter(is_kept).collect();
        if kept.is_empty() {
            let text = "every part of the surface is smaller than a cell, and these are left out";
            return Err(Error::options(text).with_hint("ask for more quads"));
        }
        let component_of = self.component_of_input_faces();
        let area = |kept: &[usize]| kept.iter().map(|&k| self.area(&pieces[k])).sum::<f64>();
        let whole = area(&kept);
        loop {
            let selection = Selection::new(self, curves, &pieces, &kept)?;
            let error = match make(&selection, size.of_share(area(&kept) / whole)) {
                Ok(made) => return Ok((made, report)),
                Err(error) => error.with_parts_numbered(&component_of),
            };
            let failed = error.failed_parts();
            let is_left = |k: &usize| failed.iter().all(|part| part.component as usize != *k);
            let left: Vec<usize> = kept.iter().copied().filter(is_left).collect();
            if left.len() == kept.len() || left.is_empty() {
                return Err(error);
            }
            if !options.partial {
                return Err(error.with_further_hint("`partial` makes the other components"));
            }
            report.failed.extend_from_slice(failed);
            kept = left;
        }
    }

    /// The component of each face of the input: other meshes of the surface have components of other numbers, but the same
    /// faces of the input.
    pub(crate) fn component_of_input_faces(&self) -> BTreeMap<u32, u32> {
        let mut component_of = BTreeMap::new();
        for (k, piece) in components(self.mesh()).unwrap_or_default().iter().enumerate() {
            for face in self.input_faces(piece) {
                component_of.entry(face).or_insert(k as u32);
            }
        }
        component_of
    }

    /// The components that are smaller than a cell.
    fn small_parts(&self, pieces: &[Component], size: GridSize) -> Vec<usize> {
        let cell = size.to_quantize().cell(self.cell_metric().side()) / self.cell_metric().unit;
        let is_small = |&k: &usize| {
            let fewest = match pieces[k].mesh.has_boundary() {
                true => FEWEST_OPEN_CELLS,
                false => FEWEST_CELLS,
            };
            self.area(&pieces[k]) < fewest * cell * cell
        };
        (0..pieces.len()).filter(is_small).collect()
    }

    fn area(&self, piece: &Component) -> f64 {
        piece.faces.iter().map(|&face| self.cell_metric().area[face]).sum()
    }
}

/// Some components of a surface, and its features there.
pub(crate) struct Selection {
    pub(crate) surface: Surface,
    pub(crate) curves: FeatureCurves,
    /// Their numbers in the whole surface.
    components: Vec<u32>,
    /// Where vertices and faces come from; none if all components are selected.
    origin: Option<Origin>,
}

/// The vertex of the whole surface of each vertex, and the face of each face.
struct Origin {
    vertices: Vec<u32>,
    faces: Vec<u32>,
}

impl Selection {
    fn new(
        whole: &Surface,
        curves: &FeatureCurves,
        pieces: &[Component],
        kept: &[usize],
    ) -> Result<Self, Error> {
        let components = kept.iter().map(|&k| k as u32).collect();
        if kept.len() == pieces.len() {
            let (surface, curves) = (whole.clone(), curves.clone());
            return Ok(Self { surface, curves, components, origin: None });
        }
        let kept = kept.iter().map(|&k| &pieces[k]);
        let mut faces: Vec<u32> = kept.flat_map(|piece| piece.faces.iter().map(|f| f.0)).collect();
        faces.sort_unstable();
        let corners = |&face: &u32| whole.faces()[face as usize];
        let mut vertices: Vec<u32> = faces.iter().flat_map(corners).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let surface = whole.restricted(&vertices, &faces)?;
        let new = |v: u32| vertices.binary_search(&v).ok().map(|v| v as u32);
        let pairs = curves.edges().iter();
        let pairs: Vec<_> = pairs.filter_map(|&[a, b]| Some([new(a)?, new(b)?])).collect();
        let curves = curves.on(&surface, edges_of(surface.mesh(), &pairs));
        Ok(Self { surface, curves, components, origin: Some(Origin { vertices, faces }) })
    }

    /// The numbers in the whole surface of components of the selection.
    pub(crate) fn components_in_whole(&self, components: &[u32]) -> Vec<u32> {
        components.iter().map(|&k| self.components[k as usize]).collect()
    }

    /// Corner UVs of the selection among those of the whole surface.
    pub(crate) fn corner_uvs(&self, of_whole: &[[f64; 2]]) -> Vec<[f64; 2]> {
        match &self.origin {
            None => of_whole.to_vec(),
            Some(Origin { faces, .. }) => {
                let corners = |&face: &u32| 3 * face as usize..3 * face as usize + 3;
                faces.iter().flat_map(|face| &of_whole[corners(face)]).copied().collect()
            }
        }
    }

    /// Makes places on the selection places on the whole surface.
    pub(crate) fn bring_back(&self, extraction: &mut Extraction) {
        let Some(Origin { vertices, faces }) = &self.origin else { return };
        for source in &mut extraction.sources {
            source.face = faces[source.face as usize];
        }
        for source in extraction.cones.iter_mut().filter_map(|cone| cone.source.as_mut()) {
            *source = vertices[*source as usize];
        }
    }

    /// A report on features with the vertices of the whole surface.
    pub(crate) fn report_in_whole(&self, mut report: FeatureReport) -> FeatureReport {
        if let Some(Origin { vertices, .. }) = &self.origin {
            report.rename(|v| vertices[v as usize]);
        }
        report
    }
}
