//! Results as pages: one file with a viewer, which opens in any browser, also without a network.

mod check;
mod facts;
mod scene;
#[cfg(feature = "io")]
mod task;
mod walk;

#[doc(hidden)]
pub use facts::{Explained, PageFacts};
#[cfg(feature = "io")]
#[doc(hidden)]
pub use task::{Done, Task, refusal};

use crate::error::{Error, ErrorKind, Stage};
use crate::map::SeamlessMap;
use crate::quads::QuadMesh;
use crate::report::VERSION;
use crate::surface::Surface;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use facts::{Facts, Places};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use scene::{Drawing, Scene};
use seamstress_parametrize::quality::{Measure, SingularValues, summarize};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;

/// The viewer, bundled from `web/`.
const VIEWER: &str = include_str!("assets/report.js");
const STYLE: &str = include_str!("assets/style.css");

/// A result to look at: its surface, what was checked of it, its numbers, its warnings, its options.
#[derive(Debug, Clone)]
pub struct Page {
    facts: Facts,
    report: Value,
    command: Option<String>,
    scene: Scene,
}

impl Page {
    fn new(facts: Facts, report: &impl Serialize, drawing: &Drawing) -> Self {
        let report = serde_json::to_value(report).unwrap_or_default();
        Self { facts, report, command: None, scene: Scene::new(drawing) }
    }

    /// The page of a run of a command, with its own report and how to repeat it.
    #[doc(hidden)]
    pub fn of_run(self, report: Value, command: Option<String>) -> Self {
        Self { report, command, ..self }
    }

    /// What the page says, as JSON.
    #[doc(hidden)]
    pub fn facts(&self) -> String {
        serde_json::json!({ "facts": self.facts, "report": self.report, "command": self.command })
            .to_string()
    }

    /// What the page draws, packed.
    #[doc(hidden)]
    pub fn scene(&self) -> &[u8] {
        self.scene.bytes()
    }

    /// The page as one HTML file that needs nothing else.
    pub fn html(&self) -> String {
        let [facts, scene] = [self.facts().as_bytes(), self.scene()].map(packed);
        html(&self.title(), &[[&facts, &scene]])
    }

    fn title(&self) -> String {
        format!("{}: {}", self.facts.name, self.facts.kind.to_lowercase())
    }

    /// Pages that were written before, side by side in one.
    ///
    /// # Errors
    /// [`ErrorKind::Unreadable`] where one is no such page.
    #[doc(hidden)]
    pub fn side_by_side(files: &[impl AsRef<Path>]) -> Result<String, Error> {
        let read = |path: &Path| {
            let error = |text: String| {
                Error::new(ErrorKind::Unreadable, format!("{}: {text}", path.display()))
                    .at_stage(Some(Stage::Files))
            };
            let text = fs::read_to_string(path).map_err(|cause| error(cause.to_string()))?;
            let pages = embedded(&text);
            if pages.is_empty() {
                return Err(error("not a report page; `--report FILE.html` writes one".into()));
            }
            Ok(pages.into_iter().map(|page| page.map(str::to_owned)).collect::<Vec<_>>())
        };
        let pages =
            files.iter().map(|file| read(file.as_ref())).collect::<Result<Vec<_>, Error>>()?;
        let pages: Vec<[&str; 2]> =
            pages.iter().flatten().map(|page| page.each_ref().map(String::as_str)).collect();
        Ok(html("Comparison", &pages))
    }
}

const FACTS: &str = "facts";
const SCENE: &str = "scene";
const CLOSING: &str = "</script>";

fn opening(class: &str) -> String {
    format!("<script type=\"text/plain\" class=\"{class}\">")
}

/// The results in a page.
fn embedded(html: &str) -> Vec<[&str; 2]> {
    let parts = |class| {
        let rest = html.split(&opening(class)).skip(1).collect::<Vec<_>>().into_iter();
        // Nothing else than what can stand in a page as it is.
        rest.filter_map(|rest| Some(rest.split_once(CLOSING)?.0)).filter(|text| is_packed(text))
    };
    parts(FACTS).zip(parts(SCENE)).map(|(facts, scene)| [facts, scene]).collect()
}

fn is_packed(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"+/=".contains(&byte))
}

/// Bytes compressed, as text.
fn packed(bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    // Writing to memory does not fail.
    let compressed = encoder.write_all(bytes).and_then(|()| encoder.finish());
    STANDARD.encode(compressed.unwrap_or_default())
}

/// Unpacks the viewer and starts it.
const START: &str = "\
const text = document.getElementById('viewer').textContent;
const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
new Response(stream).text().then((code) => import(URL.createObjectURL(new Blob([code], { type: 'text/javascript' }))));";

/// Nothing is loaded from anywhere.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' blob:; style-src 'unsafe-inline'; img-src data: blob:";

