//! Nested dissection, by METIS (Karypis and Kumar 1998).

use super::Graph;
use std::sync::Mutex;

/// METIS keeps its random state in the C library, so calls take turns; each call seeds it anew,
/// which makes the result a function of the graph alone.
static METIS: Mutex<()> = Mutex::new(());

/// The order of a graph with at least one edge; nothing if METIS declines.
pub(super) fn nested_dissection(graph: &Graph) -> Option<Vec<u32>> {
    let _turn = METIS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let n = graph.len();
    let mut nodes = n as i32;
    let mut offsets = graph.offsets.clone();
    let mut neighbours = graph.neighbours.clone();
    let mut order = vec![0i32; n];
    let mut position = vec![0i32; n];
    let mut options = vec![0i32; metis_sys::METIS_NOPTIONS as usize];
    // SAFETY: all pointers are to live buffers of the sizes METIS asks for (n + 1 offsets, n
    // entries in the two permutations, METIS_NOPTIONS options); it keeps none of them.
    let status = unsafe {
        metis_sys::METIS_SetDefaultOptions(options.as_mut_ptr());
        metis_sys::METIS_NodeND(
            &mut nodes,
            offsets.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            std::ptr::null_mut(),
            options.as_mut_ptr(),
            order.as_mut_ptr(),
            position.as_mut_ptr(),
        )
    };
    let succeeded = status == metis_sys::rstatus_et_METIS_OK;
    succeeded.then(|| order.into_iter().map(|x| x as u32).collect())
}
