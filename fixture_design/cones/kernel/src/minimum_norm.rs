//! The point of a convex hull nearest to the origin (P. Wolfe, Finding the nearest point in a polytope, 1976).
//!
//! For unit rows it decides the sign of s = min over |u| = 1 of max_i d_i . u from below: if the nearest point x is not
//! the origin, then s = -|x|, attained by u = -x / |x|; if it is, the weights of x prove s >= 0.

use crate::orthogonal::Columns;
use crate::vector::{dot, norm, plus};

/// The hull is taken to reach the origin when the nearest point is closer than this to it, relative to the rows [-].
const ARRIVED: f64 = 4e-16;
/// A row improves the point only if it beats it by this much, relative to the point's own length [-].
const IMPROVES: f64 = 1e-13;
/// Differences of corral rows this near to dependent are dependent [-].
const DEPENDENT: f64 = 1e-14;

/// The nearest point and the rows it is made of, with weights > 0 of sum 1.
pub struct NearestPoint<const D: usize> {
    pub point: [f64; D],
    pub weights: Vec<(usize, f64)>,
}

/// Nearest point of conv{rows} to the origin; at least one row, of comparable length.
pub fn minimum_norm_point<const D: usize>(rows: &[[f64; D]]) -> NearestPoint<D> {
    let mut first = 0;
    let mut size = 0.0f64;
    for (index, row) in rows.iter().enumerate() {
        size = size.max(norm(row));
        if norm(row) < norm(&rows[first]) {
            first = index;
        }
    }
    let mut corral = vec![(first, 1.0)];
    let mut point = rows[first];
    let mut length = norm(&point);
    let mut refused: Vec<usize> = Vec::new();
    let mut seen = vec![members(&corral)];
    // in exact arithmetic every major cycle shortens the point, so that no corral returns. A step along almost all of a
    // unit row from a point close to the origin gains less than rounding, yet the next one may go all the way: steps
    // that lose no more than rounding are taken too, and corrals that return are refused.
    for _ in 0..20 * rows.len() + 200 {
        // d + 1 independent rows around the origin: what is left of the length is rounding, and no row can take it out
        let around = corral.len() > D && length <= IMPROVES * size;
        if around || length <= ARRIVED * size {
            break;
        }
        let mut entering = (usize::MAX, length * (length - IMPROVES * size));
        for (index, row) in rows.iter().enumerate() {
            let height = dot(row, &point);
            if height < entering.1 && !refused.contains(&index) && !corral.iter().any(|&(c, _)| c == index) {
                entering = (index, height);
            }
        }
        let entering = entering.0;
        if entering == usize::MAX {
            break;
        }
        let mut candidate = corral.clone();
        candidate.push((entering, 0.0));
        descend(rows, &mut candidate);
        let new_point = candidate.iter().fold([0.0; D], |sum, &(row, weight)| plus(&sum, weight, &rows[row]));
        let new_length = norm(&new_point);
        let names = members(&candidate);
        if new_length > length + ARRIVED * size || seen.contains(&names) {
            refused.push(entering);
            continue;
        }
        seen.push(names);
        (corral, point, length) = (candidate, new_point, new_length);
        refused.clear();
    }
    NearestPoint { point, weights: corral }
}

fn members(corral: &[(usize, f64)]) -> Vec<usize> {
    let mut names: Vec<usize> = corral.iter().map(|&(row, _)| row).collect();
    names.sort_unstable();
    names
}

/// Minor cycles: go to the point of the corral's affine hull nearest to the origin, dropping rows on the way.
fn descend<const D: usize>(rows: &[[f64; D]], corral: &mut Vec<(usize, f64)>) {
    loop {
        let target = affine_minimizer(rows, corral);
        if target.iter().all(|&weight| weight > 0.0) {
            for ((_, weight), goal) in corral.iter_mut().zip(target) {
                *weight = goal;
            }
            return;
        }
        let mut step = f64::INFINITY;
        let mut leaving = 0;
        for (k, (&(_, weight), &goal)) in corral.iter().zip(&target).enumerate() {
            let until = weight / (weight - goal).max(1e-300);
            if goal <= 0.0 && until < step {
                (step, leaving) = (until, k);
            }
        }
        for ((_, weight), goal) in corral.iter_mut().zip(&target) {
            *weight += step * (goal - *weight);
        }
        corral[leaving].1 = 0.0;
        corral.retain(|&(_, weight)| weight > 0.0);
        let total: f64 = corral.iter().map(|&(_, weight)| weight).sum();
        for (_, weight) in corral.iter_mut() {
            *weight /= total;
        }
        if corral.len() <= 1 {
            return;
        }
    }
}

/// Affine coordinates of the point of the corral's affine hull nearest to the origin, by least squares over differences.
fn affine_minimizer<const D: usize>(rows: &[[f64; D]], corral: &[(usize, f64)]) -> Vec<f64> {
    let base = &rows[corral[0].0];
    let mut columns = Columns::<D>::new();
    let mut independent = Vec::with_capacity(corral.len());
    for (k, &(row, _)) in corral.iter().enumerate().skip(1) {
        if columns.push(&plus(&rows[row], -1.0, base), DEPENDENT) {
            independent.push(k);
        }
    }
    let solution = columns.solve(&base.map(|value| -value));
    let mut weights = vec![0.0; corral.len()];
    weights[0] = 1.0;
    for (&k, &weight) in independent.iter().zip(&solution) {
        weights[k] = weight;
        weights[0] -= weight;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn no_row_is_nearer_than_the_nearest_point() {
        let mut random = Random::new(4);
        for count in [1, 2, 5, 9, 40] {
            for _ in 0..100 {
                let rows: Vec<[f64; 4]> = (0..count).map(|_| random.vector()).collect();
                let found = minimum_norm_point(&rows);
                let total: f64 = found.weights.iter().map(|&(_, weight)| weight).sum();
                assert!((total - 1.0).abs() < 1e-12);
                let squared = dot(&found.point, &found.point);
                assert!(rows.iter().all(|row| dot(row, &found.point) >= squared - 1e-12));
            }
        }
    }
}
