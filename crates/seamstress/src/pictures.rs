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
    HeatMap, Image, LayoutOptions, Paint, RenderError, Scene, SurfaceOptions, Up, View,
    render_both, render_layout, render_surface,
};
use serde::{Deserialize, Serialize};

/// From where pictures show a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "View of the pictures"))]
#[non_exhaustive]
pub struct ViewOptions {
    /// Show the surface from this side, and where there are two pictures of it, in the second from the opposite side
    /// [default: from the front and a little from the right and from above]
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "SIDE", requires = "drawn"))]
    pub view: Option<ViewSide>,

    /// The axis that points up in pictures
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "AXIS", requires = "drawn",
        default_value_t = UpAxis::Y))]
    pub up: UpAxis,
}

/// A side of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum ViewSide {
    /// Where `z` points to; where `z` is up, against `y`
    Front,
    /// Opposite to the front
    Back,
    /// To the left of who looks from the front
    Left,
    /// To the right of who looks from the front
    Right,
    /// From above
    Top,
    /// From below
    Bottom,
    /// From the front, the right and above at once, by the same angle
    Iso,
}

/// An axis of the coordinates.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[allow(missing_docs)]
pub enum UpAxis {
    X,
    #[default]
    Y,
    Z,
}

impl ViewOptions {
    /// The view, and the one from the opposite side.
    fn sides(&self) -> [View; 2] {
        let Some(side) = self.view else { return [View::Front, View::Back] };
        let towards: [f64; 3] = match side {
            ViewSide::Front => [0.0, 0.0, 1.0],
            ViewSide::Back => [0.0, 0.0, -1.0],
            ViewSide::Left => [-1.0, 0.0, 0.0],
            ViewSide::Right => [1.0, 0.0, 0.0],
            ViewSide::Top => [0.0, 1.0, 0.0],
            ViewSide::Bottom => [0.0, -1.0, 0.0],
            ViewSide::Iso => [1.0; 3],
        };
        [View::Direction(towards), View::Direction(towards.map(|x| -x))]
    }

    /// How a surface is shown, from the first side where there is one picture.
    fn options(&self, paint: Paint) -> SurfaceOptions {
        let up = match self.up {
            UpAxis::X => Up::X,
            UpAxis::Y => Up::Y,
            UpAxis::Z => Up::Z,
        };
        let [view, _] = self.sides();
        SurfaceOptions { up, view, paint, ..SurfaceOptions::default() }
    }

    /// Draws a scene from both sides.
    fn draw_both(&self, scene: &Scene, paint: Paint) -> Result<[Image; 2], RenderError> {
        render_both(scene, &self.options(paint), self.sides())
    }
}

/// How pictures lay their texture over a map, and from where they show it.
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

    /// From where the surface is seen
    #[cfg_attr(feature = "clap", command(flatten))]
    pub view: ViewOptions,
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
    /// The surface from the front, or the side that is asked for, with a checkerboard, cones, seams and features.
    pub front: Vec<u8>,
    /// The same from the opposite side.
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
        draw_map(self.surface(), (self.inner(), &self.unscaled_uvs()), self.features(), &texture)
    }
}

impl QuadMesh {
    /// Draws the quads with their edges and irregular vertices, as a PNG file.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn picture(&self, view: &ViewOptions) -> Result<Vec<u8>, Error> {
        let irregular: Vec<(u32, i32)> =
            self.irregular().iter().map(|v| (v.vertex, v.index)).collect();
        let polygons = || self.quads().iter().map(<[u32; 4]>::as_slice);
        let net = Net::new(self.positions(), polygons());
        let image = render_surface(&net.scene(&irregular), &view.options(Paint::plain()));
        image.and_then(|image| png(&image)).map_err(no_picture)
    }
}

impl Surface {
    /// Draws the surface with features, as a PNG file: corners are dark dots, open ends orange ones.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn picture(
        &self,
        features: Option<&FeatureCurves>,
        view: &ViewOptions,
    ) -> Result<Vec<u8>, Error> {
        let scene = Scene {
            positions: self.positions(),
            faces: self.faces(),
            features: features.map_or(&[], FeatureCurves::edges),
            corners: features.map_or(&[], FeatureCurves::corners),
            open_ends: features.map_or(&[], FeatureCurves::open_ends),
            ..Scene::default()
        };
        let image = render_surface(&scene, &view.options(Paint::plain()));
        image.and_then(|image| png(&image)).map_err(no_picture)
    }

    /// Draws the surface from both sides in the colours of a measure, with a legend, as a PNG file.
    ///
    /// # Errors
    /// [`ErrorKind::NoPicture`].
    pub fn heat_picture(
        &self,
        measured: &Measurement,
        view: &ViewOptions,
    ) -> Result<Vec<u8>, Error> {
        self.heat_image(measured, view).and_then(|image| png(&image)).map_err(no_picture)
    }

    fn heat_image(&self, measured: &Measurement, view: &ViewOptions) -> Result<Image, RenderError> {
        let scene = Scene { positions: self.positions(), faces: self.faces(), ..Scene::default() };
        let heat = measured.heat();
        let [front, back] = view.draw_both(&scene, heat.paint(&measured.values))?;
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
    (map, corner_uvs): (&method::SeamlessMap, &[[f64; 2]]),
    features: Option<&AlignedFeatures>,
    texture: &TextureOptions,
) -> Result<MapPictures, Error> {
    let corner_uvs: Vec<[f64; 2]> = corner_uvs.iter().map(|&uv| texture.apply(uv)).collect();
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
    let draw = || {
        let [front, back] = texture.view.draw_both(&scene, Paint::checker(texture.period))?;
        let layout = render_layout(&scene, &LayoutOptions::default())?;
        Ok(MapPictures { front: png(&front)?, back: png(&back)?, layout: png(&layout)? })
    };
    draw().map_err(no_picture)
}

