//! Ids grouped by a key.

/// For each key the ids that have it, ascending: a counting sort kept in two arrays.
#[derive(Debug, Clone, Default)]
pub struct Buckets {
    offsets: Vec<u32>,
    ids: Vec<u32>,
}

impl Buckets {
    /// Groups the ids `0..keys.len()`; every key must be below `n_keys`.
    pub fn new(n_keys: usize, keys: &[u32]) -> Self {
        let mut offsets = vec![0u32; n_keys + 1];
        for &key in keys {
            offsets[key as usize + 1] += 1;
        }
        for i in 0..n_keys {
            offsets[i + 1] += offsets[i];
        }
        let mut fill = offsets.clone();
        let mut ids = vec![0u32; keys.len()];
        for (id, &key) in keys.iter().enumerate() {
            ids[fill[key as usize] as usize] = id as u32;
            fill[key as usize] += 1;
        }
        Self { offsets, ids }
    }

    /// The ids with a key.
    #[inline]
    pub fn of(&self, key: usize) -> &[u32] {
        &self.ids[self.offsets[key] as usize..self.offsets[key + 1] as usize]
    }

    /// Number of ids.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// True when there is no id.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_keep_their_order() {
        let buckets = Buckets::new(3, &[2, 0, 2, 2]);
        assert_eq!(buckets.of(0), [1]);
        assert!(buckets.of(1).is_empty());
        assert_eq!(buckets.of(2), [0, 2, 3]);
        assert_eq!(buckets.len(), 4);
        assert!(Buckets::new(0, &[]).is_empty());
    }
}
