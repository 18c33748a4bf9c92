//! Writing maps as text.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;
use std::io::{self, Write};

/// A triangle mesh with a map: texture coordinates per corner.
#[derive(Clone, Copy, Debug)]
pub struct MapObj<'a> {
    /// One point per vertex.
    pub positions: &'a [[f64; 3]],
    /// The triangles.
    pub faces: &'a [[u32; 3]],
    /// One point of the map per corner: three per face, in the order of its vertices.
    pub corner_uvs: &'a [[f64; 2]],
    /// Comments for the start of the file.
    pub comments: &'a [String],
}

/// Writes a map as OBJ: `v`, `vt` and `f v/vt v/vt v/vt`, vertices and faces in the order given.
///
/// Corners of a vertex with bit-equal map coordinates share a `vt`. Every number is written with the
/// digits (at most 17) that give back the same double.
///
/// # Errors
/// Of the writer; and [`io::ErrorKind::InvalidInput`], before anything is written, if the corners are
/// not three per face, a face names no vertex or a number is not finite.
pub fn write_map_obj(writer: &mut impl Write, map: &MapObj<'_>) -> io::Result<()> {
    check(map)?;
    for line in map.comments.iter().flat_map(|comment| comment.split(['\n', '\r'])) {
        writeln!(writer, "# {line}")?;
    }
    for &[x, y, z] in map.positions {
        writeln!(writer, "v {} {} {}", Number(x), Number(y), Number(z))?;
    }
    let mut known = HashMap::new();
    let mut corners = Vec::with_capacity(map.corner_uvs.len());
    for (&vertex, &uv) in map.faces.as_flattened().iter().zip(map.corner_uvs) {
        let next = known.len() + 1;
        let index = match known.entry((vertex, uv.map(f64::to_bits))) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                writeln!(writer, "vt {} {}", Number(uv[0]), Number(uv[1]))?;
                *entry.insert(next)
            }
        };
        corners.push(index);
    }
    for ([a, b, c], uv) in
        map.faces.iter().map(|face| face.map(|v| u64::from(v) + 1)).zip(corners.chunks_exact(3))
    {
        writeln!(writer, "f {a}/{} {b}/{} {c}/{}", uv[0], uv[1], uv[2])?;
    }
    Ok(())
}

fn check(map: &MapObj<'_>) -> io::Result<()> {
    let invalid = |message: String| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    if map.corner_uvs.len() != 3 * map.faces.len() {
        let (uvs, faces) = (map.corner_uvs.len(), map.faces.len());
        return invalid(format!("{uvs} corner coordinates for {faces} triangles"));
    }
    if let Some(face) =
        map.faces.iter().position(|face| face.iter().any(|&v| v as usize >= map.positions.len()))
    {
        return invalid(format!("face {face} names a vertex that does not exist"));
    }
    if let Some(vertex) =
        map.positions.iter().position(|point| !point.iter().all(|x| x.is_finite()))
    {
        return invalid(format!("the position of vertex {vertex} is not finite"));
    }
    if let Some(corner) = map.corner_uvs.iter().position(|uv| !uv.iter().all(|x| x.is_finite())) {
        return invalid(format!(
            "the map of face {}, corner {}, is not finite",
            corner / 3,
            corner % 3
        ));
    }
    Ok(())
}

/// Writes a number so that it reads back exactly: plain if short, with an exponent if tiny or huge.
pub(crate) struct Number(pub(crate) f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-5..1e17).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Format, parse_mesh};

    fn text(map: &MapObj<'_>) -> String {
        let mut bytes = Vec::new();
        write_map_obj(&mut bytes, map).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    const SQUARE: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    const FACES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    #[test]
    fn equal_coordinates_of_a_vertex_are_shared() {
        let corner_uvs = &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.5], [0.0, 0.0]];
        let comments = &["made by hand\nf 1 1 1".to_owned()];
        let map = MapObj { positions: &SQUARE, faces: &FACES, corner_uvs, comments };
        let expected = "# made by hand\n# f 1 1 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
            vt 0 0\nvt 1 0\nvt 1 1\nvt 1 1.5\nvt 0 0\nf 1/1 2/2 3/3\nf 1/1 3/4 4/5\n";
        assert_eq!(text(&map), expected);
    }

    #[test]
    fn maps_read_back_exactly() {
        let numbers = [
            0.1,
            -1.0 / 3.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            1e17,
            123_456_789.123_456_78,
            -0.0,
        ];
        let positions: Vec<[f64; 3]> = numbers.iter().map(|&x| [x, -x, x / 7.0]).collect();
        let corner_uvs: Vec<[f64; 2]> = (0..6).map(|i| [numbers[i], numbers[i + 2]]).collect();
        let map =
            MapObj { positions: &positions, faces: &FACES, corner_uvs: &corner_uvs, comments: &[] };
        let mesh = parse_mesh(text(&map).as_bytes(), Some(Format::Obj), "map").unwrap();
        let bits =
            |points: &[[f64; 3]]| points.iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(&mesh.positions), bits(&positions));
        assert_eq!(mesh.polygons.corners(), FACES.as_flattened());
        let uvs = mesh.corner_uvs.unwrap();
        let read: Vec<_> =
            uvs.corners.iter().map(|&i| uvs.coordinates[i as usize].map(f64::to_bits)).collect();
        assert_eq!(read, corner_uvs.iter().map(|uv| uv.map(f64::to_bits)).collect::<Vec<_>>());
    }

    #[test]
    fn impossible_maps_are_refused() {
        let uvs = [[0.0; 2]; 6];
        let good = MapObj { positions: &SQUARE, faces: &FACES, corner_uvs: &uvs, comments: &[] };
        let refused =
            |map: &MapObj<'_>| write_map_obj(&mut Vec::new(), map).unwrap_err().to_string();
        assert_eq!(
            refused(&MapObj { corner_uvs: &uvs[1..], ..good }),
            "5 corner coordinates for 2 triangles"
        );
        let face = refused(&MapObj { positions: &SQUARE[1..], ..good });
        assert_eq!(face, "face 1 names a vertex that does not exist");
        let mut broken = uvs;
        broken[4][1] = f64::NAN;
        assert_eq!(
            refused(&MapObj { corner_uvs: &broken, ..good }),
            "the map of face 1, corner 1, is not finite"
        );
        let far = [[f64::INFINITY; 3]; 4];
        assert_eq!(
            refused(&MapObj { positions: &far, ..good }),
            "the position of vertex 0 is not finite"
        );
    }
}
