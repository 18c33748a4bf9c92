//! What a map starts from.

use crate::error::{Error, ErrorKind, Stage};
use crate::given::MapFile;
use crate::surface::Surface;
use seamstress_io::{Cones, read_cones, read_field, read_matching};
use seamstress_mesh::HalfedgeData;
use seamstress_parametrize as method;
use seamstress_parametrize::field::{
    ConePrescription, CrossField, frames_from_directions, matchings_from_rows, residual_field,
};
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// What a map starts from: nothing but the surface, or a field, matchings, cones or a broken map from a file.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Start from"))]
#[non_exhaustive]
pub struct StartOptions {
    /// Start from this cross field, a .rawfield, or a .rosy with a vector per face: the map has its cones
    /// and follows it around handles
    #[cfg_attr(feature = "clap", arg(long, value_name = "FIELD",
        conflicts_with_all = ["cones", "method", "features", "align_boundary"]))]
    pub field: Option<PathBuf>,

    /// Start from these matchings modulo 4, with the frames of `--field`, or without it with the
    /// smoothest frames
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.matching",
        conflicts_with_all = ["cones", "method", "features", "align_boundary"]))]
    pub matching: Option<PathBuf>,

    /// Make exactly these cones: a .sing file, or a file with the total angle of every vertex in radians
    /// (those of the boundary are free)
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE",
        conflicts_with_all = ["method", "features", "align_boundary"]))]
    pub cones: Option<PathBuf>,

    /// Start from a map with foldovers: its cones and matchings, or consistent ones near them
    #[cfg_attr(feature = "clap", arg(long, value_name = "MAP.obj",
        conflicts_with_all = ["field", "matching", "cones", "method"]))]
    pub from: Option<PathBuf>,

    /// Let vertices that the .sing file does not list become cones; an index of 0 keeps one from it
    #[cfg_attr(feature = "clap", arg(long, requires = "cones"))]
    pub free_cones: bool,

    /// How the matchings are chosen
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "HOW", default_value_t = MethodName::Direct))]
    pub method: MethodName,

    /// Lay the field of `--method field` out exactly, with every safeguard against flips
    #[cfg_attr(feature = "clap", arg(long, requires = "method"))]
    pub exact: bool,

    /// Local/global iterations after the Poisson layout of `--method field`
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "N",
            default_value_t = 0,
            requires = "method",
            conflicts_with = "exact"
        )
    )]
    pub local_global: usize,

    /// Write the map of `--method field` even if triangles are flipped; it is not certified then
    #[cfg_attr(feature = "clap", arg(long, requires = "method", conflicts_with_all = ["exact", "pictures", "sing"]))]
    pub allow_flips: bool,
}

/// How the matchings are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum MethodName {
    /// Rounding between layouts, without a field
    #[default]
    Direct,
    /// A smooth cross field by mixed-integer rounding, then its Poisson layout: the classical method, as a
    /// baseline; triangles may flip
    Field,
}

impl StartOptions {
    /// The files that are read.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let files = [&self.field, &self.matching, &self.cones, &self.from];
        files.into_iter().flatten().map(PathBuf::as_path)
    }

    /// Whether the map is the Poisson layout of a smooth field.
    pub(crate) fn is_baseline(&self) -> bool {
        self.method == MethodName::Field && !self.exact
    }

    pub(crate) fn validate(&self) -> Result<(), Error> {
        if self.exact && self.method != MethodName::Field {
            return Err(Error::options("`exact` goes with the method `field`"));
        }
        Ok(())
    }

    /// Reads what the map shall start from.
    ///
    /// # Errors
    /// If a file cannot be read, or does not fit the surface.
    pub(crate) fn read(&self, surface: &Surface) -> Result<method::Start, Error> {
        if let Some(path) = &self.from {
            return Ok(method::Start::Map(read_corner_uvs(path, surface)?));
        }
        if let Some(path) = &self.cones {
            return Ok(method::Start::Cones(prescription(path, self.free_cones, surface)?));
        }
        match read_cross_field(self.field.as_deref(), self.matching.as_deref(), surface)? {
            Some(field) => Ok(method::Start::Field(field)),
            None if self.method == MethodName::Field => Ok(method::Start::SmoothField),
            None => Ok(method::Start::Mesh),
        }
    }
}

/// A field, from its directions, from matchings, or from both.
pub(crate) fn read_cross_field(
    field: Option<&Path>,
    matching: Option<&Path>,
    surface: &Surface,
) -> Result<Option<CrossField>, Error> {
    let (mesh, metric) = (surface.mesh(), surface.metric());
    let residues = matching.map(|path| matchings(path, surface)).transpose()?;
    let field = match (field, matching, residues) {
        (Some(path), _, residues) => {
            let directions = read_field(path, mesh.n_faces())?;
            let frames = frames_from_directions(mesh, surface.positions(), &directions)
                .map_err(|cause| refused(path, &cause))?;
            let field = match residues {
                Some(residues) => CrossField::with_residues(mesh, metric, frames, &residues),
                None => CrossField::principal(mesh, metric, frames),
            };
            field.map_err(|cause| refused(path, &cause))?
        }
        (None, Some(path), Some(residues)) => {
            residual_field(mesh, metric, &residues).map_err(|cause| refused(path, &cause))?
        }
        _ => return Ok(None),
    };
    Ok(Some(field))
}

/// The UVs of a map of this surface, which need not be seamless.
pub(crate) fn read_corner_uvs(path: &Path, surface: &Surface) -> Result<Vec<[f64; 2]>, Error> {
    let read = MapFile::read(path)?;
    read.require_mesh_of(surface)?;
    surface.corner_uvs(read.uvs(), read.face_uvs())
}

fn matchings(path: &Path, surface: &Surface) -> Result<HalfedgeData<i32>, Error> {
    let rows = read_matching(path, surface.faces().len())?;
    let rows: Vec<_> = rows.iter().map(|row| (row.faces, row.vertices, row.matching)).collect();
    matchings_from_rows(surface.mesh(), &rows).map_err(|cause| refused(path, &cause))
}

fn prescription(path: &Path, is_free: bool, surface: &Surface) -> Result<ConePrescription, Error> {
    let mesh = surface.mesh();
    let prescription = match read_cones(path, mesh.n_vertices())? {
        Cones::Listed(cones) if is_free => ConePrescription::among_others(mesh, &cones),
        Cones::Listed(cones) => ConePrescription::exactly(mesh, &cones),
        Cones::Angles(_) if is_free => {
            let text = "`free_cones` needs a .sing file; a file of angles fixes every vertex";
            return Err(Error::options(text).of(Some(&path.display().to_string())));
        }
        Cones::Angles(angles) => ConePrescription::from_angles(mesh, &angles),
    };
    prescription.map_err(|cause| refused(path, &cause))
}

fn refused(path: &Path, cause: &impl Display) -> Error {
    Error::new(ErrorKind::BadStart, cause.to_string())
        .at_stage(Some(Stage::Files))
        .of(Some(&path.display().to_string()))
}
