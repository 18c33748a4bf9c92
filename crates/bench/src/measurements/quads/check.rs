//! What must hold of the quads of a map, found from their corners alone.

use crate::meshes::Mesh;
use seamstress_parametrize::SeamlessMap;
use std::collections::{BTreeMap, BTreeSet, HashMap};

type Edge = (u32, u32);

/// Counts of a quad mesh, from the list of its quads.
#[derive(Debug, Default)]
pub(super) struct Counts {
    pub(super) euler_characteristic: i64,
    pub(super) boundary_loops: usize,
    /// Quads at each vertex that has some and is off the boundary, where there are not four.
    pub(super) irregular: BTreeMap<u32, usize>,
}

/// Counts, or the first reason why the quads are no oriented manifold.
pub(super) fn count(quads: &[[u32; 4]]) -> Result<Counts, String> {
    let mut next: HashMap<Edge, usize> = HashMap::new();
    for (q, quad) in quads.iter().enumerate() {
        if (1..4).any(|k| quad[..k].contains(&quad[k])) {
            return Err(format!("quad {q} has a vertex twice"));
        }
        for edge in sides(quad) {
            if next.insert(edge, q).is_some() {
                return Err(format!("edge {}-{} has two quads on one side", edge.0, edge.1));
            }
        }
    }
    let open: BTreeMap<u32, u32> = open_sides(&next)?;
    let mut around: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (q, quad) in quads.iter().enumerate() {
        quad.iter().for_each(|&v| around.entry(v).or_default().push(q));
    }
    for (&v, fan) in &around {
        if !is_one_fan(v, fan, quads) {
            return Err(format!("the quads around vertex {v} are no fan"));
        }
    }
    let edges: BTreeSet<Edge> = next.keys().map(|&(a, b)| (a.min(b), a.max(b))).collect();
    let is_irregular = |(v, fan): (&u32, &Vec<usize>)| {
        (!open.contains_key(v) && fan.len() != 4).then_some((*v, fan.len()))
    };
    Ok(Counts {
        euler_characteristic: around.len() as i64 - edges.len() as i64 + quads.len() as i64,
        boundary_loops: loops(&open),
        irregular: around.iter().filter_map(is_irregular).collect(),
    })
}

fn sides(quad: &[u32; 4]) -> [Edge; 4] {
    [0, 1, 2, 3].map(|k| (quad[k], quad[(k + 1) % 4]))
}

/// The boundary: where it goes on from each of its vertices.
fn open_sides(sides: &HashMap<Edge, usize>) -> Result<BTreeMap<u32, u32>, String> {
    let mut open = BTreeMap::new();
    for &(a, b) in sides.keys().filter(|&&(a, b)| !sides.contains_key(&(b, a))) {
        if open.insert(a, b).is_some() {
            return Err(format!("the boundary passes vertex {a} twice"));
        }
    }
    Ok(open)
}

/// Whether the quads at a vertex hang together by edges at it.
fn is_one_fan(v: u32, fan: &[usize], quads: &[[u32; 4]]) -> bool {
    let ends = |q: usize| {
        let at = quads[q].iter().position(|&w| w == v).unwrap_or(0);
        (quads[q][(at + 1) % 4], quads[q][(at + 3) % 4])
    };
    let mut reached = vec![false; fan.len()];
    let mut stack = vec![0];
    reached[0] = true;
    while let Some(i) = stack.pop() {
        let (first, last) = ends(fan[i]);
        for j in 0..fan.len() {
            let (other_first, other_last) = ends(fan[j]);
            if !reached[j] && (other_first == last || other_last == first) {
                reached[j] = true;
                stack.push(j);
            }
        }
    }
    reached.into_iter().all(|is| is)
}

fn loops(open: &BTreeMap<u32, u32>) -> usize {
    let mut left = open.clone();
    let mut count = 0;
    while let Some((mut at, _)) = left.first_key_value().map(|(&a, &b)| (a, b)) {
        count += 1;
        while let Some(next) = left.remove(&at) {
            at = next;
        }
    }
    count
}

/// Twice the area of the map, summed from its triangles, halved.
pub(super) fn uv_area(corner_uvs: &[[f64; 2]]) -> f64 {
    let twice = corner_uvs.chunks_exact(3).map(|t| {
        let [p, q] = [1, 2].map(|k| [t[k][0] - t[0][0], t[k][1] - t[0][1]]);
        p[0] * q[1] - p[1] * q[0]
    });
    0.5 * twice.sum::<f64>()
}

