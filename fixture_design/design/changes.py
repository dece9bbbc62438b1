"""The fewest changes that make a layout right, and the proof that fewer do not: hitting sets over what stays and comes.

Every element of the layout may stay (x = 1) or leave, every candidate may come as a locator or as a clamp (x = 1). An
element that leaves and one of its role that comes are one change, a move; so of each role

    changes = max(how many leave, how many come),     and their sum is made small, with

    sum of x over what stops a motion u      >= 1   for motions that a choice left free (cuts, as in `hitting`)
    sum of x over the locators that notice v >= 1   for motions that the locators of a choice did not notice
    sum of x over locators that balance      <= their number - 1, where a motion has to leave all of them

until a choice closes and locates. More contacts never open what is closed, so an element only leaves to be moved or
because the part does not come out past it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from fixture_design.arrays import Indices, Mask, Rows, Vector
from fixture_design.design.candidates import flat, stops
from fixture_design.design.closing import balanced_circuit
from fixture_design.design.hitting import free_motion, strongest
from fixture_design.design.problem import Problem
from fixture_design.design.removing import balance_of
from fixture_design.tolerances import DEFAULT

#: Cuts after which the search says what it knows so far.
_MOST_CUTS = 200
#: Programs in which the bound does not rise, after which one that is nearly there may still be far from it.
_MOST_IN_VAIN = 50
#: Between layouts with as many changes the one in which less leaves and comes is taken: what one of these costs [-].
_LITTLE = 1e-4
#: The status by which the solver says that nothing fulfils the program; others (limits, trouble) prove nothing.
_INFEASIBLE = 2


@dataclass(frozen=True, eq=False)
class Options:
    """What a layout may be made of, one entry each.

    Attributes:
        candidates: its candidate, shape (o,).
        locator: whether it is one there; else it is a clamp.  there: whether the layout has it.
        stays: whether it must.
    """

    candidates: Indices
    locator: Mask
    there: Mask
    stays: Mask

    @classmethod
    def of(cls, problem: Problem, locators: Indices, clamps: Indices, fixed: Indices, pool: Indices) -> Options:
        """A layout's locators and clamps, and all that may come: locators from ``pool``, clamps from anywhere."""
        there = np.concatenate([locators, clamps])
        numbers = np.concatenate([there, pool, problem.new])
        locator = np.zeros(len(numbers), dtype=bool)
        locator[: len(locators)] = True
        locator[len(there) : len(there) + len(pool)] = True
        old = np.arange(len(numbers)) < len(there)
        return cls(numbers, locator, old, old & np.isin(numbers, fixed))


@dataclass(frozen=True, eq=False)
class Changes:
    """The fewest changes.

    Attributes:
        locators, clamps: candidates of the layout they lead to; None where none was found.
        bound: no layout within these options takes fewer.
        complete: whether the search came to its end: these are the fewest, or there are none.
    """

    locators: Indices | None
    clamps: Indices | None
    bound: int
    complete: bool = True


