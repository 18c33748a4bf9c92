//! All integer solutions of linear relations over the Gaussian integers.

use super::gauss::{Form, Gauss, Overflow, add_scaled, gcd, scaled};
use std::collections::{BTreeMap, BTreeSet};

/// The integer solutions of homogeneous relations: `X = B zeta`, one to one with `zeta` in `Z[i]^m`.
///
/// `B` comes from substitutions that are invertible over the Gaussian integers, so X is integral exactly
/// when zeta is.
#[derive(Debug, Clone)]
pub struct Lattice {
    rows: Vec<Form>,
    rank: usize,
    /// Each coordinate as a form in the variables X.
    coordinates: Vec<Form>,
}

impl Lattice {
    /// Solves `relation = 0` for all relations in `n` variables, with one of these pinned at zero.
    ///
    /// Relations are used up one by one: a variable with a unit coefficient is expressed by the others,
    /// the one that fills the others least first (Markowitz). A relation without a unit is divided by
    /// the divisor its coefficients share (a power of `1 + i` where cones of quarter turns meet);
    /// should none be a unit even then, variables are combined by Euclid's algorithm until one is.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn new(n: usize, relations: &[Form], pinned: Option<u32>) -> Result<Self, Overflow> {
        let mut elimination = Elimination::new(n, relations, pinned);
        while let Some((relation, pivot)) = elimination.next_pivot()? {
            elimination.eliminate(relation, pivot)?;
        }
        elimination.finish(n)
    }

    /// Number of variables X.
    pub fn n_variables(&self) -> usize {
        self.rows.len()
    }

    /// Number of free coordinates `m`.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Row of B: a variable as a form in the coordinates.
    pub fn row(&self, variable: usize) -> &Form {
        &self.rows[variable]
    }

    /// A coordinate as a form in the variables.
    pub fn coordinate(&self, k: usize) -> &Form {
        &self.coordinates[k]
    }

    /// `X = B zeta`.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn expand(&self, zeta: &[Gauss]) -> Result<Vec<Gauss>, Overflow> {
        let value = |row: &Form| {
            row.iter().try_fold(Gauss::ZERO, |sum, (&k, &c)| sum.plus(c.times(zeta[k as usize])?))
        };
        self.rows.iter().map(value).collect()
    }

    /// A form in the variables as one in the coordinates.
    ///
    /// # Errors
    /// [`Overflow`].
    pub fn pull_back(&self, form: &Form) -> Result<Form, Overflow> {
        let mut result = Form::new();
        for (&variable, &c) in form {
            add_scaled(&mut result, &self.rows[variable as usize], c)?;
        }
        Ok(result)
    }
}

/// A variable replaced by a form in others.
struct Substitution {
    variable: u32,
    value: Form,
}

struct Elimination {
    relations: Vec<Form>,
    /// Relations not used up.
    alive: BTreeSet<usize>,
    /// Relations each variable occurs in.
    occurrences: BTreeMap<u32, BTreeSet<usize>>,
    substitutions: Vec<Substitution>,
    /// Variables that Euclid's algorithm brought in, as forms in older ones.
    combined: BTreeMap<u32, Form>,
    n_variables: u32,
}

impl Elimination {
    fn new(n: usize, relations: &[Form], pinned: Option<u32>) -> Self {
        let mut this = Self {
            relations: relations.to_vec(),
            alive: (0..relations.len()).collect(),
            occurrences: BTreeMap::new(),
            substitutions: Vec::new(),
            combined: BTreeMap::new(),
            n_variables: n as u32,
        };
        if let Some(pinned) = pinned {
            for relation in &mut this.relations {
                relation.remove(&pinned);
            }
            this.substitutions.push(Substitution { variable: pinned, value: Form::new() });
        }
        for (k, relation) in this.relations.iter().enumerate() {
            for &variable in relation.keys() {
                this.occurrences.entry(variable).or_default().insert(k);
            }
        }
        this
    }

