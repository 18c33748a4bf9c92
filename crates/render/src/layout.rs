//! The picture of a map in the plane of its UVs.

use crate::band::{Band, EMPTY, FIRST_OVERLAY, Line, Marks};
use crate::frame::{ByBand, Painter, Patch, Raster};
use crate::image::to_linear;
use crate::interpolate::Barycentric;
use crate::normalize::Normalizer;
use crate::paint::{Coat, FaceCoat, Paint, signed_area};
use crate::palette::{Palette, hex};
use crate::raster::{ScreenPoint, range};
use crate::scene::{Scene, check_finite};
use crate::surface::{FEATURE_WIDTH, check_fractions};
use crate::topology::{edges, matched_corners, next_corner, sorted_sides};
use crate::{Image, RenderError};

/// How a layout is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct LayoutOptions {
    /// Width and height in pixels, at most 8192 each.
    pub size: [u32; 2],
    /// The fill of the triangles.
    pub paint: Paint,
    /// Samples along each side of a pixel in which something ends, between 1 and 8.
    pub supersampling: u32,
    /// Free space on each side, as a fraction of the picture.
    pub margin: f64,
    /// Width of the boundary and of seams, as a fraction of the picture's shorter side; features are
    /// twice as wide.
    pub line_width: f64,
    /// Width of the edges of triangles, as a fraction of the picture's shorter side. They fade
    /// where the triangles are too small for them.
    pub edge_width: f64,
    /// Radius of the dots on cones, as a fraction of the picture's shorter side.
    pub cone_radius: f64,
    /// The other colours.
    pub palette: Palette,
}

impl Default for LayoutOptions {
    fn default() -> Self {
        Self {
            size: [1000, 1000],
            paint: Paint::Plain(hex(0xeeeae1)),
            supersampling: 3,
            margin: 0.03,
            line_width: 0.0016,
            edge_width: 0.0007,
            cone_radius: 0.0055,
            palette: Palette::default(),
        }
    }
}

/// Corners whose UVs differ by less than this part of the layout's size meet.
const SAME_UV: f64 = 1e-7;
/// Sizes of triangles (roots of their areas), in pixels, between which their edges fade in: for
/// the mean size over the layout, and again for each triangle.
const EDGES_FADE: [[f64; 2]; 2] = [[2.5, 14.0], [0.5, 4.0]];

/// Ids of samples that show something other than a face.
const OUTLINE: u32 = EMPTY - 1;
const FLIPPED: u32 = EMPTY - 2;
const FEATURE: u32 = EMPTY - 3;
const RELEASED: u32 = EMPTY - 4;

/// Draws the UVs of a scene in their plane, `v` upwards.
///
/// Triangles whose UVs run clockwise are flipped: they are drawn last, in their own colour, and
/// with a rim, so that none is too thin to be seen. Where two faces meet with different UVs the
/// edge counts as a seam, listed or not.
///
/// # Errors
/// If the scene is empty, inconsistent or without UVs, or if an option is out of range.
pub fn render_layout(scene: &Scene, options: &LayoutOptions) -> Result<Image, RenderError> {
    scene.check()?;
    let raster = Raster::new(options.size, options.supersampling)?;
    check_fractions([
        ("margin", options.margin),
        ("line_width", options.line_width),
        ("edge_width", options.edge_width),
        ("cone_radius", options.cone_radius),
    ])?;
    for (name, color) in options.palette.entries() {
        check_finite(name, &[color])?;
    }
    let picture = LayoutPicture::new(scene, options, raster)?;
    Ok(raster.compose(&picture))
}

struct LayoutPicture<'a> {
    /// Where the corners of each face fall.
    corners: Vec<[[f64; 2]; 3]>,
    by_band: ByBand,
    flipped: Vec<u32>,
    coat: Coat<'a>,
    /// Both sides of each feature and seam.
    lines: Vec<Line>,
    lines_by_band: ByBand,
    dots: Vec<([f64; 2], [f32; 3])>,
    edge_half_width: f64,
    edges_shown: f64,
    dot_radius: f64,
    per_pixel: f64,
    background: [f32; 3],
    outline: [f32; 3],
    feature_color: [f32; 3],
    released_color: [f32; 3],
    edge: [f32; 3],
    flipped_color: [f32; 3],
}

