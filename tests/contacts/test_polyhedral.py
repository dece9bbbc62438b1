"""Two tangent cones that meet: known clauses, and brute force over random cones in the plane and in space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from fixture_design.contacts import Clause
from fixture_design.contacts.polyhedral import polyhedral_clauses
from tests.geometry.parts import unit

X, Y, Z = np.eye(3)
#: The tangent cone of a point, {o}: what a tip without volume has for a piece.
POINT_PIECE = (*np.eye(3), *-np.eye(3))
WEDGE = (X - Z, -X - Z)
APEX = (X - Z, -X - Z, Y - Z, -Y - Z)


def admits(clauses: Sequence[Clause], velocity: np.ndarray) -> bool:
    """Whether a displacement of the contact point is admissible: n . v <= 0 for some n of every clause."""
    return all(any(normal @ velocity <= 0 for normal in clause) for clause in clauses)


#: Pieces of the part, pieces of the body, clauses.
KNOWN = {
    "facet on facet": ([[-Z]], [[Z]], [[-Z]]),
    "apex on facet": ([APEX], [[Z]], [[-Z]]),
    "facet on apex": ([[-2 * Z]], [[X + Z, Z - X, Y + Z, Z - Y]], [[-Z]]),
    "edge on facet": ([WEDGE], [[3 * Z]], [[-Z]]),
    "edge across edge": ([WEDGE], [[Y + Z, Z - Y]], [[-Z]]),
    "edge along edge": ([WEDGE], [[X + Z, Z - X]], [[X - Z, -X - Z]]),
    "apex on convex edge": ([(3 * X - Z, -3 * X - Z, 3 * Y - Z, -3 * Y - Z)], [[Y + Z, Z - Y]], [[Y - Z, -Y - Z]]),
    "corner of a block in a notch": ([(-X, -Y, -Z)], [[X], [Z]], [[-X], [-Z]]),
    "corner of a block in a corner": ([(-X, -Y, -Z)], [[X], [Y], [Z]], [[-X], [-Y], [-Z]]),
    "notch over an edge": ([[-X], [-Z]], [[X, Z]], [[-X], [-Z]]),
    "point on facet": ([[-Z]], [POINT_PIECE], [[-Z]]),
    "point on convex edge": ([WEDGE], [POINT_PIECE], [[X - Z, -X - Z]]),
    "point in concave edge, pieces that overlap": ([[X], [Z]], [POINT_PIECE], [[X], [Z]]),
    "point against point": ([POINT_PIECE], [POINT_PIECE], []),
}


@pytest.mark.parametrize("case", KNOWN)
def test_known_contacts(case: str) -> None:
    moving, fixed, expected = KNOWN[case]
    assert _rounded(polyhedral_clauses(moving, fixed) or ()) == _rounded(expected)


def _rounded(clauses: object) -> set[frozenset]:
    return {frozenset(tuple((np.round(unit(n), 9) + 0.0).tolist()) for n in clause) for clause in clauses}  # type: ignore[attr-defined]


def test_solids_that_overlap_have_no_clauses() -> None:
    assert polyhedral_clauses([[-Z]], [[Z - 0.1 * X]]) is None
    assert polyhedral_clauses([[-Z], [X, Z]], [[Z]]) is None


def test_normals_are_those_given_where_a_facet_makes_them() -> None:
    ((normal,),) = polyhedral_clauses([[np.array([0.1, 0.2, -0.7])]], [[np.array([-1.0, -2, 7])]]) or ()
    assert normal.tolist() == [0.1, 0.2, -0.7]
    ((normal,),) = polyhedral_clauses([APEX], [[7 * Z]]) or ()
    assert (normal + 0.0).tolist() == [0, 0, -7]


def test_nearly_parallel_faces_are_parallel_only_if_told_so() -> None:
    assert polyhedral_clauses([[-Z]], [[Z + 1e-6 * X]]) is None
    assert _rounded(polyhedral_clauses([WEDGE], [[Z + 1e-6 * Y]], 1e-4) or ()) == {frozenset({(0.0, -1e-6, -1.0)})}


@pytest.mark.parametrize("space", [2, 3])
def test_random_cones_against_points_of_both(space: int) -> None:
    """v enters if x1 + v = x2 for some x1 inside the part's cone and x2 inside the body's: by linear programming."""
    from scipy.optimize import linprog

    rng = np.random.default_rng(space)
    judged = {True: 0, False: 0}
    for _ in range(80):
        up = rng.normal(size=space)
        moving, fixed = _pieces(rng, up), _pieces(rng, -up)
        clauses = polyhedral_clauses(moving, fixed)
        if clauses is None:
            assert max(_depth(linprog, piece, other, np.zeros(space)) for piece in moving for other in fixed) > 0
            continue
        for velocity in rng.normal(size=(8, space)):
            depth = max(_depth(linprog, piece, other, velocity) for piece in moving for other in fixed)
            enters = not admits(clauses, velocity)
            values = [min(float(unit(n) @ velocity) for n in clause) for clause in clauses]
            if min(abs(value) for value in values) > 1e-6:
                assert enters == (depth > 1e-9), (moving, fixed, velocity)
                judged[enters] += 1
    assert min(judged.values()) > 60


def _pieces(rng: np.random.Generator, up: np.ndarray) -> list[list[np.ndarray]]:
    """One to three simplicial cones around a direction, now and then without one of their facets."""
    pieces = []
    for _ in range(rng.integers(1, 4)):
        spans = unit(up) + 0.7 * rng.normal(size=(len(up), len(up)))
        facets = list(-np.linalg.inv(spans).T)
        pieces.append(facets[1:] if rng.random() < 0.3 else facets)
    return pieces


def _depth(linprog: object, piece: list, other: list, velocity: np.ndarray) -> float:
    """The largest t with n . x <= -t on the part's side and n . (x + v) <= -t on the body's; 0 if there is none."""
    ones, others = np.array([unit(n) for n in piece]), np.array([unit(n) for n in other])
    rows = np.vstack([ones, others])
    rows = np.hstack([rows, np.ones((len(rows), 1))])
    limits = np.r_[np.zeros(len(ones)), -others @ velocity]
    cost = np.r_[np.zeros(len(velocity)), -1.0]
    bounds = [(-1e3, 1e3)] * len(velocity) + [(-10.0, 1.0)]
    found = linprog(cost, A_ub=rows, b_ub=limits, bounds=bounds)  # type: ignore[operator]
    return float(found.x[-1])


def test_pieces_that_pass_by_give_no_clause() -> None:
    clauses = polyhedral_clauses([[X, -Z]], [[Z], [Y]], pass_by=True)
    assert _rounded(clauses or ()) == _rounded([[-Z]])
