//! Tucker's partition: which rows balance, which leave, for any system D u <= 0; the Python module says what it is for.
//!
//! Facial reduction: the nearest point of the rows' hull either separates them all, or is the origin and its rows
//! balance; the others are projected along the span of the balanced ones, and so on, at most D times. Every zero test
//! is recorded.

use crate::minimum_norm::minimum_norm_point;
use crate::singular::Singular;
use crate::vector::{dot, norm, plus, scaled, unit};

/// Singular values below this, relative to the largest, are rounding in the core's pseudo-inverse [-].
const PSEUDO_RANK: f64 = 1e-14;
/// Projected weights are taken as they are if the smallest is at least this part of the largest [-].
const EVEN_ENOUGH: f64 = 1e-3;

pub struct TuckerPartition<const D: usize> {
    pub balanced: Vec<bool>,
    pub weights: Vec<f64>,
    pub span: Vec<[f64; D]>,
    pub motion: Option<[f64; D]>,
    pub zero_max: f64,
    pub nonzero_min: f64,
}

impl<const D: usize> TuckerPartition<D> {
    /// Whether face{D} is {o}: the balanced rows have full rank.
    pub fn closes(&self) -> bool {
        self.span.len() == D
    }

    /// Some unit u != 0 of face{D}: the motion that leaves most, or one along the lines.
    pub fn escape(&self) -> Option<[f64; D]> {
        if self.motion.is_some() || self.closes() {
            return self.motion;
        }
        Some(Singular::of(&self.span, D).right[self.span.len()])
    }
}

/// Split unit rows into balanced and leaving ones; numbers up to `zero` are zeros.
pub fn tucker_partition<const D: usize>(rows: &[[f64; D]], zero: f64) -> TuckerPartition<D> {
    let count = rows.len();
    let mut balanced = vec![false; count];
    let mut span: Vec<[f64; D]> = Vec::new();
    let mut free: Vec<[f64; D]> = identity();
    let (mut zero_max, mut nonzero_min) = (0.0f64, f64::INFINITY);
    let mut motion = None;
    let mut core: Vec<(usize, f64)> = Vec::new();
    while !free.is_empty() && !balanced.iter().all(|&b| b) {
        let mut rest = Vec::new();
        let mut units = Vec::new();
        let mut lengths = Vec::new();
        for (index, row) in rows.iter().enumerate().filter(|&(index, _)| !balanced[index]) {
            let projected = coordinates(row, &free);
            let length = norm(&projected);
            if length > zero {
                nonzero_min = nonzero_min.min(length);
                rest.push(index);
                lengths.push(length);
                units.push(scaled(1.0 / length, &projected));
            } else {
                // -d_i is already in the cone of the balanced rows, which is all of their span
                zero_max = zero_max.max(length);
            }
        }
        balanced.iter_mut().for_each(|b| *b = true);
        rest.iter().for_each(|&index| balanced[index] = false);
        if rest.is_empty() {
            break;
        }
        let nearest = minimum_norm_point(&units);
        let distance = norm(&nearest.point);
        if distance > zero {
            nonzero_min = nonzero_min.min(distance);
            motion = Some(combination(&nearest.point, &free).map(|value| -value / distance));
            break;
        }
        zero_max = zero_max.max(distance);
        // weights at the level of the tolerance are rounding; they must not let a row into the balance
        let chosen: Vec<(usize, f64)> = nearest.weights.into_iter().filter(|&(_, weight)| weight > zero).collect();
        let mut level = Vec::new();
        let mut supporting = Vec::new();
        for &(place, weight) in &chosen {
            nonzero_min = nonzero_min.min(weight);
            balanced[rest[place]] = true;
            level.push((rest[place], weight / lengths[place]));
            supporting.push(units[place]);
        }
        core = with_level(rows, &core, &level);
        // in the coordinates of `free`: a row almost along the old span has lost its digits in others
        let found = Singular::of(&supporting, free.len());
        let rank = found.rank(zero).max(1);
        if rank < free.len() {
            zero_max = zero_max.max(found.values[rank]);
        }
        nonzero_min = nonzero_min.min(found.values[rank - 1]);
        let turned: Vec<[f64; D]> = found.right[..free.len()].iter().map(|v| combination(v, &free)).collect();
        span.extend_from_slice(&turned[..rank]);
        free = turned[rank..].to_vec();
    }
    if free.is_empty() {
        balanced.iter_mut().for_each(|b| *b = true); // the balanced rows span everything: all others balance against them
    }
    let chosen: Vec<usize> = (0..count).filter(|&index| balanced[index]).collect();
    let mut weights = vec![0.0; count];
    if !chosen.is_empty() {
        let of_balanced: Vec<[f64; D]> = chosen.iter().map(|&index| rows[index]).collect();
        let found = Singular::of(&of_balanced, D);
        if !free.is_empty() {
            // the steps have lost digits; the balanced rows' own singular vectors are as orthogonal to them as can be
            free = found.right[span.len()..].to_vec();
            span.truncate(found.right.len() - free.len());
            span.copy_from_slice(&found.right[..D - free.len()]);
        }
        let even = positive_balance(rows, &chosen, &of_balanced, &core, &found, zero);
        for (&index, weight) in chosen.iter().zip(even) {
            weights[index] = weight;
        }
    }
    let motion = motion.map(|u| unit(&combination(&coordinates(&u, &free), &free)));
    TuckerPartition { balanced, weights, span, motion, zero_max, nonzero_min }
}

fn identity<const D: usize>() -> Vec<[f64; D]> {
    (0..D).map(|i| std::array::from_fn(|k| f64::from(u8::from(i == k)))).collect()
}

