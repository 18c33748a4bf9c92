//! The cost and quality of consistent matchings.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::{Section, progress};
use crate::process::Clock;
use seamstress_mesh::{HalfedgeData, Metric, TriMesh, components::components};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyError, ConsistencyOptions, Consistent, consistent_cut,
};
use seamstress_parametrize::cut::MatchedCut;
use seamstress_parametrize::cut::{DualTree, curvature_weight};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::progress::Watch;
use seamstress_testkit::{Rng, small_sphere};
use std::error::Error;
use std::ops::ControlFlow;

/// Consistency: the cost and quality of consistent matchings
///
/// Every matching is rounded at once to the integer nearest to the surface's own rotation; all are integer
/// variables. Columns: vertices whose index no triangles can have at first; cones before and after; the norm; the
/// objective after local moves alone, and CPU seconds; after the search with the default budget, and CPU seconds; the
/// lower bound; the gap between objective and bound, as a share of the objective; whether the objective is proven
/// minimal. Then the same for small spheres with random positions, valences and noise on their angles, of which the
/// optimum is known: by how much local moves, and the search, end above it.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Random spheres of 20 vertices for each norm and noise
    #[arg(long, value_name = "N", default_value_t = 100)]
    spheres: u64,
}

/// Noise on the angles of the spheres, radians.
const NOISES: [f64; 3] = [0.0, 0.3, 0.6];
/// Excess over the optimum that counts as none: proofs are good to a part in ten million.
const NONE: f64 = 1e-6;

/// Makes the matchings of every mesh consistent; passes if that always succeeds.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let mut table = Table::new([
        "mesh",
        "triangles",
        "impossible",
        "cones",
        "cones after",
        "norm",
        "local moves",
        "CPU s",
        "search",
        "CPU s",
        "bound",
        "gap",
        "proven",
    ]);
    let failures = args.selection.survey(|subject| {
        let start = vec![subject.name.clone(), subject.mesh.connectivity.n_faces().to_string()];
        for cells in measure_mesh(&subject.mesh)? {
            table.report([start.clone(), cells].concat());
        }
        Ok(())
    })?;
    let spheres = measure_spheres(args.spheres)?;
    let text = format!("{table}\nSpheres of 20 vertices:\n\n{spheres}");
    Ok(Section::new(text, &failures))
}

/// One component with its naively rounded matchings.
struct Piece {
    mesh: TriMesh,
    metric: Metric,
    angles: HalfedgeData<f64>,
    naive: MatchedCut,
}

/// What consistency made of all pieces in one norm.
#[derive(Default)]
struct Solved {
    seconds: f64,
    objective: f64,
    bound: f64,
    impossible: usize,
    cones: usize,
    optimal: bool,
}

/// A row for each norm.
fn measure_mesh(mesh: &Mesh) -> Result<Vec<Vec<String>>, ConsistencyError> {
    let pieces: Vec<Piece> = components(&mesh.connectivity)
        .unwrap_or_default()
        .into_iter()
        .map(|piece| {
            let positions: Vec<_> = piece.vertices.iter().map(|v| mesh.positions[v.at()]).collect();
            let metric = Metric::from_positions(&piece.mesh, &positions);
            Piece::new(piece.mesh, metric)
        })
        .collect();
    let before: usize = pieces.iter().map(|piece| piece.cones(&piece.naive)).sum();
    let row = |(norm, name): (AngleNorm, &str)| {
        let local = solve(&pieces, &ConsistencyOptions { norm, work: 0, ..Default::default() })?;
        let found = solve(&pieces, &ConsistencyOptions { norm, ..Default::default() })?;
        Ok(vec![
            found.impossible.to_string(),
            before.to_string(),
            found.cones.to_string(),
            name.to_owned(),
            format!("{:.4}", local.objective),
            format!("{:.2}", local.seconds),
            format!("{:.4}", found.objective),
            format!("{:.2}", found.seconds),
            format!("{:.4}", found.bound),
            format!("{:.2} %", 100.0 * (1.0 - found.bound / found.objective)),
            if found.optimal { "yes" } else { "no" }.to_owned(),
        ])
    };
    [(AngleNorm::L2, "l2"), (AngleNorm::L1, "l1")].into_iter().map(row).collect()
}

