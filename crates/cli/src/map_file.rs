//! Maps from files.

use crate::input::LoadedMesh;
use crate::outcome::Failure;
use seamstress_io::{PolygonMesh, read_mesh};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::Violation;
use seamstress_parametrize::map::compare_source;
use std::path::Path;

/// A map as read: triangles with a UV per corner.
pub(crate) struct MapFile {
    pub(crate) soup: TriangleSoup,
    pub(crate) corner_uvs: Vec<[f64; 2]>,
}

impl MapFile {
    /// Reads an OBJ file with a texture coordinate at every corner of every triangle.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let read = read_mesh(path)?;
        let Triangles { faces, corner_uvs } = Triangles::of(path, &read)?;
        Ok(Self { soup: TriangleSoup { positions: read.positions, faces }, corner_uvs })
    }
}

fn bad_map(path: &Path, text: &str) -> Failure {
    Failure::BadMap { file: path.to_owned(), text: text.to_owned() }
}

fn corner_uvs(read: &PolygonMesh) -> Option<Vec<[f64; 2]>> {
    let uvs = read.corner_uvs.as_ref()?;
    uvs.corners.iter().map(|&corner| uvs.coordinates.get(corner as usize).copied()).collect()
}

/// The triangles of a map and the UVs of their corners.
pub(crate) struct Triangles {
    faces: Vec<[u32; 3]>,
    pub(crate) corner_uvs: Vec<[f64; 2]>,
}

impl Triangles {
    /// # Errors
    /// If a corner has no UV, or a face is not a triangle.
    pub(crate) fn of(path: &Path, read: &PolygonMesh) -> Result<Self, Failure> {
        let corner_uvs = corner_uvs(read).ok_or_else(|| {
            let mut text = String::from(
                "not a map: a map is an OBJ file with a texture coordinate at every corner of every face",
            );
            for note in &read.notes {
                text += &format!("\nnote: {note}");
            }
            bad_map(path, &text)
        })?;
        let faces: Option<Vec<[u32; 3]>> =
            read.polygons.iter().map(|polygon| <[u32; 3]>::try_from(polygon).ok()).collect();
        let Some(faces) = faces else {
            let larger = read.polygons.iter().position(|polygon| polygon.len() > 3);
            let text = format!(
                "face {} is not a triangle; the faces of a map are the triangles of its mesh",
                larger.unwrap_or_default()
            );
            return Err(bad_map(path, &text));
        };
        Ok(Self { faces, corner_uvs })
    }
}

impl MapFile {
    /// Refuses a map whose triangles are not those of the mesh.
    pub(crate) fn require_faces_of(&self, mesh: &LoadedMesh, path: &Path) -> Result<(), Failure> {
        let source = (&mesh.soup.positions[..], &mesh.soup.faces[..]);
        let faces = (&self.soup.positions[..], &self.soup.faces[..]);
        let fault = compare_source(source, faces)
            .into_iter()
            .find(|fault| !matches!(fault, Violation::MovedVertex { .. }));
        match fault {
            Some(fault) => Err(bad_map(path, &format!("not a map of the mesh: {fault}"))),
            None => Ok(()),
        }
    }
}
