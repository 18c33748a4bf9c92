//! Real meshes against their topology and bounds on distortion, if a collection of them is there.

mod common;

use common::{collection, mapped};
use seamstress_mesh::soup::TriangleSoup;

/// What a mesh must come to.
struct Golden {
    file: &'static str,
    faces: usize,
    /// Components, and genus and boundary loops over all of them.
    topology: (usize, i64, usize),
    /// Most tau and mean symmetric Dirichlet energy: a tenth of tau and half of the excess over 4
    /// above what the method is known to reach.
    tau: f64,
    energy: f64,
    /// Most cones.
    cones: usize,
}

const fn golden(
    file: &'static str,
    faces: usize,
    topology: (usize, i64, usize),
    tau: f64,
    energy: f64,
    cones: usize,
) -> Golden {
    Golden { file, faces, topology, tau, energy, cones }
}

const CASES: [Golden; 15] = [
    golden("flap.obj", 272, (1, 0, 1), 1.01, 4.001, 0),
    golden("halved_scarf.obj", 68, (1, 0, 0), 3.7, 4.95, 30),
    golden("cup_coarse.obj", 424, (1, 0, 0), 1.5, 4.13, 20),
    golden("suzanne.obj", 968, (3, 0, 4), 1.65, 4.19, 110),
    golden("decimated_knight.off", 1000, (1, 0, 0), 1.93, 4.30, 140),
    golden("chipped_torus.obj", 1102, (1, 1, 1), 1.45, 4.12, 20),
    golden("hand_lowres.obj", 1602, (1, 0, 1), 1.5, 4.11, 55),
    golden("chassis_upright.off", 2796, (1, 2, 0), 1.81, 4.54, 140),
    golden("blobby_3cc.off", 3417, (3, 0, 4), 1.47, 4.03, 12),
    golden("block.off", 4272, (1, 3, 0), 1.95, 4.09, 70),
    golden("tray_bottom.stl", 4520, (1, 23, 0), 2.29, 4.12, 280),
    golden("aircraft.obj", 4656, (1, 0, 1), 2.12, 4.09, 80),
    golden("rocker_arm_2500.obj", 5000, (1, 1, 0), 1.55, 4.11, 55),
    golden("retinal.off", 7282, (1, 0, 0), 1.48, 4.08, 55),
    golden("eight.off", 11092, (1, 2, 0), 1.48, 4.06, 36),
];

fn run(case: &Golden, soup: &TriangleSoup) {
    assert_eq!(soup.faces.len(), case.faces);
    let solution = mapped(soup);
    let genus = solution.components.iter().map(|c| c.genus).sum::<i64>();
    let loops = solution.components.iter().map(|c| c.boundary_loops).sum::<usize>();
    assert_eq!((solution.components.len(), genus, loops), case.topology);
    let (d, cones) = (&solution.distortion, solution.map.cones());
    assert!(d.tau <= case.tau, "tau {} above {}", d.tau, case.tau);
    let energy = d.symmetric_dirichlet;
    assert!(energy <= case.energy, "energy {energy} above {}", case.energy);
    assert!(cones.len() <= case.cones, "{} cones, expected {}", cones.len(), case.cones);
    assert!(cones.iter().all(|c| c.index <= 3), "an angle without a quarter");
    // Seams close by the rules of arithmetic, not of optimisation: up to the digits of coordinates, of which an edge that is
    // a millionth of the mesh has few.
    let residual = solution.map.certificate().seam_residual * shortest_edge(soup);
    assert!(residual < 1e-12, "{residual}");
}

/// Length of the shortest edge, in means.
fn shortest_edge(soup: &TriangleSoup) -> f64 {
    let length = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|v| soup.positions[v as usize]);
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    };
    let edges = soup.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let lengths: Vec<f64> = edges.map(length).collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    lengths.iter().copied().fold(f64::INFINITY, f64::min) / mean
}

#[test]
fn real_meshes_have_good_maps() {
    let Some(folder) = collection::folder() else { return };
    let mut ran = 0;
    for case in &CASES {
        let Some(soup) = collection::read(&folder, case.file) else { continue };
        println!("{}", case.file);
        run(case, &soup);
        ran += 1;
    }
    assert!(ran > 0, "{} holds none of the meshes", folder.display());
}
