//! Lattices of random relations: all integer solutions, each once.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

use proptest::prelude::*;
use seamstress_quantize::internals::{Form, Gauss, Lattice, add_scaled};
use seamstress_testkit::Rng;

/// A system whose integer solutions are known: the combinations of the first `rank` columns of a matrix
/// that has an integral inverse.
struct System {
    relations: Vec<Form>,
    /// Rows of that matrix.
    matrix: Vec<Vec<Gauss>>,
    rank: usize,
}

fn small(rng: &mut Rng, is_real: bool) -> Gauss {
    let part = |rng: &mut Rng| rng.below(5) as i64 - 2;
    let re = part(rng);
    Gauss { re, im: if is_real { 0 } else { part(rng) } }
}

fn plus(a: Gauss, b: Gauss) -> Gauss {
    a.plus(b).unwrap()
}

fn system(seed: u64, is_real: bool) -> System {
    let mut rng = Rng::new(seed);
    let n = 2 + rng.below(4);
    let rank = rng.below(n + 1);
    let identity = |i: usize| -> Vec<Gauss> {
        (0..n).map(|j| if i == j { Gauss::ONE } else { Gauss::ZERO }).collect()
    };
    let mut matrix: Vec<Vec<Gauss>> = (0..n).map(identity).collect();
    let mut inverse = matrix.clone();
    for _ in 0..n {
        // Adds a multiple of one column to another, and takes it from the rows of the inverse.
        let (from, to) = (rng.below(n), rng.below(n));
        let c = small(&mut rng, is_real);
        if from == to {
            continue;
        }
        for row in &mut matrix {
            row[to] = plus(row[to], c.times(row[from]).unwrap());
        }
        let added = inverse[to].clone();
        for (entry, x) in inverse[from].iter_mut().zip(added) {
            *entry = plus(*entry, c.negated().times(x).unwrap());
        }
    }
    // What must vanish are the other rows of the inverse; mixed, multiplied and with some to spare.
    let basis: Vec<Form> = inverse[rank..]
        .iter()
        .map(|row| {
            let terms = row.iter().enumerate().filter(|(_, c)| **c != Gauss::ZERO);
            terms.map(|(v, &c)| (v as u32, c)).collect()
        })
        .collect();
    let mut relations = Vec::new();
    for (k, row) in basis.iter().enumerate() {
        let factor = match small(&mut rng, is_real) {
            Gauss::ZERO => Gauss::ONE,
            factor => factor,
        };
        let mut relation = Form::new();
        add_scaled(&mut relation, row, factor).unwrap();
        // Earlier rows alone: the system stays of full rank.
        for earlier in &basis[..k] {
            add_scaled(&mut relation, earlier, small(&mut rng, is_real)).unwrap();
        }
        relations.push(relation);
    }
    if let Some(first) = relations.first().cloned() {
        let mut spare = relations[relations.len() - 1].clone();
        add_scaled(&mut spare, &first, small(&mut rng, is_real)).unwrap();
        relations.push(spare);
    }
    System { relations, matrix, rank }
}

fn value(form: &Form, x: &[Gauss]) -> Gauss {
    form.iter().fold(Gauss::ZERO, |sum, (&v, c)| plus(sum, c.times(x[v as usize]).unwrap()))
}

fn coordinates(lattice: &Lattice, x: &[Gauss]) -> Vec<Gauss> {
    (0..lattice.rank()).map(|k| value(lattice.coordinate(k), x)).collect()
}

/// `X = B zeta` solves the relations for every integral zeta, zeta comes back from X, and every solution is
/// such an X: integral zeta and integral solutions are one to one.
fn check(seed: u64, is_real: bool) {
    let system = system(seed, is_real);
    let n = system.matrix.len();
    let lattice = Lattice::new(n, &system.relations, None).unwrap();
    assert_eq!(lattice.rank(), system.rank);
    let mut rng = Rng::new(seed ^ 0x5eed);
    for _ in 0..8 {
        let zeta: Vec<Gauss> = (0..system.rank).map(|_| small(&mut rng, is_real)).collect();
        let x = lattice.expand(&zeta).unwrap();
        assert!(system.relations.iter().all(|r| value(r, &x) == Gauss::ZERO), "seed {seed}");
        assert_eq!(coordinates(&lattice, &x), zeta, "seed {seed}");

        let weights: Vec<Gauss> = (0..system.rank).map(|_| small(&mut rng, is_real)).collect();
        let combine = |row: &Vec<Gauss>| {
            row.iter().zip(&weights).fold(Gauss::ZERO, |s, (a, b)| plus(s, a.times(*b).unwrap()))
        };
        let solution: Vec<Gauss> = system.matrix.iter().map(combine).collect();
        assert!(system.relations.iter().all(|r| value(r, &solution) == Gauss::ZERO));
        let zeta = coordinates(&lattice, &solution);
        assert_eq!(lattice.expand(&zeta).unwrap(), solution, "seed {seed}");
        assert!(!is_real || zeta.iter().all(|z| z.im == 0));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn gaussian_integers(seed in any::<u64>()) {
        check(seed, false);
    }

    #[test]
    fn integers(seed in any::<u64>()) {
        check(seed, true);
    }
}
