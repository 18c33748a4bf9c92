//! The elimination tree of a graph and what is read off it (Liu 1990).

use super::NONE;
use crate::buckets::Buckets;
use crate::ordering::Graph;

/// A graph whose nodes are eliminated in some order; nodes are named by their place in it.
pub(super) struct Sequence<'a> {
    graph: &'a Graph,
    /// Node of the graph at each place.
    pub(super) nodes: Vec<u32>,
    /// Place of each node.
    places: Vec<u32>,
}

impl<'a> Sequence<'a> {
    pub(super) fn new(graph: &'a Graph, nodes: Vec<u32>) -> Self {
        let places = inverse_permutation(&nodes);
        Self { graph, nodes, places }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn neighbours(&self, place: u32) -> impl Iterator<Item = u32> {
        let node = self.nodes[place as usize] as usize;
        let range = self.graph.offsets[node] as usize..self.graph.offsets[node + 1] as usize;
        self.graph.neighbours[range].iter().map(|&other| self.places[other as usize])
    }

    /// Parent of each place in the elimination tree, or [`NONE`]: the first place after it to which it is joined
    /// by a path through earlier ones.
    fn elimination_tree(&self) -> Vec<u32> {
        let n = self.len();
        let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
        for i in 0..n as u32 {
            for mut k in self.neighbours(i) {
                while k < i {
                    let next = std::mem::replace(&mut ancestor[k as usize], i);
                    if next == NONE {
                        parent[k as usize] = i;
                        break;
                    }
                    k = next;
                }
            }
        }
        parent
    }

    /// The same elimination in an order that finishes every subtree of the elimination tree before it goes on,
    /// and that tree. The fill does not change.
    pub(super) fn postordered(self) -> (Self, Vec<u32>) {
        let tree = self.elimination_tree();
        let order = postorder(&tree);
        let place = inverse_permutation(&order);
        let renamed = |k: u32| if k == NONE { NONE } else { place[k as usize] };
        let parent = order.iter().map(|&k| renamed(tree[k as usize])).collect();
        let nodes = order.iter().map(|&k| self.nodes[k as usize]).collect();
        (Self::new(self.graph, nodes), parent)
    }

    /// Total weight of each place's column of the factor, itself included, by walks along the rows' subtrees.
    pub(super) fn column_weights(&self, parent: &[u32], weight: &[u32]) -> Vec<u32> {
        let mut sum = weight.to_vec();
        let mut seen = vec![NONE; self.len()];
        for i in 0..self.len() as u32 {
            seen[i as usize] = i;
            for mut k in self.neighbours(i) {
                while k < i && seen[k as usize] != i {
                    seen[k as usize] = i;
                    sum[k as usize] += weight[i as usize];
                    k = parent[k as usize];
                }
            }
        }
        sum
    }
}

/// Ids sorted such that each comes right after its descendants.
fn postorder(parent: &[u32]) -> Vec<u32> {
    let n = parent.len();
    let keys: Vec<u32> = parent.iter().map(|&p| p.min(n as u32)).collect();
    let children = Buckets::new(n + 1, &keys);
    // Parents first and last children first, turned around.
    let mut order = Vec::with_capacity(n);
    let mut stack = children.of(n).to_vec();
    while let Some(i) = stack.pop() {
        order.push(i);
        stack.extend_from_slice(children.of(i as usize));
    }
    order.reverse();
    order
}

fn inverse_permutation(order: &[u32]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &i)| place[i as usize] = k as u32);
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two paths 0 - 4 - 1 and 2 - 5 - 3 whose middles meet in 6.
    fn two_paths() -> Graph {
        let edges = [(0, 4), (1, 4), (2, 5), (3, 5), (4, 6), (5, 6)];
        Graph::from_edges(7, edges.into_iter())
    }

    #[test]
    fn tree_and_postorder_by_hand() {
        let graph = two_paths();
        let sequence = Sequence::new(&graph, (0..7).collect());
        assert_eq!(sequence.elimination_tree(), [4, 4, 5, 5, 6, 6, NONE]);
        let (sequence, parent) = sequence.postordered();
        assert_eq!(sequence.nodes, [0, 1, 4, 2, 3, 5, 6]);
        assert_eq!(parent, [2, 2, 6, 5, 5, 6, NONE]);
        assert_eq!(sequence.column_weights(&parent, &[1; 7]), [2, 2, 2, 2, 2, 2, 1]);
        assert_eq!(
            sequence.column_weights(&parent, &[1, 1, 10, 1, 1, 1, 100]),
            [11, 11, 110, 2, 2, 101, 100]
        );
    }

    #[test]
    fn eliminating_the_middle_first_fills() {
        let star = Graph::from_edges(4, [(0, 1), (0, 2), (0, 3)].into_iter());
        let (sequence, parent) = Sequence::new(&star, vec![0, 1, 2, 3]).postordered();
        assert_eq!(parent, [1, 2, 3, NONE]);
        assert_eq!(sequence.column_weights(&parent, &[1; 4]), [4, 3, 2, 1]);
    }

    #[test]
    fn a_forest_has_several_roots() {
        let loose = Graph::from_edges(3, [(0, 2)].into_iter());
        let (sequence, parent) = Sequence::new(&loose, vec![0, 1, 2]).postordered();
        assert_eq!(parent.iter().filter(|&&p| p == NONE).count(), 2);
        assert_eq!(sequence.len(), 3);
    }
}
