"""CONVERT: from face form to span form and back (sections 2.5 and 2.8), by double description.

`thesis.py` has the thesis's own algorithm; this one gives the same cones, faster and for more vectors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Incidence, Rows, Vector, read_only
from fixture_design.cones.cone import FaceForm, PolyhedralConvexCone, SpanForm, unit_rows
from fixture_design.cones.kernel import MAX_RAYS, DoubleDescription, double_description, singular_directions
from fixture_design.errors import ConeError
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
    """The same cone with both forms irreducible, lines and equalities complete and apart, all vectors of length one.

    The new form is irreducible already; of the old one the incidence tells which vectors are facets (extreme rays) and
    which are zero on the whole cone, so that no way back has to be computed.
    """
    by_faces = cone.face_form is not None
    rows, both_ways = (cone.faces, cone.equalities) if by_faces else (cone.spans, cone.lines)
    found = convert_rows(rows, both_ways, tolerances)
    kept_rows, kept_both_ways = facets_of(rows, found, tolerances)
    face_form, span_form = FaceForm(kept_rows, kept_both_ways), SpanForm(found.vectors, found.lines)
    if not by_faces:
        face_form, span_form = FaceForm(found.vectors, found.lines), SpanForm(kept_rows, kept_both_ways)
    return PolyhedralConvexCone(cone.dimension, face_form, span_form, cone.certain and found.certain)


def facets_of(rows: Rows, found: Conversion, tolerances: Tolerances = DEFAULT) -> tuple[Rows, Rows]:
    """The rows that are facets of {x : rows . x <= 0}, by its conversion, and the equalities that the cone lies in.

    A row is a facet if the rays on it span one dimension less than the cone; of rows on the same rays the first stays.

    Returns:
        facets, unit and orthogonal to the equalities, shape (f, d), and orthonormal equalities, shape (e, d).
    """
    generators = np.vstack([found.vectors, found.lines])
    inside, outside = _span_and_complement(generators, tolerances)
    facets: dict[bytes, Vector] = {}
    for row, on in zip(rows, found.incidence.T, strict=True):
        if on.all() or on.tobytes() in facets:
            continue
        around, _ = _span_and_complement(np.vstack([found.vectors[on], found.lines]), tolerances)
        if len(around) == len(inside) - 1:
            facets[on.tobytes()] = unit_rows(((row @ inside.T) @ inside)[None, :])[0][0]
    return read_only(np.array(list(facets.values())).reshape(-1, rows.shape[1])), read_only(outside)


def _span_and_complement(rows: Rows, tolerances: Tolerances) -> tuple[Rows, Rows]:
    """Orthonormal bases of the span of unit rows and of its orthogonal complement."""
    sizes, right = singular_directions(rows)
    rank = int(np.sum(sizes > tolerances.tie))
    return right[:rank], right[rank:]


def convert_rows(
    rows: Rows, equalities: Rows, tolerances: Tolerances = DEFAULT, max_rays: int = MAX_RAYS
) -> Conversion:
    """Extreme rays and lines of {x : rows . x <= 0, equalities . x = 0}.

    By Theorem 1 this serves both ways: face vectors give span vectors, span vectors (lines as equalities) give face
    vectors (equalities as lines). Where a value falls into the undecided band, the zero is moved down and up by a
    factor of 100; what is certain then is taken, unless both are and differ.

    Args:
        rows: shape (m, d).  equalities: shape (e, d).  tolerances: relative size of a zero.
        max_rays: a cone that has more on the way is given up.

    Raises:
        ConeError: more than ``max_rays`` extreme rays.
    """
    unit, kept = unit_rows(rows)
    unit_equalities, _ = unit_rows(equalities)
    found = double_description(unit, unit_equalities, tolerances.tie, max_rays)
    if found.is_certain(tolerances.band):
        return _conversion(found, kept, True)
    others = [_retried(unit, unit_equalities, tolerances.tie * factor, max_rays) for factor in (0.01, 100.0)]
    certain = [other for other in others if other is not None and other.is_certain(tolerances.band)]
    if not certain or any(not _same_structure(certain[0], other) for other in certain[1:]):
        return _conversion(found, kept, False)
    return _conversion(certain[0], kept, True)


def _retried(rows: Rows, equalities: Rows, zero: float, max_rays: int) -> DoubleDescription | None:
    """At another zero, which may be a wrong one: rays then multiply without being any, and it says nothing."""
    try:
        return double_description(rows, equalities, zero, max_rays)
    except ConeError:
        return None


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
