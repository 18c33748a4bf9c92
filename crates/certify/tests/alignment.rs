//! The certificate of alignment: what is broken is refused by name, what is aligned passes at any
//! size.
//!
//! The good maps are laid by hand: grids over themselves, and a cube as six squares.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod meshes;

use meshes::{SeamlessMap, mesh_of};
use seamstress_certify::{Alignment, Map, Tolerance, Violation};
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit::{cube, disk_grid, fan};
use std::collections::BTreeMap;

/// A mesh with the planar map of its own x and y.
fn planar(soup: &TriangleSoup) -> (TriMesh, SeamlessMap) {
    let corner = |&v: &u32| [soup.positions[v as usize][0], soup.positions[v as usize][1]];
    certified(mesh_of(soup), soup.faces.iter().flatten().map(corner).collect())
}

#[track_caller]
fn certified(mesh: TriMesh, uvs: Vec<[f64; 2]>) -> (TriMesh, SeamlessMap) {
    let map = SeamlessMap::certify(&mesh, uvs, &Tolerance::default()).unwrap();
    (mesh, map)
}

/// The grid of 4 by 4 quads on `[-1, 1]²`: vertex `5 y + x`.
fn grid() -> TriangleSoup {
    disk_grid(4, 4)
}

fn path(vertices: &[u32]) -> Vec<[u32; 2]> {
    vertices.windows(2).map(|p| [p[0], p[1]]).collect()
}

fn boundary(mesh: &TriMesh) -> Vec<[u32; 2]> {
    let outer = mesh.edges().filter(|&h| mesh.twin(h).is_none());
    outer.map(|h| [mesh.origin(h).0, mesh.tip(h).0]).collect()
}

fn check(map: &(TriMesh, SeamlessMap), edges: &[[u32; 2]]) -> Result<Alignment, Vec<Violation>> {
    let tolerance = Tolerance::default();
    map.1.alignment(&map.0, edges, &tolerance).map_err(|violations| violations.0)
}

fn moved(soup: &TriangleSoup, how: impl Fn([f64; 2]) -> [f64; 2]) -> TriangleSoup {
    let mut soup = soup.clone();
    for p in &mut soup.positions {
        let [x, y] = how([p[0], p[1]]);
        (p[0], p[1]) = (x, y);
    }
    soup
}

#[test]
fn the_rim_of_a_grid_is_aligned() {
    let map = planar(&grid());
    let found = check(&map, &boundary(&map.0)).unwrap();
    assert_eq!((found.edges, found.boundary_edges), (16, 16));
    assert_eq!((found.sides, found.exact_sides), (16, 16));
    assert_eq!((found.axis_error, found.sectors), (0.0, 16));
    assert_eq!(found.sectors_by_quarters, BTreeMap::from([(1, 4), (2, 12)]));
    assert!(found.sector_error < 1e-14);
}

#[test]
fn sectors_of_a_path_with_a_turn_and_an_open_end() {
    let map = planar(&grid());
    // From the boundary to the middle and up: free sectors at the start, two at each vertex
    // between, a full turn at the end.
    let found = check(&map, &path(&[10, 11, 12, 17])).unwrap();
    assert_eq!((found.edges, found.boundary_edges, found.sides), (3, 0, 6));
    assert_eq!(found.sectors_by_quarters, BTreeMap::from([(1, 1), (2, 2), (3, 1), (4, 1)]));
    // With the boundary, the start has two sectors of a quarter turn.
    let all = [path(&[10, 11, 12, 17]), boundary(&map.0)].concat();
    let found = check(&map, &all).unwrap();
    assert_eq!((found.edges, found.boundary_edges), (19, 16));
    assert_eq!(found.sectors_by_quarters[&1], 1 + 4 + 2);
    assert_eq!(check(&map, &[]).unwrap().sectors, 0);
}

#[test]
fn pairs_may_come_twice_and_from_either_end() {
    let map = planar(&grid());
    let once = check(&map, &[[11, 12]]).unwrap();
    assert_eq!(check(&map, &[[11, 12], [12, 11], [11, 12]]), Ok(once));
}

#[test]
fn both_sides_of_a_seam_count() {
    // A cube as six squares, each turned by a quarter more than the last.
    let mut uvs = Vec::new();
    for square in 0..6 {
        let turn = |[x, y]: [f64; 2]| [[x, y], [-y, x], [-x, -y], [y, -x]][square % 4];
        let at = |x, y| turn([x, y]).map(|c| c + 3.0 * square as f64);
        let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        uvs.extend([a, b, c, a, c, d]);
    }
    let map = certified(mesh_of(&cube()), uvs);
    let creases: Vec<_> = map.1.seams().iter().map(|seam| seam.vertices).collect();
    let found = check(&map, &creases).unwrap();
    assert_eq!((found.edges, found.sides, found.exact_sides), (12, 24, 24));
    assert_eq!(found.sectors_by_quarters, BTreeMap::from([(1, 24)]));
}

