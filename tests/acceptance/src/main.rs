//! From a file to a certified map and quads, through the facade alone.

use seamstress::{Features, MapOptions, QuadOptions, Surface};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1);
    let surface = Surface::read(args.next().unwrap())?;
    let map = surface.parametrize(&MapOptions::default())?;
    map.write("map.obj")?;
    assert_eq!(map.face_uvs().len(), surface.faces().len());
    surface.certify(map.uvs(), map.face_uvs())?;
    let quads =
        surface.quad_mesh(&QuadOptions::count(1500).features(Features::angle(40.0)))?;
    quads.write("quads.obj")?;
    println!("{}", serde_json::to_string_pretty(map.report())?);
    println!("{} quads", quads.quads().len());
    let (p, f) = (surface.positions().to_vec(), surface.faces().to_vec());
    let same = Surface::from_triangles(&p, &f)?.parametrize(&MapOptions::default())?;
    assert_eq!(same.uvs(), map.uvs());
    Ok(())
}
