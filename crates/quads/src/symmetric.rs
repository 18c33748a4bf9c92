//! Quads of one side of planes of symmetry, made those of the whole.

use crate::extract::{Extraction, QuadCone};
use crate::{QuadConnectivity, QuadFaults, QuadMesh};
use seamstress_mesh::symmetry::Mirror;

/// The planes that a vertex lies on, or was reflected at: bit `k` for plane `k`.
pub type Planes = u8;

/// Quads that are their own image across planes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Symmetric {
    /// The quads. Images have the places on the source of what they are images of.
    pub extraction: Extraction,
    /// Who is whose neighbour among them.
    pub connectivity: QuadConnectivity,
    /// The planes that each vertex was reflected at.
    pub reflected_at: Vec<Planes>,
}

/// Quads of one side, and their images across planes, one after the other. They are joined at the vertices on these planes,
/// which are put there; the others are moved by rounding at most, so that all are images of each other to the last bit
/// where planes are across axes.
///
/// # Errors
/// Where they are no manifold: a part of the side is only one quad wide between two places of a plane, for instance.
pub fn symmetric(
    side: &Extraction,
    planes: &[Mirror],
    on_planes: &[Planes],
) -> Result<Symmetric, QuadFaults> {
    let on_planes = of_rims(&side.mesh.connectivity()?, on_planes);
    let mut whole = Whole {
        positions: side.mesh.positions().to_vec(),
        quads: side.mesh.quads().to_vec(),
        origin: (0..on_planes.len() as u32).collect(),
        reflected_at: vec![0; on_planes.len()],
        on_planes,
    };
    for (mirror, k) in planes.iter().zip(0..) {
        whole.join_image(mirror, 1 << k);
    }
    let Whole { positions, quads, origin, on_planes, reflected_at } = whole;
    let mesh = QuadMesh::from_parts(positions, quads);
    let connectivity = mesh.connectivity()?;
    let copies = 1 << planes.len();
    let extraction = Extraction {
        mesh,
        sources: origin.iter().map(|&v| side.sources[v as usize]).collect(),
        cones: cones(side, &connectivity, &origin, &on_planes),
        uv_area: side.uv_area * copies as f64,
        trimmed: side.trimmed * copies,
        split_vertices: side.split_vertices * copies,
        ..side.clone()
    };
    Ok(Symmetric { extraction, connectivity, reflected_at })
}

/// The planes along whose rim a vertex lies, of those that it lies on: elsewhere quads would meet in a point only.
fn of_rims(connectivity: &QuadConnectivity, on_planes: &[Planes]) -> Vec<Planes> {
    let mut of_rims = vec![0; on_planes.len()];
    for h in connectivity.edges().filter(|&h| connectivity.twin(h).is_none()) {
        let ends = [connectivity.origin(h), connectivity.tip(h)].map(|v| v as usize);
        let shared = on_planes[ends[0]] & on_planes[ends[1]];
        ends.iter().for_each(|&v| of_rims[v] |= shared);
    }
    of_rims
}

/// Quads, and for each vertex the one of the side that it is or is an image of.
struct Whole {
    positions: Vec<[f64; 3]>,
    quads: Vec<[u32; 4]>,
    origin: Vec<u32>,
    on_planes: Vec<Planes>,
    reflected_at: Vec<Planes>,
}

impl Whole {
    fn join_image(&mut self, mirror: &Mirror, plane: Planes) {
        let n_vertices = self.positions.len();
        let mut image = Vec::with_capacity(n_vertices);
        for v in 0..n_vertices {
            let at = self.positions[v];
            if self.on_planes[v] & plane != 0 {
                self.positions[v] = mirror.onto(at);
                image.push(v as u32);
                continue;
            }
            image.push(self.positions.len() as u32);
            self.positions[v] = mirror.settled(at);
            self.positions.push(mirror.image(self.positions[v]));
            self.origin.push(self.origin[v]);
            self.on_planes.push(self.on_planes[v]);
            self.reflected_at.push(self.reflected_at[v] | plane);
        }
        let turned = |&[a, b, c, d]: &[u32; 4]| [a, d, c, b].map(|v| image[v as usize]);
        let images: Vec<[u32; 4]> = self.quads.iter().map(turned).collect();
        self.quads.extend(images);
    }
}

