"""The largest load that pushes in second-order cones can balance: one interior point for many loads at once.

    minimise c . x  with  A x = b,  x_i = [t, z] in K_i = {|z| <= t},  t = 1 where the cone is a ball,

for each load l of length 1, where c = M^T l, A = N^T M, b = -N^T f and N spans the space orthogonal to l. Then
f + lambda l + M x = 0 for lambda = -l . (f + M x), and a motion q = l - N y with M^T q in the cones bounds lambda. The
equations are as many as the dimension of the wrenches, so a step costs one outer product a cone and one 5 x 5 Cholesky.

Method: homogeneous self-dual embedding, so that infeasible and unbounded loads end in rays instead of nowhere (Y. Ye,
M. J. Todd, S. Mizuno 1994), the scaling of Nesterov and Todd, Mehrotra's corrector (as in L. Vandenberghe, The CVXOPT
linear and quadratic cone program solvers, 2010). What comes out is a good guess and proves nothing: `balance_proof`
repairs and proves. The compiled twin is src/balance.rs, which takes four loads a step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.cones.kernel.choice import compiled
from fixture_design.cones.kernel.threads import thread_count
from fixture_design.errors import ConeError

#: The compiled kernel takes so many dimensions with cones of a width.
_WIDEST_COMPILED = {2: 3, 3: 6, 4: 7}
#: Steps at most; 8 to 15 are usual.
_STEPS = 60
#: Gap and residuals of a finished load, relative to its sizes [-].
_DONE = 4e-9
#: A ray is one when its residual is this small next to its objective [-].
_RAY = 1e-11
#: The central path is followed no further than this [-].
_CENTRE_END = 1e-20
#: Steps at the end that keep tau and the gap and take the residuals to rounding.
_POLISHING = 2
#: Part of the way to the boundary that a step goes [-].
_BACKED_OFF = 0.95
#: Pivots of the Cholesky factor below this, next to the largest, are rounding [-].
_PIVOT = 1e-30


@dataclass(frozen=True, eq=False)
class Guesses:
    """Where the interior point ended, homogeneous: forces / size and motions / size solve the load, if size > 0.

    Attributes:
        forces: x, shape (k, n, w).
        motions: q = size l - N y, shape (k, r).
        sizes: tau, shape (k,); next to nothing where the load has no optimum and the others are a ray.
        steps: shape (k,), ints.
    """

    forces: np.ndarray
    motions: np.ndarray
    sizes: np.ndarray
    steps: np.ndarray


def balance_guesses(
    maps: np.ndarray,
    balls: np.ndarray,
    fixed: np.ndarray,
    loads: np.ndarray,
    *,
    seek: bool = True,
    threads: int | None = None,
) -> Guesses:
    """The interior point for k loads.

    Args:
        maps: M, shape (r, n, w): cones padded with zero columns to one width w, 2 to 4. A ball's first column is zero.
        balls: shape (n,), bool: cones whose t is 1.
        fixed: f, shape (k, r).  loads: shape (k, r), unit.
        seek: whether lambda is to be large; False asks only for some x.
        threads: by default one for each processor; the compiled kernel uses them.

    Raises:
        ConeError: shapes that do not fit, numbers that are not finite.
    """
    r, n, width = maps.shape
    if balls.shape != (n,) or fixed.shape != loads.shape or loads.shape[1:] != (r,) or not 2 <= width <= 4:
        raise ConeError(f"maps {maps.shape}, balls {balls.shape}, fixed {fixed.shape}, loads {loads.shape} do not fit")
    if not (np.isfinite(maps).all() and np.isfinite(fixed).all() and np.isfinite(loads).all()):
        raise ConeError("maps, fixed and loads must be finite")
    native = compiled(r)
    if native is not None and r <= _WIDEST_COMPILED[width]:
        flat = np.ascontiguousarray(maps.transpose(1, 2, 0)).reshape(n * width, r)
        found = native.balance_guesses(flat, balls, fixed, loads, width, seek, thread_count(threads))
        forces, motions, sizes, steps = found
        return Guesses(forces.reshape(-1, n, width), motions, sizes, steps)
    return _numpy_guesses(maps, balls, fixed, loads, seek)


def _numpy_guesses(maps: np.ndarray, balls: np.ndarray, fixed: np.ndarray, loads: np.ndarray, seek: bool) -> Guesses:
    problem = _Problem.of(maps, balls, fixed, loads, seek)
    state = problem.start()
    running = np.ones(len(loads), dtype=bool)
    steps = np.zeros(len(loads), dtype=int)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            running &= ~problem.finished(state)
            if not running.any():
                break
            after = problem.step(state)
            running &= after.is_inside() & (after.centre(balls) < state.centre(balls) * (1 + _DONE))
            state = after.where(running, state)
            steps += running
        state = problem.polished(state)
    motions = state.tau[:, None] * loads - np.einsum("brm,bm->br", problem.basis, state.y)
    return Guesses(state.x, motions, state.tau, steps)


@dataclass(frozen=True, eq=False)
class _State:
    """x and s in the cones, y, tau and kappa: a point of the embedding for each load."""

    x: np.ndarray
    s: np.ndarray
    y: np.ndarray
    tau: np.ndarray
    kappa: np.ndarray

    def centre(self, balls: np.ndarray) -> np.ndarray:
        return (_dots(self.x, self.s).sum(axis=1) + self.tau * self.kappa) / (len(balls) + 1)

    def is_inside(self) -> np.ndarray:
        sums = self.x.sum(axis=(1, 2)) + self.s.sum(axis=(1, 2)) + self.y.sum(axis=1) + self.tau + self.kappa
        inside = (_squares(self.x) > 0).all(axis=1) & (_squares(self.s) > 0).all(axis=1)
        return np.isfinite(sums) & inside & (self.tau > 0) & (self.kappa > 0)

    def where(self, chosen: np.ndarray, other: _State) -> _State:
        pick = [np.where(chosen.reshape(-1, *[1] * (a.ndim - 1)), a, b) for a, b in zip(self, other, strict=True)]
        return _State(*pick)

    def __iter__(self):
        return iter((self.x, self.s, self.y, self.tau, self.kappa))


@dataclass(frozen=True, eq=False)
class _Problem:
    """A (k, m, n, w), b (k, m), c (k, n, w), N (k, r, m), and which cones are balls (n,)."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    basis: np.ndarray
    balls: np.ndarray

    @staticmethod
    def of(maps: np.ndarray, balls: np.ndarray, fixed: np.ndarray, loads: np.ndarray, seek: bool) -> _Problem:
        """Householder's reflection of each load to the first axis: the other columns are N."""
        mirror = loads.copy()
        mirror[:, 0] += np.where(loads[:, 0] >= 0, 1.0, -1.0)
        mirror *= np.sqrt(2.0) / np.linalg.norm(mirror, axis=1, keepdims=True)
        basis = (np.eye(loads.shape[1]) - mirror[:, :, None] * mirror[:, None, :])[:, :, 1:]
        c = np.einsum("br,rnw->bnw", loads, maps) * float(seek)
        return _Problem(
            np.einsum("brm,rnw->bmnw", basis, maps), -np.einsum("brm,br->bm", basis, fixed), c, basis, balls
        )

    def start(self) -> _State:
        ones = np.zeros(self.c.shape)
        ones[:, :, 0] = 1.0
        each = np.ones(len(ones))
        return _State(ones, ones.copy(), np.zeros(self.b.shape), each, each.copy())

    def residuals(self, state: _State) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """b tau - A x, c tau - A^T y - s (zero for a ball's t), kappa + c . x - b . y + the balls' s_t."""
        primal = self.b * state.tau[:, None] - np.einsum("bmnw,bnw->bm", self.a, state.x)
        dual = self.c * state.tau[:, None, None] - np.einsum("bmnw,bm->bnw", self.a, state.y) - state.s
        dual[:, self.balls, 0] = 0.0
        return primal, dual, state.kappa + self.cost(state) - self.bound(state)

    def cost(self, state: _State) -> np.ndarray:
        return np.einsum("bnw,bnw->b", self.c, state.x)

    def bound(self, state: _State) -> np.ndarray:
        return np.einsum("bm,bm->b", self.b, state.y) - state.s[:, self.balls, 0].sum(axis=1)

    def finished(self, state: _State) -> np.ndarray:
        """Solved, or a ray: no x at all (b . y > 0, -A^T y in the cones), or no bound (A x = 0, c . x < 0)."""
        primal, dual, _ = self.residuals(state)
        cost, bound, tau = self.cost(state), self.bound(state), state.tau
        miss_p = np.abs(primal).max(axis=1, initial=0.0)
        miss_d = np.abs(dual).max(axis=(1, 2), initial=0.0)
        size_x, size_y = state.x.max(axis=(1, 2), initial=0.0), np.abs(state.y).max(axis=1, initial=0.0)
        gap = _dots(state.x, state.s).sum(axis=1) / tau
        solved = (miss_p <= _DONE * (tau + size_x)) & (miss_d <= _DONE * (tau + size_y))
        solved &= gap <= _DONE * np.maximum(tau, np.maximum(np.abs(cost), np.abs(bound)))
        no_x = miss_d + tau <= _RAY * bound
        no_bound = miss_p + tau <= _RAY * -cost
        return solved | no_x | no_bound | (self.centre_of(state) < _CENTRE_END)

    def centre_of(self, state: _State) -> np.ndarray:
        return state.centre(self.balls)

    def step(self, state: _State) -> _State:
        """Predictor, corrector, and as far as the cones go."""
        scaling = _Scaling.of(state.x, state.s)
        system = _System.of(self, state, scaling)
        lam = scaling.times(state.s)
        mu = state.centre(self.balls)
        ahead = system.direction(-lam, -state.tau * state.kappa, np.ones(len(mu)))
        far = np.minimum(_longest(lam, ahead, state), 1.0)
        sigma = (1 - far) ** 3
        crossed = _product(ahead.x, ahead.s)
        crossed[:, :, 0] -= (sigma * mu)[:, None]
        goal = -lam - _divided(lam, crossed)
        goal_tau = sigma * mu - state.tau * state.kappa - ahead.tau * ahead.kappa
        move = system.refined(system.direction(goal, goal_tau, 1 - sigma), 1 - sigma)
        far = np.minimum(_BACKED_OFF * _longest(lam, move, state), 1.0)
        alpha = far[:, None, None]
        x = state.x + alpha * scaling.times(move.x)
        tau = state.tau + far * move.tau
        x[:, self.balls, 0] = tau[:, None]
        s = state.s + alpha * move.slack
        return _State(x, s, state.y + far[:, None] * move.y, tau, state.kappa + far * move.kappa)

    def polished(self, state: _State) -> _State:
        """Steps back to the middle that leave tau alone and take A x = b tau, A^T y + s = c tau all the way."""
        for _ in range(_POLISHING):
            scaling = _Scaling.of(state.x, state.s)
            system = _System.of(self, state, scaling)
            lam = scaling.times(state.s)
            middle = np.zeros(lam.shape)
            middle[..., 0] = (_dots(lam, lam).sum(axis=1) / len(self.balls))[:, None]
            move = system.refined(system.held(_divided(lam, middle) - lam), np.ones(len(lam)))
            far = np.minimum(_BACKED_OFF * _longest(lam, move, state), 1.0)
            far = np.where(far > _BACKED_OFF / 2, far, 0.0)
            x = state.x + far[:, None, None] * scaling.times(move.x)
            x[:, self.balls, 0] = state.tau[:, None]
            s, y = state.s + far[:, None, None] * move.slack, state.y + far[:, None] * move.y
            after = _State(x, s, y, state.tau, state.kappa)
            # a ray has nothing to be polished
            state = after.where(after.is_inside() & (state.kappa < state.tau), state)
        return state


