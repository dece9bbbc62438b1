//! Least squares on a few columns that come and go: an orthonormal basis Q and a triangle R, kept up to date.
//!
//! A new column is orthogonalised twice against the basis, which is enough for orthogonality to rounding (W. Kahan,
//! B. Parlett: "twice is enough"); a column that leaves makes R upper Hessenberg, and rotations of neighbouring rows mend
//! that. No normal equations are formed: they would square the condition number.

use crate::vector::{dot, norm, plus, scaled};

/// At most D columns of R^D: column k is sum over i <= k of r[k][i] q[i].
#[derive(Clone)]
pub struct Columns<const D: usize> {
    q: [[f64; D]; D],
    r: [[f64; D]; D],
    size: usize,
}

impl<const D: usize> Columns<D> {
    pub const fn new() -> Self {
        Self { q: [[0.0; D]; D], r: [[0.0; D]; D], size: 0 }
    }

    pub fn len(&self) -> usize {
        self.size
    }

    /// Add a column unless what is new in it is at most `dependent` of its length; whether it was added.
    #[inline(always)]
    pub fn push(&mut self, column: &[f64; D], dependent: f64) -> bool {
        if self.size == D {
            return false;
        }
        let mut rest = *column;
        let mut along = [0.0; D];
        for _ in 0..2 {
            for i in 0..self.size {
                let part = dot(&self.q[i], &rest);
                rest = plus(&rest, -part, &self.q[i]);
                along[i] += part;
            }
        }
        let length = norm(&rest);
        if length <= dependent * norm(column) {
            return false;
        }
        along[self.size] = length;
        self.q[self.size] = scaled(1.0 / length, &rest);
        self.r[self.size] = along;
        self.size += 1;
        true
    }

    /// Take column k out; those after it move up.
    #[inline(always)]
    pub fn remove(&mut self, k: usize) {
        for column in k + 1..self.size {
            self.r[column - 1] = self.r[column];
        }
        self.size -= 1;
        for i in k..self.size {
            // rotate rows i and i + 1 so that the subdiagonal element of column i vanishes
            let (top, bottom) = (self.r[i][i], self.r[i][i + 1]);
            let length = top.hypot(bottom);
            let (c, s) = if length > 0.0 { (top / length, bottom / length) } else { (1.0, 0.0) };
            for column in i..self.size {
                let (a, b) = (self.r[column][i], self.r[column][i + 1]);
                self.r[column][i] = c * a + s * b;
                self.r[column][i + 1] = c * b - s * a;
            }
            let (a, b) = (self.q[i], self.q[i + 1]);
            self.q[i] = plus(&scaled(c, &a), s, &b);
            self.q[i + 1] = plus(&scaled(c, &b), -s, &a);
        }
    }

    /// Coefficients of the combination of the columns that is nearest to `target`; the first len() count.
    #[inline(always)]
    pub fn solve(&self, target: &[f64; D]) -> [f64; D] {
        let mut x = [0.0; D];
        for k in (0..self.size).rev() {
            let mut value = dot(&self.q[k], target);
            for column in k + 1..self.size {
                value -= self.r[column][k] * x[column];
            }
            x[k] = value / self.r[k][k];
        }
        x
    }

    /// What the columns cannot reach of `target`, accurate relative to the target.
    #[inline(always)]
    pub fn residual(&self, target: &[f64; D]) -> [f64; D] {
        let mut rest = *target;
        for _ in 0..2 {
            for q in &self.q[..self.size] {
                rest = plus(&rest, -dot(q, &rest), q);
            }
        }
        rest
    }

    /// The shortest y with column . y = 1 for every column.
    #[inline(always)]
    pub fn ones(&self) -> [f64; D] {
        let mut y = [0.0; D];
        let mut x = [0.0; D];
        for k in 0..self.size {
            let mut value = 1.0;
            for i in 0..k {
                value -= self.r[k][i] * x[i];
            }
            x[k] = value / self.r[k][k];
            y = plus(&y, x[k], &self.q[k]);
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn columns_that_come_and_go_leave_least_squares_solutions() {
        let mut random = Random::new(1);
        for _ in 0..200 {
            let mut kept: Vec<[f64; 5]> = Vec::new();
            let mut columns = Columns::<5>::new();
            for _ in 0..12 {
                if kept.len() < 5 && (kept.is_empty() || random.unit() < 0.6) {
                    let column = random.vector();
                    assert!(columns.push(&column, 1e-12));
                    kept.push(column);
                } else {
                    let k = random.below(kept.len());
                    columns.remove(k);
                    kept.remove(k);
                }
                let target = random.vector();
                let x = columns.solve(&target);
                let mut rest = target;
                for (column, &factor) in kept.iter().zip(&x) {
                    rest = plus(&rest, -factor, column);
                }
                let residual = columns.residual(&target);
                for column in &kept {
                    assert!(dot(column, &residual).abs() < 1e-12);
                    assert!((dot(column, &columns.ones()) - 1.0).abs() < 1e-9);
                }
                assert!(norm(&plus(&rest, -1.0, &residual)) < 1e-8);
            }
        }
    }

    #[test]
    fn dependent_columns_are_refused() {
        let mut columns = Columns::<3>::new();
        assert!(columns.push(&[1.0, 2.0, 3.0], 1e-12));
        assert!(!columns.push(&[2.0, 4.0, 6.0], 1e-12));
        assert!(columns.push(&[0.0, 1.0, 0.0], 1e-12));
        assert_eq!(columns.len(), 2);
    }
}
