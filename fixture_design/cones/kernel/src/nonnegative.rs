//! Least squares with nonnegative unknowns (C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974, ch. 23).
//!
//! Of all w >= 0 the one that brings D^T w nearest to a target b. What is left, r = b - D^T w, is the answer that the
//! cone layer wants: r = 0 says that b lies in the cone of the rows, and otherwise d_i . r <= 0 for every row and
//! b . r = |r|^2 > 0, so r separates. The residual comes from the orthonormal basis of the rows that take part, not from
//! b - D^T w, whose rounding would be taken for a direction.

use crate::orthogonal::Columns;
use crate::vector::{dot, norm, plus};

/// A row enters only if it points along the residual by this much, relative to both [-].
const IMPROVES: f64 = 1e-13;
/// A residual this small next to the target is rounding [-].
const REACHED: f64 = 1e-15;
/// A row this near to the span of those that take part adds nothing but rounding [-].
const DEPENDENT: f64 = 1e-13;

pub struct Nonnegative<const D: usize> {
    /// The rows that take part, with their weights > 0.
    pub passive: Vec<(usize, f64)>,
    /// Orthonormal basis of them, in the same order.
    pub columns: Columns<D>,
    /// b - D^T w, from the basis.
    pub residual: [f64; D],
}

/// The w >= 0 that minimises |D^T w - b|, for rows d_i of any positive length.
#[inline(always)]
pub fn nonnegative_least_squares<const D: usize>(rows: &[[f64; D]], target: &[f64; D]) -> Nonnegative<D> {
    let mut passive: Vec<(usize, f64)> = Vec::with_capacity(D);
    let mut columns = Columns::<D>::new();
    let mut residual = *target;
    let mut refused: Vec<usize> = Vec::new();
    let enough = REACHED * norm(target);
    // each round shortens the residual, so that no set of rows returns; rounding may stall it, hence the limit
    for _ in 0..10 * rows.len() + 50 {
        let size = norm(&residual);
        if size <= enough {
            break;
        }
        let mut entering = (usize::MAX, IMPROVES * size);
        for (index, row) in rows.iter().enumerate() {
            let along = dot(row, &residual);
            // most rows do not improve on the best so far, so the lists are seldom looked at
            if along > entering.1 && !refused.contains(&index) && !passive.iter().any(|&(p, _)| p == index) {
                entering = (index, along);
            }
        }
        let entering = entering.0;
        if entering == usize::MAX {
            break;
        }
        if !columns.push(&rows[entering], DEPENDENT) {
            refused.push(entering);
            continue;
        }
        passive.push((entering, 0.0));
        let mut trial = columns.solve(target);
        if trial[passive.len() - 1] <= 0.0 {
            columns.remove(passive.len() - 1);
            passive.pop();
            refused.push(entering);
            continue;
        }
        // back to where the first weights reach zero; their rows leave
        while trial[..passive.len()].iter().any(|&weight| weight <= 0.0) {
            let mut step = 1.0f64;
            let mut leaving = 0;
            for (k, &(_, weight)) in passive.iter().enumerate() {
                if trial[k] <= 0.0 && weight / (weight - trial[k]) <= step {
                    step = weight / (weight - trial[k]);
                    leaving = k;
                }
            }
            for (k, (_, weight)) in passive.iter_mut().enumerate() {
                *weight += step * (trial[k] - *weight);
            }
            passive[leaving].1 = 0.0;
            for k in (0..passive.len()).rev() {
                if passive[k].1 <= 0.0 {
                    passive.remove(k);
                    columns.remove(k);
                }
            }
            trial = columns.solve(target);
        }
        for (k, (_, weight)) in passive.iter_mut().enumerate() {
            *weight = trial[k];
        }
        let shorter = columns.residual(target);
        if norm(&shorter) < size {
            refused.clear();
        } else {
            refused.push(entering);
        }
        residual = shorter;
    }
    Nonnegative { passive, columns, residual }
}

impl<const D: usize> Nonnegative<D> {
    /// D^T w, summed anew.
    pub fn reached(&self, rows: &[[f64; D]]) -> [f64; D] {
        self.passive.iter().fold([0.0; D], |sum, &(row, weight)| plus(&sum, weight, &rows[row]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_answer_meets_its_optimality_conditions() {
        let mut random = Random::new(3);
        for count in [0, 1, 3, 6, 12, 60] {
            for _ in 0..100 {
                let rows: Vec<[f64; 6]> = (0..count).map(|_| random.vector()).collect();
                let target = random.vector();
                let found = nonnegative_least_squares(&rows, &target);
                let rest = plus(&target, -1.0, &found.reached(&rows));
                assert!(norm(&plus(&rest, -1.0, &found.residual)) < 1e-9);
                assert!(found.passive.iter().all(|&(_, weight)| weight > 0.0));
                assert!(rows.iter().all(|row| dot(row, &found.residual) <= 1e-12));
            }
        }
    }
}
