//! Seamless maps.

use crate::context::Watcher;
use crate::error::Error;
use crate::feature_sources::Features;
use crate::features::{AlignedFeatures, FeatureCurves, FeatureReport};
use crate::options::MapOptions;
use crate::packing::PackingReport;
use crate::report::{ConeReport, Distortion, SeamReport, SurfaceReport, VERSION};
use crate::sizes::SizeReport;
use crate::surface::Surface;
use crate::symmetric::Side;
use crate::symmetry::{Symmetry, SymmetryReport};
use crate::words::{counted, rounded};
#[cfg(feature = "io")]
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};
use seamstress_parametrize::atlas::Atlas;
use seamstress_parametrize::map::{Certificate, Cone, SeamEdge};
use seamstress_parametrize::{
    self as method, ComponentStats, MapError, ReleasedFeature, Tolerance, make_aligned_map,
};
use serde::Serialize;
#[cfg(any(feature = "page", feature = "render"))]
use std::borrow::Cow;
use std::collections::HashMap;
#[cfg(feature = "io")]
use std::{io, path::Path};

/// A certified seamless map of a surface, with a report of how it was made.
#[derive(Debug, Clone)]
pub struct SeamlessMap<R = MapReport> {
    surface: Surface,
    map: method::SeamlessMap,
    corners: CornerUvs,
    features: Option<AlignedFeatures>,
    distortion: Distortion,
    /// Units of the map in a unit of the mesh.
    scale: f64,
    report: R,
}

/// How a map was made, and how good it is.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapReport {
    /// The version that made it.
    pub seamstress: &'static str,
    /// The options it was made with.
    pub options: MapOptions,
    /// The surface.
    pub input: SurfaceReport,
    /// How the map of each component was made, in order of first faces.
    pub components: Vec<ComponentStats>,
    /// Its distortion.
    pub distortion: Distortion,
    /// The sizes of cells asked for, if any were.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sizes: Option<SizeReport>,
    /// Its cones.
    pub cones: ConeReport,
    /// Its seams.
    pub seams: SeamReport,
    /// What was checked of it.
    pub certificate: Certificate,
    /// How its charts were packed, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<PackingReport>,
    /// What made it symmetric, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<SymmetryReport>,
    /// The features asked for and what became of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub features: Option<FeatureReport>,
}

/// Which texture coordinates a map is in a file that may have several, where its mesh has some of its own: GLB. OBJ files
/// have one, and it is the map.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum UvSet {
    /// The first, before those of the mesh
    #[default]
    First,
    /// The second, after the first of the mesh
    Second,
}

/// What a map is called and how it is drawn, by its report.
#[doc(hidden)]
pub trait Described {
    /// Its title in files.
    const TITLE: &'static str;
    /// Side of a check of its texture, if it has a natural one.
    const CHECK: Option<f64> = None;

    /// What its file says of it.
    fn lines(&self) -> Vec<String>;
}

impl Described for MapReport {
    const TITLE: &'static str = "Seamless map";

    fn lines(&self) -> Vec<String> {
        vec![self.distortion.line(self.cones.count)]
    }
}

impl SeamlessMap {
    pub(crate) fn new(
        surface: &Surface,
        map: method::SeamlessMap,
        features: Option<AlignedFeatures>,
        options: &MapOptions,
        components: Vec<ComponentStats>,
    ) -> Self {
        let distortion = surface.distortion(map.corner_uvs());
        let report = MapReport {
            seamstress: VERSION,
            options: options.clone(),
            input: surface.report().clone(),
            components,
            distortion,
            sizes: surface.size_report(map.corner_uvs(), surface.texture_cell()),
            cones: ConeReport::new(map.cones()),
            seams: SeamReport::new(map.seams()),
            certificate: map.certificate().clone(),
            packing: None,
            symmetry: None,
            features: features.as_ref().map(|features| features.report.clone()),
        };
        Self::reported(surface, map, features, report)
    }

    /// The same with its charts in the unit square, where options ask for that.
    pub(crate) fn packed(mut self, options: &MapOptions) -> Result<Self, Error> {
        let Some(texels) = options.pack else { return Ok(self) };
        let mesh = self.surface.mesh();
        let atlas = Atlas::new(mesh, self.corner_uvs(), texels, options.pack_margin)
            .map_err(|cause| PackingReport::refusal(&cause))?;
        self.scale = atlas.density / f64::from(texels);
        self.report.packing = Some(PackingReport::new(&atlas, options));
        self.map = method::SeamlessMap::certify(mesh, atlas.corner_uvs, &Tolerance::default())
            .map_err(|violations| self.surface.no_map(MapError::Uncertified(violations)))?;
        self.corners = CornerUvs::new(self.surface.faces(), self.map.corner_uvs());
        self.report.seams = SeamReport::new(self.map.seams());
        self.report.certificate = self.map.certificate().clone();
        Ok(self)
    }