impl<'a> LayoutPicture<'a> {
    fn new(
        scene: &Scene<'a>,
        options: &LayoutOptions,
        raster: Raster,
    ) -> Result<Self, RenderError> {
        let uvs = scene.uvs()?;
        let normalizer =
            Normalizer::fit(uvs.iter().copied()).ok_or(RenderError::NoExtent { what: "UVs" })?;
        let plane: Vec<[[f64; 2]; 3]> = uvs
            .chunks_exact(3)
            .map(|c| [c[0], c[1], c[2]].map(|uv| normalizer.apply(uv)))
            .collect();
        let used = scene.faces.iter().flatten();
        let positions = match Normalizer::fit(used.map(|&v| scene.positions[v as usize])) {
            Some(space) => scene.positions.iter().map(|&p| space.apply(p)).collect(),
            None => vec![[0.0; 3]; scene.positions.len()],
        };
        let screen = Screen::fit(plane.as_flattened(), raster.samples(), options.margin);
        let corners: Vec<_> = plane.iter().map(|f| f.map(|uv| screen.project(uv))).collect();
        let faces = 0..plane.len() as u32;
        let shorter = raster.shorter_side();
        let half_width = 0.5 * options.line_width * shorter;
        let wide = FEATURE_WIDTH * half_width;
        let line = |half_width, id| {
            move |ends: [[f64; 2]; 2]| Line { ends: ends.map(at_depth(1.0)), half_width, id }
        };
        let place = |corner: u32| corners[corner as usize / 3][corner as usize % 3];
        let along = |edges| sides_along(edges, scene.faces, &corners).into_iter();
        let lines: Vec<Line> = along(scene.features)
            .map(line(wide, FEATURE))
            .chain(
                outlines(scene, &plane).map(|ends| ends.map(place)).map(line(half_width, OUTLINE)),
            )
            .chain(along(scene.released).map(line(wide, RELEASED)))
            .collect();
        Ok(Self {
            flipped: faces.filter(|&f| signed_area(plane[f as usize]) < 0.0).collect(),
            coat: options.paint.prepare(scene, &positions)?,
            lines_by_band: raster.by_band(lines.iter().map(Line::span)),
            lines,
            dots: dots(scene, &corners, &options.palette),
            edge_half_width: 0.5 * options.edge_width * shorter,
            edges_shown: fade_in(
                mean_size(&corners) / f64::from(raster.per_pixel()),
                EDGES_FADE[0],
            ),
            dot_radius: options.cone_radius * shorter,
            per_pixel: f64::from(raster.per_pixel()),
            background: to_linear(options.palette.background),
            outline: to_linear(options.palette.seam),
            feature_color: to_linear(options.palette.feature),
            released_color: to_linear(options.palette.released),
            edge: to_linear(options.palette.edge),
            flipped_color: to_linear(options.palette.flipped),
            by_band: raster.by_band(corners.iter().map(|c| range(c.map(|p| p[1])))),
            corners,
        })
    }
}

/// The similarity from the normalised plane to the samples.
struct Screen {
    scale: f64,
    offset: [f64; 2],
}

impl Screen {
    fn fit(points: &[[f64; 2]], samples: [f64; 2], margin: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let scale = (0..2).fold(f64::INFINITY, |s, k| {
            s.min(samples[k] * (1.0 - 2.0 * margin) / (high[k] - low[k]).max(1e-12))
        });
        let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        Self {
            scale,
            offset: [0.5 * samples[0] - scale * middle[0], 0.5 * samples[1] + scale * middle[1]],
        }
    }

    fn project(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [self.offset[0] + self.scale * u, self.offset[1] - self.scale * v]
    }
}

