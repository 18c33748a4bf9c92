//! Pictures of a map as PNG files.

use crate::args::TextureArgs;
use crate::features::{AlignedFeatures, Features};
use crate::text::figure;
use seamstress_mesh::soup::{self, TriangleSoup};
use seamstress_parametrize::SeamlessMap;
use seamstress_parametrize::quality::Summary;
use seamstress_quads::{IrregularVertex, QuadMesh};
use seamstress_render::{
    HeatMap, Image, LayoutOptions, Paint, RenderError, Scene, SurfaceOptions, View, render_layout,
    render_surface,
};

/// The files, in the order of [`draw`].
pub(crate) const NAMES: [&str; 3] = ["front.png", "back.png", "layout.png"];

/// Draws the surface from both sides in the colours of a measure, with a legend, as one PNG.
pub(crate) fn heat(soup: &TriangleSoup, summary: &Summary) -> Result<Vec<u8>, RenderError> {
    let scene = Scene { positions: &soup.positions, faces: &soup.faces, ..Scene::default() };
    let heat = heat_of(summary);
    let options = |view| SurfaceOptions {
        view,
        paint: heat.paint(&summary.values.0),
        ..SurfaceOptions::default()
    };
    let front = render_surface(&scene, &options(View::Front))?;
    let back = render_surface(&scene, &options(View::Back))?;
    let mut png = Vec::new();
    let both = front.beside(&back)?;
    heat.with_legend(&both, &summary.values.0)?.write_png(&mut png)?;
    Ok(png)
}

/// The scale of colours that suits a measure.
pub(crate) fn heat_of(summary: &Summary) -> HeatMap {
    let measure = summary.measure;
    let mut high = summary.percentiles.p99;
    if !high.is_finite() {
        let finite = summary.values.iter().copied().filter(|x| x.is_finite());
        high = finite.fold(measure.ideal(), f64::max);
    }
    let title =
        format!("{}   mean {}   max {}", measure.name(), figure(summary.mean), figure(summary.max));
    // An isometry has one colour, not the noise of its last digits.
    let high = high.max(measure.ideal() + LEAST_RANGE);
    HeatMap { low: measure.ideal(), high, title }
}

/// The colours span at least this.
const LEAST_RANGE: f64 = 1e-6;

/// Draws the surface from both sides and the layout, with the features, aligned and released; the texture
/// is turned, scaled and shifted first.
pub(crate) fn draw(
    soup: &TriangleSoup,
    map: &SeamlessMap,
    features: Option<&AlignedFeatures>,
    texture: &TextureArgs,
) -> Result<[Vec<u8>; 3], RenderError> {
    let corner_uvs: Vec<[f64; 2]> = map.corner_uvs().iter().map(|&uv| texture.apply(uv)).collect();
    let cones: Vec<(u32, i32)> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
    let seams: Vec<[u32; 2]> = map.seams().iter().map(|s| s.vertices).collect();
    let released = features.map(AlignedFeatures::released_pairs).unwrap_or_default();
    let scene = Scene {
        positions: &soup.positions,
        faces: &soup.faces,
        corner_uvs: Some(&corner_uvs),
        cones: &cones,
        seams: &seams,
        features: features.map_or(&[], |features| &features.kept),
        released: &released,
        ..Scene::default()
    };
    let surface = |view| {
        let paint = Paint::checker(texture.period);
        let options = SurfaceOptions { view, paint, ..SurfaceOptions::default() };
        render_surface(&scene, &options)
    };
    let images = [
        surface(View::Front)?,
        surface(View::Back)?,
        render_layout(&scene, &LayoutOptions::default())?,
    ];
    let mut files = [const { Vec::new() }; 3];
    for (image, file) in images.iter().zip(&mut files) {
        image.write_png(file)?;
    }
    Ok(files)
}

