//! Progress and cancellation: the caller is heard in every stage.

mod common;

use common::mesh_of;
use seamstress_parametrize::{MapError, MapOptions, Progress, Stage, make_map};
use seamstress_testkit::{cube, disjoint_union, random_surface};
use std::ops::ControlFlow;

#[test]
fn stages_come_in_order_and_fractions_in_range() {
    let soup = disjoint_union(&[random_surface(1), cube()]);
    let mut seen: Vec<Progress> = Vec::new();
    let mut record = |now| {
        seen.push(now);
        ControlFlow::Continue(())
    };
    make_map(&mesh_of(&soup), &soup.positions, &MapOptions::default(), &mut record).unwrap();
    let steps: Vec<_> = seen.iter().map(|now| (now.component, now.stage)).collect();
    assert!(steps[..steps.len() - 1].is_sorted_by_key(|&(component, _)| component));
    for component in 0..2 {
        let stages: Vec<Stage> =
            steps.iter().filter(|step| step.0 == component).map(|step| step.1).collect();
        let expected = [Stage::Cut, Stage::Rounding, Stage::Layout];
        assert!(expected.iter().all(|stage| stages.contains(stage)), "{stages:?}");
        assert_eq!(stages[0], Stage::Cut);
    }
    assert_eq!(seen.last().unwrap().stage, Stage::Certificate);
    assert!(seen.iter().all(|now| now.n_components == 2 && (0.0..=1.0).contains(&now.fraction)));
}

#[test]
fn breaking_at_any_call_stops_at_once() {
    let soup = random_surface(2);
    let mesh = mesh_of(&soup);
    let run = |stop_at: usize| {
        let mut calls = 0;
        let mut observer = |_| {
            calls += 1;
            if calls > stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let result = make_map(&mesh, &soup.positions, &MapOptions::default(), &mut observer);
        (result, calls)
    };
    let (whole, n_calls) = run(usize::MAX);
    whole.unwrap();
    assert!(n_calls > 20, "only {n_calls} calls");
    for stop_at in [0, 1, 2, n_calls / 3, n_calls / 2, n_calls - 2, n_calls - 1] {
        let (stopped, calls) = run(stop_at);
        assert!(matches!(stopped, Err(MapError::Cancelled(_))), "at call {stop_at}");
        assert_eq!(calls, stop_at + 1, "called on after the break");
    }
}
