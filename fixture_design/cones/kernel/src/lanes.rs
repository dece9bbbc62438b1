//! A few numbers that go through the same arithmetic side by side, so that the compiler uses vector instructions.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// How many.
pub const LANES: usize = 4;

#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub struct Lanes(pub [f64; LANES]);

/// Which of them.
pub type Chosen = [bool; LANES];

impl Lanes {
    pub const ZERO: Lanes = Lanes([0.0; LANES]);
    pub const ONE: Lanes = Lanes([1.0; LANES]);

    #[inline(always)]
    pub fn all(value: f64) -> Self {
        Lanes([value; LANES])
    }

    #[inline(always)]
    fn map(self, work: impl Fn(f64) -> f64) -> Self {
        let mut result = self;
        for k in 0..LANES {
            result.0[k] = work(self.0[k]);
        }
        result
    }

    #[inline(always)]
    fn with(self, other: Self, work: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self;
        for k in 0..LANES {
            result.0[k] = work(self.0[k], other.0[k]);
        }
        result
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// The larger one; a NaN of `self` stays.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.with(other, |a, b| if a < b { b } else { a })
    }

    /// The smaller one; a NaN of `self` stays.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.with(other, |a, b| if a > b { b } else { a })
    }

    #[inline(always)]
    pub fn at_most(self, other: Self) -> Chosen {
        let mut result = [false; LANES];
        for k in 0..LANES {
            result[k] = self.0[k] <= other.0[k];
        }
        result
    }

    #[inline(always)]
    pub fn below(self, other: Self) -> Chosen {
        let mut result = [false; LANES];
        for k in 0..LANES {
            result[k] = self.0[k] < other.0[k];
        }
        result
    }

    /// `self` where chosen, else `other`.
    #[inline(always)]
    pub fn where_chosen(self, chosen: &Chosen, other: Self) -> Self {
        let mut result = self;
        for k in 0..LANES {
            result.0[k] = if chosen[k] { self.0[k] } else { other.0[k] };
        }
        result
    }
}

#[inline(always)]
pub fn both(a: Chosen, b: Chosen) -> Chosen {
    std::array::from_fn(|k| a[k] & b[k])
}

#[inline(always)]
pub fn either(a: Chosen, b: Chosen) -> Chosen {
    std::array::from_fn(|k| a[k] | b[k])
}

macro_rules! operator {
    ($Trait:ident, $name:ident, $symbol:tt) => {
        impl $Trait for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $name(self, other: Lanes) -> Lanes {
                self.with(other, |a, b| a $symbol b)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn neg(self) -> Lanes {
        self.map(|a| -a)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Lanes) {
        *self = *self + other;
    }
}

/// a . b.
#[inline(always)]
pub fn dots<const K: usize>(a: &[Lanes; K], b: &[Lanes; K]) -> Lanes {
    let mut sum = a[0] * b[0];
    for k in 1..K {
        sum += a[k] * b[k];
    }
    sum
}

/// a . b without the first.
#[inline(always)]
pub fn tail_dots<const K: usize>(a: &[Lanes; K], b: &[Lanes; K]) -> Lanes {
    let mut sum = Lanes::ZERO;
    for k in 1..K {
        sum += a[k] * b[k];
    }
    sum
}
