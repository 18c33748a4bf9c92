//! `seamstress completions` and `seamstress man`: from the same definitions as the help.

use crate::failure::{Failure, Status, print};
use std::fs;
use std::path::{Path, PathBuf};

/// Print the completions of a shell
///
/// For bash: `seamstress completions bash > ~/.local/share/bash-completion/completions/seamstress`.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: clap_complete::Shell,
}

impl CompletionsArgs {
    pub(crate) fn run(&self, mut definition: clap::Command) -> Result<Status, Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut definition, "seamstress", &mut script);
        print(String::from_utf8_lossy(&script).trim_end())?;
        Ok(Status::Done)
    }
}

/// Write the manual pages, one for each command
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct ManArgs {
    /// Write them to this folder, made if it does not exist
    folder: PathBuf,
}

impl ManArgs {
    pub(crate) fn run(&self, definition: clap::Command) -> Result<Status, Failure> {
        let unwritable = |path: &Path, cause: std::io::Error| {
            Failure::Usage(format!("cannot write {}: {cause}", path.display()))
        };
        fs::create_dir_all(&self.folder).map_err(|cause| unwritable(&self.folder, cause))?;
        clap_mangen::generate_to(definition, &self.folder)
            .map_err(|cause| unwritable(&self.folder, cause))?;
        Ok(Status::Done)
    }
}
