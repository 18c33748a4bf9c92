//! The picture of a surface in space.

use crate::band::{Band, EMPTY, FIRST_OVERLAY, Line, Marks};
use crate::camera::{Camera, Projection, Up, View};
use crate::frame::{ByBand, Painter, Patch, Raster};
use crate::image::to_linear;
use crate::interpolate::{Barycentric, blend};
use crate::lighting::Lights;
use crate::normalize::Normalizer;
use crate::normals::{Normals, SmoothEdge};
use crate::occlusion::{Openness, Sky};
use crate::paint::{Coat, FaceCoat, Paint, signed_area};
use crate::palette::Palette;
use crate::raster::{ScreenPoint, range};
use crate::scene::{Scene, check_finite};
use crate::vec3::{Vec3, add, dot, scale};
use crate::{Image, RenderError};

/// How a surface is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceOptions {
    /// Width and height in pixels, at most 8192 each.
    pub size: [u32; 2],
    /// The axis that points up.
    pub up: Up,
    /// Where the viewer stands.
    pub view: View,
    /// Perspective or not.
    pub projection: Projection,
    /// The colour of the surface.
    pub paint: Paint,
    /// Samples along each side of a pixel in which something ends, between 1 and 8.
    pub supersampling: u32,
    /// Free space on each side, as a fraction of the picture.
    pub margin: f64,
    /// Width of seams, as a fraction of the picture's shorter side; features are twice as wide, so that
    /// they show on both sides of a seam; released ones cover it.
    pub line_width: f64,
    /// How much hollows darken, between 0 (not at all) and 1.
    pub occlusion: f64,
    /// Radius of the balls on cones, as a fraction of the picture's shorter side; those on corners
    /// and open ends are a little smaller.
    pub cone_radius: f64,
    /// The other colours.
    pub palette: Palette,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        Self {
            size: [1000, 1000],
            up: Up::default(),
            view: View::Front,
            projection: Projection::default(),
            paint: Paint::checker(None),
            supersampling: 3,
            margin: 0.03,
            line_width: 0.0018,
            occlusion: 0.9,
            cone_radius: 0.008,
            palette: Palette::default(),
        }
    }
}

/// A line may lie this far behind a face and still show, in units of about the mesh's size.
const LINE_SLACK: f64 = 0.0015;
/// The most that slack grows on faces seen at a grazing angle.
const GRAZING_SLACK: f64 = 0.02;
/// Balls come this much of their radius towards the viewer, to sit on the surface.
const BALL_LIFT: f64 = 0.5;

/// Width of features in widths of seams.
pub(crate) const FEATURE_WIDTH: f64 = 2.0;
/// Radius of the balls on corners and ends of features in radii of those on cones.
const CORNER_RADIUS: f64 = 0.75;

/// Ids of samples that show something other than a face.
const SEAM: u32 = EMPTY - 1;
const FEATURE: u32 = EMPTY - 2;
const RELEASED: u32 = EMPTY - 3;

/// Draws the surface of a scene.
///
/// # Errors
/// If the scene is empty or inconsistent, if an option is out of range, or if the paint needs
/// UVs and the scene has none.
pub fn render_surface(scene: &Scene, options: &SurfaceOptions) -> Result<Image, RenderError> {
    Model::new(scene, options)?.draw(options.view)
}

/// Draws the surface of a scene from two sides, in place of the view of the options; what does not depend on the view
/// is prepared once.
///
/// # Errors
/// Those of [`render_surface`].
pub fn render_both(
    scene: &Scene,
    options: &SurfaceOptions,
    [first, second]: [View; 2],
) -> Result<[Image; 2], RenderError> {
    let model = Model::new(scene, options)?;
    Ok([model.draw(first)?, model.draw(second)?])
}

