//! Reads a collection of meshes, good and bad, if it is there, and compares with its table.
//!
//! Its `MESHES.md` lists `#V` and `#F` of every file; its folder `bad` holds odd and broken files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use seamstress_io::{Format, ReadError, ReadErrorKind, read_mesh};
use seamstress_testkit::in_collection;

fn folder() -> Option<PathBuf> {
    in_collection("MESHES.md").and_then(|table| table.parent().map(Path::to_owned))
}

/// The counts of vertices and faces in the table, by path from the folder; `None` where it has no number.
fn table(folder: &Path) -> BTreeMap<PathBuf, Option<(usize, usize)>> {
    let text = fs::read_to_string(folder.join("MESHES.md")).unwrap();
    let number =
        |cell: &str| cell.split_whitespace().next()?.replace(',', "").parse::<usize>().ok();
    let mut rows = BTreeMap::new();
    // The column of `#V` in the current table.
    let mut column = None;
    for line in text.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        if cells.get(1) == Some(&"file") {
            column = cells.iter().position(|&cell| cell == "#V");
        } else if let (Some(column), Some(name)) =
            (column, cells.get(1).and_then(|cell| cell.strip_prefix('`')))
        {
            let name = Path::new(name.trim_end_matches('`'));
            let path = if folder.join(name).is_file() {
                name.to_owned()
            } else {
                Path::new("bad").join(name)
            };
            rows.insert(path, number(cells[column]).zip(number(cells[column + 1])));
        }
    }
    rows
}

fn count(path: &Path) -> Result<(usize, usize), ReadError> {
    let start = Instant::now();
    let mesh = read_mesh(path);
    // Time and memory linear in the file, whatever its header announces: no file here takes a second.
    assert!(start.elapsed() < Duration::from_secs(60), "{} is slow", path.display());
    mesh.map(|mesh| (mesh.positions.len(), mesh.polygons.len()))
}