@dataclass(frozen=True, eq=False)
class _Scaling:
    """W = eta [w0, w1; w1, I + w1 w1^T / (1 + w0)] a cone, with W s = W^-1 x."""

    eta: np.ndarray
    w: np.ndarray

    @staticmethod
    def of(x: np.ndarray, s: np.ndarray) -> _Scaling:
        size_x, size_s = np.sqrt(_squares(x)), np.sqrt(_squares(s))
        x, s = x / size_x[..., None], s / size_s[..., None]
        w = x - s
        w[..., 0] = x[..., 0] + s[..., 0]
        w /= np.sqrt(2 * (1 + _dots(x, s)))[..., None]
        w[..., 0] = np.sqrt(1 + _dots(w[..., 1:], w[..., 1:]))
        return _Scaling(np.sqrt(size_x / size_s), w)

    def times(self, v: np.ndarray) -> np.ndarray:
        along = _dots(self.w[..., 1:], v[..., 1:])
        result = v + self.w * (v[..., 0] + along / (1 + self.w[..., 0]))[..., None]
        result[..., 0] = self.w[..., 0] * v[..., 0] + along
        return self.eta[..., None] * result


@dataclass(frozen=True, eq=False)
class _Move:
    """A direction: W^-1 dx, W ds, ds itself, dy, dtau, dkappa."""

    x: np.ndarray
    s: np.ndarray
    slack: np.ndarray
    y: np.ndarray
    tau: np.ndarray
    kappa: np.ndarray


