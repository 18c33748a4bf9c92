//! The cost and quality of consistent matchings.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::Section;
use crate::process::Clock;
use seamstress_mesh::{Metric, TriMesh, components::components};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyError, ConsistencyOptions, Consistent, consistent_cut,
};
use seamstress_parametrize::cut::{DualTree, curvature_weight};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::progress::Watch;
use seamstress_parametrize::rounding::MatchedCut;
use seamstress_testkit::Rng;
use std::error::Error;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Consistency: the cost and quality of consistent matchings
///
/// Every matching is rounded at once to the integer nearest to the surface's own rotation; all are integer
/// variables. Columns: vertices whose index no triangles can have at first; cones before and after; CPU
/// seconds, objective and its lower bound in the l2 norm; CPU seconds and objective in the l1 norm; the
/// objective of a long local search, if one was asked for, and how much lower it is.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// Look for better indices for so many seconds: from the best ones with some random matchings changed
    #[arg(long, value_name = "SECONDS")]
    search: Option<f64>,
}

/// Random matchings that a step of the long search changes, at most.
const KICKS: usize = 8;

/// Makes the matchings of every mesh consistent; passes if that always succeeds.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let mut table = Table::new([
        "mesh",
        "triangles",
        "impossible",
        "cones",
        "cones after",
        "l2 CPU s",
        "objective",
        "bound",
        "l1 CPU s",
        "objective",
        "search",
        "lower by",
    ]);
    let failures = args.selection.survey(|subject| {
        let mut cells = vec![subject.name.clone(), subject.mesh.connectivity.n_faces().to_string()];
        cells.extend(measure_mesh(&subject.mesh, args.search)?);
        table.report(cells);
        Ok(())
    })?;
    Ok(Section::new(table, &failures))
}

/// One component with its naively rounded matchings.
struct Piece {
    mesh: TriMesh,
    metric: Metric,
    naive: MatchedCut,
}

/// What consistency made of all pieces in one norm.
#[derive(Default)]
struct Solved {
    seconds: f64,
    objective: f64,
    bound: f64,
    impossible: usize,
    cuts: Vec<MatchedCut>,
}

fn measure_mesh(mesh: &Mesh, search: Option<f64>) -> Result<Vec<String>, ConsistencyError> {
    let pieces: Vec<Piece> = components(&mesh.connectivity)
        .unwrap_or_default()
        .into_iter()
        .map(|piece| {
            let positions: Vec<_> = piece.vertices.iter().map(|v| mesh.positions[v.at()]).collect();
            Piece::new(piece.mesh, &positions)
        })
        .collect();
    let [squares, absolute] = [AngleNorm::L2, AngleNorm::L1].map(|norm| solve(&pieces, norm));
    let (squares, absolute) = (squares?, absolute?);
    let cones = |cuts: &[&MatchedCut]| -> usize {
        pieces.iter().zip(cuts).map(|(piece, cut)| piece.cones(cut)).sum()
    };
    let before: Vec<&MatchedCut> = pieces.iter().map(|piece| &piece.naive).collect();
    let searched = search.map(|seconds| searched(&pieces, &squares, seconds)).transpose()?;
    let shown =
        |x: Option<f64>, decimals: usize| x.map_or("-".to_owned(), |x| format!("{x:.decimals$}"));
    Ok(vec![
        squares.impossible.to_string(),
        cones(&before).to_string(),
        cones(&squares.cuts.iter().collect::<Vec<_>>()).to_string(),
        format!("{:.2}", squares.seconds),
        format!("{:.4}", squares.objective),
        format!("{:.4}", squares.bound),
        format!("{:.2}", absolute.seconds),
        format!("{:.3}", absolute.objective),
        shown(searched, 4),
        searched.map_or("-".into(), |x| format!("{:.2} %", 100.0 * (1.0 - x / squares.objective))),
    ])
}

impl Piece {
    fn new(mesh: TriMesh, positions: &[[f64; 3]]) -> Self {
        let metric = Metric::from_positions(&mesh, positions);
        let tree = DualTree::lightest(&mesh, curvature_weight(&mesh, &metric));
        let naive = MatchedCut::new(&Sectors::unaligned(&mesh), &metric, tree);
        Self { mesh, metric, naive }
    }

    fn cones(&self, matched: &MatchedCut) -> usize {
        let indices = matched.sector_indices(&Sectors::unaligned(&self.mesh), &self.metric);
        indices.iter().filter(|&&k| k != 0).count()
    }

    fn consistent(
        &self,
        matched: &MatchedCut,
        norm: AngleNorm,
    ) -> Result<(MatchedCut, Consistent), ConsistencyError> {
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let options = ConsistencyOptions { norm, ..Default::default() };
        let angles = &self.metric.angle;
        consistent_cut(&self.mesh, &self.metric, matched, angles, &options, &mut watch)
    }
}

fn solve(pieces: &[Piece], norm: AngleNorm) -> Result<Solved, ConsistencyError> {
    let mut all = Solved::default();
    let clock = Clock::start();
    for piece in pieces {
        let (cut, found) = piece.consistent(&piece.naive, norm)?;
        all.objective += found.objective;
        all.bound += found.lower_bound;
        all.impossible += found.stats.impossible_units;
        all.cuts.push(cut);
    }
    all.seconds = clock.seconds();
    Ok(all)
}

/// The lowest sum of squares that solves from changed matchings find, all pieces together; the time is
/// shared by their faces.
fn searched(pieces: &[Piece], first: &Solved, seconds: f64) -> Result<f64, ConsistencyError> {
    let faces: usize = pieces.iter().map(|piece| piece.mesh.n_faces()).sum();
    let mut rng = Rng::new(1);
    let mut total = 0.0;
    for (piece, start) in pieces.iter().zip(&first.cuts) {
        let share = seconds * piece.mesh.n_faces() as f64 / faces as f64;
        let limit = Duration::try_from_secs_f64(share).unwrap_or(Duration::ZERO);
        let begun = Instant::now();
        let (mut best, found) = piece.consistent(start, AngleNorm::L2)?;
        let mut lowest = found.objective;
        while begun.elapsed() < limit && !best.matching.is_empty() {
            let mut kicked = best.clone();
            for _ in 0..=rng.below(KICKS) {
                let seam = rng.below(kicked.matching.len());
                kicked.matching[seam] += if rng.unit() < 0.5 { 1 } else { -1 };
            }
            let (cut, found) = piece.consistent(&kicked, AngleNorm::L2)?;
            if found.objective < lowest {
                (best, lowest) = (cut, found.objective);
            }
        }
        total += lowest;
    }
    Ok(total)
}
