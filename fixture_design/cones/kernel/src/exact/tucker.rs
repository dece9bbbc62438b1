//! Tucker's partition in exact arithmetic, and the exact sign of s.
//!
//! Does -sum d_i lie in the cone of the rows? If it does, with weights v, then 1 + v is a balance with all weights positive.
//! If not, Farkas' vector y has d_i . y <= 0 for all rows and < 0 for some: these leave, the others lie on y's plane, and
//! the question is asked of them again, in one dimension less.

use dashu_int::IBig;

use super::double_description::echelon;
use super::integer::{Integer, integers_of};
use super::simplex::{Farkas, nonnegative_solution};
use crate::closure::{Bounds, at_once};
use crate::vector::unit;

/// s of unit rows rounded from exact ones is off by less than this [-]: a component by 3 u, a unit row by (3 + D) u sqrt(D).
const ROUNDED: f64 = 64.0 * f64::EPSILON / 2.0;

pub struct Partition<const D: usize> {
    pub balanced: Vec<bool>,
    /// Positive on the balanced rows, zero elsewhere; sum weights_i d_i = 0.
    pub weights: Vec<IBig>,
    /// d_i . motion < 0 for all rows that do not balance, 0 for those that do; None if all balance.
    pub motion: Option<[IBig; D]>,
    /// Reduced echelon basis of the balanced rows' span.
    pub span: Vec<[IBig; D]>,
}

impl<const D: usize> Partition<D> {
    pub fn closes(&self) -> bool {
        self.span.len() == D
    }
}

/// Split the rows into balanced and leaving ones. A zero row balances by itself.
pub fn tucker_partition<const D: usize>(rows: &[[IBig; D]]) -> Partition<D> {
    let mut weights = vec![IBig::ZERO; rows.len()];
    let mut left: Vec<usize> = (0..rows.len()).collect();
    let mut gone: Vec<usize> = Vec::new();
    let mut motion: Option<[IBig; D]> = None;
    while !left.is_empty() {
        let vectors: Vec<[IBig; D]> = left.iter().map(|&row| rows[row].clone()).collect();
        let target: [IBig; D] = std::array::from_fn(|k| -vectors.iter().map(|row| row[k].clone()).sum::<IBig>());
        match solution(&vectors, &target) {
            Farkas::Inside { weights: found, denominator } => {
                for (&row, weight) in left.iter().zip(found) {
                    weights[row] = &denominator + weight;
                }
                break;
            }
            Farkas::Outside { separating } => {
                motion = Some(match &motion {
                    None => separating.clone(),
                    Some(earlier) => still_leaving(rows, &gone, earlier, &separating),
                });
                let height = |row: &usize| IBig::dot(&rows[*row], &separating).expect("no overflow");
                let (stay, leave) = left.iter().partition(|row| height(row).is_zero());
                left = stay;
                gone.extend::<Vec<usize>>(leave);
            }
        }
    }
    let mut balanced = vec![false; rows.len()];
    left.iter().for_each(|&row| balanced[row] = true);
    let span = echelon(left.iter().map(|&row| rows[row].clone()).collect());
    Partition { balanced, weights, motion, span }
}

fn solution<const D: usize>(rows: &[[IBig; D]], target: &[IBig; D]) -> Farkas<IBig, D> {
    let small = |vector: &[IBig; D]| -> Option<[i64; D]> {
        let values: Option<Vec<i64>> = vector.iter().map(i64::from_big).collect();
        values?.try_into().ok()
    };
    let in_words = || {
        let columns: Option<Vec<[i64; D]>> = rows.iter().map(small).collect();
        nonnegative_solution(&columns?, &small(target)?)
    };
    match in_words() {
        Some(Farkas::Inside { weights, denominator }) => {
            Farkas::Inside { weights: weights.into_iter().map(IBig::from).collect(), denominator: denominator.into() }
        }
        Some(Farkas::Outside { separating }) => Farkas::Outside { separating: separating.map(IBig::from) },
        None => nonnegative_solution(rows, target).expect("long integers do not overflow"),
    }
}

