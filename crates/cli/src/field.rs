//! `seamstress field`.

use crate::args::FieldArgs;
use crate::input::LoadedMesh;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::quad_file::read_quads;
use crate::report::{self, VERSION};
use crate::start::read_corner_uvs;
use crate::summary;
use crate::text::{self, counted, row};
use seamstress_io::{MatchingRow, write_matching, write_rawfield, write_rosy, write_singularities};
use seamstress_mesh::{Halfedge, Metric, TriMesh};
use seamstress_parametrize::field::{CrossField, Homology, directions_in_space, extract};
use seamstress_parametrize::{SeamlessMap, Tolerance};
use seamstress_quads::layout::lay_out_squares;
use serde_json::json;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A field, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    connectivity: TriMesh,
    field: CrossField,
    cones: Vec<(u32, i32)>,
    loops: Vec<i32>,
}

/// Runs the command.
pub(crate) fn run(args: &FieldArgs) -> Result<Status, Failure> {
    let mut targets: Vec<Target> =
        args.sing.iter().map(|path| Target::new(Kind::Cones, path)).collect();
    targets.extend(args.matching.iter().map(|path| Target::new(Kind::Matching, path)));
    targets.push(Target::new(Kind::Field, &args.output));
    let inputs: Vec<&Path> = args.map.iter().chain([&args.mesh]).map(PathBuf::as_path).collect();
    let plan = Plan::new(&inputs, None, targets)?;
    let product = read_off(args)?;
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Cones => write_singularities(file, &product.cones),
            Kind::Matching => write_rows(file, &product),
            _ => write_field(file, args, &product),
        })?;
    }
    batch.commit()?;
    text::print(&if args.json { json_text(&product) } else { summary_text(&plan, &product) })?;
    Ok(Status::Done)
}

fn read_off(args: &FieldArgs) -> Result<Product, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    mesh.tell_findings();
    let connectivity = mesh.connect()?;
    let (file, corner_uvs) = match &args.map {
        Some(map) => (map, read_corner_uvs(map, &connectivity, &mesh.soup.positions)?),
        None => (&args.mesh, uvs_of_quads(&args.mesh, &mesh.soup.faces)?),
    };
    let bad_map = |text: String| Failure::BadMap { file: file.clone(), text };
    let tolerance = Tolerance { seam: args.tolerance, ..Tolerance::default() };
    let map = SeamlessMap::certify(&connectivity, corner_uvs, &tolerance)
        .map_err(|violations| bad_map(format!("not a seamless map: {violations}")))?;
    let metric = Metric::from_positions(&connectivity, &mesh.soup.positions);
    let homology = Homology::new(&connectivity);
    let field = extract(&connectivity, &metric, &homology, &map)
        .map_err(|error| bad_map(error.to_string()))?;
    let indices = field.indices(&connectivity);
    let cones = indices.enumerate().filter(|(_, k)| **k != 0).map(|(v, &k)| (v.0, k)).collect();
    let loops = homology.loops().iter().map(|l| field.loop_index(&connectivity, l)).collect();
    Ok(Product { mesh, connectivity, field, cones, loops })
}

/// UVs of the triangles of a quad mesh, two for each quad along either diagonal, from the layout in which
/// every quad is a unit square.
fn uvs_of_quads(path: &Path, faces: &[[u32; 3]]) -> Result<Vec<[f64; 2]>, Failure> {
    let quads = read_quads(path)?;
    let bad = |text: String| Failure::BadMesh { file: path.to_owned(), text };
    let layout = lay_out_squares(&quads).map_err(|error| bad(error.to_string()))?;
    let halves = layout.faces.as_flattened().chunks_exact(6).zip(layout.corner_uvs.chunks_exact(6));
    let uvs =
        halves.zip(faces.as_flattened().chunks_exact(6)).flat_map(|((vertices, uvs), here)| {
            here.iter().filter_map(|v| Some(uvs[vertices.iter().position(|w| w == v)?]))
        });
    Ok(uvs.collect())
}

fn write_field(file: &mut impl Write, args: &FieldArgs, product: &Product) -> io::Result<()> {
    let positions = &product.mesh.soup.positions;
    let crosses = directions_in_space(&product.connectivity, positions, &product.field);
    match args.output.extension().is_some_and(|e| e.eq_ignore_ascii_case("rosy")) {
        true => write_rosy(file, &crosses),
        false => write_rawfield(file, &crosses),
    }
}

/// All edges, those of the boundary with -1 for the missing face.
fn write_rows(file: &mut impl Write, product: &Product) -> io::Result<()> {
    let mesh = &product.connectivity;
    let row = |h: Halfedge| MatchingRow {
        faces: [i64::from(h.face().0), mesh.twin(h).map_or(-1, |t| i64::from(t.face().0))],
        vertices: [mesh.origin(h).0, mesh.tip(h).0],
        matching: product.field.matching()[h].rem_euclid(4),
    };
    let rows: Vec<MatchingRow> = mesh.edges().map(row).collect();
    write_matching(file, mesh.n_faces(), &rows)
}

fn json_text(product: &Product) -> String {
    let cones: Vec<_> =
        product.cones.iter().map(|(v, k)| json!({ "vertex": v, "index": k })).collect();
    report::to_text(&json!({
        "seamstress": VERSION,
        "command": "field",
        "input": report::input_json(&product.mesh),
        "cones": cones,
        "loop_indices": product.loops,
    }))
}

fn summary_text(plan: &Plan, product: &Product) -> String {
    let loops: Vec<String> = product.loops.iter().map(i32::to_string).collect();
    let loops = match loops.len() {
        0 => "none".into(),
        _ => loops.join(", "),
    };
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.push(row("field", &counted(product.cones.len(), "cone")));
    rows.push(row("loops", &format!("indices around handles: {loops}")));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
