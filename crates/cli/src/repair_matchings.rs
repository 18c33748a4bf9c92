//! `seamstress repair-matchings`.

use crate::args::{Norm, RepairMatchingsArgs};
use crate::input::LoadedMesh;
use crate::job::{Job, Worker};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::report::{self, VERSION};
use crate::start::{read_corner_uvs, read_cross_field};
use crate::summary;
use crate::text::{counted, figure, row};
use seamstress_io::{MatchingRow, write_matching, write_singularities};
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh, VertexData};
use seamstress_parametrize::consistency::{
    AngleNorm, ConsistencyError, ConsistencyInput, ConsistencyOptions, Consistent, MatchingSet,
    SeamMatching, make_consistent, transitions,
};
use seamstress_parametrize::progress::{Stage, Watch};
use serde_json::json;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What is given: angles, indices, and a matching per interior edge.
struct Given {
    angles: HalfedgeData<f64>,
    indices: VertexData<i32>,
    seams: Vec<SeamMatching>,
}

/// Consistent matchings, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    connectivity: TriMesh,
    given: Given,
    consistent: Consistent,
}

/// Runs the command.
pub(crate) fn run(args: &RepairMatchingsArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.mesh)?;
    let mut targets: Vec<Target> =
        args.sing.iter().map(|path| Target::new(Kind::Cones, path)).collect();
    targets.push(Target::new(Kind::Matching, &args.output));
    let given = [&args.from, &args.field, &args.matching].into_iter().flatten();
    let inputs: Vec<&Path> = given.chain([&args.mesh]).map(PathBuf::as_path).collect();
    let plan = Plan::new(&inputs, None, targets)?;
    let owned = args.clone();
    let product = job.run(move |worker| make(&owned, worker))?;
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Cones => write_singularities(file, &cones(&product)),
            _ => write_rows(file, &product),
        })?;
    }
    job.finish(&args.run, batch, || json_text(args, &product), || summary_text(args, &product))?;
    Ok(Status::Done)
}

fn make(args: &RepairMatchingsArgs, mut worker: Worker) -> Result<Product, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let connectivity = mesh.connect()?;
    let given = read(args, &connectivity, &mesh.soup.positions)?;
    let indices: VertexData<f64> = given.indices.iter().map(|&k| f64::from(k)).collect();
    let input = ConsistencyInput { angles: &given.angles, indices: &indices, seams: &given.seams };
    let norm = match (args.norm, &args.from) {
        (Some(Norm::L1), _) | (None, Some(_)) => AngleNorm::L1,
        _ => AngleNorm::L2,
    };
    let options = ConsistencyOptions { norm, ..ConsistencyOptions::default() };
    let made = {
        let mut observe = |progress| worker.observe(progress);
        let mut watch = Watch::new(&mut observe, 0, 1);
        let entered = watch.enter(Stage::Rounding).map_err(ConsistencyError::from);
        entered.and_then(|()| make_consistent(&connectivity, &input, &options, &mut watch))
    };
    let consistent = made.map_err(|error| {
        let file = mesh.path.clone();
        match (error, worker.stop.reason()) {
            (ConsistencyError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
            (error, _) => Failure::Inconsistent { file, text: error.to_string() },
        }
    })?;
    Ok(Product { mesh, connectivity, given, consistent })
}

fn read(
    args: &RepairMatchingsArgs,
    mesh: &TriMesh,
    positions: &[[f64; 3]],
) -> Result<Given, Failure> {
    let (angles, indices, matching) = match &args.from {
        Some(path) => transitions(mesh, &read_corner_uvs(path, mesh, positions)?),
        None => {
            let (field, matching) = (args.field.as_deref(), args.matching.as_deref());
            let field = read_cross_field(field, matching, mesh, positions)?.ok_or_else(|| {
                Failure::Usage("give a map with `--from`, or a field with `--field`".into())
            })?;
            let angles = Metric::from_positions(mesh, positions).angle;
            (angles, field.indices(mesh), field.matching().clone())
        }
    };
    let seam = |left: Halfedge| SeamMatching {
        left,
        matching: f64::from(matching[left]),
        set: MatchingSet::Integer,
    };
    let seams = mesh.interior_edges().map(seam).collect();
    Ok(Given { angles, indices, seams })
}

/// Interior vertices with an index other than zero.
fn cones(product: &Product) -> Vec<(u32, i32)> {
    let indices = product.consistent.indices.enumerate();
    indices
        .filter(|(v, k)| !product.connectivity.is_boundary(*v) && **k != 0.0)
        .map(|(v, k)| (v.0, k.round() as i32))
        .collect()
}

/// All edges, those of the boundary with -1 for the missing face.
fn write_rows(file: &mut impl Write, product: &Product) -> io::Result<()> {
    let mesh = &product.connectivity;
    let mut matching = HalfedgeData::filled(mesh.n_halfedges(), 0);
    for (seam, r) in product.given.seams.iter().zip(&product.consistent.matchings) {
        matching[seam.left] = (r.round() as i32).rem_euclid(4);
    }
    let row = |h: Halfedge| MatchingRow {
        faces: [i64::from(h.face().0), mesh.twin(h).map_or(-1, |t| i64::from(t.face().0))],
        vertices: [mesh.origin(h).0, mesh.tip(h).0],
        matching: matching[h],
    };
    let rows: Vec<MatchingRow> = mesh.edges().map(row).collect();
    write_matching(file, mesh.n_faces(), &rows)
}

fn json_text(args: &RepairMatchingsArgs, product: &Product) -> String {
    let cones: Vec<_> =
        cones(product).iter().map(|(v, k)| json!({ "vertex": v, "index": k })).collect();
    let consistent = &product.consistent;
    report::to_text(&json!({
        "seamstress": VERSION,
        "command": "repair-matchings",
        "input": report::input_json(&product.mesh),
        "cones_before": cones_before(product),
        "cones": cones,
        "objective": consistent.objective,
        "lower_bound": consistent.lower_bound,
        "stats": consistent.stats,
        "file": args.output.to_string_lossy(),
    }))
}

fn cones_before(product: &Product) -> usize {
    product.given.indices.iter().filter(|&&k| k != 0).count()
}

fn summary_text(args: &RepairMatchingsArgs, product: &Product) -> String {
    let consistent = &product.consistent;
    let stats = consistent.stats;
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.push(row(
        "cones",
        &format!("{} given, {} now", cones_before(product), cones(product).len()),
    ));
    rows.push(row(
        "changed",
        &format!(
            "{} in {}; the index of {}",
            counted(stats.changed_matchings, "matching"),
            product.given.seams.len(),
            counted(stats.changed_indices, "vertex"),
        ),
    ));
    rows.push(row(
        "angles",
        &format!(
            "{} from those given, {} at least",
            figure(consistent.objective),
            figure(consistent.lower_bound),
        ),
    ));
    rows.push(row("written", &args.output.display().to_string()));
    rows.join("\n")
}
