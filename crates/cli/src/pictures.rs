//! Pictures of a map as PNG files.

use crate::args::TextureArgs;
use crate::features::{AlignedFeatures, Features};
use crate::text::figure;
use seamstress::SeamlessMap;
use seamstress::quality::Summary;
use seamstress_quads::{IrregularVertex, QuadMesh};
use seamstress_render::{
    HeatMap, LayoutOptions, Paint, RenderError, Scene, SurfaceOptions, View, render_layout,
    render_surface,
};
use seamstress_surface::soup::TriangleSoup;

/// The files, in the order of [`draw`].
pub(crate) const NAMES: [&str; 3] = ["front.png", "back.png", "layout.png"];

/// Draws the surface from both sides in the colours of a measure, with a legend, as one PNG.
pub(crate) fn heat(soup: &TriangleSoup, summary: &Summary) -> Result<Vec<u8>, RenderError> {
    let scene = Scene { positions: &soup.positions, faces: &soup.faces, ..Scene::default() };
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
    let heat = HeatMap { low: measure.ideal(), high, title };
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
    let faces: Vec<[u32; 3]> =
        quads.quads().iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mut edges: Vec<[u32; 2]> = quads
        .quads()
        .iter()
        .flat_map(|quad| (0..4).map(|k| [quad[k], quad[(k + 1) % 4]]))
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable();
    edges.dedup();
    let cones: Vec<(u32, i32)> = irregular.iter().map(|v| (v.vertex, v.index)).collect();
    let scene = Scene {
        positions: quads.positions(),
        faces: &faces,
        cones: &cones,
        seams: &edges,
        ..Scene::default()
    };
    let options = SurfaceOptions { paint: Paint::plain(), ..SurfaceOptions::default() };
    let mut file = Vec::new();
    render_surface(&scene, &options)?.write_png(&mut file)?;
    Ok(file)
}
