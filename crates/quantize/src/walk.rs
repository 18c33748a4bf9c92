//! How the wedges around each vertex follow from each other.

use crate::base::Base;
use crate::gauss::{Form, Gauss, Overflow, add_scaled, scaled};
use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, Vertex};
use seamstress_parametrize::cut::{Cut, SeamGraph};

/// Walks around the vertices and writes down how the wedges follow from each other.
pub(super) struct Walker<'a> {
    mesh: &'a TriMesh,
    cut: &'a Cut,
    graph: &'a SeamGraph,
    matching: &'a HalfedgeData<i32>,
    pub(super) bases: Vec<Base>,
    pub(super) forms: Vec<Form>,
    /// What must vanish for the walks around interior vertices to close.
    pub(super) relations: Vec<Form>,
}

impl<'a> Walker<'a> {
    pub(super) fn new(
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
    pub(super) fn start(&self, v: Vertex) -> Option<Halfedge> {
        let mut fan = self.mesh.outgoing(v);
        let first = fan.next()?;
        if self.mesh.is_boundary(v) || self.cut.is_seam[first] {
            return Some(first);
        }
        Some(fan.find(|&h| self.cut.is_seam[h]).unwrap_or(first))
    }

    /// Walks once around a vertex, from a wedge at `i^0` times its position plus a form.
    pub(super) fn walk(
        &mut self,
        v: Vertex,
        ordinary: Option<u32>,
        start: Form,
    ) -> Result<(), Overflow> {
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
    pub(super) fn hold_last(&mut self, n_ordinary: &mut u32) -> u32 {
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
