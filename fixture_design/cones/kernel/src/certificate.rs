//! Bounds on s = min over |u| = 1 of max_i d_i . u that hold for the rows as the floats they are, rounding and all.
//!
//! s > 0 says that the rows close, s < 0 that a motion leaves them all; zero rows say nothing and are left out. The
//! float filter of everything exact here is this: a bound that excludes zero is a proof; where neither does, rational
//! arithmetic decides (`exact`).
//!
//! Notation: u = 2^-53, g(n) = n u / (1 - n u). A sum of n products in any order errs by at most g(n) sum |x_i y_i|
//! (N. Higham, Accuracy and Stability of Numerical Algorithms, 2002, section 3.1); fused multiply-add errs by no more.
//!
//! **A motion** v proves s <= max_i d_i . v / |v|. Computed d_i . v errs by at most g(D) |d_i| |v|, since
//! sum |d_ik v_k| <= |d_i| |v|. The bound returned adds (D + 8) u |d_i|, which pays for the division and for |v|, |d_i|
//! themselves too. Rows so short that their squares underflow have no such bound.
//!
//! **Weights** w >= 0, W = sum w_i > 0, prove with E = diag(w) D, r = D^T w:
//!
//! > s >= (sigma_min(E) - |r|) / (W + |w|)  if sigma_min(E) > |r|,   and always  s >= -|r| / W.
//!
//! For any unit u let h = max_i d_i . u. The numbers w_i (h - d_i . u) are >= 0 with sum W h - r . u <= W h + |r|, which
//! gives the second bound, and bounds their 1-norm, hence the 2-norm of w h - E u. So sigma_min(E) <= |E u| <=
//! |h| |w| + W h + |r|. If h < 0, then |h| |w| + W h <= 0 by |w| <= W, and sigma_min(E) <= |r|; so where sigma_min(E) > |r|,
//! h >= 0 and the first bound follows.
//!
//! What is computed, for m rows:
//! * |r|: computed r_k errs by at most g(m) a_k, a_k = sum_i w_i |d_ik|, and |a| <= sum_i w_i |d_i|.
//! * sigma_min(E) from the Gram matrix G = E^T E. Entries of E are products (one rounding), entries of G sums of m products,
//!   so computed G errs, entry by entry, by at most g(m + 2) (|E|^T |E|), whose norm is at most its trace, tr G.
//! * Cholesky of G - c I, in floats. If it runs to completion, then, whatever rounding did, the smallest eigenvalue of the
//!   matrix it was given is above -g(D + 1) / (1 - g(D + 1)) tr G (S. Rump, Verification of positive definiteness, BIT 46,
//!   2006); c is subtracted with an error of u tr G. Together: lambda_min(E^T E) >= c - (m + D + 8) 1.1 u tr G.
//! * Underflow costs at most m 2^-1074 an entry: bounds on lambda below 1e-250 are not used.
//!
//! `tests/cones/test_certificate.py` tries to break the bounds: rows and weights made so that s is known in rational
//! arithmetic and next to zero on either side.

use crate::vector::{dot, norm, plus};

/// Unit round-off.
const U: f64 = f64::EPSILON / 2.0;
/// Slack for roundings in the bounds' own evaluation, and for second-order terms.
const SAFE: f64 = 1.1;
/// Smallest eigenvalue that underflow cannot have made.
const FAR_FROM_UNDERFLOW: f64 = 1e-250;

/// Length of a vector whose squares may have lost digits to underflow, or be none.
const SQUARES_UNDERFLOW: f64 = 1e-140;

/// An upper bound on s: the largest d_i . v / |v| with its rounding; v need not be unit.
#[inline(always)]
pub fn upper_bound<const D: usize>(rows: &[[f64; D]], motion: &[f64; D]) -> f64 {
    let size = norm(motion);
    if !(size.is_normal()) {
        return f64::INFINITY;
    }
    let off = (D as f64 + 8.0) * SAFE * U;
    let mut highest = -1.0f64; // of rows that are all zero; as an upper bound it costs nothing
    for row in rows {
        if row.iter().all(|&value| value == 0.0) {
            continue;
        }
        let length = norm(row);
        if length < SQUARES_UNDERFLOW {
            return f64::INFINITY;
        }
        highest = highest.max(dot(row, motion) / size + off * length);
    }
    highest
}

