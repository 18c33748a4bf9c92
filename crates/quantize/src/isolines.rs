//! Isolines: along straight runs of aligned edges one coordinate is the same, and has to be integral.

use crate::base::Base;
use crate::gauss::{Form, Gauss, Overflow, add_scaled, scaled};
use num_complex::Complex64;
use seamstress_mesh::features::{EdgeSet, Sector, sectors};
use seamstress_mesh::{Halfedge, TriMesh, VertexData};
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;

/// Where aligned edges turn: vertices with a sector between two of them whose angle is not straight. These
/// have to be grid points; so does a boundary that turns back.
///
/// `position` gives the place of a corner in the plane of its face.
pub fn turning_points(
    mesh: &TriMesh,
    aligned: &EdgeSet,
    position: impl Fn(Halfedge) -> Complex64,
) -> VertexData<bool> {
    let angle = |h: &Halfedge| {
        let at = position(*h);
        ((position(h.next()) - at).conj() * (position(h.prev()) - at)).arg()
    };
    let turns = |v| {
        let sectors = sectors(mesh, aligned, v);
        let is_straight = |sector: &Sector| {
            (sector.corners.iter().map(angle).sum::<f64>() / FRAC_PI_2).round() == 2.0
        };
        let is_between = |sector: &&Sector| !sector.is_free;
        // Two straight sectors at a boundary are the tip of a slit, and an edge that goes on from it.
        let turns_back = mesh.is_boundary(v) && sectors.iter().filter(is_between).count() > 1;
        let bends = sectors.iter().filter(is_between).any(|sector| !is_straight(sector));
        aligned.around(mesh, v).nth(1).is_some() && (bends || turns_back)
    };
    mesh.vertices().map(turns).collect()
}

/// The integral coordinate of an ordinary vertex on an isoline.
#[derive(Debug, Clone)]
pub struct Tie {
    /// Which coordinate of its position: 0 or 1.
    pub coordinate: u32,
    /// Its value as a form in the held unknowns.
    pub level: Form,
}

/// The levels of all isolines.
#[derive(Debug, Clone)]
pub struct Levels {
    /// For each ordinary vertex.
    pub ties: Vec<Option<Tie>>,
    /// For each isoline that holds no grid point, a wedge on it and the coordinate that is its level.
    pub wedges: Vec<(u32, u32)>,
    /// Forms in the held unknowns that have to vanish for both ends of every aligned edge to be at the same
    /// level.
    pub relations: Vec<Form>,
}

impl Levels {
    /// Follows the aligned edges, given by the wedges of their ends and the coordinate these share.
    ///
    /// Levels spread from grid points along the edges, then from one vertex of each isoline without such a
    /// point, whose level becomes a held unknown of its own.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn new(
        bases: &[Base],
        forms: &[Form],
        n_ordinary: usize,
        n_variables: usize,
        edges: &[([u32; 2], u32)],
    ) -> Result<Self, Overflow> {
        let mut spread = Spread { bases, forms, ties: vec![None; n_ordinary] };
        let mut at_vertex: Vec<Vec<u32>> = vec![Vec::new(); n_ordinary];
        let mut queue = VecDeque::new();
        for (k, (ends, _)) in edges.iter().enumerate() {
            for &wedge in ends {
                match bases[wedge as usize] {
                    Base::Ordinary { vertex, .. } => at_vertex[vertex as usize].push(k as u32),
                    Base::Fixed => queue.push_back(k as u32),
                }
            }
        }
        let mut wedges = Vec::new();
        let mut next = 0;
        loop {
            while let Some(k) = queue.pop_front() {
                let (ends, coordinate) = edges[k as usize];
                if let Some(vertex) = spread.along(ends, coordinate)? {
                    queue.extend(&at_vertex[vertex as usize]);
                }
            }
            // An isoline that no level has reached.
            let is_new = |(ends, _): &([u32; 2], u32)| spread.is_unknown(ends[0]);
            let Some(found) = edges[next..].iter().position(is_new) else { break };
            next += found;
            let ([wedge, _], coordinate) = edges[next];
            let unknown = (2 * n_variables + wedges.len()) as u32;
            if let Some(vertex) = spread.begin(wedge, coordinate, unknown) {
                wedges.push((wedge, coordinate));
                queue.extend(&at_vertex[vertex as usize]);
            }
        }
        let mut relations = Vec::new();
        for &([a, b], coordinate) in edges {
            let (Some(mut form), Some(other)) =
                (spread.level(a, coordinate)?, spread.level(b, coordinate)?)
            else {
                continue;
            };
            add_scaled(&mut form, &other, Gauss::ONE.negated())?;
            if !form.is_empty() {
                relations.push(form);
            }
        }
        relations.sort();
        relations.dedup();
        Ok(Self { ties: spread.ties, wedges, relations })
    }
}

