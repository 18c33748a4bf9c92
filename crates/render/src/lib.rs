//! Headless pictures of meshes and maps for Seamstress.
//!
//! Two pictures of one [`Scene`]: [`render_surface`] shows the mesh in space, shaded and textured
//! through its UVs; [`render_layout`] shows the UVs in the plane. Both are drawn in software by a
//! z-buffer, with several samples, averaged in linear light, in pixels that an outline, a crease, a line
//! or a dot crosses, and one in all others. They depend on nothing but their arguments: the
//! same scene gives the same bytes on any number of threads.

mod band;
mod camera;
mod canvas;
mod checker;
mod error;
mod font;
mod frame;
mod heat;
mod image;
mod interpolate;
mod layout;
mod lighting;
mod normalize;
mod normals;
mod occlusion;
mod paint;
mod palette;
mod raster;
mod scene;
mod surface;
mod topology;
mod vec3;

pub use camera::{Projection, Up, View};
pub use error::RenderError;
pub use heat::HeatMap;
pub use image::Image;
pub use layout::{LayoutOptions, render_layout};
pub use paint::Paint;
pub use palette::Palette;
pub use scene::Scene;
pub use surface::{SurfaceOptions, render_both, render_surface};
