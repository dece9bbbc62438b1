"""REDUCTION: fewest vectors by dropping one after another (section 2.8.2, Theorem 4).

Near a tie a vector is left out if the others make it up with numbers up to ``tolerances.tie`` taken as zero, and kept
beyond; a value in the undecided band is not flagged, unlike CONVERT's.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Rows
from fixture_design.cones.bidirection import balanced_rows
from fixture_design.cones.cone import PolyhedralConvexCone, unit_rows
from fixture_design.cones.membership import in_cone_of
from fixture_design.tolerances import DEFAULT, Tolerances


def reduce(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """REDUCTION(A): the same cone, in each form that it is known in, with no vector that can be left out.

    Vectors that balance become equalities (lines), as many as are independent; of the others one goes if it is a
    nonnegative combination of those still kept (2-103, 2-106). They are tried one after another, the last first, so
    that of two that make each other redundant the earlier one stays: testing each against all others at once, as
    (4-16) does, would lose both. What stays is some of the vectors given, unchanged.

    Near a tie: a vector outside the cone of the others by up to about tie goes, so that the cone may shrink (its face
    form: grow) by as much at each step; vectors that all but balance are equalities up to tie. ``certain`` is that of
    the cone given, for REDUCTION itself sees no band: `convert_both` reduces too, and tells.
    """
    face = span = None
    if cone.face_form is not None:
        faces, equalities = _irreducible(cone.faces, cone.equalities, tolerances)
        face = PolyhedralConvexCone.from_faces(faces, equalities, dimension=cone.dimension).face_form
    if cone.span_form is not None:
        spans, lines = _irreducible(cone.spans, cone.lines, tolerances)
        span = PolyhedralConvexCone.from_span(spans, lines, dimension=cone.dimension).span_form
    return PolyhedralConvexCone(cone.dimension, face, span, cone.certain)


def irreducible_rows(rows: Rows, both_ways: Rows, tolerances: Tolerances = DEFAULT) -> Indices:
    """Indices of the rows that stay when those in the cone of the others (and +-both_ways) are dropped one by one.

    Near a tie as `in_cone_of`.
    """
    unit, kept = unit_rows(rows)
    original = np.flatnonzero(kept)
    lines, _ = unit_rows(both_ways)
    stay = list(range(len(unit)))
    for index in reversed(range(len(unit))):
        others = [other for other in stay if other != index]
        if in_cone_of(unit[index], np.vstack([unit[others], lines, -lines]), tolerances):
            stay = others
    return original[stay]


def _irreducible(rows: Rows, both_ways: Rows, tolerances: Tolerances) -> tuple[Rows, Rows]:
    balanced = balanced_rows(rows, both_ways, tolerances)
    lines = _independent(np.vstack([both_ways, rows[balanced]]), tolerances)
    rest = rows[~balanced]
    return rest[irreducible_rows(rest, lines, tolerances)], lines


def _independent(rows: Rows, tolerances: Tolerances) -> Rows:
    """The first rows that are linearly independent, as given."""
    unit, kept = unit_rows(rows)
    chosen, basis = [], np.zeros((0, rows.shape[1]))
    for index, row in zip(np.flatnonzero(kept), unit, strict=True):
        rest = row - (row @ basis.T) @ basis
        rest = rest - (rest @ basis.T) @ basis  # twice is enough for orthogonality to rounding
        length = np.linalg.norm(rest)
        if length > tolerances.tie:
            chosen.append(index)
            basis = np.vstack([basis, rest / length])
    return rows[chosen]
