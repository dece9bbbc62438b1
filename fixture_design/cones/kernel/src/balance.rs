//! The largest load that pushes in second-order cones can balance: an interior point, several loads side by side.
//!
//! ```text
//!     minimise c . x  with  A x = b,  x_i = [t, z] in K_i = {|z| <= t},  t = 1 where the cone is a ball,
//! ```
//!
//! for each load l of length 1, where c = M^T l, A = N^T M, b = -N^T f and N spans the space orthogonal to l. The Python
//! module `kernel/balance.py` is the same in numpy and says where the method comes from; what is found here is a guess that
//! proves nothing, and is repaired and proved there.
//!
//! Everything is in scaled variables, where x and s look alike: W s = W^-1 x = lambda. A ball's dt = dtau is a plane in
//! them, of normal W e_t, and is projected out.

use crate::balance_step::{Cone, Embedding};
use crate::lanes::{Chosen, LANES, Lanes, both, dots};

/// What is the same for all loads.
pub struct Pushes<'a, const R: usize> {
    /// R numbers for each column of each cone; a ball's first column is zero.
    pub maps: &'a [[f64; R]],
    pub balls: &'a [bool],
    /// Whether lambda is to be large, or only some x is wanted.
    pub seek: bool,
}

/// Where the interior point ended, homogeneous: forces / size and motions / size solve the load, if size > 0.
pub struct Guesses<const R: usize> {
    pub forces: Vec<f64>,
    pub motions: Vec<[f64; R]>,
    pub sizes: Vec<f64>,
    pub steps: Vec<i64>,
}

/// Steps at most; 9 to 13 are usual.
const STEPS: i64 = 60;
/// Steps at the end that keep tau and the gap and take the residuals to rounding.
const POLISHING: i64 = 2;

