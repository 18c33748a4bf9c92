//! From patches and grid points to quads.

use super::fixed::Point;
use super::patches::Patches;
use super::pieces::Pieces;
use super::points::{GridPoints, Site};
use super::snap::GridMap;
use super::winding::degrees;
use seamstress_mesh::{Face, TriMesh};
use seamstress_parallel::prelude::*;

const NONE: u32 = u32::MAX;
/// Faces looked at by one task.
const FACES_PER_TASK: usize = 1024;

/// Quads whose corners are numbers of grid points, and what became of the cells that gave none.
pub(super) struct Quads {
    pub(super) quads: Vec<[u32; 4]>,
    /// Cells cut by the boundary.
    pub(super) trimmed: usize,
    /// Cells lost in folds: covered a wrong number of times, or collapsed.
    pub(super) lost: usize,
    /// Grid points that folds cover several times, less those they became.
    pub(super) merged: usize,
}

/// Makes a quad of every whole cell.
///
/// Without folds a whole cell is covered once and each of its corners is one grid point. With
/// folds the sheets are counted with their signs, and the grid points at one corner of a patch
/// become one.
pub(super) fn assemble(
    mesh: &TriMesh,
    map: &GridMap,
    pieces: &Pieces,
    points: &GridPoints,
    patches: &Patches,
    has_folds: bool,
) -> Quads {
    let mut classes = Classes::new(points.sites.len());
    let degrees = if has_folds {
        merge_on_collapsed_faces(mesh, map, points, &mut classes);
        degrees(mesh, map, pieces, patches)
    } else {
        vec![1; patches.count()]
    };
    // Sheets at a corner of a patch that covers its cell once, or not at all, cancel but for one or none.
    let is_simple = |patch: usize| !patches.is_twisted[patch] && degrees[patch].abs() <= 1;
    let found = corners(mesh, map, pieces, points, patches);
    let corners = merge_at_corners(patches.count(), &found, is_simple, &mut classes);
    let names = classes.names(|number| is_cone(map, points.sites[number as usize]));
    let mut result = Quads { quads: Vec::new(), trimmed: 0, lost: 0, merged: 0 };
    for (patch, corners) in corners.iter().enumerate() {
        if patches.is_partial[patch] {
            result.trimmed += 1;
            continue;
        }
        match quad(corners, degrees[patch], &names).filter(|_| !patches.is_twisted[patch]) {
            Some(quad) if !has_folds || !is_collapsed(&quad) => result.quads.push(quad),
            // A fold's two sheets are nothing.
            _ => result.lost += usize::from(degrees[patch] != 0),
        }
    }
    let is_renamed = |(number, &name): (usize, &u32)| number != name as usize;
    result.merged = names.iter().enumerate().filter(|&pair| is_renamed(pair)).count();
    result
}

fn is_cone(map: &GridMap, site: Site) -> bool {
    matches!(site, Site::Vertex(v) if map.indices[v] != 0)
}

fn quad(corners: &[u32; 4], degree: i32, names: &[u32]) -> Option<[u32; 4]> {
    if corners.contains(&NONE) {
        return None;
    }
    let [a, b, c, d] = corners.map(|number| names[number as usize]);
    match degree {
        1 => Some([a, b, c, d]),
        // A sheet that is turned over in the plane is still a part of the surface.
        -1 => Some([a, d, c, b]),
        _ => None,
    }
}

fn is_collapsed(quad: &[u32; 4]) -> bool {
    (1..4).any(|k| quad[..k].contains(&quad[k]))
}

/// A grid point at a corner of a patch.
type Record = (u32, u8, u32);

/// The grid points at the corners of all patches, once for each face they are on.
fn corners(
    mesh: &TriMesh,
    map: &GridMap,
    pieces: &Pieces,
    points: &GridPoints,
    patches: &Patches,
) -> Vec<Vec<Record>> {
    let faces: Vec<Face> = mesh.faces().collect();
    let records = faces.par_chunks(FACES_PER_TASK).map(|faces| {
        let (mut records, mut found): (Vec<Record>, _) = (Vec::new(), Vec::new());
        for &face in faces {
            points.of_closed_face(mesh, map, face, &mut found);
            for &(p, number) in &found {
                records.extend(cells_at(p).filter_map(|(k, cell)| {
                    let piece = pieces.get(face, cell)? as usize;
                    let slot = (k + patches.turns[piece]) % 4;
                    Some((patches.of_piece[piece], slot, number))
                }));
            }
        }
        records
    });
    records.collect()
}

/// The grid point at each corner of each patch; further ones at a simple patch become one with it.
fn merge_at_corners(
    n_patches: usize,
    records: &[Vec<Record>],
    is_simple: impl Fn(usize) -> bool,
    classes: &mut Classes,
) -> Vec<[u32; 4]> {
    let mut corners = vec![[NONE; 4]; n_patches];
    for &(patch, slot, number) in records.iter().flatten() {
        let patch = patch as usize;
        let known = &mut corners[patch][usize::from(slot)];
        if *known == NONE {
            *known = number;
        } else if is_simple(patch) {
            classes.join(*known, number);
        }
    }
    corners
}

/// The four cells at a grid point, and which of their corners it is, counter-clockwise from the lowest.
fn cells_at([i, j]: [i64; 2]) -> impl Iterator<Item = (u8, [i64; 2])> {
    [(0, [i, j]), (1, [i - 1, j]), (2, [i - 1, j - 1]), (3, [i, j - 1])].into_iter()
}

/// Points of a collapsed face at one place of the plane are one point.
fn merge_on_collapsed_faces(
    mesh: &TriMesh,
    map: &GridMap,
    points: &GridPoints,
    classes: &mut Classes,
) {
    let mut found = Vec::new();
    for face in mesh.faces() {
        let [a, b, c] = map.triangle(face);
        if Point::orientation(a, b, c) != 0 {
            continue;
        }
        points.of_closed_face(mesh, map, face, &mut found);
        found.sort_unstable();
        for pair in found.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            classes.join(pair[0].1, pair[1].1);
        }
    }
}

/// Classes of grid points that become one vertex.
struct Classes {
    parent: Vec<u32>,
}

impl Classes {
    fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    fn root(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let up = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = up;
            x = up;
        }
        x
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// The point each class is named after: its first preferred one, or else its first.
    fn names(mut self, is_preferred: impl Fn(u32) -> bool) -> Vec<u32> {
        let n = self.parent.len() as u32;
        let mut chosen = vec![NONE; n as usize];
        for x in (0..n).filter(|&x| is_preferred(x)) {
            let name = &mut chosen[self.root(x) as usize];
            *name = (*name).min(x);
        }
        let name = |x| {
            let root = self.root(x);
            if chosen[root as usize] == NONE { root } else { chosen[root as usize] }
        };
        (0..n).map(name).collect()
    }
}
