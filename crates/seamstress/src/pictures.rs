//! Pictures, drawn in software, as PNG files in memory.

use crate::error::{Error, ErrorKind, Stage};
use crate::features::{AlignedFeatures, FeatureCurves};
use crate::map::{Described, SeamlessMap};
use crate::quads::QuadMesh;
use crate::report::Measurement;
use crate::surface::Surface;
use crate::words::rounded;
use seamstress_mesh::soup;
use seamstress_parametrize as method;
use seamstress_render::{
    HeatMap, Image, LayoutOptions, Paint, RenderError, Scene, SurfaceOptions, View, render_layout,
    render_surface,
};
use serde::{Deserialize, Serialize};

/// How pictures lay their texture over a map.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Texture of the pictures"))]
#[non_exhaustive]
pub struct TextureOptions {
    /// Turn the texture by so many degrees; seams fit all the same
    #[cfg_attr(feature = "clap", arg(long = "texture-angle", value_name = "DEGREES", requires = "pictures",
        default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse::finite))]
    pub angle: f64,

    /// Shift the texture by U,V, in units of the map
    #[cfg_attr(feature = "clap", arg(long = "texture-shift", value_name = "U,V", requires = "pictures",
        default_value = "0,0", allow_negative_numbers = true, value_parser = parse::pair))]
    pub shift: [f64; 2],

    /// Side of a check of the texture, in units of the map [default: suits the size of the surface]
    #[cfg_attr(feature = "clap", arg(long = "texture-period", value_name = "X", requires = "pictures",
        value_parser = parse::positive))]
    pub period: Option<f64>,
}

impl TextureOptions {
    /// Where the texture has a point of the map.
    fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = match self.angle {
            0.0 => (0.0, 1.0),
            degrees => degrees.to_radians().sin_cos(),
        };
        [cos * u - sin * v + self.shift[0], sin * u + cos * v + self.shift[1]]
    }
}

/// Parsers of arguments.
#[cfg(feature = "clap")]
pub(crate) mod parse {
    pub(crate) fn finite(text: &str) -> Result<f64, String> {
        let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| "expected a number".into())
    }

    pub(crate) fn positive(text: &str) -> Result<f64, String> {
        match finite(text) {
            Ok(x) if x > 0.0 => Ok(x),
            _ => Err("expected a number larger than 0".into()),
        }
    }

    pub(crate) fn pair(text: &str) -> Result<[f64; 2], String> {
        match text.split_once(',').map(|(u, v)| (finite(u), finite(v))) {
            Some((Ok(u), Ok(v))) => Ok([u, v]),
            _ => Err("expected two numbers, as in 0.5,0".into()),
        }
    }
}

/// Three pictures of a map, each a PNG file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct MapPictures {
    /// The surface from the front, with a checkerboard, cones, seams and features.
    pub front: Vec<u8>,
    /// The same from the back.
    pub back: Vec<u8>,
    /// The map in the plane.
    pub layout: Vec<u8>,
}

impl<R: Described> SeamlessMap<R> {
    /// Draws it; an integer-grid map by default with one check a cell.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn pictures(&self, texture: &TextureOptions) -> Result<MapPictures, Error> {
        let texture = TextureOptions { period: texture.period.or(R::CHECK), ..*texture };
        draw_map(self.surface(), self.inner(), self.features(), &texture)
    }
}

impl QuadMesh {
    /// Draws the quads with their edges and irregular vertices, as a PNG file.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn picture(&self) -> Result<Vec<u8>, Error> {
        let irregular: Vec<(u32, i32)> =
            self.irregular().iter().map(|v| (v.vertex, v.index)).collect();
        let polygons = || self.quads().iter().map(<[u32; 4]>::as_slice);
        let net = Net::new(self.positions(), polygons());
        let image = net.draw(&irregular, Paint::plain(), View::Front);
        image.and_then(|image| png(&image)).map_err(no_picture)
    }
}

impl Surface {
    /// Draws the surface with features, as a PNG file: corners are dark dots, open ends orange ones.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn picture(&self, features: Option<&FeatureCurves>) -> Result<Vec<u8>, Error> {
        let scene = Scene {
            positions: self.positions(),
            faces: self.faces(),
            features: features.map_or(&[], FeatureCurves::edges),
            corners: features.map_or(&[], FeatureCurves::corners),
            open_ends: features.map_or(&[], FeatureCurves::open_ends),
            ..Scene::default()
        };
        let options = SurfaceOptions { paint: Paint::plain(), ..SurfaceOptions::default() };
        render_surface(&scene, &options).and_then(|image| png(&image)).map_err(no_picture)
    }

    /// Draws the surface from both sides in the colours of a measure, with a legend, as a PNG file.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn heat_picture(&self, measured: &Measurement) -> Result<Vec<u8>, Error> {
        self.heat_image(measured).and_then(|image| png(&image)).map_err(no_picture)
    }

    fn heat_image(&self, measured: &Measurement) -> Result<Image, RenderError> {
        let scene = Scene { positions: self.positions(), faces: self.faces(), ..Scene::default() };
        let heat = measured.heat();
        let options = |view| SurfaceOptions {
            view,
            paint: heat.paint(&measured.values),
            ..SurfaceOptions::default()
        };
        let front = render_surface(&scene, &options(View::Front))?;
        let back = render_surface(&scene, &options(View::Back))?;
        heat.with_legend(&front.beside(&back)?, &measured.values)
    }
}

