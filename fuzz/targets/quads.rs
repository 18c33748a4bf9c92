//! Quads of any kind are certified or refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress_certify::Quads;
use seamstress_fuzz::Bytes;

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let seed = u64::from(bytes.byte());
    let mut soup = seamstress_testkit::random_quads(bytes.below(3) as u32, bytes.below(12), seed);
    let surface = bytes.surface();
    for _ in 0..bytes.byte() % 6 {
        let (quad, corner) = (bytes.below(soup.quads.len()), bytes.below(4));
        soup.quads[quad][corner] = bytes.below(soup.positions.len() + 1) as u32;
    }
    let sources: Vec<u32> =
        soup.positions.iter().map(|_| bytes.below(surface.faces.len() + 1) as u32).collect();
    let quads = Quads {
        quads: &soup.quads,
        sources: &sources,
        n_vertices: surface.positions.len(),
        faces: &surface.faces,
        is_trimmed: bytes.byte() % 2 == 0,
    };
    if let Ok(found) = quads.check() {
        assert_eq!(found.quads, soup.quads.len());
    }
    let _ = quads.agree_with(&[1; 8], bytes.coordinate());
});
