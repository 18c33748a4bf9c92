//! The subspace of a linear space in which given edges lie along the axes.

use super::space::LinearSpace;
use std::collections::BTreeMap;

/// An edge both ends of which have the same coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Level {
    /// Wedges of its ends.
    pub ends: [u32; 2],
    /// The coordinate they share: 0 for u, 1 for v.
    pub coordinate: u32,
}

/// Linear form in the unknowns.
type LinearForm = BTreeMap<u32, f64>;

/// Coefficients below this are rounding errors of zero: the exact ones are sums of dyadic fractions.
const ZERO: f64 = 1e-11;

/// The part of a space in which all given edges are level.
///
/// Most conditions say that two unknowns are equal up to sign: a signed union-find settles them, so that
/// the wedges along an isoline share one number. Conditions across chains and at nodes have more terms and
/// are eliminated one by one.
pub fn leveled(space: &LinearSpace, levels: &[Level]) -> LinearSpace {
    let mut equalities = Equalities::new(space.n_unknowns());
    let mut conditions: Vec<LinearForm> =
        levels.iter().map(|level| condition(space, level)).collect();
    loop {
        let before = conditions.len();
        conditions.retain_mut(|form| {
            *form = equalities.reduce(form);
            !equalities.absorb(form)
        });
        if conditions.len() == before {
            break;
        }
    }
    let solved = eliminate(conditions, uses(space, &mut equalities));
    let row = |row: usize| {
        let mut form = equalities.reduce(&form_of(space, row));
        substitute(&mut form, &solved);
        form
    };
    let rows: Vec<LinearForm> = (0..2 * space.n_wedges()).map(row).collect();
    renumber(space, &rows)
}

/// The form that vanishes for a level edge.
fn condition(space: &LinearSpace, level: &Level) -> LinearForm {
    let [a, b] = level.ends.map(|w| form_of(space, (2 * w + level.coordinate) as usize));
    let mut form = b;
    add_scaled(&mut form, &a, -1.0);
    form
}

fn form_of(space: &LinearSpace, row: usize) -> LinearForm {
    let (columns, coefficients) = space.row(row);
    columns.iter().copied().zip(coefficients.iter().copied()).collect()
}

fn add_term(form: &mut LinearForm, unknown: u32, c: f64) {
    let sum = form.entry(unknown).or_default();
    *sum += c;
    if sum.abs() < ZERO {
        form.remove(&unknown);
    }
}

fn add_scaled(form: &mut LinearForm, other: &LinearForm, factor: f64) {
    for (&unknown, &c) in other {
        add_term(form, unknown, factor * c);
    }
}

/// Unknowns known to be equal up to sign, or zero.
struct Equalities {
    /// Another unknown it equals up to sign, or itself; and the sign.
    parent: Vec<(u32, f64)>,
    is_zero: Vec<bool>,
}

impl Equalities {
    fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).map(|x| (x, 1.0)).collect(), is_zero: vec![false; n] }
    }

    /// Representative of an unknown, and the sign between them.
    fn find(&mut self, mut x: u32) -> (u32, f64) {
        let mut sign = 1.0;
        loop {
            let (up, s) = self.parent[x as usize];
            if up == x {
                return (x, sign);
            }
            // Halve the path.
            let (above, t) = self.parent[up as usize];
            self.parent[x as usize] = (above, s * t);
            (x, sign) = (above, sign * s * t);
        }
    }

    /// A form in representatives that are not zero.
    fn reduce(&mut self, form: &LinearForm) -> LinearForm {
        let mut reduced = LinearForm::new();
        for (&x, &c) in form {
            let (root, sign) = self.find(x);
            if !self.is_zero[root as usize] {
                add_term(&mut reduced, root, sign * c);
            }
        }
        reduced
    }

    /// Takes a condition in if it says no more than that two unknowns are equal up to sign or one is zero;
    /// whether it did.
    fn absorb(&mut self, reduced: &LinearForm) -> bool {
        let terms: Vec<_> = reduced.iter().map(|(&x, &c)| (x, c)).collect();
        match terms[..] {
            [] => true,
            [(x, _)] => {
                self.is_zero[x as usize] = true;
                true
            }
            [(x, c), (y, d)] if (c.abs() - d.abs()).abs() < ZERO => {
                // c x + d y = 0; the larger id hangs on the smaller.
                self.parent[y as usize] = (x, -(c * d).signum());
                true
            }
            _ => false,
        }
    }
}

/// How many coordinates depend on each representative.
fn uses(space: &LinearSpace, equalities: &mut Equalities) -> Vec<u32> {
    let mut uses = vec![0; space.n_unknowns()];
    for row in 0..2 * space.n_wedges() {
        for &x in space.row(row).0 {
            uses[equalities.find(x).0 as usize] += 1;
        }
    }
    uses
}