fn coordinates<const D: usize>(vector: &[f64; D], basis: &[[f64; D]]) -> [f64; D] {
    let mut along = [0.0; D];
    for (place, axis) in along.iter_mut().zip(basis) {
        *place = dot(axis, vector);
    }
    along
}

fn combination<const D: usize>(along: &[f64; D], basis: &[[f64; D]]) -> [f64; D] {
    basis.iter().zip(along).fold([0.0; D], |sum, (axis, &factor)| plus(&sum, factor, axis))
}

fn sum_of<const D: usize>(rows: &[[f64; D]], weights: &[(usize, f64)]) -> [f64; D] {
    weights.iter().fold([0.0; D], |sum, &(row, weight)| plus(&sum, weight, &rows[row]))
}

/// Positive balanced weights on the rows of earlier levels and of this one.
///
/// The new rows balance up to something in the span of the core; the core takes that up, with any sign, and enough of its
/// own positive balance makes the signs right.
fn with_level<const D: usize>(rows: &[[f64; D]], core: &[(usize, f64)], level: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let mut all: Vec<(usize, f64)> = if core.is_empty() {
        level.to_vec()
    } else {
        let taken_up = PseudoInverse::of(rows, core).taken_up(&sum_of(rows, level));
        let lower = core.iter().zip(taken_up).map(|(&(row, own), extra)| (row, own + extra));
        lower.chain(level.iter().copied()).collect()
    };
    let total: f64 = all.iter().map(|&(_, weight)| weight).sum();
    all.iter_mut().for_each(|(_, weight)| *weight /= total);
    all
}

/// What takes a wrench from the span of the core to weights of its rows.
struct PseudoInverse<'a, const D: usize> {
    core: &'a [(usize, f64)],
    /// For each row of the core its coefficients: x_k = row k . wrench.
    solver: Vec<[f64; D]>,
}

impl<'a, const D: usize> PseudoInverse<'a, D> {
    fn of(rows: &[[f64; D]], core: &'a [(usize, f64)]) -> Self {
        let vectors: Vec<[f64; D]> = core.iter().map(|&(row, _)| rows[row]).collect();
        let found = Singular::of(&vectors, D);
        let rank = found.rank(PSEUDO_RANK * found.values[0]);
        let row_of = |vector: &[f64; D]| {
            (0..rank).fold([0.0; D], |sum, j| {
                let right = &found.right[j];
                plus(&sum, dot(vector, right) / (found.values[j] * found.values[j]), right)
            })
        };
        Self { core, solver: vectors.iter().map(row_of).collect() }
    }

    /// Nonnegative weights of the core that balance a wrench from its span.
    fn taken_up(&self, wrench: &[f64; D]) -> Vec<f64> {
        let signed: Vec<f64> = self.solver.iter().map(|row| -dot(row, wrench)).collect();
        let lift = signed.iter().zip(self.core).map(|(x, &(_, own))| -x / own).fold(0.0, f64::max);
        signed.iter().zip(self.core).map(|(x, &(_, own))| (x + lift * own).max(0.0)).collect()
    }
}

/// Weights w > 0, sum 1, with D^T w = 0, for the rows that balance; as even as one projection makes them.
///
/// The nearest balanced weights to (1, ..., 1) are positive for most sets; else every row is balanced by the core, the
/// few rows that span what all of them do, and the sum is projected once more to take its rounding out.
fn positive_balance<const D: usize>(
    rows: &[[f64; D]],
    chosen: &[usize],
    balanced: &[[f64; D]],
    core: &[(usize, f64)],
    found: &Singular<D>,
    zero: f64,
) -> Vec<f64> {
    let across = across(balanced, found, found.rank(zero));
    let mut even = vec![1.0; balanced.len()];
    project_out(&mut even, &across);
    let (least, most) = extremes(&even);
    if least > EVEN_ENOUGH * most {
        return normalised(even);
    }
    let solver = PseudoInverse::of(rows, core);
    let mut total = vec![0.0; rows.len()];
    for (row, &index) in balanced.iter().zip(chosen) {
        let own = solver.taken_up(row);
        let sum = 1.0 + own.iter().sum::<f64>();
        for (&(place, _), weight) in core.iter().zip(own) {
            total[place] += weight / sum;
        }
        total[index] += 1.0 / sum;
    }
    let total: Vec<f64> = chosen.iter().map(|&index| total[index]).collect();
    let mut projected = total.clone();
    project_out(&mut projected, &across);
    normalised(if extremes(&projected).0 > 0.0 { projected } else { total })
}

/// Orthonormal basis of the first left singular vectors.
fn across<const D: usize>(rows: &[[f64; D]], found: &Singular<D>, rank: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(rank);
    for right in &found.right[..rank] {
        let mut left: Vec<f64> = rows.iter().map(|row| dot(row, right)).collect();
        let size = left.iter().map(|v| v * v).sum::<f64>().sqrt();
        left.iter_mut().for_each(|v| *v /= size);
        project_out(&mut left, &basis);
        let size = left.iter().map(|v| v * v).sum::<f64>().sqrt();
        left.iter_mut().for_each(|v| *v /= size);
        basis.push(left);
    }
    basis
}

/// Take the part in the span of orthonormal vectors out, twice for the sake of rounding.
fn project_out(vector: &mut [f64], basis: &[Vec<f64>]) {
    for _ in 0..2 {
        for axis in basis {
            let along: f64 = axis.iter().zip(vector.iter()).map(|(a, v)| a * v).sum();
            for (v, a) in vector.iter_mut().zip(axis) {
                *v -= along * a;
            }
        }
    }
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
}

fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= total);
    weights
}
