//! Integer-grid maps whose quads are a manifold.

use crate::{
    ExtractError, ExtractOptions, Extraction, QuadConnectivity, QuadFault, QuadFaults, extract,
};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Geometry, TriMesh};
use seamstress_parametrize::SeamlessMap;
use seamstress_parametrize::progress::{Observer, Progress};
use seamstress_quantize::{
    Decisions, Quantization, QuantizationFailure, QuantizeError, QuantizeOptions, Refusal,
    quantize_deciding,
};
use std::cell::RefCell;
use std::ops::ControlFlow;

/// An integer-grid map and its quads, an oriented manifold.
#[derive(Debug)]
#[non_exhaustive]
pub struct ManifoldQuads {
    /// The map.
    pub quantization: Quantization,
    /// Its quads.
    pub extraction: Extraction,
    /// Who is whose neighbour among them.
    pub connectivity: QuadConnectivity,
}

/// Why there are no such quads.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ManifoldError {
    /// There is no integer-grid map.
    #[error(transparent)]
    Quantize(#[from] QuantizeError),
    /// There are no quads.
    #[error(transparent)]
    Extract(#[from] ExtractError),
    /// Those of all components together are no manifold.
    #[error("the quads are no manifold: {faults}")]
    NoManifold {
        /// What is wrong with them.
        #[source]
        faults: QuadFaults,
        /// Faces of the mesh where that is.
        faces: Vec<u32>,
    },
}

/// Whether to go on where a brief search for a component has found no map.
pub type GoesOn<'a> = dyn FnMut(&QuantizationFailure) -> bool + 'a;

/// Rounds a seamless map, as [`quantize`](seamstress_quantize::quantize) does, and extracts its quads, a manifold.
///
/// Where a component, or the space between cones, is only a cell or two wide, a cell of the grid may have
/// itself as a neighbour, or another one twice. An indexed quad mesh cannot represent that. The quads of a component
/// are therefore looked at before a grid is taken, as is whether they keep its slits open. `goes_on` is asked where a brief search has found none.
///
/// # Errors
/// [`ManifoldError`].
pub fn manifold_quads<'a>(
    mesh: &TriMesh,
    geometry: impl Into<Geometry<'a>>,
    map: &SeamlessMap,
    aligned: &EdgeSet,
    options: &QuantizeOptions,
    goes_on: &mut GoesOn<'_>,
    observer: &mut Observer<'_>,
) -> Result<ManifoldQuads, ManifoldError> {
    let settings = ExtractOptions::default();
    // Rounding and the looks at its quads take turns.
    let observer = RefCell::new(observer);
    let observe = |progress| (observer.borrow_mut())(progress);
    let geometry = geometry.into();
    let positions = geometry.positions;
    let mut decisions = OfManifolds { positions, settings: &settings, observe, goes_on };
    let quantization =
        quantize_deciding(mesh, geometry, map, aligned, options, &mut decisions, &mut { observe })?;
    let extraction =
        extract(mesh, positions, quantization.map.corner_uvs(), &settings, &mut { observe })?;
    let connectivity = extraction.mesh.connectivity().map_err(|faults| {
        let faces = faulty_faces(&extraction, &faults);
        ManifoldError::NoManifold { faults, faces }
    })?;
    Ok(ManifoldQuads { quantization, extraction, connectivity })
}

/// Decides for maps whose quads are a manifold.
struct OfManifolds<'a, O> {
    positions: &'a [[f64; 3]],
    settings: &'a ExtractOptions,
    observe: O,
    goes_on: &'a mut GoesOn<'a>,
}

impl<O: FnMut(Progress) -> ControlFlow<()>> Decisions for OfManifolds<'_, O> {
    fn accept(&mut self, piece: &Component, corner_uvs: &[[f64; 2]]) -> Result<(), Refusal> {
        let positions = piece.positions(self.positions);
        // A small piece may have no whole cell; whether the mesh has any is found in the end. So is a wish to stop.
        let made = extract(&piece.mesh, &positions, corner_uvs, self.settings, &mut self.observe);
        let Ok(extraction) = made else { return Ok(()) };
        let connectivity = extraction.mesh.connectivity().map_err(|faults| {
            let faces = faulty_faces(&extraction, &faults);
            let faces = faces.into_iter().map(|f| piece.faces[f as usize].0).collect();
            Refusal { reason: format!("its quads are no manifold: {faults}"), faces }
        })?;
        // A slit of two edges has the same ends twice, as an edge between two quads has.
        let (quads, mesh) =
            (connectivity.euler_characteristic(), piece.mesh.euler_characteristic());
        match extraction.trimmed == 0 && quads != mesh {
            true => {
                let reason = "its quads close a slit that is one edge long".to_owned();
                Err(Refusal { reason, ..Refusal::default() })
            }
            false => Ok(()),
        }
    }

    fn goes_on(&mut self, failure: &QuantizationFailure) -> bool {
        (self.goes_on)(failure)
    }
}

