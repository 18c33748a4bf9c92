//! Maps for several weights of the corners.

use crate::{Args, corners_off, features_of, solve};
use seamstress_bench::markdown::Table;
use seamstress_bench::meshes;
use seamstress_parametrize::MapOptions;
use std::error::Error;

/// One row per mesh and weight.
pub(crate) fn table(args: &Args, weights: &[f64]) -> Result<Table, Box<dyn Error>> {
    let titles = ["mesh", "weight", "corners", "off", "cones", "tau", "SD", "released"];
    let mut table = Table::new(titles);
    for path in &args.meshes {
        let mesh = meshes::load(path)?;
        let (features, _) = features_of(path, &mesh, args)?;
        for &weight in weights {
            let mut options = MapOptions::default();
            options.rounding.corner_weight = weight;
            options.cone_price = Some(args.cone_price);
            let solution = match solve(&mesh, &features, &options) {
                Ok((solution, _)) => solution,
                Err(error) => {
                    eprintln!("{}: {error}", meshes::name(path));
                    continue;
                }
            };
            let (off, corners) = corners_off(&mesh, &solution);
            let row = vec![
                meshes::name(path),
                weight.to_string(),
                corners.to_string(),
                off.to_string(),
                solution.map.cones().len().to_string(),
                format!("{:.2}", solution.distortion.tau),
                format!("{:.3}", solution.distortion.symmetric_dirichlet),
                solution.released.len().to_string(),
            ];
            eprintln!("| {} |", row.join(" | "));
            table.push(row);
        }
    }
    Ok(table)
}