/// Draws a mesh with its features, as a PNG file.
pub(crate) fn draw_features(
    soup: &TriangleSoup,
    features: Option<&Features>,
) -> Result<Vec<u8>, RenderError> {
    let corners = features.map(Features::corners).unwrap_or_default();
    let open_ends = features.map(Features::open_ends).unwrap_or_default();
    let scene = Scene {
        positions: &soup.positions,
        faces: &soup.faces,
        features: features.map_or(&[], |features| &features.pairs),
        corners: &corners,
        open_ends: &open_ends,
        ..Scene::default()
    };
    let options = SurfaceOptions { paint: Paint::plain(), ..SurfaceOptions::default() };
    let mut file = Vec::new();
    render_surface(&scene, &options)?.write_png(&mut file)?;
    Ok(file)
}

/// Draws a quad mesh with its edges and irregular vertices.
pub(crate) fn draw_quads(
    quads: &QuadMesh,
    irregular: &[IrregularVertex],
) -> Result<Vec<u8>, RenderError> {
    let irregular: Vec<(u32, i32)> = irregular.iter().map(|v| (v.vertex, v.index)).collect();
    let polygons = || quads.quads().iter().map(<[u32; 4]>::as_slice);
    let net = Net::new(quads.positions(), polygons());
    let image = net.draw(&irregular, Paint::plain(), View::Front)?;
    let mut file = Vec::new();
    image.write_png(&mut file)?;
    Ok(file)
}

/// Draws polygons from both sides in the colours of a figure, with their edges, irregular vertices and a legend.
///
/// Irregular vertices come with their index: 4 less the edges there.
pub(crate) fn draw_polygons<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]> + Clone,
    irregular: &[(u32, i32)],
    (heat, values): (&HeatMap, &[f64]),
) -> Result<Vec<u8>, RenderError> {
    let net = Net::new(positions, polygons);
    let of_faces: Vec<f64> =
        net.polygon_of_face.iter().filter_map(|&p| values.get(p as usize)).copied().collect();
    let side = |view| net.draw(irregular, heat.paint(&of_faces), view);
    let both = side(View::Front)?.beside(&side(View::Back)?)?;
    let mut file = Vec::new();
    heat.with_legend(&both, &of_faces)?.write_png(&mut file)?;
    Ok(file)
}

/// Polygons as triangles and edges.
struct Net<'a> {
    positions: &'a [[f64; 3]],
    faces: Vec<[u32; 3]>,
    polygon_of_face: Vec<u32>,
    edges: Vec<[u32; 2]>,
}

impl<'a> Net<'a> {
    fn new<'b>(
        positions: &'a [[f64; 3]],
        polygons: impl Iterator<Item = &'b [u32]> + Clone,
    ) -> Self {
        let (faces, polygon_of_face) = match soup::triangulate(positions, polygons.clone()) {
            Ok(split) => (split.faces, split.polygon_of_face),
            // Polygons with a vertex twice can be drawn all the same.
            Err(_) => fans(polygons.clone()),
        };
        let mut edges: Vec<[u32; 2]> = polygons
            .flat_map(|polygon| (0..polygon.len()).map(move |k| (polygon, k)))
            .map(|(polygon, k)| [polygon[k], polygon[(k + 1) % polygon.len()]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        Self { positions, faces, polygon_of_face, edges }
    }

    fn draw(
        &self,
        irregular: &[(u32, i32)],
        paint: Paint,
        view: View,
    ) -> Result<Image, RenderError> {
        let scene = Scene {
            positions: self.positions,
            faces: &self.faces,
            cones: irregular,
            seams: &self.edges,
            ..Scene::default()
        };
        render_surface(&scene, &SurfaceOptions { view, paint, ..SurfaceOptions::default() })
    }
}

/// Triangles around the first corner of each polygon, and the polygon of each.
fn fans<'a>(polygons: impl Iterator<Item = &'a [u32]>) -> (Vec<[u32; 3]>, Vec<u32>) {
    let fan = |(p, polygon): (usize, &'a [u32])| {
        (2..polygon.len()).map(move |k| ([polygon[0], polygon[k - 1], polygon[k]], p as u32))
    };
    polygons.enumerate().flat_map(fan).unzip()
}