#[test]
fn good_meshes_have_the_stated_size() {
    let Some(folder) = folder() else { return };
    let mut read = 0;
    for (path, expected) in table(&folder).into_iter().filter(|(path, _)| !path.starts_with("bad"))
    {
        let found = count(&folder.join(&path)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(Some(found), expected, "{}", path.display());
        read += 1;
    }
    assert!(read >= 40, "only {read} meshes");
}

/// Where a broken file is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
enum At {
    File,
    Line(usize),
    Byte(usize),
}
use At::{Byte, File, Line};

/// The files to be refused: the fault, its place, and what the message must contain.
const REFUSED: [(&str, &str, At, &str); 43] = [
    ("binary_garbage.obj", "syntax", Byte(192), "NUL"),
    ("binary_truncated.ply", "truncated", Byte(3130), "192 `face` elements, found 138"),
    ("comma_decimals.obj", "syntax", Line(8), "`1,5` (write decimals with a point)"),
    ("corrupted_invalid_double.obj", "syntax", Line(6), "`XXX0.5854098561465024`"),
    ("corrupted_invalid_face_count.ply", "truncated", Byte(2160), "22 `face` elements, found 20"),
    ("corrupted_invalid_facet_vertex.obj", "range", Line(20), "index 8"),
    ("corrupted_invalid_facet_vertex_count.off", "range", Line(15), "index 100"),
    ("corrupted_invalid_int.obj", "syntax", Line(15), "`XXX2/1`"),
    ("corrupted_invalid_triangle_count.stl", "truncated", Byte(1084), "22 facets, found 20"),
    ("corrupted_invalid_vertex_count.off", "syntax", Line(13), "`0.309017`"),
    ("corrupted_invalid_vertex_count.ply", "corners", Byte(1954), "found 0"),
    ("empty.obj", "empty", File, "is empty"),
    ("empty.off", "empty", File, "is empty"),
    ("empty.ply", "empty", File, "is empty"),
    ("empty.stl", "empty", File, "is empty"),
    ("face_two_vertices.obj", "corners", Line(289), "found 2"),
    ("index_negative_out_of_range.obj", "range", Line(289), "index -9999"),
    ("index_not_integer.obj", "syntax", Line(289), "`2.5`"),
    ("index_out_of_range.obj", "range", Line(289), "index 9999"),
    ("index_overflow.obj", "range", Line(289), "index 99999999999999999999"),
    ("index_zero.obj", "range", Line(289), "counts from 1"),
    ("inf_coordinate.obj", "finite", Line(8), "`inf`"),
    ("nan_coordinate.obj", "finite", Line(8), "`nan`"),
    ("notenoughindices.obj", "corners", Line(9), "found 2"),
    ("nul_bytes.obj", "syntax", Byte(200), "NUL"),
    ("off_count_too_large.off", "truncated", Line(6), "4000000000 vertices, found 4"),
    ("off_index_out_of_range.off", "range", Line(6), "index 3"),
    ("off_negative_index.off", "range", Line(6), "index -1"),
    ("only_comments.obj", "empty", File, "no vertices"),
    ("only_vertices.obj", "empty", File, "96 vertices but no faces"),
    ("overflow_number.obj", "finite", Line(8), "`1e400`"),
    ("ply_count_too_large.ply", "truncated", Byte(214), "4000000000 `vertex` elements, found 3"),
    ("points_bin.ply", "empty", File, "5 vertices but no faces"),
    ("stl_count_too_large.stl", "truncated", Byte(134), "4000000000 facets, found 1"),
    ("stl_truncated.stl", "truncated", Byte(9609), "192 facets, found 190"),
    ("text_coordinate.obj", "syntax", Line(8), "`abc`"),
    ("text_garbage.obj", "syntax", Line(1), "`lorem`"),
    ("truncated.obj", "corners", Line(254), "found 2"),
    ("truncated.off", "truncated", Line(200), "192 faces, found 102"),
    ("truncated_geogram.ply", "truncated", Byte(1828), "12 `vertex` elements, found 6"),
    ("truncated_geogram.stl", "truncated", Byte(584), "20 facets, found 10"),
    ("two_coordinates.obj", "syntax", Line(8), "the end of the line"),
    ("zero_faces.off", "empty", File, "3 vertices but no faces"),
];

/// Files the reader behind the table fails on or misreads: their true size.
const CORRECTED: [(&str, (usize, usize)); 7] = [
    ("comments_blank_tabs.obj", (96, 192)),
    ("line_continuation.obj", (96, 192)),
    ("off_no_header.off", (96, 192)),
    ("tristrips_brain.ply", (18844, 36752)),
    ("utf8_bom.obj", (96, 192)),
    ("whitespace_trimesh.off", (8, 6)),
    ("wrong_extension.off", (96, 192)),
];

fn kind(error: &ReadError) -> &'static str {
    match error.kind {
        ReadErrorKind::Syntax { .. } => "syntax",
        ReadErrorKind::Truncated { .. } => "truncated",
        ReadErrorKind::IndexOutOfRange { .. } => "range",
        ReadErrorKind::TooFewCorners { .. } => "corners",
        ReadErrorKind::NonFinite { .. } => "finite",
        ReadErrorKind::Empty(_) => "empty",
        ReadErrorKind::Unsupported { .. } => "unsupported",
        _ => "other",
    }
}

#[test]
fn bad_meshes_get_their_verdict() {
    let Some(folder) = folder() else { return };
    let table = table(&folder);
    let (mut accepted, mut refused) = (0, 0);
    for entry in fs::read_dir(folder.join("bad")).unwrap() {
        let path = entry.unwrap().path();
        if Format::from_path(&path).is_none() {
            continue;
        }
        let name = path.file_name().unwrap().to_str().unwrap();
        let result = count(&path);
        if let Some((_, fault, at, text)) = REFUSED.iter().find(|(file, ..)| *file == name) {
            let error = result.expect_err(name);
            let found = error.line().map(Line).or(error.byte().map(Byte)).unwrap_or(File);
            assert_eq!((kind(&error), found), (*fault, *at), "{error}");
            assert!(error.to_string().contains(text), "{error}");
            refused += 1;
        } else {
            let stated = table.get(&Path::new("bad").join(name)).copied().flatten();
            let corrected = CORRECTED.iter().find(|(file, _)| *file == name).map(|(_, size)| *size);
            let found = result.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(Some(found), corrected.or(stated), "{name}");
            accepted += 1;
        }
    }
    assert_eq!(refused, REFUSED.len());
    assert!(accepted >= 90, "only {accepted} meshes");
}