    pub(crate) fn with_symmetry(mut self, symmetry: SymmetryReport) -> Self {
        self.report.symmetry = Some(symmetry);
        self
    }
}

impl<R> SeamlessMap<R> {
    pub(crate) fn reported(
        surface: &Surface,
        map: method::SeamlessMap,
        features: Option<AlignedFeatures>,
        report: R,
    ) -> Self {
        let corners = CornerUvs::new(surface.faces(), map.corner_uvs());
        let distortion = surface.distortion(map.corner_uvs());
        Self {
            surface: surface.without_wishes(),
            map,
            corners,
            features,
            distortion,
            scale: 1.0,
            report,
        }
    }

    /// The surface it is of.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The UVs, mesh units unless it is packed: one for each vertex, and one more wherever a seam gives it another.
    pub fn uvs(&self) -> &[[f64; 2]] {
        &self.corners.uvs
    }

    /// For each face of the surface the UVs of its corners.
    pub fn face_uvs(&self) -> &[[u32; 3]] {
        &self.corners.faces
    }

    /// The UV of every corner, three a face.
    pub fn corner_uvs(&self) -> &[[f64; 2]] {
        self.map.corner_uvs()
    }

    /// Interior vertices with an angle other than a full turn, ascending.
    pub fn cones(&self) -> &[Cone] {
        self.map.cones()
    }

    /// Interior edges across which the UVs jump.
    pub fn seams(&self) -> &[SeamEdge] {
        self.map.seams()
    }

    /// What was checked.
    pub fn certificate(&self) -> &Certificate {
        self.map.certificate()
    }

    /// Feature edges that it has on its axes, by their ends.
    pub fn aligned_edges(&self) -> &[[u32; 2]] {
        self.features.as_ref().map_or(&[], |features| &features.kept)
    }

    /// Features asked for that it does not follow, each with the reason.
    pub fn dropped_features(&self) -> &[ReleasedFeature] {
        self.features.as_ref().map_or(&[], |features| &features.dropped)
    }

    /// Its distortion.
    pub fn distortion(&self) -> &Distortion {
        &self.distortion
    }

    /// How it was made, and how good it is.
    pub fn report(&self) -> &R {
        &self.report
    }

    /// The UV of every corner in mesh units.
    #[cfg(any(feature = "page", feature = "render"))]
    pub(crate) fn unscaled_uvs(&self) -> Cow<'_, [[f64; 2]]> {
        match self.scale {
            1.0 => Cow::Borrowed(self.corner_uvs()),
            scale => self.corner_uvs().iter().map(|uv| uv.map(|x| x / scale)).collect(),
        }
    }

    pub(crate) fn inner(&self) -> &method::SeamlessMap {
        &self.map
    }

    pub(crate) fn features(&self) -> Option<&AlignedFeatures> {
        self.features.as_ref()
    }
}

#[cfg(feature = "io")]
impl<R: Described> SeamlessMap<R> {
    /// Writes it as OBJ, PLY or GLB, by the ending of the name, with the positions, faces and attributes of the surface; the
    /// file appears when it is complete.
    ///
    /// # Errors
    /// [`ErrorKind::Unwritable`](crate::ErrorKind::Unwritable).
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let write = |file: &mut _| self.write_as(path, UvSet::First, file);
        crate::files::Output::Map.write(path, write)
    }

    /// Writes it in the format that a file of this name has: OBJ, PLY or GLB. OBJ if it says none.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_as(
        &self,
        name: impl AsRef<Path>,
        set: UvSet,
        writer: &mut impl io::Write,
    ) -> io::Result<()> {
        let lines = self.report.lines();
        let uvs = (&self.corners, set);
        write_map(writer, name.as_ref(), &self.surface, R::TITLE, uvs, &lines)
    }
}

impl Distortion {
    /// For the head of a file.
    pub(crate) fn line(&self, cones: usize) -> String {
        format!(
            "tau {}, symmetric Dirichlet energy {}, {}",
            rounded(self.tau),
            rounded(self.symmetric_dirichlet),
            counted(cones, "cone")
        )
    }
}

/// A map of a surface, and what the surface carries, with its title, its source and more in comments.
#[cfg(feature = "io")]
pub(crate) fn write_map(
    writer: &mut impl io::Write,
    name: &Path,
    surface: &Surface,
    title: &str,
    (corners, set): (&CornerUvs, UvSet),
    lines: &[String],
) -> io::Result<()> {
    let mut comments = vec![format!("{title} by Seamstress {VERSION}")];
    comments.extend(source_line(surface));
    comments.extend_from_slice(lines);
    let (positions, polygons) = (surface.positions(), surface.faces());
    let uvs = Attribute::new(
        "map",
        AttributeDomain::Corner,
        AttributeKind::Uv,
        2,
        corners.uvs.as_flattened().to_vec(),
    );
    let format = seamstress_io::Format::from_path(name).unwrap_or(seamstress_io::Format::Obj);
    let mut attributes = surface.attributes_on_triangles();
    let is_second = set == UvSet::Second && format == seamstress_io::Format::Gltf;
    let first = attributes.all.iter().position(|a| a.kind == AttributeKind::Uv);
    let place = first.filter(|_| is_second).map_or(0, |first| first + 1);
    attributes.all.insert(place, uvs.with_rows(corners.faces.as_flattened().to_vec()));
    let (attributes, comments) = (&attributes, &comments[..]);
    seamstress_io::Polymesh { positions, polygons, attributes, comments }.write(writer, format)
}

