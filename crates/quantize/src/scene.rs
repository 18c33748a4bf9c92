//! A layout with its exact description, and lines on it.

use super::conditional::Row;
use super::gauss::{Form, Gauss, Overflow, add_scaled};
use super::space::{GridNeeds, IntegerSpace};
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh};
use seamstress_parametrize::cut::Cut;

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

/// A straight line on the flat surface from one grid point to another, or back to the same; or the way from
/// an isoline, or a grid point, straight to another isoline.
#[derive(Debug, Clone)]
pub struct Connection {
    /// Its length, in the units of the layout.
    pub length: f64,
    /// Real and imaginary part of the way from its first to its second end, as exact forms in the
    /// coordinates. The second is empty for ways to an isoline.
    pub rows: [Row; 2],
    /// Grid units that a walk along the grid from one end to the other must have at least.
    pub least: i64,
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
        Ok(Connection { length: sight.length, rows: self.space.rows(&form)?, least: 1 })
    }
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

/// One for lines that differ by a unit only, with what the strictest of them asks for, shortest first; those
/// that vanish identically are left out.
pub fn distinct(mut connections: Vec<Connection>) -> Vec<Connection> {
    connections.retain(|c| c.rows.iter().any(|row| !row.is_empty()));
    for connection in &mut connections {
        connection.rows = canonical(std::mem::take(&mut connection.rows));
    }
    connections.sort_by(|a, b| a.rows.cmp(&b.rows).then(a.length.total_cmp(&b.length)));
    connections.dedup_by(|b, a| {
        let is_same = a.rows == b.rows;
        if is_same {
            a.least = a.least.max(b.least);
        }
        is_same
    });
    connections.sort_by(|a, b| a.length.total_cmp(&b.length).then(a.rows.cmp(&b.rows)));
    connections
}

/// The multiple by a unit that comes last in the order of rows.
fn canonical([re, im]: [Row; 2]) -> [Row; 2] {
    let negated = |row: &Row| -> Row { row.iter().map(|&(k, c)| (k, -c)).collect() };
    let [back, down] = [negated(&re), negated(&im)];
    let turned = [[down.clone(), re.clone()], [back.clone(), down], [im.clone(), back]];
    turned.into_iter().fold([re, im], |a, b| a.max(b))
}
