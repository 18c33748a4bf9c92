//! Fronts: which unknowns are eliminated together.
//!
//! Neighbouring unknowns with equal structure are one node of a smaller graph (Ashcraft 1995), nodes with nested
//! structures a supernode, and small supernodes join their parents where that costs less than it saves (relaxed
//! supernodes, Ashcraft and Grimes 1989).

use super::NONE;
use super::tree::Sequence;
use crate::buckets::Buckets;
use crate::ordering::Graph;
use crate::pattern::Pattern;
use std::collections::BinaryHeap;

/// Consecutive unknowns of the order with the same neighbours, such as the coordinates of a point.
pub(super) struct Groups {
    /// First unknown of each group in the order; one more than there are groups.
    pub(super) offsets: Vec<u32>,
    /// Groups that share an entry of the matrix.
    pub(super) graph: Graph,
}

impl Groups {
    pub(super) fn new(pattern: &Pattern, order: &[u32]) -> Self {
        let rows = |column: u32| {
            let range = pattern.column_offsets[column as usize] as usize
                ..pattern.column_offsets[column as usize + 1] as usize;
            &pattern.rows[range]
        };
        let alike = |i: u32, j: u32| rows(i.min(j))[1..] == *rows(i.max(j));
        let mut group = vec![0u32; order.len()];
        let mut offsets = vec![0u32];
        for (k, &i) in order.iter().enumerate() {
            if k > 0 && !alike(order[k - 1], i) {
                offsets.push(k as u32);
            }
            group[i as usize] = offsets.len() as u32 - 1;
        }
        if !order.is_empty() {
            offsets.push(order.len() as u32);
        }
        // Columns of a group reach the same groups, so the first will do.
        let first = &offsets[..offsets.len() - 1];
        let edges = first.iter().flat_map(|&k| {
            let column = order[k as usize];
            rows(column).iter().map(move |&row| (column, row))
        });
        let mut last = (NONE, NONE);
        let edges = edges.filter_map(|(column, row)| {
            let edge = (group[column as usize], group[row as usize]);
            (std::mem::replace(&mut last, edge) != edge).then_some(edge)
        });
        let graph = Graph::from_edges(first.len(), edges);
        Self { offsets, graph }
    }

    fn weight(&self, group: u32) -> u32 {
        self.offsets[group as usize + 1] - self.offsets[group as usize]
    }
}

/// Groups in their final order, cut into fronts, each after all fronts that it depends on.
pub(super) struct Fronts<'a> {
    pub(super) sequence: Sequence<'a>,
    /// First group of each front; one more than there are fronts.
    pub(super) offsets: Vec<u32>,
    /// The front that takes over what is left of each, or [`NONE`].
    pub(super) parent: Vec<u32>,
}

impl<'a> Fronts<'a> {
    /// Of a matrix whose entries are so many real numbers each.
    pub(super) fn new(groups: &'a Groups, reals: usize) -> Self {
        let n = groups.graph.len();
        let (sequence, tree) = Sequence::new(&groups.graph, (0..n as u32).collect()).postordered();
        let weight: Vec<u32> = sequence.nodes.iter().map(|&g| groups.weight(g)).collect();
        let column = sequence.column_weights(&tree, &weight);

        // Maximal supernodes.
        let mut first = Vec::new();
        let mut supernode_of = Vec::with_capacity(n);
        for j in 0..n {
            let continues =
                j > 0 && tree[j - 1] == j as u32 && column[j - 1] == column[j] + weight[j - 1];
            if !continues {
                first.push(j as u32);
            }
            supernode_of.push(first.len() as u32 - 1);
        }
        first.push(n as u32);
        let m = first.len() - 1;
        let range = |s: usize| first[s] as usize..first[s + 1] as usize;
        let mut sizes: Vec<Size> = (0..m)
            .map(|s| {
                let last = range(s).end - 1;
                Size {
                    pivots: weight[range(s)].iter().sum::<u32>() as usize,
                    others: (column[last] - weight[last]) as usize,
                }
            })
            .collect();
        let parent: Vec<u32> = (0..m)
            .map(|s| match tree[range(s).end - 1] {
                NONE => NONE,
                p => supernode_of[p as usize],
            })
            .collect();

        // The last member stands for a front; it keeps its place, so the fronts are postordered, too.
        let joined = amalgamate(&parent, &mut sizes, reals);
        let members = Buckets::new(m, &joined);
        let mut number = vec![NONE; m];
        let (mut nodes, mut offsets, mut last) = (Vec::with_capacity(n), vec![0], Vec::new());
        for s in (0..m).filter(|&s| joined[s] == s as u32) {
            number[s] = last.len() as u32;
            last.push(s);
            for &member in members.of(s) {
                nodes.extend_from_slice(&sequence.nodes[range(member as usize)]);
            }
            offsets.push(nodes.len() as u32);
        }
        let parent = last
            .iter()
            .map(|&s| match parent[s] {
                NONE => NONE,
                p => number[joined[p as usize] as usize],
            })
            .collect();
        Self { sequence: Sequence::new(&groups.graph, nodes), offsets, parent }
    }

