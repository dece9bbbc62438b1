"""Margins: s = min over |u| = 1 of the max over clauses of the min over alternatives of d . u, as a number to compare.

Rows are [n; (x - reference) X n / length] with |n| = 1 and the part's own reference and length, not normalised further:
then a contact more never lowers the closure margin. Over a union, s is the smallest s of its branches; more rows only
raise it, so a partial choice whose s is already above the smallest one found is not looked into.
"""

from __future__ import annotations

import numpy as np

from fixture_design.analysis.hull import nearest_facet
from fixture_design.arrays import Rows
from fixture_design.cones.kernel import minimum_norm_point, tucker_partition
from fixture_design.contacts import Constraints
from fixture_design.tolerances import DEFAULT, Tolerances

#: Choices looked at before a union's margin is given up.
MAX_CHOICES = 256


def closure_margin(constraints: Constraints, tolerances: Tolerances = DEFAULT) -> float | None:
    """s of the union that the constraints describe; None where it would take too long.

    Positive: closed, by so much. Negative: -s is the margin of strong accessibility. Zero: a tie.
    """
    alternatives = [constraints.alternatives_of(clause) for clause in range(len(constraints.contact))]
    forced = [int(a[0]) for a in alternatives if len(a) == 1]
    open_clauses = sorted((a for a in alternatives if len(a) > 1), key=len)
    smallest, visited = np.inf, 0
    stack: list[tuple[list[int], int]] = [(forced, 0)]
    while stack:
        choice, depth = stack.pop()
        visited += 1
        if visited > MAX_CHOICES:
            return None
        margin = branch_margin(constraints.rows[constraints.rows_of(choice)], tolerances)
        if margin is None:
            return None
        if margin >= smallest:
            continue
        if depth == len(open_clauses):
            smallest = margin
        else:
            stack += [([*choice, int(alternative)], depth + 1) for alternative in open_clauses[depth]]
    return float(smallest)


def branch_margin(rows: Rows, tolerances: Tolerances = DEFAULT) -> float | None:
    """s of one set of rows: facet distance if they close, minus the distance of their hull if they do not.

    Returns:
        s, exact to rounding; -inf without rows; None if they close and are too many for the hull's facets.
    """
    if not len(rows):
        return -np.inf
    point, _ = minimum_norm_point(rows)
    distance = float(np.linalg.norm(point))
    if distance > tolerances.tie:
        return -distance
    if not tucker_partition(rows / np.linalg.norm(rows, axis=1, keepdims=True), tolerances.tie).closes:
        return 0.0
    found = nearest_facet(rows)
    return None if found is None else found[0]
