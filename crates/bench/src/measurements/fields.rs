//! Round trips from maps to cross fields and back.

use crate::markdown::Table;
use crate::meshes::{Mesh, Selection};
use crate::output::Section;
use crate::process::Clock;
use seamstress_mesh::{HalfedgeData, Metric};
use seamstress_parametrize::field::{CrossField, Homology, extract, lift, map_indices};
use seamstress_parametrize::{MapOptions, Start, make_map, make_map_from};
use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

/// Cross fields: round trips from maps to fields and back
///
/// Maps each mesh, reads the cross field off the map, maps the field, and compares. Columns: cones and loops
/// of the first map; whether the second has the same cones, the same loop indices; its tau against that of the
/// first; milliseconds for the basis of the homology and for the elimination of eq. (13), with all matchings
/// changed by full turns first.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,
}

/// Makes the round trip of every mesh; passes if there is a map in both directions and cones and loops are kept.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let mut table = Table::new([
        "mesh",
        "triangles",
        "cones",
        "loops",
        "same cones",
        "same loops",
        "tau",
        "tau again",
        "basis ms",
        "(13) ms",
        "CPU s",
    ]);
    let failures = args.selection.survey(|subject| {
        let mut cells = vec![subject.name.clone(), subject.mesh.connectivity.n_faces().to_string()];
        cells.extend(round_trip(&subject.mesh)?);
        let is_same = !cells.iter().any(|cell| cell == NOT_THE_SAME);
        table.report(cells);
        if is_same { Ok(()) } else { Err("cones or loops are not the same".into()) }
    })?;
    Ok(Section::new(table, &failures))
}

const NOT_THE_SAME: &str = "NO";

fn round_trip(mesh: &Mesh) -> Result<Vec<String>, Box<dyn Error>> {
    let clock = Clock::start();
    let (connectivity, positions) = (&mesh.connectivity, &mesh.positions);
    let options = MapOptions::default();
    let mut go_on = |_| ControlFlow::Continue(());
    let first = make_map(connectivity, positions, &options, &mut go_on)?;
    let metric = Metric::from_positions(connectivity, positions);
    let begun = Instant::now();
    let homology = Homology::new(connectivity);
    let basis = begun.elapsed().as_secs_f64() * 1e3;
    let field = extract(connectivity, &metric, &homology, &first.map)?;
    let elimination = time_of_elimination(mesh, &homology, &field, first.map.corner_uvs())?;
    let start = Start::Field(field.clone());
    let second = make_map_from(connectivity, positions, &start, &options, &mut go_on)?;
    let again = extract(connectivity, &metric, &homology, &second.map)?;
    let loops = |field: &CrossField| -> Vec<i32> {
        homology.loops().iter().map(|l| field.loop_index(connectivity, l)).collect()
    };
    let yes = |same: bool| if same { "yes" } else { NOT_THE_SAME }.to_owned();
    Ok(vec![
        first.map.cones().len().to_string(),
        homology.loops().len().to_string(),
        yes(first.map.cones() == second.map.cones()),
        yes(loops(&field) == loops(&again)),
        format!("{:.3}", first.distortion.tau),
        format!("{:.3}", second.distortion.tau),
        format!("{basis:.1}"),
        format!("{elimination:.1}"),
        format!("{:.2}", clock.seconds()),
    ])
}

/// Milliseconds to find the full turns again after all matchings were changed by some.
fn time_of_elimination(
    mesh: &Mesh,
    homology: &Homology,
    field: &CrossField,
    corner_uvs: &[[f64; 2]],
) -> Result<f64, Box<dyn Error>> {
    let connectivity = &mesh.connectivity;
    let mut shifted: HalfedgeData<i32> = field.matching().clone();
    for h in connectivity.interior_edges() {
        let turns = 4 * ((h.0 % 3) as i32 - 1);
        shifted[h] += turns;
        if let Some(t) = connectivity.twin(h) {
            shifted[t] -= turns;
        }
    }
    let found = CrossField::new(connectivity, field.frames().clone(), shifted.clone())?
        .node_indices(connectivity, homology);
    let (nodes, loops) = map_indices(connectivity, homology, corner_uvs);
    let begun = Instant::now();
    let turns = lift(connectivity, homology, &shifted, &found, &nodes, &loops)?;
    let elapsed = begun.elapsed().as_secs_f64() * 1e3;
    let full = shifted.iter().zip(turns.iter()).map(|(r, k)| r + 4 * k).collect();
    let lifted = CrossField::new(connectivity, field.frames().clone(), full)?;
    if lifted.node_indices(connectivity, homology) != nodes {
        return Err("the elimination missed the indices".into());
    }
    Ok(elapsed)
}