@dataclass
class _Program:
    """The integer program so far; ``leaving`` locators leave that are no option."""

    problem: Problem
    options: Options
    leaving: int
    cuts: list[Mask] = field(default_factory=list)
    conflicts: list[tuple[int, ...]] = field(default_factory=list)

    def solved(self) -> tuple[Mask | None, float]:
        """The cheapest choice, shape (o,), and a lower bound of its changes: inf where there certainly is no choice.

        Without a choice and with a bound of 0 the solver gave up.
        """
        from scipy.optimize import Bounds, LinearConstraint, milp  # noqa: PLC0415 - slow to import

        kept = self._unlike()
        options, count = self.options, len(kept)
        old, locator = options.there[kept], options.locator[kept]
        costs = np.concatenate([np.where(old, -_LITTLE, _LITTLE), [1.0, 1.0]])
        rows: list[np.ndarray] = []
        least: list[float] = []
        most: list[float] = []

        def add(row: np.ndarray, low: float, high: float) -> None:
            rows.append(row)
            least.append(low)
            most.append(high)

        for z, role in enumerate((locator, ~locator)):
            for sign, some in ((1.0, role & old), (-1.0, role & ~old)):  # z - leaving >= 0, z - coming >= 0
                row = np.zeros(count + 2)
                row[:count][some], row[count + z] = sign, 1.0
                add(row, float(some.sum()) + (self.leaving if z == 0 else 0) if sign > 0 else 0.0, np.inf)
        for limit, role in ((self.problem.limits.locators, locator), (self.problem.limits.clamps, ~locator)):
            if limit is not None:
                add(np.append(role.astype(float), [0.0, 0.0]), 0.0, float(limit))
        # as many come as there are changes, at most; new ones have no number of their own here (`_unlike`)
        add(np.append((old & locator).astype(float), [1.0, 0.0]), float(_least_locators(self.problem, options)), np.inf)
        add(np.append(old.astype(float), [1.0, 1.0]), float(_least_elements(self.problem)), np.inf)
        for cut in self.cuts:
            add(np.append(cut[kept].astype(float), [0.0, 0.0]), 1.0, np.inf)
        place = {int(option): column for column, option in enumerate(kept)}
        for conflict in self.conflicts:
            row = np.zeros(count + 2)
            row[[place[option] for option in conflict]] = 1.0
            add(row, 0.0, float(len(conflict) - 1))
        low = np.concatenate([options.stays[kept].astype(float), [0.0, 0.0]])
        high = np.concatenate([np.ones(count), [np.inf, np.inf]])
        within = LinearConstraint(np.array(rows), np.array(least), np.array(most))  # type: ignore[arg-type]
        limits = Bounds(low, high)  # type: ignore[arg-type]
        whole = np.ones(count + 2)
        found = milp(costs, constraints=within, integrality=whole, bounds=limits, options={"mip_rel_gap": 0.0})
        if found.x is None:
            return None, np.inf if found.status == _INFEASIBLE else 0.0
        chosen = np.zeros(len(options.candidates), dtype=bool)
        chosen[kept[found.x[:count] > 1 / 2]] = True
        # as many come as there are changes, at most, so that these cost no more than (1 + little) times their number
        return chosen, max(0.0, float(np.ceil(float(found.mip_dual_bound) / (1 + _LITTLE) - DEFAULT.near)))

    def _unlike(self) -> Indices:
        """What is there, what is in conflicts, and of all others one for each role and set of cuts."""
        always = self.options.there.copy()
        always[[option for conflict in self.conflicts for option in conflict]] = True
        if not self.cuts:
            return np.flatnonzero(always)
        patterns = np.vstack([np.array(self.cuts), self.options.locator])
        hit = patterns[:-1].any(axis=0)
        others = np.flatnonzero(~always & hit)
        if not len(others):
            return np.flatnonzero(always)
        first = np.unique(np.packbits(patterns[:, others], axis=0), axis=1, return_index=True)[1]
        return np.sort(np.concatenate([np.flatnonzero(always), others[first]]))


def fewest_changes(
    problem: Problem, options: Options, leaving: int, enough: float, cancelled: Callable[[], bool] = lambda: False
) -> Changes:
    """The fewest changes within some options.

    Args:
        leaving: how many locators leave that are no option.
        enough: the search ends where the bound reaches this.
    """
    program, bound = _Program(problem, options, leaving), 0
    in_vain = 0
    while True:
        chosen, least = program.solved()
        if chosen is None:
            return Changes(None, None, len(options.candidates) + 1 if least > 0 else bound, complete=least > 0)
        in_vain = 0 if least > bound else in_vain + 1
        bound = max(bound, int(least))
        too_many = len(program.cuts) >= _MOST_CUTS or in_vain >= _MOST_IN_VAIN
        if bound >= enough or too_many or cancelled():
            return Changes(None, None, bound, complete=bound >= enough)
        conflict = _in_conflict(problem, options, chosen) or _bound_both_ways(problem, options, chosen)
        if conflict is not None:
            program.conflicts.append(conflict)
            continue
        more = list(_missing(problem, options, chosen))
        if not more:
            numbers = options.candidates
            return Changes(numbers[chosen & options.locator], numbers[chosen & ~options.locator], bound)
        program.cuts += more


