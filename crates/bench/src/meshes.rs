//! Meshes to measure.

use crate::output::progress;
use seamstress_io::{Format, read_mesh};
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::{self, TriangleSoup};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// Which meshes are measured.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Selection {
    /// Mesh files, or folders of them without their subfolders
    #[arg(required = true, value_name = "MESHES")]
    pub(crate) meshes: Vec<PathBuf>,

    /// Take only the files whose name contains one of these
    #[arg(long, value_name = "TEXT", value_delimiter = ',')]
    pub(crate) only: Vec<String>,

    /// Leave out meshes of fewer triangles
    #[arg(long, value_name = "N")]
    pub(crate) smallest: Option<usize>,

    /// Leave out meshes of more triangles
    #[arg(long, value_name = "N")]
    pub(crate) largest: Option<usize>,
}

impl Selection {
    /// The files, small ones first. Those that are no meshes are among them.
    ///
    /// # Errors
    /// If a folder cannot be read, or there are no such files.
    pub(crate) fn paths(&self) -> Result<Vec<PathBuf>, Box<dyn Error>> {
        let mut sized = Vec::new();
        for path in &self.meshes {
            let cannot_read = |e| format!("cannot read {}: {e}", path.display());
            let files = if path.is_dir() { mesh_files(path) } else { Ok(vec![path.clone()]) };
            for file in files.map_err(cannot_read)? {
                sized.push((fs::metadata(&file).map_err(cannot_read)?.len(), file));
            }
        }
        sized.sort();
        sized.retain(|(_, path)| self.takes_name(path) && self.takes_size(path));
        if sized.is_empty() {
            return Err("no such mesh files".into());
        }
        Ok(sized.into_iter().map(|(_, path)| path).collect())
    }

    /// Measures one mesh after the other; gives a line for each that failed. Files that are no meshes are left
    /// out.
    ///
    /// # Errors
    /// As [`Selection::paths`].
    pub(crate) fn survey(
        &self,
        mut measure: impl FnMut(&Subject) -> Result<(), Box<dyn Error>>,
    ) -> Result<Vec<String>, Box<dyn Error>> {
        let mut failures = Vec::new();
        for path in self.paths()? {
            let mesh = match load(&path) {
                Ok(mesh) => mesh,
                Err(error) => {
                    progress(&format!("left out: {error}"));
                    continue;
                }
            };
            let subject = Subject { name: name(&path), path, mesh };
            if let Err(error) = measure(&subject) {
                let failure = format!("{}: {error}", subject.name);
                progress(&failure);
                failures.push(failure);
            }
        }
        Ok(failures)
    }

    fn takes_name(&self, path: &Path) -> bool {
        self.only.is_empty() || self.only.iter().any(|text| name(path).contains(text))
    }

    fn takes_size(&self, path: &Path) -> bool {
        if self.smallest.is_none() && self.largest.is_none() {
            return true;
        }
        let range = self.smallest.unwrap_or(0)..=self.largest.unwrap_or(usize::MAX);
        load(path).is_ok_and(|mesh| range.contains(&mesh.connectivity.n_faces()))
    }
}

/// The mesh files of a folder, in no order.
fn mesh_files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_file() && Format::from_path(&path).is_some() {
            files.push(path);
        }
    }
    Ok(files)
}

/// The name of a file without its folder.
pub(crate) fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// A mesh that is measured.
#[derive(Debug, Clone)]
pub(crate) struct Subject {
    /// Its file.
    pub(crate) path: PathBuf,
    /// The name of the file.
    pub(crate) name: String,
    /// What the file holds.
    pub(crate) mesh: Mesh,
}

/// A triangle mesh without defects.
#[derive(Debug, Clone)]
pub(crate) struct Mesh {
    /// Its triangles.
    pub(crate) connectivity: TriMesh,
    /// One position per vertex.
    pub(crate) positions: Vec<[f64; 3]>,
}

impl Mesh {
    /// The vertices of its triangles.
    pub(crate) fn faces(&self) -> Vec<[u32; 3]> {
        let faces = self.connectivity.faces();
        faces.map(|f| self.connectivity.face_vertices(f).map(|v| v.0)).collect()
    }
}

/// Reads a mesh and splits its polygons.
///
/// # Errors
/// If the file cannot be read, or has defects that keep it from being a mesh.
pub(crate) fn load(path: &Path) -> Result<Mesh, Box<dyn Error>> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn selection(folder: &Path) -> Selection {
        Selection { meshes: vec![folder.into()], only: vec![], smallest: None, largest: None }
    }

    #[test]
    fn files_come_by_size_and_meshes_by_their_triangles() {
        let folder = tempfile::tempdir().unwrap();
        let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let broken = "v 0 0 0\nf 1 2 3\n# this file is no mesh, and the largest\n";
        for (name, text) in [("a.obj", square), ("b.obj", triangle), ("c.obj", broken)] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        fs::write(folder.path().join("notes.txt"), "").unwrap();
        let names = |selection: &Selection| -> Vec<String> {
            selection.paths().unwrap().iter().map(|path| name(path)).collect()
        };
        let all = selection(folder.path());
        assert_eq!(names(&all), ["b.obj", "a.obj", "c.obj"]);
        assert_eq!(names(&Selection { only: vec!["c.".into()], ..all.clone() }), ["c.obj"]);
        assert_eq!(names(&Selection { smallest: Some(2), ..all.clone() }), ["a.obj"]);
        assert_eq!(names(&Selection { largest: Some(1), ..all.clone() }), ["b.obj"]);
        assert!(Selection { largest: Some(0), ..all.clone() }.paths().is_err());
        let mut seen = Vec::new();
        let failures = all.survey(|subject| {
            seen.push(subject.mesh.connectivity.n_faces());
            if seen.len() == 1 { Err("too small".into()) } else { Ok(()) }
        });
        assert_eq!((seen, failures.unwrap()), (vec![1, 2], vec!["b.obj: too small".to_owned()]));
    }
}
