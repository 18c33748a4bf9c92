//! A surface of any kind has a certified map, or a typed error that is no fault of this program.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress::{ErrorKind, MapOptions, Surface};
use seamstress_fuzz::Bytes;

fuzz_target!(|data: &[u8]| {
    let soup = Bytes(data).surface();
    let Ok(surface) = Surface::from_polygons(&soup.positions, &soup.faces) else { return };
    match surface.parametrize(&MapOptions::default()) {
        Ok(map) => assert_eq!(map.certificate().faces, surface.faces().len()),
        Err(error) => assert_ne!(error.kind(), ErrorKind::Internal, "{error}"),
    }
});
