//! A first layout of a disk: inside a circle, every vertex the mean of its neighbours (Tutte 1963).

use num_complex::Complex64;
use seamstress_linalg::ordering::{Graph, fill_reducing_order};
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern};
use seamstress_mesh::{Halfedge, Metric, TriMesh, Vertex};
use std::f64::consts::TAU;

/// Whether a connected mesh is a topological disk.
pub fn is_disk(mesh: &TriMesh) -> bool {
    mesh.genus() == 0 && mesh.n_boundary_loops() == 1
}

/// Why a mesh has no first layout as a disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DiskError {
    /// It has handles, or not exactly one boundary loop.
    #[error("it is not a disk")]
    NotADisk,
    /// The linear system could not be solved.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}

/// Positions of the corners, three per face, with the boundary on a circle of the mesh's area, spaced by
/// length. No triangle is flipped, in exact arithmetic: the polygon is strictly convex.
///
/// # Errors
/// [`DiskError`].
pub fn embed_disk(mesh: &TriMesh, metric: &Metric) -> Result<Vec<[f64; 2]>, DiskError> {
    if !is_disk(mesh) {
        return Err(DiskError::NotADisk);
    }
    let n = mesh.n_vertices();
    let mut z = on_circle(mesh, metric);
    let is_inner = |v: Vertex| !mesh.is_boundary(v);
    let ends = |h| [mesh.origin(h), mesh.tip(h)];
    let pattern = Pattern::of_cliques(n, mesh.edges().map(|h| ends(h).map(|v| v.0)));
    let edges: Vec<_> = mesh.edges().map(|h| (mesh.origin(h).0, mesh.tip(h).0)).collect();
    let order = fill_reducing_order(&Graph::from_edges(n, edges.into_iter()));
    let mut cholesky = Cholesky::<f64>::analyze(&pattern, &order)?;
    // Boundary vertices keep rows of their own, `z = z`.
    let mut matrix = vec![0.0; pattern.len()];
    let mut rhs = vec![[0.0; 2]; n];
    for v in mesh.vertices().filter(|&v| !is_inner(v)) {
        matrix[pattern.diagonal()[v.at()] as usize] = 1.0;
        rhs[v.at()] = [z[v.at()].re, z[v.at()].im];
    }
    for h in mesh.edges() {
        let [a, b] = ends(h);
        for (v, other) in [(a, b), (b, a)].into_iter().filter(|(v, _)| is_inner(*v)) {
            matrix[pattern.diagonal()[v.at()] as usize] += 1.0;
            if !is_inner(other) {
                rhs[v.at()][0] += z[other.at()].re;
                rhs[v.at()][1] += z[other.at()].im;
            }
        }
        if let Some(slot) = pattern.slot(a.0, b.0).filter(|_| is_inner(a) && is_inner(b)) {
            matrix[slot as usize] = -1.0;
        }
    }
    cholesky.factorize(&matrix)?;
    let mut columns: Vec<f64> =
        [0, 1].iter().flat_map(|&k| rhs.iter().map(move |r| r[k])).collect();
    cholesky.solve_columns(&mut columns, 2);
    for v in mesh.vertices().filter(|&v| is_inner(v)) {
        z[v.at()] = Complex64::new(columns[v.at()], columns[n + v.at()]);
    }
    let corner = |h: Halfedge| z[mesh.origin(h).at()] * metric.unit;
    Ok(mesh.halfedges().map(|h| [corner(h).re, corner(h).im]).collect())
}

/// The boundary vertices on their circle, counter-clockwise; the others at its centre.
fn on_circle(mesh: &TriMesh, metric: &Metric) -> Vec<Complex64> {
    let mut z = vec![Complex64::ZERO; mesh.n_vertices()];
    let border = |h: &Halfedge| mesh.twin(*h).is_none();
    let perimeter: f64 = mesh.halfedges().filter(border).map(|h| metric.length[h]).sum();
    let radius = (2.0 * metric.total_area() / TAU).sqrt();
    let Some(first) = mesh.halfedges().find(border) else { return z };
    let (mut h, mut travelled) = (first, 0.0);
    loop {
        z[mesh.origin(h).at()] = Complex64::from_polar(radius, TAU * travelled / perimeter);
        travelled += metric.length[h];
        let Some(next) = mesh.outgoing(mesh.tip(h)).find(border).filter(|&next| next != first)
        else {
            return z;
        };
        h = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SeamlessMap, Tolerance};
    use seamstress_testkit as kit;

    #[test]
    fn disks_are_embedded_without_flips_and_others_refused() {
        for soup in [kit::saddle(9), kit::fan(5, 1.0, true), kit::monkey_saddle(6)] {
            let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
            let metric = Metric::from_positions(&mesh, &soup.positions);
            let uvs = embed_disk(&mesh, &metric).unwrap();
            let map = SeamlessMap::certify(&mesh, uvs, &Tolerance::default()).unwrap();
            assert!(map.cones().is_empty() && map.seams().is_empty());
        }
        let soup = kit::icosphere(1);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        assert_eq!(embed_disk(&mesh, &metric), Err(DiskError::NotADisk));
    }
}
