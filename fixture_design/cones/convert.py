"""CONVERT: from face form to span form and back (sections 2.5 and 2.8), by double description.

`thesis.py` has the thesis's own algorithm; this one gives the same cones, faster and for more vectors.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Incidence, Rows, read_only
from fixture_design.cones.cone import FaceForm, PolyhedralConvexCone, SpanForm, unit_rows
from fixture_design.cones.kernel import DoubleDescription, double_description
from fixture_design.tolerances import DEFAULT, Tolerances


@dataclass(frozen=True, eq=False)
class Conversion:
    """What CONVERT found.

    Attributes:
        vectors: shape (k, d), unit: the extreme rays of the converted cone, lines taken out.
        lines: shape (l, d), orthonormal.
        incidence: shape (k, m): whether ray k lies on face m of the input (a zero face vector is on every ray).
        certain: False if a value fell into the undecided band, and other tolerances did not settle it.
    """

    vectors: Rows
    lines: Rows
    incidence: Incidence
    certain: bool


def convert(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """CONVERT(A): the same cone with both forms.

    The new form is irreducible: extreme rays (facets), orthogonal to the lines (equalities), unit length. A form that
    was given stays as it was given. {o} has equalities of full rank and no span vector; R^d has d lines and no face.

    Args:
        cone: in either form, or both (then it is returned as it is).
        tolerances: relative size of a zero.

    Raises:
        ConeError: too many extreme rays.

    Source: thesis sections 2.5, 2.8; Figure 7 for the way back through the polar.

    Example:
        >>> convert(PolyhedralConvexCone.from_faces([[-1, 0], [0, -1]])).spans.round(6) + 0.0
        array([[0., 1.],
               [1., 0.]])
    """
    if cone.span_form is None:
        found = convert_rows(cone.faces, cone.equalities, tolerances)
        span_form = SpanForm(found.vectors, found.lines)
        return PolyhedralConvexCone(cone.dimension, cone.face_form, span_form, cone.certain and found.certain)
    if cone.face_form is None:
        found = convert_rows(cone.spans, cone.lines, tolerances)
        face_form = FaceForm(found.vectors, found.lines)
        return PolyhedralConvexCone(cone.dimension, face_form, cone.span_form, cone.certain and found.certain)
    return cone


def convert_both(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """The same cone with both forms as CONVERT makes them: irreducible, lines and equalities complete and apart."""
    known = convert(cone, tolerances)
    faces = convert(replace(known, face_form=None), tolerances)
    return convert(replace(faces, span_form=None), tolerances)


def convert_rows(rows: Rows, equalities: Rows, tolerances: Tolerances = DEFAULT) -> Conversion:
    """Extreme rays and lines of {x : rows . x <= 0, equalities . x = 0}.

    By Theorem 1 this serves both ways: face vectors give span vectors, span vectors (lines as equalities) give face
    vectors (equalities as lines). Where a value falls into the undecided band, the zero is moved down and up by a
    factor of 100; what is certain then is taken, unless both are and differ.

    Args:
        rows: shape (m, d).  equalities: shape (e, d).  tolerances: relative size of a zero.
    """
    unit, kept = unit_rows(rows)
    unit_equalities, _ = unit_rows(equalities)
    found = double_description(unit, unit_equalities, tolerances.tie)
    if found.is_certain(tolerances.band):
        return _conversion(found, kept, True)
    others = [double_description(unit, unit_equalities, tolerances.tie * factor) for factor in (0.01, 100.0)]
    certain = [other for other in others if other.is_certain(tolerances.band)]
    if not certain or any(not _same_structure(certain[0], other) for other in certain[1:]):
        return _conversion(found, kept, False)
    return _conversion(certain[0], kept, True)


def _same_structure(first: DoubleDescription, second: DoubleDescription) -> bool:
    """As many lines, and the same rays by the rows they are on."""
    if len(first.lines) != len(second.lines) or len(first.rays) != len(second.rays):
        return False
    return sorted(map(tuple, first.incidence)) == sorted(map(tuple, second.incidence))


def _conversion(state: DoubleDescription, kept: np.ndarray, certain: bool) -> Conversion:
    incidence = np.ones((len(state.rays), len(kept)), dtype=bool)
    incidence[:, kept] = state.incidence
    order = np.lexsort(np.round(state.rays, 9).T[::-1]) if len(state.rays) else np.zeros(0, dtype=int)
    return Conversion(read_only(state.rays[order]), read_only(state.lines), incidence[order], certain)
