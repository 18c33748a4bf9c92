//! Arrays of NumPy as bytes, in the order of the machine. Bytes need no version of NumPy.

use pyo3::prelude::*;
use pyo3::types::PyByteArray;

/// A number that arrays hold.
pub(crate) trait Element: Copy {
    /// Bytes of one.
    const SIZE: usize;

    /// Reads one.
    fn read(bytes: &[u8]) -> Self;

    /// Writes one.
    fn write(self, bytes: &mut [u8]);
}

macro_rules! element {
    ($number:ty) => {
        impl Element for $number {
            const SIZE: usize = size_of::<$number>();

            fn read(bytes: &[u8]) -> Self {
                let mut copy = [0; Self::SIZE];
                copy.copy_from_slice(bytes);
                Self::from_ne_bytes(copy)
            }

            fn write(self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self.to_ne_bytes());
            }
        }
    };
}
element!(f64);
element!(u32);
element!(i32);

/// The numbers of an array.
pub(crate) fn numbers<T: Element>(bytes: &[u8]) -> Vec<T> {
    bytes.chunks_exact(T::SIZE).map(T::read).collect()
}

/// The rows of an array.
pub(crate) fn rows<T: Element, const N: usize>(bytes: &[u8]) -> Vec<[T; N]> {
    let row = |row: &[u8]| std::array::from_fn(|k| T::read(&row[k * T::SIZE..(k + 1) * T::SIZE]));
    bytes.chunks_exact(N * T::SIZE).map(row).collect()
}

/// An array of numbers.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    numbers: &[T],
) -> PyResult<Bound<'py, PyByteArray>> {
    PyByteArray::new_with(py, numbers.len() * T::SIZE, |bytes| {
        let places = bytes.chunks_exact_mut(T::SIZE);
        numbers.iter().zip(places).for_each(|(number, place)| number.write(place));
        Ok(())
    })
}
