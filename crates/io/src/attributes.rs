//! What a file says of its faces beside their corners.

use std::collections::BTreeMap;

/// Something that faces on the two sides of an edge may have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attribute {
    /// The material: `usemtl` of OBJ.
    Material,
    /// The group or object: `g` and `o` of OBJ.
    Group,
    /// The smoothing group: `s` of OBJ.
    Smoothing,
    /// Texture coordinates at the ends of the edge: `vt` of OBJ.
    Uvs,
}

/// Texture coordinates per polygon corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerUvs {
    /// The distinct `vt` entries of the file.
    pub coordinates: Vec<[f64; 2]>,
    /// One index into `coordinates` per corner, in the order of [`Polygons::corners`](crate::Polygons::corners).
    pub corners: Vec<u32>,
}

/// The attributes of all faces, of those formats that have them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceAttributes {
    /// For each polygon a number per name; empty if no polygon has one.
    pub(crate) materials: Vec<u32>,
    pub(crate) groups: Vec<u32>,
    pub(crate) smoothing: Vec<u32>,
    pub(crate) uvs: Option<CornerUvs>,
}

impl FaceAttributes {
    /// Whether the file says anything of an attribute.
    #[must_use]
    pub fn has(&self, attribute: Attribute) -> bool {
        match attribute {
            Attribute::Uvs => self.uvs.is_some(),
            labels => !self.labels(labels).is_empty(),
        }
    }

    /// The edges at which an attribute of polygons differs, the same that were read: each once, by its ends.
    #[must_use]
    pub fn borders<'a>(
        &self,
        polygons: impl IntoIterator<Item = &'a [u32]>,
        attribute: Attribute,
    ) -> Vec<[u32; 2]> {
        let labels = self.labels(attribute);
        let mut seen: BTreeMap<[u32; 2], Side> = BTreeMap::new();
        let mut borders = Vec::new();
        let mut corner = 0;
        for (polygon, vertices) in polygons.into_iter().enumerate() {
            for (k, &from) in vertices.iter().enumerate() {
                let next = (k + 1) % vertices.len();
                let to = vertices[next];
                let ends = [from.min(to), from.max(to)];
                let (at_from, at_to) = (self.uv(corner + k), self.uv(corner + next));
                let uvs = if from < to { [at_from, at_to] } else { [at_to, at_from] };
                let uvs = uvs.map(|uv| uv.filter(|_| attribute == Attribute::Uvs));
                let side = Side { label: labels.get(polygon).copied(), uvs };
                match seen.get(&ends) {
                    None => drop(seen.insert(ends, side)),
                    Some(other) => borders.extend((*other != side).then_some(ends)),
                }
            }
            corner += vertices.len();
        }
        borders.sort_unstable();
        borders.dedup();
        borders
    }

    fn labels(&self, attribute: Attribute) -> &[u32] {
        match attribute {
            Attribute::Material => &self.materials,
            Attribute::Group => &self.groups,
            Attribute::Smoothing => &self.smoothing,
            Attribute::Uvs => &[],
        }
    }

    fn uv(&self, corner: usize) -> Option<[f64; 2]> {
        let uvs = self.uvs.as_ref()?;
        uvs.coordinates.get(*uvs.corners.get(corner)? as usize).copied()
    }
}

/// What a polygon has at one of its sides.
#[derive(PartialEq)]
struct Side {
    label: Option<u32>,
    uvs: [Option<[f64; 2]>; 2],
}

/// Numbers names in the order in which they come, and keeps the one that holds.
#[derive(Default)]
pub(crate) struct Labels {
    names: BTreeMap<Vec<u8>, u32>,
    current: u32,
    of_polygons: Vec<u32>,
}

impl Labels {
    /// Polygons from here on have a name; those before the first have none.
    pub(crate) fn set(&mut self, name: Vec<u8>) {
        let number = self.names.len() as u32 + 1;
        self.current = *self.names.entry(name).or_insert(number);
    }

    /// Another polygon.
    pub(crate) fn push(&mut self) {
        self.of_polygons.push(self.current);
    }

    /// The number of each polygon; none if there are no names.
    pub(crate) fn finish(self) -> Vec<u32> {
        if self.names.is_empty() { Vec::new() } else { self.of_polygons }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Format, parse_mesh};

    /// A strip of three squares.
    fn strip(faces: &str) -> (FaceAttributes, Vec<Vec<u32>>) {
        let mut text = String::from("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 1 1\nvt 0.5 0.5\n");
        for x in 0..4 {
            text += &format!("v {x} 0 0\nv {x} 1 0\n");
        }
        let mut mesh = parse_mesh((text + faces).as_bytes(), Some(Format::Obj), "a").unwrap();
        let polygons = mesh.polygons.iter().map(<[u32]>::to_vec).collect();
        (mesh.take_attributes(), polygons)
    }

    fn borders(faces: &str, attribute: Attribute) -> Vec<[u32; 2]> {
        let (attributes, polygons) = strip(faces);
        attributes.borders(polygons.iter().map(Vec::as_slice), attribute)
    }

    #[test]
    fn names_part_faces() {
        let faces = "f 1 3 4 2\nusemtl red paint\ns 1\no box\nf 3 5 6 4\nusemtl red\ns off\ng lid\nf 5 7 8 6\n";
        let both = vec![[2, 3], [4, 5]];
        assert_eq!(borders(faces, Attribute::Material), both);
        assert_eq!(borders(faces, Attribute::Smoothing), both);
        assert_eq!(borders(faces, Attribute::Group), both);
        // The same name again is the same material, and `off` is the group 0.
        let faces = "usemtl a\ns 0\nf 1 3 4 2\ns off\nusemtl a\nf 3 5 6 4\nusemtl b\nf 5 7 8 6\n";
        assert_eq!(borders(faces, Attribute::Material), [[4, 5]]);
        assert!(borders(faces, Attribute::Smoothing).is_empty());
    }

    #[test]
    fn what_a_file_does_not_say_it_has_not() {
        let (attributes, _) = strip("usemtl a\nf 1 3 4 2\nf 3 5 6 4\n");
        let has = [Attribute::Material, Attribute::Group, Attribute::Smoothing, Attribute::Uvs];
        assert_eq!(has.map(|attribute| attributes.has(attribute)), [true, false, false, false]);
    }

    #[test]
    fn seams_are_where_coordinates_differ() {
        // Between the first two faces other entries with the same coordinates, at one end; then another coordinate.
        let faces = "f 1/1 3/2 4/3 2/4\nf 3/2 5/1 6/4 4/5\nf 5/1 7/2 8/3 6/6\n";
        assert_eq!(borders(faces, Attribute::Uvs), [[4, 5]]);
        assert!(borders(faces, Attribute::Material).is_empty());
    }
}
