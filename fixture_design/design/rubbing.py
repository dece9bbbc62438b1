"""Preloads that press the part against every locator however friction rubs: what `analysis.seating` asks, searched for.

Clamps close one after the other. With the clamps S closed, the weight w and all balances that friction allows,

    N_i(S, p) = min  sum_e c_ie     over  c >= 0
    with  sum_{r, e} c_re d_re + sum_{k in S, e} c_ke d_ke = w,   sum_e c_ke = p_k,

is convex in p, so that the dual values (y, z) at some p bound it for all: N_i >= y . w + z . p. A locator is pressed if
N_i > 0 with some of the sets of clamps that are closed on the way, each of which must balance. The pushes follow from
the bounds at what is known: the pushes at which the smallest bound is largest, or the least that keep all bounds a part
of what the clamps push. Either gives bounds that are no worse, and so on.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice, permutations

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Weights
from fixture_design.design.problem import Problem
from fixture_design.design.pushing import Program
from fixture_design.tolerances import PRESSED_ANYHOW

#: Orders of closing that are compared, and rounds of better bounds.
_MOST_ORDERS, _MOST_ROUNDS = 120, 4


@dataclass(frozen=True, eq=False)
class Bounds:
    """Lower bounds of normal forces, a + z . p, one a locator: shapes (l,) and (l, k) for k clamps."""

    fixed: Weights
    slopes: Float[np.ndarray, "l k"]

    def at(self, pushes: Weights) -> Weights:
        return self.fixed + self.slopes @ pushes


@dataclass(frozen=True, eq=False)
class Seated:
    """Pushes of clamps [N], the order in which they close (numbers of the clamps), and what they prove."""

    pushes: Weights
    order: tuple[int, ...]
    bounds: Bounds


def rubs(problem: Problem) -> bool:
    """Whether the part has to sit on its locators, and friction could keep it from that."""
    return problem.duties is not None and bool(problem.duties.pressed.any() and problem.candidates.friction.any())


def seated(problem: Problem, locators: Indices, others: Indices, program: Program | None = None) -> Seated | None:
    """Small pushes of the clamps that hold what has to be held and press every locator; None where none were found.

    Args:
        others: clamps and what else there is; pushes are of those of them that push, in their order.
        program: what is to be held; by default that of the problem.
    """
    program = program or problem.pushing
    if program is None or not program.duties.pushes[others].any():
        return None
    steps = _Steps(problem, locators, others)
    low, high = program.duties.low[steps.clamps], program.duties.high[steps.clamps]
    for start in _starts(program, locators, others):
        found = _raised(steps, np.clip(start, low, high), low, high)
        if found is not None:
            return _least(program, steps, locators, others, found)
    return None


def _starts(program: Program, locators: Indices, others: Indices) -> Iterator[Weights]:
    """Pushes to start from: all as large, and those of the least that press the part without friction."""
    pushes = program.least(locators, others)
    each = pushes.each[program.duties.pushes[others]]
    if np.isfinite(pushes.total):
        yield np.full(len(each), max(float(each.max()), float(np.abs(program.duties.wrenches).max())))
        yield each


def _raised(steps: _Steps, pushes: Weights, low: Weights, high: Weights) -> Seated | None:
    """The pushes changed until every locator is pressed; None where that does not come about."""
    for _ in range(_MOST_ROUNDS):
        found = steps.best(pushes)
        if found is None or _enough(found, pushes):
            return found
        better = _evened(found.bounds, float(pushes.sum()), low, high)
        if better is None or np.allclose(better, pushes):
            return None
        pushes = better
    return None


def _enough(found: Seated, pushes: Weights) -> bool:
    return bool((found.bounds.at(pushes) >= PRESSED_ANYHOW * pushes.sum()).all() and pushes.sum() > 0)


def _evened(bounds: Bounds, total: float, low: Weights, high: Weights) -> Weights | None:
    """The pushes of the same sum at which the smallest bound is largest; None where limits forbid that sum."""
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    count = len(low)
    found = linprog(
        np.append(np.zeros(count), -1.0), A_ub=np.column_stack([-bounds.slopes, np.ones(len(bounds.fixed))]),
        b_ub=bounds.fixed, A_eq=np.append(np.ones(count), 0.0)[None], b_eq=[total],
        bounds=[*zip(low, high, strict=True), (None, None)], method="highs",
    )  # fmt: skip
    return None if found.x is None else found.x[:count]


def _least(program: Program, steps: _Steps, locators: Indices, others: Indices, found: Seated) -> Seated | None:
    """The least pushes that hold what has to be held within the bounds, and those within the bounds there."""
    best: Seated | None = None
    for _ in range(_MOST_ROUNDS):
        pushes = program.least_within(
            locators, others, found.bounds.slopes - PRESSED_ANYHOW, found.bounds.fixed
        )  # a + z . p >= a part of sum p
        again = None if pushes is None else steps.best(pushes, found.order)
        if pushes is None or again is None or (best is not None and pushes.sum() >= best.pushes.sum()):
            return best
        best = found = again
    return best


@dataclass(eq=False)
class _Steps:
    """The least forces of each locator with some of the clamps closed."""

    problem: Problem
    locators: Indices
    others: Indices
    known: dict[tuple[tuple[int, ...], bytes], tuple[Weights, Bounds] | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        duties, elements = self.problem.duties, self.problem.candidates.elements
        assert duties is not None
        pushing = duties.pushes[self.others]
        supports = np.array([_supports(elements[index]) for index in self.others.tolist()], dtype=bool)
        self.clamps = self.others[pushing]
        self.reacting = np.concatenate([self.locators, self.others[~pushing & ~supports]]).astype(np.int64)

    def best(self, pushes: Weights, order: tuple[int, ...] | None = None) -> Seated | None:
        """With the order in which the locator that is pressed least is pressed most; None where no order balances."""
        count = len(self.clamps)
        orders = islice(permutations(range(count)), _MOST_ORDERS) if order is None else [order]
        found: Seated | None = None
        for some in orders:
            bounds = self._on_the_way(pushes, some)
            if bounds is not None and (found is None or bounds.at(pushes).min() > found.bounds.at(pushes).min()):
                found = Seated(pushes, some, bounds)
        return found

    def _on_the_way(self, pushes: Weights, order: tuple[int, ...]) -> Bounds | None:
        """Of each locator the bound of the step at which it is pressed most."""
        steps = [self._with(pushes, tuple(sorted(order[:count]))) for count in range(len(order) + 1)]
        if any(step is None for step in steps):
            return None
        there = [step for step in steps if step is not None]
        most = np.argmax([least for least, _ in there], axis=0)
        fixed = np.array([there[step][1].fixed[i] for i, step in enumerate(most.tolist())])
        slopes = np.array([there[step][1].slopes[i] for i, step in enumerate(most.tolist())])
        return Bounds(fixed, slopes)

    def _with(self, pushes: Weights, closed: tuple[int, ...]) -> tuple[Weights, Bounds] | None:
        key = (closed, pushes.tobytes())
        if key not in self.known:
            self.known[key] = self._solved(pushes, closed)
        return self.known[key]

    def _solved(self, pushes: Weights, closed: tuple[int, ...]) -> tuple[Weights, Bounds] | None:
        """The least force of every locator, with its bound; None where there is no balance.

        Pyramids inside the friction cones balance for certain, and pyramids around them leave friction all it may do.
        """
        from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

        problem = self.problem
        assert problem.pushing is not None
        assert problem.pushing_bound is not None
        assert problem.duties is not None
        unit = float(np.abs(problem.duties.weight).max() + pushes[list(closed)].sum()) or 1.0
        right = np.concatenate([problem.duties.weight, pushes[list(closed)]]) / unit
        inner, _ = self._equations(problem.pushing.rough, closed)
        if linprog(np.zeros(inner.shape[1]), A_eq=inner, b_eq=right, method="highs").x is None:
            return None
        outer, edges = self._equations(problem.pushing_bound.rough, closed)
        fixed, slopes = np.zeros(len(self.locators)), np.zeros((len(self.locators), len(pushes)))
        dimension = problem.candidates.dimension
        for place in range(len(self.locators)):
            costs = np.zeros(outer.shape[1])
            costs[place * edges : (place + 1) * edges] = 1.0
            found = linprog(costs, A_eq=outer, b_eq=right, method="highs")
            if found.x is None:
                return None
            fixed[place] = found.eqlin.marginals[:dimension] @ problem.duties.weight
            slopes[place, list(closed)] = found.eqlin.marginals[dimension:]
        bounds = Bounds(fixed, slopes)
        return bounds.at(pushes), bounds

    def _equations(self, rows: np.ndarray, closed: tuple[int, ...]) -> tuple[np.ndarray, int]:
        """The balance of all forces, and the sum of each closed clamp's: columns of locators first; how many each."""
        edges, dimension = rows.shape[1], rows.shape[2]
        clamps = self.clamps[list(closed)]
        acting = np.concatenate([self.reacting, clamps]).astype(np.int64)
        balance = rows[acting].reshape(-1, dimension).T
        sums = np.kron(np.eye(len(clamps)), np.ones((1, edges)))
        given = np.hstack([np.zeros((len(clamps), len(self.reacting) * edges)), sums])
        return np.vstack([balance, given]), edges


def _supports(element: object) -> bool:
    """Whether an element comes up only when the part is seated."""
    return getattr(element, "role", None) == "support"