struct Spread<'a> {
    bases: &'a [Base],
    forms: &'a [Form],
    ties: Vec<Option<Tie>>,
}

impl Spread<'_> {
    fn is_unknown(&self, wedge: u32) -> bool {
        matches!(self.bases[wedge as usize],
            Base::Ordinary { vertex, .. } if self.ties[vertex as usize].is_none())
    }

    /// The level of a wedge, if it is known.
    fn level(&self, wedge: u32, coordinate: u32) -> Result<Option<Form>, Overflow> {
        let wedge = wedge as usize;
        level(self.bases[wedge], &self.forms[wedge], &self.ties, coordinate)
    }

    /// Carries the level from one end of an edge to the other; the vertex that it reaches, if it is new.
    fn along(&mut self, ends: [u32; 2], coordinate: u32) -> Result<Option<u32>, Overflow> {
        for [from, to] in [ends, [ends[1], ends[0]]] {
            let Base::Ordinary { vertex, turns } = self.bases[to as usize] else { continue };
            if self.ties[vertex as usize].is_some() {
                continue;
            }
            let Some(mut level) = self.level(from, coordinate)? else { continue };
            let own = part(&self.forms[to as usize], coordinate);
            add_scaled(&mut level, &own, Gauss::ONE.negated())?;
            let (of_x, sign) = tied(coordinate, turns);
            let level = scaled(&level, sign)?;
            self.ties[vertex as usize] = Some(Tie { coordinate: of_x, level });
            return Ok(Some(vertex));
        }
        Ok(None)
    }

    /// Gives a vertex a level of its own.
    fn begin(&mut self, wedge: u32, coordinate: u32, unknown: u32) -> Option<u32> {
        let Base::Ordinary { vertex, turns } = self.bases[wedge as usize] else { return None };
        let level = Form::from([(unknown, Gauss::ONE)]);
        self.ties[vertex as usize] = Some(Tie { coordinate: tied(coordinate, turns).0, level });
        Some(vertex)
    }
}

/// Which coordinate of `x` a coordinate of `i^turns x` is, and its sign.
pub fn tied(coordinate: u32, turns: i32) -> (u32, Gauss) {
    let (of_x, sign) = match (coordinate, turns.rem_euclid(4)) {
        (c, 0) => (c, 1),
        (0, 1) => (1, -1),
        (_, 1) => (0, 1),
        (c, 2) => (c, -1),
        (0, _) => (1, 1),
        _ => (0, -1),
    };
    (of_x, Gauss { re: sign, im: 0 })
}

/// A coordinate of a wedge with this base and form, if it is integral.
///
/// # Errors
/// [`Overflow`].
pub fn level(
    base: Base,
    form: &Form,
    ties: &[Option<Tie>],
    coordinate: u32,
) -> Result<Option<Form>, Overflow> {
    let mut level = part(form, coordinate);
    if let Base::Ordinary { vertex, turns } = base {
        let (of_x, sign) = tied(coordinate, turns);
        match &ties[vertex as usize] {
            Some(tie) if tie.coordinate == of_x => add_scaled(&mut level, &tie.level, sign)?,
            _ => return Ok(None),
        }
    }
    Ok(Some(level))
}

/// The real (0) or imaginary (1) part of a form in complex variables, as a form in their real and imaginary
/// parts by turns.
pub fn part(form: &Form, coordinate: u32) -> Form {
    let parts = form.iter().flat_map(|(&v, c)| {
        let [re, im] = if coordinate == 0 { [c.re, c.im.saturating_neg()] } else { [c.im, c.re] };
        [(2 * v, re), (2 * v + 1, im)]
    });
    parts.filter(|(_, c)| *c != 0).map(|(k, re)| (k, Gauss { re, im: 0 })).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::Vertex;

    /// Four triangles around vertex 0 at the tip of a slit along `-x`, whose sides end at 1 and 5.
    fn slit() -> (TriMesh, [Complex64; 6]) {
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        let at = [[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
        (TriMesh::from_faces(6, &faces).unwrap(), at.map(|[u, v]| Complex64::new(u, v)))
    }

    #[test]
    fn a_slit_ends_at_a_grid_point_also_where_a_feature_goes_straight_on() {
        let (mesh, at) = slit();
        let tip_turns = |others: &[u32]| {
            let edges = others.iter().map(|&v| mesh.edge_between(Vertex(0), Vertex(v)).unwrap());
            let aligned = EdgeSet::new(&mesh, edges);
            turning_points(&mesh, &aligned, |h| at[mesh.origin(h).at()])[Vertex(0)]
        };
        assert!(tip_turns(&[1, 5]));
        assert!(tip_turns(&[1, 3, 5]));
        // One side of the slit alone, or with what goes straight on, does not turn.
        assert!(!tip_turns(&[1]) && !tip_turns(&[1, 3]));
    }
}