/// The cones of the whole: those beside the planes with their images, and vertices on planes that are irregular now.
fn cones(
    side: &Extraction,
    connectivity: &QuadConnectivity,
    origin: &[u32],
    on_planes: &[Planes],
) -> Vec<QuadCone> {
    let of_side = |v: u32| {
        let found = side.cones.binary_search_by_key(&origin[v as usize], |cone| cone.vertex);
        found.ok().map(|k| side.cones[k])
    };
    let vertices = 0..origin.len() as u32;
    let beside = vertices.filter(|&v| on_planes[v as usize] == 0);
    // Which vertex of the source is the image of another is not known.
    let source = |v: u32, cone: QuadCone| cone.source.filter(|_| origin[v as usize] == v);
    let beside = beside.filter_map(|v| {
        let cone = of_side(v)?;
        Some(QuadCone { vertex: v, source: source(v, cone), ..cone })
    });
    let irregular = connectivity.irregular_vertices().into_iter();
    let on_planes = irregular.filter(|found| on_planes[found.vertex as usize] != 0);
    let on_planes = on_planes.map(|found| QuadCone {
        vertex: found.vertex,
        source: of_side(found.vertex).and_then(|cone| source(found.vertex, cone)),
        index: found.index,
    });
    let mut cones: Vec<QuadCone> = beside.chain(on_planes).collect();
    cones.sort_by_key(|cone| cone.vertex);
    cones
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extract::{ExtractOptions, extract};
    use seamstress_mesh::TriMesh;
    use seamstress_parametrize::progress::go_on;
    use seamstress_testkit::disk_grid;

    /// Two by two quads over the square from -1 to 1, moved so that it begins at a place.
    fn grid(x: f64, y: f64) -> Extraction {
        let mut sheet = disk_grid(2, 2);
        let mesh = TriMesh::from_faces(sheet.positions.len(), &sheet.faces).unwrap();
        let uv = |&v: &u32| [sheet.positions[v as usize][0], sheet.positions[v as usize][1]];
        let uvs: Vec<[f64; 2]> = sheet.faces.as_flattened().iter().map(uv).collect();
        sheet.positions.iter_mut().for_each(|p| (p[0], p[1]) = (p[0] + 1.0 + x, p[1] + 1.0 + y));
        extract(&mesh, &sheet.positions, &uvs, &ExtractOptions::default(), &mut go_on).unwrap()
    }

    fn on_planes(side: &Extraction) -> Vec<Planes> {
        let on = |p: &[f64; 3]| u8::from(p[0] == 0.0) | u8::from(p[1] == 0.0) << 1;
        side.mesh.positions().iter().map(on).collect()
    }

    #[test]
    fn a_quarter_of_a_sheet_becomes_the_whole() {
        let side = grid(0.0, 0.0);
        let planes = [Mirror::across(0, 0.0), Mirror::across(1, 0.0)];
        let made = symmetric(&side, &planes, &on_planes(&side)).unwrap();
        let mesh = &made.extraction.mesh;
        assert_eq!((mesh.quads().len(), mesh.positions().len()), (16, 25));
        assert_eq!(made.connectivity.n_boundary_loops(), 1);
        assert!(made.connectivity.irregular_vertices().is_empty());
        assert_eq!(made.extraction.uv_area, 16.0);
        for (p, reflected) in mesh.positions().iter().zip(&made.reflected_at) {
            assert_eq!(*reflected, u8::from(p[0] < 0.0) | u8::from(p[1] < 0.0) << 1, "{p:?}");
        }
    }

    #[test]
    fn sides_that_do_not_touch_a_plane_stay_apart() {
        let side = grid(0.5, 0.0);
        let made = symmetric(&side, &[Mirror::across(0, 0.0)], &[0; 9]).unwrap();
        assert_eq!(made.connectivity.connected_quads().1, 2);
        // One vertex in the plane is no rim.
        let mut touching = vec![0; 9];
        touching[0] = 1;
        let made = symmetric(&side, &[Mirror::across(0, 0.0)], &touching).unwrap();
        assert_eq!(made.connectivity.connected_quads().1, 2);
    }

    #[test]
    fn one_quad_between_two_places_of_a_plane_is_too_few() {
        let side = grid(0.0, 0.0);
        let all_round: Vec<Planes> =
            side.mesh.positions().iter().map(|p| u8::from(p[..2] != [1.0, 1.0])).collect();
        let made = symmetric(&side, &[Mirror::across(2, 0.0)], &all_round);
        assert!(made.is_ok_and(|made| made.connectivity.n_boundary_loops() == 0));
        let mut strip = side.clone();
        strip.mesh =
            QuadMesh::new(side.mesh.positions().to_vec(), side.mesh.quads()[..2].to_vec()).unwrap();
        assert!(symmetric(&strip, &[Mirror::across(2, 0.0)], &[1; 9]).is_err());
    }
}