def _least_locators(problem: Problem, options: Options) -> int:
    """No fewer locators determine what all candidates can notice: each has so many rows at most."""
    if not problem.determines:
        return 0
    rows = np.any(problem.candidates.rows[options.candidates], axis=2).sum(axis=1)
    return -(-problem.candidates.freedoms // max(1, int(rows.max(initial=1))))


def _least_elements(problem: Problem) -> int:
    """No fewer options close without friction, with what stays: d + 1 rows do."""
    if problem.closes != "without friction" or problem.each > 1:
        return 0
    return max(0, problem.candidates.dimension + 1 - len(problem.clamps))


def _in_conflict(problem: Problem, options: Options, chosen: Mask) -> tuple[int, int] | None:
    """Two that may not be there together, of which one is new: the same place in two roles, or too near."""
    some = np.flatnonzero(chosen)
    for place, option in enumerate(some.tolist()):
        for other in some[place + 1 :].tolist():
            first, second = int(options.candidates[option]), int(options.candidates[other])
            old = options.there[option] and options.there[other]
            if not old and (first == second or not problem.joins(np.array([first]), [second])[0]):
                return option, other
    return None


def _bound_both_ways(problem: Problem, options: Options, chosen: Mask) -> tuple[int, ...] | None:
    """Few locators among which there is a balance, so that no motion leaves all of them; None where there is none."""
    some = np.flatnonzero(chosen & options.locator)
    if not problem.opens or not len(some):
        return None
    rows, owner, balanced = balance_of(problem.candidates.rows, options.candidates[some])
    if not balanced.any():
        return None
    circuit = balanced_circuit(rows, np.ones(len(rows)), balanced)
    found = balanced if circuit is None else circuit
    return tuple(int(option) for option in np.unique(some[owner[found]]))


def _missing(problem: Problem, options: Options, chosen: Mask) -> Iterator[Mask]:
    """Cuts that a choice does not hit: what its locators do not notice, what nothing of it stops."""
    numbers, near = options.candidates, problem.candidates.tolerances.near
    kept = np.array(problem.clamps, dtype=np.int64)
    if problem.locates:
        motion = _unnoticed(problem, options, chosen)
        if motion is not None:
            yield options.locator & (np.abs(problem.candidates.rows[numbers] @ motion).max(axis=1) > near)
    if problem.closes is not None:
        rows = problem.closing_rows
        motion = free_motion(flat(rows, np.concatenate([kept, numbers[chosen]])), problem.candidates.tolerances)
        if motion is not None:
            pool = np.unique(numbers)
            cover = np.flatnonzero(np.isin(pool, numbers[chosen]))
            motion, _ = strongest(rows, kept, pool, cover, motion, problem.candidates.tolerances)
            yield stops(rows[numbers], motion, near)


def _unnoticed(problem: Problem, options: Options, chosen: Mask) -> Vector | None:
    """A unit motion that the chosen locators do not notice, and as few others as there are in a simple try."""
    freedoms, tolerance = problem.candidates.freedoms, problem.candidates.tolerances.near
    rows = problem.candidates.rows
    held = flat(rows, options.candidates[chosen & options.locator])
    null = _null_space(held, problem.candidates.dimension, tolerance)
    spare = problem.candidates.dimension - freedoms
    if len(null) <= spare:
        return None
    for candidate in options.candidates[options.locator & ~chosen].tolist():
        if len(null) == spare + 1:
            break
        less = _null_space(np.vstack([held, rows[candidate]]), problem.candidates.dimension, tolerance)
        if spare < len(less) < len(null):
            held, null = np.vstack([held, rows[candidate]]), less
    everything = flat(rows, np.arange(len(problem.candidates)))
    noticed = [motion for motion in null if np.abs(everything @ motion).max() > tolerance]
    return noticed[0] if noticed else None


def _null_space(rows: Rows, dimension: int, tolerance: float) -> Rows:
    """Orthonormal motions that the rows do not notice, shape (k, d)."""
    if not len(rows):
        return np.eye(dimension)
    _, values, right = np.linalg.svd(rows)
    rank = int((values > tolerance * max(float(values[0]), tolerance)).sum())
    return right[rank:]
