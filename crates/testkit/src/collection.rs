//! An optional collection of real meshes, good and broken, that cannot be part of the repository.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Names the folder of the collection; by default it is `../shared/meshes` beside the repository.
pub const FOLDER: &str = "SEAMSTRESS_MESHES";

/// When set to 1, tests fail that find no collection, or not their file in it.
pub const REQUIRED: &str = "SEAMSTRESS_REQUIRE_MESHES";

/// A file or folder of the collection, by its path in it; `""` is the collection itself.
///
/// `None` where it is missing, which is written to standard error: the test is to be skipped.
///
/// # Panics
/// Where it is missing and [`REQUIRED`] is 1.
#[must_use]
#[track_caller]
pub fn in_collection(path: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/meshes");
    let folder = std::env::var_os(FOLDER).map_or(beside, PathBuf::from);
    let required = std::env::var_os(REQUIRED).is_some_and(|value| value == "1");
    let found = look_up(&folder, path, required);
    if found.is_none() {
        // Past the test harness, which keeps back what tests print that pass.
        let place = std::panic::Location::caller();
        let folder = folder.display();
        let _ = writeln!(std::io::stderr(), "skipped: no {folder}/{path} ({place})");
    }
    found
}

fn look_up(folder: &Path, path: &str, required: bool) -> Option<PathBuf> {
    let file = folder.join(path);
    assert!(file.exists() || !required, "{} is missing, and {REQUIRED} is 1", file.display());
    file.exists().then_some(file)
}

#[cfg(test)]
mod tests {
    use super::look_up;
    use std::path::Path;

    #[test]
    fn what_is_missing_is_skipped_or_fails() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        assert_eq!(look_up(here, "Cargo.toml", true), Some(here.join("Cargo.toml")));
        assert_eq!(look_up(here, "bunny.obj", false), None);
        let failed = std::panic::catch_unwind(|| look_up(here, "bunny.obj", true));
        assert!(failed.is_err());
    }
}
