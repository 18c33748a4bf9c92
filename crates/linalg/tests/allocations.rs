//! A factorisation that follows others allocates next to nothing.

use seamstress_linalg::{Cholesky, PatternBuilder};
use seamstress_parallel::with_threads;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The system's allocator, counting bytes.
struct Counting;

static BYTES: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        BYTES.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the pointer came from `alloc` with this layout.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn factorising_again_allocates_next_to_nothing() {
    // A square grid with its rows as they come: a band.
    let side = 120u32;
    let mut builder = PatternBuilder::new((side * side) as usize);
    for k in 0..side * side {
        if k % side + 1 < side {
            builder.add_clique(&[k, k + 1]);
        }
        if k + side < side * side {
            builder.add_clique(&[k, k + side]);
        }
    }
    let pattern = builder.build();
    let mut values = vec![-1.0; pattern.len()];
    pattern.diagonal().iter().for_each(|&slot| values[slot as usize] = 4.5);
    let order: Vec<u32> = (0..side * side).collect();
    let mut cholesky = Cholesky::<f64>::analyze(&pattern, &order).unwrap();
    let mut x = vec![1.0; pattern.order()];
    for threads in [1, 2] {
        with_threads(threads, || {
            cholesky.factorize(&values).unwrap();
            let before = BYTES.load(Ordering::Relaxed);
            cholesky.factorize(&values).unwrap();
            cholesky.solve(&mut x);
            let allocated = BYTES.load(Ordering::Relaxed) - before;
            assert!(8 * cholesky.factor_len() > 5_000_000);
            assert!(allocated < 50_000, "{allocated} bytes on {threads} threads");
        })
        .unwrap();
    }
}
