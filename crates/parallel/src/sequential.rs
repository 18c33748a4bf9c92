//! The adaptors of rayon that Seamstress uses, as plain iterators.

/// Iterates over a slice.
pub trait ParallelSlice<T> {
    /// Over the items.
    fn par_iter(&self) -> std::slice::Iter<'_, T>;

    /// Over chunks of `size` items; the last may be shorter.
    fn par_chunks(&self, size: usize) -> std::slice::Chunks<'_, T>;
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> std::slice::Iter<'_, T> {
        self.iter()
    }

    fn par_chunks(&self, size: usize) -> std::slice::Chunks<'_, T> {
        self.chunks(size)
    }
}

/// Iterates over a slice that may be changed.
pub trait ParallelSliceMut<T> {
    /// Over the items.
    fn par_iter_mut(&mut self) -> std::slice::IterMut<'_, T>;

    /// Over chunks of `size` items; the last may be shorter.
    fn par_chunks_mut(&mut self, size: usize) -> std::slice::ChunksMut<'_, T>;
}

impl<T> ParallelSliceMut<T> for [T] {
    fn par_iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
        self.iter_mut()
    }

    fn par_chunks_mut(&mut self, size: usize) -> std::slice::ChunksMut<'_, T> {
        self.chunks_mut(size)
    }
}

/// Iterates over anything.
pub trait IntoParallelIterator: IntoIterator + Sized {
    /// Over the items.
    fn into_par_iter(self) -> Self::IntoIter {
        self.into_iter()
    }
}

impl<I: IntoIterator> IntoParallelIterator for I {}

/// What rayon's iterators have and plain ones lack.
pub trait ParallelIterator: Iterator + Sized {
    /// Fewest items worth a task: of no meaning on one thread.
    fn with_min_len(self, _length: usize) -> Self {
        self
    }

    /// Maps each item to several.
    fn flat_map_iter<U: IntoIterator>(
        self,
        f: impl FnMut(Self::Item) -> U,
    ) -> impl Iterator<Item = U::Item> {
        self.flat_map(f)
    }
}

impl<I: Iterator> ParallelIterator for I {}
