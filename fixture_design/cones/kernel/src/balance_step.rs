//! One step of the interior point of `balance`: predictor, corrector, and the steps back to the middle at the end.

use crate::lanes::{Chosen, Lanes, both, dots, either, tail_dots};

/// Gap and residuals of a finished load, relative to its sizes [-].
const DONE: f64 = 4e-9;
/// A ray is one when its residual is this small next to its objective [-].
const RAY: f64 = 1e-11;
/// The central path is followed no further than this [-].
const CENTRE_END: f64 = 1e-20;
/// Part of the way to the boundary that a step goes [-].
const BACKED_OFF: f64 = 0.95;
/// Pivots of the Cholesky factor below this, next to the largest, are rounding [-].
const PIVOT: f64 = 1e-30;
/// No step is longer than one over this [-].
const SHORTEST_BACK: f64 = 1e-300;

/// One cone: its data, its x and s, and what a step needs to know of it.
#[derive(Clone)]
pub struct Cone<const M: usize, const K: usize> {
    pub ball: bool,
    pub a: [[Lanes; K]; M],
    pub c: [Lanes; K],
    pub x: [Lanes; K],
    pub s: [Lanes; K],
    /// W = eta [w0, w1; w1, I + w1 w1^T / (1 + w0)].
    eta: Lanes,
    w: [Lanes; K],
    lambda: [Lanes; K],
    /// W e_t at length one, and that length; zero for what is no ball.
    normal: [Lanes; K],
    length: Lanes,
    /// A W, projected.
    columns: [[Lanes; K]; M],
    /// W c.
    cost: [Lanes; K],
    /// c tau - A^T y - s.
    dual: [Lanes; K],
    /// W dual.
    dual_scaled: [Lanes; K],
    /// W^-1 dx for dtau = 1.
    per_tau: [Lanes; K],
    goal: [Lanes; K],
    /// W^-1 dx of the move, and ds.
    move_x: [Lanes; K],
    slack: [Lanes; K],
}

impl<const M: usize, const K: usize> Cone<M, K> {
    #[inline(always)]
    pub fn new(ball: bool) -> Self {
        let none = [Lanes::ZERO; K];
        let mut first = none;
        first[0] = Lanes::ONE;
        Self {
            ball,
            a: [none; M],
            c: none,
            x: first,
            s: first,
            eta: Lanes::ONE,
            w: first,
            lambda: first,
            normal: none,
            length: Lanes::ONE,
            columns: [none; M],
            cost: none,
            dual: none,
            dual_scaled: none,
            per_tau: none,
            goal: none,
            move_x: none,
            slack: none,
        }
    }

    #[inline(always)]
    fn scaled(&self, v: &[Lanes; K]) -> [Lanes; K] {
        let along = tail_dots(&self.w, v);
        let factor = v[0] + along / (Lanes::ONE + self.w[0]);
        let mut result = [self.eta * (self.w[0] * v[0] + along); K];
        for k in 1..K {
            result[k] = self.eta * (v[k] + factor * self.w[k]);
        }
        result
    }

    /// What of v is left beside a ball's plane.
    #[inline(always)]
    fn across(&self, v: &[Lanes; K]) -> [Lanes; K] {
        if !self.ball {
            return *v;
        }
        let along = dots(&self.normal, v);
        std::array::from_fn(|k| v[k] - along * self.normal[k])
    }

    /// A^T y.
    #[inline(always)]
    fn pulled(matrix: &[[Lanes; K]; M], y: &[Lanes; M]) -> [Lanes; K] {
        let mut sum = [Lanes::ZERO; K];
        for m in 0..M {
            for k in 0..K {
                sum[k] += y[m] * matrix[m][k];
            }
        }
        sum
    }

    #[inline(always)]
    fn set_scaling(&mut self) {
        let (size_x, size_s) = (squares(&self.x).sqrt(), squares(&self.s).sqrt());
        let (over_x, over_s) = (Lanes::ONE / size_x, Lanes::ONE / size_s);
        let x = self.x.map(|value| value * over_x);
        let s = self.s.map(|value| value * over_s);
        let factor = Lanes::ONE / (Lanes::all(2.0) * (Lanes::ONE + dots(&x, &s))).sqrt();
        self.w = std::array::from_fn(|k| factor * (x[k] - s[k]));
        self.w[0] = (Lanes::ONE + tail_dots(&self.w, &self.w)).sqrt();
        self.eta = (size_x * over_s).sqrt();
        self.lambda = self.scaled(&self.s);
        if self.ball {
            let length = dots(&self.w, &self.w).sqrt();
            self.normal = self.w.map(|value| value / length);
            self.length = length * self.eta;
        }
    }
}

