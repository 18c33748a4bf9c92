//! Charts as rectangles in a square.

use super::charts::Charts;
use super::{bounds, triangle};
use crunch::{Item, Rect, Rotation, pack};

/// How often the scale is halved before it is said that there is no room.
const HALVINGS: i32 = 40;
/// How often the step to a larger scale is halved: then it is a 4000th.
const STEPS: usize = 12;

/// Charts in the unit square.
pub(super) struct Placed {
    pub(super) corner_uvs: Vec<[f64; 2]>,
    /// Texels per unit.
    pub(super) density: f64,
}

/// Charts at the largest scale found at which they fit, by their rectangles, whose sides are whole texels.
pub(super) fn place(
    charts: &Charts,
    corner_uvs: &[[f64; 2]],
    texels: u32,
    margin: u32,
) -> Option<Placed> {
    let boxes: Vec<[[f64; 2]; 2]> = charts
        .faces
        .iter()
        .map(|faces| bounds(faces.iter().flat_map(|&f| triangle(corner_uvs, f))))
        .collect();
    // Each rectangle has its margin on the right and above, the square on the left and below.
    let room = texels.checked_sub(margin)?;
    let sides = |scale: f64, i: usize| {
        let [low, high] = boxes[i];
        [0, 1].map(|k| ((high[k] - low[k]) * scale).ceil() as usize + margin as usize)
    };
    let fit = |scale: f64| {
        let items = (0..boxes.len()).map(|i| {
            let [width, height] = sides(scale, i);
            Item::new(i, width, height, Rotation::Allowed)
        });
        pack(Rect::of_size(room as usize, room as usize), items).ok()
    };
    let longest = boxes.iter().flat_map(|[low, high]| [high[0] - low[0], high[1] - low[1]]);
    let most = room.checked_sub(margin).filter(|&texels| texels > 0)?;
    let largest = f64::from(most) / longest.fold(0.0, f64::max);
    let (mut scale, mut packed) = (0..HALVINGS)
        .map(|k| largest * 0.5f64.powi(k))
        .find_map(|scale| Some((scale, fit(scale)?)))?;
    let mut step = scale;
    for _ in 0..STEPS {
        step *= 0.5;
        if let Some(larger) = fit(scale + step) {
            (scale, packed) = (scale + step, larger);
        }
    }
    let mut placed = vec![[0.0; 2]; corner_uvs.len()];
    for item in &packed {
        let [low, high] = boxes[item.data];
        let is_turned = item.rect.w != sides(scale, item.data)[0];
        let corner = [item.rect.x, item.rect.y].map(|x| x as f64 + f64::from(margin));
        for h in charts.faces[item.data].iter().flat_map(|f| f.halfedges()) {
            let [u, v] = corner_uvs[h.at()];
            let at = match is_turned {
                true => [high[1] - v, u - low[0]],
                false => [u - low[0], v - low[1]],
            };
            placed[h.at()] = [0, 1].map(|k| (at[k] * scale + corner[k]) / f64::from(texels));
        }
    }
    Some(Placed { corner_uvs: placed, density: scale })
}
