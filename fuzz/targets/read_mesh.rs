//! Any bytes are a mesh of valid indices and finite coordinates, or an error; what was read can be written and read.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress_io::{Format, Polymesh, parse_mesh};

const FORMATS: [Option<Format>; 6] = [
    None,
    Some(Format::Obj),
    Some(Format::Off),
    Some(Format::Ply),
    Some(Format::Stl),
    Some(Format::Gltf),
];

fuzz_target!(|data: &[u8]| {
    for claimed in FORMATS {
        let Ok(mesh) = parse_mesh(data, claimed, "fuzzed") else { continue };
        let n = mesh.positions.len();
        let polygons: Vec<&[u32]> =
            (0..mesh.polygons.len()).map(|k| mesh.polygons.get(k)).collect();
        assert!(polygons.iter().copied().flatten().all(|&v| (v as usize) < n));
        assert!(mesh.positions.as_flattened().iter().all(|x| x.is_finite()));
        let triangle = |polygon: &&[u32]| <[u32; 3]>::try_from(*polygon).ok();
        let triangles: Vec<[u32; 3]> = polygons.iter().filter_map(triangle).collect();
        let written = Polymesh {
            positions: &mesh.positions,
            polygons: &triangles,
            attributes: &seamstress_io::attributes::Attributes::default(),
            comments: &[],
        };
        let mut text = Vec::new();
        written.write(&mut text, Format::Obj).unwrap();
        if !triangles.is_empty() {
            let again = parse_mesh(&text, Some(Format::Obj), "written").unwrap();
            assert_eq!(again.positions, mesh.positions);
            assert_eq!(again.polygons.len(), triangles.len());
        }
    }
});
