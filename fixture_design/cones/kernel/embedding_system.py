"""The linear equations of one step of `balance`, in scaled variables, for many loads at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.cones.kernel.cone_algebra import Scaling, dots
from fixture_design.cones.kernel.embedding import Embedding, State

#: Pivots of the Cholesky factor below this, next to the largest, are rounding [-].
_PIVOT = 1e-30


@dataclass(frozen=True, eq=False)
class Move:
    """A direction: W^-1 dx, W ds, ds itself, dy, dtau, dkappa."""

    x: np.ndarray
    s: np.ndarray
    slack: np.ndarray
    y: np.ndarray
    tau: np.ndarray
    kappa: np.ndarray


@dataclass(frozen=True, eq=False)
class System:
    """The linear equations of a step in scaled variables, where x and s look alike, factored.

    A ball's dt = dtau is a plane in them: with a = W e_t it takes (I - a a^T / |a|^2) of everything, and adds a / |a|^2
    for each dtau.

    Attributes:
        normals: a / |a|, shape (k, n, w); zero for cones.  lengths: |a|.
        columns: A W (I - a a^T / |a|^2).  factor: of their squares.
        cost: W c so projected.  per_tau: what dtau = 1 brings: W^-1 dx, dy.
        missing: the residuals.
    """

    problem: Embedding
    state: State
    scaling: Scaling
    normals: np.ndarray
    lengths: np.ndarray
    columns: np.ndarray
    factor: np.ndarray
    cost: np.ndarray
    per_tau: tuple[np.ndarray, np.ndarray]
    missing: tuple[np.ndarray, np.ndarray, np.ndarray]

    @staticmethod
    def of(problem: Embedding, state: State, scaling: Scaling) -> System:
        lengths = np.linalg.norm(scaling.w, axis=-1)
        normals = scaling.w / lengths[..., None] * problem.balls[:, None]
        lengths = lengths * scaling.eta
        wide = Scaling(scaling.eta[:, None], scaling.w[:, None])
        columns = wide.times(problem.a)
        above = dots(columns, normals[:, None]) / lengths[:, None]
        columns = _across(normals[:, None], columns)
        factor = cholesky(np.einsum("bmnw,bjnw->bmj", columns, columns))
        cost = scaling.times(problem.c)
        level = _across(normals, cost)
        right = problem.b - above.sum(axis=-1) + np.einsum("bmnw,bnw->bm", columns, level)
        y = solve(factor, right)
        x = normals / lengths[..., None] - level + np.einsum("bmnw,bm->bnw", columns, y)
        missing = problem.residuals(state)
        return System(problem, state, scaling, normals, lengths, columns, factor, cost, (x, y), missing)

    def direction(self, goal: np.ndarray, goal_tau: np.ndarray, part: np.ndarray) -> Move:
        """W^-1 dx + W ds = goal, kappa dtau + tau dkappa = goal_tau, and ``part`` of the residuals gone."""
        problem, state = self.problem, self.state
        primal, dual, gap = self.missing
        primal, dual, gap = primal * part[:, None], dual * part[:, None, None], gap * part
        level = _across(self.normals, goal - self.scaling.times(dual))
        y = solve(self.factor, primal - np.einsum("bmnw,bnw->bm", self.columns, level))
        x = level + np.einsum("bmnw,bm->bnw", self.columns, y)
        x1, y1 = self.per_tau
        slack = dual - np.einsum("bmnw,bm->bnw", problem.a, y)
        tops = dots(self.normals, goal - self.scaling.times(slack)) / self.lengths
        right = gap + np.einsum("bnw,bnw->b", self.cost, x) - np.einsum("bm,bm->b", problem.b, y) + tops.sum(axis=1)
        slope = state.kappa / state.tau + np.einsum("bnw,bnw->b", x1, x1)
        tau = (right + goal_tau / state.tau) / slope
        return self._move(x + tau[:, None, None] * x1, y + tau[:, None] * y1, goal, goal_tau, dual, tau)

    def held(self, goal: np.ndarray) -> Move:
        """W^-1 dx + W ds = goal, all of the residuals of x and s gone, dtau = dkappa = 0."""
        primal, dual, _ = self.missing
        level = _across(self.normals, goal - self.scaling.times(dual))
        y = solve(self.factor, primal - np.einsum("bmnw,bnw->bm", self.columns, level))
        x = level + np.einsum("bmnw,bm->bnw", self.columns, y)
        return self._move(x, y, goal, np.zeros(len(y)), dual, np.zeros(len(y)))

    def _move(self, x, y, goal, goal_tau, dual, tau) -> Move:
        slack = dual + tau[:, None, None] * self.problem.c - np.einsum("bmnw,bm->bnw", self.problem.a, y)
        tops = dots(self.normals, goal - self.scaling.times(slack)) / self.lengths - tau[:, None] / self.lengths**2
        slack[:, self.problem.balls, 0] = tops[:, self.problem.balls]
        kappa = (goal_tau - self.state.kappa * tau) / self.state.tau
        return Move(x, goal - x, slack, y, tau, kappa)

    def refined(self, move: Move, part: np.ndarray) -> Move:
        """The move with A dx = b dtau + part of the residual once more."""
        above = dots(self.scaling.times(move.x)[:, None], self.problem.a).sum(axis=-1)
        missing = self.missing[0] * part[:, None] + self.problem.b * move.tau[:, None] - above
        y = solve(self.factor, missing)
        x = move.x + np.einsum("bmnw,bm->bnw", self.columns, y)
        slack = move.slack - np.einsum("bmnw,bm->bnw", self.problem.a, y)
        slack[:, self.problem.balls, 0] = move.slack[:, self.problem.balls, 0]
        return Move(x, move.s + move.x - x, slack, move.y + y, move.tau, move.kappa)


def _across(normals: np.ndarray, v: np.ndarray) -> np.ndarray:
    """What of v is orthogonal to the unit normals."""
    return v - dots(normals, v)[..., None] * normals


def cholesky(normal: np.ndarray) -> np.ndarray:
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


def solve(lower: np.ndarray, right: np.ndarray) -> np.ndarray:
    m = right.shape[1]
    y = right.copy()
    for j in range(m):
        y[:, j] = (y[:, j] - np.einsum("bk,bk->b", lower[:, j, :j], y[:, :j])) / lower[:, j, j]
    for j in reversed(range(m)):
        y[:, j] = (y[:, j] - np.einsum("bk,bk->b", lower[:, j + 1 :, j], y[:, j + 1 :])) / lower[:, j, j]
    return y