/// The embedding of the group's loads.
pub struct Embedding<const M: usize, const K: usize> {
    pub cones: Vec<Cone<M, K>>,
    pub y: [Lanes; M],
    pub tau: Lanes,
    kappa: Lanes,
    b: [Lanes; M],
    /// L with L L^T = H, its diagonal inverted.
    factor: [[Lanes; M]; M],
    y_per_tau: [Lanes; M],
    slope: Lanes,
    primal: [Lanes; M],
    gap: Lanes,
    mu: Lanes,
}

/// dy, dtau and dkappa of a move; the rest is in the cones.
struct Move<const M: usize> {
    y: [Lanes; M],
    tau: Lanes,
    kappa: Lanes,
}

impl<const M: usize, const K: usize> Embedding<M, K> {
    pub fn new() -> Self {
        let none = [Lanes::ZERO; M];
        Self {
            cones: Vec::new(),
            y: none,
            tau: Lanes::ONE,
            kappa: Lanes::ONE,
            b: none,
            factor: [none; M],
            y_per_tau: none,
            slope: Lanes::ONE,
            primal: none,
            gap: Lanes::ZERO,
            mu: Lanes::ONE,
        }
    }

    #[inline(always)]
    pub fn start(&mut self, b: [Lanes; M]) {
        (self.b, self.y, self.tau, self.kappa) = (b, [Lanes::ZERO; M], Lanes::ONE, Lanes::ONE);
    }

    /// The scaling of every cone, and the residuals.
    #[inline(always)]
    pub fn scale(&mut self) {
        let mut primal = self.b.map(|value| value * self.tau);
        let mut centre = self.tau * self.kappa;
        for cone in &mut self.cones {
            cone.set_scaling();
            centre += dots(&cone.x, &cone.s);
            let pull = Cone::pulled(&cone.a, &self.y);
            for k in 0..K {
                cone.dual[k] = cone.c[k] * self.tau - pull[k] - cone.s[k];
            }
            if cone.ball {
                cone.dual[0] = Lanes::ZERO;
            }
            for m in 0..M {
                primal[m] = primal[m] - dots(&cone.a[m], &cone.x);
            }
        }
        self.primal = primal;
        self.mu = centre / Lanes::all((self.cones.len() + 1) as f64);
        self.gap = self.kappa + self.cost() - self.bound();
    }

    #[inline(always)]
    fn cost(&self) -> Lanes {
        self.cones.iter().fold(Lanes::ZERO, |sum, cone| sum + dots(&cone.c, &cone.x))
    }

    #[inline(always)]
    fn bound(&self) -> Lanes {
        let balls = self.cones.iter().filter(|cone| cone.ball);
        balls.fold(dots(&self.b, &self.y), |sum, cone| sum - cone.s[0])
    }

    /// Solved, or a ray: no x at all (b . y > 0, -A^T y in the cones), or no bound (A x = 0, c . x < 0).
    #[inline(always)]
    pub fn finished(&self) -> Chosen {
        let (cost, bound, tau) = (self.cost(), self.bound(), self.tau);
        let (mut miss_p, mut size_y) = (Lanes::ZERO, Lanes::ZERO);
        for m in 0..M {
            miss_p = miss_p.max(self.primal[m].abs());
            size_y = size_y.max(self.y[m].abs());
        }
        let (mut miss_d, mut size_x) = (Lanes::ZERO, Lanes::ZERO);
        for cone in &self.cones {
            size_x = size_x.max(cone.x[0]);
            for k in 0..K {
                miss_d = miss_d.max(cone.dual[k].abs());
            }
        }
        let done = Lanes::all(DONE);
        let gap = (self.mu * Lanes::all((self.cones.len() + 1) as f64) - tau * self.kappa) / tau;
        let solved = both(miss_p.at_most(done * (tau + size_x)), miss_d.at_most(done * (tau + size_y)));
        let solved = both(solved, gap.at_most(done * tau.max(cost.abs()).max(bound.abs())));
        let no_x = (miss_d + tau).at_most(Lanes::all(RAY) * bound);
        let no_bound = (miss_p + tau).at_most(Lanes::all(RAY) * -cost);
        either(either(solved, no_x), either(no_bound, self.mu.below(Lanes::all(CENTRE_END))))
    }

