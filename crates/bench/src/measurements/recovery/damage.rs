//! What is done to a good map.

use seamstress_mesh::{Face, Halfedge, HalfedgeData, TriMesh};
use seamstress_parametrize::consistency::lifted_angles;
use seamstress_testkit::Rng;
use std::f64::consts::{FRAC_PI_2, PI};

/// Share of the seams whose matching is changed by one.
const WRONG_SEAMS: f64 = 1e-3;
/// Noise on corner angles, quarters to either side.
const NOISE: f64 = 0.2;
/// Share of the vertices dragged out of place, and how far, in mean UV edges.
const DRAGGED: f64 = 1e-2;
const DRAG: f64 = 2.0;

/// A kind of damage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Damage {
    /// Matchings of 0.1 % of the seams, one at least, changed by one up or down
    Matchings,
    /// Noise of 0.2 quarters to either side on all corner angles
    Angles,
    /// 1 % of the vertices, one at least, dragged by two edge lengths in the plane: foldovers
    Foldovers,
    /// The Poisson layout of a smooth cross field in place of the good map, with the foldovers it has
    Field,
    /// Every matching rounded at once, to stay close to the angles of the surface
    Naive,
}

impl Damage {
    pub(super) const ALL: [Damage; 5] =
        [Damage::Matchings, Damage::Angles, Damage::Foldovers, Damage::Field, Damage::Naive];
}

impl std::fmt::Display for Damage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Damage::Matchings => "matchings",
            Damage::Angles => "angles",
            Damage::Foldovers => "foldovers",
            Damage::Field => "field",
            Damage::Naive => "naive",
        })
    }
}

/// Changes some matchings by one, up or down.
pub(super) fn wrong_matchings(matchings: &mut [i32], rng: &mut Rng) {
    if matchings.is_empty() {
        return;
    }
    let count = ((WRONG_SEAMS * matchings.len() as f64).round() as usize).max(1);
    for _ in 0..count {
        let seam = rng.below(matchings.len());
        matchings[seam] += if rng.unit() < 0.5 { 1 } else { -1 };
    }
}

/// Adds noise to all angles; they still sum to a half turn in every triangle.
pub(super) fn noisy_angles(angles: &HalfedgeData<f64>, rng: &mut Rng) -> HalfedgeData<f64> {
    let mut noisy: Vec<f64> =
        angles.iter().map(|a| a + NOISE * FRAC_PI_2 * (2.0 * rng.unit() - 1.0)).collect();
    for triangle in noisy.chunks_exact_mut(3) {
        let rest = (PI - triangle.iter().sum::<f64>()) / 3.0;
        triangle.iter_mut().for_each(|a| *a += rest);
    }
    HalfedgeData(noisy)
}

/// Drags some inner vertices away, all corners of each as its seams turn them; the angles of the broken
/// map, and how many triangles it flips.
pub(super) fn folded_angles(
    mesh: &TriMesh,
    corner_uvs: &[[f64; 2]],
    rng: &mut Rng,
) -> (HalfedgeData<f64>, usize) {
    let mut uvs = corner_uvs.to_vec();
    let mean = mesh.halfedges().map(|h| edge(&uvs, h)).map(|e| e[0].hypot(e[1])).sum::<f64>()
        / mesh.n_halfedges() as f64;
    let count = ((DRAGGED * mesh.n_vertices() as f64).round() as usize).max(1);
    for _ in 0..count {
        let v = seamstress_mesh::Vertex(rng.below(mesh.n_vertices()) as u32);
        let fan: Vec<_> = mesh.outgoing(v).collect();
        // Only where no seam passes: all corners of the vertex at one place.
        if mesh.is_boundary(v)
            || fan.is_empty()
            || fan.iter().any(|h| uvs[h.at()] != uvs[fan[0].at()])
        {
            continue;
        }
        let [x, y, _] = rng.in_ball();
        for h in fan {
            let uv = &mut uvs[h.at()];
            *uv = [uv[0] + DRAG * mean * x, uv[1] + DRAG * mean * y];
        }
    }
    (lifted_angles(mesh, &uvs), count_flips(mesh, &uvs))
}

/// How many triangles are flipped or collapsed.
pub(super) fn count_flips(mesh: &TriMesh, uvs: &[[f64; 2]]) -> usize {
    let flipped = |f: &Face| {
        let [a, b, _] = f.halfedges().map(|h| edge(uvs, h));
        a[0] * b[1] - a[1] * b[0] <= 0.0
    };
    mesh.faces().filter(flipped).count()
}

/// The image of a half-edge.
fn edge(uvs: &[[f64; 2]], h: Halfedge) -> [f64; 2] {
    let (a, b) = (uvs[h.at()], uvs[h.next().at()]);
    [b[0] - a[0], b[1] - a[1]]
}
