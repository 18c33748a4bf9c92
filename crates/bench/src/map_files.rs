//! Files of maps and of the meshes they belong to.

use crate::meshes::Mesh;
use seamstress_io::attributes::{Attribute, AttributeDomain, AttributeKind};
use seamstress_io::{Format, PolygonMesh, Polymesh, read_mesh};
use seamstress_mesh::Metric;
use seamstress_parametrize::{MapOptions, Purpose, SeamlessMap, Tolerance, make_map};
use seamstress_quantize::GridSize;
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// The seamless map of a mesh for a number of quads, and the seconds it took: read from the folder if it is
/// there, else made, and kept in the folder.
///
/// # Errors
/// If there is no map, or a file cannot be read or written.
pub(crate) fn seamless(
    name: &str,
    mesh: &Mesh,
    quads: f64,
    folder: Option<&Path>,
) -> Result<(SeamlessMap, f64), Box<dyn Error>> {
    let kept = folder.map(|folder| folder.join(format!("{name}.{quads}.map.obj")));
    if let Some(path) = kept.as_ref().filter(|path| path.is_file()) {
        let read = read_mesh(path)?;
        let corners = corner_uvs(&read).ok_or("the map kept has no UVs")?;
        let map = SeamlessMap::certify(&mesh.connectivity, corners, &Tolerance::default())?;
        return Ok((map, 0.0));
    }
    let start = Instant::now();
    let mut go_on = |_| ControlFlow::Continue(());
    let side = Metric::from_positions(&mesh.connectivity, &mesh.positions).side();
    let purpose = Purpose::Quads { edge_length: GridSize::Quads(quads).cell(side) };
    let options = MapOptions { purpose, ..MapOptions::default() };
    let map = make_map(&mesh.connectivity, &mesh.positions, &options, &mut go_on)?.map;
    let seconds = start.elapsed().as_secs_f64();
    if let Some(path) = kept {
        write_map(&path, mesh, map.corner_uvs())?;
    }
    Ok((map, seconds))
}

/// The first texture coordinates of what was read, one per corner, if there are any.
pub(crate) fn corner_uvs(read: &PolygonMesh) -> Option<Vec<[f64; 2]>> {
    let uvs = read.corner_uvs()?;
    Some((0..uvs.rows.len()).map(|c| [uvs.of(c)[0], uvs.of(c)[1]]).collect())
}

/// Writes triangles with their UVs.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_map(
    path: &Path,
    mesh: &Mesh,
    corner_uvs: &[[f64; 2]],
) -> Result<(), Box<dyn Error>> {
    let mut file = BufWriter::new(File::create(path)?);
    let (positions, polygons) = (&mesh.positions, &mesh.faces()[..]);
    let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Uv);
    let uvs = Attribute::new("map", domain, kind, 2, corner_uvs.as_flattened().to_vec());
    let attributes = &vec![uvs].into();
    Polymesh { positions, polygons, attributes, comments: &[] }.write(&mut file, Format::Obj)?;
    Ok(file.flush()?)
}

/// Writes triangles without UVs, as an OBJ file.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_mesh(path: &Path, mesh: &Mesh) -> Result<(), Box<dyn Error>> {
    let mut file = BufWriter::new(File::create(path)?);
    for [x, y, z] in &mesh.positions {
        writeln!(file, "v {x} {y} {z}")?;
    }
    for face in mesh.faces() {
        let [a, b, c] = face.map(|v| v + 1);
        writeln!(file, "f {a} {b} {c}")?;
    }
    Ok(file.flush()?)
}
