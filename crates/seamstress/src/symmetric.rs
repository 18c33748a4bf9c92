//! One side of the planes of symmetry of a surface, on which quads are made, and the whole that they are mirrored to.

use crate::error::{Error, ErrorKind, Stage};
use crate::features::{FeatureCurves, FeatureReport, edges_of, ordered};
use crate::options::MapOptions;
use crate::surface::Surface;
use crate::symmetry::{Found, SymmetryReport};
use crate::words::counted;
use seamstress_mesh::TriMesh;
use seamstress_mesh::refine::FeaturePiece;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::symmetry::{Cut, Mirror, Segments, cut};
use seamstress_parametrize::{ReleaseReason, ReleasedFeature};
use seamstress_quads::extract::SurfacePoint;
use seamstress_quads::{Extraction, Planes, QuadConnectivity, Symmetric, symmetric};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Weights of corners of faces up to this are those of rounding.
const WEIGHT: f64 = 1e-6;

/// One side of the planes of symmetry of a surface.
pub(crate) struct Side {
    pub(crate) surface: Surface,
    /// The features there, and the rim: the edges in the planes.
    pub(crate) curves: FeatureCurves,
    /// The features of the whole.
    pub(crate) asked: FeatureCurves,
    whole: Surface,
    planes: Vec<Found>,
    piece: Piece,
}

impl Side {
    /// With the sizes and directions of the whole, for cells of a length; none where no symmetry is asked for, or none is
    /// found.
    ///
    /// # Errors
    /// [`ErrorKind::NotSymmetric`], and those of [`Surface::sized`].
    pub(crate) fn new(
        whole: &Surface,
        asked: &FeatureCurves,
        options: &MapOptions,
        cell: f64,
    ) -> Result<Option<Self>, Error> {
        let planes = whole.symmetry_planes(options.symmetry)?;
        if planes.is_empty() {
            return Ok(None);
        }
        let mut piece = Piece::of(whole, asked, &planes);
        for (found, k) in planes.iter().zip(0..) {
            piece = piece.cut(&found.mirror, 1 << k, whole.on_plane()).ok_or_else(|| {
                let text = format!("the surface has no side at the plane {}", found.report());
                Error::new(ErrorKind::NotSymmetric, text).at_stage(Some(Stage::Check))
            })?;
        }
        let soup = TriangleSoup { positions: piece.positions.clone(), faces: piece.faces.clone() };
        let surface = whole.remeshed(soup, &piece.vertex_origin, &piece.face_origin)?;
        let features = piece.features.iter().map(|piece| piece.vertices);
        let rim = surface.mesh().edges().filter(|&h| surface.mesh().twin(h).is_none());
        let rim = rim.map(|h| [surface.mesh().origin(h).0, surface.mesh().tip(h).0]);
        let rim = rim.filter(|&ends| piece.planes_of(ends) != 0);
        let edges = edges_of(surface.mesh(), &features.chain(rim).collect::<Vec<_>>());
        let curves = asked.on(&surface, edges);
        let mirrors: Vec<Mirror> = planes.iter().map(|found| found.mirror).collect();
        let surface = whole.directed_side(surface, &piece.face_origin, &mirrors)?;
        let surface = whole.sized_side(surface, &mirrors, &curves, options, cell)?;
        let (whole, asked) = (whole.clone(), asked.clone());
        Ok(Some(Self { surface, curves, whole, asked, planes, piece }))
    }

    pub(crate) fn report(&self) -> SymmetryReport {
        let (positions, within) = (self.whole.settled_on(&self.planes), self.whole.on_plane());
        let crosses = |found: &Found, face: &[u32; 3]| {
            let heights = face.map(|v| found.mirror.height(positions[v as usize]));
            heights.iter().any(|&x| x > within) && heights.iter().any(|&x| x < -within)
        };
        let is_split = |face: &&[u32; 3]| self.planes.iter().any(|found| crosses(found, face));
        SymmetryReport {
            planes: self.planes.iter().map(Found::report).collect(),
            split_triangles: self.whole.faces().iter().filter(is_split).count(),
            side_triangles: self.surface.faces().len(),
        }
    }

