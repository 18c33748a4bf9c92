//! Fields, matchings and cones from files.

use crate::args::{Method, StartArgs};
use crate::map_file::MapFile;
use crate::outcome::Failure;
use seamstress_io::{Cones, read_cones, read_field, read_matching};
use seamstress_mesh::{HalfedgeData, Metric, TriMesh};
use seamstress_parametrize::field::{
    ConePrescription, CrossField, frames_from_directions, matchings_from_rows, residual_field,
};
use seamstress_parametrize::map::compare_source;
use seamstress_parametrize::{Start, Violations};
use std::fmt::Display;
use std::path::Path;

/// Reads what a map shall start from.
///
/// # Errors
/// If a file cannot be read, or does not fit the mesh.
pub(crate) fn read_start(
    args: &StartArgs,
    mesh: &TriMesh,
    positions: &[[f64; 3]],
) -> Result<Start, Failure> {
    if let Some(path) = &args.from {
        return Ok(Start::Map(read_corner_uvs(path, mesh, positions)?));
    }
    if let Some(path) = &args.cones {
        return Ok(Start::Cones(prescription(path, args.free_cones, mesh)?));
    }
    match read_cross_field(args.field.as_deref(), args.matching.as_deref(), mesh, positions)? {
        Some(field) => Ok(Start::Field(field)),
        None if args.method == Method::Field => Ok(Start::SmoothField),
        None => Ok(Start::Mesh),
    }
}

/// A field, from its directions, from matchings, or from both.
pub(crate) fn read_cross_field(
    field: Option<&Path>,
    matching: Option<&Path>,
    mesh: &TriMesh,
    positions: &[[f64; 3]],
) -> Result<Option<CrossField>, Failure> {
    let residues = matching.map(|path| matchings(path, mesh)).transpose()?;
    let metric = || Metric::from_positions(mesh, positions);
    let field = match (field, matching, residues) {
        (Some(path), _, residues) => {
            let directions = read_field(path, mesh.n_faces())?;
            let frames = frames_from_directions(mesh, positions, &directions)
                .map_err(|error| refused(path, &error))?;
            let field = match residues {
                Some(residues) => CrossField::with_residues(mesh, &metric(), frames, &residues),
                None => CrossField::principal(mesh, &metric(), frames),
            };
            field.map_err(|error| refused(path, &error))?
        }
        (None, Some(path), Some(residues)) => {
            residual_field(mesh, &metric(), &residues).map_err(|error| refused(path, &error))?
        }
        _ => return Ok(None),
    };
    Ok(Some(field))
}

/// The UVs of a map of this mesh, which need not be seamless.
pub(crate) fn read_corner_uvs(
    path: &Path,
    mesh: &TriMesh,
    positions: &[[f64; 3]],
) -> Result<Vec<[f64; 2]>, Failure> {
    let read = MapFile::read(path)?;
    let faces: Vec<[u32; 3]> = mesh.faces().map(|f| mesh.face_vertices(f).map(|v| v.0)).collect();
    let source = (positions, faces.as_slice());
    let violations = compare_source(source, (&read.soup.positions, &read.soup.faces));
    match violations.is_empty() {
        true => Ok(read.corner_uvs),
        false => {
            Err(Failure::BadMap { file: path.to_owned(), text: Violations(violations).to_string() })
        }
    }
}

fn matchings(path: &Path, mesh: &TriMesh) -> Result<HalfedgeData<i32>, Failure> {
    let rows = read_matching(path, mesh.n_faces())?;
    let rows: Vec<_> = rows.iter().map(|row| (row.faces, row.vertices, row.matching)).collect();
    matchings_from_rows(mesh, &rows).map_err(|error| refused(path, &error))
}

fn prescription(path: &Path, is_free: bool, mesh: &TriMesh) -> Result<ConePrescription, Failure> {
    let prescription = match read_cones(path, mesh.n_vertices())? {
        Cones::Listed(cones) if is_free => ConePrescription::among_others(mesh, &cones),
        Cones::Listed(cones) => ConePrescription::exactly(mesh, &cones),
        Cones::Angles(_) if is_free => {
            let text = "`--free-cones` needs a .sing file; a file of angles fixes every vertex";
            return Err(Failure::Usage(format!("{}: {text}", path.display())));
        }
        Cones::Angles(angles) => ConePrescription::from_angles(mesh, &angles),
    };
    prescription.map_err(|error| refused(path, &error))
}

fn refused(path: &Path, error: &impl Display) -> Failure {
    Failure::BadStart { file: path.to_owned(), text: error.to_string() }
}
