//! Every kind of broken result is refused, for the right reason, on each of ten meshes.
#![allow(clippy::unwrap_used, reason = "a test")]

mod common;

use common::mutations::MUTATIONS;
use common::{kind, ten};
use seamstress_testkit::Rng;

#[test]
fn good_results_pass() {
    for case in ten() {
        assert_eq!(case.violations(), []);
    }
}

#[test]
fn broken_results_are_refused_for_their_reason() {
    let kinds: std::collections::BTreeSet<_> = MUTATIONS.iter().map(|(what, ..)| what).collect();
    assert!(kinds.len() >= 40);
    for (number, good) in ten().iter().enumerate() {
        for (k, (what, reason, spoil)) in MUTATIONS.iter().enumerate() {
            let (mut case, mut rng) = (good.clone(), Rng::new((100 * number + k) as u64));
            spoil(&mut case, &mut rng);
            let found: Vec<String> = case.violations().iter().map(kind).collect();
            assert!(found.iter().any(|kind| kind == reason), "{what} on mesh {number}: {found:?}");
        }
    }
}