    /// The relation and unit coefficient to use next; divides and combines until there is one.
    fn next_pivot(&mut self) -> Result<Option<(usize, u32)>, Overflow> {
        loop {
            self.alive.retain(|&k| !self.relations[k].is_empty());
            if self.alive.is_empty() {
                return Ok(None);
            }
            if let Some(pivot) = self.cheapest_unit() {
                return Ok(Some(pivot));
            }
            if !self.divide()? {
                self.combine()?;
            }
        }
    }

    fn cheapest_unit(&self) -> Option<(usize, u32)> {
        let candidates = self.alive.iter().flat_map(|&k| {
            let relation = &self.relations[k];
            let units = relation.iter().filter(|(_, c)| c.is_unit());
            units
                .map(move |(&v, _)| ((relation.len() - 1) * (self.occurrences[&v].len() - 1), k, v))
        });
        candidates.min().map(|(_, k, v)| (k, v))
    }

    /// Divides every relation by its divisor; whether that changed any.
    fn divide(&mut self) -> Result<bool, Overflow> {
        let mut changed = false;
        for &k in &self.alive {
            let relation = &mut self.relations[k];
            let divisor = relation.values().try_fold(Gauss::ZERO, |d, &c| gcd(c, d))?;
            if divisor.norm() > 1 {
                for c in relation.values_mut() {
                    *c = c.nearest_quotient(divisor)?;
                }
                changed = true;
            }
        }
        Ok(changed)
    }

    /// One step of Euclid's algorithm on the first relation: with `a` its smallest coefficient, at `x`,
    /// and `b = q a + r` another, at `y`, the variable `x + q y` takes the place of `x`, which leaves the
    /// smaller `r` at `y`.
    fn combine(&mut self) -> Result<(), Overflow> {
        let Some(&k) = self.alive.first() else { return Ok(()) };
        let relation = &self.relations[k];
        let Some((&x, &a)) = relation.iter().min_by_key(|(_, c)| c.norm()) else { return Ok(()) };
        for (&y, &b) in relation.iter().filter(|(y, _)| **y != x) {
            let q = b.nearest_quotient(a)?;
            if q.times(a)? != b {
                let fresh = self.n_variables;
                self.n_variables += 1;
                self.combined.insert(fresh, Form::from([(x, Gauss::ONE), (y, q)]));
                let value = Form::from([(fresh, Gauss::ONE), (y, q.negated())]);
                return self.substitute(x, value);
            }
        }
        Ok(())
    }

    fn eliminate(&mut self, relation: usize, pivot: u32) -> Result<(), Overflow> {
        self.alive.remove(&relation);
        let mut form = std::mem::take(&mut self.relations[relation]);
        for variable in form.keys() {
            if let Some(uses) = self.occurrences.get_mut(variable) {
                uses.remove(&relation);
            }
        }
        let c = form.remove(&pivot).unwrap_or(Gauss::ONE);
        // The inverse of a unit is its conjugate.
        self.substitute(pivot, scaled(&form, c.conj().negated())?)
    }

    /// Replaces a variable in all relations.
    fn substitute(&mut self, variable: u32, value: Form) -> Result<(), Overflow> {
        for k in self.occurrences.remove(&variable).unwrap_or_default() {
            let relation = &mut self.relations[k];
            let Some(c) = relation.remove(&variable) else { continue };
            add_scaled(relation, &value, c)?;
            for v in value.keys() {
                let uses = self.occurrences.entry(*v).or_default();
                if self.relations[k].contains_key(v) {
                    uses.insert(k)
                } else {
                    uses.remove(&k)
                };
            }
        }
        self.substitutions.push(Substitution { variable, value });
        Ok(())
    }

