//! What a page asks for: a file and options in, a result with its page and its files out. Pages in a browser and pages
//! of the command do the same tasks.

use super::Page;
use crate::context::Context;
use crate::error::{Error, ErrorKind};
use crate::feature_sources::{FeatureSource, Features};
use crate::files::Output;
use crate::inspection::Inspection;
use crate::integer::IntegerGridMap;
use crate::map::{SeamlessMap, UvSet};
use crate::options::{IntegerMapOptions, MapOptions, QuadOptions};
use crate::quads::QuadMesh;
use crate::surface::Surface;
use crate::surface_options::SurfaceOptions;
use serde::Deserialize;
use std::path::Path;

/// Something to make of a mesh.
#[doc(hidden)]
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    #[serde(default)]
    surface: SurfaceOptions,
    /// For a preview: made of a coarser mesh, of about so many triangles.
    coarse: Option<usize>,
    make: Make,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Make {
    /// What is wrong with the mesh, and the features of these sources.
    Check(Features),
    Map(MapOptions),
    Integer(IntegerMapOptions),
    Quads(QuadOptions),
}

/// The result of a task.
#[doc(hidden)]
#[derive(Debug)]
pub struct Done {
    page: Page,
    made: Made,
}

#[derive(Debug)]
enum Made {
    Checked,
    Map(SeamlessMap),
    Integer(IntegerGridMap),
    Quads(QuadMesh),
}

impl Task {
    /// Reads a task from JSON. It cannot name files.
    ///
    /// # Errors
    /// [`ErrorKind::Options`].
    pub fn parse(json: &str) -> Result<Self, Error> {
        let task: Self =
            serde_json::from_str(json).map_err(|error| Error::options(error.to_string()))?;
        let has_files = match (task.map_options(), task.features()) {
            (Some(options), _) => options.files().next().is_some(),
            (None, features) => features.sources().iter().any(|source| source.file().is_some()),
        };
        match has_files {
            true => {
                Err(Error::options("features, directions and sizes cannot come from a file here"))
            }
            false => Ok(task),
        }
    }

    fn map_options(&self) -> Option<&MapOptions> {
        match &self.make {
            Make::Check(_) => None,
            Make::Map(options) => Some(options),
            Make::Integer(options) => Some(&options.map),
            Make::Quads(options) => Some(&options.map),
        }
    }

    fn features(&self) -> &Features {
        match &self.make {
            Make::Check(features) => features,
            Make::Map(options) => &options.features,
            Make::Integer(options) => &options.map.features,
            Make::Quads(options) => &options.map.features,
        }
    }

    /// The surface to make something of.
    fn surface(&self, inspection: Inspection, context: Context) -> Result<Surface, Error> {
        let surface = inspection.surface()?.with_context(context);
        let Some(n_faces) = self.coarse else { return Ok(surface) };
        // Edges that are named by their ends stay.
        let named = self.features().sources().iter().filter_map(|source| match source {
            FeatureSource::Edges(edges) => Some(edges.as_flattened()),
            _ => None,
        });
        let places = surface.places();
        let kept: Vec<u32> =
            named.flatten().filter_map(|vertex| places.vertices.get(vertex).copied()).collect();
        surface.coarse(n_faces, &kept)
    }

    /// Does it with the content of a file of some name.
    ///
    /// # Errors
    /// Those of reading, and of what is made.
    pub fn run(&self, content: &[u8], name: &str, context: Context) -> Result<Done, Error> {
        let inspection = Inspection::of_file_content(content, name, &self.surface)?;
        let make_surface = |inspection| self.surface(inspection, context);
        let (page, made) = match &self.make {
            Make::Check(features) => {
                let curves = match inspection.is_surface() && !features.is_none() {
                    true => Some(make_surface(inspection.clone())?.features(features)?),
                    false => None,
                };
                (Page::of_mesh(&inspection, curves.as_ref()), Made::Checked)
            }
            Make::Map(options) => {
                let map = make_surface(inspection)?.parametrize(options)?;
                (map.page(), Made::Map(map))
            }
            Make::Integer(options) => {
                let map = make_surface(inspection)?.integer_map(options)?;
                (map.page(), Made::Integer(map))
            }
            Make::Quads(options) => {
                let quads = make_surface(inspection)?.quad_mesh(options)?;
                (quads.page(), Made::Quads(quads))
            }
        };
        Ok(Done { page, made })
    }
}

/// An error as pages show it, as JSON.
#[doc(hidden)]
pub fn refusal(error: &Error) -> String {
    let json = serde_json::json!({
        "code": error.code(),
        "message": error.to_string(),
        "hint": error.hint(),
    });
    json.to_string()
}

impl Done {
    /// The page of the result.
    pub fn page(&self) -> &Page {
        &self.page
    }

    /// The result as a file: a page, its report as JSON, maps and quads in the format of the name.
    ///
    /// # Errors
    /// [`ErrorKind::Unwritable`] if there is no such file of it.
    pub fn file(&self, name: &str) -> Result<Vec<u8>, Error> {
        if name.ends_with(".html") {
            return Ok(self.page.html().into_bytes());
        }
        if name.ends_with(".json") {
            return Ok(format!("{:#}\n", self.page.report).into_bytes());
        }
        let path = Path::new(name);
        let mut file = Vec::new();
        let written = match &self.made {
            Made::Map(map) => {
                Output::Map.check_name(path)?;
                map.write_as(path, UvSet::First, &mut file)
            }
            Made::Integer(map) => {
                Output::Map.check_name(path)?;
                map.write_as(path, UvSet::First, &mut file)
            }
            Made::Quads(quads) => {
                Output::Quads.check_name(path)?;
                quads.write_as(path, &mut file)
            }
            Made::Checked => {
                let text = format!("{name}: the result has no file of this kind");
                return Err(Error::new(ErrorKind::Unwritable, text));
            }
        };
        let failed = |cause: std::io::Error| Error::new(ErrorKind::Unwritable, cause.to_string());
        written.map_err(failed).map(|()| file)
    }
}
