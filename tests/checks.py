"""All comparators, and float estimates of how near an answer is to another one. Nothing here calls the code under test,
except that `same_set` reads the forms of the cones that it is given.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from scipy.optimize import lsq_linear, nnls
from scipy.spatial import ConvexHull

from fixture_design.cones import PolyhedralConvexCone
from tests import exact

#: Largest number that passes for rounding, for unit vectors after a conversion or two [-].
ROUNDING = 1e-9
#: Relative change of friction that must not change the answer in space, or it is a near tie; a pyramid of 128 edges is
#: off by 3e-4 [-].
FRICTION_BAND = 1e-3


def unit(rows: object) -> np.ndarray:
    """Rows of length one; zero rows left out."""
    array = np.array(rows, dtype=float)
    if not array.size:
        return array.reshape(0, array.shape[1] if array.ndim == 2 else 0)
    array = array[np.abs(array).max(axis=1) > 0]
    array = array / np.abs(array).max(axis=1, keepdims=True)
    return array / np.linalg.norm(array, axis=1, keepdims=True)


def same_rays(first: object, second: object, tolerance: float = ROUNDING) -> bool:
    """Equal as sets of directions: the same number, and each has its partner."""
    a, b = unit(first), unit(second)
    if len(a) != len(b):
        return False
    if not len(a):
        return True
    distances = np.linalg.norm(a[:, None] - b[None], axis=2)
    return bool((distances.min(axis=1) <= tolerance).all() and (distances.min(axis=0) <= tolerance).all())


def same_linear_span(first: object, second: object, tolerance: float = ROUNDING) -> bool:
    """Whether two lists of independent vectors span one linear space."""
    a, b = unit(first), unit(second)
    if len(a) != len(b):
        return False
    return not len(a) or bool(np.abs(a - (a @ np.linalg.pinv(b)) @ b).max() <= tolerance)


def fits(spans: np.ndarray, lines: np.ndarray, faces: np.ndarray, equalities: np.ndarray) -> float:
    """Largest violation of a face form by a span form, all as unit vectors: 0 if every span vector is in the cone."""
    u, b, a, e = (unit(np.asarray(rows)) for rows in (spans, lines, faces, equalities))
    products = [np.maximum(a @ u.T, 0), np.abs(a @ b.T), np.abs(e @ u.T), np.abs(e @ b.T)]
    return max((float(product.max()) for product in products if product.size), default=0.0)


def same_set(first: PolyhedralConvexCone, second: PolyhedralConvexCone, tolerance: float = ROUNDING) -> bool:
    """Whether two cones, each in both forms, are one set: the span form of each fits the face form of the other."""
    there = fits(first.spans, first.lines, second.faces, second.equalities)
    back = fits(second.spans, second.lines, first.faces, first.equalities)
    return max(there, back) <= tolerance


def matches_exact(cone: PolyhedralConvexCone, rays: exact.Rows, lines: exact.Rows) -> bool:
    """Whether a span form, irreducible and orthogonal to its lines, has these extreme rays and lines."""
    return same_rays(cone.spans, rays) and same_linear_span(cone.lines, lines)


def is_irreducible(rows: exact.Rows, both_ways: exact.Rows = ()) -> bool:
    """Whether no integer row is in the cone of the others, both_ways are independent, and no row balances."""
    if exact.rank(both_ways) < len(both_ways):
        return False
    lines = [[sign * v for v in row] for row in both_ways for sign in (1, -1)]
    for index, row in enumerate(rows):
        others = [*rows[:index], *rows[index + 1 :], *lines]
        if exact.in_cone(row, others) or exact.in_cone([-v for v in row], others):
            return False
    return True


@dataclass(frozen=True)
class Gaps:
    """How far answers are from other ones (see `tests.generated.GeneratedLayout.gaps`), and the closure margin s."""

    form_closure: float
    strongly_accessible: float
    deterministic: float
    force_closure: float
    margin: float


def gaps_of(
    contacts: Sequence[exact.ExactContact], truth: Mapping[str, bool | None], dimension: int, edges: int
) -> Gaps:
    """Distances of exact answers from other ones, in floats: signs come from exact arithmetic, sizes from here.

    Rows are dimensionless: unit normals, moments about the centroid of the contacts, divided by their RMS distance.
    ``edges`` settled force closure; 0 says that there is no friction.
    """
    clauses = exact.clauses_of(contacts)
    branches = [_Branch.of(rows, _scaled(rows, contacts), dimension) for rows in exact.branches(clauses)]
    closure = _closure_gap(branches, truth["form_closure"])
    if truth["strongly_accessible"]:
        strong = max(-branch.margin for branch in branches)
    else:
        strong = min(branch.margin or np.inf for branch in branches)
    smallest = min(branch.smallest for branch in branches)
    force = closure
    if edges:
        force = _force_gap(contacts, truth["force_closure"], dimension, edges)
    margin = min(branch.margin for branch in branches)
    return Gaps(closure, strong, smallest if truth["deterministic"] else np.inf, force, margin)


def _closure_gap(branches: Sequence[_Branch], closed: bool | None) -> float:
    """Of a union: the weakest branch if it is closed; if not, the branch that shows it best."""
    if closed:
        return min(branch.gap for branch in branches)
    return max(branch.gap for branch in branches if not branch.closed)


def _force_gap(contacts: Sequence[exact.ExactContact], closed: bool | None, dimension: int, edges: int) -> float:
    if closed is None or (dimension == 6 and not _is_robust(contacts, closed)):
        return 0.0
    if closed and edges * len(contacts) > 200:
        return FRICTION_BAND * min(float(contact.friction) for contact in contacts if contact.friction)
    clauses = exact.clauses_of(contacts, edges, "inner" if closed else "outer")
    return _closure_gap(
        [_Branch.of(rows, _scaled(rows, contacts), dimension) for rows in exact.branches(clauses)], closed
    )


def _is_robust(contacts: Sequence[exact.ExactContact], closed: bool) -> bool:
    """Whether a little less (more) friction leaves the answer: then pyramids that are turned otherwise see it too."""
    factor = 1 + Fraction(-1 if closed else 1, round(1 / FRICTION_BAND))
    changed = [replace(contact, friction=contact.friction * factor) for contact in contacts]
    return exact.force_closes(changed, dimension=6) is closed


def _scaled(rows: exact.Rows, contacts: Sequence[exact.ExactContact]) -> np.ndarray:
    """Rows about the first contact's point, as unit-normal rows about the centroid over the RMS distance."""
    points = np.array([[float(v) for v in contact.point] for contact in contacts])
    width = points.shape[1]
    centroid = points.mean(axis=0)
    length = float(np.sqrt(np.mean(np.sum((points - centroid) ** 2, axis=1)))) or 1.0
    array = np.array([[float(v) for v in row] for row in rows])
    array /= np.linalg.norm(array[:, :width], axis=1, keepdims=True)
    shift = points[0] - centroid
    if width == 2:
        array[:, 2] += shift[0] * array[:, 1] - shift[1] * array[:, 0]
    else:
        array[:, 3:] += np.cross(shift, array[:, :3])
    array[:, width:] /= length
    return array