    /// Resolves the substitutions, last first, and numbers the variables that are left.
    fn finish(self, n: usize) -> Result<Lattice, Overflow> {
        let replaced: BTreeSet<u32> = self.substitutions.iter().map(|s| s.variable).collect();
        let free: Vec<u32> = (0..self.n_variables).filter(|v| !replaced.contains(v)).collect();
        let mut resolved: BTreeMap<u32, Form> = BTreeMap::new();
        for (k, &v) in free.iter().enumerate() {
            resolved.insert(v, Form::from([(k as u32, Gauss::ONE)]));
        }
        for Substitution { variable, value } in self.substitutions.iter().rev() {
            let mut row = Form::new();
            for (v, &c) in value {
                // Values hold variables that were replaced later, or never.
                if let Some(known) = resolved.get(v) {
                    add_scaled(&mut row, known, c)?;
                }
            }
            resolved.insert(*variable, row);
        }
        let mut originals: BTreeMap<u32, Form> =
            (0..n as u32).map(|v| (v, Form::from([(v, Gauss::ONE)]))).collect();
        for (&fresh, form) in &self.combined {
            let mut original = Form::new();
            for (v, &c) in form {
                add_scaled(&mut original, &originals[v], c)?;
            }
            originals.insert(fresh, original);
        }
        Ok(Lattice {
            rows: (0..n as u32).map(|v| resolved.remove(&v).unwrap_or_default()).collect(),
            rank: free.len(),
            coordinates: free.iter().map(|v| originals[v].clone()).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(terms: &[(u32, i64, i64)]) -> Form {
        terms.iter().map(|&(v, re, im)| (v, Gauss { re, im })).collect()
    }

    fn value(form: &Form, x: &[Gauss]) -> Gauss {
        let term = |s: Gauss, (&v, &c): (&u32, &Gauss)| s.plus(c.times(x[v as usize]).unwrap());
        form.iter().fold(Gauss::ZERO, |s, t| term(s, t).unwrap())
    }

    /// Every integer point in a box satisfies the relations exactly when it is `B zeta` for the zeta
    /// read from it.
    fn check(n: usize, relations: &[Form], pinned: Option<u32>) -> Lattice {
        let lattice = Lattice::new(n, relations, pinned).unwrap();
        let side = 2i64;
        let values: Vec<Gauss> =
            (-side..=side).flat_map(|re| (-side..=side).map(move |im| Gauss { re, im })).collect();
        let (mut solutions, total) = (0, values.len().pow(n as u32));
        for code in 0..total {
            let x: Vec<Gauss> =
                (0..n).map(|k| values[code / values.len().pow(k as u32) % values.len()]).collect();
            let solves = relations.iter().all(|r| value(r, &x) == Gauss::ZERO)
                && pinned.is_none_or(|p| x[p as usize] == Gauss::ZERO);
            let zeta: Vec<Gauss> =
                (0..lattice.rank()).map(|k| value(lattice.coordinate(k), &x)).collect();
            assert_eq!(lattice.expand(&zeta).unwrap() == x, solves, "{x:?}");
            solutions += usize::from(solves);
        }
        assert!(solutions > 1, "the box holds too few solutions to tell");
        lattice
    }

    #[test]
    fn unit_pivots() {
        // x0 = i x1 + x2
        assert_eq!(check(3, &[form(&[(0, -1, 0), (1, 0, 1), (2, 1, 0)])], None).rank(), 2);
    }

    #[test]
    fn common_divisors_are_divided_out() {
        // (1 + i) x0 + 2 x1 = 0 is x0 + (1 - i) x1 = 0
        assert_eq!(check(2, &[form(&[(0, 1, 1), (1, 2, 0)])], None).rank(), 1);
    }

    #[test]
    fn euclid_finds_a_unit() {
        let relation = form(&[(0, 2, 0), (1, 2, 1), (2, 3, 0)]);
        assert_eq!(check(3, &[relation], None).rank(), 2);
    }

    #[test]
    fn pinned_variables_are_zero() {
        let relations =
            [form(&[(0, 1, 0), (1, 1, -1), (2, 0, 1)]), form(&[(1, 0, 2), (2, -1, -1)])];
        assert_eq!(check(3, &relations, Some(0)).rank(), 1);
    }

    #[test]
    fn no_relations_leave_everything_free() {
        assert_eq!(check(2, &[], None).rank(), 2);
        assert_eq!(Lattice::new(0, &[], None).unwrap().rank(), 0);
    }
}
