//! Maps for several weights of the corners.

use super::{Args, corners_off, features_of, solve};
use crate::markdown::Table;
use crate::output::Section;
use seamstress_parametrize::MapOptions;
use std::error::Error;

/// One row per mesh and weight.
pub(super) fn measure(args: &Args, weights: &[f64]) -> Result<Section, Box<dyn Error>> {
    let titles = ["mesh", "weight", "corners", "off", "cones", "tau", "SD", "dropped"];
    let mut table = Table::new(titles);
    let failures = args.selection.survey(|subject| {
        let features = features_of(subject, args.angle)?;
        for &weight in weights {
            let mut options = MapOptions::default();
            options.rounding.corner_weight = weight;
            options.cone_price = Some(args.cone_price);
            let (solution, _) = solve(&subject.mesh, &features, &options)?;
            let (off, corners) = corners_off(&subject.mesh, &solution);
            table.report(vec![
                subject.name.clone(),
                weight.to_string(),
                corners.to_string(),
                off.to_string(),
                solution.map.cones().len().to_string(),
                format!("{:.2}", solution.distortion.tau),
                format!("{:.3}", solution.distortion.symmetric_dirichlet),
                solution.released.len().to_string(),
            ]);
        }
        Ok(())
    })?;
    Ok(Section::new(table, &failures))
}
