//! Any polygons are a surface, or have faults that are named.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress::Surface;
use seamstress_fuzz::Bytes;

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let n = bytes.below(16);
    let positions: Vec<[f64; 3]> = (0..n).map(|_| [(); 3].map(|()| bytes.coordinate())).collect();
    if let Err(error) = Surface::from_polygons(&positions, bytes.polygons(n)) {
        assert!(!error.to_string().is_empty());
    }
});
