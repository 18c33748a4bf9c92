//! Meshes to measure.

use seamstress_io::{Format, read_mesh};
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::{self, TriangleSoup};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// The mesh files of a folder whose name contains `only`, small ones first.
///
/// # Errors
/// If the folder cannot be read, or holds no such file.
pub fn list(folder: &Path, only: Option<&str>) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let cannot_read = |e| format!("cannot read {}: {e}", folder.display());
    let mut meshes = Vec::new();
    for entry in fs::read_dir(folder).map_err(cannot_read)? {
        let path = entry.map_err(cannot_read)?.path();
        let is_wanted = only.is_none_or(|text| name(&path).contains(text));
        if is_wanted && path.is_file() && Format::from_path(&path).is_some() {
            meshes.push((fs::metadata(&path).map_err(cannot_read)?.len(), path));
        }
    }
    meshes.sort();
    if meshes.is_empty() {
        return Err(format!("no such mesh file in {}", folder.display()).into());
    }
    Ok(meshes.into_iter().map(|(_, path)| path).collect())
}

/// The name of a file without its folder.
pub fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// A triangle mesh without faults.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Its triangles.
    pub connectivity: TriMesh,
    /// One position per vertex.
    pub positions: Vec<[f64; 3]>,
}

impl Mesh {
    /// The vertices of its triangles.
    pub fn faces(&self) -> Vec<[u32; 3]> {
        let faces = self.connectivity.faces();
        faces.map(|f| self.connectivity.face_vertices(f).map(|v| v.0)).collect()
    }
}

/// Reads a mesh and splits its polygons.
///
/// # Errors
/// If the file cannot be read, or has faults that keep it from being a mesh.
pub fn load(path: &Path) -> Result<Mesh, Box<dyn Error>> {
    let read = read_mesh(path)?;
    let refuse = |fault: Option<&dyn ToString>| {
        let fault = fault.map_or(String::new(), |fault| format!(": {}", fault.to_string()));
        format!("{}: not a mesh{fault}", path.display())
    };
    let faces = soup::triangulate(&read.positions, read.polygons.iter())
        .map_err(|faults| refuse(faults.first().map(|fault| fault as _)))?
        .faces;
    let soup = TriangleSoup { positions: read.positions, faces };
    if let Some(fault) = soup::check(&soup).errors().next() {
        return Err(refuse(Some(fault)).into());
    }
    let connectivity = TriMesh::from_faces(soup.positions.len(), &soup.faces)?;
    Ok(Mesh { connectivity, positions: soup.positions })
}