@dataclass(frozen=True, eq=False)
class _System:
    """The linear equations of a step in scaled variables, where x and s look alike, factored.

    A ball's dt = dtau is a plane in them: with a = W e_t it takes (I - a a^T / |a|^2) of everything, and adds a / |a|^2
    for each dtau.

    Attributes:
        normals: a / |a|, shape (k, n, w); zero for cones.  lengths: |a|.
        columns: A W (I - a a^T / |a|^2).  factor: of their squares.
        cost: W c so projected.  per_tau: what dtau = 1 brings: W^-1 dx, dy.
        missing: the residuals.
    """

    problem: _Problem
    state: _State
    scaling: _Scaling
    normals: np.ndarray
    lengths: np.ndarray
    columns: np.ndarray
    factor: np.ndarray
    cost: np.ndarray
    per_tau: tuple[np.ndarray, np.ndarray]
    missing: tuple[np.ndarray, np.ndarray, np.ndarray]

    @staticmethod
    def of(problem: _Problem, state: _State, scaling: _Scaling) -> _System:
        lengths = np.linalg.norm(scaling.w, axis=-1)
        normals = scaling.w / lengths[..., None] * problem.balls[:, None]
        lengths = lengths * scaling.eta
        wide = _Scaling(scaling.eta[:, None], scaling.w[:, None])
        columns = wide.times(problem.a)
        above = _dots(columns, normals[:, None]) / lengths[:, None]
        columns = _across(normals[:, None], columns)
        factor = _cholesky(np.einsum("bmnw,bjnw->bmj", columns, columns))
        cost = scaling.times(problem.c)
        level = _across(normals, cost)
        right = problem.b - above.sum(axis=-1) + np.einsum("bmnw,bnw->bm", columns, level)
        y = _solve(factor, right)
        x = normals / lengths[..., None] - level + np.einsum("bmnw,bm->bnw", columns, y)
        missing = problem.residuals(state)
        return _System(problem, state, scaling, normals, lengths, columns, factor, cost, (x, y), missing)

    def direction(self, goal: np.ndarray, goal_tau: np.ndarray, part: np.ndarray) -> _Move:
        """W^-1 dx + W ds = goal, kappa dtau + tau dkappa = goal_tau, and ``part`` of the residuals gone."""
        problem, state = self.problem, self.state
        primal, dual, gap = self.missing
        primal, dual, gap = primal * part[:, None], dual * part[:, None, None], gap * part
        level = _across(self.normals, goal - self.scaling.times(dual))
        y = _solve(self.factor, primal - np.einsum("bmnw,bnw->bm", self.columns, level))
        x = level + np.einsum("bmnw,bm->bnw", self.columns, y)
        x1, y1 = self.per_tau
        slack = dual - np.einsum("bmnw,bm->bnw", problem.a, y)
        tops = _dots(self.normals, goal - self.scaling.times(slack)) / self.lengths
        right = gap + np.einsum("bnw,bnw->b", self.cost, x) - np.einsum("bm,bm->b", problem.b, y) + tops.sum(axis=1)
        slope = state.kappa / state.tau + np.einsum("bnw,bnw->b", x1, x1)
        tau = (right + goal_tau / state.tau) / slope
        return self._move(x + tau[:, None, None] * x1, y + tau[:, None] * y1, goal, goal_tau, dual, tau)

    def held(self, goal: np.ndarray) -> _Move:
        """W^-1 dx + W ds = goal, all of the residuals of x and s gone, dtau = dkappa = 0."""
        primal, dual, _ = self.missing
        level = _across(self.normals, goal - self.scaling.times(dual))
        y = _solve(self.factor, primal - np.einsum("bmnw,bnw->bm", self.columns, level))
        x = level + np.einsum("bmnw,bm->bnw", self.columns, y)
        return self._move(x, y, goal, np.zeros(len(y)), dual, np.zeros(len(y)))

    def _move(self, x, y, goal, goal_tau, dual, tau) -> _Move:
        slack = dual + tau[:, None, None] * self.problem.c - np.einsum("bmnw,bm->bnw", self.problem.a, y)
        tops = _dots(self.normals, goal - self.scaling.times(slack)) / self.lengths - tau[:, None] / self.lengths**2
        slack[:, self.problem.balls, 0] = tops[:, self.problem.balls]
        kappa = (goal_tau - self.state.kappa * tau) / self.state.tau
        return _Move(x, goal - x, slack, y, tau, kappa)

    def refined(self, move: _Move, part: np.ndarray) -> _Move:
        """The move with A dx = b dtau + part of the residual once more."""
        above = _dots(self.scaling.times(move.x)[:, None], self.problem.a).sum(axis=-1)
        missing = self.missing[0] * part[:, None] + self.problem.b * move.tau[:, None] - above
        y = _solve(self.factor, missing)
        x = move.x + np.einsum("bmnw,bm->bnw", self.columns, y)
        slack = move.slack - np.einsum("bmnw,bm->bnw", self.problem.a, y)
        slack[:, self.problem.balls, 0] = move.slack[:, self.problem.balls, 0]
        return _Move(x, move.s + move.x - x, slack, move.y + y, move.tau, move.kappa)