/// The colours span at least this: an isometry has one colour, not the noise of its last digits.
const MINIMUM_RANGE: f64 = 1e-6;

impl Measurement {
    /// The scale of colours that suits it.
    pub(crate) fn heat(&self) -> HeatMap {
        let mut high = self.percentiles.p99;
        if !high.is_finite() {
            let finite = self.values.iter().copied().filter(|x| x.is_finite());
            high = finite.fold(self.ideal, f64::max);
        }
        let title = format!(
            "{}   mean {}   max {}",
            self.measure.name(),
            rounded(self.mean),
            rounded(self.max)
        );
        HeatMap { low: self.ideal, high: high.max(self.ideal + MINIMUM_RANGE), title }
    }
}

fn no_picture(cause: RenderError) -> Error {
    Error::new(ErrorKind::NoPicture, format!("no picture could be drawn: {cause}"))
        .at_stage(Some(Stage::Pictures))
}

fn png(image: &Image) -> Result<Vec<u8>, RenderError> {
    let mut file = Vec::new();
    image.write_png(&mut file)?;
    Ok(file)
}

/// Draws a map with its features, aligned and dropped; the texture is turned, scaled and shifted first.
fn draw_map(
    surface: &Surface,
    map: &method::SeamlessMap,
    features: Option<&AlignedFeatures>,
    texture: &TextureOptions,
) -> Result<MapPictures, Error> {
    let corner_uvs: Vec<[f64; 2]> = map.corner_uvs().iter().map(|&uv| texture.apply(uv)).collect();
    let cones: Vec<(u32, i32)> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
    let seams: Vec<[u32; 2]> = map.seams().iter().map(|s| s.vertices).collect();
    let dropped = features.map(AlignedFeatures::dropped_pairs).unwrap_or_default();
    let scene = Scene {
        positions: surface.positions(),
        faces: surface.faces(),
        corner_uvs: Some(&corner_uvs),
        cones: &cones,
        seams: &seams,
        features: features.map_or(&[], |features| &features.kept),
        released: &dropped,
        ..Scene::default()
    };
    let side = |view| {
        let paint = Paint::checker(texture.period);
        let options = SurfaceOptions { view, paint, ..SurfaceOptions::default() };
        render_surface(&scene, &options).and_then(|image| png(&image)).map_err(no_picture)
    };
    let layout = render_layout(&scene, &LayoutOptions::default()).and_then(|image| png(&image));
    Ok(MapPictures {
        front: side(View::Front)?,
        back: side(View::Back)?,
        layout: layout.map_err(no_picture)?,
    })
}

/// Draws polygons from both sides in colours, one value each, with edges, irregular vertices and a legend, as a PNG
/// file.
pub(crate) fn draw_polygons<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]> + Clone,
    irregular: &[(u32, i32)],
    (heat, values): (&HeatMap, &[f64]),
) -> Result<Vec<u8>, Error> {
    let net = Net::new(positions, polygons);
    let of_faces: Vec<f64> =
        net.polygon_of_face.iter().filter_map(|&p| values.get(p as usize)).copied().collect();
    let side = |view| net.draw(irregular, heat.paint(&of_faces), view);
    let draw = || {
        let both = side(View::Front)?.beside(&side(View::Back)?)?;
        png(&heat.with_legend(&both, &of_faces)?)
    };
    draw().map_err(no_picture)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_and_a_shift() {
        let texture = TextureOptions { angle: 90.0, shift: [1.0, -2.0], period: None };
        let [u, v] = texture.apply([3.0, 5.0]);
        assert!((u + 4.0).abs() < 1e-12 && (v - 1.0).abs() < 1e-12);
        assert_eq!(TextureOptions::default().apply([0.1, 0.7]), [0.1, 0.7]);
    }

    #[cfg(feature = "clap")]
    #[test]
    fn numbers_and_pairs() {
        use parse::{finite, pair, positive};
        assert_eq!(pair("0.5,-2"), Ok([0.5, -2.0]));
        assert!(pair("1").is_err() && pair("a,b").is_err() && pair("1,inf").is_err());
        assert!(positive("0").is_err() && finite("nan").is_err());
    }
}
