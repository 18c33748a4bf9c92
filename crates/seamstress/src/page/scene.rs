//! What a page draws, packed small: polygons in the order of a [walk](super::walk), with numbers that are quantised and
//! predicted from their neighbours, in planes of bytes. `web/src/scene.ts` reads this back.

use super::walk::{Step, Walk, Wedges};
use serde::Serialize;

/// The largest quantised number.
const LEVELS: f64 = 65_535.0;
/// Stands for a value that is not finite.
const NOT_FINITE: u32 = 65_535;

/// What is drawn.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Drawing<'a> {
    /// Vertices of the polygons, and more that lines end at.
    pub(super) positions: &'a [[f64; 3]],
    /// Vertices of all polygons, one after the other.
    pub(super) corners: &'a [u32],
    /// Corners of a polygon: 3 or 4.
    pub(super) sides: usize,
    /// A UV for every corner.
    pub(super) corner_uvs: Option<&'a [[f64; 2]]>,
    /// A number for every polygon, larger than 0; infinite where it is flipped.
    pub(super) values: &'a [f64],
    /// Feature edges, by their ends.
    pub(super) features: &'a [[u32; 2]],
}

/// A drawing, packed.
#[derive(Debug, Clone)]
pub(super) struct Scene(Vec<u8>);

/// How to read the bytes.
#[derive(Serialize)]
struct Header {
    sides: usize,
    vertices: usize,
    positions: Grid<3>,
    uvs: Option<Grid<2>>,
    values: Option<[f64; 2]>,
    arrays: Vec<Array>,
}

/// The place of quantised points: `origin + step * number`.
#[derive(Serialize)]
struct Grid<const N: usize> {
    #[serde(serialize_with = "as_slice")]
    origin: [f64; N],
    step: f64,
}

fn as_slice<S: serde::Serializer, const N: usize>(
    numbers: &[f64; N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    numbers.as_slice().serialize(serializer)
}

/// Whole numbers in planes: first the lowest bytes of all, then the next.
#[derive(Serialize)]
struct Array {
    name: &'static str,
    length: usize,
    planes: usize,
}

impl Scene {
    pub(super) fn new(drawing: &Drawing) -> Self {
        let wedges = Wedges::new(drawing.corners, drawing.corner_uvs);
        let walk = Walk::new(&wedges.of_corners, drawing.sides);
        let mut packer = Packer::default();
        packer.pack("codes", walk.codes.iter().copied());
        packer.pack("faces", deltas(walk.faces.iter().copied()));
        let vertices: Vec<u32> =
            walk.steps.iter().map(|step| wedges.vertices[step.wedge]).collect();
        packer.pack("vertices", deltas(vertices.iter().copied()));
        let grid = Grid::new(drawing.positions);
        packer.pack_points("positions", &grid, &places(drawing.positions, &vertices, &walk.steps));
        let uvs = drawing.corner_uvs.map(|_| {
            let uvs: Vec<[f64; 2]> = walk.steps.iter().map(|step| wedges.uvs[step.wedge]).collect();
            let grid = Grid::new(&uvs);
            let places: Vec<_> = uvs
                .iter()
                .zip(&walk.steps)
                .map(|(&uv, step)| (uv, step.known.map(|k| k.map(|k| uvs[k]))))
                .collect();
            packer.pack_points("uvs", &grid, &places);
            grid
        });
        packer.pack("features", deltas(drawing.features.as_flattened().iter().copied()));
        let range = Range::new(drawing.values);
        if let Some(range) = &range {
            let values = walk.faces.iter().map(|&face| range.level(drawing.values[face as usize]));
            packer.pack("values", values);
        }
        let header = Header {
            sides: drawing.sides,
            vertices: drawing.positions.len(),
            positions: grid,
            uvs,
            values: range.map(|range| [range.low, range.high]),
            arrays: packer.arrays,
        };
        let header = serde_json::to_vec(&header).unwrap_or_default();
        let mut bytes = (header.len() as u32).to_le_bytes().to_vec();
        bytes.extend(header);
        bytes.extend(packer.bytes);
        Self(bytes)
    }

    /// The length of the header (32 bits, little-endian), the header as JSON, the arrays.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }
}

/// A point, and those that it is predicted from.
type Place<const N: usize> = ([f64; N], Option<[[f64; N]; 3]>);

/// The vertices in the order in which the walk first meets them, and then those that it does not meet.
fn places(positions: &[[f64; 3]], vertices: &[u32], steps: &[Step]) -> Vec<Place<3>> {
    let at = |vertex: u32| positions[vertex as usize];
    let mut is_met = vec![false; positions.len()];
    let mut places = Vec::with_capacity(positions.len());
    for (&vertex, step) in vertices.iter().zip(steps) {
        if !std::mem::replace(&mut is_met[vertex as usize], true) {
            places.push((at(vertex), step.known.map(|known| known.map(|k| at(vertices[k])))));
        }
    }
    let rest = (0..positions.len()).filter(|&vertex| !is_met[vertex]);
    places.extend(rest.map(|vertex| (positions[vertex], None)));
    places
}

/// The finite values, which are quantised by their logarithm.
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    fn new(values: &[f64]) -> Option<Self> {
        let finite = values.iter().copied().filter(|x| x.is_finite());
        let (low, high) = finite
            .fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), x| (low.min(x), high.max(x)));
        (!values.is_empty()).then_some(match low <= high && low > 0.0 {
            true => Self { low, high },
            false => Self { low: 1.0, high: 1.0 },
        })
    }

    fn level(&self, x: f64) -> u32 {
        if !x.is_finite() {
            return NOT_FINITE;
        }
        let share = (x / self.low).ln() / (self.high / self.low).ln();
        // An empty range has no share.
        (share.clamp(0.0, 1.0) * (LEVELS - 1.0)).round() as u32
    }
}

