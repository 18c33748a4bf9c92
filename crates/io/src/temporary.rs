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
    use std::time::Duration;

    const PREFIX: &str = ".seamstress-";
    const SUFFIX: &str = ".tmp";
    /// Age from which a file that nobody has locked is abandoned: between its start and its lock no time to speak of
    /// passes.
    const ABANDONED: Duration = Duration::from_secs(60);

    /// A file that vanishes unless it is put in place.
    ///
    /// It is locked as long as somebody works on it. What a process has left that was killed is removed when the next file
    /// is started in the same directory.
    #[derive(Debug)]
    pub(crate) struct Temporary(tempfile::NamedTempFile);

    impl Temporary {
        /// Starts one in a directory, with the permissions of new files, or these.
        pub(crate) fn create(
            directory: &Path,
            permissions: Option<fs::Permissions>,
        ) -> io::Result<Self> {
            remove_abandoned(directory);
            let mut builder = tempfile::Builder::new();
            builder.prefix(PREFIX).suffix(SUFFIX);
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                // As for any new file; the process's mask applies.
                builder.permissions(fs::Permissions::from_mode(0o666));
            }
            let file = builder.tempfile_in(directory)?;
            // Where files cannot be locked, nobody finds them abandoned.
            let _ = file.as_file().lock();
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
            // The errors of the file itself do not tell its name, which tells the user nothing.
            self.0.as_file().write(data)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.as_file().flush()
        }
    }

    /// Removes temporary files that nobody works on; whatever cannot be removed stays.
    fn remove_abandoned(directory: &Path) {
        let is_ours = |name: &str| name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
            let is_temporary = entry.file_name().to_str().is_some_and(is_ours);
            if is_temporary && is_abandoned(&entry.path()).unwrap_or(false) {
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    fn is_abandoned(path: &Path) -> io::Result<bool> {
        let file = fs::File::open(path)?;
        let age = file.metadata()?.modified()?.elapsed().unwrap_or_default();
        Ok(age > ABANDONED && file.try_lock().is_ok())
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use std::time::SystemTime;

        #[test]
        fn what_is_abandoned_is_removed() {
            let folder = tempfile::tempdir().unwrap();
            let hour_ago = SystemTime::now() - Duration::from_secs(3600);
            let with_age = |name: &str, modified: SystemTime| {
                let file = fs::File::create(folder.path().join(name)).unwrap();
                file.set_modified(modified).unwrap();
                file
            };
            with_age(".seamstress-killed.tmp", hour_ago);
            with_age(".seamstress-new.tmp", SystemTime::now());
            with_age("mine.tmp", hour_ago);
            let locked = with_age(".seamstress-at-work.tmp", hour_ago);
            locked.lock().unwrap();
            let file = Temporary::create(folder.path(), None).unwrap();
            file.0.as_file().set_modified(hour_ago).unwrap();
            drop(Temporary::create(folder.path(), None).unwrap());
            file.persist(&folder.path().join("done")).unwrap();
            let entries = fs::read_dir(folder.path()).unwrap();
            let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
            names.sort();
            assert_eq!(
                names,
                [".seamstress-at-work.tmp", ".seamstress-new.tmp", "done", "mine.tmp"]
            );
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
