//! Maps beside those of mixed-integer quadrangulation.

use crate::map_files::{corner_uvs, write_mesh};
use crate::markdown::Table;
use crate::meshes::{Selection, Subject};
use crate::output::Section;
use crate::process::sibling;
use crate::program::{Outcome, Program, Report};
use seamstress_io::read_mesh;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::quality::{Distortion, distortion};
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Mixed-integer quadrangulation: how good are its maps, and what do they cost?
///
/// Of each mesh a map with default options on one thread, and one by another program, both in this run. Columns, each
/// `here; there`: flipped triangles, tau, mean symmetric Dirichlet energy of the triangles that are not flipped, cones, CPU seconds
/// (of the other program: of the field and of its integration). Passes if nothing is flipped here, and tau and energy are no larger
/// than there.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    selection: Selection,

    /// The other program
    ///
    /// It is called as `PROGRAM MESH MAP.obj`. The last line of its output is a JSON object with CPU seconds, `field` and
    /// `integration`. One is made of `miq.cpp`, next to the source of this command.
    #[arg(long, value_name = "PROGRAM")]
    miq: PathBuf,
}

/// Maps every mesh with both.
pub(super) fn measure(args: &Args) -> Result<Section, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let program = Program { path: sibling("seamstress")?, time_limit: None, threads: Some(1) };
    let [source, map] = ["source.obj", "map.obj"].map(|name| folder.path().join(name));
    let mut table = Table::new(["mesh", "triangles", "flipped", "tau", "energy", "cones", "CPU s"]);
    let mut missed = Vec::new();
    let failures = args.selection.survey(|subject| {
        let made = match program.run::<&str>("map", &subject.path, &map, &[]) {
            Outcome::Done(report) => report,
            Outcome::Refused(reason) | Outcome::Failed(reason) => Err(reason.to_string())?,
        };
        let here = Made::new(subject, &map, vec![made.number("/cost/cpu_seconds")])?;
        write_mesh(&source, &subject.mesh)?;
        let there =
            run(&args.miq, &source, &map).and_then(|seconds| Made::new(subject, &map, seconds));
        let there = there.map_err(|error| missed.push(format!("{}: {error}", subject.name))).ok();
        missed.extend(here.fault(there.as_ref()).map(|fault| format!("{}: {fault}", subject.name)));
        let pair = |cell: fn(&Made) -> String| {
            format!("{}; {}", cell(&here), there.as_ref().map_or("-".into(), cell))
        };
        table.report(vec![
            subject.name.clone(),
            subject.mesh.connectivity.n_faces().to_string(),
            pair(|made| made.distortion.flipped.to_string()),
            pair(|made| format!("{:.2}", made.distortion.tau)),
            pair(|made| format!("{:.3}", made.distortion.symmetric_dirichlet)),
            pair(|made| made.cones.to_string()),
            pair(|made| made.cost()),
        ]);
        Ok(())
    })?;
    Ok(Section::new(table.to_string(), &[failures, missed].concat()))
}

/// Runs the other program; its CPU seconds.
fn run(program: &Path, mesh: &Path, map: &Path) -> Result<Vec<Option<f64>>, Box<dyn Error>> {
    let output = Command::new(program).args([mesh, map]).output()?;
    if !output.status.success() {
        return Err(format!("{}: {}", program.display(), output.status).into());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let last = text.lines().last().ok_or("it printed nothing")?;
    let seconds = Report::from(serde_json::from_str::<serde_json::Value>(last)?);
    Ok(["/field", "/integration"].map(|part| seconds.number(part)).to_vec())
}

/// A map that was made, by whomever.
struct Made {
    distortion: Distortion,
    cones: usize,
    /// Of its steps.
    seconds: Vec<Option<f64>>,
}

impl Made {
    fn new(
        subject: &Subject,
        map: &Path,
        seconds: Vec<Option<f64>>,
    ) -> Result<Self, Box<dyn Error>> {
        let corners = corner_uvs(&read_mesh(map)?).ok_or("the map has no UVs")?;
        let mesh = &subject.mesh.connectivity;
        if corners.len() != mesh.n_halfedges() {
            return Err("the map is one of another mesh".into());
        }
        let metric = Metric::from_positions(mesh, &subject.mesh.positions);
        let distortion = distortion(mesh, &metric, &corners);
        Ok(Self { distortion, cones: cones(mesh, &corners), seconds })
    }

    fn cost(&self) -> String {
        let seconds = self.seconds.iter().map(|s| s.map_or("-".into(), |s| format!("{s:.2}")));
        seconds.collect::<Vec<String>>().join(" + ")
    }

    /// What is not as it should be, beside another map.
    fn fault(&self, there: Option<&Self>) -> Option<String> {
        let Distortion { flipped, tau, symmetric_dirichlet: energy, .. } = self.distortion;
        if flipped > 0 {
            return Some(format!("{flipped} triangles are flipped"));
        }
        let there = &there?.distortion;
        let is_worse = tau > there.tau || energy > there.symmetric_dirichlet;
        is_worse.then(|| {
            format!(
                "tau {tau:.2}, energy {energy:.3}; there {:.2} and {:.3}",
                there.tau, there.symmetric_dirichlet
            )
        })
    }
}

/// Interior vertices whose angle in a map is nearer to other multiples of a quarter turn than to four.
fn cones(mesh: &TriMesh, corner_uvs: &[[f64; 2]]) -> usize {
    let mut angle = vec![0.0; mesh.n_vertices()];
    for h in mesh.halfedges() {
        let [at, next, last] = [h, h.next(), h.prev()].map(|h| corner_uvs[h.at()]);
        let [a, b] = [next, last].map(|to| [to[0] - at[0], to[1] - at[1]]);
        let turn = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]);
        angle[mesh.origin(h).at()] += turn;
    }
    let is_cone = |angle: f64| ((TAU - angle) / FRAC_PI_2).round() != 0.0;
    let inner = mesh.vertices().filter(|&v| !mesh.is_boundary(v));
    inner.filter(|v| mesh.outgoing(*v).next().is_some() && is_cone(angle[v.at()])).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tip_of_a_box_is_a_cone() {
        // Three triangles around a vertex, each with a right angle there.
        let mesh = TriMesh::from_faces(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]]).unwrap();
        let right = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(cones(&mesh, &right.repeat(3)), 1);
        let third = [[0.0, 0.0], [1.0, 0.0], [-0.5, 0.75_f64.sqrt()]];
        assert_eq!(cones(&mesh, &third.repeat(3)), 0);
    }

    #[test]
    fn a_map_that_is_worse_is_a_fault() {
        let mesh = TriMesh::from_faces(3, &[[0, 1, 2]]).unwrap();
        let metric = Metric::from_positions(&mesh, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        let made = |uvs: [[f64; 2]; 3]| Made {
            distortion: distortion(&mesh, &metric, &uvs),
            cones: 0,
            seconds: vec![Some(1.0), None],
        };
        let flat = made([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let long = made([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]);
        let flipped = made([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
        assert_eq!(flat.fault(Some(&long)), None);
        assert_eq!(flat.fault(None), None);
        assert!(long.fault(Some(&flat)).is_some_and(|fault| fault.starts_with("tau 1.41")));
        assert!(flipped.fault(None).is_some());
        assert_eq!(flat.cost(), "1.00 + -");
    }
}