/// So much of the earlier motion, plus the new one, that the rows which left still leave.
fn still_leaving<const D: usize>(
    rows: &[[IBig; D]],
    gone: &[usize],
    earlier: &[IBig; D],
    new: &[IBig; D],
) -> [IBig; D] {
    let mut factor = IBig::ONE;
    for &row in gone {
        let (before, now) = (IBig::dot(&rows[row], earlier), IBig::dot(&rows[row], new));
        let (before, now) = (before.expect("no overflow"), now.expect("no overflow"));
        if now > IBig::ZERO {
            factor = factor.max(now / -before + IBig::ONE);
        }
    }
    IBig::combined(&factor, earlier, &-IBig::ONE, new).expect("no overflow")
}

/// The sign of s for the rows as the floats they are: 1 closed, -1 left by some motion, 0 neither. Zero rows say nothing.
///
/// `filter`: let the float bounds decide where they can.
pub fn sign_of_closure<const D: usize>(rows: &[[f64; D]], filter: bool) -> i8 {
    if filter && let Some(sign) = certain_sign(&at_once(rows), 0.0) {
        return sign;
    }
    let integers: Vec<[IBig; D]> = rows.iter().map(integers_of).collect();
    sign_of(&integers)
}

/// The same for integer rows.
pub fn sign_of_exact_closure<const D: usize>(rows: &[[IBig; D]], filter: bool) -> i8 {
    if filter {
        let rounded: Vec<[f64; D]> = rows.iter().map(|row| unit(&IBig::rounded(row))).collect();
        if let Some(sign) = certain_sign(&at_once(&rounded), ROUNDED) {
            return sign;
        }
    }
    sign_of(rows)
}

fn certain_sign<const D: usize>(bounds: &Bounds<D>, off: f64) -> Option<i8> {
    if bounds.lower > off {
        Some(1)
    } else if bounds.upper < -off {
        Some(-1)
    } else {
        None
    }
}

fn sign_of<const D: usize>(rows: &[[IBig; D]]) -> i8 {
    let rows: Vec<[IBig; D]> = rows.iter().filter(|row| row.iter().any(|v| *v != IBig::ZERO)).cloned().collect();
    let partition = tucker_partition(&rows);
    if partition.closes() {
        1
    } else if partition.balanced.iter().any(|&balanced| balanced) {
        0
    } else {
        -1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::vector::{norm, scaled};

    #[test]
    fn the_partition_is_tucker_s() {
        let mut random = Random::new(8);
        for _ in 0..1000 {
            let rows: Vec<[IBig; 4]> =
                (0..random.below(9)).map(|_| std::array::from_fn(|_| IBig::from(random.below(5) as i64 - 2))).collect();
            let found = tucker_partition(&rows);
            for k in 0..4 {
                let sum: IBig = rows.iter().zip(&found.weights).map(|(row, weight)| &row[k] * weight).sum();
                assert_eq!(sum, IBig::ZERO);
            }
            for ((row, &balanced), weight) in rows.iter().zip(&found.balanced).zip(&found.weights) {
                assert_eq!(balanced, *weight > IBig::ZERO);
                if let Some(motion) = &found.motion {
                    let height = IBig::dot(row, motion).unwrap();
                    assert!(if balanced { height == IBig::ZERO } else { height < IBig::ZERO });
                } else {
                    assert!(balanced);
                }
            }
        }
    }

    #[test]
    fn the_filter_changes_no_sign() {
        let mut random = Random::new(9);
        for number in 0..3000 {
            let grid = number % 2 == 0;
            let rows: Vec<[f64; 3]> = (0..1 + random.below(8))
                .map(|_| {
                    let row: [f64; 3] = random.vector();
                    let row = if grid { row.map(|value| (2.0 * value).round()) } else { row };
                    if norm(&row) > 0.0 { scaled(1.0 / norm(&row), &row) } else { row }
                })
                .collect();
            assert_eq!(sign_of_closure(&rows, true), sign_of_closure(&rows, false));
            let integers: Vec<[IBig; 3]> = rows.iter().map(integers_of).collect();
            assert_eq!(sign_of_exact_closure(&integers, true), sign_of_exact_closure(&integers, false));
        }
    }
}