/// Where a surface comes from, for the head of a file.
#[cfg(feature = "io")]
pub(crate) fn source_line(surface: &Surface) -> Option<String> {
    let path = Path::new(surface.input()?);
    let name = path.file_name().unwrap_or(path.as_os_str());
    let repaired = match surface.report().repairs.len() {
        0 => String::new(),
        n => format!(", after {}", counted(n, "repair")),
    };
    Some(format!("Source: {}{repaired}", name.display()))
}

/// UVs with corners that share one.
#[derive(Debug, Clone)]
pub(crate) struct CornerUvs {
    pub(crate) uvs: Vec<[f64; 2]>,
    pub(crate) faces: Vec<[u32; 3]>,
}

impl CornerUvs {
    /// Corners of a vertex share a UV if theirs are equal to the bit, as in a file.
    pub(crate) fn new(faces: &[[u32; 3]], corner_uvs: &[[f64; 2]]) -> Self {
        let mut known = HashMap::new();
        let mut uvs = Vec::new();
        let mut index = |vertex: u32, uv: [f64; 2]| {
            *known.entry((vertex, uv.map(f64::to_bits))).or_insert_with(|| {
                uvs.push(uv);
                (uvs.len() - 1) as u32
            })
        };
        let corners = faces.iter().zip(corner_uvs.chunks_exact(3));
        let faces = corners.map(|(face, uvs)| [0, 1, 2].map(|k| index(face[k], uvs[k]))).collect();
        Self { uvs, faces }
    }
}

impl Surface {
    pub(crate) fn distortion(&self, corner_uvs: &[[f64; 2]]) -> Distortion {
        Distortion::from(&method::quality::distortion(self.mesh(), self.metric(), corner_uvs))
    }

    /// Makes a seamless map of low distortion by the direct method, and certifies it.
    ///
    /// # Errors
    /// Of the [kinds](crate::ErrorKind) `NoMap`, where the method finds none that it can vouch for, `DroppedFeatures`,
    /// `BadFeatures`, `Options`, `Cancelled` and `TimeLimit`.
    ///
    /// # Source
    /// Levi 2021.
    pub fn parametrize(&self, options: &MapOptions) -> Result<SeamlessMap, Error> {
        options.validate()?;
        let options = &options.or_features(Features::none());
        let made = self.context().run(self.expected_for_map(), |watcher| {
            let asked = self.features(&options.features)?;
            let sized = self.prepared_for_textures(&asked, options)?;
            sized.direct_map(asked, options, options.to_method(), watcher)?.packed(options)
        });
        made.map_err(|error| error.of(self.input()))
    }

    /// The map by the direct method with these settings, aligned to these features; of one side and its images, where it
    /// is to be symmetric.
    pub(crate) fn direct_map(
        &self,
        asked: FeatureCurves,
        options: &MapOptions,
        settings: method::MapOptions,
        watcher: &mut Watcher,
    ) -> Result<SeamlessMap, Error> {
        match Side::new(self, &asked, options, self.texture_cell())? {
            Some(side) => self.symmetric_map(&side, options, settings, watcher),
            None => {
                self.make_map(asked, &options.clone().symmetry(Symmetry::None), settings, watcher)
            }
        }
    }

    /// The map by the direct method with these settings, aligned to these features.
    pub(crate) fn make_map(
        &self,
        asked: FeatureCurves,
        options: &MapOptions,
        settings: method::MapOptions,
        watcher: &mut Watcher,
    ) -> Result<SeamlessMap, Error> {
        options.symmetry.refuse()?;
        let mut observe = |progress| watcher.observe(progress);
        let solution =
            make_aligned_map(self.mesh(), self.geometry(), &asked.edges, &settings, &mut observe)
                .map_err(|cause| self.no_map(cause))?;
        let certify = || self.aligned(asked, &solution.map, &solution.released);
        let features = (!options.features.is_none()).then(certify).transpose()?;
        Ok(SeamlessMap::new(self, solution.map, features, options, solution.components))
    }

    /// Features in a map that was made along them, except for those that were dropped.
    pub(crate) fn aligned(
        &self,
        asked: FeatureCurves,
        map: &method::SeamlessMap,
        dropped: &[ReleasedFeature],
    ) -> Result<AlignedFeatures, Error> {
        let tolerance = Tolerance::default();
        AlignedFeatures::certify(self.mesh(), asked, map, dropped, &tolerance)
            .map_err(|violations| self.misaligned(&violations))
    }
}
