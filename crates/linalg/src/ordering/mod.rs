//! Fill-reducing orderings.

mod dissection;
#[cfg(feature = "metis")]
mod metis;
mod minimum_degree;

pub use dissection::Dissection;
pub use minimum_degree::minimum_degree;

use crate::buckets::Buckets;

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

/// Elimination order that keeps factors sparse: entry `k` is the node eliminated `k`-th. It depends on the
/// graph alone.
///
/// By nested dissection (METIS), whose factors are sparser on surfaces; by [`minimum_degree`] without the
/// feature `metis`, or if METIS declines.
pub fn fill_reducing_order(graph: &Graph) -> Vec<u32> {
    if graph.len() <= 2 || graph.neighbours.is_empty() {
        return (0..graph.len() as u32).collect();
    }
    #[cfg(feature = "metis")]
    if let Some(order) = metis::nested_dissection(graph) {
        return order;
    }
    minimum_degree(graph)
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
    fn orders_are_permutations_and_repeatable() {
        let graph = grid(20);
        for method in [fill_reducing_order, minimum_degree] {
            let order = method(&graph);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..400).collect::<Vec<_>>());
            assert_eq!(order, method(&graph));
        }
    }

    /// Entries below the diagonal of a factor whose unknowns are eliminated in this order.
    fn fill(graph: &Graph, order: &[u32]) -> usize {
        let n = graph.len();
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(k, &node)| place[node as usize] = k);
        let mut later: Vec<std::collections::BTreeSet<usize>> = vec![Default::default(); n];
        for node in 0..n {
            let range = graph.offsets[node] as usize..graph.offsets[node + 1] as usize;
            let ends = graph.neighbours[range].iter().map(|&m| place[m as usize]);
            later[place[node]] = ends.filter(|&end| end > place[node]).collect();
        }
        for k in 0..n {
            let column = later[k].clone();
            if let Some(&parent) = column.first() {
                later[parent].extend(column.into_iter().filter(|&row| row > parent));
            }
        }
        later.iter().map(|column| column.len()).sum()
    }

    #[test]
    fn orders_keep_factors_sparse() {
        let star = Graph::from_edges(4, [(0, 1), (0, 2), (0, 3)].into_iter());
        assert_eq!([fill(&star, &[0, 1, 2, 3]), fill(&star, &[1, 2, 3, 0])], [6, 3]);
        let graph = grid(30);
        let given: Vec<u32> = (0..900).collect();
        let banded = fill(&graph, &given);
        for method in [fill_reducing_order, minimum_degree] {
            let sparse = fill(&graph, &method(&graph));
            assert!(2 * sparse < banded, "{sparse} of {banded}");
        }
    }

    #[test]
    fn edges_are_symmetric_and_unique() {
        let graph = Graph::from_edges(3, [(0, 1), (1, 0), (2, 2), (1, 2)].into_iter());
        assert_eq!(graph.offsets, [0, 1, 3, 4]);
        assert_eq!(graph.neighbours, [1, 0, 2, 1]);
    }

    #[test]
    fn tiny_graphs_keep_their_order() {
        let loose = Graph::from_edges(3, [].into_iter());
        assert_eq!(fill_reducing_order(&loose), [0, 1, 2]);
        assert_eq!(minimum_degree(&Graph::from_edges(1, [].into_iter())), [0]);
        assert_eq!(expand(&[1, 0], 2), [2, 3, 0, 1]);
    }
}
