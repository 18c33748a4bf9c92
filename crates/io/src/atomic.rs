//! Files that appear only when they are complete.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::format::is_compressed;
use crate::temporary::Temporary;
use flate2::Compression;
use flate2::write::GzEncoder;

/// A file that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {cause}", path.display())]
#[non_exhaustive]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub cause: io::Error,
}

impl WriteError {
    fn new(path: &Path, cause: io::Error) -> Self {
        Self { path: path.to_owned(), cause }
    }
}

/// A file under construction.
///
/// The data goes to a temporary file in the same directory; [`AtomicFile::commit`] renames it. Without a
/// commit the temporary file is removed and a file of the same name stays as it was. Data for a name that ends
/// in `.gz` is compressed. Errors name the path.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    /// Where the data goes: `path` with symbolic links followed.
    target: PathBuf,
    file: Sink,
}

/// Where data goes.
#[derive(Debug)]
enum Sink {
    Plain(BufWriter<Temporary>),
    Compressed(GzEncoder<BufWriter<Temporary>>),
}

impl Sink {
    fn writer(&mut self) -> &mut dyn Write {
        match self {
            Self::Plain(file) => file,
            Self::Compressed(file) => file,
        }
    }

    fn finish(self) -> io::Result<Temporary> {
        let file = match self {
            Self::Plain(file) => file,
            Self::Compressed(file) => file.finish()?,
        };
        file.into_inner().map_err(io::IntoInnerError::into_error)
    }
}

impl AtomicFile {
    /// Starts a file that will be at `path`. An existing file there will be replaced.
    ///
    /// # Errors
    /// If the directory does not exist or cannot be written, or `path` is a directory or device.
    pub fn create(path: &Path) -> Result<Self, WriteError> {
        let fail = |cause| WriteError::new(path, cause);
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let existing = fs::metadata(&target).ok();
        if existing.as_ref().is_some_and(|existing| !existing.is_file()) {
            return Err(fail(io::Error::new(
                io::ErrorKind::InvalidInput,
                "it is not a regular file",
            )));
        }
        let directory = match target.parent() {
            Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
            Some(parent) => parent,
            None => {
                return Err(fail(io::Error::new(
                    io::ErrorKind::InvalidInput,
                    "it has no file name",
                )));
            }
        };
        let permissions = existing.map(|existing| existing.permissions());
        let file = Temporary::create(directory, permissions)
            .map_err(|error| fail(in_words(directory, error)))?;
        let file = BufWriter::with_capacity(1 << 16, file);
        let file = match is_compressed(path) {
            true => Sink::Compressed(GzEncoder::new(file, Compression::default())),
            false => Sink::Plain(file),
        };
        Ok(Self { path: path.to_owned(), target, file })
    }

    /// The path the file will have.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Finishes the file and puts it in place.
    ///
    /// # Errors
    /// If the last data cannot be written or the file cannot be renamed; nothing is left behind then.
    pub fn commit(self) -> Result<(), WriteError> {
        let Self { path, target, file } = self;
        let file = file.finish().map_err(|error| WriteError::new(&path, error))?;
        file.persist(&target).map_err(|error| WriteError::new(&path, error))
    }

    fn named(&self, error: &io::Error) -> io::Error {
        io::Error::new(error.kind(), format!("cannot write {}: {error}", self.path.display()))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        self.file.writer().write(data).map_err(|error| self.named(&error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.writer().flush().map_err(|error| self.named(&error))
    }
}

/// The system's error without the name of the temporary file, which tells the user nothing.
fn in_words(directory: &Path, error: io::Error) -> io::Error {
    let kind = error.kind();
    let what = match kind {
        // Such as in /proc: it is there, and takes no files.
        io::ErrorKind::NotFound if directory.is_dir() => "the directory takes no new files",
        io::ErrorKind::NotFound => "the directory does not exist",
        io::ErrorKind::NotADirectory => "its directory is a file",
        io::ErrorKind::PermissionDenied => "the directory cannot be written",
        _ => return error,
    };
    io::Error::new(kind, what)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(directory: &Path) -> usize {
        fs::read_dir(directory).unwrap().count()
    }

    #[test]
    fn a_commit_replaces_the_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("map.obj");
        fs::write(&path, "old").unwrap();
        let mut file = AtomicFile::create(&path).unwrap();
        assert_eq!(file.path(), path);
        file.write_all(b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        file.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(entries(directory.path()), 1);
    }

    #[test]
    fn without_commit_nothing_is_left() {
        let directory = tempfile::tempdir().unwrap();
        let mut file = AtomicFile::create(&directory.path().join("map.obj")).unwrap();
        file.write_all(b"half").unwrap();
        drop(file);
        assert_eq!(entries(directory.path()), 0);
    }

    #[test]
    fn a_name_in_gz_compresses() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.obj.gz");
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".repeat(50) + "f 1 2 3\n";
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(text.as_bytes()).unwrap();
        file.flush().unwrap();
        file.commit().unwrap();
        assert!(fs::metadata(&path).unwrap().len() < 200);
        assert_eq!(crate::read_mesh(&path).unwrap().positions.len(), 150);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_directory_that_takes_no_files_is_not_said_to_be_missing() {
        let message = AtomicFile::create(Path::new("/proc/map.obj")).unwrap_err().to_string();
        assert_eq!(message, "cannot write /proc/map.obj: the directory takes no new files");
    }

    #[test]
    fn impossible_places_are_named() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("none").join("map.obj");
        let message = AtomicFile::create(&path).unwrap_err().to_string();
        assert_eq!(
            message,
            format!("cannot write {}: the directory does not exist", path.display())
        );
        let message = AtomicFile::create(directory.path()).unwrap_err().to_string();
        assert!(message.ends_with("it is not a regular file"), "{message}");
        assert_eq!(entries(directory.path()), 0);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let (path, link) = (directory.path().join("map.obj"), directory.path().join("link.obj"));
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        AtomicFile::create(&link).unwrap().commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }
}
