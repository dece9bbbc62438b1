"""Deterministic locating (H. Asada, A. By, 1985): the locators' distances fix the part's position to first order.

That is so if and only if no motion leaves every contact's distance unchanged: the face vectors have full rank, in every
branch where there are alternatives. Where a clause has an alternative in the span of the rows chosen so far, that one
leads to a deficient branch if any does, so the clause is not branched on; every branching raises the rank, and the
search is at most d deep.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, product

import numpy as np

from fixture_design.analysis.counting import too_few_to_locate
from fixture_design.analysis.normal_errors import still_motion
from fixture_design.analysis.restraint import Restraint, motion_in_world
from fixture_design.arrays import Rows, Vector, Weights
from fixture_design.cones.kernel import singular_directions
from fixture_design.contacts import Constraints, motion_scaled
from fixture_design.layout import Answer, Finding, Rule, Singular
from fixture_design.tolerances import Tolerances

#: Choices looked at before the rank is given up as undecided.
MAX_NODES = 3000
#: Branches whose singular values are looked at for the margin.
MAX_BRANCHES = 1024


def deterministic(restraint: Restraint) -> Finding:
    """Whether the face vectors have rank d in every branch.

    Returns:
        yes with the rank; no with the rank of the worst branch and a motion that it does not notice; undecided with a
        reason. The margin is the d-th singular value in the report's scale, smallest over the branches, 0 with fewer
        rows than d; None if there are more than MAX_BRANCHES branches.
    """
    constraints, rule = restraint.constraints, None
    search = _RankSearch.of(constraints, restraint.tolerances)
    outcome = search.visit()
    if isinstance(outcome, _Deficient) and outcome.motion is None and constraints.errors.any():
        if restraint.slip is not None:
            return _slips(restraint, restraint.slip)
        still, rule = still_motion(restraint.contacts, restraint.tolerances), too_few_to_locate(restraint.contacts)
        if still is not None:
            outcome, rule = replace(outcome, motion=still), None
        elif rule is not None:
            outcome = _RankSearch.of(constraints.without_errors(), restraint.tolerances).visit()
    margin = determinacy_margin(restraint.reported)
    dimension = constraints.rows.shape[1]
    if isinstance(outcome, _FullRank):
        choices = tuple(restraint.choice(leaf, constraints) for leaf in outcome.leaves)
        return Finding(Answer.YES, margin, Singular(dimension, None, choices, 0.0), 0.0)
    if outcome.motion is None:
        reason = f"the smallest singular value is {outcome.value:.1e}, neither zero nor clear of it"
        if constraints.errors.any():
            reason = f"the smallest singular value is {outcome.value:.1e}, not clear of what the normals may be off"
        if search.nodes >= MAX_NODES:
            reason = f"the union has {constraints.branch_count} cones; gave up after {MAX_NODES} choices"
        return Finding(Answer.UNDECIDED, margin, reason=restraint.reason(reason))
    motion = motion_in_world(outcome.motion, constraints.scale)
    scaled = motion_scaled(motion, restraint.report.reference, restraint.report.length)
    rows = restraint.reported.rows[restraint.reported.rows_of(outcome.choice)]
    residual = float(np.abs(rows @ scaled).max() / np.linalg.norm(scaled))
    choice = restraint.choice(outcome.choice, constraints)
    return Finding(Answer.NO, margin, Singular(outcome.rank, motion, (choice,), residual, rule), residual)


def _slips(restraint: Restraint, slip: Vector) -> Finding:
    """No: a motion of all surfaces along themselves is noticed by no contact, up to the normals' errors."""
    motion = motion_in_world(slip, restraint.constraints.scale)
    scaled = motion_scaled(motion, restraint.report.reference, restraint.report.length)
    residual = float(np.abs(restraint.reported.rows @ scaled).max() / np.linalg.norm(scaled))
    values = singular_directions(restraint.constraints.rows)[0]
    rank = min(int(np.sum(values > restraint.tolerances.tie)), len(values) - 1)
    evidence = Singular(rank, motion, ((),), residual, Rule("common slip", ()))
    return Finding(Answer.NO, 0.0, evidence, residual)