/// The sides, as pairs of corners, at the boundary, along listed seams, and wherever the UVs of
/// two faces part.
fn outlines<'b>(
    scene: &Scene<'b>,
    plane: &'b [[[f64; 2]; 3]],
) -> impl Iterator<Item = [u32; 2]> + 'b {
    let faces = scene.faces;
    let mut seams: Vec<[u32; 2]> = scene.seams.to_vec();
    seams.iter_mut().for_each(|s| s.sort_unstable());
    seams.sort_unstable();
    let uv = |corner: u32| plane[corner as usize / 3][corner as usize % 3];
    let meet = move |[a, b]: [u32; 2]| (0..2).all(|k| (uv(a)[k] - uv(b)[k]).abs() <= SAME_UV);
    let sides = sorted_sides(faces);
    let mut found = Vec::new();
    for edge in edges(&sides) {
        let inner = match edge {
            &[a, b] => {
                seams.binary_search(&a.vertices).is_err()
                    && matched_corners(faces, a, b).into_iter().all(meet)
            }
            _ => false,
        };
        if !inner {
            found.extend(edge.iter().map(|s| [s.corner, next_corner(s.corner)]));
        }
    }
    found.into_iter()
}

/// The sides of the faces along edges given by their ends.
fn sides_along(
    edges: &[[u32; 2]],
    faces: &[[u32; 3]],
    corners: &[[[f64; 2]; 3]],
) -> Vec<[[f64; 2]; 2]> {
    if edges.is_empty() {
        return Vec::new();
    }
    let mut edges = edges.to_vec();
    edges.iter_mut().for_each(|ends| ends.sort_unstable());
    edges.sort_unstable();
    let mut found = Vec::new();
    for (face, points) in faces.iter().zip(corners) {
        for k in 0..3 {
            let mut ends = [face[k], face[(k + 1) % 3]];
            ends.sort_unstable();
            if edges.binary_search(&ends).is_ok() {
                found.push([points[k], points[(k + 1) % 3]]);
            }
        }
    }
    found
}

/// The places and colours of the cones, at every corner of theirs.
fn dots(scene: &Scene, corners: &[[[f64; 2]; 3]], palette: &Palette) -> Vec<([f64; 2], [f32; 3])> {
    let mut cones = scene.cones.to_vec();
    cones.sort_unstable();
    let mut dots = Vec::new();
    for (face, points) in scene.faces.iter().zip(corners) {
        for (vertex, point) in face.iter().zip(points) {
            if let Ok(at) = cones.binary_search_by_key(vertex, |c| c.0) {
                dots.push((*point, to_linear(palette.cone(cones[at].1))));
            }
        }
    }
    dots
}

impl Painter for LayoutPicture<'_> {
    fn mark(&self, index: usize, marks: &mut Marks) {
        // The texture is that of the plane, and goes on from face to face.
        if matches!(self.coat, Coat::PerFace(_)) {
            let faces = self.by_band.of(index).iter().map(|&face| self.corners[face as usize]);
            faces.for_each(|face| marks.triangle(face.map(at_depth(0.0))));
        }
        for &face in &self.flipped {
            let corners = self.corners[face as usize].map(at_depth(0.0));
            marks.triangle(corners);
            (0..3).for_each(|k| marks.line([corners[k], corners[(k + 1) % 3]], self.rim()));
        }
        for &line in self.lines_by_band.of(index) {
            let line = &self.lines[line as usize];
            marks.line(line.ends, line.half_width);
        }
        for &(centre, _) in &self.dots {
            marks.ball(at_depth(0.0)(centre), self.dot_radius);
        }
    }

    fn draw(&self, index: usize, band: &mut Band) {
        for &face in self.by_band.of(index) {
            band.fill_triangle(self.corners[face as usize].map(at_depth(0.0)), face);
        }
        for &face in &self.flipped {
            let raised = self.corners[face as usize].map(at_depth(1.0));
            band.fill_triangle(raised, FLIPPED);
            for k in 0..3 {
                let ends = [raised[k], raised[(k + 1) % 3]];
                band.draw_line(ends, self.rim(), FLIPPED, |_, _, _| 0.0);
            }
        }
        for &line in self.lines_by_band.of(index) {
            let line = &self.lines[line as usize];
            if line.half_width > 0.0 {
                band.draw_line(line.ends, line.half_width, line.id, |_, _, _| 0.0);
            }
        }
        if self.dot_radius > 0.0 {
            for (index, (centre, _)) in self.dots.iter().enumerate() {
                let centre = at_depth(2.0)(*centre);
                band.draw_ball(centre, self.dot_radius, 0.0, FIRST_OVERLAY + index as u32);
            }
        }
    }

    fn shader(&self) -> impl FnMut(u32, Patch) -> [f32; 3] {
        let mut current = EMPTY;
        let mut shader = None;
        move |id, patch| match id {
            EMPTY => self.background,
            OUTLINE => self.outline,
            FLIPPED => self.flipped_color,
            FEATURE => self.feature_color,
            RELEASED => self.released_color,
            dot if dot >= FIRST_OVERLAY => {
                let (centre, color) = self.dots[(dot - FIRST_OVERLAY) as usize];
                let [x, y] = patch.at;
                let reach = (x - centre[0]).hypot(y - centre[1]);
                if reach > 0.8 * self.dot_radius { self.background } else { color }
            }
            face => {
                if let (Coat::Plain(color), true) = (&self.coat, self.edges_shown == 0.0) {
                    return *color;
                }
                if face != current {
                    current = face;
                    shader = self.on_face(face as usize);
                }
                shader.as_ref().map_or(self.background, |s| s.color(self, patch))
            }
        }
    }
}

