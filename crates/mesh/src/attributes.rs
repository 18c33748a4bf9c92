//! What a mesh carries beside its shape: values of its vertices, corners and faces.

use std::collections::{BTreeMap, HashMap};

/// All that a mesh carries.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Attributes {
    /// The attributes, those of one kind in the order of their importance.
    pub all: Vec<Attribute>,
    /// Files that describe the materials: `mtllib` of OBJ.
    pub material_files: Vec<String>,
}

impl From<Vec<Attribute>> for Attributes {
    fn from(all: Vec<Attribute>) -> Self {
        Self { all, material_files: Vec::new() }
    }
}

impl Attributes {
    /// Nothing.
    pub const NONE: &Self = &Self { all: Vec::new(), material_files: Vec::new() };

    /// The first of a kind that vertices or corners have, the second, and so on.
    pub fn of_kind(&self, kind: AttributeKind) -> impl Iterator<Item = &Attribute> {
        self.all.iter().filter(move |a| a.kind == kind && a.domain != AttributeDomain::Face)
    }

    /// The labels of faces with a name.
    pub fn labels(&self, name: &str) -> Option<&Attribute> {
        let is_label = |a: &&Attribute| {
            a.kind == AttributeKind::Label && a.domain == AttributeDomain::Face && a.name == name
        };
        self.all.iter().find(is_label)
    }
}

/// What has a value of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AttributeDomain {
    /// Every vertex.
    Vertex,
    /// Every corner of every polygon, in their order.
    Corner,
    /// Every polygon.
    Face,
}

/// What an attribute is, which says how its values are mixed and written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AttributeKind {
    /// Texture coordinates, v upwards.
    Uv,
    /// Unit normals.
    Normal,
    /// Colours from 0 to 1, with or without opacity.
    Color,
    /// Other numbers.
    Number,
    /// Names or whole numbers that stand for something, such as materials: never mixed.
    Label,
}

/// A table of values, and which of its rows each element has.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Attribute {
    /// Its name: `material`, `object`, `group` and `smoothing` for labels of faces, else as a file or a user calls it.
    pub name: String,
    /// What has its values.
    pub domain: AttributeDomain,
    /// What it is.
    pub kind: AttributeKind,
    /// Numbers in a row.
    pub width: usize,
    /// The rows, one after the other.
    pub values: Vec<f64>,
    /// The row of each element.
    pub rows: Vec<u32>,
    /// The name of each row, of labels that have names; empty for what has none.
    pub names: Vec<String>,
}

impl Attribute {
    /// Values with a row of `width` numbers for each element, in order.
    pub fn new(
        name: impl Into<String>,
        domain: AttributeDomain,
        kind: AttributeKind,
        width: usize,
        values: Vec<f64>,
    ) -> Self {
        let n_rows = values.len().checked_div(width).unwrap_or_default();
        let rows = (0..n_rows as u32).collect();
        Self { name: name.into(), domain, kind, width, values, rows, names: Vec::new() }
    }

    /// The same values with another row for each element.
    #[must_use]
    pub fn with_rows(self, rows: Vec<u32>) -> Self {
        Self { rows, ..self }
    }

    /// Labels: the name of each element by its number.
    pub fn labels(
        name: impl Into<String>,
        domain: AttributeDomain,
        names: Vec<String>,
        rows: Vec<u32>,
    ) -> Self {
        let kind = AttributeKind::Label;
        Self { name: name.into(), domain, kind, width: 0, values: Vec::new(), rows, names }
    }

