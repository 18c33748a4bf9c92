//! Maps and quad meshes from files.

use crate::error::{Error, ErrorKind, Stage};
use crate::files::read_mesh;
use crate::finding::Finding;
use crate::inspection::Inspection;
use crate::surface::Surface;
use crate::surface_options::SurfaceOptions;
use seamstress_certify::{Obj, compare_source};
use seamstress_io::{Format, PolygonMesh, read_content};
use seamstress_parametrize::map::{first_in_words, in_words};
use seamstress_parametrize::{Violation, Violations};
use std::path::Path;

/// A map read from an OBJ file: triangles with a texture coordinate at every corner. It promises nothing.
#[derive(Debug, Clone)]
pub struct MapFile {
    input: String,
    /// Of an OBJ file what the checker itself reads.
    map: Obj<3>,
    mesh: PolygonMesh,
}

impl MapFile {
    /// Reads a map.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`]; [`ErrorKind::NotAMap`] if a corner has no texture coordinate, or a face is no
    /// triangle.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let mut mesh = read_mesh(path, None)?;
        let input = path.display().to_string();
        let bad = |text: &str| {
            Err(Error::new(ErrorKind::NotAMap, text).at_stage(Some(Stage::Files)).of(Some(&input)))
        };
        // They are the map, not something that its mesh carries.
        let corners = mesh.corner_uvs().cloned();
        let Some(corners) = corners else {
            let mut text = String::from(
                "not a map: a map is an OBJ file with a texture coordinate at every corner of every face",
            );
            for note in &mesh.notes {
                text += &format!("\nnote: {note}");
            }
            return bad(&text);
        };
        let faces: Option<Vec<[u32; 3]>> =
            mesh.polygons.iter().map(|polygon| <[u32; 3]>::try_from(polygon).ok()).collect();
        let Some(faces) = faces else {
            let larger = mesh.polygons.iter().position(|polygon| polygon.len() > 3);
            return bad(&format!(
                "face {} is not a triangle; the faces of a map are the triangles of its mesh",
                larger.unwrap_or_default()
            ));
        };
        mesh.attributes.all.retain(|attribute| *attribute != corners);
        let face_uvs = corners.rows.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let uvs = corners.values.chunks_exact(2).map(|uv| [uv[0], uv[1]]).collect();
        let map = match mesh.format {
            Format::Obj => match Obj::read(&String::from_utf8_lossy(&read_content(path)?)) {
                Ok(map) => map,
                Err(line) => return bad(&format!("not a map: line {line} is not as in a map")),
            },
            _ => Obj { positions: mesh.positions.clone(), uvs, faces, face_uvs },
        };
        Ok(Self { input, map, mesh })
    }

    /// The UVs.
    pub fn uvs(&self) -> &[[f64; 2]] {
        &self.map.uvs
    }

    /// For each face the UVs of its corners.
    pub fn face_uvs(&self) -> &[[u32; 3]] {
        &self.map.face_uvs
    }

    /// The mesh that it is of, as it stands in the file.
    pub fn inspect(&self) -> Inspection {
        Inspection::of_mesh(Path::new(&self.input), self.mesh.clone(), &SurfaceOptions::default())
    }

    /// Everything in which its mesh differs from a surface. A map must not touch positions nor faces.
    pub fn differences(&self, surface: &Surface) -> Vec<Finding> {
        self.compare(surface).iter().map(Finding::from).collect()
    }

    /// Refuses a map whose triangles are not those of a surface.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`].
    pub fn require_faces_of(&self, surface: &Surface) -> Result<(), Error> {
        let moved = |fault: &Violation| matches!(fault, Violation::MovedVertex { .. });
        match self.compare(surface).into_iter().find(|fault| !moved(fault)) {
            Some(fault) => {
                Err(self.refused(&format!("not a map of the mesh: {}", in_words(&fault))))
            }
            None => Ok(()),
        }
    }

    /// Refuses a map whose triangles or positions are not those of a surface.
    ///
    /// # Errors
    /// [`ErrorKind::NotAMap`].
    pub fn require_mesh_of(&self, surface: &Surface) -> Result<(), Error> {
        let differences = self.compare(surface);
        match differences.is_empty() {
            true => Ok(()),
            false => Err(self
                .refused(&format!("not a map of the mesh: {}", first_in_words(&differences)))
                .with_findings(surface.findings(&Violations(differences)))),
        }
    }

    fn compare(&self, surface: &Surface) -> Vec<Violation> {
        let source = (surface.positions(), surface.faces());
        compare_source(source, (&self.map.positions, &self.map.faces))
    }

    fn refused(&self, text: &str) -> Error {
        Error::new(ErrorKind::NotAMap, text).of(Some(&self.input))
    }
}