/// Draws polygons from both sides in colours, one value each, with edges, irregular vertices and a legend, as a PNG
/// file.
pub(crate) fn draw_polygons<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]> + Clone,
    irregular: &[(u32, i32)],
    (heat, values): (&HeatMap, &[f64]),
    view: &ViewOptions,
) -> Result<Vec<u8>, Error> {
    let net = Net::new(positions, polygons);
    let of_faces: Vec<f64> =
        net.polygon_of_face.iter().filter_map(|&p| values.get(p as usize)).copied().collect();
    let draw = || {
        let [front, back] = view.draw_both(&net.scene(irregular), heat.paint(&of_faces))?;
        png(&heat.with_legend(&front.beside(&back)?, &of_faces)?)
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

    fn scene<'b>(&'b self, irregular: &'b [(u32, i32)]) -> Scene<'b> {
        Scene {
            positions: self.positions,
            faces: &self.faces,
            cones: irregular,
            seams: &self.edges,
            ..Scene::default()
        }
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
        let texture = TextureOptions { angle: 90.0, shift: [1.0, -2.0], ..Default::default() };
        let [u, v] = texture.apply([3.0, 5.0]);
        assert!((u + 4.0).abs() < 1e-12 && (v - 1.0).abs() < 1e-12);
        assert_eq!(TextureOptions::default().apply([0.1, 0.7]), [0.1, 0.7]);
    }

    /// A box as long as its sides along `x`, `y` and `z`.
    fn block(sides: [f64; 3]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let corner = |v: u32| std::array::from_fn(|k| sides[k] * f64::from((v >> k) & 1));
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        ((0..8).map(corner).collect(), faces)
    }

    #[test]
    fn sides_and_the_axis_that_is_up_show_as_they_are_named() {
        let (positions, faces) = block([4.0, 2.0, 1.0]);
        let scene = Scene { positions: &positions, faces: &faces, ..Scene::default() };
        // Width over height of what is not background.
        let shape = |side, up| {
            let view = ViewOptions { view: Some(side), up };
            let image = render_surface(&scene, &view.options(Paint::plain())).unwrap();
            let drawn = |x: &u32, y: &u32| image.pixel(*x, *y) != [255; 3];
            let across = (0..image.width()).filter(|x| drawn(x, &(image.height() / 2))).count();
            let down = (0..image.height()).filter(|y| drawn(&(image.width() / 2), y)).count();
            across as f64 / down as f64
        };
        let cases = [
            (ViewSide::Front, UpAxis::Y, 4.0 / 2.0),
            (ViewSide::Back, UpAxis::Y, 4.0 / 2.0),
            (ViewSide::Left, UpAxis::Y, 1.0 / 2.0),
            (ViewSide::Right, UpAxis::Y, 1.0 / 2.0),
            (ViewSide::Top, UpAxis::Y, 4.0 / 1.0),
            (ViewSide::Bottom, UpAxis::Z, 4.0 / 2.0),
            (ViewSide::Front, UpAxis::Z, 4.0 / 1.0),
            (ViewSide::Left, UpAxis::Z, 2.0 / 1.0),
            (ViewSide::Front, UpAxis::X, 2.0 / 4.0),
        ];
        for (side, up, expected) in cases {
            let found = shape(side, up);
            assert!((found / expected - 1.0).abs() < 0.02, "{side:?} {up:?}: {found}");
        }
    }

    #[test]
    fn an_axis_that_is_up_draws_the_mesh_that_is_turned() {
        let (positions, faces) = block([4.0, 2.0, 1.0]);
        let turned: Vec<[f64; 3]> = positions.iter().map(|&[x, y, z]| [x, z, -y]).collect();
        let picture = |positions: &[[f64; 3]], up| {
            let view = ViewOptions { view: None, up };
            Surface::from_triangles(positions, &faces).unwrap().picture(None, &view).unwrap()
        };
        assert!(picture(&positions, UpAxis::Z) == picture(&turned, UpAxis::Y));
        assert!(picture(&positions, UpAxis::Z) != picture(&positions, UpAxis::Y));
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