/// A triangle ready to be coloured.
struct Shader<'a> {
    barycentric: Barycentric,
    /// Heights over the three edges, in samples.
    heights: [f64; 3],
    /// How much of the edges shows.
    edges: f64,
    coat: FaceCoat<'a>,
}

/// Points of the plane over it.
fn at_depth(depth: f64) -> impl Fn([f64; 2]) -> ScreenPoint {
    move |[x, y]| ScreenPoint { x, y, depth, inverse_w: 1.0 }
}

/// The area of a triangle in samples.
fn screen_area(corners: [[f64; 2]; 3]) -> f64 {
    0.5 * signed_area(corners).abs()
}

/// The mean over the layout of the sizes of the triangles that lie there, in samples.
fn mean_size(corners: &[[[f64; 2]; 3]]) -> f64 {
    let areas = corners.iter().map(|&c| screen_area(c));
    let (sum, area) = areas.fold((0.0, 0.0), |(s, t), a| (s + a * a.sqrt(), t + a));
    if area > 0.0 { sum / area } else { 0.0 }
}

/// Rises smoothly from 0 to 1 between two values.
fn fade_in(x: f64, [low, high]: [f64; 2]) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl LayoutPicture<'_> {
    /// Half the width of the rims of flipped triangles.
    fn rim(&self) -> f64 {
        0.5 * self.per_pixel
    }

    fn on_face(&self, face: usize) -> Option<Shader<'_>> {
        let barycentric = Barycentric::new(self.corners[face].map(at_depth(0.0)))?;
        let heights = barycentric.heights();
        let pixels = screen_area(self.corners[face]).sqrt() / self.per_pixel;
        Some(Shader {
            barycentric,
            heights,
            edges: self.edges_shown * fade_in(pixels, EDGES_FADE[1]),
            coat: self.coat.on_face(face),
        })
    }
}

impl Shader<'_> {
    fn color(&self, picture: &LayoutPicture, Patch { at: [x, y], side }: Patch) -> [f32; 3] {
        let weights = self.barycentric.at(x, y);
        let fill = self.coat.color(&weights, side);
        let nearest = (0..3).fold(f64::INFINITY, |d, k| d.min(weights.value[k] * self.heights[k]));
        // The part of the patch on the edge, as if the edge ran along a side of it.
        let (half, reach) = (picture.edge_half_width, 0.5 * side);
        let across = half.min(nearest + reach) - (-half).max(nearest - reach);
        let covered = (across / side).clamp(0.0, 1.0);
        let blend = (self.edges * covered) as f32;
        std::array::from_fn(|c| fill[c] + blend * (picture.edge[c] - fill[c]))
    }
}
