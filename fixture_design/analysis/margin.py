"""Margins: s = min over |u| = 1 of the max over clauses of the min over alternatives of d . u, as a number to compare.

Rows are [n; (x - reference) X n / length] with |n| = 1 and the part's own reference and length, not normalised further:
then a contact more never lowers the closure margin. Over a union, s is the smallest s of its branches. More rows only
raise s, so the s of a partial choice bounds all its branches from below, and the choice with the lowest bound is always
the next to be completed: the first complete one has the smallest s.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import count

import numpy as np

from fixture_design.analysis.hull import nearest_facet
from fixture_design.arrays import Rows
from fixture_design.cones.kernel import minimum_norm_point, tucker_partition
from fixture_design.contacts import Constraints
from fixture_design.tolerances import DEFAULT, Tolerances

#: Choices looked at before a union's margin is given up.
MAX_CHOICES = 256
#: Work of facets, in numbers of rows to the power d / 2, before a margin is given up: about a second.
MAX_WORK = 2.0e7


@dataclass(order=True)
class _Choice:
    """A partial choice with a lower bound on s; ``exact`` if the bound is the s of its rows."""

    bound: float
    number: int
    exact: bool = field(compare=False)
    taken: tuple[int, ...] = field(compare=False)
    depth: int = field(compare=False)


def closure_margin(constraints: Constraints, tolerances: Tolerances = DEFAULT) -> float | None:
    """s of the union that the constraints describe; None where it would take too long.

    Positive: closed, by so much. Negative: -s is the margin of strong accessibility. Zero: a tie.
    """
    alternatives = [constraints.alternatives_of(clause).tolist() for clause in range(len(constraints.contact))]
    forced = tuple(options[0] for options in alternatives if len(options) == 1)
    several = sorted((options for options in alternatives if len(options) > 1), key=len)
    numbers = count()
    waiting: list[_Choice] = []

    def add(taken: tuple[int, ...], depth: int, least: float) -> None:
        bound, exact = open_margin(constraints.rows[constraints.rows_of(taken)], tolerances)
        heappush(waiting, _Choice(max(bound, least), next(numbers), exact, taken, depth))

    add(forced, 0, -np.inf)
    work = 0.0
    for _ in range(MAX_CHOICES):
        choice = heappop(waiting)
        rows = constraints.rows[constraints.rows_of(choice.taken)]
        if not choice.exact:
            work += float(len(rows)) ** (rows.shape[1] / 2)
            found = nearest_facet(rows) if work <= MAX_WORK else None
            if found is None:
                return None
            heappush(
                waiting, _Choice(max(found.distance, choice.bound), next(numbers), True, choice.taken, choice.depth)
            )
        elif choice.depth == len(several):
            return choice.bound
        else:
            for alternative in several[choice.depth]:
                add((*choice.taken, alternative), choice.depth + 1, choice.bound)
    return None


def open_margin(rows: Rows, tolerances: Tolerances = DEFAULT) -> tuple[float, bool]:
    """s of one set of rows if they do not close, and whether it is exact.

    Returns:
        minus the distance of the rows' hull from the origin, or zero for a tie: exact. Zero and not exact if they
        close: s is positive then, and the hull's facets tell how much. Minus infinity without rows.
    """
    if not len(rows):
        return -np.inf, True
    point, _ = minimum_norm_point(rows)
    distance = float(np.linalg.norm(point))
    if distance > tolerances.tie:
        return -distance, True
    unit = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    return 0.0, not tucker_partition(unit, tolerances.tie).closes
