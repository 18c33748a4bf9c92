//! Layouts as exact functions of vertex positions and of what must be integral.

use super::gauss::{Form, Gauss, Overflow, add_scaled, scaled};
use super::lattice::Lattice;
use crate::cut::{Cut, SeamGraph};
use crate::layout::space::{Expression, LinearSpace};
use crate::quarter::{turn, unit};
use num_complex::Complex64;
use seamstress_surface::{Halfedge, HalfedgeData, TriMesh, Vertex, VertexData};

/// What a wedge's position depends on besides the integral variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Base {
    /// `i^turns` times the position of an ordinary vertex.
    Ordinary {
        /// Its number among the ordinary vertices.
        vertex: u32,
        /// Quarter turns.
        turns: i32,
    },
    /// Nothing: the wedge is at a cone, or at the vertex that is held at the origin.
    Fixed,
}

/// `z_wedge = i^turns x_vertex + form in X`, with X the translation of every chain of seams and the
/// position of every cone, all of them integral in an integer map.
#[derive(Debug, Clone)]
pub struct IntegerSpace {
    bases: Vec<Base>,
    forms: Vec<Form>,
    n_ordinary: usize,
    lattice: Lattice,
    chains: Vec<ChainEnds>,
    /// A wedge of each cone.
    cones: Vec<u32>,
    origin: Origin,
}

/// The wedges on both sides of a chain's first vertex, and its matching.
#[derive(Debug, Clone, Copy)]
struct ChainEnds {
    left: u32,
    right: u32,
    matching: i32,
}

/// What a layout is translated by to meet the pin.
#[derive(Debug, Clone, Copy)]
enum Origin {
    Wedge(u32),
    Chain(ChainEnds),
}

impl IntegerSpace {
    /// The space over a cut and its matchings; `is_cone` marks the singular vertices, those whose index
    /// is a multiple of four included.
    ///
    /// Layouts may be translated. That freedom is used to hold something at zero: a cone, without
    /// cones the translation of a chain that turns, without such chains one vertex.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn new(
        mesh: &TriMesh,
        cut: &Cut,
        matching: &HalfedgeData<i32>,
        is_cone: &VertexData<bool>,
    ) -> Result<Self, Overflow> {
        let graph = SeamGraph::new(mesh, cut, is_cone);
        let ends = |&h: &Halfedge| {
            let [left, _, right, _] = cut.seam_wedges(mesh, h);
            ChainEnds { left, right, matching: matching[h] }
        };
        let chains: Vec<_> =
            graph.chains.iter().filter_map(|chain| chain.left.first().map(ends)).collect();
        let mut walker = Walker::new(mesh, cut, &graph, matching);
        let mut cones = Vec::new();
        let mut n_ordinary = 0;
        for v in mesh.vertices() {
            let Some(first) = walker.start(v) else { continue };
            if is_cone[v] {
                let position = (chains.len() + cones.len()) as u32;
                cones.push(cut.wedge[first]);
                walker.walk(v, None, Form::from([(position, Gauss::ONE)]))?;
            } else {
                walker.walk(v, Some(n_ordinary), Form::new())?;
                n_ordinary += 1;
            }
        }
        let turning = chains.iter().position(|chain| chain.matching.rem_euclid(4) != 0);
        let (pinned, origin) = match (cones.first(), turning) {
            (Some(&wedge), _) => (Some(chains.len() as u32), Origin::Wedge(wedge)),
            (None, Some(k)) => (Some(k as u32), Origin::Chain(chains[k])),
            (None, None) => (None, Origin::Wedge(walker.hold_last(&mut n_ordinary))),
        };
        let lattice = Lattice::new(chains.len() + cones.len(), &walker.relations, pinned)?;
        let Walker { bases, forms, .. } = walker;
        let n_ordinary = n_ordinary as usize;
        Ok(Self { bases, forms, n_ordinary, lattice, chains, cones, origin })
    }

    /// Number of ordinary vertices that may move.
    pub fn n_ordinary(&self) -> usize {
        self.n_ordinary
    }

    /// Number of wedges.
    pub fn n_wedges(&self) -> usize {
        self.bases.len()
    }

    /// The integral variables.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// What moves a wedge besides the integral variables.
    pub fn base(&self, wedge: u32) -> Base {
        self.bases[wedge as usize]
    }

    /// The part of a wedge's position that the integral variables give.
    pub fn form(&self, wedge: u32) -> &Form {
        &self.forms[wedge as usize]
    }

    /// The linear space with the pairs of unknowns `x` of the ordinary vertices first, then X.
    pub fn linear(&self) -> LinearSpace {
        let n = self.n_ordinary as u32;
        let row = |(base, form): (&Base, &Form)| {
            let mut row: Expression = form.iter().map(|(&v, c)| (n + v, c.to_complex())).collect();
            if let Base::Ordinary { vertex, turns } = base {
                row.insert(*vertex, unit(*turns));
            }
            row
        };
        let rows: Vec<Expression> = self.bases.iter().zip(&self.forms).map(row).collect();
        LinearSpace::from_complex(&rows, self.n_ordinary + self.lattice.n_variables())
    }

    /// The coordinates zeta and positions `x` of a layout, after translating it to meet the pin.
    ///
    /// Each is read at one place; what the seams are open by shows at the others.
    pub fn read(&self, z: &[Complex64]) -> (Vec<Complex64>, Vec<Complex64>) {
        let at = |w: u32| z[w as usize];
        let translation =
            |c: &ChainEnds, by: Complex64| at(c.right) - by - turn(at(c.left) - by, c.matching);
        let origin = match self.origin {
            Origin::Wedge(w) => at(w),
            Origin::Chain(c) => {
                translation(&c, Complex64::ZERO) / (Complex64::ONE - unit(c.matching))
            }
        };
        let mut variables: Vec<Complex64> =
            self.chains.iter().map(|c| translation(c, origin)).collect();
        variables.extend(self.cones.iter().map(|&w| at(w) - origin));
        let zeta = self.coordinates(&variables);
        let exact = self.variables(&zeta);
        let mut x = vec![Complex64::ZERO; self.n_ordinary];
        for (w, base) in self.bases.iter().enumerate() {
            if let Base::Ordinary { vertex, turns } = *base {
                let moved = z[w] - origin - evaluate(&self.forms[w], &exact);
                x[vertex as usize] = turn(moved, -turns);
            }
        }
        (zeta, x)
    }

    /// The coordinates zeta of integral variables.
    pub fn coordinates(&self, variables: &[Complex64]) -> Vec<Complex64> {
        (0..self.lattice.rank()).map(|k| evaluate(self.lattice.coordinate(k), variables)).collect()
    }

    /// `X = B zeta` for any complex zeta.
    pub fn variables(&self, zeta: &[Complex64]) -> Vec<Complex64> {
        (0..self.lattice.n_variables()).map(|v| evaluate(self.lattice.row(v), zeta)).collect()
    }
}

