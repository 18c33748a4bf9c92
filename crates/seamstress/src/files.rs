//! Files: their errors as those of this crate.

use crate::error::{Error, ErrorKind, Stage};
use crate::mesh_format::MeshFormat;
use seamstress_io::{AtomicFile, Format, PolygonMesh, ReadError, ReadErrorKind, WriteError};
use std::io::{self, Write};
use std::path::Path;

impl From<ReadError> for Error {
    fn from(cause: ReadError) -> Self {
        // The message names the file and the place in it.
        let error =
            Self::new(ErrorKind::Unreadable, cause.to_string()).at_stage(Some(Stage::Files));
        match cause.kind {
            ReadErrorKind::UnknownFormat { .. } => error.with_hint("name the format with `format`"),
            _ => error,
        }
    }
}

impl From<WriteError> for Error {
    fn from(cause: WriteError) -> Self {
        Self::new(ErrorKind::Unwritable, cause.to_string()).at_stage(Some(Stage::Files))
    }
}

/// What is written into a file of a format that its name says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Output {
    /// A map, as OBJ, PLY or GLB.
    Map,
    /// Quads, as OBJ, OFF, PLY, STL or GLB.
    Quads,
    /// Quads with the points that their vertices come from, as PLY.
    SourcePoints,
    /// A picture, as PNG.
    Picture,
}

impl Output {
    /// Refuses a name whose ending promises another format. A name without one promises none; `.gz` after it is for
    /// all.
    ///
    /// # Errors
    /// [`ErrorKind::Unwritable`].
    pub fn check_name(self, path: &Path) -> Result<(), Error> {
        let (what, endings) = match self {
            Self::Map => ("maps", &["obj", "ply", "glb"][..]),
            Self::Quads => ("quad meshes", &["obj", "off", "ply", "stl", "glb"][..]),
            Self::SourcePoints => ("source points", &["ply"][..]),
            Self::Picture => ("pictures", &["png"][..]),
        };
        let name = match seamstress_io::is_compressed(path) {
            true => path.with_extension(""),
            false => path.to_owned(),
        };
        let Some(ending) = name.extension().map(|ending| ending.to_string_lossy()) else {
            return Ok(());
        };
        if endings.iter().any(|known| ending.eq_ignore_ascii_case(known)) {
            return Ok(());
        }
        let text = format!(
            "{}: {what} are written as {}, not {}; give the output a name in {}",
            path.display(),
            alternatives(endings.iter().map(|ending| ending.to_uppercase())),
            ending.to_uppercase(),
            alternatives(endings.iter().map(|ending| format!(".{ending}")))
        );
        Err(Error::new(ErrorKind::Unwritable, text).at_stage(Some(Stage::Files)))
    }

    /// Writes a file of the format that its name says, which appears only when it is complete.
    ///
    /// # Errors
    /// [`ErrorKind::Unwritable`].
    pub fn write(
        self,
        path: &Path,
        content: impl FnOnce(&mut AtomicFile) -> io::Result<()>,
    ) -> Result<(), Error> {
        self.check_name(path)?;
        let mut file = AtomicFile::create(path)?;
        let written = content(&mut file).and_then(|()| file.flush());
        written.map_err(|cause| Error::new(ErrorKind::Unwritable, cause.to_string()))?;
        Ok(file.commit()?)
    }
}

/// "A, B or C".
fn alternatives(words: impl Iterator<Item = String>) -> String {
    let words: Vec<String> = words.collect();
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// Reads a mesh as one of a format, that of its name if none is given.
pub(crate) fn read_mesh(path: &Path, format: Option<MeshFormat>) -> Result<PolygonMesh, Error> {
    Ok(seamstress_io::read_mesh_as(path, format.map(Format::from))?)
}
