//! What a file says, by the checker's own reader, and a map against the mesh it was made from.

use crate::verdict::Violation;

/// The polygons of `N` corners in the text of an OBJ file, and their texture coordinates. Decimals are read as the nearest
/// doubles. Whether the elements that are named are there is for others to say.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Obj<const N: usize> {
    /// The places of vertices.
    pub positions: Vec<[f64; 3]>,
    /// Texture coordinates.
    pub uvs: Vec<[f64; 2]>,
    /// The vertices of each polygon.
    pub faces: Vec<[u32; N]>,
    /// The texture coordinates at the corners of each polygon that has one at every corner.
    pub face_uvs: Vec<[u32; N]>,
}

impl<const N: usize> Obj<N> {
    /// Reads a text.
    ///
    /// # Errors
    /// The line, from 1, of a vertex or texture coordinate without numbers, or of a polygon with another number of corners or
    /// a corner that is no index.
    pub fn read(text: &str) -> Result<Self, usize> {
        let (mut file, mut words) = (Self::default(), Vec::new());
        let text = text.trim_start_matches('\u{feff}').replace("\r\n", "\n");
        for (number, line) in (1usize..).zip(text.split(['\n', '\r'])) {
            let line = line.split('#').next().unwrap_or(line).trim_ascii_end();
            words.extend(line.trim_end_matches('\\').split_ascii_whitespace());
            // A backslash joins a line with the next one.
            if !line.ends_with('\\') {
                file.statement(&words).ok_or(number)?;
                words.clear();
            }
        }
        Ok(file)
    }

    fn statement(&mut self, words: &[&str]) -> Option<()> {
        match *words {
            ["v", ref place @ ..] => self.positions.push(numbers(place)?),
            ["vt", u] => self.uvs.push(numbers(&[u, "0"])?),
            ["vt", ref uv @ ..] => self.uvs.push(numbers(uv)?),
            ["f" | "fo", ref corners @ ..] => {
                self.faces.push(indices(corners, 0, self.positions.len())?);
                self.face_uvs.extend(indices(corners, 1, self.uvs.len()));
            }
            _ => {}
        }
        Some(())
    }
}

/// The first words as numbers.
fn numbers<const N: usize>(words: &[&str]) -> Option<[f64; N]> {
    let numbers = words.get(..N)?.iter().map(|word| word.parse().ok());
    numbers.collect::<Option<Vec<_>>>()?.try_into().ok()
}

/// The indices in a part of each corner, `v/vt/vn`, of which there are so many before if they count back.
fn indices<const N: usize>(corners: &[&str], part: usize, before: usize) -> Option<[u32; N]> {
    let index = |corner: &&str| {
        let given: i64 = corner.split('/').nth(part)?.parse().ok()?;
        u32::try_from(if given < 0 { before as i64 + given } else { given - 1 }).ok()
    };
    corners.iter().map(index).collect::<Option<Vec<_>>>()?.try_into().ok()
}

/// Places of vertices, and the vertices of faces.
pub type Triangles<'a> = (&'a [[f64; 3]], &'a [[u32; 3]]);

/// Compares a map's vertices and faces with its source; a map must not touch them.
///
/// Positions have to agree exactly: they are written with enough digits.
pub fn compare_source(source: Triangles<'_>, map: Triangles<'_>) -> Vec<Violation> {
    let differ = |of_source: usize, map| (of_source != map).then_some((of_source, map));
    let vertices = differ(source.0.len(), map.0.len())
        .map(|(source_count, map)| Violation::VertexCount { source_count, map });
    let faces = differ(source.1.len(), map.1.len())
        .map(|(source_count, map)| Violation::FaceCount { source_count, map });
    let mut found: Vec<_> = vertices.into_iter().chain(faces).collect();
    if found.is_empty() {
        let moved = (0..).zip(source.0.iter().zip(map.0)).filter(|(_, (a, b))| a != b);
        found.extend(moved.map(|(vertex, (a, b))| {
            let distance = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            Violation::MovedVertex { vertex, distance }
        }));
        let changed = (0..).zip(source.1.iter().zip(map.1)).filter(|(_, (a, b))| a != b);
        found.extend(changed.map(|(face, _)| Violation::ChangedFace { face }));
    }
    found
}