@dataclass(frozen=True)
class _Branch:
    """One branch: closed or not, margin s (0.0 is an exact zero), gap of the answer, d-th singular value."""

    closed: bool
    margin: float
    gap: float
    smallest: float

    @classmethod
    def of(cls, rows: exact.Rows, floats: np.ndarray, dimension: int) -> _Branch:
        values = np.linalg.svd(floats, compute_uv=False)
        smallest = float(values[dimension - 1]) if len(values) >= dimension else 0.0
        if exact.closes(rows, dimension):
            margin = depth_of_origin(floats)
            return cls(True, margin, margin, smallest)
        if exact.separable(rows):
            margin = -distance_to_hull(floats)
            return cls(False, margin, -margin, smallest)
        return cls(False, 0.0, _gap_of_a_tie(rows, floats), smallest)


def _gap_of_a_tie(rows: exact.Rows, floats: np.ndarray) -> float:
    """With s = 0: how clearly the rows that do not balance are left, across the span of those that do."""
    if len(rows) > 30:
        return np.inf
    balanced = np.array(exact.balanced(rows))
    if balanced.all():
        return np.inf  # the rank alone decides, exactly
    spanned = exact.rank([row for row, both_ways in zip(rows, balanced, strict=True) if both_ways])
    across = floats[~balanced] @ np.linalg.svd(floats[balanced])[2][spanned:].T
    return distance_to_hull(across / np.linalg.norm(across, axis=1, keepdims=True))


def distance_to_hull(rows: np.ndarray) -> float:
    """Distance of the origin from the hull of the rows, checked by the plane that it touches.

    Of two solvers the first that passes the check: scipy 1.17.1 has both stop early on some symmetric rows.
    """
    target = np.zeros(rows.shape[1] + 1)
    target[-1] = 1.0
    matrix = np.vstack([rows.T, np.ones(len(rows))])
    for solve in (_by_nnls, _by_trust_region):
        weights = solve(matrix, target)
        point = weights @ rows / weights.sum()
        distance = float(np.linalg.norm(point))
        if (rows @ point >= distance**2 - 1e-6 * distance - 1e-14).all():
            return distance
    raise AssertionError("neither solver found the nearest point of the hull")


def _by_nnls(matrix: np.ndarray, target: np.ndarray) -> np.ndarray:
    return nnls(matrix, target)[0]


def _by_trust_region(matrix: np.ndarray, target: np.ndarray) -> np.ndarray:
    return lsq_linear(matrix, target, (0, np.inf), method="trf", tol=1e-15, max_iter=500).x


def depth_of_origin(rows: np.ndarray) -> float:
    """Distance of the origin from the boundary of the hull of the rows, which holds it; good to about 1e-9.

    Rows are joggled (QJ), since merging of coplanar facets fails in R^6 for repeated and symmetric rows.
    """
    return max(0.0, float(-ConvexHull(np.unique(rows, axis=0), qhull_options="QJ Pp").equations[:, -1].max()))
