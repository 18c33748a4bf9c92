//! Properties of PLY as attributes: single numbers, and those that belong together by their names.

use crate::ply_header::{Kind, Property, Scalar};
use seamstress_mesh::attributes::{Attribute, AttributeDomain, AttributeKind};

/// Properties that are one attribute, its kind, and how many of them it needs.
const GROUPS: [(AttributeKind, &[&str], usize); 8] = [
    (AttributeKind::Color, &["red", "green", "blue", "alpha"], 3),
    (AttributeKind::Color, &["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"], 3),
    (AttributeKind::Color, &["r", "g", "b", "a"], 3),
    (AttributeKind::Normal, &["nx", "ny", "nz"], 3),
    (AttributeKind::Uv, &["s", "t"], 2),
    (AttributeKind::Uv, &["u", "v"], 2),
    (AttributeKind::Uv, &["texture_u", "texture_v"], 2),
    (AttributeKind::Uv, &["texture_s", "texture_t"], 2),
];

/// The single numbers of the elements of a kind: those properties that are no list and not taken otherwise.
pub(crate) struct Table {
    columns: Vec<(String, Scalar)>,
    values: Vec<f64>,
}

impl Table {
    pub(crate) fn new(properties: &[Property], is_taken: impl Fn(&str) -> bool) -> Self {
        let column = |property: &Property| match property.kind {
            Kind::Scalar(scalar) if !is_taken(&property.name) => {
                Some((property.name.clone(), scalar))
            }
            _ => None,
        };
        Self { columns: properties.iter().filter_map(column).collect(), values: Vec::new() }
    }

    /// Adds the next number, row by row.
    pub(crate) fn push(&mut self, value: f64) {
        self.values.push(value);
    }

    /// The attributes, and the names of those properties that are none, since not all numbers are finite.
    pub(crate) fn finish(self, domain: AttributeDomain) -> (Vec<Attribute>, Vec<String>) {
        let mut is_left: Vec<bool> = vec![true; self.columns.len()];
        let (mut attributes, mut ignored) = (Vec::new(), Vec::new());
        let mut take = |name: &str, kind, columns: Vec<usize>| match self
            .attribute(name, domain, kind, &columns)
        {
            Some(attribute) => attributes.push(attribute),
            None => ignored.extend(columns.iter().map(|&c| self.columns[c].0.clone())),
        };
        for (kind, names, least) in GROUPS {
            let place = |name: &&str| self.columns.iter().position(|column| column.0 == *name);
            let places: Vec<usize> = names.iter().map_while(place).collect();
            if places.len() >= least && places.iter().all(|&c| is_left[c]) {
                places.iter().for_each(|&c| is_left[c] = false);
                take(default_name(kind), kind, places);
            }
        }
        for column in (0..self.columns.len()).filter(|&c| is_left[c]) {
            let (name, scalar) = &self.columns[column];
            let kind = match scalar.is_integer() {
                true => AttributeKind::Label,
                false => AttributeKind::Number,
            };
            take(name, kind, vec![column]);
        }
        (attributes, ignored)
    }

    fn attribute(
        &self,
        name: &str,
        domain: AttributeDomain,
        kind: AttributeKind,
        columns: &[usize],
    ) -> Option<Attribute> {
        let scale = |column: usize| match (kind, self.columns[column].1) {
            (AttributeKind::Color, Scalar::U16) => f64::from(u16::MAX),
            (AttributeKind::Color, scalar) if scalar.is_integer() => f64::from(u8::MAX),
            _ => 1.0,
        };
        let rows = self.values.chunks_exact(self.columns.len());
        let values = rows.flat_map(|row| columns.iter().map(|&c| row[c] / scale(c)));
        let values: Vec<f64> = values.collect();
        if !values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let attribute = Attribute::new(name, domain, kind, columns.len(), Vec::new());
        Some(match kind {
            // Equal whole numbers are one label.
            AttributeKind::Label => attribute.with_values(domain, &values),
            _ => Attribute::new(name, domain, kind, columns.len(), values),
        })
    }
}

/// What an attribute is called that has no name of its own.
pub(crate) fn default_name(kind: AttributeKind) -> &'static str {
    match kind {
        AttributeKind::Uv => "uv",
        AttributeKind::Normal => "normal",
        AttributeKind::Color => "color",
        _ => "value",
    }
}