    /// The quads of the side and their images.
    ///
    /// # Errors
    /// Where they are no manifold, or do not reach the planes.
    pub(crate) fn mirrored(
        &self,
        quads: &Extraction,
        features: Option<&FeatureReport>,
    ) -> Result<(Extraction, QuadConnectivity), Error> {
        self.require_rim(features)?;
        let on_planes: Vec<Planes> = quads.sources.iter().map(|at| self.planes_at(at)).collect();
        let mirrors: Vec<Mirror> = self.planes.iter().map(|found| found.mirror).collect();
        let made = symmetric(quads, &mirrors, &on_planes)
            .map_err(|faults| Error::no_manifold(&faults).with_hint("try more quads"))?;
        let Symmetric { mut extraction, connectivity, reflected_at, .. } = made;
        let (positions, faces) = (self.surface.positions(), self.surface.faces());
        let place = |(source, at): (&SurfacePoint, &Planes)| {
            let on_side = source.position(positions, faces);
            let at = mirrors.iter().zip(0..).filter(move |(_, k)| at >> k & 1 == 1);
            at.fold(on_side, |p, (mirror, _)| mirror.image(p))
        };
        let points: Vec<_> = extraction.sources.iter().zip(&reflected_at).map(place).collect();
        extraction.sources = self.whole.places_of(points)?;
        let vertex = |v: u32| self.piece.vertex_origin.get(v as usize).copied();
        for cone in &mut extraction.cones {
            cone.source = cone.source.and_then(vertex);
        }
        Ok((extraction, connectivity))
    }

    /// Refuses what does not follow the rim.
    ///
    /// # Errors
    /// [`ErrorKind::NoQuads`].
    pub(crate) fn require_rim(&self, features: Option<&FeatureReport>) -> Result<(), Error> {
        let dropped = features.iter().flat_map(|features| features.dropped.iter().flatten());
        match dropped.filter(|edge| self.piece.planes_of(edge.vertices) != 0).count() {
            0 => Ok(()),
            n => {
                let edges = counted(n, "edge");
                let text = format!("{edges} in a plane of symmetry could not be followed");
                Err(Error::new(ErrorKind::NoQuads, text).with_hint("try without `symmetry`"))
            }
        }
    }

    /// The planes that a point of the side lies on.
    fn planes_at(&self, place: &SurfacePoint) -> Planes {
        let corners = self.surface.faces()[place.face as usize].into_iter().zip(place.barycentric);
        let corners = corners.filter(|&(_, weight)| weight > WEIGHT);
        corners.fold(!0, |planes, (corner, _)| planes & self.piece.on_planes[corner as usize])
    }

    /// For each corner of the triangles of the whole the one of the side that it is, or is the image of, and the sign of
    /// its triangle after reflections; none where a triangle is not the image of one of the side.
    pub(crate) fn corners(&self) -> Option<Vec<(usize, f64)>> {
        let numbers = self.piece.vertex_origin.iter().copied().zip(0u32..);
        let number: HashMap<u32, u32> = numbers.collect();
        let faces = self.piece.faces.iter().zip(0..);
        let face_of: HashMap<[u32; 3], usize> =
            faces.map(|(&face, f)| (smallest_first(face), f)).collect();
        let (positions, within) = (self.whole.settled_on(&self.planes), self.whole.on_plane());
        let mut found = Vec::with_capacity(3 * self.whole.faces().len());
        for face in self.whole.faces() {
            let (mut corners, mut sign) = (*face, 1.0);
            for plane in &self.planes {
                let height = |&v: &u32| plane.mirror.height(positions[v as usize]);
                if face.iter().any(|v| height(v) < -within) {
                    let images = plane.images.as_ref()?;
                    corners = corners.map(|v| images[v as usize]);
                    sign = -sign;
                }
            }
            let [a, b, c] = corners;
            let [a, b, c] = [*number.get(&a)?, *number.get(&b)?, *number.get(&c)?];
            let turned = if sign > 0.0 { [a, b, c] } else { [c, b, a] };
            let image = *face_of.get(&smallest_first(turned))?;
            for corner in [a, b, c] {
                let k = self.piece.faces[image].iter().position(|&v| v == corner)?;
                found.push((3 * image + k, sign));
            }
        }
        Some(found)
    }

