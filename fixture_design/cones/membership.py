"""NONZERO, ELEMENT, SUBSET, INTERIOR: the four questions of section 2.5, and equality of cones.

All but INTERIOR are asked here without CONVERT where Tucker's partition answers directly; the answers are those of
(2-42) to (2-45), with the slips corrected that the docstrings name.

Near a tie: every answer is a bool and compares numbers of unit vectors with ``tolerances.tie``, up to which they are
zero. With a value in the undecided band around it (tie / band to tie band) the answer is that of the side it lies on,
and nothing says so: cones whose vectors are off by as much may have another. Only CONVERT looks at the band; a cone
that it made has ``certain`` False then, which these functions neither use nor pass on. For an answer that may be
undecided ask `analysis` (form closure and its kin: bounds from both sides); `tucker_partition` has the largest zero
and the smallest non-zero that it met.
"""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import ArrayLike, Rows, Vector
from fixture_design.cones.cone import PolyhedralConvexCone, require_same_dimension, unit_rows, unit_vector
from fixture_design.cones.convert import convert
from fixture_design.cones.kernel import tucker_partition
from fixture_design.errors import DimensionError
from fixture_design.tolerances import DEFAULT, Tolerances


def nonzero(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> bool:
    """NONZERO(A): whether A holds more than o (2-42).

    A span form needs one non-zero vector; a face form must fail to balance with full rank (`TuckerPartition.closes`),
    which needs no conversion. Near a tie: no, if the rows' hull comes within tie of o and the rows that balance there
    have all singular values beyond tie; a cone thinner than about tie is then {o}.
    """
    if cone.span_form is not None:
        return bool(unit_rows(np.vstack([cone.spans, cone.lines]))[1].any())
    return not tucker_partition(_inequalities(cone), tolerances.tie).closes


def element(vector: ArrayLike, cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> bool:
    """ELEMENT(r, A): whether r is in A, up to a relative tolerance (2-43). The zero vector is in every cone.

    In span form r = sum c_j u_j is asked of the span vectors directly: r is in A if and only if -r balances with them.
    Near a tie: in face form yes up to a_i . r = tie, for unit a_i and r; in span form as `in_cone_of`.

    Raises:
        DimensionError: r and A do not fit.
    """
    r = np.asarray(vector, dtype=np.float64)
    if r.shape != (cone.dimension,):
        raise DimensionError(f"a vector of shape {r.shape} and a cone in R^{cone.dimension}")
    unit = unit_vector(r)
    if unit is None:
        return True
    if cone.face_form is not None:
        faces, _ = unit_rows(cone.faces)
        equalities, _ = unit_rows(cone.equalities)
        return bool(np.all(faces @ unit <= tolerances.tie) and np.all(np.abs(equalities @ unit) <= tolerances.tie))
    return in_cone_of(unit, _generators(cone), tolerances)


def in_cone_of(vector: Vector, generators: Rows, tolerances: Tolerances = DEFAULT) -> bool:
    """Whether a unit vector is a nonnegative combination of unit generators (2-103).

    Near a tie: yes if -r takes part in Tucker's balance with numbers up to tie taken as zero. So an r outside by up to
    about tie is inside, more than that where the generators themselves all but balance.
    """
    partition = tucker_partition(np.vstack([generators, -vector]), tolerances.tie)
    return bool(partition.balanced[-1])


def subset(inner: PolyhedralConvexCone, outer: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> bool:
    """SUBSET(A, B): whether every span vector of A is in B (2-44; its index runs over the span vectors, 1..k).

    Near a tie: as `element`, one span vector after another; if A is known in face form only, also as its conversion,
    whose ``certain`` is lost.
    """
    require_same_dimension(inner, outer)
    inner = convert(inner, tolerances) if inner.span_form is None else inner
    vectors = np.vstack([inner.spans, inner.lines, -inner.lines])
    return all(element(vector, outer, tolerances) for vector in vectors)


def equal(first: PolyhedralConvexCone, second: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> bool:
    """Whether two cones are one set: each a subset of the other. A cone has many forms; this compares the sets."""
    return subset(first, second, tolerances) and subset(second, first, tolerances)


def interior(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> bool:
    """INTERIOR(A): whether A has an interior (2-45).

    (2-45) speaks of non-zero face vectors: zero ones are left out, and without any A is R^d, whose interior is not
    empty. In face form: no equality and no balanced row; in span form: the span vectors have rank d. Near a tie: no, if
    the rows' hull comes within tie of o, or if the d-th singular value of the unit span vectors is at most tie.
    """
    if cone.face_form is not None:
        rows = _inequalities(cone)
        return not len(rows) or not tucker_partition(rows, tolerances.tie).balanced.any()
    vectors = _generators(cone)
    if len(vectors) < cone.dimension:
        return False
    return bool(np.linalg.svd(vectors, compute_uv=False)[cone.dimension - 1] > tolerances.tie)


def _inequalities(cone: PolyhedralConvexCone) -> Rows:
    """Unit face vectors, each equality as two of them."""
    faces, _ = unit_rows(cone.faces)
    equalities, _ = unit_rows(cone.equalities)
    return np.vstack([faces, equalities, -equalities])


def _generators(cone: PolyhedralConvexCone) -> Rows:
    """Unit span vectors, each line as two of them."""
    spans, _ = unit_rows(cone.spans)
    lines, _ = unit_rows(cone.lines)
    return np.vstack([spans, lines, -lines])