/// Fractions of the picture must leave something of it.
pub(crate) fn check_fractions<const N: usize>(
    fractions: [(&'static str, f64); N],
) -> Result<(), RenderError> {
    match fractions.iter().find(|(_, f)| !(0.0..=0.45).contains(f)) {
        Some((name, _)) => Err(RenderError::BadOption { name, requirement: "between 0 and 0.45" }),
        None => Ok(()),
    }
}

/// A ball on a vertex, as it falls on the screen.
struct Ball {
    centre: ScreenPoint,
    radius: f64,
    bulge: f64,
    color: [f32; 3],
}

/// What pictures from all sides share.
struct Model<'a> {
    scene: &'a Scene<'a>,
    options: &'a SurfaceOptions,
    raster: Raster,
    positions: Vec<Vec3>,
    /// Whether each vertex has a face.
    on_face: Vec<bool>,
    normals: Normals,
    coat: Coat<'a>,
    sky: Option<Sky>,
}

impl<'a> Model<'a> {
    fn new(scene: &'a Scene, options: &'a SurfaceOptions) -> Result<Self, RenderError> {
        scene.check()?;
        let raster = Raster::new(options.size, options.supersampling)?;
        if !(0.0..=1.0).contains(&options.occlusion) {
            return Err(RenderError::BadOption {
                name: "occlusion",
                requirement: "between 0 and 1",
            });
        }
        check_fractions([
            ("margin", options.margin),
            ("line_width", options.line_width),
            ("cone_radius", options.cone_radius),
        ])?;
        for (name, color) in options.palette.entries() {
            check_finite(name, &[color])?;
        }
        let mut on_face = vec![false; scene.positions.len()];
        scene.faces.iter().flatten().for_each(|&v| on_face[v as usize] = true);
        let used = scene.positions.iter().zip(&on_face).filter(|(_, used)| **used);
        let normalizer = Normalizer::fit(used.map(|(&p, _)| p))
            .ok_or(RenderError::NoExtent { what: "positions" })?;
        let place = |&p: &Vec3| options.up.turn(normalizer.apply(p));
        let positions: Vec<Vec3> = scene.positions.iter().map(place).collect();
        let coat = options.paint.prepare(scene, &positions)?;
        Ok(Self {
            normals: Normals::new(&positions, scene.faces, |corners| coat.goes_on(corners)),
            sky: (options.occlusion > 0.0).then(|| Sky::new(&positions, scene.faces)),
            scene,
            options,
            raster,
            positions,
            on_face,
            coat,
        })
    }

    fn draw(&self, view: View) -> Result<Image, RenderError> {
        Ok(self.raster.compose(&SurfacePicture::new(self, view)?))
    }
}

struct SurfacePicture<'a> {
    model: &'a Model<'a>,
    points: Vec<ScreenPoint>,
    camera: Camera,
    lights: Lights,
    openness: Option<Openness<'a>>,
    faces_by_band: ByBand,
    /// Edges where light, texture or the sight of the surface ends.
    ends: Vec<[u32; 2]>,
    ends_by_band: ByBand,
    lines: Vec<Line>,
    lines_by_band: ByBand,
    balls: Vec<Ball>,
    background: [f32; 3],
    seam: [f32; 3],
    feature: [f32; 3],
    released: [f32; 3],
}

