//! Writes the parts of the test kit as OBJ files into a folder.

use std::fmt::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: parts FOLDER")?;
    std::fs::create_dir_all(&folder)?;
    for (name, part) in seamstress_testkit::parts() {
        let mut text = String::new();
        for [x, y, z] in &part.positions {
            writeln!(text, "v {x} {y} {z}")?;
        }
        for face in &part.faces {
            let [a, b, c] = face.map(|v| v + 1);
            writeln!(text, "f {a} {b} {c}")?;
        }
        std::fs::write(format!("{folder}/{name}.obj"), text)?;
    }
    Ok(())
}
