//! One order for all systems of a mesh.

use super::{Graph, fill_reducing_order};

/// A fill-reducing order of a graph, and its elimination tree: each node hangs on the first of those that its column of the
/// factor reaches.
///
/// Systems whose unknowns lie at nodes of the graph, and are coupled where these are, take their own order from it.
#[derive(Debug, Clone)]
pub struct Dissection {
    order: Vec<u32>,
    /// When a node is eliminated.
    place: Vec<u32>,
    /// The next node up the tree; itself at roots.
    parent: Vec<u32>,
}

impl Dissection {
    /// Orders a graph.
    pub fn new(graph: &Graph) -> Self {
        let order = fill_reducing_order(graph);
        let n = order.len();
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(k, &node)| place[node as usize] = k as u32);
        let mut parent: Vec<u32> = (0..n as u32).collect();
        // Liu 1990: climb from every earlier neighbour, along shortcuts that are laid on the way.
        let mut top = parent.clone();
        for &node in &order {
            let range = graph.offsets[node as usize]..graph.offsets[node as usize + 1];
            for &neighbour in &graph.neighbours[range.start as usize..range.end as usize] {
                let mut below = neighbour as u32;
                if place[below as usize] >= place[node as usize] {
                    continue;
                }
                while top[below as usize] != below && top[below as usize] != node {
                    below = std::mem::replace(&mut top[below as usize], node);
                }
                if top[below as usize] == below {
                    top[below as usize] = node;
                    parent[below as usize] = node;
                }
            }
        }
        Self { order, place, parent }
    }

    /// Entry `k` is the node eliminated `k`-th.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// When a node is eliminated.
    pub fn place(&self, node: u32) -> u32 {
        self.place[node as usize]
    }

    /// The lowest node that has both below it or is one of them; the later one if there is none.
    fn meet(&self, mut a: u32, mut b: u32) -> u32 {
        while a != b {
            if self.place[a as usize] > self.place[b as usize] {
                std::mem::swap(&mut a, &mut b);
            }
            if self.parent[a as usize] == a {
                return b;
            }
            a = self.parent[a as usize];
        }
        a
    }

    /// An order of `n` unknowns, given at which nodes each of them lies, as pairs of unknown and node: an unknown is
    /// eliminated where its nodes meet. Those that lie nowhere come last; ties go to the smaller one.
    pub fn induced(&self, n: usize, lies: impl Iterator<Item = (u32, u32)>) -> Vec<u32> {
        let mut meet: Vec<Option<u32>> = vec![None; n];
        for (unknown, node) in lies {
            let meet = &mut meet[unknown as usize];
            *meet = Some(meet.map_or(node, |other| self.meet(other, node)));
        }
        let key = |unknown: &u32| {
            meet[*unknown as usize].map_or(u32::MAX, |node| self.place[node as usize])
        };
        let mut order: Vec<u32> = (0..n as u32).collect();
        order.sort_by_key(key);
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of squares, `2 n` nodes.
    fn ladder(n: u32) -> Graph {
        let rungs = (0..n).map(|k| (2 * k, 2 * k + 1));
        let rails = (0..2 * (n - 1)).map(|k| (k, k + 2));
        Graph::from_edges(2 * n as usize, rungs.chain(rails))
    }

    #[test]
    fn the_tree_is_that_of_the_factor() {
        let graph = ladder(40);
        let dissection = Dissection::new(&graph);
        // By elimination: the later neighbours of a node go over to the first of them.
        let mut later: Vec<std::collections::BTreeSet<u32>> = (0..80)
            .map(|node: usize| {
                let range = graph.offsets[node] as usize..graph.offsets[node + 1] as usize;
                let places = graph.neighbours[range].iter().map(|&k| dissection.place(k as u32));
                places.filter(|&place| place > dissection.place(node as u32)).collect()
            })
            .collect();
        for &node in dissection.order() {
            let column = later[node as usize].clone();
            let parent = column.first().map_or(node, |&place| dissection.order()[place as usize]);
            assert_eq!(dissection.parent[node as usize], parent);
            if parent != node {
                later[parent as usize].extend(column.iter().skip(1));
            }
        }
    }

    #[test]
    fn unknowns_go_where_their_nodes_meet() {
        // A path in the order of its ends first: 0 and 4 are leaves, and all meet in the middle.
        let path = Dissection {
            order: vec![0, 4, 1, 3, 2],
            place: vec![0, 2, 4, 3, 1],
            parent: vec![1, 2, 2, 2, 3],
        };
        let lies = [(0, 2), (1, 0), (2, 4), (2, 3), (3, 0), (3, 4), (4, 1)];
        // Unknown 3 lies at both ends, unknown 5 nowhere.
        assert_eq!(path.induced(6, lies.into_iter()), [1, 4, 2, 0, 3, 5]);
        let graph = ladder(10);
        let dissection = Dissection::new(&graph);
        let same = dissection.induced(20, (0..20).map(|k| (k, k)));
        assert_eq!(same, dissection.order());
    }

    #[test]
    fn pieces_of_a_graph_have_no_node_in_common() {
        let two = Dissection::new(&Graph::from_edges(4, [(0, 1), (2, 3)].into_iter()));
        let mut order = two.induced(3, [(0, 0), (1, 2), (2, 0), (2, 3)].into_iter());
        order.sort_unstable();
        assert_eq!(order, [0, 1, 2]);
        assert_eq!(two.parent.iter().zip(0..).filter(|&(&p, k)| p == k).count(), 2);
    }
}
