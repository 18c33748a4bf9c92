//! Temporary files, where the system has files.

use std::fs;
use std::io;
use std::path::Path;

#[cfg(not(target_family = "wasm"))]
pub(crate) use with_files::Temporary;
#[cfg(target_family = "wasm")]
pub(crate) use without_files::Temporary;

#[cfg(not(target_family = "wasm"))]
mod with_files {
    use super::{Path, fs, io};
    use std::io::Write;

    /// A file that vanishes unless it is put in place.
    #[derive(Debug)]
    pub(crate) struct Temporary(tempfile::NamedTempFile);

    impl Temporary {
        /// Starts one in a directory, with the permissions of new files, or these.
        pub(crate) fn create(
            directory: &Path,
            permissions: Option<fs::Permissions>,
        ) -> io::Result<Self> {
            let mut builder = tempfile::Builder::new();
            builder.prefix(".seamstress-").suffix(".tmp");
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                // As for any new file; the process's mask applies.
                builder.permissions(fs::Permissions::from_mode(0o666));
            }
            let file = builder.tempfile_in(directory)?;
            if let Some(permissions) = permissions {
                file.as_file().set_permissions(permissions)?;
            }
            Ok(Self(file))
        }

        /// Puts it in place.
        pub(crate) fn persist(self, path: &Path) -> io::Result<()> {
            self.0.persist(path).map(|_| ()).map_err(|error| error.error)
        }
    }

    impl Write for Temporary {
        fn write(&mut self, data: &[u8]) -> io::Result<usize> {
            self.0.write(data)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.flush()
        }
    }
}

#[cfg(target_family = "wasm")]
mod without_files {
    use super::{Path, fs, io};
    use std::io::Write;

    /// There is none.
    #[derive(Debug)]
    pub(crate) enum Temporary {}

    impl Temporary {
        pub(crate) fn create(_: &Path, _: Option<fs::Permissions>) -> io::Result<Self> {
            Err(io::Error::new(io::ErrorKind::Unsupported, "there are no files here"))
        }

        pub(crate) fn persist(self, _: &Path) -> io::Result<()> {
            match self {}
        }
    }

    impl Write for Temporary {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            match *self {}
        }

        fn flush(&mut self) -> io::Result<()> {
            match *self {}
        }
    }
}