/// Faces of the mesh where faults of its quads are.
fn faulty_faces(extraction: &Extraction, faults: &QuadFaults) -> Vec<u32> {
    let vertex = |fault: &QuadFault| match *fault {
        QuadFault::RepeatedVertex { vertex, .. } | QuadFault::NonManifoldVertex { vertex, .. } => {
            vertex
        }
        QuadFault::RepeatedHalfedge { from, .. } => from,
    };
    let face = |fault| extraction.sources[vertex(fault) as usize].face;
    let mut faces: Vec<u32> = faults.0.iter().map(face).collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_parametrize::Tolerance;
    use seamstress_quantize::{GridSize, QuantizationFailure, RoundingMethod};
    use seamstress_testkit::{disk_grid, squares, torus};

    #[test]
    fn a_torus_has_five_quads_at_a_minimum() {
        let map = squares(&torus(6, 6, 2.0, 0.7), 1);
        let mesh = TriMesh::from_faces(map.soup.positions.len(), &map.soup.faces).unwrap();
        let seamless = SeamlessMap::certify(&mesh, map.corner_uvs, &Tolerance::default()).unwrap();
        let mut go_on = |_| ControlFlow::Continue(());
        for asked in [1.0, 4.0] {
            let options =
                QuantizeOptions { size: GridSize::Quads(asked), ..QuantizeOptions::default() };
            let made = manifold_quads(
                &mesh,
                &map.soup.positions,
                &seamless,
                &EdgeSet::new(&mesh, []),
                &options,
                &mut |_| true,
                &mut go_on,
            )
            .unwrap();
            // With fewer, an edge would be repeated; five points can all be joined on a torus.
            assert!(made.connectivity.n_quads() >= 5, "asked for {asked}");
            assert_eq!(made.connectivity.euler_characteristic(), 0);
        }
    }

    #[test]
    fn a_slit_of_one_edge_stays_open() {
        // A square of 8 by 8 steps, cut open along two of them.
        let mut soup = disk_grid(8, 8);
        let middle = 39;
        soup.positions.push(soup.positions[middle as usize]);
        let other = soup.positions.len() as u32 - 1;
        let is_above = |face: &&mut [u32; 3]| face.iter().any(|&v| v > 44);
        let corners = soup.faces.iter_mut().filter(is_above).flatten();
        corners.filter(|v| **v == middle).for_each(|v| *v = other);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        assert_eq!(mesh.euler_characteristic(), 0);
        let uv = |&v: &u32| [0, 1].map(|k| soup.positions[v as usize][k]);
        let uvs = soup.faces.as_flattened().iter().map(uv).collect();
        let map = SeamlessMap::certify(&mesh, uvs, &Tolerance::default()).unwrap();
        let boundary = mesh.halfedges().filter(|&h| mesh.twin(h).is_none());
        let aligned = EdgeSet::new(&mesh, boundary);
        let mut go_on = |_| ControlFlow::Continue(());
        for asked in [16.0, 64.0] {
            let options =
                QuantizeOptions { size: GridSize::Quads(asked), ..QuantizeOptions::default() };
            let made = manifold_quads(
                &mesh,
                &soup.positions,
                &map,
                &aligned,
                &options,
                &mut |_| true,
                &mut go_on,
            )
            .unwrap();
            // On 4 by 4 cells the slit would be as long as an edge.
            assert_eq!(made.connectivity.euler_characteristic(), 0, "asked for {asked}");
            let n_quads = made.connectivity.n_quads();
            assert!((16..=64).contains(&n_quads), "{n_quads} for {asked}");
        }
    }

    #[test]
    fn the_error_says_what_is_wrong_with_the_quads() {
        let map = squares(&torus(6, 6, 2.0, 0.7), 1);
        let mesh = TriMesh::from_faces(map.soup.positions.len(), &map.soup.faces).unwrap();
        let seamless = SeamlessMap::certify(&mesh, map.corner_uvs, &Tolerance::default()).unwrap();
        let mut go_on = |_| ControlFlow::Continue(());
        // Of one coarse grid alone, without any heed to its edges.
        let options = QuantizeOptions {
            size: GridSize::Quads(4.0),
            rounding: RoundingMethod::Greedy,
            ..QuantizeOptions::default()
        };
        let nothing = EdgeSet::new(&mesh, []);
        let positions = &map.soup.positions;
        let made = manifold_quads(
            &mesh,
            positions,
            &seamless,
            &nothing,
            &options,
            &mut |_| true,
            &mut go_on,
        );
        let ManifoldError::Quantize(QuantizeError::Components(failed)) = made.unwrap_err() else {
            panic!("a map that is refused is a failure of its component")
        };
        assert!(failed[0].to_string().contains("its quads are no manifold: "), "{}", failed[0]);
        let QuantizationFailure::Refused(refusal) = &failed[0].cause else { panic!("{failed:?}") };
        assert!(!refusal.faces.is_empty());
    }
}