/// A lower bound on s from weights w >= 0, one a row: positive if they prove closure, else -|D^T w| / sum w.
#[inline(always)]
pub fn lower_bound<const D: usize>(rows: &[[f64; D]], weights: &[f64]) -> f64 {
    let count = rows.len() as f64;
    let mut gram = [[0.0; D]; D];
    let mut sum = [0.0; D];
    let (mut total, mut squares, mut sizes) = (0.0, 0.0, 0.0);
    for (row, &weight) in rows.iter().zip(weights) {
        if row.iter().all(|&value| value == 0.0) {
            continue;
        }
        let weighted = row.map(|value| weight * value);
        sum = plus(&sum, weight, row);
        for k in 0..D {
            for l in 0..=k {
                gram[k][l] += weighted[k] * weighted[l];
            }
        }
        total += weight;
        squares += weight * weight;
        sizes += norm(&weighted);
    }
    let trace: f64 = (0..D).map(|k| gram[k][k]).sum();
    if !(total > 0.0 && total.is_finite() && trace.is_finite()) {
        return f64::NEG_INFINITY;
    }
    let residual = (norm(&sum) + (count + 4.0) * SAFE * U * sizes) * (1.0 + 8.0 * U);
    let open = -residual / total * (1.0 + (count + 4.0) * SAFE * U);
    let off = (count + D as f64 + 8.0) * SAFE * U * trace;
    let Some(smallest) = smallest_eigenvalue(&gram, off) else { return open };
    let sigma = smallest.sqrt() * (1.0 - 4.0 * U);
    if sigma > residual {
        // the last factor pays for the roundings of the total and of the norm of the weights
        (sigma - residual) / (total + squares.sqrt()) * (1.0 - (count + 16.0) * SAFE * U)
    } else {
        open
    }
}

/// A proven lower bound on the smallest eigenvalue of the lower triangle's matrix, not more than `off` from what is known.
///
/// Inverse iteration guesses it, Cholesky of the shifted matrix proves the guess, or a smaller one.
#[inline(always)]
fn smallest_eigenvalue<const D: usize>(gram: &[[f64; D]; D], off: f64) -> Option<f64> {
    let whole = cholesky(gram, 0.0)?;
    let mut guess = f64::INFINITY;
    let mut vector: [f64; D] = std::array::from_fn(|k| 1.0 + 0.1 * k as f64);
    for _ in 0..4 {
        let solved = solve(&whole, &vector);
        let size = norm(&solved);
        if !size.is_normal() {
            return None;
        }
        guess = guess.min(norm(&vector) / size);
        vector = solved.map(|value| value / size);
    }
    for part in [0.9, 0.5, 0.1, 0.01] {
        let shift = part * guess + off;
        if cholesky(gram, shift).is_some() {
            let proved = shift - off;
            return (proved > FAR_FROM_UNDERFLOW).then_some(proved * (1.0 - 4.0 * U));
        }
    }
    None
}

/// The Cholesky factor of gram - shift I, if it runs to completion.
#[inline(always)]
fn cholesky<const D: usize>(gram: &[[f64; D]; D], shift: f64) -> Option<[[f64; D]; D]> {
    let mut factor = [[0.0; D]; D];
    for k in 0..D {
        let mut pivot = gram[k][k] - shift;
        for j in 0..k {
            pivot -= factor[k][j] * factor[k][j];
        }
        if !(pivot > 0.0) {
            return None;
        }
        let root = pivot.sqrt();
        factor[k][k] = root;
        for i in k + 1..D {
            let mut value = gram[i][k];
            for j in 0..k {
                value -= factor[i][j] * factor[k][j];
            }
            factor[i][k] = value / root;
        }
    }
    Some(factor)
}

#[inline(always)]
fn solve<const D: usize>(factor: &[[f64; D]; D], target: &[f64; D]) -> [f64; D] {
    let mut x = *target;
    for k in 0..D {
        for j in 0..k {
            x[k] -= factor[k][j] * x[j];
        }
        x[k] /= factor[k][k];
    }
    for k in (0..D).rev() {
        for j in k + 1..D {
            x[k] -= factor[j][k] * x[j];
        }
        x[k] /= factor[k][k];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_bounds_enclose_what_sampling_finds() {
        let mut random = Random::new(5);
        for _ in 0..200 {
            let mut rows: Vec<[f64; 3]> = (0..8).map(|_| random.vector()).collect();
            let sum = rows.iter().fold([0.0; 3], |sum, row| plus(&sum, -1.0, row));
            rows.push(sum);
            let lower = lower_bound(&rows, &[1.0; 9]);
            assert!(lower > 0.0);
            for _ in 0..200 {
                let motion = random.vector();
                let highest = rows.iter().map(|row| dot(row, &motion)).fold(f64::MIN, f64::max) / norm(&motion);
                assert!(lower <= highest && highest <= upper_bound(&rows, &motion));
            }
        }
    }

    #[test]
    fn rows_without_full_rank_are_never_proved_closed() {
        let mut random = Random::new(6);
        for _ in 0..1000 {
            // in the plane orthogonal to (1, 1, 1) up to rounding of the last coordinate
            let rows: Vec<[f64; 3]> = (0..7)
                .map(|_| {
                    let (a, b) = ((random.unit() * 1024.0).floor(), (random.unit() * 1024.0).floor());
                    [a, b, -a - b]
                })
                .flat_map(|row| [row, row.map(|value| -value)])
                .collect();
            assert!(lower_bound(&rows, &[0.1; 14]) <= 0.0);
        }
    }
}
