//! Quads of any integer map, spoiled or not, are a manifold, or there is a typed error.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress::{ErrorKind, ExtractionOptions, Features, Surface};
use seamstress_fuzz::Bytes;
use seamstress_testkit::{random_voxels, squares};

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let seed = u64::from(bytes.byte());
    let side = 1 + bytes.below(3) as u32;
    let mut map =
        squares(&random_voxels(1 + bytes.below(6), seed), side).with_random_charts(9, seed);
    if bytes.byte() % 2 == 0 {
        map = map.with_random_points(seed).with_moved_vertices(0.5, seed);
    }
    for _ in 0..bytes.byte() % 8 {
        let corner = bytes.below(map.corner_uvs.len());
        map.corner_uvs[corner][bytes.below(2)] = bytes.coordinate();
    }
    let Ok(surface) = Surface::from_polygons(&map.soup.positions, &map.soup.faces) else { return };
    let face_uvs: Vec<[u32; 3]> =
        (0..map.soup.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let options = ExtractionOptions::default();
    match surface.extract_quads(&map.corner_uvs, &face_uvs, &Features::none(), &options) {
        Ok(quads) => assert!(quads.report().quads.is_manifold),
        Err(error) => assert_ne!(error.kind(), ErrorKind::Internal, "{error}"),
    }
});