/// The interior point for all loads, divided over `threads` threads. M = R - 1 equations; cones are K wide.
pub fn balance_guesses<const R: usize, const M: usize, const K: usize>(
    pushes: &Pushes<R>,
    fixed: &[[f64; R]],
    loads: &[[f64; R]],
    threads: usize,
) -> Guesses<R> {
    let (count, width) = (loads.len(), pushes.balls.len() * K);
    let mut found = Guesses {
        forces: vec![0.0; count * width],
        motions: vec![[0.0; R]; count],
        sizes: vec![0.0; count],
        steps: vec![0; count],
    };
    // whole groups a thread
    let piece = count.div_ceil(threads.max(1)).next_multiple_of(LANES).max(LANES);
    std::thread::scope(|scope| {
        let forces = found.forces.chunks_mut((piece * width).max(1));
        let others = found.motions.chunks_mut(piece).zip(found.sizes.chunks_mut(piece));
        let inputs = fixed.chunks(piece).zip(loads.chunks(piece)).zip(found.steps.chunks_mut(piece));
        let mut workers = Vec::new();
        for ((forces, (motions, sizes)), ((fixed, loads), steps)) in forces.zip(others).zip(inputs) {
            let mut run = move || run_fast::<R, M, K>(pushes, fixed, loads, forces, motions, sizes, steps);
            if threads <= 1 { run() } else { workers.push(scope.spawn(run)) }
        }
        for worker in workers {
            // a panic of a worker goes on in the caller, whose border catches it
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    found
}

/// With the vector instructions that this processor has.
fn run_fast<const R: usize, const M: usize, const K: usize>(
    pushes: &Pushes<R>,
    fixed: &[[f64; R]],
    loads: &[[f64; R]],
    forces: &mut [f64],
    motions: &mut [[f64; R]],
    sizes: &mut [f64],
    steps: &mut [i64],
) {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2")]
        unsafe fn run_avx2<const R: usize, const M: usize, const K: usize>(
            pushes: &Pushes<R>,
            fixed: &[[f64; R]],
            loads: &[[f64; R]],
            forces: &mut [f64],
            motions: &mut [[f64; R]],
            sizes: &mut [f64],
            steps: &mut [i64],
        ) {
            run::<R, M, K>(pushes, fixed, loads, forces, motions, sizes, steps);
        }
        if std::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has what the function was compiled for
            return unsafe { run_avx2::<R, M, K>(pushes, fixed, loads, forces, motions, sizes, steps) };
        }
    }
    run::<R, M, K>(pushes, fixed, loads, forces, motions, sizes, steps);
}

#[inline(always)]
fn run<const R: usize, const M: usize, const K: usize>(
    pushes: &Pushes<R>,
    fixed: &[[f64; R]],
    loads: &[[f64; R]],
    forces: &mut [f64],
    motions: &mut [[f64; R]],
    sizes: &mut [f64],
    steps: &mut [i64],
) {
    let width = pushes.balls.len() * K;
    let mut problem = Embedding::<M, K>::new();
    for first in (0..loads.len()).step_by(LANES) {
        // the last group is filled up with its last load
        let load_of = |lane: usize| (first + lane).min(loads.len() - 1);
        let l: [Lanes; R] = std::array::from_fn(|i| Lanes(std::array::from_fn(|lane| loads[load_of(lane)][i])));
        let f: [Lanes; R] = std::array::from_fn(|i| Lanes(std::array::from_fn(|lane| fixed[load_of(lane)][i])));
        let mirror = mirror_of(&l);
        set_up(&mut problem, pushes, &l, &f, &mirror);
        let taken = solve(&mut problem);
        // q = tau l - N y, with N the columns of the reflection but the first
        let mut padded = [Lanes::ZERO; R];
        padded[1..].copy_from_slice(&problem.y[..R - 1]);
        let spread = reflected(&mirror, &padded);
        for lane in 0..LANES.min(loads.len() - first) {
            let number = first + lane;
            (sizes[number], steps[number]) = (problem.tau.0[lane], taken[lane]);
            motions[number] = std::array::from_fn(|i| (problem.tau * l[i] - spread[i]).0[lane]);
            let mine = &mut forces[number * width..(number + 1) * width];
            for (cone, place) in problem.cones.iter().zip(mine.chunks_exact_mut(K)) {
                for k in 0..K {
                    place[k] = cone.x[k].0[lane];
                }
            }
        }
    }
}

#[inline(always)]
fn solve<const M: usize, const K: usize>(problem: &mut Embedding<M, K>) -> [i64; LANES] {
    let mut running: Chosen = [true; LANES];
    let mut taken = [0; LANES];
    let mut polished = 0;
    for round in 0..STEPS + POLISHING {
        problem.scale();
        let done = problem.finished();
        running = both(running, std::array::from_fn(|k| !done[k]));
        let to_middle = polished > 0 || round >= STEPS || running == [false; LANES];
        polished += i64::from(to_middle);
        running = problem.step(if to_middle { problem.ended() } else { running }, to_middle);
        for lane in 0..LANES {
            taken[lane] += i64::from(running[lane] && !to_middle);
        }
        if polished == POLISHING {
            break;
        }
    }
    taken
}

/// The vector m of length sqrt 2 for which I - m m^T takes the load to the first axis, or its opposite.
#[inline(always)]
fn mirror_of<const R: usize>(load: &[Lanes; R]) -> [Lanes; R] {
    let mut mirror = *load;
    for lane in 0..LANES {
        mirror[0].0[lane] += if load[0].0[lane] >= 0.0 { 1.0 } else { -1.0 };
    }
    let factor = (Lanes::all(2.0) / dots(&mirror, &mirror)).sqrt();
    mirror.map(|value| factor * value)
}

#[inline(always)]
fn reflected<const R: usize>(mirror: &[Lanes; R], v: &[Lanes; R]) -> [Lanes; R] {
    let along = dots(mirror, v);
    std::array::from_fn(|i| v[i] - along * mirror[i])
}

#[inline(always)]
fn set_up<const R: usize, const M: usize, const K: usize>(
    problem: &mut Embedding<M, K>,
    pushes: &Pushes<R>,
    load: &[Lanes; R],
    fixed: &[Lanes; R],
    mirror: &[Lanes; R],
) {
    let turned = reflected(mirror, fixed);
    problem.start(std::array::from_fn(|m| -turned[m + 1]));
    problem.cones.clear();
    for (columns, &ball) in pushes.maps.chunks_exact(K).zip(pushes.balls) {
        let mut cone = Cone::new(ball);
        for k in 0..K {
            let column = columns[k].map(Lanes::all);
            let turned = reflected(mirror, &column);
            for m in 0..M {
                cone.a[m][k] = turned[m + 1];
            }
            cone.c[k] = if pushes.seek { dots(load, &column) } else { Lanes::ZERO };
        }
        problem.cones.push(cone);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Pushes up, with friction 1/2, and a clamp down that rubs with 1/2: columns [t, z] each.
    const MAPS: [[f64; 3]; 6] =
        [[0.0, 1.0, -1.0], [0.5, 0.0, 0.0], [0.0, 1.0, 1.0], [0.5, 0.0, 0.0], [0.0; 3], [0.5, 0.0, 0.0]];

    fn guesses(fixed: [f64; 3], loads: &[[f64; 3]], threads: usize) -> Guesses<3> {
        let pushes = Pushes { maps: &MAPS, balls: &[false, false, true], seek: true };
        balance_guesses::<3, 2, 2>(&pushes, &vec![fixed; loads.len()], loads, threads)
    }

    #[test]
    fn friction_holds_half_of_what_presses() {
        // the clamp and the weight press with 1 and 3; the two below rub with half of 4, the clamp with half of 1
        let found = guesses([0.0, -4.0, 0.0], &[[1.0, 0.0, 0.0]], 1);
        let x: Vec<f64> = found.forces.iter().map(|value| value / found.sizes[0]).collect();
        assert!((x[0] + x[2] - 4.0).abs() < 1e-7);
        assert!((0.5 * (x[1] + x[3] + x[5]) + 2.5).abs() < 1e-7);
        let q = found.motions[0].map(|value| value / found.sizes[0]);
        assert!((q[0] - 1.0).abs() < 1e-7 && (4.0 * q[1] + 0.5 * q[0].abs() - 2.5).abs() < 1e-7);
    }

    #[test]
    fn what_has_no_end_ends_in_a_ray() {
        // down: the two below take anything; up, when nothing presses them: nothing holds
        assert!(guesses([0.0, -4.0, 0.0], &[[0.0, -1.0, 0.0]], 1).sizes[0] < 1e-9);
        assert!(guesses([0.0, 4.0, 0.0], &[[1.0, 0.0, 0.0]], 1).sizes[0] < 1e-9);
    }

    #[test]
    fn neighbours_and_threads_change_nothing() {
        let mut random = Random::new(5);
        let loads: Vec<[f64; 3]> = (0..13).map(|_| crate::vector::unit(&random.vector())).collect();
        let together = guesses([0.1, -4.0, 0.2], &loads, 3);
        for (number, load) in loads.iter().enumerate() {
            let alone = guesses([0.1, -4.0, 0.2], &[*load], 1);
            assert!((alone.sizes[0] - together.sizes[number]).abs() <= 1e-3 * alone.sizes[0].max(1e-6));
        }
        assert!(guesses([0.1, -4.0, 0.2], &[], 2).sizes.is_empty());
    }
}