#[test]
fn a_map_turned_by_a_hair_is_off_in_every_edge() {
    let (sin, cos) = 1e-8f64.to_radians().sin_cos();
    let map = planar(&moved(&grid(), |[x, y]| [cos * x - sin * y, sin * x + cos * y]));
    let rim = boundary(&map.0);
    let found = check(&map, &rim).unwrap_err();
    let mut named = Vec::new();
    for violation in found {
        let Violation::OffAxis { vertices, degrees, .. } = violation else {
            panic!("{violation:?}");
        };
        assert!((degrees / 1e-8 - 1.0).abs() < 1e-6);
        named.push(vertices);
    }
    assert_eq!(named, rim);
    let wide = Tolerance { axes: 2e-8, ..Tolerance::default() };
    let found = map.1.alignment(&map.0, &rim, &wide).unwrap();
    assert!((found.axis_error / 1e-8 - 1.0).abs() < 1e-6);
    assert!(found.exact_sides < found.sides);
}

#[test]
fn a_slanted_edge_is_named_with_its_faces_and_its_sectors() {
    let map = planar(&grid());
    // The diagonal 6-12 runs at 45 degrees between the faces 10 and 11; at 12 it ends.
    let found = check(&map, &[[6, 12]]).unwrap_err();
    let off: Vec<_> = found
        .iter()
        .filter_map(|violation| match violation {
            Violation::OffAxis { vertices, face, degrees } => Some((*vertices, *face, *degrees)),
            _ => None,
        })
        .collect();
    let [(ends, one, a), (_, other, b)] = off[..] else { panic!("{found:?}") };
    assert!(ends == [6, 12] || ends == [12, 6]);
    assert!((a - 45.0).abs() < 1e-12 && (b - 45.0).abs() < 1e-12 && one != other);
    // Two edges that meet at 45 degrees: 7-12 goes straight up, 6-12 does not.
    let found = check(&map, &[[6, 12], [7, 12]]).unwrap_err();
    let mut sectors: Vec<_> = found
        .iter()
        .filter_map(|violation| match violation {
            Violation::SectorAngle { vertex, between, quarters } => {
                Some((*vertex, *between, *quarters))
            }
            _ => None,
        })
        .collect();
    sectors.sort_by(|a, b| a.2.total_cmp(&b.2));
    let [(12, [6, 7], small), (12, [7, 6], large)] = sectors[..] else { panic!("{found:?}") };
    assert!((small - 0.5).abs() < 1e-14 && (large - 3.5).abs() < 1e-14);
    assert!(matches!(found[0], Violation::OffAxis { vertices: [12, 6], .. }), "{found:?}");
}

#[test]
fn a_sector_folded_to_nothing_is_refused() {
    // A fan of four triangles at a boundary vertex, squeezed towards the axis until its angle
    // is nearer to none than to a quarter turn.
    let flat = fan(4, 0.0, false);
    let squeezed = moved(&flat, |[x, y]| {
        let angle = 1e-5 * y.atan2(x);
        [angle.cos(), angle.sin()].map(|c| c * x.hypot(y))
    });
    let map = planar(&squeezed);
    let loose = Tolerance { axes: 1.0, ..Tolerance::default() };
    let found = map.1.alignment(&map.0, &[[0, 1], [0, 5]], &loose).unwrap_err().0;
    let [Violation::SectorAngle { vertex: 0, between: [1, 5], quarters }] = found[..] else {
        panic!("{found:?}");
    };
    assert!((quarters - 2e-5).abs() < 1e-10);
}

#[test]
fn pairs_that_are_no_edges_are_named() {
    let map = planar(&grid());
    let found = check(&map, &[[0, 1], [0, 12], [3, 99]]).unwrap_err();
    let named = [[0, 12], [3, 99]].map(|vertices| Violation::NotAnEdge { vertices });
    assert_eq!(found, named);
}

#[test]
fn a_map_of_another_mesh_is_refused() {
    let (_, map) = planar(&grid());
    let other = mesh_of(&disk_grid(3, 4));
    let found = check(&(other, map), &[[0, 1]]).unwrap_err();
    assert_eq!(found, [Violation::UvCount { expected: 72, found: 96 }]);
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-300, 1e-200, 1e-12, 1e200, 1e307] {
        let soup = grid();
        let corner = |&v: &u32| [0, 1].map(|k| scale * soup.positions[v as usize][k]);
        let uvs = soup.faces.iter().flatten().map(corner).collect();
        let map = certified(mesh_of(&soup), uvs);
        let found = check(&map, &boundary(&map.0)).unwrap();
        assert_eq!((found.exact_sides, found.sectors_by_quarters[&1]), (16, 4));
        assert!(found.sector_error < 1e-14);
        assert!(check(&map, &[[6, 12]]).is_err());
    }
}

#[test]
fn a_slit_ends_at_a_grid_point_also_where_an_edge_goes_straight_on() {
    // Four triangles around vertex 0 at the tip of a slit along -x, whose sides end at 1 and 5.
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let edges = [[0, 1], [0, 3], [0, 5]];
    for (tip, is_right) in [(0.0, true), (0.5, false)] {
        let at = [[tip, 0.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
        let uvs: Vec<[f64; 2]> = faces.as_flattened().iter().map(|&v| at[v]).collect();
        let faces = faces.map(|face| face.map(|v| v as u32));
        let map = Map::new(6, &faces, &uvs).unwrap();
        let found = map.integers(&edges, &Tolerance::default()).map(|found| found.integral_corners);
        match is_right {
            true => assert_eq!(found.unwrap(), 1),
            false => assert!(matches!(
                found.unwrap_err().0[..],
                [Violation::FractionalCorner { vertex: 0, .. }]
            )),
        }
    }
}
