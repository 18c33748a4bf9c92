//! Cuts where only some of the matchings are known.

use super::{Cut, Unfolding, prune::prune};
use seamstress_mesh::{Face, FaceData, Halfedge, HalfedgeData, TriMesh};
use std::collections::VecDeque;

/// A slit mesh cut along the edges whose matching is open, and along as few others as it takes to lay the faces out:
/// wherever known matchings close up around a vertex, its edges are glued.
#[derive(Debug, Clone)]
pub struct PartialCut {
    /// Its wedges and seams.
    pub cut: Cut,
    /// Quarter turns from the gauge of the unfolding to that of this cut, where glued edges have matching zero.
    pub gauge: FaceData<i32>,
    /// The seams of the cut of known matching, by their left half-edges, with it in this gauge.
    pub known: Vec<(Halfedge, i32)>,
}

impl PartialCut {
    /// Cuts a slit mesh that is unfolded; `matching` is that of its seams, in their order, where it is known.
    pub fn new(slit: &TriMesh, unfolding: &Unfolding, matching: &[Option<i32>]) -> Self {
        let mut across = HalfedgeData::filled(slit.n_halfedges(), Some(0));
        for (&h, &matching) in unfolding.cut.seams.iter().zip(matching) {
            across[h] = matching;
            if let Some(t) = slit.twin(h) {
                across[t] = matching.map(|m| -m);
            }
        }
        let mut gauge: FaceData<Option<i32>> = FaceData::filled(slit.n_faces(), None);
        let mut is_seam: HalfedgeData<bool> =
            slit.halfedges().map(|h| slit.twin(h).is_some()).collect();
        for root in slit.faces() {
            spread(slit, root, &across, &mut gauge, &mut is_seam);
        }
        let gauge: FaceData<i32> = gauge.iter().map(|k| k.unwrap_or(0)).collect();
        let here = |h: Halfedge| {
            let other = slit.twin(h).map_or(0, |t| gauge[t.face()]);
            across[h].map(|m| m - gauge[h.face()] + other)
        };
        let closes = |h| here(h).is_some_and(|m| m.rem_euclid(4) == 0);
        prune(slit, &mut is_seam, |v, h| !slit.is_boundary(v) && closes(h));
        let cut = Cut::new(slit, |h| !is_seam[h]);
        let known = cut.seams.iter().filter_map(|&h| Some((h, here(h)?))).collect();
        Self { cut, gauge, known }
    }
}

/// Gives all faces that known matchings join to a face its gauge, and glues the edges of the breadth-first tree that
/// reaches them.
fn spread(
    slit: &TriMesh,
    root: Face,
    across: &HalfedgeData<Option<i32>>,
    gauge: &mut FaceData<Option<i32>>,
    is_seam: &mut HalfedgeData<bool>,
) {
    if gauge[root].is_some() {
        return;
    }
    gauge[root] = Some(0);
    let mut queue = VecDeque::from([(root, 0)]);
    while let Some((f, k)) = queue.pop_front() {
        for h in f.halfedges() {
            let (Some(t), Some(matching)) = (slit.twin(h), across[h]) else { continue };
            if gauge[t.face()].is_none() {
                gauge[t.face()] = Some(k - matching);
                is_seam[h] = false;
                is_seam[t] = false;
                queue.push_back((t.face(), k - matching));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::MatchedCut;
    use crate::features::Sectors;
    use seamstress_mesh::Metric;
    use seamstress_mesh::soup::TriangleSoup;
    use seamstress_testkit as testkit;

    /// Checks a cut with some matchings open; its wedges, and those of the cut along all seams.
    fn check(soup: &TriangleSoup, is_open: impl Fn(usize) -> bool) -> (usize, usize) {
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let sectors = Sectors::unaligned(&mesh);
        let unfolding = Unfolding::through_curved_sectors(&sectors, &metric);
        let matched = MatchedCut::nearest(unfolding.clone());
        let known = matched.matching.iter().enumerate();
        let matching: Vec<Option<i32>> = known.map(|(e, &m)| (!is_open(e)).then_some(m)).collect();
        let PartialCut { cut, gauge, known } = PartialCut::new(&mesh, &unfolding, &matching);
        let mut left = 0;
        for (&h, &matching) in unfolding.cut.seams.iter().zip(&matching) {
            let turned = gauge[mesh.twin(h).unwrap().face()] - gauge[h.face()];
            match matching {
                None => assert!(cut.is_seam[h]),
                // What is glued has matching zero in the gauge of the cut.
                Some(m) if !cut.is_seam[h] => assert_eq!((m + turned).rem_euclid(4), 0),
                Some(m) => {
                    assert!(known.contains(&(h, m + turned)));
                    left += 1;
                }
            }
        }
        assert!(left <= known.len());
        // Faces, seams on both sides and wedges make a disk.
        let edges = mesh.edges().count() + cut.seams.len();
        assert_eq!(cut.n_wedges + mesh.n_faces(), edges + 1);
        // No seam of known matching ends where its matchings close up.
        let full = matched.matching_per_halfedge(&sectors);
        for v in mesh.vertices() {
            let seams: Vec<Halfedge> = mesh.outgoing(v).filter(|&h| cut.is_seam[h]).collect();
            if let [only] = seams[..] {
                let total: i32 = mesh.outgoing(v).map(|h| full[h]).sum();
                let open = unfolding
                    .cut
                    .seams
                    .iter()
                    .zip(&matching)
                    .any(|(&h, m)| m.is_none() && (h == only || mesh.twin(h) == Some(only)));
                assert!(open || total.rem_euclid(4) != 0, "vertex {}", v.0);
            }
        }
        (cut.n_wedges, unfolding.cut.n_wedges)
    }

    #[test]
    fn cuts_are_short_disks_and_glue_what_closes_up() {
        let sphere = testkit::bumpy(&testkit::icosphere(2), 0.05, 3);
        let torus = testkit::torus(12, 8, 3.0, 1.0);
        for soup in [&sphere, &torus] {
            let (here, all) = check(soup, |_| true);
            assert_eq!(here, all);
            let (known, _) = check(soup, |_| false);
            let (some, _) = check(soup, |e| e % 3 == 0);
            assert!(known < some && some < all, "{known} {some} {all}");
        }
    }
}
