//! Fill-reducing orderings.

use crate::buckets::Buckets;
use std::sync::Mutex;

/// Undirected graph in compressed form: the neighbours of node `i` are
/// `neighbours[offsets[i]..offsets[i + 1]]`, each edge listed at both ends, no loops.
#[derive(Debug, Clone, Default)]
pub struct Graph {
    /// One more than the number of nodes.
    pub offsets: Vec<i32>,
    /// Neighbour ids.
    pub neighbours: Vec<i32>,
}

impl Graph {
    /// Builds the graph from edges given in any order; repetitions and loops are dropped.
    pub fn from_edges(n: usize, edges: impl Iterator<Item = (u32, u32)>) -> Self {
        let (from, to): (Vec<u32>, Vec<u32>) =
            edges.filter(|(a, b)| a != b).flat_map(|(a, b)| [(a, b), (b, a)]).unzip();
        let by_node = Buckets::new(n, &from);
        let mut graph = Graph {
            offsets: Vec::with_capacity(n + 1),
            neighbours: Vec::with_capacity(from.len()),
        };
        graph.offsets.push(0);
        let mut list = Vec::new();
        for node in 0..n {
            list.clear();
            list.extend(by_node.of(node).iter().map(|&e| to[e as usize] as i32));
            list.sort_unstable();
            list.dedup();
            graph.neighbours.extend_from_slice(&list);
            graph.offsets.push(graph.neighbours.len() as i32);
        }
        graph
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// True when there is no node.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// METIS keeps its random state in the C library, so calls take turns; each call seeds it anew,
/// which makes the result a function of the graph alone.
static METIS: Mutex<()> = Mutex::new(());

/// Elimination order by nested dissection: entry `k` is the node eliminated `k`-th.
///
/// Falls back to the given order when METIS declines (it does for graphs without edges).
pub fn nested_dissection(graph: &Graph) -> Vec<u32> {
    let n = graph.len();
    if n <= 2 || graph.neighbours.is_empty() {
        return (0..n as u32).collect();
    }
    let _turn = METIS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
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
    if status == metis_sys::rstatus_et_METIS_OK {
        order.into_iter().map(|x| x as u32).collect()
    } else {
        (0..n as u32).collect()
    }
}

/// Repeats an order of nodes for `block` unknowns per node: node `i` owns unknowns
/// `block * i .. block * (i + 1)`.
pub fn expand(order: &[u32], block: u32) -> Vec<u32> {
    order.iter().flat_map(|&i| (0..block).map(move |k| block * i + k)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: u32) -> Graph {
        let at = move |i, j| i * n + j;
        let edges: Vec<_> = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .flat_map(|(i, j)| {
                let right = (j + 1 < n).then(|| (at(i, j), at(i, j + 1)));
                let down = (i + 1 < n).then(|| (at(i, j), at(i + 1, j)));
                right.into_iter().chain(down)
            })
            .collect();
        Graph::from_edges((n * n) as usize, edges.into_iter())
    }

    #[test]
    fn order_is_a_permutation_and_repeatable() {
        let graph = grid(20);
        let order = nested_dissection(&graph);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..400).collect::<Vec<_>>());
        assert_eq!(order, nested_dissection(&graph));
    }

    #[test]
    fn edges_are_symmetric_and_unique() {
        let graph = Graph::from_edges(3, [(0, 1), (1, 0), (2, 2), (1, 2)].into_iter());
        assert_eq!(graph.offsets, [0, 1, 3, 4]);
        assert_eq!(graph.neighbours, [1, 0, 2, 1]);
    }

    #[test]
    fn tiny_graphs_keep_their_order() {
        assert_eq!(nested_dissection(&Graph::from_edges(3, [].into_iter())), [0, 1, 2]);
        assert_eq!(expand(&[1, 0], 2), [2, 3, 0, 1]);
    }
}