impl<'a> SurfacePicture<'a> {
    fn new(model: &'a Model<'a>, view: View) -> Result<Self, RenderError> {
        let Model { scene, options, raster, positions, on_face, normals, .. } = model;
        let camera = Camera::fit(
            view,
            options.projection,
            (positions, scene.faces),
            positions.iter().zip(on_face).filter(|(_, used)| **used).map(|(&p, _)| p),
            raster.samples(),
            options.margin,
        )?;
        let points: Vec<ScreenPoint> = positions.iter().map(|&p| camera.project(p)).collect();
        let at = |v: u32| points[v as usize];
        let seen = |v: &u32| on_face[*v as usize];
        let half_width = 0.5 * options.line_width * raster.shorter_side();
        let lines = |list: &'a [[u32; 2]], id, half_width| {
            let seen = list.iter().filter(|s| s.iter().all(seen));
            seen.map(move |s| Line { ends: s.map(at), half_width, id })
                .filter(|l| l.half_width > 0.0)
        };
        let wide = FEATURE_WIDTH * half_width;
        let lines: Vec<Line> = lines(scene.features, FEATURE, wide)
            .chain(lines(scene.seams, SEAM, half_width))
            .chain(lines(scene.released, RELEASED, wide))
            .collect();
        let palette = &options.palette;
        let ball_radius = options.cone_radius * raster.shorter_side();
        let small = CORNER_RADIUS * ball_radius;
        let corners = scene.corners.iter().map(|&v| (v, small, palette.corner));
        let ends = scene.open_ends.iter().map(|&v| (v, small, palette.open_end));
        let cones = scene.cones.iter().map(|&(v, index)| (v, ball_radius, palette.cone(index)));
        let balls =
            corners.chain(ends).chain(cones).filter(|(v, radius, _)| seen(v) && *radius > 0.0);
        let balls = balls.map(|(vertex, radius, color)| {
            let centre = at(vertex);
            let bulge = camera.bulge(centre, radius);
            let depth = centre.depth + BALL_LIFT * bulge;
            Ball { centre: ScreenPoint { depth, ..centre }, radius, bulge, color: to_linear(color) }
        });
        let to_viewer = |face: &[u32; 3]| {
            let [a, b, c] = face.map(at);
            let area = signed_area([a, b, c].map(|p| [p.x, p.y]));
            area.partial_cmp(&0.0)
        };
        let to_viewer: Vec<_> = scene.faces.iter().map(to_viewer).collect();
        let silhouette = |edge: &&SmoothEdge| {
            let [a, b] = edge.faces.map(|face| to_viewer[face as usize]);
            a != b
        };
        let silhouettes = normals.smooth.iter().filter(silhouette).map(|edge| edge.ends);
        let ends: Vec<[u32; 2]> = normals.sharp.iter().copied().chain(silhouettes).collect();
        Ok(Self {
            model,
            ends_by_band: raster.by_band(ends.iter().map(|end| {
                let [a, b] = end.map(|v| at(v).y);
                (a.min(b) - 1.0, a.max(b) + 1.0)
            })),
            ends,
            lights: Lights::new(&camera),
            openness: model.sky.as_ref().map(Sky::openness),
            faces_by_band: raster
                .by_band(scene.faces.iter().map(|face| range(face.map(|v| at(v).y)))),
            lines_by_band: raster.by_band(lines.iter().map(Line::span)),
            lines,
            balls: balls.collect(),
            background: to_linear(palette.background),
            seam: to_linear(palette.seam),
            feature: to_linear(palette.feature),
            released: to_linear(palette.released),
            camera,
            points,
        })
    }

    fn corners(&self, face: usize) -> [ScreenPoint; 3] {
        self.model.scene.faces[face].map(|v| self.points[v as usize])
    }

    /// By how much a line may lie behind the face at a sample: the face is followed from the
    /// sample to the middle of the line, as far as that is plausible.
    fn slack(&self, id: u32, dx: f64, dy: f64) -> f64 {
        let Some(barycentric) = Some(id as usize)
            .filter(|&face| face < self.model.scene.faces.len())
            .and_then(|face| Barycentric::new(self.corners(face)))
        else {
            return LINE_SLACK;
        };
        let slope = barycentric.slope(self.corners(id as usize).map(|p| p.depth));
        LINE_SLACK + (slope[0] * dx + slope[1] * dy).clamp(0.0, GRAZING_SLACK)
    }

    fn shade_ball(&self, ball: &Ball, [x, y]: [f64; 2]) -> [f32; 3] {
        let right = (x - ball.centre.x) / ball.radius;
        let up = (ball.centre.y - y) / ball.radius;
        let back = (1.0 - right * right - up * up).max(0.0).sqrt();
        let camera = &self.camera;
        let sideways = add(scale(camera.right, right), scale(camera.up, up));
        let normal = add(sideways, scale(camera.back, back));
        // A dark rim parts the ball from a busy ground.
        let rim = (0.35 + 1.3 * back).min(1.0) as f32;
        let light = self.lights.on(normal) * rim;
        let glint = self.lights.glint(normal);
        ball.color.map(|c| c * light + glint)
    }
}

