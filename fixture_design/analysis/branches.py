"""Questions about A = A_1 u ... u A_N without listing its N cones (thesis 2.6, Tables 1 and 2; N is a product).

A search node has alternatives chosen for some clauses. More rows only raise s, so a node that is closed is closed in
all its branches, and a node without interior has none in any: one set of weights settles them together. A motion of the
node that some alternative of every other clause admits settles the whole union; otherwise the clause that it violates
most is the next to be branched on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.bounds import Bounds, bounds_of
from fixture_design.arrays import Indices, Rows, Vector, Weights
from fixture_design.contacts import Constraints
from fixture_design.layout import Rule
from fixture_design.tolerances import DEFAULT, Tolerances

#: Nodes looked at before a union is given up as undecided.
MAX_NODES = 3000
#: Nodes still looked at after the first branch that stayed undecided.
NODES_AFTER_DOUBT = 100

#: Alternatives chosen so far, one for each clause that is settled.
Choice = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Leaf:
    """Proof for all branches that contain ``choice``: weights on every row, zero for rows outside the choice."""

    choice: Choice
    weights: Weights


@dataclass(frozen=True, eq=False)
class Settled:
    """The outcome of a search.

    Attributes:
        truth: None if undecided.
        motion: unit, in the rows' coordinates, if one motion settles it.
        leaves: if weights settle it: together they cover every branch.
        reason: why it is undecided.
        rule: why the motion of the normals as given settles it for all normals within their errors, if it does so.
    """

    truth: bool | None
    motion: Vector | None = None
    leaves: tuple[Leaf, ...] = ()
    reason: str | None = None
    rule: Rule | None = None


class UnionQuestions:
    """Closure and interior of the union that some constraints describe. Rows are scaled to unit length here."""

    def __init__(self, constraints: Constraints, tolerances: Tolerances = DEFAULT) -> None:
        lengths = np.linalg.norm(constraints.rows, axis=1)
        self.constraints = constraints
        self.rows: Rows = constraints.rows / lengths[:, None]
        self.errors: Weights = constraints.errors / lengths
        self.lengths = lengths
        self.tolerances = tolerances.at_offset(constraints.scale.offset)
        clauses = len(constraints.contact)
        self._rows_by_alternative = _split(constraints.alternative, len(constraints.clause))
        self._alternatives_by_clause = _split(constraints.clause, clauses)
        self._single = tuple(int(a[0]) for a in self._alternatives_by_clause if len(a) == 1)

    def closed(self) -> Settled:
        """Whether every A_n is {o} (2-48), or a motion of A."""
        tolerances = self.tolerances
        return self._search(
            proves=lambda bounds: bounds.lower > tolerances.near,
            admits=lambda value: value <= tolerances.zero,
            found=False,
        )

    def has_interior(self) -> Settled:
        """Whether some A_n has interior (2-51): a motion that leaves all contacts, or weights that forbid it."""
        tolerances = self.tolerances
        return self._search(
            proves=lambda bounds: bounds.lower >= -tolerances.zero,
            admits=lambda value: value < -tolerances.near,
            found=True,
        )

    def value(self, motion: Vector) -> float:
        """max over clauses of min over alternatives of max over rows of d . u + error, for a unit motion."""
        return float(self._clause_values(motion).max(initial=-np.inf))

    def _search(self, proves: Callable[[Bounds], bool], admits: Callable[[float], bool], found: bool) -> Settled:
        leaves: list[Leaf] = []
        reason: str | None = None
        waiting: list[Choice] = [self._single]
        budget = MAX_NODES
        while waiting:
            if budget == 0:
                size = self.constraints.branch_count
                return Settled(None, reason=reason or f"the union has {size} cones; gave up after {MAX_NODES} choices")
            budget -= 1
            choice = waiting.pop()
            rows = self._rows_of(choice)
            bounds = bounds_of(self.rows[rows], self.errors[rows], self.tolerances)
            if bounds.weights is not None and proves(bounds):
                leaves.append(Leaf(choice, self._all_rows(rows, bounds.weights)))
                continue
            clause = self._next_clause(choice, bounds.motion, admits)
            if clause is None and bounds.motion is not None and admits(self.value(bounds.motion)):
                return Settled(found, motion=bounds.motion)
            if clause is None:
                clause = self._any_clause(choice)
            if clause is None:
                # one motion elsewhere may still settle the union, but it is no longer worth a long search
                reason, budget = reason or _why_undecided(bounds, self.tolerances), min(budget, NODES_AFTER_DOUBT)
                continue
            waiting += [(*choice, int(alternative)) for alternative in reversed(self._alternatives_by_clause[clause])]
        return Settled(None, reason=reason) if reason else Settled(not found, leaves=tuple(leaves))

    def _next_clause(self, choice: Choice, motion: Vector | None, admits: Callable[[float], bool]) -> int | None:
        """The clause not chosen yet that the motion violates most; None if it violates none."""
        if motion is None:
            return self._any_clause(choice)
        values = self._clause_values(motion)
        values[self.constraints.clause[list(choice)]] = -np.inf
        worst = int(np.argmax(values)) if len(values) else 0
        return None if values[worst] == -np.inf or admits(float(values[worst])) else worst

    def _any_clause(self, choice: Choice) -> int | None:
        settled = set(self.constraints.clause[list(choice)].tolist())
        return next((c for c in range(len(self._alternatives_by_clause)) if c not in settled), None)

    def _clause_values(self, motion: Vector) -> Weights:
        return self.constraints.clause_values(self.rows @ motion + self.errors)

    def _rows_of(self, choice: Choice) -> Indices:
        if not choice:
            return np.zeros(0, dtype=np.int64)
        return np.sort(np.concatenate([self._rows_by_alternative[alternative] for alternative in choice]))

    def _all_rows(self, rows: Indices, weights: Weights) -> Weights:
        """Weights of the unnormalised rows: a row twice as long needs half the weight."""
        everywhere = np.zeros(len(self.rows))
        everywhere[rows] = weights / self.lengths[rows]
        return everywhere / everywhere.sum()


def _split(owners: Indices, count: int) -> list[Indices]:
    """For each owner 0..count-1 the positions that belong to it (owners are sorted)."""
    edges = np.searchsorted(owners, np.arange(count + 1))
    return [np.arange(edges[i], edges[i + 1]) for i in range(count)]


def _why_undecided(bounds: Bounds, tolerances: Tolerances) -> str:
    return (
        f"the closure margin lies between {max(bounds.lower, -1.0):.1e} and {min(bounds.upper, 1.0):.1e}: "
        f"a tie would be within {tolerances.zero:.1e}, a clear answer beyond {tolerances.near:.1e}"
    )
