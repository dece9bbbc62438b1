//! A ray once more as the null vector of the rows it lies on, which takes out what the steps have accumulated.

use crate::vector::{dot, norm, plus, unit};

/// The ray without its part in the span of `rows`, if they span all but one dimension, each clear of `sharp`.
///
/// The span's basis is picked by pivoting, the longest remainder first, so that rows that are nearly dependent (repeats,
/// ties within the tolerance) do not spoil it; each remainder is orthogonalised twice, which is enough. Where the rows do
/// not pin the ray down sharply, the step's own ray is as good, and nothing is returned.
pub fn polished<'a, const D: usize>(
    ray: &[f64; D],
    rows: impl Iterator<Item = &'a [f64; D]>,
    sharp: f64,
) -> Option<[f64; D]> {
    let mut rest: Vec<[f64; D]> = rows.copied().collect();
    let mut better = *ray;
    let mut basis: Vec<[f64; D]> = Vec::with_capacity(D);
    while basis.len() + 1 < D {
        let longest = (0..rest.len()).max_by(|&a, &b| norm(&rest[a]).total_cmp(&norm(&rest[b])))?;
        let mut pivot = rest.swap_remove(longest);
        if norm(&pivot) <= sharp {
            return None;
        }
        for other in &basis {
            pivot = plus(&pivot, -dot(other, &pivot), other);
        }
        let pivot = unit(&pivot);
        for row in &mut rest {
            *row = plus(row, -dot(&pivot, row), &pivot);
        }
        basis.push(pivot);
    }
    for _ in 0..2 {
        for pivot in &basis {
            better = plus(&better, -dot(pivot, &better), pivot);
        }
        better = unit(&better);
    }
    (dot(&better, ray) > 0.9).then_some(better)
}
