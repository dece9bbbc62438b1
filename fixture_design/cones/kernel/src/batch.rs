//! Closure of many sets of rows at once, on several cores.

use std::thread;

use crate::closure::{Bounds, Sizes, closure};
use crate::exact::tucker::sign_of_closure;
use crate::nonnegative::nonnegative_least_squares;

/// Sets of rows in one flat array: set k has the rows indices[offsets[k]..offsets[k + 1]], or, without indices, those
/// places themselves.
pub struct Ragged<'a, const D: usize> {
    pub rows: &'a [[f64; D]],
    pub indices: Option<&'a [i64]>,
    pub offsets: &'a [i64],
}

impl<const D: usize> Ragged<'_, D> {
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    #[inline(always)]
    fn set(&self, number: usize, buffer: &mut Vec<[f64; D]>) {
        let (start, end) = (self.offsets[number] as usize, self.offsets[number + 1] as usize);
        buffer.clear();
        match self.indices {
            None => buffer.extend_from_slice(&self.rows[start..end]),
            Some(indices) => buffer.extend(indices[start..end].iter().map(|&row| self.rows[row as usize])),
        }
    }
}

/// What each set came to: bounds on s and, where asked for, what proves them.
pub struct Answers {
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// One a place of the ragged sets, zero where there are none; empty if not asked for.
    pub weights: Vec<f64>,
    /// D a set, zero where there is none; empty if not asked for.
    pub motions: Vec<f64>,
}

/// The closure of every set, divided over `threads` threads.
pub fn closures<const D: usize>(sets: &Ragged<D>, sizes: Sizes, witnesses: bool, threads: usize) -> Answers {
    let count = sets.len();
    let places = sets.offsets[count] as usize;
    let mut answers = Answers {
        lower: vec![0.0; count],
        upper: vec![0.0; count],
        weights: vec![0.0; if witnesses { places } else { 0 }],
        motions: vec![0.0; if witnesses { count * D } else { 0 }],
    };
    let piece = count.div_ceil(threads.max(1)).max(1);
    thread::scope(|scope| {
        let (mut weights, mut motions) = (&mut answers.weights[..], &mut answers.motions[..]);
        let bounds = answers.lower.chunks_mut(piece).zip(answers.upper.chunks_mut(piece));
        let mut workers = Vec::new();
        for (number, (lower, upper)) in bounds.enumerate() {
            let first = number * piece;
            let mine = if witnesses { sets.offsets[first + lower.len()] - sets.offsets[first] } else { 0 };
            let (own_weights, rest) = weights.split_at_mut(mine as usize);
            weights = rest;
            let (own_motions, rest) = motions.split_at_mut(if witnesses { lower.len() * D } else { 0 });
            motions = rest;
            let mut run = move || run(sets, sizes, first, lower, upper, own_weights, own_motions);
            if threads <= 1 { run() } else { workers.push(scope.spawn(run)) }
        }
        for worker in workers {
            // a panic of a worker goes on in the caller, whose border catches it
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    answers
}

/// How near the cone of each set comes to a vector, and what is left.
pub struct Distances {
    /// D a set: the vector less its nearest point of the cone.
    pub residuals: Vec<f64>,
    /// One a place of the ragged sets: the nearest point's weights.
    pub weights: Vec<f64>,
}

/// For every set the point of its cone nearest to a vector of its own, divided over `threads` threads.
pub fn memberships<const D: usize>(sets: &Ragged<D>, vectors: &[[f64; D]], threads: usize) -> Distances {
    let count = sets.len();
    let mut residuals = vec![0.0; count * D];
    let mut weights = vec![0.0; sets.offsets[count] as usize];
    let piece = count.div_ceil(threads.max(1)).max(1);
    thread::scope(|scope| {
        let mut left = &mut weights[..];
        let mut workers = Vec::new();
        for (number, mine) in residuals.chunks_mut(piece * D).enumerate() {
            let first = number * piece;
            let places = sets.offsets[first + mine.len() / D] - sets.offsets[first];
            let (own, rest) = left.split_at_mut(places as usize);
            left = rest;
            workers.push(scope.spawn(move || {
                let mut rows = Vec::new();
                for (k, residual) in mine.chunks_exact_mut(D).enumerate() {
                    sets.set(first + k, &mut rows);
                    let found = nonnegative_least_squares(&rows, &vectors[first + k]);
                    residual.copy_from_slice(&found.residual);
                    let place = (sets.offsets[first + k] - sets.offsets[first]) as usize;
                    for (row, weight) in found.passive {
                        own[place + row] = weight;
                    }
                }
            }));
        }
        for worker in workers {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    Distances { residuals, weights }
}

/// The exact sign of s of every set, divided over `threads` threads.
pub fn signs<const D: usize>(sets: &Ragged<D>, filter: bool, threads: usize) -> Vec<i8> {
    let mut signs = vec![0; sets.len()];
    let piece = sets.len().div_ceil(threads.max(1)).max(1);
    thread::scope(|scope| {
        let workers: Vec<_> = signs
            .chunks_mut(piece)
            .enumerate()
            .map(|(number, mine)| {
                scope.spawn(move || {
                    let mut rows = Vec::new();
                    for (k, sign) in mine.iter_mut().enumerate() {
                        sets.set(number * piece + k, &mut rows);
                        *sign = sign_of_closure(&rows, filter);
                    }
                })
            })
            .collect();
        for worker in workers {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    signs
}

fn run<const D: usize>(
    sets: &Ragged<D>,
    sizes: Sizes,
    first: usize,
    lower: &mut [f64],
    upper: &mut [f64],
    weights: &mut [f64],
    motions: &mut [f64],
) {
    let mut rows = Vec::new();
    let mut place = 0;
    for k in 0..lower.len() {
        sets.set(first + k, &mut rows);
        let found: Bounds<D> = closure(&rows, sizes);
        (lower[k], upper[k]) = (found.lower, found.upper);
        if weights.len() >= place + rows.len() && !found.weights.is_empty() {
            weights[place..place + rows.len()].copy_from_slice(&found.weights);
        }
        place += rows.len();
        if let (Some(motion), false) = (found.motion, motions.is_empty()) {
            motions[k * D..(k + 1) * D].copy_from_slice(&motion);
        }
    }
}
