//! Singular values and right singular vectors of rows in R^D, by one-sided Jacobi rotations (M. R. Hestenes, 1958).
//!
//! Rotations of pairs of columns go on until all are orthogonal; their lengths are then the singular values, each accurate
//! relative to itself for columns of like length (J. Demmel, K. Veselic, 1992). Many rows are reduced to a D x D triangle
//! by reflections first.

/// Columns whose cosine is below this are orthogonal [-].
const ORTHOGONAL: f64 = 1e-16;
/// Sweeps over all pairs; five to eight do in practice.
const SWEEPS: usize = 40;

/// The singular values, largest first, with their right vectors.
pub struct Singular<const D: usize> {
    pub values: [f64; D],
    pub right: [[f64; D]; D],
}

impl<const D: usize> Singular<D> {
    /// Of the first `width` coordinates; the rest of `values` and `right` stays zero.
    pub fn of(rows: &[[f64; D]], width: usize) -> Self {
        let mut columns: Vec<Vec<f64>> = (0..width).map(|k| rows.iter().map(|row| row[k]).collect()).collect();
        if rows.len() > 2 * width {
            triangle(&mut columns);
        }
        let mut right = [[0.0; D]; D];
        for (k, vector) in right.iter_mut().enumerate().take(width) {
            vector[k] = 1.0;
        }
        for _ in 0..SWEEPS {
            let mut turned = false;
            for first in 0..width {
                for second in first + 1..width {
                    turned |= rotate(&mut columns, &mut right, first, second);
                }
            }
            if !turned {
                break;
            }
        }
        let mut sizes: Vec<(f64, usize)> = columns.iter().map(|c| length(c)).zip(0..).collect();
        sizes.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut sorted = Self { values: [0.0; D], right: [[0.0; D]; D] };
        for (place, &(value, k)) in sizes.iter().enumerate() {
            sorted.values[place] = value;
            sorted.right[place] = right[k];
        }
        sorted
    }

    pub fn rank(&self, zero: f64) -> usize {
        self.values.iter().filter(|&&value| value > zero).count()
    }
}

fn length(column: &[f64]) -> f64 {
    column.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Make two columns orthogonal; whether they were not.
fn rotate<const D: usize>(columns: &mut [Vec<f64>], right: &mut [[f64; D]; D], first: usize, second: usize) -> bool {
    let (head, tail) = columns.split_at_mut(second);
    let (a, b) = (&mut head[first], &mut tail[0]);
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b.iter()) {
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    if ab == 0.0 || ab.abs() <= ORTHOGONAL * aa.sqrt() * bb.sqrt() {
        return false;
    }
    let zeta = (bb - aa) / (2.0 * ab);
    let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = c * t;
    if s == 0.0 {
        return false; // the columns' lengths are so different that the angle underflows
    }
    for (x, y) in a.iter_mut().zip(b.iter_mut()) {
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    }
    for k in 0..D {
        let (x, y) = (right[first][k], right[second][k]);
        right[first][k] = c * x - s * y;
        right[second][k] = s * x + c * y;
    }
    true
}

/// Householder reflections: the columns' triangle, with the same singular values and right vectors.
fn triangle(columns: &mut [Vec<f64>]) {
    let width = columns.len();
    for k in 0..width {
        let mut mirror: Vec<f64> = columns[k][k..].to_vec();
        let size = length(&mirror);
        if size == 0.0 {
            continue;
        }
        mirror[0] += if mirror[0] >= 0.0 { size } else { -size };
        let squared: f64 = mirror.iter().map(|v| v * v).sum();
        for column in columns.iter_mut().skip(k) {
            let along: f64 = column[k..].iter().zip(&mirror).map(|(x, m)| x * m).sum();
            for (x, m) in column[k..].iter_mut().zip(&mirror) {
                *x -= 2.0 * along / squared * m;
            }
        }
    }
    for column in columns {
        column.truncate(width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::vector::{dot, norm};

    #[test]
    fn the_vectors_are_orthonormal_and_the_values_are_the_rows_lengths_along_them() {
        let mut random = Random::new(2);
        for count in [0, 1, 2, 4, 9, 40] {
            let rows: Vec<[f64; 4]> = (0..count).map(|_| random.vector()).collect();
            let found = Singular::of(&rows, 4);
            for (i, v) in found.right.iter().enumerate() {
                let along: Vec<f64> = rows.iter().map(|row| dot(row, v)).collect();
                assert!((length(&along) - found.values[i]).abs() < 1e-13);
                assert!((norm(v) - 1.0).abs() < 1e-13);
                assert!(found.right[..i].iter().all(|w| dot(v, w).abs() < 1e-13));
            }
            assert!(found.values.is_sorted_by(|a, b| a >= b));
            assert_eq!(found.rank(1e-9), count.min(4));
        }
    }
}
