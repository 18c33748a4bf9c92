//! The picture of a surface in space.

use crate::camera::{Camera, Projection, View};
use crate::frame::{Painter, Raster};
use crate::image::to_linear;
use crate::interpolate::{Barycentric, blend};
use crate::lighting::Lights;
use crate::normalize::Normalizer;
use crate::normals::corner_normals;
use crate::occlusion::Occlusion;
use crate::paint::{Coat, FaceCoat, Paint};
use crate::palette::Palette;
use crate::raster::{Band, EMPTY, ScreenPoint, range};
use crate::scene::{Scene, check_finite};
use crate::vec3::{Vec3, add, scale, unit};
use crate::{Image, RenderError};

/// How a surface is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceOptions {
    /// Width and height in pixels, at most 8192 each.
    pub size: [u32; 2],
    /// Where the viewer stands.
    pub view: View,
    /// Perspective or not.
    pub projection: Projection,
    /// The colour of the surface.
    pub paint: Paint,
    /// Samples along each side of a pixel, between 1 and 8.
    pub supersampling: u32,
    /// Free space on each side, as a fraction of the picture.
    pub margin: f64,
    /// Width of seams and features, as a fraction of the picture's shorter side.
    pub line_width: f64,
    /// How much hollows darken, between 0 (not at all) and 1.
    pub occlusion: f64,
    /// Radius of the balls on cones, as a fraction of the picture's shorter side.
    pub cone_radius: f64,
    /// The other colours.
    pub palette: Palette,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        Self {
            size: [1200, 1200],
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

/// Ids of samples that show something other than a face.
const SEAM: u32 = EMPTY - 1;
const FEATURE: u32 = EMPTY - 2;
const FIRST_CONE: u32 = 1 << 31;

/// Draws the surface of a scene.
///
/// # Errors
/// If the scene is empty or inconsistent, if an option is out of range, or if the paint needs
/// UVs and the scene has none.
pub fn render_surface(scene: &Scene, options: &SurfaceOptions) -> Result<Image, RenderError> {
    scene.check()?;
    let raster = Raster::new(options.size, options.supersampling)?;
    if !(0.0..=1.0).contains(&options.occlusion) {
        return Err(RenderError::BadOption { name: "occlusion", requirement: "between 0 and 1" });
    }
    check_fractions([
        ("margin", options.margin),
        ("line_width", options.line_width),
        ("cone_radius", options.cone_radius),
    ])?;
    for (name, color) in options.palette.entries() {
        check_finite(name, &[color])?;
    }
    let picture = SurfacePicture::new(scene, options, raster)?;
    Ok(raster.compose(&picture))
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

/// A ball on a cone, as it falls on the screen.
struct Ball {
    centre: ScreenPoint,
    bulge: f64,
    color: [f32; 3],
}

struct SurfacePicture<'a> {
    faces: &'a [[u32; 3]],
    points: Vec<ScreenPoint>,
    /// First and last row of samples each face may touch.
    spans: Vec<[f32; 2]>,
    normals: Vec<[[f32; 3]; 3]>,
    coat: Coat<'a>,
    camera: Camera,
    lights: Lights,
    occlusion: Option<(Occlusion, f64)>,
    /// Samples along the side of a pixel.
    per_pixel: usize,
    positions: Vec<Vec3>,
    lines: Vec<([ScreenPoint; 2], u32)>,
    half_width: f64,
    balls: Vec<Ball>,
    ball_radius: f64,
    background: [f32; 3],
    seam: [f32; 3],
    feature: [f32; 3],
}

impl<'a> SurfacePicture<'a> {
    fn new(
        scene: &Scene<'a>,
        options: &SurfaceOptions,
        raster: Raster,
    ) -> Result<Self, RenderError> {
        let used = scene.faces.iter().flatten();
        let normalizer = Normalizer::fit(used.map(|&v| scene.positions[v as usize]))
            .ok_or(RenderError::NoExtent { what: "positions" })?;
        let positions: Vec<Vec3> = scene.positions.iter().map(|&p| normalizer.apply(p)).collect();
        let camera = Camera::fit(
            options.view,
            options.projection,
            &positions,
            scene.faces,
            raster.samples(),
            options.margin,
        )?;
        let points: Vec<ScreenPoint> = positions.iter().map(|&p| camera.project(p)).collect();
        let at = |v: u32| points[v as usize];
        let mut on_face = vec![false; positions.len()];
        scene.faces.iter().flatten().for_each(|&v| on_face[v as usize] = true);
        let seen = |v: &u32| on_face[*v as usize];
        let spans = scene.faces.iter().map(|f| {
            let (low, high) = range(f.map(|v| at(v).y));
            [(low - 1.0) as f32, (high + 1.0) as f32]
        });
        let features =
            scene.features.iter().filter(|s| s.iter().all(seen)).map(|s| (s.map(at), FEATURE));
        let seams = scene.seams.iter().filter(|s| s.iter().all(seen)).map(|s| (s.map(at), SEAM));
        let ball_radius = options.cone_radius * raster.shorter_side();
        let cones = scene.cones.iter().filter(|c| seen(&c.0));
        let balls = cones.map(|&(vertex, index)| {
            let centre = at(vertex);
            let bulge = camera.bulge(centre, ball_radius);
            let depth = centre.depth + BALL_LIFT * bulge;
            Ball {
                centre: ScreenPoint { depth, ..centre },
                bulge,
                color: to_linear(options.palette.cone(index)),
            }
        });
        Ok(Self {
            faces: scene.faces,
            spans: spans.collect(),
            normals: corner_normals(&positions, scene.faces),
            coat: options.paint.prepare(scene, &positions)?,
            lights: Lights::new(&camera),
            lines: features.chain(seams).collect(),
            half_width: 0.5 * options.line_width * raster.shorter_side(),
            balls: balls.collect(),
            ball_radius,
            background: to_linear(options.palette.background),
            seam: to_linear(options.palette.seam),
            feature: to_linear(options.palette.feature),
            occlusion: (options.occlusion > 0.0)
                .then(|| (Occlusion::new(&positions, scene.faces), options.occlusion)),
            per_pixel: raster.per_pixel() as usize,
            camera,
            points,
            positions,
        })
    }

    fn corners(&self, face: usize) -> [ScreenPoint; 3] {
        self.faces[face].map(|v| self.points[v as usize])
    }

    /// By how much a line may lie behind the face at a sample: the face is followed from the
    /// sample to the middle of the line, as far as that is plausible.
    fn slack(&self, id: u32, dx: f64, dy: f64) -> f64 {
        let Some(barycentric) = Some(id as usize)
            .filter(|&face| face < self.faces.len())
            .and_then(|face| Barycentric::new(self.corners(face)))
        else {
            return LINE_SLACK;
        };
        let slope = barycentric.slope(self.corners(id as usize).map(|p| p.depth));
        LINE_SLACK + (slope[0] * dx + slope[1] * dy).clamp(0.0, GRAZING_SLACK)
    }

    fn shade_ball(&self, ball: &Ball, x: f64, y: f64) -> [f32; 3] {
        let right = (x - ball.centre.x) / self.ball_radius;
        let up = (ball.centre.y - y) / self.ball_radius;
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

/// A face ready to be shaded along a run of samples.
struct Shader<'a> {
    barycentric: Option<Barycentric>,
    positions: [Vec3; 3],
    normals: [[f64; 3]; 3],
    coat: FaceCoat<'a>,
}

impl Shader<'_> {
    /// The colour at `(x, y)`; `turn` tells the samples of a pixel apart.
    fn color(&self, picture: &SurfacePicture, [x, y]: [f64; 2], turn: usize) -> Option<[f32; 3]> {
        let weights = self.barycentric?.at(x, y);
        let normal = unit(blend(weights.value, &self.normals)).unwrap_or(self.normals[0]);
        let mut light = picture.lights.on(normal);
        if let Some((occlusion, strength)) = &picture.occlusion {
            let at = blend(weights.value, &self.positions);
            let turns = picture.per_pixel * picture.per_pixel;
            let open = occlusion.openness(at, normal, turn, turns);
            light *= (1.0 - strength * (1.0 - open * open)) as f32;
        }
        Some(self.coat.color(&weights).map(|c| c * light))
    }
}

impl Painter for SurfacePicture<'_> {
    fn draw(&self, band: &mut Band) {
        for (face, &[low, high]) in self.spans.iter().enumerate() {
            if band.meets(f64::from(low), f64::from(high)) {
                band.fill_triangle(self.corners(face), face as u32);
            }
        }
        if self.half_width > 0.0 {
            for &(ends, id) in &self.lines {
                band.draw_line(ends, self.half_width, id, |below, dx, dy| {
                    self.slack(below, dx, dy)
                });
            }
        }
        if self.ball_radius > 0.0 {
            for (index, ball) in self.balls.iter().enumerate() {
                let id = FIRST_CONE + index as u32;
                band.draw_ball(ball.centre, self.ball_radius, ball.bulge, id);
            }
        }
    }

    fn shade(&self, band: &Band, row: usize, colors: &mut [[f32; 3]]) {
        let y = band.centre(row);
        let mut current = EMPTY;
        let mut shader = None;
        for (column, (&id, color)) in band.ids(row).iter().zip(colors).enumerate() {
            let x = column as f64 + 0.5;
            *color = match id {
                EMPTY => self.background,
                SEAM => self.seam,
                FEATURE => self.feature,
                cone if cone >= FIRST_CONE => {
                    self.shade_ball(&self.balls[(cone - FIRST_CONE) as usize], x, y)
                }
                face => {
                    if face != current {
                        current = face;
                        shader = Some(self.shader(face as usize));
                    }
                    let turn = (row % self.per_pixel) * self.per_pixel + column % self.per_pixel;
                    let seen = shader.as_ref().and_then(|s| s.color(self, [x, y], turn));
                    seen.unwrap_or(self.background)
                }
            };
        }
    }
}

impl SurfacePicture<'_> {
    /// Faces seen from behind are lit as if they were turned around.
    fn shader(&self, face: usize) -> Shader<'_> {
        let [a, b, c] = self.corners(face);
        let clockwise = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
        let turn = if clockwise { -1.0 } else { 1.0 };
        Shader {
            barycentric: Barycentric::new([a, b, c]),
            positions: self.faces[face].map(|v| self.positions[v as usize]),
            normals: self.normals[face].map(|n| n.map(|x| turn * f64::from(x))),
            coat: self.coat.on_face(face),
        }
    }
}