#[derive(Default)]
struct Packer {
    arrays: Vec<Array>,
    bytes: Vec<u8>,
}

impl Packer {
    fn pack(&mut self, name: &'static str, numbers: impl Iterator<Item = u32>) {
        let numbers: Vec<u32> = numbers.collect();
        let largest = numbers.iter().copied().max().unwrap_or_default();
        let planes = (4 - largest.leading_zeros() as usize / 8).max(1);
        for plane in 0..planes {
            self.bytes.extend(numbers.iter().map(|number| number.to_le_bytes()[plane]));
        }
        self.arrays.push(Array { name, length: numbers.len(), planes });
    }

    /// Points as differences to where they are expected, an array an axis: at the fourth corner of a parallelogram, or
    /// where the point before is.
    fn pack_points<const N: usize>(
        &mut self,
        name: &'static str,
        grid: &Grid<N>,
        places: &[Place<N>],
    ) {
        for k in 0..N {
            let level = |point: &[f64; N]| grid.level(point, k);
            let mut before = 0;
            let differences = places.iter().map(|(point, known)| {
                let expected = match known {
                    Some([a, b, c]) => level(a) + level(b) - level(c),
                    None => before,
                };
                before = level(point);
                signed(before - expected)
            });
            self.pack(name, differences);
        }
    }
}

impl<const N: usize> Grid<N> {
    /// The finest on which all points have places, the same along all axes.
    fn new(points: &[[f64; N]]) -> Self {
        let finite = || points.iter().filter(|point| point.iter().all(|x| x.is_finite()));
        let bound = |k: usize, start: f64, least: fn(f64, f64) -> f64| {
            finite().map(|point| point[k]).fold(start, least)
        };
        let origin: [f64; N] = std::array::from_fn(|k| bound(k, f64::INFINITY, f64::min));
        let origin = origin.map(|x| if x.is_finite() { x } else { 0.0 });
        let extents = (0..N).map(|k| bound(k, origin[k], f64::max) - origin[k]);
        let step = match extents.fold(0.0, f64::max) / LEVELS {
            step if step > 0.0 && step.is_finite() => step,
            _ => 1.0,
        };
        Self { origin, step }
    }

    fn level(&self, point: &[f64; N], k: usize) -> i32 {
        ((point[k] - self.origin[k]) / self.step).round().clamp(0.0, LEVELS) as i32
    }
}

/// Small numbers of either sign as small ones: 0, -1, 1, -2, 2 as 0, 1, 2, 3, 4.
fn signed(number: i32) -> u32 {
    ((number << 1) ^ (number >> 31)) as u32
}

/// Differences of neighbours.
fn deltas(numbers: impl Iterator<Item = u32>) -> impl Iterator<Item = u32> {
    numbers.scan(0u32, |before, number| {
        let delta = number.wrapping_sub(*before) as i32;
        *before = number;
        Some(signed(delta))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_of_either_sign_are_small() {
        let numbers: Vec<u32> = deltas([3, 2, 4, 4, 0, u32::MAX].into_iter()).collect();
        assert_eq!(numbers, [6, 1, 4, 0, 7, 1]);
    }

    #[test]
    fn the_ends_of_a_range_are_exact_levels() {
        let range = Range::new(&[1.5, f64::INFINITY, 6.0]).unwrap();
        assert_eq!([1.5, 3.0, 6.0, f64::NAN].map(|x| range.level(x)), [0, 32_767, 65_534, 65_535]);
        assert_eq!(Range::new(&[2.0; 4]).unwrap().level(2.0), 0);
        assert!(Range::new(&[]).is_none());
    }
}
