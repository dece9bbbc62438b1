//! Integers that may give up: machine words overflow, and the work is done again with integers of any length.

use dashu_int::ops::{Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};

/// What the exact algorithms need of a number. `None` is overflow.
pub trait Integer: Clone + PartialEq + Send + Sync {
    fn from_big(value: &IBig) -> Option<Self>;
    fn to_big(&self) -> IBig;
    fn zero() -> Self;
    fn one() -> Self;
    fn is_zero(&self) -> bool;
    fn is_negative(&self) -> bool;
    fn negated(&self) -> Self;
    /// sum of a_i b_i.
    fn dot(a: &[Self], b: &[Self]) -> Option<Self>;
    /// (a x - b y) / divisor, which is known to come out even.
    fn cross(a: &Self, x: &Self, b: &Self, y: &Self, divisor: &Self) -> Option<Self>;
    /// a x - b y for all the pairs (x, y), without their common factor.
    fn combined<const D: usize>(a: &Self, x: &[Self; D], b: &Self, y: &[Self; D]) -> Option<[Self; D]>;
    /// The vector in floats, its largest component about 1: correct to two roundings a component.
    fn rounded<const D: usize>(vector: &[Self; D]) -> [f64; D];
}

impl Integer for i64 {
    fn from_big(value: &IBig) -> Option<Self> {
        // one bit to spare: negation never overflows
        Self::try_from(value).ok().filter(|small| small.unsigned_abs() < 1 << 62)
    }
    fn to_big(&self) -> IBig {
        IBig::from(*self)
    }
    fn zero() -> Self {
        0
    }
    fn one() -> Self {
        1
    }
    fn is_zero(&self) -> bool {
        *self == 0
    }
    fn is_negative(&self) -> bool {
        *self < 0
    }
    fn negated(&self) -> Self {
        -self
    }
    #[inline(always)]
    fn dot(a: &[Self], b: &[Self]) -> Option<Self> {
        // eight products below 2^124 stay below 2^127
        let mut sum = 0i128;
        for (x, y) in a.iter().zip(b) {
            sum += i128::from(*x) * i128::from(*y);
        }
        fitting(sum)
    }
    #[inline(always)]
    fn cross(a: &Self, x: &Self, b: &Self, y: &Self, divisor: &Self) -> Option<Self> {
        let difference = i128::from(*a) * i128::from(*x) - i128::from(*b) * i128::from(*y);
        fitting(if *divisor == 1 { difference } else { difference / i128::from(*divisor) })
    }
    #[inline(always)]
    fn combined<const D: usize>(a: &Self, x: &[Self; D], b: &Self, y: &[Self; D]) -> Option<[Self; D]> {
        let wide: [i128; D] =
            std::array::from_fn(|k| i128::from(*a) * i128::from(x[k]) - i128::from(*b) * i128::from(y[k]));
        let mut factor = 0u128;
        for value in wide {
            factor = common_factor(factor, value.unsigned_abs());
            if factor == 1 {
                break;
            }
        }
        let mut result = [0; D];
        for k in 0..D {
            result[k] = fitting(if factor > 1 { divided(wide[k], factor) } else { wide[k] })?;
        }
        Some(result)
    }
    #[inline(always)]
    fn rounded<const D: usize>(vector: &[Self; D]) -> [f64; D] {
        let floats = vector.map(|value| value as f64);
        let largest = floats.iter().fold(0.0f64, |most, value| most.max(value.abs()));
        if largest > 0.0 { floats.map(|value| value / largest) } else { floats }
    }
}

#[inline(always)]
fn fitting(value: i128) -> Option<i64> {
    (value.unsigned_abs() < 1 << 62).then_some(value as i64)
}

#[inline(always)]
fn divided(value: i128, factor: u128) -> i128 {
    match (i64::try_from(value), i64::try_from(factor)) {
        (Ok(value), Ok(factor)) => i128::from(value / factor),
        _ => value / factor as i128,
    }
}

#[inline(always)]
fn common_factor(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        if let (Ok(x), Ok(y)) = (u64::try_from(a), u64::try_from(b)) {
            return u128::from(common_factor_of_words(x, y));
        }
        (a, b) = (b, a % b);
    }
    a
}

/// By halving (J. Stein, 1967): no divisions.
#[inline(always)]
fn common_factor_of_words(mut a: u64, mut b: u64) -> u64 {
    if a == 0 || b == 0 {
        return a | b;
    }
    let twos = (a | b).trailing_zeros();
    a >>= a.trailing_zeros();
    while b != 0 {
        b >>= b.trailing_zeros();
        (a, b) = (a.min(b), a.abs_diff(b));
    }
    a << twos
}

