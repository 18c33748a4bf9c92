//! Output files: checked before the work, written after it, put in place together.

use crate::failure::Failure;
use crate::text;
use seamstress::{AtomicFile, Error, Output};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Kind {
    Map,
    Quads,
    Report,
    Page,
    Comparison,
    Cones,
    Field,
    Matching,
    Picture,
}

/// A file to be written.
#[derive(Debug, Clone, serde::Serialize)]
pub(crate) struct Target {
    pub(crate) kind: Kind,
    #[serde(serialize_with = "as_text")]
    pub(crate) path: PathBuf,
}

impl Target {
    pub(crate) fn new(kind: Kind, path: &Path) -> Self {
        Self { kind, path: path.to_owned() }
    }

    /// The name must not promise a format that is not written.
    fn refuse_other_format(&self) -> Result<(), Failure> {
        let output = match self.kind {
            Kind::Map => Output::Map,
            Kind::Quads => Output::Quads,
            Kind::Picture => Output::Picture,
            Kind::Report
            | Kind::Page
            | Kind::Comparison
            | Kind::Cones
            | Kind::Field
            | Kind::Matching => {
                return Ok(());
            }
        };
        Ok(output.check_name(&self.path)?)
    }
}

/// Whether a path stands for standard input or standard output.
pub(crate) fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn as_text<S: serde::Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

/// All files to be written: the map last, since it says that the rest is there.
#[derive(Debug)]
pub(crate) struct Plan {
    pub(crate) targets: Vec<Target>,
    /// The folder that may have to be made.
    folder: Option<PathBuf>,
}

impl Plan {
    /// Plans the outputs of a run: files in the order they are put in place, and the folder that some
    /// of them are in.
    ///
    /// # Errors
    /// If an output would replace an input or another output, or cannot be written.
    pub(crate) fn new(
        inputs: &[&Path],
        folder: Option<&Path>,
        targets: Vec<Target>,
    ) -> Result<Self, Failure> {
        let plan = Self { targets, folder: folder.map(Path::to_owned) };
        for target in &plan.targets {
            target.refuse_other_format()?;
        }
        plan.refuse_clashes(inputs)?;
        plan.probe()?;
        Ok(plan)
    }

    /// Whether a result goes to standard output.
    pub(crate) fn writes_to_standard_output(&self) -> bool {
        self.targets.iter().any(|target| is_standard_stream(&target.path))
    }

    fn refuse_clashes(&self, inputs: &[&Path]) -> Result<(), Failure> {
        // Standard input and standard output have one name and are two things.
        let files = inputs.iter().filter(|input| !is_standard_stream(input));
        let input_ids: Vec<PathBuf> = files.map(|input| identity(input)).collect();
        let mut seen: Vec<PathBuf> = self.folder.iter().map(|folder| identity(folder)).collect();
        for Target { path, .. } in &self.targets {
            let id = identity(path);
            let shown = path.display();
            if input_ids.contains(&id) {
                let text = format!("{shown} is an input; write the output to another file");
                return Err(Failure::Usage(text));
            }
            if seen.contains(&id) {
                let text = format!("two outputs have the path {shown}; give each its own");
                return Err(Failure::Usage(text));
            }
            seen.push(id);
        }
        Ok(())
    }

    /// Tries every output with a file that vanishes again.
    fn probe(&self) -> Result<(), Failure> {
        let folder = self.folder.as_deref().filter(|folder| !folder.exists());
        if let Some(folder) = folder {
            let base = missing(folder).last().copied().unwrap_or(folder);
            // The name is that of the folder to be made, which is not there.
            create(base)?;
        }
        let files = self.targets.iter().filter(|target| !is_standard_stream(&target.path));
        for Target { path, .. } in files {
            let is_in_new_folder =
                folder.is_some_and(|folder| identity(parent(path)) == identity(folder));
            if !is_in_new_folder {
                create(path)?;
            }
        }
        Ok(())
    }

    /// Starts writing; makes the folder if it does not exist.
    pub(crate) fn begin(&self) -> Result<Batch, Failure> {
        let mut batch = Batch::default();
        if let Some(folder) = &self.folder {
            batch.make(folder)?;
        }
        Ok(batch)
    }
}