    /// Whether it is x / tau that the end is near to, and no ray.
    #[inline(always)]
    pub fn ended(&self) -> Chosen {
        self.kappa.below(self.tau)
    }

    /// H = sum of the squares of the columns, factored, and what dtau = 1 brings.
    #[inline(always)]
    fn factor(&mut self) {
        let mut normal = [[Lanes::ZERO; M]; M];
        let mut right = self.b;
        for cone in &mut self.cones {
            cone.cost = cone.scaled(&cone.c);
            cone.dual_scaled = cone.scaled(&cone.dual);
            let level = cone.across(&cone.cost);
            for m in 0..M {
                let full = cone.scaled(&cone.a[m]);
                cone.columns[m] = full;
                if cone.ball {
                    let along = dots(&full, &cone.normal);
                    cone.columns[m] = std::array::from_fn(|k| full[k] - along * cone.normal[k]);
                    right[m] = right[m] - along / cone.length;
                }
                right[m] += dots(&cone.columns[m], &level);
                for j in 0..=m {
                    normal[m][j] += dots(&cone.columns[m], &cone.columns[j]);
                }
            }
        }
        self.factor = cholesky(normal);
        self.y_per_tau = self.solved(right);
        let mut slope = self.kappa / self.tau;
        for cone in &mut self.cones {
            let level = cone.across(&cone.cost);
            let back = Cone::pulled(&cone.columns, &self.y_per_tau);
            for k in 0..K {
                let own = if cone.ball { cone.normal[k] / cone.length } else { Lanes::ZERO };
                cone.per_tau[k] = own - level[k] + back[k];
            }
            slope += dots(&cone.per_tau, &cone.per_tau);
        }
        self.slope = slope;
    }

    #[inline(always)]
    fn solved(&self, right: [Lanes; M]) -> [Lanes; M] {
        let (lower, mut y) = (&self.factor, right);
        for j in 0..M {
            for k in 0..j {
                y[j] = y[j] - lower[j][k] * y[k];
            }
            y[j] = y[j] * lower[j][j];
        }
        for j in (0..M).rev() {
            for k in j + 1..M {
                y[j] = y[j] - lower[k][j] * y[k];
            }
            y[j] = y[j] * lower[j][j];
        }
        y
    }

    /// W^-1 dx + W ds = goal, kappa dtau + tau dkappa = goal_tau, and `part` of the residuals gone; tau stays if `held`.
    #[inline(always)]
    fn direction(&mut self, goal_tau: Lanes, part: Lanes, held: bool) -> Move<M> {
        let mut right = self.primal.map(|value| part * value);
        for cone in &mut self.cones {
            let level: [Lanes; K] = std::array::from_fn(|k| cone.goal[k] - part * cone.dual_scaled[k]);
            cone.move_x = cone.across(&level);
            for m in 0..M {
                right[m] = right[m] - dots(&cone.columns[m], &cone.move_x);
            }
        }
        let mut y = self.solved(right);
        let mut sum = part * self.gap - dots(&self.b, &y);
        for cone in &mut self.cones {
            let back = Cone::pulled(&cone.columns, &y);
            for k in 0..K {
                cone.move_x[k] += back[k];
            }
            sum += dots(&cone.cost, &cone.move_x);
            let pull = Cone::pulled(&cone.a, &y);
            cone.slack = std::array::from_fn(|k| part * cone.dual[k] - pull[k]);
            if cone.ball {
                sum += cone.top();
            }
        }
        let tau = if held { Lanes::ZERO } else { (sum + goal_tau / self.tau) / self.slope };
        for m in 0..M {
            y[m] += tau * self.y_per_tau[m];
        }
        for cone in &mut self.cones {
            let pull = Cone::pulled(&cone.a, &y);
            for k in 0..K {
                cone.move_x[k] += tau * cone.per_tau[k];
                cone.slack[k] = part * cone.dual[k] + tau * cone.c[k] - pull[k];
            }
            if cone.ball {
                cone.slack[0] = cone.top() - tau / (cone.length * cone.length);
            }
        }
        Move { y, tau, kappa: (goal_tau - self.kappa * tau) / self.tau }
    }