def _across(normals: np.ndarray, v: np.ndarray) -> np.ndarray:
    """What of v is orthogonal to the unit normals."""
    return v - _dots(normals, v)[..., None] * normals


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...w,...w->...", a, b)


def _squares(x: np.ndarray) -> np.ndarray:
    """t^2 - |z|^2, without its cancellation."""
    z = np.sqrt(_dots(x[..., 1:], x[..., 1:]))
    return (x[..., 0] - z) * (x[..., 0] + z)


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a o b = [a . b; a0 b1 + b0 a1]."""
    result = a[..., :1] * b + b[..., :1] * a
    result[..., 0] = _dots(a, b)
    return result


def _divided(a: np.ndarray, d: np.ndarray) -> np.ndarray:
    """u with a o u = d."""
    first = (a[..., 0] * d[..., 0] - _dots(a[..., 1:], d[..., 1:])) / _squares(a)
    result = (d - first[..., None] * a) / a[..., :1]
    result[..., 0] = first
    return result


def _longest(lam: np.ndarray, move: _Move, state: _State) -> np.ndarray:
    """The longest step that stays in the cones, seen from the scaled point lam of both x and s."""
    size = np.sqrt(_squares(lam))
    unit = lam / size[..., None]
    back = np.zeros(len(lam))
    for d in (move.x, move.s):
        first = unit[..., 0] * d[..., 0] - _dots(unit[..., 1:], d[..., 1:])
        rest = d[..., 1:] - ((d[..., 0] + first) / (unit[..., 0] + 1))[..., None] * unit[..., 1:]
        back = np.maximum(back, ((np.sqrt(_dots(rest, rest)) - first) / size).max(axis=1, initial=0.0))
    back = np.maximum(back, np.maximum(-move.tau / state.tau, -move.kappa / state.kappa))
    return 1 / np.maximum(back, 1e-300)


def _cholesky(normal: np.ndarray) -> np.ndarray:
    """L with L L^T = H; pivots that are rounding count as infinite, which leaves their direction alone."""
    m = normal.shape[-1]
    lower = np.zeros(normal.shape)
    floor = _PIVOT * np.einsum("bmm->bm", normal).max(axis=1, initial=0.0)
    for j in range(m):
        pivot = normal[:, j, j] - np.einsum("bk,bk->b", lower[:, j, :j], lower[:, j, :j])
        lower[:, j, j] = np.sqrt(np.where(pivot > floor, pivot, np.inf))
        rest = normal[:, j + 1 :, j] - np.einsum("bik,bk->bi", lower[:, j + 1 :, :j], lower[:, j, :j])
        lower[:, j + 1 :, j] = rest / lower[:, j, j][:, None]
    return lower


def _solve(lower: np.ndarray, right: np.ndarray) -> np.ndarray:
    m = right.shape[1]
    y = right.copy()
    for j in range(m):
        y[:, j] = (y[:, j] - np.einsum("bk,bk->b", lower[:, j, :j], y[:, :j])) / lower[:, j, j]
    for j in reversed(range(m)):
        y[:, j] = (y[:, j] - np.einsum("bk,bk->b", lower[:, j + 1 :, j], y[:, j + 1 :])) / lower[:, j, j]
    return y
