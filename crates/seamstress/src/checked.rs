//! Triangles that have been checked, and welded and repaired if asked.

use crate::polygons::Polygons;
use crate::surface_options::{SurfaceOptions, Weld};
use crate::words::{counted, rounded};
use seamstress_mesh::soup::{
    self, Facts, Fault, Merged, Repair, TriangleSoup, Triangulation, TriangulationNotes,
};

/// Triangles after check, merging and repairs.
#[derive(Default)]
pub(crate) struct Checked {
    pub(crate) soup: TriangleSoup,
    pub(crate) facts: Facts,
    /// In the vertices and polygons of the input.
    pub(crate) faults: Vec<Fault>,
    pub(crate) is_repairable: bool,
    pub(crate) notes: Vec<String>,
    pub(crate) repairs: Vec<String>,
    pub(crate) welded_vertices: usize,
    pub(crate) weld_tolerance: Option<f64>,
    /// In the vertices of the input.
    pub(crate) junctions: Vec<[u32; 2]>,
    pub(crate) merged_into: Option<Vec<u32>>,
    pub(crate) vertex_origin: Option<Vec<u32>>,
    pub(crate) face_origin: Vec<u32>,
}

impl Checked {
    pub(crate) fn new(
        positions: &[[f64; 3]],
        polygons: &Polygons,
        options: SurfaceOptions,
    ) -> Self {
        let slices: Vec<&[u32]> = polygons.iter().collect();
        let faults = soup::polygon_faults(positions.len(), &slices);
        let has_bad_corners = !faults.is_empty();
        let is_of_corners = |fault: &Fault| {
            matches!(fault, Fault::RepeatedVertex { .. } | Fault::TooFewCorners { .. })
        };
        if !faults.iter().all(is_of_corners) {
            return Self::unsplit(positions, slices.len(), faults);
        }
        let mut checked = Self::default();
        let mut repairs = Vec::new();
        let into = checked.merge_vertices(positions, polygons, options, &mut repairs);
        let merged = match into {
            Some(_) => into,
            None if options.repair && has_bad_corners => {
                Some((0..positions.len() as u32).collect())
            }
            None => None,
        }
        .map(|into| (soup::merge(positions, polygons.iter(), &into), into));
        match merged {
            None => checked.split(positions.to_vec(), polygons.iter(), None, options, repairs),
            Some((mut merged, into)) => {
                repairs.append(&mut merged.repairs);
                checked.merged_into = Some(into);
                let positions = std::mem::take(&mut merged.positions);
                let polygons = std::mem::take(&mut merged.polygons);
                let slices = polygons.iter().map(Vec::as_slice);
                checked.split(positions, slices, Some(&merged), options, repairs);
            }
        }
        let is_error = |fault: &Fault| fault.severity() == soup::Severity::Error;
        if !options.repair && checked.faults.iter().any(is_error) {
            let repaired = Self::new(positions, polygons, options.repair(true));
            checked.is_repairable = !repaired.faults.iter().any(is_error);
        }
        checked
    }

    /// For each vertex what it is merged into, if any is.
    fn merge_vertices(
        &mut self,
        positions: &[[f64; 3]],
        polygons: &Polygons,
        options: SurfaceOptions,
        repairs: &mut Vec<Repair>,
    ) -> Option<Vec<u32>> {
        let is_soup = || soup::is_unwelded(positions.len(), polygons.iter());
        let automatic = || soup::weld_tolerance(positions, polygons.iter());
        let tolerance = match options.weld {
            Weld::Off => None,
            Weld::Soups => is_soup().then(automatic),
            Weld::Auto => Some(automatic()),
            Weld::Within(tolerance) => Some(tolerance),
        };
        if let Some(tolerance) = tolerance {
            let into = soup::weld(positions, tolerance);
            let count = n_merged(&into);
            if count == 0 && options.weld == Weld::Soups {
                return None;
            }
            (self.welded_vertices, self.weld_tolerance) = (count, Some(tolerance));
            self.notes.push(weld_note(count, tolerance, options.weld));
            return (count > 0).then_some(into);
        }
        if !options.repair {
            return None;
        }
        let into = soup::collapse(positions, polygons.iter());
        let mut sets: Vec<[u32; 2]> = into.iter().copied().zip(0..).map(<[u32; 2]>::from).collect();
        sets.sort_unstable();
        let joined = sets.chunk_by(|a, b| a[0] == b[0]).filter(|set| set.len() > 1);
        repairs.extend(joined.map(|set| Repair::CollapsedSides {
            vertices: set.iter().map(|pair| pair[1]).collect(),
        }));
        (n_merged(&into) > 0).then_some(into)
    }

