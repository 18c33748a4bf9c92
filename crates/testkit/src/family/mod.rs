//! A family of meshes of any kind, each made from its number: what a collection of strangers might hold.

mod organic;
mod parts;

use crate::{Rng, relabel};
use seamstress_mesh::soup::{Severity, TriangleSoup, check};

/// A way to make meshes from random numbers.
type Kind = (&'static str, fn(&mut Rng) -> TriangleSoup);

/// In the order of the numbers modulo their count.
const KINDS: [Kind; 10] = [
    ("turned", parts::turned),
    ("blob", organic::blob),
    ("plate", parts::plate),
    ("terrain", organic::terrain),
    ("lattice", organic::lattice),
    ("prism", parts::prism),
    ("scan", organic::scan),
    ("ring", parts::ring_shaped),
    ("frame", parts::frame),
    ("cast", organic::cast),
];
/// Tries of a kind until there is a mesh without defects.
const TRIES: usize = 100;

/// The mesh of a number, and its name: parts as drawing programs export them, with fillets, thin walls and holes; organic
/// blobs; scans with noise and holes; terrain; lattices of high genus; castings. About 50 to 9,000 triangles, an oriented
/// manifold of one or more components, the same in every run.
#[must_use]
pub fn family(number: u64) -> (String, TriangleSoup) {
    let (name, make) = KINDS[(number % KINDS.len() as u64) as usize];
    let mut rng = Rng::new(number);
    let is_mesh = |soup: &TriangleSoup| {
        let mut faults = check(soup).faults.into_iter();
        !soup.faces.is_empty() && faults.all(|fault| fault.severity() != Severity::Error)
    };
    let soup = (0..TRIES).map(|_| make(&mut rng)).find(is_mesh).unwrap();
    // Files have their triangles in any order; half of these too.
    let soup = if rng.below(2) == 0 { relabel(&soup, number) } else { soup };
    (format!("{name}_{number:03}"), soup)
}

/// A number between two.
fn between(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.unit()
}

/// A whole number of a range.
fn whole(rng: &mut Rng, low: u32, high: u32) -> u32 {
    low + rng.below((high - low + 1) as usize) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::sound;
    use std::collections::BTreeSet;

    #[test]
    fn members_are_meshes_of_moderate_size_and_all_different() {
        let (mut names, mut most_handles, mut open) = (BTreeSet::new(), 0, 0);
        for number in 0..60 {
            let (name, soup) = family(number);
            assert!((50..=9000).contains(&soup.faces.len()), "{name}: {}", soup.faces.len());
            let facts = sound(&soup);
            most_handles = most_handles.max(facts.genus().unwrap());
            open += usize::from(facts.boundary_loops() > 0);
            assert_eq!(family(number), (name.clone(), soup));
            names.insert(name);
        }
        assert_eq!(names.len(), 60);
        assert!(most_handles >= 10 && open >= 6, "{most_handles} handles, {open} open");
    }
}