/// The same for all paths to a file, whether it exists or not.
fn identity(path: &Path) -> PathBuf {
    let with_parent = || {
        let parent = fs::canonicalize(parent(path)).ok()?;
        Some(parent.join(path.file_name()?))
    };
    fs::canonicalize(path)
        .ok()
        .or_else(with_parent)
        .or_else(|| std::path::absolute(path).ok())
        .unwrap_or_else(|| path.to_owned())
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => path,
    }
}

fn create(path: &Path) -> Result<AtomicFile, Failure> {
    Ok(AtomicFile::create(path).map_err(Error::from)?)
}

/// The folders that are missing on the way to one, innermost first.
fn missing(folder: &Path) -> Vec<&Path> {
    folder.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists()).collect()
}

/// Files being written. Without a commit nothing stays.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    files: Vec<AtomicFile>,
    /// What goes to standard output.
    standard_output: Vec<u8>,
    /// Folders and files made, in order, to be removed again.
    made_folders: Vec<PathBuf>,
    made_files: Vec<PathBuf>,
}

impl Batch {
    fn make(&mut self, folder: &Path) -> Result<(), Failure> {
        for path in missing(folder).into_iter().rev() {
            fs::create_dir(path).map_err(|cause| {
                Failure::Usage(format!("cannot write {}: {cause}", path.display()))
            })?;
            self.made_folders.push(path.to_owned());
        }
        Ok(())
    }

    /// Writes a file, out of sight as yet.
    pub(crate) fn write(
        &mut self,
        path: &Path,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        if is_standard_stream(path) {
            let written = content(&mut self.standard_output);
            return written.map_err(|error| Failure::Usage(error.to_string()));
        }
        let mut file = create(path)?;
        content(&mut file)
            .and_then(|()| file.flush())
            .map_err(|error| Failure::Usage(error.to_string()))?;
        self.files.push(file);
        Ok(())
    }

    /// Puts all files in place, in the order they were written, and then writes to standard output.
    ///
    /// # Errors
    /// If one cannot be put in place; the new ones before it are removed then.
    pub(crate) fn commit(mut self) -> Result<(), Failure> {
        for file in std::mem::take(&mut self.files) {
            let path = file.path().to_owned();
            let is_new = !path.exists();
            file.commit().map_err(Error::from)?;
            if is_new {
                self.made_files.push(path);
            }
        }
        text::write(&self.standard_output)
            .map_err(|cause| Failure::Usage(format!("cannot write to standard output: {cause}")))?;
        self.made_files.clear();
        self.made_folders.clear();
        Ok(())
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        // Temporary files go before the folder they are in.
        self.files.clear();
        for path in &self.made_files {
            let _ = fs::remove_file(path);
        }
        for path in self.made_folders.iter().rev() {
            let _ = fs::remove_dir(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(batch: &mut Batch, path: &Path) {
        let written = batch.write(path, |file| file.write_all(b"new"));
        assert!(written.is_ok(), "{written:?}");
    }

    fn names(folder: &Path) -> Vec<String> {
        let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let names = fs::read_dir(folder).unwrap().map(name);
        names.map(|name| name.to_string_lossy().into()).collect()
    }

    #[test]
    fn when_the_last_file_fails_nothing_new_stays() {
        let folder = tempfile::tempdir().unwrap();
        let [first, map] = ["new/deep/first", "map"].map(|name| folder.path().join(name));
        let mut batch = Batch::default();
        batch.make(parent(&first)).unwrap();
        write(&mut batch, &first);
        write(&mut batch, &map);
        // A folder cannot be replaced by a file.
        fs::create_dir(&map).unwrap();
        assert!(batch.commit().is_err());
        assert_eq!(names(folder.path()), ["map"]);
    }

    #[test]
    fn a_commit_puts_all_in_place() {
        let folder = tempfile::tempdir().unwrap();
        let [first, map] = ["new/first", "map"].map(|name| folder.path().join(name));
        let mut batch = Batch::default();
        batch.make(parent(&first)).unwrap();
        write(&mut batch, &first);
        write(&mut batch, &map);
        assert!(!map.exists());
        batch.commit().unwrap();
        assert!(first.is_file() && map.is_file());
    }

    #[test]
    fn paths_to_one_file_are_the_same() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("a")).unwrap();
        let [x, y, z] = ["b", "a/../b", "a/b"].map(|name| identity(&folder.path().join(name)));
        assert_eq!(x, y);
        assert_ne!(x, z);
    }
}
