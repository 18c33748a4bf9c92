//! What the rounding of one layout has to keep, with what the search has learned about it.

use crate::connections::connections;
use crate::faces::{PointFace, point_faces};
use crate::farkas::FarkasCut;
use crate::gauss::Overflow;
use crate::layout::SeamlessLayout;
use crate::rays::lines_to_isolines;
use crate::rounding::{Constraint, ReducedEnergy, RoundingProblem, Rule};
use crate::scene::{Connection, distinct};
use crate::stretches::{Stretch, stretches};
use seamstress_mesh::Metric;

/// Lines shorter than this in the seamless map are constrained, grid units.
const CONSTRAINED_LENGTH: f64 = 2.5;

/// Conditions on the integers of a layout, on any grid. What is learned stays when the grid changes.
#[derive(Default)]
pub(crate) struct Obstacles {
    /// The radius up to which lines are known, and these lines; in the layout's units.
    near: (f64, Vec<Connection>),
    /// Faces of the mesh whose corners are grid points.
    faces: Vec<PointFace>,
    /// Curves that should have a number of cells.
    stretches: Vec<Stretch>,
    /// Infeasibility cuts.
    cuts: Vec<(FarkasCut, Rule)>,
}

/// Between whole numbers.
const HALF: f64 = 0.5;

impl Obstacles {
    /// Nothing but what is known of a layout before any rounding.
    ///
    /// # Errors
    /// [`Overflow`].
    pub(crate) fn new(layout: &SeamlessLayout<'_>, metric: &Metric) -> Result<Self, Overflow> {
        let z = layout.z();
        let scene = layout.scene(&z);
        let stretches = stretches(&scene, metric, layout.unit, &layout.coordinates)?;
        Ok(Self { faces: point_faces(&scene)?, stretches, ..Self::default() })
    }

    /// Adds cuts with the conditions that they impose.
    pub(crate) fn learn(&mut self, cuts: impl IntoIterator<Item = (FarkasCut, Rule)>) {
        self.cuts.extend(cuts);
    }

    /// Forgets all cuts; says how many there were.
    pub(crate) fn forget_cuts(&mut self) -> usize {
        self.cuts.drain(..).count()
    }

    /// The rounding problem of a layout for cells of size `h`, in its units.
    ///
    /// # Errors
    /// [`Overflow`].
    pub(crate) fn problem<'a>(
        &mut self,
        layout: &SeamlessLayout<'_>,
        energy: &'a ReducedEnergy,
        h: f64,
    ) -> Result<RoundingProblem<'a>, Overflow> {
        let radius = CONSTRAINED_LENGTH * h;
        if radius > self.near.0 {
            let z = layout.z();
            let scene = layout.scene(&z);
            let mut lines = connections(&scene, radius)?;
            lines.extend(lines_to_isolines(&scene, radius)?);
            self.near = (radius, distinct(lines));
        }
        let from = &layout.coordinates;
        let short = self.near.1.iter().filter(|line| line.length < radius);
        let constraints = short.map(|line| Constraint::new(line, from, h)).collect();
        let mean = from.iter().map(|x| x / h).collect();
        let mut problem = RoundingProblem { energy, mean, constraints, joint: Vec::new() };
        for face in self.faces.iter().filter(|face| face.extent < radius) {
            let sides = face.sides.iter().map(|side| Constraint::new(side, from, h));
            problem.add(sides, Rule::Oriented);
        }
        for stretch in &self.stretches {
            let cells = stretch.cells(h);
            // Of others rounding leaves enough.
            if cells > 1.0 && cells + 1.0 > stretch.displacement / h {
                let rule = Rule::Beyond { forces: [1.0].into(), bound: cells - HALF };
                problem.add([Constraint::free(stretch.row.clone())].into_iter(), rule);
            }
        }
        for (cut, rule) in &self.cuts {
            let parts = cut.differences.iter().cloned().map(Constraint::free);
            problem.add(parts, rule.clone());
        }
        Ok(problem)
    }
}