    /// The move with A dx = b dtau + part of the residual once more.
    #[inline(always)]
    fn refine(&mut self, found: &mut Move<M>, part: Lanes) {
        let mut missing: [Lanes; M] = std::array::from_fn(|m| part * self.primal[m] + found.tau * self.b[m]);
        for cone in &self.cones {
            let step = cone.scaled(&cone.move_x);
            for m in 0..M {
                missing[m] = missing[m] - dots(&cone.a[m], &step);
            }
        }
        let y = self.solved(missing);
        for cone in &mut self.cones {
            let (back, pull) = (Cone::pulled(&cone.columns, &y), Cone::pulled(&cone.a, &y));
            for k in 0..K {
                cone.move_x[k] += back[k];
                if k > 0 || !cone.ball {
                    cone.slack[k] = cone.slack[k] - pull[k];
                }
            }
        }
        for m in 0..M {
            found.y[m] += y[m];
        }
    }

    /// The longest step that stays in the cones, seen from the scaled point lambda of both x and s.
    #[inline(always)]
    fn longest(&self, found: &Move<M>) -> Lanes {
        let mut back = Lanes::all(SHORTEST_BACK).max(-found.tau / self.tau).max(-found.kappa / self.kappa);
        for cone in &self.cones {
            let over = Lanes::ONE / squares(&cone.lambda).sqrt();
            let unit = cone.lambda.map(|value| value * over);
            let other: [Lanes; K] = std::array::from_fn(|k| cone.goal[k] - cone.move_x[k]);
            for d in [&cone.move_x, &other] {
                let first = unit[0] * d[0] - tail_dots(&unit, d);
                let factor = (d[0] + first) / (unit[0] + Lanes::ONE);
                let mut rest = Lanes::ZERO;
                for k in 1..K {
                    let value = d[k] - factor * unit[k];
                    rest += value * value;
                }
                back = ((rest.sqrt() - first) * over).max(back);
            }
        }
        Lanes::ONE / back
    }

    /// A step for the lanes that are wanted; which of them it brought on.
    ///
    /// Towards the end: a predictor, then a corrector. To the middle: one move that leaves tau alone and takes
    /// A x = b tau, A^T y + s = c tau all the way. They share one piece of code, which is long once it is unrolled.
    #[inline(always)]
    pub fn step(&mut self, wanted: Chosen, to_middle: bool) -> Chosen {
        self.factor();
        let (mut target, mut part, mut goal_tau) = (Lanes::ZERO, Lanes::ONE, -self.tau * self.kappa);
        if to_middle {
            let squared = self.cones.iter().fold(Lanes::ZERO, |sum, cone| sum + dots(&cone.lambda, &cone.lambda));
            target = squared / Lanes::all(self.cones.len() as f64);
        }
        for cone in &mut self.cones {
            (cone.move_x, cone.slack) = ([Lanes::ZERO; K], [Lanes::ZERO; K]);
        }
        let mut predicts = !to_middle;
        loop {
            for cone in &mut self.cones {
                // W ds of the predictor waits in the slack
                let mut crossed = product(&cone.move_x, &cone.slack);
                crossed[0] = crossed[0] - target;
                let quotient = divided(&cone.lambda, &crossed);
                cone.goal = std::array::from_fn(|k| -cone.lambda[k] - quotient[k]);
            }
            let mut found = self.direction(goal_tau, part, to_middle);
            self.refine(&mut found, part);
            let far = self.longest(&found);
            if !predicts {
                let far = (Lanes::all(BACKED_OFF) * far).min(Lanes::ONE);
                let worth = Lanes::all(if to_middle { BACKED_OFF / 2.0 } else { 0.0 }).below(far);
                return self.advance(&found, far, both(wanted, worth), !to_middle);
            }
            predicts = false;
            let short = Lanes::ONE - far.min(Lanes::ONE);
            let sigma = short * short * short;
            (target, part) = (sigma * self.mu, Lanes::ONE - sigma);
            goal_tau = target - self.tau * self.kappa - found.tau * found.kappa;
            for cone in &mut self.cones {
                cone.slack = std::array::from_fn(|k| cone.goal[k] - cone.move_x[k]);
            }
        }
    }