    /// The report on features of the side as one on those of the whole: an edge is kept if all its pieces are, or if it is
    /// at the image of one that is.
    pub(crate) fn feature_report(&self, of_side: FeatureReport) -> FeatureReport {
        let gone = of_side.dropped.iter().flatten();
        let gone: HashMap<[u32; 2], ReleaseReason> =
            gone.map(|piece| (ordered(piece.vertices), piece.reason)).collect();
        let pieces = &self.piece.features;
        let fate = |piece: &FeaturePiece| gone.get(&ordered(piece.vertices)).copied();
        let ends = |piece: &FeaturePiece| piece.vertices.map(|v| self.piece.positions[v as usize]);
        let segments = Segments::new(pieces.iter().map(ends));
        let reach = self.whole.symmetry_tolerance();
        let mut dropped = BTreeMap::new();
        let mut on_side = BTreeSet::new();
        for piece in pieces {
            on_side.insert(ordered(piece.source));
            dropped.extend(fate(piece).map(|reason| (ordered(piece.source), reason)));
        }
        for edge in self.asked.edges().iter().map(|&edge| ordered(edge)) {
            if on_side.contains(&edge) {
                continue;
            }
            let [p, q] = edge.map(|v| self.whole.positions()[v as usize]);
            let middle = self.reflected([0, 1, 2].map(|k| 0.5 * (p[k] + q[k])));
            let reason = match segments.nearest(middle) {
                Some((piece, distance)) if distance <= reach => fate(&pieces[piece]),
                _ => Some(ReleaseReason::OneSided),
            };
            dropped.extend(reason.map(|reason| (edge, reason)));
        }
        let mut report = self.asked.report().clone();
        report.kept = Some(report.edges - dropped.len());
        let released = |(edge, reason)| ReleasedFeature::new(edge, reason);
        report.dropped = Some(dropped.into_iter().map(released).collect());
        report.alignment = of_side.alignment;
        report
    }

    /// The image of a point on this side.
    fn reflected(&self, p: [f64; 3]) -> [f64; 3] {
        let mirrors = self.planes.iter().map(|found| found.mirror);
        mirrors.fold(p, |p, mirror| if mirror.height(p) < 0.0 { mirror.image(p) } else { p })
    }
}

/// A cycle from its smallest member on.
fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        first if first == a => [a, b, c],
        first if first == b => [b, c, a],
        _ => [c, a, b],
    }
}

/// A mesh while it is cut, plane by plane.
struct Piece {
    positions: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    /// The vertices of the whole that the first vertices are.
    vertex_origin: Vec<u32>,
    /// The face of the whole of each face.
    face_origin: Vec<u32>,
    /// The planes on whose rim each vertex is.
    on_planes: Vec<Planes>,
    /// Feature edges, and the edge of the whole that each is a piece of.
    features: Vec<FeaturePiece>,
}

impl Piece {
    /// The whole, with vertices that belong to the planes on them.
    fn of(whole: &Surface, asked: &FeatureCurves, planes: &[Found]) -> Self {
        let n_vertices = whole.positions().len();
        let features =
            asked.edges().iter().map(|&edge| FeaturePiece { vertices: edge, source: edge });
        Self {
            positions: whole.settled_on(planes),
            faces: whole.faces().to_vec(),
            vertex_origin: (0..n_vertices as u32).collect(),
            face_origin: (0..whole.faces().len() as u32).collect(),
            on_planes: vec![0; n_vertices],
            features: features.collect(),
        }
    }

    fn cut(&self, mirror: &Mirror, plane: Planes, within: f64) -> Option<Self> {
        let mesh = TriMesh::from_faces(self.positions.len(), &self.faces).ok()?;
        let features: Vec<[u32; 2]> = self.features.iter().map(|piece| piece.vertices).collect();
        let edges = edges_of(&mesh, &features);
        let Cut { positions, faces, vertex_origin, face_origin, features, rim } =
            cut(&mesh, &self.positions, &edges, mirror, within)?;
        let of_both = |ends: &[u32; 2]| self.planes_of(*ends);
        let mut on_planes: Vec<Planes> = vertex_origin.iter().map(of_both).collect();
        rim.as_flattened().iter().for_each(|&v| on_planes[v as usize] |= plane);
        let origin = self.feature_origin();
        let of_whole =
            |piece: FeaturePiece| FeaturePiece { source: origin[&ordered(piece.source)], ..piece };
        let kept = vertex_origin.iter().filter(|[a, b]| a == b);
        let of_vertex = |&[v, _]: &[u32; 2]| self.vertex_origin.get(v as usize).copied();
        Some(Self {
            vertex_origin: kept.map_while(of_vertex).collect(),
            face_origin: face_origin.iter().map(|&f| self.face_origin[f as usize]).collect(),
            features: features.into_iter().map(of_whole).collect(),
            positions,
            faces,
            on_planes,
        })
    }

    /// The planes on whose rim both of two vertices are.
    fn planes_of(&self, ends: [u32; 2]) -> Planes {
        ends.iter().fold(!0, |planes, &v| planes & self.on_planes[v as usize])
    }

    /// The edge of the whole that each feature edge, its ends ascending, is a piece of.
    fn feature_origin(&self) -> HashMap<[u32; 2], [u32; 2]> {
        self.features.iter().map(|piece| (ordered(piece.vertices), piece.source)).collect()
    }
}