impl Piece {
    fn new(mesh: TriMesh, metric: Metric) -> Self {
        let tree = DualTree::lightest(&mesh, curvature_weight(&mesh, &metric));
        let naive = MatchedCut::new(&Sectors::unaligned(&mesh), &metric, tree);
        Self { mesh, angles: metric.angle.clone(), metric, naive }
    }

    fn cones(&self, matched: &MatchedCut) -> usize {
        let indices = matched.sector_indices(&Sectors::unaligned(&self.mesh), &self.metric);
        indices.iter().filter(|&&k| k != 0).count()
    }

    fn consistent(
        &self,
        options: &ConsistencyOptions,
    ) -> Result<(MatchedCut, Consistent), ConsistencyError> {
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        consistent_cut(&self.mesh, &self.metric, &self.naive, &self.angles, options, &mut watch)
    }
}

fn solve(pieces: &[Piece], options: &ConsistencyOptions) -> Result<Solved, ConsistencyError> {
    let mut all = Solved { optimal: true, ..Solved::default() };
    let clock = Clock::start();
    for piece in pieces {
        let (cut, found) = piece.consistent(options)?;
        all.objective += found.objective;
        all.bound += found.lower_bound;
        all.impossible += found.stats.impossible_units;
        all.optimal &= found.optimal;
        all.cones += piece.cones(&cut);
    }
    all.seconds = clock.seconds();
    Ok(all)
}

/// How far spheres of 20 vertices end from the optimum, where it is proven.
fn measure_spheres(count: u64) -> Result<Table, Box<dyn Error>> {
    let mut table = Table::new([
        "norm",
        "noise",
        "spheres",
        "local moves: mean excess",
        "worst",
        "search: worst excess",
        "proven",
        "CPU s each",
    ]);
    for (norm, name) in [(AngleNorm::L2, "l2"), (AngleNorm::L1, "l1")] {
        for noise in NOISES {
            progress(&format!("spheres: {name}, noise {noise}"));
            let mut excess = Vec::new();
            let mut proven = 0;
            let mut seconds = 0.0;
            for seed in 0..count {
                let piece = sphere(seed, noise)?;
                let options = ConsistencyOptions { norm, ..Default::default() };
                let local = piece.consistent(&ConsistencyOptions { work: 0, ..options })?.1;
                let clock = Clock::start();
                let found = piece.consistent(&options)?.1;
                seconds += clock.seconds();
                if found.optimal {
                    proven += 1;
                    let over = |value: f64| (value / found.objective - 1.0).max(0.0);
                    excess.push((over(local.objective), over(found.objective)));
                }
            }
            let worst = |of: fn(&(f64, f64)) -> f64| excess.iter().map(of).fold(0.0, f64::max);
            let mean = excess.iter().map(|e| e.0).sum::<f64>() / excess.len().max(1) as f64;
            let percent =
                |x: f64| if x < NONE { "0".to_owned() } else { format!("{:.2} %", 100.0 * x) };
            table.report(vec![
                name.to_owned(),
                noise.to_string(),
                count.to_string(),
                percent(mean),
                percent(worst(|e| e.0)),
                percent(worst(|e| e.1)),
                proven.to_string(),
                format!("{:.3}", seconds / count.max(1) as f64),
            ]);
        }
    }
    Ok(table)
}

/// A small sphere with noise on its angles.
fn sphere(seed: u64, noise: f64) -> Result<Piece, Box<dyn Error>> {
    let soup = small_sphere(seed);
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces)?;
    let metric = Metric::from_positions(&mesh, &soup.positions);
    let mut piece = Piece::new(mesh, metric);
    let mut rng = Rng::new(seed);
    piece.angles.iter_mut().for_each(|a| *a += noise * (2.0 * rng.unit() - 1.0));
    Ok(piece)
}
