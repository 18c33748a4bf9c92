//! Approximate minimum degree (Amestoy, Davis and Duff 1996), by faer.

use super::Graph;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// The order by approximate minimum degree: entry `k` is the node eliminated `k`-th. It depends on the graph
/// alone.
///
/// The order given if there is no memory for it.
pub fn minimum_degree(graph: &Graph) -> Vec<u32> {
    let n = graph.len();
    let unsigned = |ids: &[i32]| ids.iter().map(|&x| x as u32).collect::<Vec<_>>();
    let (columns, rows) = (unsigned(&graph.offsets), unsigned(&graph.neighbours));
    let given = (0..n as u32).collect();
    let Ok(mut memory) = MemBuffer::try_new(amd::order_scratch::<u32>(n, rows.len())) else {
        return given;
    };
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &rows);
    let (mut order, mut position) = (vec![0; n], vec![0; n]);
    let (control, stack) = (amd::Control::default(), MemStack::new(&mut memory));
    match amd::order(&mut order, &mut position, pattern, control, stack) {
        Ok(_) => order,
        Err(_) => given,
    }
}
