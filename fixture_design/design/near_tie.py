"""The motion that rows stop least of all, where a closure test has no proof either way."""

from __future__ import annotations

import numpy as np

from fixture_design.analysis.hull import nearest_facet
from fixture_design.arrays import Rows, Vector
from fixture_design.errors import SolverError
from fixture_design.tolerances import Tolerances


def least_stopped(rows: Rows, tolerances: Tolerances) -> tuple[Vector, bool]:
    """A unit motion u for which max_i d_i . u is least, and whether the rows close for certain all the same.

    The normal of the hull's nearest facet, where that is found. Else the least t of  d_i . u <= t  on the faces
    u_k = +-1 of the cube |u|_inf = 1, by a linear program each: for |u| = 1 nothing is below t / sqrt(d).

    Args:
        rows: shape (m, d), unit.

    Raises:
        SolverError: a program ended without its optimum.
    """
    facet = nearest_facet(rows)
    if facet is not None:
        return facet.motion, bool(facet.at_least > tolerances.near)
    found = [_on_face(rows, axis, sign) for axis in range(rows.shape[1]) for sign in (1.0, -1.0)]
    motion = min((u / np.linalg.norm(u) for u, _ in found), key=lambda u: float((rows @ u).max()))
    return motion, bool(min(least for _, least in found) / np.sqrt(rows.shape[1]) > tolerances.near)


def _on_face(rows: Rows, axis: int, sign: float) -> tuple[Vector, float]:
    """The motion with u_axis = sign that is stopped least, and by how much."""
    from scipy.optimize import linprog  # noqa: PLC0415 - slow to import

    dimension = rows.shape[1]
    limits = [(-1.0, 1.0)] * dimension + [(None, None)]
    limits[axis] = (sign, sign)
    cost = np.append(np.zeros(dimension), 1.0)
    found = linprog(cost, A_ub=np.column_stack([rows, -np.ones(len(rows))]), b_ub=np.zeros(len(rows)), bounds=limits)
    if found.x is None:
        raise SolverError(f"the motion that is stopped least was not found: {found.message}")
    return found.x[:dimension], float(found.fun)
