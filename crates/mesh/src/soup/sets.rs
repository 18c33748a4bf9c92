//! Disjoint sets whose members carry a sign relative to each other.

/// Union-find over `0..n`, each member with a parity against its set's smallest member.
///
/// The representative of a set is its smallest member, so results do not depend on the order of
/// unions.
#[derive(Debug, Clone)]
pub(crate) struct SignedSets {
    parent: Vec<u32>,
    odd: Vec<bool>,
}

impl SignedSets {
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect(), odd: vec![false; n] }
    }

    /// The smallest member of `x`'s set, and whether `x` has the opposite sign.
    pub(super) fn find(&mut self, mut x: u32) -> (u32, bool) {
        let mut odd = false;
        loop {
            let parent = self.parent[x as usize];
            if parent == x {
                return (x, odd);
            }
            // Halve the path: x hangs on its grandparent from now on.
            let grandparent = self.parent[parent as usize];
            if grandparent != parent {
                self.parent[x as usize] = grandparent;
                self.odd[x as usize] ^= self.odd[parent as usize];
            }
            odd ^= self.odd[x as usize];
            x = self.parent[x as usize];
        }
    }

    /// For each member the smallest member of its set.
    pub(crate) fn into_roots(mut self) -> Vec<u32> {
        (0..self.parent.len() as u32).map(|x| self.find(x).0).collect()
    }

    /// Joins the sets of `a` and `b`, whose signs differ if `odd`. False if they are in one set
    /// already and their signs say otherwise.
    pub(crate) fn join(&mut self, a: u32, b: u32, odd: bool) -> bool {
        let (root_a, odd_a) = self.find(a);
        let (root_b, odd_b) = self.find(b);
        let between = odd ^ odd_a ^ odd_b;
        if root_a == root_b {
            return !between;
        }
        let (low, high) = (root_a.min(root_b), root_a.max(root_b));
        self.parent[high as usize] = low;
        self.odd[high as usize] = between;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::SignedSets;

    #[test]
    fn signs_compose_along_a_chain() {
        let mut sets = SignedSets::new(5);
        assert!(sets.join(4, 3, true));
        assert!(sets.join(3, 2, true));
        assert!(sets.join(2, 1, true));
        assert_eq!(sets.find(4), (1, true));
        assert_eq!(sets.find(3), (1, false));
        assert_eq!(sets.find(0), (0, false));
        assert!(sets.join(4, 1, true), "three odd steps are odd");
        assert!(!sets.join(4, 1, false), "the same pair cannot agree as well");
    }

    #[test]
    fn long_chains_keep_their_signs() {
        let n = 1000;
        let mut sets = SignedSets::new(n);
        for i in (1..n as u32).rev() {
            assert!(sets.join(i, i - 1, true));
        }
        for i in 0..n as u32 {
            assert_eq!(sets.find(i), (0, i % 2 == 1));
        }
    }
}