impl Integer for IBig {
    fn from_big(value: &IBig) -> Option<Self> {
        Some(value.clone())
    }
    fn to_big(&self) -> IBig {
        self.clone()
    }
    fn zero() -> Self {
        Self::ZERO
    }
    fn one() -> Self {
        Self::ONE
    }
    fn is_zero(&self) -> bool {
        *self == Self::ZERO
    }
    fn is_negative(&self) -> bool {
        *self < Self::ZERO
    }
    fn negated(&self) -> Self {
        -self
    }
    fn dot(a: &[Self], b: &[Self]) -> Option<Self> {
        let mut sum = Self::ZERO;
        for (x, y) in a.iter().zip(b) {
            if *x != Self::ZERO && *y != Self::ZERO {
                sum += x * y;
            }
        }
        Some(sum)
    }
    fn cross(a: &Self, x: &Self, b: &Self, y: &Self, divisor: &Self) -> Option<Self> {
        let difference = a * x - b * y;
        Some(if *divisor == Self::ONE { difference } else { difference / divisor })
    }
    fn combined<const D: usize>(a: &Self, x: &[Self; D], b: &Self, y: &[Self; D]) -> Option<[Self; D]> {
        let mut all: [Self; D] = std::array::from_fn(|k| a * &x[k] - b * &y[k]);
        make_primitive(&mut all);
        Some(all)
    }
    fn rounded<const D: usize>(vector: &[Self; D]) -> [f64; D] {
        use dashu_int::ops::BitTest;
        let bits = vector.iter().map(BitTest::bit_len).max().unwrap_or(0);
        // shifted to 64 bits and more of the largest: what is cut off is below a rounding of the largest
        let cut = bits.saturating_sub(120);
        let scale = 2f64.powi(-((bits - cut) as i32));
        std::array::from_fn(|k| (&vector[k] >> cut).to_f64().value() * scale)
    }
}

/// Divide by the common factor.
pub fn make_primitive(vector: &mut [IBig]) {
    let mut factor = UBig::ZERO;
    for value in vector.iter().filter(|value| **value != IBig::ZERO) {
        factor = if factor == UBig::ZERO { value.clone().unsigned_abs() } else { (&factor).gcd(value) };
        if factor == UBig::ONE {
            return;
        }
    }
    if factor > UBig::ONE {
        let factor = IBig::from(factor);
        for value in vector {
            *value = &*value / &factor;
        }
    }
}

/// The floats times a power of two, as integers without common factor; zero stays zero.
pub fn integers_of<const D: usize>(row: &[f64; D]) -> [IBig; D] {
    let parts = row.map(|value| {
        let bits = value.to_bits();
        let exponent = (bits >> 52 & 0x7FF) as i64;
        let mantissa = bits & ((1 << 52) - 1);
        let (mantissa, exponent) = if exponent == 0 { (mantissa, 1) } else { (mantissa | 1 << 52, exponent) };
        (if value < 0.0 { -(mantissa as i64) } else { mantissa as i64 }, exponent)
    });
    let lowest = parts.iter().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0);
    let mut integers = parts.map(|(mantissa, exponent)| match mantissa {
        0 => IBig::ZERO,
        _ => IBig::from(mantissa) << (exponent - lowest) as usize,
    });
    make_primitive(&mut integers);
    integers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_become_the_integers_that_they_are() {
        assert_eq!(integers_of(&[0.5, -0.25, 0.0]), [2, -1, 0].map(IBig::from));
        assert_eq!(integers_of(&[3.0, 6.0]), [1, 2].map(IBig::from));
        assert_eq!(integers_of(&[5e-324, 1e-323]), [1, 2].map(IBig::from));
        assert_eq!(integers_of(&[0.0, 0.0]), [0, 0].map(IBig::from));
    }

    #[test]
    fn words_and_long_integers_agree_until_words_overflow() {
        let (x, y) = ([6i64, -4, 10], [3i64, 5, 7]);
        let small = i64::combined(&2, &x, &-3, &y).unwrap();
        let long = IBig::combined(&2.into(), &x.map(IBig::from), &(-3).into(), &y.map(IBig::from)).unwrap();
        assert_eq!(small.map(IBig::from), long);
        assert!(i64::combined(&(1 << 61), &[1 << 61, 3], &1, &[1, 2]).is_none());
        assert_eq!(common_factor(1 << 100, 3 << 90), 1 << 90);
        assert_eq!(common_factor(0, 7), 7);
    }
}
