//! Local estimation: what turning an edge does, estimated on a small patch.

use crate::cotangent::edge_weight;
use crate::features::Sectors;
use seamstress_linalg::dense::solve_spd;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, Vertex, VertexData};
use seamstress_parallel::prelude::*;
use std::collections::BTreeMap;

/// Rings around an edge that make its patch.
const RINGS: usize = 2;

/// Answer of the log scale to turning one edge by a quarter, on its patch, negated.
struct PatchResponse {
    /// Vertices of the patch with the area-weighted change of the log scale.
    weighted: Vec<(Vertex, f64)>,
    /// Weighted square of the change.
    square: f64,
}

/// Local estimates for the edges that are still open.
///
/// Turning an edge by d quarters moves d quarters of curvature from its origin to its tip; on a patch
/// held at its rim the logarithm s of the layout's scale answers with `-d w`, `L w = (pi / 2)(e_o - e_t)`.
/// The energy `|s|^2` then changes by `-2 d <s, w> + d^2 |w|^2`. In units of `|w|^2` this is `d^2` where
/// the layout is still isometric, and less where the turn relieves a stretch that is there.
pub(super) struct LocalEstimate {
    responses: Vec<Option<PatchResponse>>,
}

impl LocalEstimate {
    /// Solves the patch problem of each open edge.
    pub(super) fn new(
        sectors: &Sectors<'_>,
        metric: &Metric,
        turning: &[Halfedge],
        open: &[u32],
    ) -> Self {
        let cotangent = metric.cotangent();
        let area = metric.vertex_area(sectors.slit());
        let solved: Vec<_> = open
            .par_iter()
            .map(|&e| (e, respond(sectors, &cotangent, &area, turning[e as usize])))
            .collect();
        let mut responses: Vec<Option<PatchResponse>> = turning.iter().map(|_| None).collect();
        for (e, response) in solved {
            responses[e as usize] = response;
        }
        Self { responses }
    }

    /// Size of turning an edge by `d` quarters, given the present log scale: `|d|` in a relaxed layout.
    pub(super) fn size(&self, edge: u32, d: f64, log_scale: &VertexData<f64>) -> f64 {
        let Some(response) = &self.responses[edge as usize] else { return d.abs() };
        let overlap: f64 = response.weighted.iter().map(|&(v, w)| w * log_scale[v]).sum();
        (d * d - 2.0 * d * overlap / response.square).max(0.0).sqrt()
    }
}

fn respond(
    sectors: &Sectors<'_>,
    cotangent: &HalfedgeData<f64>,
    area: &VertexData<f64>,
    edge: Halfedge,
) -> Option<PatchResponse> {
    let slit = sectors.slit();
    let mut patch = vec![slit.origin(edge), slit.tip(edge)];
    let mut number: BTreeMap<Vertex, usize> = patch.iter().copied().zip(0..).collect();
    let mut begin = 0;
    for _ in 0..RINGS {
        let end = patch.len();
        for i in begin..end {
            for h in slit.outgoing(patch[i]) {
                // The previous half-edge reaches the last neighbour of a boundary vertex.
                for w in [slit.tip(h), slit.origin(h.prev())] {
                    if !sectors.is_free(w) && !number.contains_key(&w) {
                        number.insert(w, patch.len());
                        patch.push(w);
                    }
                }
            }
        }
        begin = end;
    }
    let n = patch.len();
    let mut laplacian = vec![0.0; n * n];
    for (i, &s) in patch.iter().enumerate() {
        let away = slit.outgoing(s).map(|h| (h, slit.tip(h)));
        let back = sectors.roads(s).filter(|road| road.sign < 0);
        for (h, to) in away.chain(back.map(|road| (road.halfedge, road.to))) {
            let weight = edge_weight(slit, cotangent, h);
            laplacian[i * n + i] += weight;
            if let Some(&j) = number.get(&to) {
                laplacian[i * n + j] -= weight;
            }
        }
    }
    let mut change = vec![0.0; n];
    for (i, sign) in [(0, 1.0), (1, -1.0)] {
        if !sectors.is_free(patch[i]) {
            change[i] = sign * std::f64::consts::FRAC_PI_2;
        }
    }
    solve_spd(&laplacian, &mut change).ok()?;
    let weighted: Vec<_> = patch.iter().zip(&change).map(|(&v, w)| (v, w * area[v])).collect();
    let square: f64 = weighted.iter().zip(&change).map(|((_, a), w)| a * w).sum();
    (square > 0.0).then_some(PatchResponse { weighted, square })
}
