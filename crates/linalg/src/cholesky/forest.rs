//! Subtrees that do not depend on each other, and what is above them.

use super::NONE;
use std::ops::Range;

/// A postordered tree of fronts, cut for several threads.
pub(super) struct Forest {
    /// Groups of neighbouring subtrees that are worked off together, ascending.
    pub(super) subtrees: Vec<Range<usize>>,
    /// The other fronts, ascending; they come after all subtrees.
    pub(super) top: Vec<usize>,
}

impl Forest {
    /// Cuts the tree given by the parents of fronts and their work: no subtree has more than one of so many `parts` of
    /// the whole, nor have several that go together, unless that is less than `least`.
    pub(super) fn new(parent: &[u32], mut work: Vec<f64>, parts: f64, least: f64) -> Self {
        let most = (work.iter().sum::<f64>() / parts).max(least);
        let parent_of = |s: usize| (parent[s] != NONE).then_some(parent[s] as usize);
        let mut first: Vec<usize> = (0..parent.len()).collect();
        for s in 0..parent.len() {
            if let Some(p) = parent_of(s) {
                first[p] = first[p].min(first[s]);
                work[p] += work[s];
            }
        }
        let heavy = |s: usize| work[s] > most;
        let (mut subtrees, mut top): (Vec<Range<usize>>, _) = (Vec::new(), Vec::new());
        let mut together = 0.0;
        for (s, &first) in first.iter().enumerate() {
            if heavy(s) {
                top.push(s);
            } else if parent_of(s).is_none_or(heavy) {
                together += work[s];
                match subtrees.last_mut() {
                    Some(last) if last.end == first && together <= most => last.end = s + 1,
                    _ => {
                        together = work[s];
                        subtrees.push(first..s + 1);
                    }
                }
            }
        }
        Self { subtrees, top }
    }
}

/// The fronts of a group of subtrees, in a tree given by parents, whose parent is above the group.
pub(super) fn roots(parent: &[u32], fronts: Range<usize>) -> impl Iterator<Item = usize> {
    let end = fronts.end;
    fronts.filter(move |&s| parent[s] != NONE && parent[s] as usize >= end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_subtrees_go_together_and_the_rest_is_on_top() {
        // 0 and 1 below 2; 3 below 4; 2, 4 and 5 below 6.
        let parent = [2, 2, 6, 4, 6, 6, NONE];
        let work = vec![1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 1.0];
        let cut = |parts, least| {
            let Forest { subtrees, top } = Forest::new(&parent, work.clone(), parts, least);
            (subtrees.into_iter().map(|fronts| (fronts.start, fronts.end)).collect::<Vec<_>>(), top)
        };
        assert_eq!(cut(1.0, 0.0), (vec![(0, 7)], vec![]));
        assert_eq!(cut(2.0, 0.0), (vec![(0, 3), (3, 6)], vec![6]));
        assert_eq!(cut(4.0, 0.0), (vec![(0, 2), (3, 5), (5, 6)], vec![2, 6]));
        assert_eq!(cut(4.0, 8.0), (vec![(0, 7)], vec![]));
    }
}