    /// Number of fronts.
    pub(super) fn len(&self) -> usize {
        self.parent.len()
    }
}

/// Unknowns of a front.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    /// Those that are eliminated.
    pub(super) pivots: usize,
    /// Those that are updated.
    pub(super) others: usize,
}

impl Size {
    /// Multiplications, about, with rows in blocks of four.
    pub(super) fn work(self) -> f64 {
        let (c, rows) = (self.pivots as f64, self.rows());
        c * (c * c / 3.0 + c * (rows - c) + (rows - c) * (rows - c))
    }

    /// All rows, filled up to whole blocks.
    fn rows(self) -> f64 {
        (self.pivots + self.others).next_multiple_of(4) as f64
    }

    /// Picoseconds of a front and of the solves that go through it, about: measured on meshes of 20,000 to 100,000
    /// triangles. Times are within 4 % of each other from 6,000 to 10,000 fronts.
    fn cost(self, reals: usize) -> i64 {
        const OPERATION: f64 = 40.0;
        const UPDATE_ENTRY: f64 = 600.0;
        const FACTOR_ENTRY: f64 = 3000.0;
        const FRONT: f64 = 50_000.0;
        let (c, rows, reals) = (self.pivots as f64, self.rows(), reals as f64);
        let updates = (rows - c) * (rows - c) / 2.0;
        let time = OPERATION * reals * reals * self.work()
            + reals * (UPDATE_ENTRY * updates + FACTOR_ENTRY * c * rows)
            + FRONT;
        time as i64
    }
}

/// The supernode that each one joins in the end: itself or an ancestor.
fn amalgamate(parent: &[u32], sizes: &mut [Size], reals: usize) -> Vec<u32> {
    let m = parent.len();
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); m];
    let mut joins: Vec<u32> = (0..m as u32).collect();
    for p in 0..m {
        let gain = |child: u32, sizes: &[Size]| {
            let (child, own) = (sizes[child as usize], sizes[p]);
            let both = Size { pivots: child.pivots + own.pivots, others: own.others };
            child.cost(reals) + own.cost(reals) - both.cost(reals)
        };
        let candidates = std::mem::take(&mut children[p]);
        let mut heap: BinaryHeap<(i64, u32)> =
            candidates.into_iter().map(|c| (gain(c, sizes), c)).collect();
        // Gains fall as the parent grows, so the first that is still what it was is the best.
        while let Some((before, child)) = heap.pop() {
            let now = gain(child, sizes);
            if now < before && now > 0 {
                heap.push((now, child));
            } else if now > 0 {
                joins[child as usize] = p as u32;
                sizes[p].pivots += sizes[child as usize].pivots;
                let more = std::mem::take(&mut children[child as usize]);
                heap.extend(more.into_iter().map(|c| (gain(c, sizes), c)));
            } else {
                children[p].push(child);
            }
        }
        if parent[p] != NONE {
            children[parent[p] as usize].push(p as u32);
        }
    }
    for s in (0..m).rev() {
        joins[s] = joins[joins[s] as usize];
    }
    joins
}
