//! Do rows close, does a motion leave them all, or neither? One nonnegative least squares decides nearly every case.
//!
//! Let w >= 0 bring D^T w nearest to b = -sum d_i. If it reaches b, the weights 1 + w are all positive and balance the rows,
//! and the rows close if they have full rank (E. Stiemke, 1915). If not, the residual r has d_i . r <= 0 for every row and is
//! not zero: a motion of the cone, so the rows do not close. Only the rows that take part, which are independent, are
//! on r's plane; a step along the y that is alike on all of them leaves these too, unless others lie on it by accident.
//! Either answer comes as a bound on s with its proof (`certificate`).
//!
//! What that does not settle (ties, rows that balance in part, near misses) goes to Tucker's partition, at three sizes
//! of zero.

use crate::certificate::{lower_bound, upper_bound};
use crate::nonnegative::{Nonnegative, nonnegative_least_squares};
use crate::tucker::tucker_partition;
use crate::vector::{dot, norm, plus, scaled, unit};

/// Largest number that is certainly zero, the tolerance, and the smallest that is certainly not.
#[derive(Clone, Copy)]
pub struct Sizes {
    pub zero: f64,
    pub tie: f64,
    pub near: f64,
}

/// lower <= s <= upper, and what proves it.
pub struct Bounds<const D: usize> {
    pub lower: f64,
    pub upper: f64,
    /// Nonnegative, sum 1; empty if none were found.
    pub weights: Vec<f64>,
    pub motion: Option<[f64; D]>,
}

impl<const D: usize> Bounds<D> {
    fn nothing() -> Self {
        Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY, weights: Vec::new(), motion: None }
    }

    fn settled(&self, sizes: Sizes) -> bool {
        let tie = self.lower >= -sizes.zero && self.upper <= sizes.zero;
        self.lower > sizes.near || self.upper < -sizes.near || tie
    }

    fn learn(&mut self, other: Self) {
        if other.lower > self.lower {
            (self.lower, self.weights) = (other.lower, other.weights);
        }
        if other.upper < self.upper {
            (self.upper, self.motion) = (other.upper, other.motion);
        }
    }
}

/// Bounds on s for unit rows that settle its sign, where the tolerances allow it.
#[inline(always)]
pub fn closure<const D: usize>(rows: &[[f64; D]], sizes: Sizes) -> Bounds<D> {
    let mut bounds = at_once(rows);
    if bounds.settled(sizes) || rows.is_empty() {
        return bounds;
    }
    for factor in [1.0, 0.01, 100.0] {
        bounds.learn(by_partition(rows, sizes.tie * factor));
        if bounds.settled(sizes) {
            break;
        }
    }
    bounds
}

/// Part of its target that a least-squares residual is, at least, to be a motion that leaves the rows for sure.
const CLEARLY_LEAVING: f64 = 1e-6;

/// Bounds from one nonnegative least squares.
#[inline(always)]
pub fn at_once<const D: usize>(rows: &[[f64; D]]) -> Bounds<D> {
    let mut bounds = Bounds::nothing();
    let target = rows.iter().fold([0.0; D], |sum, row| plus(&sum, -1.0, row));
    if rows.is_empty() {
        let mut first = [0.0; D];
        first[0] = 1.0;
        return Bounds { upper: -1.0, motion: Some(first), ..bounds };
    }
    let found = nonnegative_least_squares(rows, &target);
    let size = norm(&found.residual);
    if size > CLEARLY_LEAVING * norm(&target) || rows.len() <= D {
        (bounds.upper, bounds.motion) = leaving(rows, &found);
        return bounds;
    }
    // small or none: both answers are tried, and the one that holds is taken
    let mut weights: Vec<f64> = rows.iter().map(|row| f64::from(u8::from(norm(row) > 0.0))).collect();
    for &(row, weight) in &found.passive {
        weights[row] += weight;
    }
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= total);
    bounds.lower = lower_bound(rows, &weights);
    bounds.weights = weights;
    if bounds.lower <= 0.0 && size > 0.0 {
        (bounds.upper, bounds.motion) = leaving(rows, &found);
    }
    bounds
}

/// The residual, and a step further off the rows that take part: an upper bound on s with its motion.
#[inline(always)]
fn leaving<const D: usize>(rows: &[[f64; D]], found: &Nonnegative<D>) -> (f64, Option<[f64; D]>) {
    let size = norm(&found.residual);
    if !size.is_normal() {
        return (f64::INFINITY, None);
    }
    let direction = scaled(1.0 / size, &found.residual);
    let y = found.columns.ones();
    // the longest step t for which every row is left by at least t: d_i . (r - t y) <= -t
    let mut step = 1.0f64;
    for (index, row) in rows.iter().enumerate() {
        if found.passive.iter().any(|&(passive, _)| passive == index) || norm(row) == 0.0 {
            continue;
        }
        let (gap, slope) = (-dot(row, &direction), 1.0 - dot(row, &y));
        if slope > 0.0 {
            step = step.min(gap / slope);
        } else if gap < 0.0 {
            step = 0.0;
        }
    }
    let straight = upper_bound(rows, &direction);
    if step > 0.0 {
        let further = unit(&plus(&direction, -step, &y));
        let upper = upper_bound(rows, &further);
        if upper < straight {
            return (upper, Some(further));
        }
    }
    (straight, Some(direction))
}

fn by_partition<const D: usize>(rows: &[[f64; D]], zero: f64) -> Bounds<D> {
    let partition = tucker_partition(rows, zero);
    let mut bounds = Bounds::nothing();
    if let Some(motion) = partition.escape() {
        bounds.upper = upper_bound(rows, &motion);
        bounds.motion = Some(motion);
    }
    if partition.balanced.iter().any(|&b| b) {
        bounds.lower = lower_bound(rows, &partition.weights);
        bounds.weights = partition.weights;
    }
    bounds
}
