//! Quads against the surface and the map that they come from.

use crate::manifold::Manifold;
use crate::violation::{Violation, Violations};
use std::collections::{BTreeMap, BTreeSet};

/// Quads, and what they were extracted from.
#[derive(Debug, Clone, Copy)]
pub struct Quads<'a> {
    /// The vertices of each quad, counter-clockwise as the faces of the surface.
    pub quads: &'a [[u32; 4]],
    /// For each vertex of the quads, a face of the surface that it comes from.
    pub sources: &'a [u32],
    /// Number of vertices of the surface.
    pub n_vertices: usize,
    /// Faces of the surface.
    pub faces: &'a [[u32; 3]],
    /// Whether the boundary cuts cells, which are left out: then nothing follows for components with a boundary.
    pub is_trimmed: bool,
}

/// What was checked of quads.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuadCertificate {
    /// Quads, an oriented manifold.
    pub quads: usize,
    /// Components of the surface with the topology of their quads.
    pub components: usize,
    /// Interior vertices without four quads, which are the cones of the map.
    pub irregular: usize,
}

impl Quads<'_> {
    /// Certifies that the quads are an oriented manifold; that none joins two components of the surface; and that those
    /// of a component which no boundary cuts are in one piece, with its Euler characteristic and boundary.
    ///
    /// A component may have no quads at all.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn check(&self) -> Result<QuadCertificate, Violations> {
        let quads = Manifold::new(self.sources.len(), self.quads)?;
        let surface = Manifold::new(self.n_vertices, self.faces)?;
        let (piece_of, piece_characteristics) = quads.components();
        let (component_of, characteristics) = surface.components();
        let component = |v: &u32| component_of.get(self.sources[*v as usize] as usize);
        let is_stray = |quad: &[u32; 4]| {
            component(&quad[0]).is_none()
                || quad.iter().any(|v| component(v) != component(&quad[0]))
        };
        let stray = self.quads.iter().zip(0..).filter(|(quad, _)| is_stray(quad));
        Violations::unless_none(stray.map(|(_, quad)| Violation::StrayQuad { quad }))?;

        let open: BTreeSet<_> = surface.boundary().map(|h| component_of[h / 3]).collect();
        let open_pieces: BTreeSet<_> = quads.boundary().map(|h| piece_of[h / 4]).collect();
        let mut pieces_of: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for (quad, &piece) in self.quads.iter().zip(&piece_of) {
            component(&quad[0]).map(|&of| pieces_of.entry(of).or_default().insert(piece));
        }
        pieces_of.retain(|component, _| !(self.is_trimmed && open.contains(component)));
        let wrong = |(&component, pieces): (&usize, &BTreeSet<usize>)| {
            let surface = characteristics[component];
            let quads = pieces.iter().map(|&piece| piece_characteristics[piece]).sum();
            let pieces_end = !pieces.is_disjoint(&open_pieces);
            if pieces.len() > 1 {
                Some(Violation::QuadPieces { component, pieces: pieces.len() })
            } else if quads != surface {
                Some(Violation::QuadTopology { component, quads, surface })
            } else {
                let differs = pieces_end != open.contains(&component);
                differs.then_some(Violation::QuadBoundary { component })
            }
        };
        Violations::unless_none(pieces_of.iter().filter_map(wrong))?;
        let irregular = indices(&quads).values().sum();
        Ok(QuadCertificate { quads: self.quads.len(), components: pieces_of.len(), irregular })
    }

    /// Certifies that interior vertices have the indices of the cones of an integer-grid map, and that there are as many
    /// quads as its area in grid units has cells, to the nearest number: a boundary that nothing holds on the grid may lie
    /// beside it by rounding errors. It holds of maps whose boundary cuts no cell.
    ///
    /// # Errors
    /// Every violation.
    pub fn agree_with(&self, cones: &[i32], area: f64) -> Result<(), Violations> {
        let found = indices(&Manifold::new(self.sources.len(), self.quads)?);
        let expected = counts(cones.iter().copied());
        let all: BTreeSet<i32> = found.keys().chain(expected.keys()).copied().collect();
        let fault = |index| {
            let [irregular, cones] =
                [&found, &expected].map(|all| all.get(&index).copied().unwrap_or_default());
            (irregular != cones).then_some(Violation::QuadIndex { index, irregular, cones })
        };
        let quads = self.quads.len();
        let count = (quads as f64 != area.round()).then_some(Violation::QuadCount { quads, area });
        Violations::unless_none(all.into_iter().filter_map(fault).chain(count))
    }
}

/// How many interior vertices there are of each index other than 0.
fn indices(quads: &Manifold<4>) -> BTreeMap<i32, usize> {
    let interior = quads.vertices().filter(|&v| quads.is_interior(v) == Some(true));
    counts(interior.map(|v| 4 - quads.fan(v).count() as i32).filter(|&index| index != 0))
}

fn counts<T: Ord>(items: impl Iterator<Item = T>) -> BTreeMap<T, usize> {
    let mut counts = BTreeMap::new();
    items.for_each(|item| *counts.entry(item).or_default() += 1);
    counts
}
