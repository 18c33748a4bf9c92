//! `seamstress app`.

mod jobs;
mod server;

use crate::args::after_help;
use crate::command::read_mesh;
use crate::failure::{Failure, Status, print};
use seamstress::SurfaceOptions;
use server::{Mesh, Server};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  seamstress app
  seamstress app bunny.ply
  seamstress app --port 8000 --no-open";

/// Work in a page of your browser: drop a mesh, make quads or a map, look at it, save it
///
/// Serves the page to this machine alone, under an address that cannot be guessed, and does the work itself. Prints the
/// address, opens it in a browser, and ends with Ctrl-C, or when no page has been open for a while. Nothing leaves the
/// machine.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct AppArgs {
    /// A mesh to start with: OBJ, OFF, PLY, STL or glTF
    mesh: Option<PathBuf>,

    /// Serve the page at this port [default: one that is free]
    #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
    port: u16,

    /// Print the address, and open no browser
    #[arg(long)]
    no_open: bool,

    /// End when no page has been open for so many minutes
    #[arg(long, value_name = "MINUTES", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..))]
    idle: u64,
}

impl AppArgs {
    /// Serves until it is stopped.
    pub(crate) fn run(&self) -> Result<Status, Failure> {
        let mesh = self.mesh.as_ref().map(|path| {
            // Whoever names a file that is no mesh wants to know at once.
            read_mesh(path, &SurfaceOptions::default())?;
            let content = fs::read(path).map_err(|cause| unusable(&path.display(), &cause))?;
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into();
            Ok::<_, Failure>(Mesh { name, content })
        });
        let server = Server::start(self.port, mesh.transpose()?)
            .map_err(|cause| unusable(&format!("port {}", self.port), &cause))?;
        let address = server.address();
        print(&format!("{address}\nCtrl-C ends it"))?;
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        // Without a handler Ctrl-C ends the process as well.
        let _ = ctrlc::set_handler(move || stopped.store(true, Ordering::Relaxed));
        if !self.no_open {
            // Where there is no browser, there is the address.
            let _ = open::that_detached(address);
        }
        server.serve(&stop, Duration::from_secs(60 * self.idle));
        Ok(Status::Done)
    }
}

/// Serves the page on a thread of its own for as long as the process lives; its address. For fuzz targets.
#[cfg(fuzzing)]
pub fn serve_forever() -> std::io::Result<String> {
    let server = Server::start(0, None)?;
    let address = server.address();
    std::thread::spawn(move || server.serve(&AtomicBool::new(false), Duration::MAX));
    Ok(address)
}

fn unusable(what: &dyn std::fmt::Display, cause: &dyn std::fmt::Display) -> Failure {
    Failure::Usage(format!("{what} cannot be used: {cause}"))
}