/// The value of a form at complex variables.
pub fn evaluate(form: &Form, at: &[Complex64]) -> Complex64 {
    form.iter().map(|(&v, c)| c.to_complex() * at[v as usize]).sum()
}

/// Walks around the vertices and writes down how the wedges follow from each other.
struct Walker<'a> {
    mesh: &'a TriMesh,
    cut: &'a Cut,
    graph: &'a SeamGraph,
    matching: &'a HalfedgeData<i32>,
    bases: Vec<Base>,
    forms: Vec<Form>,
    relations: Vec<Form>,
}

impl<'a> Walker<'a> {
    fn new(
        mesh: &'a TriMesh,
        cut: &'a Cut,
        graph: &'a SeamGraph,
        matching: &'a HalfedgeData<i32>,
    ) -> Self {
        Self {
            mesh,
            cut,
            graph,
            matching,
            bases: vec![Base::Fixed; cut.n_wedges],
            forms: vec![Form::new(); cut.n_wedges],
            relations: Vec::new(),
        }
    }

    /// Where the walk around a vertex starts: at the boundary, behind a seam, or anywhere.
    fn start(&self, v: Vertex) -> Option<Halfedge> {
        let mut fan = self.mesh.outgoing(v);
        let first = fan.next()?;
        if self.mesh.is_boundary(v) || self.cut.is_seam[first] {
            return Some(first);
        }
        Some(fan.find(|&h| self.cut.is_seam[h]).unwrap_or(first))
    }

    /// Walks once around a vertex, from a wedge at `i^0` times its position plus a form.
    fn walk(&mut self, v: Vertex, ordinary: Option<u32>, start: Form) -> Result<(), Overflow> {
        let Some(first) = self.start(v) else { return Ok(()) };
        let mut fan: Vec<Halfedge> = self.mesh.outgoing(v).collect();
        let begin = fan.iter().position(|&h| h == first).unwrap_or(0);
        fan.rotate_left(begin);
        let (mut turns, mut form) = (0, start.clone());
        for (k, &h) in fan.iter().enumerate() {
            if k > 0 && self.cut.is_seam[h] {
                (turns, form) = self.across(h, turns, &form)?;
            }
            let wedge = self.cut.wedge[h] as usize;
            self.bases[wedge] =
                ordinary.map_or(Base::Fixed, |vertex| Base::Ordinary { vertex, turns });
            self.forms[wedge] = form.clone();
        }
        if !self.mesh.is_boundary(v) && self.cut.is_seam[first] {
            let (_, mut relation) = self.across(first, turns, &form)?;
            add_scaled(&mut relation, &start, Gauss::ONE.negated())?;
            if !relation.is_empty() {
                self.relations.push(relation);
            }
        }
        Ok(())
    }

    /// From the wedge on the right of an outgoing seam to the one on its left.
    fn across(&self, seam: Halfedge, turns: i32, right: &Form) -> Result<(i32, Form), Overflow> {
        let back = -self.matching[seam];
        let mut left = scaled(right, Gauss::unit(back))?;
        if let Some((chain, along)) = self.graph.chain_of[seam] {
            // along the chain: right = i^r left + t; against it: left = i^-r right + t
            let factor = if along { Gauss::unit(back).negated() } else { Gauss::ONE };
            add_scaled(&mut left, &Form::from([(chain, Gauss::ONE)]), factor)?;
        }
        Ok((turns + back, left))
    }

    /// Holds the ordinary vertex of the highest number at the origin; returns a wedge of it.
    fn hold_last(&mut self, n_ordinary: &mut u32) -> u32 {
        *n_ordinary = n_ordinary.saturating_sub(1);
        let mut held = 0;
        for (w, base) in self.bases.iter_mut().enumerate() {
            if matches!(*base, Base::Ordinary { vertex, .. } if vertex == *n_ordinary) {
                if self.forms[w].is_empty() {
                    held = w as u32;
                }
                *base = Base::Fixed;
            }
        }
        held
    }
}