    /// The values of an element.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn of(&self, element: usize) -> &[f64] {
        self.row(self.rows[element])
    }

    /// The values of a row.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: u32) -> &[f64] {
        &self.values[row as usize * self.width..][..self.width]
    }

    /// The number of rows.
    pub fn n_rows(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(self.names.len())
    }

    /// The same table for other elements, each with the values of an element of this one.
    ///
    /// # Panics
    /// If there is no such element.
    #[must_use]
    pub fn on(&self, domain: AttributeDomain, elements: impl Iterator<Item = usize>) -> Self {
        let rows = elements.map(|element| self.rows[element]).collect();
        Self { domain, rows, ..self.clone() }
    }

    /// The same for elements with values of their own, one row each, of which equal ones are kept once.
    #[must_use]
    pub fn with_values(&self, domain: AttributeDomain, values: &[f64]) -> Self {
        let mut known: HashMap<Vec<u64>, u32> = HashMap::new();
        let mut kept = Vec::new();
        let rows = values.chunks_exact(self.width.max(1)).map(|row| {
            let next = known.len() as u32;
            *known.entry(row.iter().map(|x| x.to_bits()).collect()).or_insert_with(|| {
                kept.extend_from_slice(row);
                next
            })
        });
        let rows = rows.collect();
        let (name, kind, width) = (self.name.clone(), self.kind, self.width);
        Self { name, domain, kind, width, values: kept, rows, names: Vec::new() }
    }

    /// One of corners as one of vertices, if all corners of a vertex have the same values; `corners` has their
    /// vertices. Vertices in no polygon get the first row.
    #[must_use]
    pub fn by_vertex(&self, corners: &[u32], n_vertices: usize) -> Option<Self> {
        let mut rows: Vec<Option<u32>> = vec![None; n_vertices];
        for (&row, &vertex) in self.rows.iter().zip(corners) {
            let first = *rows[vertex as usize].get_or_insert(row);
            if first != row && (self.width == 0 || self.row(first) != self.row(row)) {
                return None;
            }
        }
        let rows = rows.into_iter().map(Option::unwrap_or_default).collect();
        Some(Self { domain: AttributeDomain::Vertex, rows, ..self.clone() })
    }

    /// One of corners as one of vertices with the means of their corners; `corners` has their vertices.
    #[must_use]
    pub fn averaged(&self, corners: &[u32], n_vertices: usize) -> Self {
        let mut values = vec![0.0; n_vertices * self.width];
        let mut counts = vec![0u32; n_vertices];
        for (&row, &vertex) in self.rows.iter().zip(corners) {
            counts[vertex as usize] += 1;
            let sum = &mut values[vertex as usize * self.width..];
            sum.iter_mut().zip(self.row(row)).for_each(|(sum, x)| *sum += x);
        }
        for (row, &count) in values.chunks_exact_mut(self.width.max(1)).zip(&counts) {
            row.iter_mut().for_each(|x| *x /= f64::from(count.max(1)));
        }
        Self::new(self.name.clone(), AttributeDomain::Vertex, self.kind, self.width, values)
    }

    /// The edges of polygons at which it differs on both sides, each once, by its ends.
    #[must_use]
    pub fn borders<'a>(&self, polygons: impl IntoIterator<Item = &'a [u32]>) -> Vec<[u32; 2]> {
        let is_of_corners = self.domain == AttributeDomain::Corner;
        let mut seen: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
        let mut borders = Vec::new();
        let mut corner = 0;
        let is_same = |a: u32, b: u32| a == b || (self.width > 0 && self.row(a) == self.row(b));
        for (polygon, vertices) in polygons.into_iter().enumerate() {
            for (k, &from) in vertices.iter().enumerate() {
                let next = (k + 1) % vertices.len();
                let to = vertices[next];
                let ends = match is_of_corners {
                    true => [corner + k, corner + next],
                    false => [polygon, polygon],
                };
                let rows = ends.map(|element| self.rows[element]);
                let side = if from < to { rows } else { [rows[1], rows[0]] };
                let edge = [from.min(to), from.max(to)];
                let other = *seen.entry(edge).or_insert(side);
                if !(is_same(other[0], side[0]) && is_same(other[1], side[1])) {
                    borders.push(edge);
                }
            }
            corner += vertices.len();
        }
        borders.sort_unstable();
        borders.dedup();
        borders
    }

    /// Why it is none of a mesh with so many elements of its domain.
    ///
    /// # Errors
    /// In words.
    pub fn check(&self, n_elements: usize) -> Result<(), String> {
        let name = &self.name;
        if self.rows.len() != n_elements {
            let domain = match self.domain {
                AttributeDomain::Vertex => "vertices",
                AttributeDomain::Corner => "corners",
                AttributeDomain::Face => "faces",
            };
            let n = self.rows.len();
            return Err(format!("{name}: values for {n} {domain}; the mesh has {n_elements}"));
        }
        if self.width > 0 && !self.values.len().is_multiple_of(self.width) {
            let (n, width) = (self.values.len(), self.width);
            return Err(format!("{name}: {n} numbers are no rows of {width}"));
        }
        let n_rows = self.n_rows();
        if let Some(element) = self.rows.iter().position(|&row| row as usize >= n_rows) {
            let row = self.rows[element];
            return Err(format!("{name}: element {element} has row {row} of {n_rows}"));
        }
        match self.values.iter().position(|x| !x.is_finite()) {
            Some(at) => Err(format!("{name}: value {at} is not finite")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(values: &[f64]) -> Attribute {
        let (domain, kind) = (AttributeDomain::Corner, AttributeKind::Number);
        Attribute::new("weight", domain, kind, 1, values.to_vec())
    }

    #[test]
    fn equal_corners_are_values_of_vertices() {
        // Two triangles with the vertices 0, 1, 2 and 2, 1, 3.
        let vertices = [0, 1, 2, 2, 1, 3];
        let smooth = corners(&[5.0, 6.0, 7.0, 7.0, 6.0, 8.0]).by_vertex(&vertices, 5).unwrap();
        let of_vertices: Vec<f64> = (0..5).map(|v| smooth.of(v)[0]).collect();
        assert_eq!(of_vertices, [5.0, 6.0, 7.0, 8.0, 5.0]);
        assert_eq!(corners(&[5.0, 6.0, 7.0, 7.5, 6.0, 8.0]).by_vertex(&vertices, 4), None);
    }

    #[test]
    fn corners_may_be_averaged() {
        let mean = corners(&[5.0, 6.0, 7.0, 9.0, 6.0, 8.0]).averaged(&[0, 1, 2, 2, 1, 3], 5);
        assert_eq!(mean.values, [5.0, 6.0, 8.0, 8.0, 0.0]);
    }

    #[test]
    fn borders_are_where_values_differ() {
        // Three squares in a row.
        let squares: [&[u32]; 3] = [&[0, 2, 3, 1], &[2, 4, 5, 3], &[4, 6, 7, 5]];
        let names = ["red", "blue"].map(String::from).to_vec();
        let label = Attribute::labels("material", AttributeDomain::Face, names, vec![0, 1, 1]);
        assert_eq!(label.borders(squares), [[2, 3]]);
        // Between the first two other rows with equal values; then another value at one end.
        let values = [0.0, 1.0, 2.0, 3.0, 1.0, 7.0, 8.0, 2.0, 7.0, 9.0, 9.0, 5.0];
        assert_eq!(corners(&values).borders(squares), [[4, 5]]);
    }

    #[test]
    fn equal_values_are_kept_once() {
        let made = corners(&[0.0]).with_values(AttributeDomain::Vertex, &[3.0, 4.0, 3.0]);
        assert_eq!((made.values, made.rows), (vec![3.0, 4.0], vec![0, 1, 0]));
    }

    #[test]
    fn tables_that_do_not_fit_are_told() {
        let good = corners(&[1.0, 2.0, 3.0]);
        assert_eq!(good.check(3), Ok(()));
        let short = good.check(4).unwrap_err();
        assert_eq!(short, "weight: values for 3 corners; the mesh has 4");
        let far = Attribute { rows: vec![0, 1, 3], ..good.clone() };
        assert_eq!(far.check(3).unwrap_err(), "weight: element 2 has row 3 of 3");
        let broken = corners(&[1.0, f64::NAN, 3.0]);
        assert_eq!(broken.check(3).unwrap_err(), "weight: value 1 is not finite");
        let names = vec!["red".to_owned()];
        let label = Attribute::labels("material", AttributeDomain::Face, names, vec![0, 1]);
        assert_eq!(label.check(2).unwrap_err(), "material: element 1 has row 1 of 1");
    }
}
