use seamstress::{Features, MapOptions, QuadOptions, Surface};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let surface = Surface::read("samples/bracket.obj")?;

    // Certified, or an error that names the stage and the elements.
    let map = surface.parametrize(&MapOptions::default())?;
    map.write("bracket_map.obj")?;
    println!("{} cones, tau {:.3}", map.cones().len(), map.report().distortion.tau);

    // Chains of quad edges follow the creases.
    let options = QuadOptions::count(1500).features(Features::angle(40.0));
    surface.quad_mesh(&options)?.write("bracket_quads.obj")?;

    // Any program's map: the certificate, or every violation.
    let certificate = surface.certify(map.uvs(), map.face_uvs())?;
    println!("seams fit to {:e} edge lengths", certificate.seam_residual);
    Ok(())
}
