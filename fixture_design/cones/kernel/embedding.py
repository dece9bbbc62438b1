"""The homogeneous self-dual embedding of `balance` for many loads: its data, its points, and when it is over."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fixture_design.cones.kernel.cone_algebra import dots, squares

#: Gap and residuals of a finished load, relative to its sizes [-].
DONE = 4e-9
#: A ray is one when its residual is this small next to its objective [-].
_RAY = 1e-11
#: The central path is followed no further than this [-].
_CENTRE_END = 1e-20


@dataclass(frozen=True, eq=False)
class State:
    """x and s in the cones, y, tau and kappa: a point of the embedding for each load."""

    x: np.ndarray
    s: np.ndarray
    y: np.ndarray
    tau: np.ndarray
    kappa: np.ndarray

    def centre(self, balls: np.ndarray) -> np.ndarray:
        return (dots(self.x, self.s).sum(axis=1) + self.tau * self.kappa) / (len(balls) + 1)

    def is_inside(self) -> np.ndarray:
        sums = self.x.sum(axis=(1, 2)) + self.s.sum(axis=(1, 2)) + self.y.sum(axis=1) + self.tau + self.kappa
        inside = (squares(self.x) > 0).all(axis=1) & (squares(self.s) > 0).all(axis=1)
        return np.isfinite(sums) & inside & (self.tau > 0) & (self.kappa > 0)

    def where(self, chosen: np.ndarray, other: State) -> State:
        pick = [np.where(chosen.reshape(-1, *[1] * (a.ndim - 1)), a, b) for a, b in zip(self, other, strict=True)]
        return State(*pick)

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.x, self.s, self.y, self.tau, self.kappa))


@dataclass(frozen=True, eq=False)
class Embedding:
    """A (k, m, n, w), b (k, m), c (k, n, w), N (k, r, m), and which cones are balls (n,)."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    basis: np.ndarray
    balls: np.ndarray

    @staticmethod
    def of(maps: np.ndarray, balls: np.ndarray, fixed: np.ndarray, loads: np.ndarray, seek: bool) -> Embedding:
        """Householder's reflection of each load to the first axis: the other columns are N."""
        mirror = loads.copy()
        mirror[:, 0] += np.where(loads[:, 0] >= 0, 1.0, -1.0)
        mirror *= np.sqrt(2.0) / np.linalg.norm(mirror, axis=1, keepdims=True)
        basis = (np.eye(loads.shape[1]) - mirror[:, :, None] * mirror[:, None, :])[:, :, 1:]
        c = np.einsum("br,rnw->bnw", loads, maps) * float(seek)
        return Embedding(
            np.einsum("brm,rnw->bmnw", basis, maps), -np.einsum("brm,br->bm", basis, fixed), c, basis, balls
        )

    def start(self) -> State:
        ones = np.zeros(self.c.shape)
        ones[:, :, 0] = 1.0
        each = np.ones(len(ones))
        return State(ones, ones.copy(), np.zeros(self.b.shape), each, each.copy())

    def residuals(self, state: State) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """b tau - A x, c tau - A^T y - s (zero for a ball's t), kappa + c . x - b . y + the balls' s_t."""
        primal = self.b * state.tau[:, None] - np.einsum("bmnw,bnw->bm", self.a, state.x)
        dual = self.c * state.tau[:, None, None] - np.einsum("bmnw,bm->bnw", self.a, state.y) - state.s
        dual[:, self.balls, 0] = 0.0
        return primal, dual, state.kappa + self.cost(state) - self.bound(state)

    def cost(self, state: State) -> np.ndarray:
        return np.einsum("bnw,bnw->b", self.c, state.x)

    def bound(self, state: State) -> np.ndarray:
        return np.einsum("bm,bm->b", self.b, state.y) - state.s[:, self.balls, 0].sum(axis=1)

    def finished(self, state: State) -> np.ndarray:
        """Solved, or a ray: no x at all (b . y > 0, -A^T y in the cones), or no bound (A x = 0, c . x < 0)."""
        primal, dual, _ = self.residuals(state)
        cost, bound, tau = self.cost(state), self.bound(state), state.tau
        miss_p = np.abs(primal).max(axis=1, initial=0.0)
        miss_d = np.abs(dual).max(axis=(1, 2), initial=0.0)
        size_x, size_y = state.x.max(axis=(1, 2), initial=0.0), np.abs(state.y).max(axis=1, initial=0.0)
        gap = dots(state.x, state.s).sum(axis=1) / tau
        solved = (miss_p <= DONE * (tau + size_x)) & (miss_d <= DONE * (tau + size_y))
        solved &= gap <= DONE * np.maximum(tau, np.maximum(np.abs(cost), np.abs(bound)))
        no_x = miss_d + tau <= _RAY * bound
        no_bound = miss_p + tau <= _RAY * -cost
        return solved | no_x | no_bound | (self.centre_of(state) < _CENTRE_END)

    def centre_of(self, state: State) -> np.ndarray:
        return state.centre(self.balls)
