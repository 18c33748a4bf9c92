//! Writes the published schemas: `cargo run -p seamstress --features schema --example schemas docs/schema`.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args_os().nth(1).ok_or("usage: schemas FOLDER")?);
    fs::create_dir_all(&folder)?;
    for (name, schema) in seamstress::schemas() {
        let text = serde_json::to_string_pretty(&schema)? + "\n";
        fs::write(folder.join(format!("{name}.json")), text)?;
    }
    Ok(())
}
