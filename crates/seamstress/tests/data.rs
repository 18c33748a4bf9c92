//! What must be true of the maps and quads of every mesh of `tests/data`, with any features of this crate.
#![allow(clippy::unwrap_used)]

use seamstress::{Context, MapOptions, QuadMesh, QuadOptions, SeamlessMap, Surface};
use seamstress_testkit::{DataMesh, data_meshes};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Most tau and most cones: a tenth and a quarter above what the method is known to reach.
const BOUNDS: [(&str, f64, usize); 12] = [
    ("plate_with_holes.obj", 1.27, 50),
    ("gear.obj", 1.68, 70),
    ("l_beam.stl", 1.01, 12),
    ("angle_bracket.obj", 1.26, 40),
    ("shell.obj", 1.34, 2),
    ("thin_plate.obj", 1.27, 20),
    ("needles.obj", 1.37, 10),
    ("trefoil.ply", 1.32, 23),
    ("linked_rings.off", 1.38, 43),
    ("blob.obj", 1.4, 10),
    ("cube_frame.off", 1.38, 38),
    ("goldberg.obj", 1.43, 10),
];

/// Quads asked for, and the factor that their number may be off: the grid gets finer where cones are close.
const QUADS: (u32, f64) = (500, 3.0);

fn surface(mesh: &DataMesh, threads: usize) -> Surface {
    let surface = Surface::from_polygons(&mesh.soup.positions, &mesh.soup.polygons).unwrap();
    surface.with_context(Context::default().threads(threads))
}

fn mapped(mesh: &DataMesh, threads: usize) -> SeamlessMap {
    surface(mesh, threads).parametrize(&MapOptions::default()).unwrap()
}

fn quads(mesh: &DataMesh) -> QuadMesh {
    surface(mesh, 1).quad_mesh(&QuadOptions::count(QUADS.0)).unwrap()
}

#[test]
fn maps_are_certified_have_the_right_cones_and_little_distortion() {
    for mesh in data_meshes() {
        let map = mapped(&mesh, 0);
        let file = mesh.file;
        let certificate = map.surface().certify(map.uvs(), map.face_uvs()).unwrap();
        assert_eq!(certificate, *map.certificate(), "{file}");
        // Gauss and Bonnet, in quarters of a turn.
        let chi = mesh.euler_characteristic();
        assert_eq!(certificate.euler_characteristic, chi, "{file}");
        assert!((certificate.index_sum - 4.0 * chi as f64).abs() < 1e-9, "{file}");
        if mesh.boundary_loops == 0 {
            let sum: i64 = map.cones().iter().map(|cone| i64::from(cone.index)).sum();
            assert_eq!(sum, 4 * chi, "{file}");
        }
        assert!(map.cones().iter().all(|cone| cone.index <= 3), "{file}: a cone of no angle");
        let report = map.report();
        let genus: usize = report.components.iter().map(|c| c.genus as usize).sum();
        let loops: usize = report.components.iter().map(|c| c.boundary_loops).sum();
        let topology = [report.components.len(), genus, loops];
        assert_eq!(topology, [mesh.components, mesh.genus, mesh.boundary_loops], "{file}");
        let (_, most_tau, most_cones) =
            BOUNDS.into_iter().find(|bounds| bounds.0 == file).expect("bounds for every mesh");
        let (tau, cones) = (report.distortion.tau, map.cones().len());
        assert!((1.0 - 1e-12..most_tau).contains(&tau), "{file}: tau {tau}");
        assert!(cones <= most_cones, "{file}: {cones} cones");
    }
}

#[test]
fn quads_are_manifold_and_as_many_as_asked_for() {
    for mesh in data_meshes() {
        let quads = quads(&mesh);
        let file = mesh.file;
        let mut sides = BTreeMap::new();
        for quad in quads.quads() {
            for k in 0..4 {
                *sides.entry((quad[k], quad[(k + 1) % 4])).or_insert(0) += 1;
            }
        }
        assert!(sides.values().all(|&count| count == 1), "{file}: a side with two quads");
        let has_twin = |&(a, b): &(u32, u32)| sides.contains_key(&(b, a));
        let paired = sides.keys().filter(|side| has_twin(side)).count();
        let rim = sides.len() - paired;
        assert_eq!(rim > 0, mesh.boundary_loops > 0, "{file}: {rim} sides on a rim");
        let (vertices, edges) = (quads.positions().len() as i64, (paired / 2 + rim) as i64);
        let chi = vertices - edges + quads.quads().len() as i64;
        if mesh.boundary_loops == 0 {
            assert_eq!(chi, mesh.euler_characteristic(), "{file}");
        }
        let ratio = quads.quads().len() as f64 / f64::from(QUADS.0);
        assert!((1.0 / QUADS.1..QUADS.1).contains(&ratio), "{file}: {} quads", quads.quads().len());
    }
}

/// A number that changes with any bit.
fn digest(values: impl Iterator<Item = f64>) -> u64 {
    // FNV-1a (Fowler, Noll and Vo).
    let bytes = values.flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The same bits on any number of threads; `SEAMSTRESS_DIGESTS=FILE` leaves them in a file, to be compared with those of
/// a build with other features.
#[test]
fn maps_do_not_depend_on_threads() {
    let mut lines = String::new();
    for mesh in data_meshes() {
        let [one, three] = [1, 3].map(|threads| mapped(&mesh, threads));
        assert_eq!(one.corner_uvs(), three.corner_uvs(), "{}", mesh.file);
        let [map, quads] = [
            digest(one.corner_uvs().iter().flatten().copied()),
            digest(quads(&mesh).positions().iter().flatten().copied()),
        ];
        writeln!(lines, "{map:016x} {quads:016x} {}", mesh.file).unwrap();
    }
    if let Some(file) = std::env::var_os("SEAMSTRESS_DIGESTS") {
        std::fs::write(file, lines).unwrap();
    }
}
