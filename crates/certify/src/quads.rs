//! Quads against the surface and the map that they come from.

use crate::manifold::Manifold;
use crate::verdict::{Checked, Violation, Violations};
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
    pub fn check(&self) -> Checked<QuadCertificate> {
        let quads = Manifold::new(self.sources.len(), self.quads)?;
        let surface = Manifold::new(self.n_vertices, self.faces)?;
        let ((piece_of, pieces), (component_of, components)) =
            (quads.components(), surface.components());
        let component = |v: u32| component_of.get(self.sources[v as usize] as usize).copied();
        let mut pieces_of: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        let mut stray = Vec::new();
        for ((quad, corners), &piece) in (0..).zip(self.quads).zip(&piece_of) {
            match component(corners[0]) {
                Some(of) if corners.iter().all(|&v| component(v) == Some(of)) => {
                    pieces_of.entry(of).or_default().insert(piece);
                }
                _ => stray.push(Violation::StrayQuad { quad }),
            }
        }
        Violations::unless_none(stray)?;
        pieces_of.retain(|&component, _| components[component].1 || !self.is_trimmed);
        let wrong = |(&component, of): (&usize, &BTreeSet<usize>)| {
            let (surface, is_closed) = components[component];
            let quads = of.iter().map(|&piece| pieces[piece].0).sum();
            let differs = of.iter().all(|&piece| pieces[piece].1) != is_closed;
            match of.len() {
                2.. => Some(Violation::QuadPieces { component, pieces: of.len() }),
                _ if quads != surface => {
                    Some(Violation::QuadTopology { component, quads, surface })
                }
                _ => differs.then_some(Violation::QuadBoundary { component }),
            }
        };
        Violations::unless_none(pieces_of.iter().filter_map(wrong))?;
        let irregular = indices(&quads).len();
        Ok(QuadCertificate { quads: self.quads.len(), components: pieces_of.len(), irregular })
    }

    /// Certifies that interior vertices have the indices of the cones of an integer-grid map, and that there are as many
    /// quads as its area in grid units has cells, to the nearest number: a boundary that nothing holds on the grid may lie
    /// beside it by rounding errors. It holds of maps whose boundary cuts no cell.
    ///
    /// # Errors
    /// Every violation.
    pub fn agree_with(&self, cones: &[i32], area: f64) -> Checked<()> {
        let mut counts: BTreeMap<i32, [usize; 2]> = BTreeMap::new();
        let irregular = indices(&Manifold::new(self.sources.len(), self.quads)?);
        irregular.into_iter().for_each(|index| counts.entry(index).or_default()[0] += 1);
        cones.iter().for_each(|&index| counts.entry(index).or_default()[1] += 1);
        let wrong = counts.into_iter().filter(|(_, [irregular, cones])| irregular != cones);
        let wrong = wrong.map(|(index, [irregular, cones])| Violation::QuadIndex {
            index,
            irregular,
            cones,
        });
        let quads = self.quads.len();
        let count = (quads as f64 != area.round()).then_some(Violation::QuadCount { quads, area });
        Violations::unless_none(wrong.chain(count))
    }
}

/// The indices of interior vertices other than 0.
fn indices(quads: &Manifold<4>) -> Vec<i32> {
    let stars = quads.stars().filter(|star| star.is_closed);
    stars.map(|star| 4 - star.corners.len() as i32).filter(|&index| index != 0).collect()
}