/// What is wrong with the quads of a map; nothing if all is well.
///
/// A closed mesh must have quads of its own topology, as many as the area of the map, with the irregular
/// vertices of the map's cones: at the same positions, with `4 - index` quads. An open mesh is trimmed: its
/// irregular vertices must be cones.
pub(super) fn faults(
    mesh: &Mesh,
    map: &SeamlessMap,
    positions: &[[f64; 3]],
    quads: &[[u32; 4]],
    counts: &Counts,
) -> Vec<String> {
    let mut faults = Vec::new();
    let source = &mesh.connectivity;
    let is_closed = source.n_boundary_loops() == 0;
    let mut cones: BTreeMap<[u64; 3], Vec<i32>> = BTreeMap::new();
    for cone in map.cones() {
        cones.entry(key(mesh.positions[cone.vertex as usize])).or_default().push(cone.index);
    }
    for (&v, &valence) in &counts.irregular {
        let index = 4 - valence as i32;
        let here = cones.get_mut(&key(positions[v as usize]));
        match here.and_then(|list| list.iter().position(|&i| i == index).map(|at| list.remove(at)))
        {
            Some(_) => {}
            None => faults.push(format!("vertex {v} of valence {valence} is no cone")),
        }
    }
    if is_closed {
        let left: usize = cones.values().map(Vec::len).sum();
        if left > 0 {
            faults.push(format!("{left} cones are no irregular vertices"));
        }
        if counts.boundary_loops > 0 {
            faults.push(format!("{} boundary loops", counts.boundary_loops));
        }
        let expected = source.euler_characteristic();
        if counts.euler_characteristic != expected {
            let found = counts.euler_characteristic;
            faults.push(format!("Euler characteristic {found} instead of {expected}"));
        }
        let area = uv_area(map.corner_uvs());
        if (area - quads.len() as f64).abs() > 0.5 {
            faults.push(format!("{} quads for an area of {area}", quads.len()));
        }
    }
    faults
}

/// A position as an exact key.
fn key(p: [f64; 3]) -> [u64; 3] {
    // Zero has two signs.
    p.map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_mesh::TriMesh;
    use seamstress_testkit as kit;

    fn cube() -> (kit::IntegerMap, Vec<[u32; 4]>) {
        let map = kit::squares(&kit::cube(), 1);
        let faces = map.soup.faces.chunks(2);
        let quads = faces.map(|p| [p[0][0], p[0][1], p[0][2], p[1][2]]).collect();
        (map, quads)
    }

    #[test]
    fn a_cube_and_what_can_be_wrong_with_one() {
        let (map, quads) = cube();
        let counts = count(&quads).unwrap();
        assert_eq!((counts.euler_characteristic, counts.boundary_loops), (2, 0));
        assert!(counts.irregular.values().all(|&n| n == 3) && counts.irregular.len() == 8);
        let counts = count(&quads[1..]).unwrap();
        assert_eq!((counts.euler_characteristic, counts.boundary_loops), (1, 1));

        let mut turned = quads.clone();
        turned[0].reverse();
        assert!(count(&turned).unwrap_err().contains("on one side"));
        let mut collapsed = quads.clone();
        collapsed[2][0] = collapsed[2][1];
        assert!(count(&collapsed).unwrap_err().contains("twice"));
        let apex = [[0, 1, 2, 3], [0, 4, 5, 6]];
        assert!(count(&apex).unwrap_err().contains("vertex 0"));
        let mut two: Vec<[u32; 4]> = quads.clone();
        two.extend(quads.iter().map(|q| q.map(|v| if v == 0 { 0 } else { v + 8 })));
        assert!(count(&two).unwrap_err().contains("no fan"));
        assert_eq!(uv_area(&map.corner_uvs), 6.0);
    }

    #[test]
    fn every_fault_is_found() {
        let (map, quads) = cube();
        let connectivity = TriMesh::from_faces(8, &map.soup.faces).unwrap();
        let tolerance = seamstress_parametrize::Tolerance::default();
        let certified = SeamlessMap::certify(&connectivity, map.corner_uvs, &tolerance).unwrap();
        let mesh = Mesh { connectivity, positions: map.soup.positions.clone() };
        let of = |positions: &[[f64; 3]], quads: &[[u32; 4]]| {
            faults(&mesh, &certified, positions, quads, &count(quads).unwrap()).join(", ")
        };
        assert_eq!(of(&mesh.positions, &quads), "");
        let mut moved = mesh.positions.clone();
        moved[3][1] += 1e-9;
        assert_eq!(
            of(&moved, &quads),
            "vertex 3 of valence 3 is no cone, 1 cones are no irregular vertices"
        );
        let open = of(&mesh.positions, &quads[1..]);
        assert!(open.contains("4 cones are no") && open.contains("1 boundary loops"), "{open}");
        assert!(open.contains("Euler characteristic 1 instead of 2"), "{open}");
        assert!(open.contains("5 quads for an area of 6"), "{open}");
    }
}
