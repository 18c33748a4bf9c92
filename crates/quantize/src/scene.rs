//! A layout with its exact description, and lines on it.

use crate::gauss::{Form, Gauss, Overflow, add_scaled};
use crate::linear::{Row, negated};
use crate::space::{GridNeeds, IntegerSpace};
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, Vertex};
use seamstress_parametrize::cut::Cut;

/// Edges of a loop from a grid point back to itself at a minimum: with one or two, two edges of quads would join the
/// same two points.
const MINIMUM_LOOP: i64 = 3;

/// A layout of a cut mesh and the space it lies in.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The mesh.
    pub mesh: &'a TriMesh,
    /// Its cut.
    pub cut: &'a Cut,
    /// The matching of every half-edge.
    pub matching: &'a HalfedgeData<i32>,
    /// What has to come to lie on the grid.
    pub needs: &'a GridNeeds,
    /// How wedges depend on what is integral.
    pub space: &'a IntegerSpace,
    /// Positions of the wedges.
    pub z: &'a [Complex64],
}

/// How a path of faces carries a position `q` in its last face back to the first: `i^turns q + form in X`.
#[derive(Debug, Clone, Default)]
pub struct Carry {
    /// Quarter turns.
    pub turns: i32,
    /// Translation.
    pub form: Form,
}

/// A straight line on the flat surface from one grid point to another, or back to the same (a saddle connection);
/// or from a vertex on an isoline, or a grid point, straight across to another isoline.
#[derive(Debug, Clone)]
pub struct Connection {
    /// The vertices at its ends; of an isoline, one on it.
    pub ends: [Vertex; 2],
    /// Its length, in the units of the layout.
    pub length: f64,
    /// Real and imaginary part of the displacement from its first to its second end, as exact forms in the
    /// coordinates. The second is empty for lines to an isoline.
    pub rows: [Row; 2],
    /// Grid units that a walk along the grid from one end to the other must have at a minimum.
    pub minimum: i64,
}

/// A grid point seen from a corner: the corner, the corner where it was found, and the edges crossed.
#[derive(Debug, Clone)]
pub struct Sight {
    /// Corner at the first end.
    pub from: Halfedge,
    /// Corner at the second end.
    pub to: Halfedge,
    /// Distance.
    pub length: f64,
    /// Half-edges crossed on the way, each in the face that is left.
    pub crossed: Vec<Halfedge>,
}

impl Scene<'_> {
    /// Position of a corner.
    pub fn at(&self, corner: Halfedge) -> Complex64 {
        self.z[self.cut.wedge[corner] as usize]
    }

    /// A path of faces that goes on across a half-edge of its last one.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn across(&self, path: Carry, h: Halfedge) -> Result<Carry, Overflow> {
        let Carry { mut turns, mut form } = path;
        if let Some((chain, along)) = self.space.graph().chain_of[h] {
            let after = turns - self.matching[h];
            let t = Form::from([(chain, Gauss::ONE)]);
            // A point q beyond the seam is at i^-r (q - t), from its left side; from the right,
            // the chain's own translation leads back.
            let factor = if along { Gauss::unit(after).negated() } else { Gauss::unit(turns) };
            add_scaled(&mut form, &t, factor)?;
            turns = after;
        }
        Ok(Carry { turns, form })
    }

    /// The path of faces that crosses these half-edges, each in the face that is left.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn path(&self, crossed: &[Halfedge]) -> Result<Carry, Overflow> {
        crossed.iter().try_fold(Carry::default(), |path, &h| self.across(path, h))
    }

    /// The straight line from a corner at a grid point to another, through faces.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn line(&self, sight: &Sight) -> Result<Connection, Overflow> {
        let Carry { turns, mut form } = self.path(&sight.crossed)?;
        let [to, from] = [sight.to, sight.from].map(|h| self.space.form(self.cut.wedge[h]));
        add_scaled(&mut form, to, Gauss::unit(turns))?;
        add_scaled(&mut form, from, Gauss::ONE.negated())?;
        let rows = self.space.rows(&form)?;
        let ends = [sight.from, sight.to].map(|h| self.mesh.origin(h));
        let minimum = if ends[0] == ends[1] { MINIMUM_LOOP } else { 1 };
        Ok(Connection { ends, length: sight.length, rows, minimum })
    }
}

/// One for lines that differ by a unit only, with what the strictest of them asks for, shortest first; those that
/// vanish identically are left out.
pub fn distinct(mut lines: Vec<Connection>) -> Vec<Connection> {
    lines.retain(|line| line.rows.iter().any(|row| !row.is_empty()));
    lines.iter_mut().for_each(|line| line.rows = canonical(std::mem::take(&mut line.rows)));
    lines.sort_by(|a, b| a.rows.cmp(&b.rows).then(a.length.total_cmp(&b.length)));
    lines.dedup_by(|other, line| {
        let is_same = other.rows == line.rows;
        line.minimum = line.minimum.max(if is_same { other.minimum } else { 0 });
        is_same
    });
    lines.sort_by(|a, b| a.length.total_cmp(&b.length).then(a.rows.cmp(&b.rows)));
    lines
}

/// The multiple by a unit that comes last in the order of rows.
fn canonical([re, im]: [Row; 2]) -> [Row; 2] {
    let [back, down] = [negated(&re), negated(&im)];
    let turned = [[down.clone(), re.clone()], [back.clone(), down], [im.clone(), back]];
    turned.into_iter().fold([re, im], |a, b| a.max(b))
}
