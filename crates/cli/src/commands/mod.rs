//! The commands, each with its arguments, its calls of the library and its words.

#[cfg(feature = "app")]
mod app;
mod check;
mod extract;
mod features;
mod field;
mod integer;
mod layout_quads;
mod manual;
mod map;
mod matchings;
mod measure;
mod optimize;
mod quad;
mod quad_files;
mod quality;
mod report;

#[cfg(feature = "app")]
pub(crate) use app::AppArgs;
#[cfg(all(feature = "app", fuzzing))]
pub use app::serve_forever;
pub(crate) use check::CheckArgs;
pub(crate) use extract::ExtractArgs;
pub(crate) use features::FeaturesArgs;
pub(crate) use field::FieldArgs;
pub(crate) use integer::IntegerArgs;
pub(crate) use layout_quads::LayoutQuadsArgs;
pub(crate) use manual::{CompletionsArgs, ManArgs};
pub(crate) use map::MapArgs;
pub(crate) use matchings::MatchingsArgs;
pub(crate) use measure::MeasureArgs;
pub(crate) use optimize::OptimizeArgs;
pub(crate) use quad::QuadArgs;
pub(crate) use quality::QualityArgs;
pub(crate) use report::ReportArgs;

use crate::output::{Kind, Target};
use seamstress::{Error, MapPictures, Measure};
use std::path::{Path, PathBuf};

/// The files of [`MapPictures`].
const MAP_PICTURES: [&str; 3] = ["front.png", "back.png", "layout.png"];

/// The pictures of a map in a folder.
fn map_pictures(folder: Option<&PathBuf>) -> Vec<Target> {
    let picture = |folder: &PathBuf| {
        MAP_PICTURES.map(|name| Target::new(Kind::Picture, &folder.join(name))).to_vec()
    };
    folder.map(picture).unwrap_or_default()
}

/// Draws the pictures of a map, if a folder is given for them.
fn draw_map(
    folder: Option<&PathBuf>,
    draw: impl FnOnce() -> Result<MapPictures, Error>,
) -> Result<Vec<Vec<u8>>, Error> {
    let Some(_) = folder else { return Ok(Vec::new()) };
    let pictures = draw()?;
    Ok(vec![pictures.front, pictures.back, pictures.layout])
}

/// Files of one kind.
fn targets<'a>(kind: Kind, paths: impl IntoIterator<Item = &'a PathBuf>) -> Vec<Target> {
    paths.into_iter().map(|path| Target::new(kind, path)).collect()
}

/// Reports: pages where the name says HTML, JSON else.
fn reports<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Vec<Target> {
    let is_page = |path: &Path| {
        path.extension().is_some_and(|ending| {
            ["html", "htm"].iter().any(|known| ending.eq_ignore_ascii_case(known))
        })
    };
    let kind = |path: &Path| if is_page(path) { Kind::Page } else { Kind::Report };
    paths.into_iter().map(|path| Target::new(kind(path), path)).collect()
}

/// The inputs of a run.
fn inputs<'a>(first: &'a Path, others: impl IntoIterator<Item = &'a Path>) -> Vec<&'a Path> {
    std::iter::once(first).chain(others).collect()
}

/// The measure of a name that the parser has let pass.
fn measure_named(name: &str) -> Measure {
    let named = Measure::ALL.into_iter().find(|measure| measure.name() == name);
    named.unwrap_or(Measure::Tau)
}