def determinacy_margin(constraints: Constraints) -> float | None:
    """Smallest d-th singular value over the branches; None if there are too many to look at."""
    if constraints.branch_count > MAX_BRANCHES:
        return None
    alternatives = [constraints.alternatives_of(c).tolist() for c in range(len(constraints.contact))]
    branches = islice(product(*alternatives), MAX_BRANCHES)
    return min(_last_singular_value(constraints.rows[constraints.rows_of(b)]) for b in branches)


def _last_singular_value(rows: Rows) -> float:
    if len(rows) < rows.shape[1]:
        return 0.0
    return float(np.linalg.svd(rows, compute_uv=False)[-1])


@dataclass(frozen=True, eq=False)
class _FullRank:
    """All branches below a choice have full rank: those of each leaf by the alternatives that the leaf names."""

    leaves: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, eq=False)
class _Deficient:
    """A branch without full rank (with the motion it does not notice) or too near to tell (without)."""

    choice: tuple[int, ...]
    rank: int
    value: float
    motion: Vector | None


@dataclass(eq=False)
class _RankSearch:
    """Looks for a branch whose unit rows have less than full rank."""

    constraints: Constraints
    rows: Rows
    errors: Weights
    tolerances: Tolerances
    nodes: int = 0

    @classmethod
    def of(cls, constraints: Constraints, tolerances: Tolerances) -> _RankSearch:
        lengths = np.linalg.norm(constraints.rows, axis=1)
        rows, errors = constraints.rows / lengths[:, None], constraints.errors / lengths
        return cls(constraints, rows, errors, tolerances.at_offset(constraints.scale.offset))

    @cached_property
    def alternatives(self) -> list[list[int]]:
        return [self.constraints.alternatives_of(c).tolist() for c in range(len(self.constraints.contact))]

    @cached_property
    def forced(self) -> tuple[int, ...]:
        return tuple(options[0] for options in self.alternatives if len(options) == 1)

    def visit(self, branched: tuple[int, ...] = ()) -> _FullRank | _Deficient:
        """The first deficient branch that contains the choice, a doubtful one if there is none, or full rank.

        ``branched`` are the alternatives chosen so far. Full rank is asked of their rows (and those of clauses without
        alternatives) alone; alternatives in their span are then taken for the sake of a deficient branch.
        """
        self.nodes += 1
        rows = self.constraints.rows_of((*self.forced, *branched))
        values, right = singular_directions(self.rows[rows])
        error = float(np.linalg.norm(self.errors[rows]))
        if values[-1] > self.tolerances.near + error:
            return _FullRank((branched,))
        unnoticed = right[values <= self.tolerances.near + error]
        spanned, clause, options = self._next(branched, unnoticed)
        if clause is None:
            return self._deficient((*self.forced, *branched, *spanned))
        doubtful, leaves = None, []
        for alternative in options:
            if self.nodes >= MAX_NODES:
                return doubtful or _Deficient(branched, 0, float(values[-1]), None)
            found = self.visit((*branched, alternative))
            if isinstance(found, _Deficient) and found.motion is not None:
                return found
            if isinstance(found, _FullRank):
                leaves += found.leaves
            else:
                doubtful = doubtful or found
        return doubtful or _FullRank(tuple(leaves))

    def _deficient(self, choice: tuple[int, ...]) -> _Deficient:
        rows = self.constraints.rows_of(choice)
        values, right = singular_directions(self.rows[rows])
        certain = values[-1] <= self.tolerances.zero and not np.any(self.errors[rows])
        rank = int(np.sum(values > self.tolerances.tie))
        return _Deficient(choice, rank, float(values[-1]), right[-1] if certain else None)

    def _next(self, branched: tuple[int, ...], unnoticed: Rows) -> tuple[list[int], int | None, list[int]]:
        """Alternatives in the span, one a clause; then the clause that adds least, and its alternatives in order."""
        settled = set(self.constraints.clause[list(branched)].tolist())
        spanned: list[int] = []
        best: tuple[float, int, list[int]] | None = None
        for clause, options in enumerate(self.alternatives):
            if clause in settled or len(options) == 1:
                continue
            adds = np.linalg.norm(self.rows[self.constraints.rows_of(options)] @ unnoticed.T, axis=1)
            if adds.min() <= self.tolerances.zero:
                spanned.append(options[int(np.argmin(adds))])
            elif best is None or adds.min() < best[0]:
                best = (float(adds.min()), clause, [options[i] for i in np.argsort(adds)])
        return (spanned, None, []) if best is None else (spanned, *best[1:])
