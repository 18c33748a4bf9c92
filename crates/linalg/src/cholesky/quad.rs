//! Numbers in fours.

use num_complex::Complex64;
use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};

/// Numbers that matrices may hold: `f64` and [`Complex64`].
pub trait Scalar:
    Copy
    + Default
    + Debug
    + PartialEq
    + Send
    + Sync
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
{
    /// Four of them.
    #[doc(hidden)]
    type Quad: Quad<Scalar = Self>;
    /// Real numbers in one.
    #[doc(hidden)]
    const REALS: usize;
    /// Block rows that kernels work on together: as many as registers hold.
    #[doc(hidden)]
    const HEIGHT: usize;

    /// Its complex conjugate.
    #[doc(hidden)]
    fn conjugate(self) -> Self;

    /// Its product with a real number.
    #[doc(hidden)]
    fn scale(self, factor: f64) -> Self;

    /// Its real part.
    #[doc(hidden)]
    fn real(self) -> f64;
}

/// Four numbers, the lanes of a vector register (or of two).
pub trait Quad: Copy + Default + Debug + Send + Sync {
    /// The numbers.
    type Scalar: Scalar<Quad = Self>;

    /// A lane, counted modulo four.
    fn get(&self, lane: usize) -> Self::Scalar;

    /// Overwrites a lane, counted modulo four.
    fn set(&mut self, lane: usize, value: Self::Scalar);

    /// Adds `COUNT` lanes of another to lanes of this, from multiples of `COUNT` on, counted modulo four.
    fn add_lanes<const COUNT: usize>(&mut self, lane: usize, other: &Self, from: usize);

    /// `self -= a conj(b)`.
    fn subtract_outer<const FMA: bool>(&mut self, a: &Self, b: Self::Scalar);

    /// `self += a b`.
    fn add_product<const FMA: bool>(&mut self, a: &Self, b: Self::Scalar);

    /// `self += conj(a) b`, lane by lane.
    fn add_inner<const FMA: bool>(&mut self, a: &Self, b: &Self);

    /// Multiplies all lanes.
    fn scale(&mut self, factor: f64);

    /// Sum of the lanes.
    fn sum(&self) -> Self::Scalar;
}

/// Four real numbers in one register.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(32))]
pub struct Reals([f64; 4]);

/// Four complex numbers, real parts first.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(32))]
pub struct Complexes {
    re: [f64; 4],
    im: [f64; 4],
}

/// `a b + c`, rounded once where the processor can.
#[inline(always)]
fn mul_add<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

#[inline(always)]
fn add_lanes<const COUNT: usize>(to: &mut [f64; 4], lane: usize, from: &[f64; 4], other: usize) {
    let part = |lane: usize| lane % 4 / COUNT;
    let (to, from) =
        (&mut to.as_chunks_mut::<COUNT>().0[part(lane)], from.as_chunks::<COUNT>().0[part(other)]);
    for l in 0..COUNT {
        to[l] += from[l];
    }
}

impl Scalar for f64 {
    type Quad = Reals;
    const REALS: usize = 1;
    const HEIGHT: usize = 2;

    #[inline(always)]
    fn conjugate(self) -> Self {
        self
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn real(self) -> f64 {
        self
    }
}

impl Scalar for Complex64 {
    type Quad = Complexes;
    const REALS: usize = 2;
    const HEIGHT: usize = 1;

    #[inline(always)]
    fn conjugate(self) -> Self {
        self.conj()
    }

    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    #[inline(always)]
    fn real(self) -> f64 {
        self.re
    }
}

impl Quad for Reals {
    type Scalar = f64;

    #[inline(always)]
    fn get(&self, lane: usize) -> f64 {
        self.0[lane % 4]
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, value: f64) {
        self.0[lane % 4] = value;
    }

    #[inline(always)]
    fn add_lanes<const COUNT: usize>(&mut self, lane: usize, other: &Self, from: usize) {
        add_lanes::<COUNT>(&mut self.0, lane, &other.0, from);
    }

    #[inline(always)]
    fn subtract_outer<const FMA: bool>(&mut self, a: &Self, b: f64) {
        for l in 0..4 {
            self.0[l] = mul_add::<FMA>(-a.0[l], b, self.0[l]);
        }
    }

    #[inline(always)]
    fn add_product<const FMA: bool>(&mut self, a: &Self, b: f64) {
        for l in 0..4 {
            self.0[l] = mul_add::<FMA>(a.0[l], b, self.0[l]);
        }
    }

    #[inline(always)]
    fn add_inner<const FMA: bool>(&mut self, a: &Self, b: &Self) {
        for l in 0..4 {
            self.0[l] = mul_add::<FMA>(a.0[l], b.0[l], self.0[l]);
        }
    }

    #[inline(always)]
    fn scale(&mut self, factor: f64) {
        for x in &mut self.0 {
            *x *= factor;
        }
    }

    #[inline(always)]
    fn sum(&self) -> f64 {
        self.0[0] + self.0[1] + self.0[2] + self.0[3]
    }
}

impl Quad for Complexes {
    type Scalar = Complex64;

    #[inline(always)]
    fn get(&self, lane: usize) -> Complex64 {
        Complex64::new(self.re[lane % 4], self.im[lane % 4])
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, value: Complex64) {
        (self.re[lane % 4], self.im[lane % 4]) = (value.re, value.im);
    }

    #[inline(always)]
    fn add_lanes<const COUNT: usize>(&mut self, lane: usize, other: &Self, from: usize) {
        add_lanes::<COUNT>(&mut self.re, lane, &other.re, from);
        add_lanes::<COUNT>(&mut self.im, lane, &other.im, from);
    }

    #[inline(always)]
    fn subtract_outer<const FMA: bool>(&mut self, a: &Self, b: Complex64) {
        for l in 0..4 {
            let re = mul_add::<FMA>(-a.re[l], b.re, self.re[l]);
            let im = mul_add::<FMA>(-a.im[l], b.re, self.im[l]);
            self.re[l] = mul_add::<FMA>(-a.im[l], b.im, re);
            self.im[l] = mul_add::<FMA>(a.re[l], b.im, im);
        }
    }

    #[inline(always)]
    fn add_product<const FMA: bool>(&mut self, a: &Self, b: Complex64) {
        for l in 0..4 {
            let re = mul_add::<FMA>(a.re[l], b.re, self.re[l]);
            let im = mul_add::<FMA>(a.im[l], b.re, self.im[l]);
            self.re[l] = mul_add::<FMA>(-a.im[l], b.im, re);
            self.im[l] = mul_add::<FMA>(a.re[l], b.im, im);
        }
    }

    #[inline(always)]
    fn add_inner<const FMA: bool>(&mut self, a: &Self, b: &Self) {
        for l in 0..4 {
            let re = mul_add::<FMA>(a.re[l], b.re[l], self.re[l]);
            let im = mul_add::<FMA>(a.re[l], b.im[l], self.im[l]);
            self.re[l] = mul_add::<FMA>(a.im[l], b.im[l], re);
            self.im[l] = mul_add::<FMA>(-a.im[l], b.re[l], im);
        }
    }

    #[inline(always)]
    fn scale(&mut self, factor: f64) {
        for x in self.re.iter_mut().chain(&mut self.im) {
            *x *= factor;
        }
    }

    #[inline(always)]
    fn sum(&self) -> Complex64 {
        let sum = |x: &[f64; 4]| x[0] + x[1] + x[2] + x[3];
        Complex64::new(sum(&self.re), sum(&self.im))
    }
}
