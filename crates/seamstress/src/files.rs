//! Files: their errors as those of this crate.

use crate::error::{Error, ErrorKind, Stage};
use seamstress_io::{AtomicFile, PolygonMesh, ReadError, WriteError};
use std::io::{self, Write};
use std::path::Path;

impl From<ReadError> for Error {
    fn from(cause: ReadError) -> Self {
        // The message names the file and the place in it.
        Self::new(ErrorKind::Unreadable, cause.to_string()).at_stage(Some(Stage::Files))
    }
}

impl From<WriteError> for Error {
    fn from(cause: WriteError) -> Self {
        Self::new(ErrorKind::Unwritable, cause.to_string()).at_stage(Some(Stage::Files))
    }
}

pub(crate) fn read_mesh(path: &Path) -> Result<PolygonMesh, Error> {
    Ok(seamstress_io::read_mesh(path)?)
}

/// Writes a file that appears only when it is complete.
pub(crate) fn write(
    path: &Path,
    content: impl FnOnce(&mut AtomicFile) -> io::Result<()>,
) -> Result<(), Error> {
    let mut file = AtomicFile::create(path)?;
    let written = content(&mut file).and_then(|()| file.flush());
    written.map_err(|cause| Error::new(ErrorKind::Unwritable, cause.to_string()))?;
    Ok(file.commit()?)
}