    /// So far along the move, where that ends inside the cones and, if `nearer` is asked for, no further from the end.
    #[inline(always)]
    fn advance(&mut self, found: &Move<M>, far: Lanes, wanted: Chosen, nearer: bool) -> Chosen {
        let (tau, kappa) = (self.tau + far * found.tau, self.kappa + far * found.kappa);
        let mut least = tau.min(kappa);
        let mut centre = tau * kappa;
        let mut largest = Lanes::ZERO;
        for cone in &mut self.cones {
            let step = cone.scaled(&cone.move_x);
            for k in 0..K {
                // the new x and s wait where the move was
                cone.move_x[k] = cone.x[k] + far * step[k];
                cone.slack[k] = cone.s[k] + far * cone.slack[k];
            }
            if cone.ball {
                cone.move_x[0] = tau;
            }
            centre += dots(&cone.move_x, &cone.slack);
            least = (squares(&cone.move_x).min(least)).min(squares(&cone.slack)).min(cone.move_x[0]).min(cone.slack[0]);
            largest = cone.move_x[0].max(largest).max(cone.slack[0]);
        }
        let mut good = both(wanted, Lanes::ZERO.below(least));
        good = both(good, (centre + largest).below(Lanes::all(f64::INFINITY)));
        if nearer {
            let limit = self.mu * Lanes::all((self.cones.len() + 1) as f64 * (1.0 + DONE));
            good = both(good, centre.below(limit));
        }
        for cone in &mut self.cones {
            for k in 0..K {
                cone.x[k] = cone.move_x[k].where_chosen(&good, cone.x[k]);
                cone.s[k] = cone.slack[k].where_chosen(&good, cone.s[k]);
            }
        }
        for m in 0..M {
            self.y[m] = (self.y[m] + far * found.y[m]).where_chosen(&good, self.y[m]);
        }
        (self.tau, self.kappa) = (tau.where_chosen(&good, self.tau), kappa.where_chosen(&good, self.kappa));
        good
    }
}

impl<const M: usize, const K: usize> Cone<M, K> {
    /// A ball's ds_t for the rest of its ds, without the part of dtau.
    #[inline(always)]
    fn top(&self) -> Lanes {
        let mut rest = self.slack;
        rest[0] = Lanes::ZERO;
        let scaled = self.scaled(&rest);
        let left: [Lanes; K] = std::array::from_fn(|k| self.goal[k] - scaled[k]);
        dots(&self.normal, &left) / self.length
    }
}

/// t^2 - |z|^2, without its cancellation.
#[inline(always)]
fn squares<const K: usize>(x: &[Lanes; K]) -> Lanes {
    let z = tail_dots(x, x).sqrt();
    (x[0] - z) * (x[0] + z)
}

/// a o b = [a . b; a0 b1 + b0 a1].
#[inline(always)]
fn product<const K: usize>(a: &[Lanes; K], b: &[Lanes; K]) -> [Lanes; K] {
    let mut result = [dots(a, b); K];
    for k in 1..K {
        result[k] = a[0] * b[k] + b[0] * a[k];
    }
    result
}

/// u with a o u = d.
#[inline(always)]
fn divided<const K: usize>(a: &[Lanes; K], d: &[Lanes; K]) -> [Lanes; K] {
    let first = (a[0] * d[0] - tail_dots(a, d)) / squares(a);
    let over = Lanes::ONE / a[0];
    let mut result = [first; K];
    for k in 1..K {
        result[k] = (d[k] - first * a[k]) * over;
    }
    result
}

/// L with L L^T = H, its diagonal inverted; pivots that are rounding count as infinite, which leaves their direction.
#[inline(always)]
fn cholesky<const M: usize>(normal: [[Lanes; M]; M]) -> [[Lanes; M]; M] {
    let mut lower = [[Lanes::ZERO; M]; M];
    let floor = (0..M).fold(Lanes::ZERO, |largest, m| largest.max(normal[m][m])) * Lanes::all(PIVOT);
    for j in 0..M {
        let mut pivot = normal[j][j];
        for k in 0..j {
            pivot = pivot - lower[j][k] * lower[j][k];
        }
        let inverse = (Lanes::ONE / pivot.sqrt()).where_chosen(&floor.below(pivot), Lanes::ZERO);
        lower[j][j] = inverse;
        for i in j + 1..M {
            let mut rest = normal[i][j];
            for k in 0..j {
                rest = rest - lower[i][k] * lower[j][k];
            }
            lower[i][j] = rest * inverse;
        }
    }
    lower
}
