//! The generated family of meshes, as files.

use seamstress_io::attributes::Attributes;
use seamstress_io::{Format, Polymesh};
use seamstress_testkit::family;
use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Write meshes of the generated family as OBJ files
///
/// Parts with fillets, thin walls and holes, organic blobs, scans with noise, terrain, lattices of high genus, castings: the
/// same for everyone, since each is made from its number alone.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The folder, made if it does not exist
    folder: PathBuf,

    /// How many
    #[arg(long, value_name = "N", default_value_t = FAMILY)]
    count: u64,

    /// The number of the first
    #[arg(long, value_name = "N", default_value_t = 0)]
    first: u64,
}

/// Meshes of the family on the pages of results.
pub(crate) const FAMILY: u64 = 500;

/// Writes them.
///
/// # Errors
/// If a file cannot be written.
pub fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    write(&args.folder, args.first, args.count)?;
    Ok(true)
}

pub(crate) fn write(folder: &Path, first: u64, count: u64) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    for number in first..first.saturating_add(count) {
        let (name, soup) = family(number);
        let mesh = Polymesh {
            positions: &soup.positions,
            polygons: &soup.faces,
            attributes: &Attributes::default(),
            comments: &[],
        };
        let file = folder.join(name + ".obj");
        mesh.write(&mut BufWriter::new(File::create(file)?), Format::Obj)?;
    }
    Ok(())
}