fn html(title: &str, pages: &[[&str; 2]]) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;");
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <meta name=\"generator\" content=\"Seamstress {VERSION}\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n<body>\n\
         <noscript>This page draws with JavaScript, which is switched off.</noscript>\n"
    );
    for [facts, scene] in pages {
        html +=
            &format!("{}{facts}{CLOSING}\n{}{scene}{CLOSING}\n", opening(FACTS), opening(SCENE));
    }
    let viewer = packed(VIEWER.as_bytes());
    html += &format!(
        "<script type=\"text/plain\" id=\"viewer\">{viewer}</script>\n<script type=\"module\">{START}</script>\n</body>\n"
    );
    html
}

/// The name of a file without its folder.
fn name_of(path: Option<&str>) -> String {
    let name = path.map(Path::new).map(|path| path.file_name().unwrap_or(path.as_os_str()));
    name.map_or_else(|| "mesh".into(), |name| name.display().to_string())
}

impl Surface {
    /// Where elements of the input are on the surface.
    fn places(&self) -> Places {
        let vertices = 0..self.positions().len() as u32;
        // Of several copies the first.
        let mut places = Places::default();
        for (vertex, given) in vertices.filter_map(|v| Some((v, self.input_vertex(v)?))) {
            places.vertices.entry(given).or_insert(vertex);
        }
        let faces = 0..self.faces().len() as u32;
        for (face, given) in faces.filter_map(|face| Some((face, self.input_face(face)?))) {
            places.faces.entry(given).or_insert(face);
        }
        places
    }

    /// Tau of every triangle, infinite where it is flipped.
    fn tau(&self, corner_uvs: &[[f64; 2]]) -> Vec<f64> {
        let singular = SingularValues::new(self.mesh(), self.metric(), corner_uvs);
        summarize(Measure::Tau, &singular).values.0
    }
}

/// The facts that a report has of a result.
fn explained(report: &impl Explained, input: Option<&str>, places: Places) -> Facts {
    let facts = Facts { name: name_of(input), version: VERSION, ..Facts::default() };
    let mut page = PageFacts { facts, places };
    report.explain(&mut page);
    page.facts
}

impl<R: Explained + Serialize> SeamlessMap<R> {
    /// A page to look at it.
    pub fn page(&self) -> Page {
        let surface = self.surface();
        let facts = explained(self.report(), surface.input(), surface.places());
        let drawing = Drawing {
            positions: surface.positions(),
            corners: surface.faces().as_flattened(),
            sides: 3,
            corner_uvs: Some(self.corner_uvs()),
            values: &surface.tau(&self.unscaled_uvs()),
            features: self.aligned_edges(),
        };
        Page::new(facts, self.report(), &drawing)
    }
}

impl QuadMesh {
    /// A page to look at it.
    pub fn page(&self) -> Page {
        let surface = self.surface();
        // Faces of the surface are not drawn.
        let places = Places { faces: BTreeMap::new(), ..surface.places() };
        let mut facts = explained(self.report(), surface.input(), places);
        let kept = self.kept_features();
        // Vertices of the surface that are named are drawn after those of the quads.
        let mut positions = self.positions().to_vec();
        let mut drawn = BTreeMap::new();
        let mut draw = |vertex: &mut u32| {
            *vertex = *drawn.entry(*vertex).or_insert_with(|| {
                positions.push(surface.positions()[*vertex as usize]);
                (positions.len() - 1) as u32
            });
        };
        let mut features = kept;
        features.as_flattened_mut().iter_mut().for_each(&mut draw);
        facts.dropped.iter_mut().flat_map(|dropped| &mut dropped.vertices).for_each(&mut draw);
        facts.notes.iter_mut().flat_map(|note| &mut note.vertices).for_each(&mut draw);
        let drawing = Drawing {
            positions: &positions,
            corners: self.quads().as_flattened(),
            sides: 4,
            features: &features,
            ..Drawing::default()
        };
        Page::new(facts, self.report(), &drawing)
    }

    /// Features that the quads follow, by vertices of the surface.
    fn kept_features(&self) -> Vec<[u32; 2]> {
        let Some(features) = &self.report().features else { return Vec::new() };
        let ordered = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let dropped = features.dropped.iter().flatten().map(|feature| ordered(feature.vertices));
        let dropped: std::collections::BTreeSet<[u32; 2]> = dropped.collect();
        let edges = features.curves.iter().flat_map(|curve| {
            let closing =
                [curve.vertices.last(), curve.vertices.first()].map(Option::<&u32>::copied);
            let closing = match (curve.is_loop, closing) {
                (true, [Some(last), Some(first)]) if last != first => Some([last, first]),
                _ => None,
            };
            curve.vertices.windows(2).map(|pair| [pair[0], pair[1]]).chain(closing)
        });
        edges.filter(|&edge| !dropped.contains(&ordered(edge))).collect()
    }
}

#[cfg(test)]
mod tests;
