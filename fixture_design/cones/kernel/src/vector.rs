//! Vectors of R^D as arrays: the few operations that everything here is made of.

#[inline(always)]
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for i in 0..D {
        sum += a[i] * b[i];
    }
    sum
}

#[inline(always)]
pub fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// a + factor * b.
#[inline(always)]
pub fn plus<const D: usize>(a: &[f64; D], factor: f64, b: &[f64; D]) -> [f64; D] {
    let mut sum = *a;
    for i in 0..D {
        sum[i] += factor * b[i];
    }
    sum
}

#[inline(always)]
pub fn scaled<const D: usize>(factor: f64, a: &[f64; D]) -> [f64; D] {
    a.map(|value| factor * value)
}

/// The vector at length one; a zero vector stays as it is.
#[inline(always)]
pub fn unit<const D: usize>(a: &[f64; D]) -> [f64; D] {
    let length = norm(a);
    if length > 0.0 { scaled(1.0 / length, a) } else { *a }
}

/// `flat`, of a multiple of D numbers, as rows.
pub fn rows_of<const D: usize>(flat: &[f64]) -> Vec<[f64; D]> {
    flat.chunks_exact(D).map(|row| row.try_into().expect("chunks of D")).collect()
}

/// Rows as one list of numbers.
pub fn flattened<const D: usize>(rows: &[[f64; D]]) -> Vec<f64> {
    rows.as_flattened().to_vec()
}
