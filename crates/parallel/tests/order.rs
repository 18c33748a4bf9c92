//! Loops must return what plain iterators do, in their order, with and without threads.

use seamstress_parallel::prelude::*;
use seamstress_parallel::{n_threads, with_threads};

const N: u32 = 10_000;

fn items() -> Vec<u32> {
    (0..N).map(|k| k.wrapping_mul(2_654_435_761) % 1009).collect()
}

#[test]
fn results_keep_the_order_of_the_input() {
    let items = items();
    let maps: Vec<u64> = items.par_iter().with_min_len(16).map(|&x| u64::from(x) + 1).collect();
    assert!(maps.iter().zip(&items).all(|(&y, &x)| y == u64::from(x) + 1));

    let numbered: Vec<(usize, u32)> = items.par_iter().enumerate().map(|(k, &x)| (k, x)).collect();
    assert!(numbered.iter().enumerate().all(|(k, &(at, x))| k == at && items[k] == x));

    let kept: Vec<u32> = items.clone().into_par_iter().filter(|x| x % 3 == 0).collect();
    assert_eq!(kept, items.iter().copied().filter(|x| x % 3 == 0).collect::<Vec<_>>());

    let several: Vec<u32> = items.par_chunks(7).flat_map_iter(|c| c.to_vec()).collect();
    assert_eq!(several, items);

    let first_error: Result<Vec<u32>, ()> =
        (0..N).into_par_iter().map(|k| if k == 5000 { Err(()) } else { Ok(k) }).collect();
    assert_eq!(first_error, Err(()));
}

#[test]
fn every_item_is_changed_once() {
    let mut counts = vec![0u32; N as usize];
    counts.par_iter_mut().enumerate().with_min_len(64).for_each(|(k, out)| *out += k as u32);
    assert!(counts.iter().enumerate().all(|(k, &x)| x == k as u32));
    counts.par_chunks_mut(33).enumerate().for_each(|(c, chunk)| chunk.fill(c as u32));
    assert!(counts.iter().enumerate().all(|(k, &x)| x == k as u32 / 33));
}

#[test]
fn a_pool_has_the_threads_asked_for() {
    let found = with_threads(3, n_threads).unwrap();
    assert_eq!(found, if cfg!(feature = "rayon") { 3 } else { 1 });
}
