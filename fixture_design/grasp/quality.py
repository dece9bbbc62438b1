"""How good a grasp is, in numbers that compare grasps of one part.

With the wrenches w_k of the contacts' edges (`wrenches`), moments divided by a length of the part:

* least weight  l* = m max { l : sum a_k w_k = 0, sum a_k = 1, a_k >= l }, between 0 and 1: how evenly the contacts can
  squeeze. Source: A. H. Li, P. Culbertson, A. D. Ames, FRoGGeR, 2023.
* epsilon  the radius of the largest ball around 0 in conv{w_k}: the worst load that fingers balance which push with 1 N
  in all. Source: C. Ferrari, J. Canny, Planning optimal grasps, ICRA 1992.

Neither is a proof of closure: rank can be missing with a positive least weight. `verification` has the verdict.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.analysis.hull import MAX_ROWS, nearest_facet
from fixture_design.arrays import Point, Rows
from fixture_design.contacts import Contact
from fixture_design.grasp.wrenches import pushes_of
from fixture_design.tolerances import DEFAULT


@dataclass(frozen=True)
class Quality:
    """Attributes: least_weight, epsilon [-], see the module; both are 0 for a grasp that is not closed.

    epsilon is None where there are too many contacts for a hull.
    """

    least_weight: float
    epsilon: float | None


def quality(contacts: Sequence[Contact], reference: Point, length: float) -> Quality:
    """The quality of some contacts in space; moments about ``reference``, divided by ``length`` [m]."""
    wrenches = pushes_of(contacts, reference).wrenches.copy()
    wrenches[:, 3:] /= length
    return Quality(least_weight(wrenches), epsilon(wrenches))


def least_weight(wrenches: Rows) -> float:
    """l* of some wrenches, shape (m, 6); 0 where they do not balance with all of them taking part."""
    from scipy.optimize import linprog

    count, dimension = wrenches.shape
    if not count:
        return 0.0
    # a = l + b, b >= 0
    equalities = np.vstack([np.hstack([wrenches.T, wrenches.sum(axis=0)[:, None]]), np.append(np.ones(count), count)])
    found = linprog(
        np.append(np.zeros(count), -1.0), A_eq=equalities, b_eq=np.append(np.zeros(dimension), 1.0),
        bounds=(0, None), method="highs",
    )  # fmt: skip
    return float(found.x[-1] * count) if found.x is not None else 0.0


def epsilon(wrenches: Rows) -> float | None:
    """The radius of the largest ball around 0 in the hull of some wrenches; 0 where 0 is not inside."""
    if len(wrenches) > MAX_ROWS:
        return None
    found = nearest_facet(wrenches) if len(wrenches) else None
    if found is None or found.at_least <= DEFAULT.near:
        return 0.0
    return found.at_least
