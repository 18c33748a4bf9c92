//! Names that hold for the polygons after them.

use seamstress_mesh::attributes::{Attribute, AttributeDomain};
use std::collections::HashMap;

/// Numbers names in the order in which they come, and keeps the one that holds.
#[derive(Default)]
pub(crate) struct Labels {
    numbers: HashMap<Vec<u8>, u32>,
    names: Vec<String>,
    current: Option<u32>,
    of_polygons: Vec<Option<u32>>,
}

impl Labels {
    /// Polygons from here on have a name.
    pub(crate) fn set(&mut self, name: &[u8]) {
        let next = self.names.len() as u32;
        let number = *self.numbers.entry(name.to_vec()).or_insert_with(|| {
            self.names.push(String::from_utf8_lossy(name).into_owned());
            next
        });
        self.current = Some(number);
    }

    /// Polygons from here on have no name, as those before the first.
    pub(crate) fn unset(&mut self) {
        self.current = None;
    }

    /// Another polygon.
    pub(crate) fn push(&mut self) {
        self.of_polygons.push(self.current);
    }

    /// The name of each polygon, empty where there is none; nothing if there are no names at all.
    pub(crate) fn finish(mut self, name: &str) -> Option<Attribute> {
        if self.names.is_empty() {
            return None;
        }
        let nameless = self.names.len() as u32;
        if self.of_polygons.contains(&None) {
            self.names.push(String::new());
        }
        let rows = self.of_polygons.into_iter().map(|number| number.unwrap_or(nameless)).collect();
        Some(Attribute::labels(name, AttributeDomain::Face, self.names, rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_numbered_and_may_be_missing() {
        let mut labels = Labels::default();
        labels.push();
        for name in ["red", "blue", "red"] {
            labels.set(name.as_bytes());
            labels.push();
        }
        let found = labels.finish("material").unwrap();
        assert_eq!(found.names, ["red", "blue", ""]);
        assert_eq!(found.rows, [2, 0, 1, 0]);
        let mut none = Labels::default();
        none.push();
        assert_eq!(none.finish("material"), None);
    }
}
