//! Generated meshes of every kind: a certified map, or an error that says why not.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test, with helpers")]

use seamstress::{ErrorKind, MapOptions, Surface};
use seamstress_testkit::family;

/// Maps of those of some numbers: how many are certified, of how many.
fn certified(numbers: impl Iterator<Item = u64>) -> (usize, usize) {
    let (mut certified, mut all) = (0, 0);
    for number in numbers {
        let (name, soup) = family(number);
        let surface = Surface::from_triangles(&soup.positions, &soup.faces).unwrap();
        all += 1;
        match surface.parametrize(&MapOptions::default()) {
            Ok(map) => {
                assert_eq!(map.certificate().faces, soup.faces.len(), "{name}");
                surface.certify(map.uvs(), map.face_uvs()).unwrap();
                certified += 1;
            }
            Err(error) => assert_ne!(error.kind(), ErrorKind::Internal, "{name}: {error}"),
        }
    }
    (certified, all)
}

#[test]
fn two_of_each_kind_have_maps() {
    let (certified, all) = certified((0..500).step_by(27));
    assert_eq!((certified, all), (19, 19));
}

#[test]
#[ignore = "about half a minute of computation"]
fn of_five_hundred_at_least_98_per_cent_have_maps() {
    let (certified, all) = certified(0..500);
    assert_eq!(all, 500);
    assert!(certified >= 490, "{certified} of {all}");
}