    /// Splits polygons into triangles, and checks these, after repairs if they are asked for.
    fn split<'a>(
        &mut self,
        positions: Vec<[f64; 3]>,
        polygons: impl ExactSizeIterator<Item = &'a [u32]>,
        merged: Option<&Merged>,
        options: SurfaceOptions,
        repairs: Vec<Repair>,
    ) {
        self.repairs = repairs.iter().map(ToString::to_string).collect();
        let polygon_was = |polygon: u32| match merged {
            Some(merged) => merged.polygon_origin[polygon as usize],
            None => polygon,
        };
        let vertex_was = |vertex: u32| match merged {
            Some(merged) => merged.vertex_origin[vertex as usize],
            None => vertex,
        };
        let n_polygons = polygons.len();
        let (faces, polygon_of_face) = match soup::triangulate(&positions, polygons) {
            Ok(Triangulation { faces, polygon_of_face, mut notes, .. }) => {
                for polygon in &mut notes.unresolved {
                    *polygon = polygon_was(*polygon);
                }
                self.notes.extend(triangulation_notes(&notes));
                (faces, polygon_of_face.into_iter().map(polygon_was).collect::<Vec<u32>>())
            }
            Err(faults) => {
                let faults = faults.into_iter().map(|fault| {
                    fault.with_faces_renamed(polygon_was).with_vertices_renamed(vertex_was)
                });
                let unsplit = Self::unsplit(&positions, n_polygons, faults.collect());
                (self.soup, self.facts, self.faults) =
                    (unsplit.soup, unsplit.facts, unsplit.faults);
                return;
            }
        };
        let soup = TriangleSoup { positions, faces };
        self.vertex_origin = merged.map(|merged| merged.vertex_origin.clone());
        self.face_origin = polygon_of_face;
        self.soup = match options.repair {
            false => soup,
            true => self.repair(soup, vertex_was),
        };
        let report = soup::check(&self.soup);
        let in_input = |fault: Fault| {
            let fault = fault.with_faces_renamed(|face| self.face_origin[face as usize]);
            match &self.vertex_origin {
                Some(origin) => fault.with_vertices_renamed(|v| origin[v as usize]),
                None => fault,
            }
        };
        self.faults = report.faults.into_iter().map(in_input).collect();
        // Triangles of one polygon may have one fault.
        self.faults.dedup();
        self.facts = report.facts;
    }

    fn repair(&mut self, soup: TriangleSoup, vertex_was: impl Fn(u32) -> u32) -> TriangleSoup {
        let done = soup::repair(soup);
        let polygon_was = |face: u32| self.face_origin[face as usize];
        let mut repairs: Vec<Repair> =
            done.repairs.into_iter().map(|r| r.renamed(polygon_was, &vertex_was)).collect();
        repairs.dedup();
        self.repairs.extend(repairs.iter().map(ToString::to_string));
        self.junctions = done.junctions.iter().map(|edge| edge.map(&vertex_was)).collect();
        self.vertex_origin = Some(done.vertex_origin.into_iter().map(&vertex_was).collect());
        self.face_origin = done.face_origin.into_iter().map(polygon_was).collect();
        done.soup
    }

    /// Vertices in the place of another, not counting the copies that repairs have made.
    pub(crate) fn coincident_vertices(&self) -> usize {
        let mut origins = self.vertex_origin.clone().unwrap_or_default();
        let n_vertices = origins.len();
        origins.sort_unstable();
        origins.dedup();
        self.facts.n_coincident_vertices.saturating_sub(n_vertices - origins.len())
    }

    /// Polygons that could not be split.
    fn unsplit(positions: &[[f64; 3]], n_polygons: usize, faults: Vec<Fault>) -> Self {
        let mut facts = Facts::default();
        (facts.n_vertices, facts.n_faces) = (positions.len(), n_polygons);
        let soup = TriangleSoup { positions: positions.to_vec(), faces: Vec::new() };
        Self { soup, facts, faults, ..Self::default() }
    }
}

fn n_merged(into: &[u32]) -> usize {
    into.iter().zip(0u32..).filter(|(into, v)| **into != *v).count()
}

fn weld_note(count: usize, tolerance: f64, weld: Weld) -> String {
    let place = match tolerance > 0.0 {
        true => format!("within {} of another", rounded(tolerance)),
        false => "in the place of another".into(),
    };
    let reason = match weld {
        Weld::Soups => "; the faces shared next to none",
        _ => "",
    };
    match count {
        0 => format!("no vertex is {place}"),
        n => format!("merged {} {place}{reason}", counted(n, "vertex")),
    }
}

fn triangulation_notes(notes: &TriangulationNotes) -> Vec<String> {
    let mut lines = Vec::new();
    let quads = counted(notes.quads, "quad");
    let larger = counted(notes.larger, "polygon");
    match (notes.quads, notes.larger) {
        (0, 0) => {}
        (_, 0) => lines.push(format!("{quads} split into triangles")),
        (0, _) => lines.push(format!("{larger} split into triangles")),
        _ => lines.push(format!("{quads} and {larger} of more corners split into triangles")),
    }
    if let [first, ..] = notes.unresolved[..] {
        lines.push(format!(
            "{} could not be split into triangles that are not flat or overlapping; the first is face {first}",
            counted(notes.unresolved.len(), "polygon")
        ));
    }
    lines
}
