//! Triangles with whatever defects are a mesh or have faults that are named, also after repair.
#![no_main]

use libfuzzer_sys::fuzz_target;
use seamstress_fuzz::Bytes;
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::{Severity, TriangleSoup, check, repair};

/// A soup without an error among its faults is a mesh.
fn judge(soup: &TriangleSoup) {
    if check(soup).faults.iter().all(|fault| fault.severity() != Severity::Error) {
        assert!(TriMesh::from_faces(soup.positions.len(), &soup.faces).is_ok());
    }
}

fuzz_target!(|data: &[u8]| {
    let soup = Bytes(data).surface();
    judge(&soup);
    judge(&repair(soup).soup);
});
