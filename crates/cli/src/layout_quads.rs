//! `seamstress layout-quads`.

use crate::args::{LayoutQuadsArgs, QuadLayoutMethod};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::quad_file::read_quads;
use crate::report::{self, VERSION};
use crate::summary;
use crate::text::{self, counted, row};
use seamstress_io::{MapObj, write_map_obj};
use seamstress_mesh::Metric;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::quality::{Distortion, distortion};
use seamstress_parametrize::{SeamlessMap, Tolerance};
use seamstress_quads::QuadMesh;
use seamstress_quads::layout::{QuadLayout, lay_out_conformal, lay_out_squares};
use serde_json::json;
use std::io::Write;

/// How far seams of the conformal layout may be open, in quad edges: its linear system is badly
/// conditioned on large meshes, which is what it is there to show.
const CONFORMAL_TOLERANCE: f64 = 1e-5;

/// A layout, certified and measured.
struct Product {
    soup: TriangleSoup,
    n_quads: usize,
    map: SeamlessMap,
    distortion: Distortion,
    /// Largest distance of a coordinate from an integer.
    integer_error: f64,
}

/// Runs the command.
pub(crate) fn run(args: &LayoutQuadsArgs) -> Result<Status, Failure> {
    let plan = plan(args)?;
    let quads = read_quads(&args.quads)?;
    let layout = lay_out(args, &quads)?;
    let product = certify(args, &quads, layout)?;
    let pictures = match &args.pictures {
        Some(_) => pictures::draw(&product.soup, &product.map, None, &args.texture)
            .map_err(|cause| Failure::NoPicture { file: args.quads.clone(), cause })?
            .to_vec(),
        None => Vec::new(),
    };
    let mut batch = plan.begin()?;
    let mut pictures = pictures.iter();
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Picture => file.write_all(pictures.next().map_or(&[], Vec::as_slice)),
            _ => write_map(file, args, &product),
        })?;
    }
    batch.commit()?;
    text::print(&if args.json { json_text(args, &product) } else { summary_text(args, &product) })?;
    Ok(Status::Done)
}

fn plan(args: &LayoutQuadsArgs) -> Result<Plan, Failure> {
    let mut targets = Vec::new();
    if let Some(folder) = &args.pictures {
        targets.extend(pictures::NAMES.map(|name| Target::new(Kind::Picture, &folder.join(name))));
    }
    targets.push(Target::new(Kind::Map, &args.output));
    Plan::new(&[&args.quads], args.pictures.as_deref(), targets)
}

fn lay_out(args: &LayoutQuadsArgs, quads: &QuadMesh) -> Result<QuadLayout, Failure> {
    let layout = match args.method {
        QuadLayoutMethod::Squares => lay_out_squares(quads),
        QuadLayoutMethod::Conformal => lay_out_conformal(quads),
    };
    layout.map_err(|error| Failure::BadMesh { file: args.quads.clone(), text: error.to_string() })
}

fn certify(
    args: &LayoutQuadsArgs,
    quads: &QuadMesh,
    layout: QuadLayout,
) -> Result<Product, Failure> {
    let error = |x: &f64| (x - x.round()).abs();
    let integer_error = layout.corner_uvs.iter().flatten().map(error).fold(0.0, f64::max);
    let metric = Metric::from_positions(&layout.mesh, quads.positions());
    let distortion = distortion(&layout.mesh, &metric, &layout.corner_uvs);
    let mut tolerance = Tolerance::default();
    if args.method == QuadLayoutMethod::Conformal {
        tolerance.seam = CONFORMAL_TOLERANCE;
    }
    let map = SeamlessMap::certify(&layout.mesh, layout.corner_uvs, &tolerance).map_err(
        |violations| Failure::Internal {
            file: args.quads.clone(),
            text: format!("the layout failed its certificate: {violations}"),
        },
    )?;
    let soup = TriangleSoup { positions: quads.positions().to_vec(), faces: layout.faces };
    Ok(Product { soup, n_quads: quads.quads().len(), map, distortion, integer_error })
}

fn write_map(
    file: &mut impl Write,
    args: &LayoutQuadsArgs,
    product: &Product,
) -> std::io::Result<()> {
    let name = args.quads.file_name().unwrap_or(args.quads.as_os_str());
    let comments = [
        format!("Layout of a quad mesh by Seamstress {VERSION}: every two triangles a unit square"),
        format!("Source: {}", name.display()),
    ];
    write_map_obj(
        file,
        &MapObj {
            positions: &product.soup.positions,
            faces: &product.soup.faces,
            corner_uvs: product.map.corner_uvs(),
            comments: &comments,
        },
    )
}

fn json_text(args: &LayoutQuadsArgs, product: &Product) -> String {
    let mut value = report::map_json(&product.map, &product.distortion);
    value["seamstress"] = VERSION.into();
    value["command"] = "layout-quads".into();
    value["input"] = json!({
        "file": args.quads.to_string_lossy(),
        "vertices": product.soup.positions.len(),
        "quads": product.n_quads,
    });
    value["integer_error"] = product.integer_error.into();
    report::to_text(&value)
}

fn summary_text(args: &LayoutQuadsArgs, product: &Product) -> String {
    let counts =
        [counted(product.soup.positions.len(), "vertex"), counted(product.n_quads, "quad")];
    let accuracy = match product.integer_error {
        0.0 => "all coordinates are integers".into(),
        error => format!("coordinates within {error:.1e} of integers"),
    };
    let mut rows = vec![
        row("quad mesh", &args.quads.display().to_string()),
        row("size", &counts.join(", ")),
        row("layout", &accuracy),
    ];
    rows.extend(summary::map_rows(&product.map, &product.distortion));
    rows.push(row("written", &args.output.display().to_string()));
    rows.join("\n")
}