/// A face ready to be shaded.
struct Shader<'a> {
    face: usize,
    barycentric: Barycentric,
    positions: [Vec3; 3],
    normals: [Vec3; 3],
    coat: FaceCoat<'a>,
}

impl Shader<'_> {
    fn normal(&self, weights: [f64; 3]) -> Vec3 {
        let sum = blend(weights, &self.normals);
        let square = dot(sum, sum);
        if square > 1e-12 { scale(sum, 1.0 / square.sqrt()) } else { self.normals[0] }
    }

    fn color(&self, picture: &SurfacePicture, Patch { at: [x, y], side }: Patch) -> [f32; 3] {
        let weights = self.barycentric.at(x, y);
        let mut light = picture.lights.on(self.normal(weights.value));
        if let Some(openness) = &picture.openness {
            let open = openness.at(self.face, weights.value, |weights| {
                (blend(weights, &self.positions), self.normal(weights))
            });
            light *= (1.0 - picture.model.options.occlusion * (1.0 - open * open)) as f32;
        }
        self.coat.color(&weights, side).map(|c| c * light)
    }
}

impl Painter for SurfacePicture<'_> {
    fn mark(&self, index: usize, marks: &mut Marks) {
        for &end in self.ends_by_band.of(index) {
            marks.line(self.ends[end as usize].map(|v| self.points[v as usize]), 0.0);
        }
        for &line in self.lines_by_band.of(index) {
            let line = &self.lines[line as usize];
            marks.line(line.ends, line.half_width);
        }
        self.balls.iter().for_each(|ball| marks.ball(ball.centre, ball.radius));
    }

    fn draw(&self, index: usize, band: &mut Band) {
        for &face in self.faces_by_band.of(index) {
            band.fill_triangle(self.corners(face as usize), face);
        }
        for &line in self.lines_by_band.of(index) {
            let line = &self.lines[line as usize];
            band.draw_line(line.ends, line.half_width, line.id, |below, dx, dy| {
                self.slack(below, dx, dy)
            });
        }
        for (index, ball) in self.balls.iter().enumerate() {
            band.draw_ball(ball.centre, ball.radius, ball.bulge, FIRST_OVERLAY + index as u32);
        }
    }

    fn shader(&self) -> impl FnMut(u32, Patch) -> [f32; 3] {
        let mut current = EMPTY;
        let mut shader = None;
        move |id, patch| match id {
            EMPTY => self.background,
            SEAM => self.seam,
            FEATURE => self.feature,
            RELEASED => self.released,
            ball if ball >= FIRST_OVERLAY => {
                self.shade_ball(&self.balls[(ball - FIRST_OVERLAY) as usize], patch.at)
            }
            face => {
                if face != current {
                    current = face;
                    shader = self.on_face(face as usize);
                }
                shader.as_ref().map_or(self.background, |s: &Shader| s.color(self, patch))
            }
        }
    }
}

impl SurfacePicture<'_> {
    fn on_face(&self, face: usize) -> Option<Shader<'_>> {
        let Model { scene, positions, normals, coat, .. } = self.model;
        let corners = self.corners(face);
        // Faces seen from behind are lit as if they were turned around.
        let turn = if signed_area(corners.map(|p| [p.x, p.y])) > 0.0 { -1.0 } else { 1.0 };
        Some(Shader {
            face,
            barycentric: Barycentric::new(corners)?,
            positions: scene.faces[face].map(|v| positions[v as usize]),
            normals: normals.at_corners[face].map(|n| n.map(|x| turn * f64::from(x))),
            coat: coat.on_face(face),
        })
    }
}