/// Solves conditions for one unknown each; the solutions hold none of these.
///
/// Each step takes the condition and the unknown that add the fewest terms to the coordinates (Markowitz),
/// among the unknowns with the largest coefficient, which keeps the coefficients exact.
fn eliminate(mut open: Vec<LinearForm>, mut uses: Vec<u32>) -> BTreeMap<u32, LinearForm> {
    let mut solved: Vec<(u32, LinearForm)> = Vec::new();
    let price = |form: &LinearForm, uses: &[u32]| {
        let largest = form.values().fold(0.0f64, |m, c| m.max(c.abs()));
        let large = form.iter().filter(|(_, c)| c.abs() > largest - ZERO);
        let (used, pivot) = large.map(|(&x, _)| (uses[x as usize], x)).min()?;
        Some((used as usize * (form.len() - 1), pivot))
    };
    while let Some((k, pivot)) = open
        .iter()
        .enumerate()
        .filter_map(|(k, form)| price(form, &uses).map(|(price, pivot)| (price, k, pivot)))
        .min()
        .map(|(_, k, pivot)| (k, pivot))
    {
        let mut form = open.swap_remove(k);
        let Some(c) = form.remove(&pivot) else { continue };
        let mut value = LinearForm::new();
        add_scaled(&mut value, &form, -1.0 / c);
        for other in &mut open {
            if let Some(c) = other.remove(&pivot) {
                add_scaled(other, &value, c);
            }
        }
        value.keys().for_each(|&x| uses[x as usize] += uses[pivot as usize]);
        solved.push((pivot, value));
    }
    // Later solutions hold no earlier pivot, so resolving backwards takes one pass.
    let mut resolved = BTreeMap::new();
    for (pivot, mut value) in solved.into_iter().rev() {
        substitute(&mut value, &resolved);
        resolved.insert(pivot, value);
    }
    resolved
}

/// Replaces solved unknowns until none is left.
fn substitute(form: &mut LinearForm, solved: &BTreeMap<u32, LinearForm>) {
    if solved.is_empty() {
        return;
    }
    while let Some(unknown) = form.keys().copied().find(|x| solved.contains_key(x)) {
        if let Some(c) = form.remove(&unknown) {
            add_scaled(form, &solved[&unknown], c);
        }
    }
}

/// Numbers the unknowns that are left, in order, and their nodes.
fn renumber(space: &LinearSpace, rows: &[LinearForm]) -> LinearSpace {
    let mut number = vec![u32::MAX; space.n_unknowns()];
    rows.iter().flat_map(LinearForm::keys).for_each(|&x| number[x as usize] = 0);
    let mut nodes: Vec<u32> = Vec::new();
    let mut last = None;
    for (x, id) in number.iter_mut().enumerate().filter(|(_, id)| **id == 0) {
        *id = nodes.len() as u32;
        let node = space.nodes()[x];
        let here = nodes.last().map_or(0, |&n| if last == Some(node) { n } else { n + 1 });
        nodes.push(here);
        last = Some(node);
    }
    let renamed = |row: &LinearForm| row.iter().map(|(&x, &c)| (number[x as usize], c)).collect();
    LinearSpace::from_rows(nodes, rows.iter().map(renamed))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(a: u32, b: u32, coordinate: u32) -> Level {
        Level { ends: [a, b], coordinate }
    }

    #[test]
    fn wedges_along_an_isoline_share_one_number() {
        let space =
            leveled(&LinearSpace::free(4), &[level(0, 1, 1), level(1, 2, 1), level(2, 3, 0)]);
        assert_eq!(space.n_unknowns(), 5);
        assert_eq!(space.nodes(), [0, 0, 1, 2, 3]);
        let z = space.expand(&[0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!((z[0].im, z[1].im, z[2].im), (0.2, 0.2, 0.2));
        assert_eq!((z[2].re, z[3].re), (0.4, 0.4));
        assert_eq!((z[0].re, z[1].re, z[3].im), (0.1, 0.3, 0.5));
    }

    #[test]
    fn longer_conditions_are_eliminated_exactly() {
        // Three wedges of which the second is half the first plus the third, the last zero.
        let rows = [
            vec![(0, 1.0)],
            vec![(1, 1.0)],
            vec![(0, 0.5), (2, 1.0)],
            vec![(3, -1.0)],
            vec![],
            vec![(2, 1.0), (3, 1.0)],
        ];
        let nodes = vec![0, 0, 1, 1];
        let space = LinearSpace::from_rows(nodes, rows.into_iter());
        let conditions = [level(0, 1, 0), level(1, 2, 1), level(1, 0, 1)];
        let leveled = leveled(&space, &conditions);
        // u0 = u0 / 2 + x2, -x3 = x2 + x3, -x3 = x1
        let y: Vec<f64> = (0..leveled.n_unknowns()).map(|k| 1.0 + k as f64).collect();
        let z = leveled.expand(&y);
        assert_eq!(leveled.n_unknowns(), 1);
        assert_eq!(z[0].re, z[1].re);
        assert_eq!((z[1].im, z[0].im), (z[2].im, z[1].im));
        assert!(z.iter().any(|z| z.norm() > 0.1));
    }

    #[test]
    fn contradictions_leave_zero() {
        // u0 = u1 and u0 = -u1
        let rows = [vec![(0, 1.0)], vec![], vec![(1, 1.0)], vec![], vec![(1, -1.0)], vec![]];
        let space = LinearSpace::from_rows(vec![0, 1], rows.into_iter());
        let leveled = leveled(&space, &[level(0, 1, 0), level(0, 2, 0)]);
        assert_eq!(leveled.n_unknowns(), 0);
    }
}
