//! The checker judges any faces and UVs at all, and alike when all of it is turned by a quarter or scaled by a power of
//! two.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress_certify::{Map, Tolerance};
use seamstress_fuzz::Bytes;

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let (n_vertices, faces): (usize, Vec<[u32; 3]>) = match bytes.byte() % 3 {
        0 => {
            let n = 3 + bytes.below(8);
            let face = |polygon: &Vec<u32>| <[u32; 3]>::try_from(polygon.as_slice()).ok();
            (n, bytes.polygons(n).iter().filter_map(face).collect())
        }
        _ => {
            let soup = bytes.surface();
            (soup.positions.len(), soup.faces)
        }
    };
    let n_edges = bytes.below(6);
    let edges: Vec<[u32; 2]> =
        (0..n_edges).map(|_| [(); 2].map(|()| bytes.below(n_vertices + 1) as u32)).collect();
    let uvs: Vec<[f64; 2]> =
        (0..3 * faces.len()).map(|_| [bytes.coordinate(), bytes.coordinate()]).collect();
    let verdict = |uvs: &[[f64; 2]]| {
        let map = Map::new(n_vertices, &faces, uvs).ok()?;
        let _ = map.alignment(&edges, &Tolerance::default());
        let _ = map.integers(&edges, &Tolerance::default());
        let found = map.seamless(&Tolerance::default()).ok()?;
        let matchings: Vec<_> = found.seams.iter().map(|seam| (seam.left, seam.matching)).collect();
        Some((found.cones, matchings, found.certificate.overwound_boundary_vertices))
    };
    let first = verdict(&uvs);
    let turned: Vec<_> = uvs.iter().map(|&[u, v]| [-v, u]).collect();
    assert_eq!(first, verdict(&turned));
    let is_moderate = |x: &f64| *x == 0.0 || (1e-100..1e100).contains(&x.abs());
    if uvs.as_flattened().iter().all(is_moderate) {
        let scaled: Vec<_> = uvs.iter().map(|uv| uv.map(|x| 4096.0 * x)).collect();
        assert_eq!(first, verdict(&scaled));
    }
});
