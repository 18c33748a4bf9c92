//! Faces of three grid points: nothing between these can give way.

use crate::gauss::Overflow;
use crate::scene::{Connection, Scene, Sight};
use seamstress_mesh::Halfedge;

/// A triangle of the mesh whose corners are grid points. It may not collapse or turn over.
#[derive(Debug, Clone)]
pub struct PointFace {
    /// The sides from its first corner to the second and to the third.
    pub sides: [Connection; 2],
    /// Its shortest side, in the units of the layout.
    pub extent: f64,
}

/// All faces of three grid points.
///
/// # Errors
/// [`Overflow`].
pub fn point_faces(scene: &Scene<'_>) -> Result<Vec<PointFace>, Overflow> {
    let length = |a: Halfedge, b: Halfedge| (scene.at(b) - scene.at(a)).norm();
    let face = |[a, b, c]: [Halfedge; 3]| {
        let side = |to| {
            let length = length(a, to);
            scene.line(&Sight { from: a, to, length, crossed: Vec::new() })
        };
        let extent = length(a, b).min(length(b, c)).min(length(c, a));
        Ok(PointFace { sides: [side(b)?, side(c)?], extent })
    };
    let is_point = |&h: &Halfedge| scene.needs.is_point[scene.mesh.origin(h)];
    let sides = scene.mesh.faces().map(|f| f.halfedges());
    sides.filter(|sides| sides.iter().all(is_point)).map(face).collect()
}
