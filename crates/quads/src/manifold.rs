//! Integer maps fine enough for their quads to be a manifold.

use crate::{ExtractError, ExtractOptions, Extraction, QuadConnectivity, QuadFaults, extract};
use seamstress_mesh::TriMesh;
use seamstress_quantize::{GridSize, IntegerSolution};

/// An integer map and its quads, an oriented manifold.
#[derive(Debug)]
#[non_exhaustive]
pub struct ManifoldQuads {
    /// The map.
    pub integer: IntegerSolution,
    /// Its quads.
    pub extraction: Extraction,
    /// Who is whose neighbour among them.
    pub connectivity: QuadConnectivity,
    /// Coarser maps whose quads were no manifold.
    pub refinements: usize,
}

/// Why there are no such quads.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ManifoldError<E> {
    /// There is no integer map.
    #[error(transparent)]
    Integer(E),
    /// There are no quads.
    #[error(transparent)]
    Extract(#[from] ExtractError),
    /// They are no manifold, however fine the grid.
    #[error("the quads are no manifold: {0}")]
    NoManifold(#[from] QuadFaults),
}

/// Finer grids tried. They double the number of quads more than twice.
const MOST_REFINEMENTS: usize = 9;
/// A finer grid's cells are shorter by this factor.
const FINER: f64 = 1.1;

/// Makes an integer map and extracts its quads; where they are no manifold, on a finer grid.
///
/// Where a component, or the space between cones, is only a cell or two wide, a cell of the grid may have
/// itself as a neighbour, or another one twice. No mesh of the usual kind can say so. `make` makes the map
/// for the grid it is given.
///
/// # Errors
/// What `make` and [`extract()`] return, and the faults of the quads of the finest grid tried.
pub fn manifold_quads<E>(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    size: GridSize,
    mut make: impl FnMut(GridSize) -> Result<IntegerSolution, E>,
) -> Result<ManifoldQuads, ManifoldError<E>> {
    let (mut size, mut refinements) = (size, 0);
    loop {
        let integer = make(size).map_err(ManifoldError::Integer)?;
        let options = ExtractOptions::default();
        let extraction = extract(mesh, positions, integer.map.corner_uvs(), &options)?;
        match extraction.mesh.connectivity() {
            Ok(connectivity) => {
                return Ok(ManifoldQuads { integer, extraction, connectivity, refinements });
            }
            Err(faults) if refinements == MOST_REFINEMENTS => return Err(faults.into()),
            Err(_) => {
                refinements += 1;
                // Cones may have asked for more quads already.
                size = match finer(size, FINER) {
                    GridSize::Quads(n) => GridSize::Quads(n.max(FINER * integer.quads())),
                    size => size,
                };
            }
        }
    }
}

/// A grid whose cells are shorter by a factor.
fn finer(size: GridSize, factor: f64) -> GridSize {
    match size {
        GridSize::Quads(count) => GridSize::Quads(count * factor * factor),
        GridSize::EdgeLength(length) => GridSize::EdgeLength(length / factor),
        GridSize::Scale(scale) => GridSize::Scale(scale * factor),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_parametrize::{SeamlessMap, Tolerance};
    use seamstress_quantize::{IntegerOptions, to_integer_map};
    use seamstress_testkit::{squares, torus};
    use std::ops::ControlFlow;

    #[test]
    fn a_torus_of_one_cell_needs_a_finer_grid() {
        let map = squares(&torus(6, 6, 2.0, 0.7), 1);
        let mesh = TriMesh::from_faces(map.soup.positions.len(), &map.soup.faces).unwrap();
        let seamless = SeamlessMap::certify(&mesh, map.corner_uvs, &Tolerance::default()).unwrap();
        let mut asked = Vec::new();
        let made = manifold_quads(&mesh, &map.soup.positions, GridSize::Quads(1.0), |size| {
            asked.push(size);
            let options =
                IntegerOptions { size: GridSize::Quads(1.0), ..IntegerOptions::default() };
            let mut go_on = |_| ControlFlow::Continue(());
            to_integer_map(&mesh, &map.soup.positions, &seamless, &options, &mut go_on)
        });
        // Whoever makes it keeps to one cell; three by three is the least torus without a repeated edge.
        let error = made.unwrap_err();
        assert!(matches!(error, ManifoldError::NoManifold(_)), "{error}");
        assert_eq!(asked.len(), 1 + MOST_REFINEMENTS);

        let made = manifold_quads(&mesh, &map.soup.positions, GridSize::Quads(4.0), |size| {
            let options = IntegerOptions { size, ..IntegerOptions::default() };
            let mut go_on = |_| ControlFlow::Continue(());
            to_integer_map(&mesh, &map.soup.positions, &seamless, &options, &mut go_on)
        });
        let made = made.unwrap();
        assert!(made.refinements > 0 && made.connectivity.n_quads() >= 9);
        assert_eq!(made.connectivity.euler_characteristic(), 0);
    }

    #[test]
    fn every_size_gets_finer() {
        assert_eq!(finer(GridSize::Quads(100.0), 2.0), GridSize::Quads(400.0));
        assert_eq!(finer(GridSize::EdgeLength(1.0), 2.0), GridSize::EdgeLength(0.5));
        assert_eq!(finer(GridSize::Scale(3.0), 2.0), GridSize::Scale(6.0));
    }
}
