"""CONVERT exactly as section 2.8 has it: readable, slow, the reference that the tests compare the fast one with.

The cone face{a_1..a_m} falls into 2^m pieces A[I], one for each set I of face vectors that are strictly negative
(2-85). Its span vectors are one vector out of every non-empty piece whose linear hull L[I] has one dimension more than
the lineality space L[0] (2-92, 2-93). Theorems 2 to 5 spare most of the 2^m:

* Theorem 4 (REDUCTION) leaves out redundant face vectors before anything is enumerated,
* Theorem 5 (BIDIRECTION) leaves out those that are zero on the whole cone (2-112),
* Theorem 3 skips every superset of an I with d[I] = d + 1 (2-100),
* Theorem 2 finds the vector of A[I] among the base vectors of L[I], without a linear program (2-98).

Theorem 2 holds for a base of L[I]; its vectors that lie in A[0] have zero products, so they are passed over. The linear
programs that Theorems 4 and 5 leave are answered by Tucker's partition.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from fixture_design.arrays import Rows, Vector, read_only
from fixture_design.cones.bidirection import balanced_rows
from fixture_design.cones.cone import FaceForm, PolyhedralConvexCone, SpanForm, unit_rows
from fixture_design.cones.kernel import singular_directions
from fixture_design.cones.polar import dual
from fixture_design.cones.reduction import irreducible_rows
from fixture_design.tolerances import DEFAULT, Tolerances


def convert(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> PolyhedralConvexCone:
    """CONVERT(A) of section 2.8: the cone with both forms; span to face through the polar, as in Figure 7.

    Exponential in the number of face vectors that are neither redundant nor bidirectional: fine up to about 14.
    """
    if cone.span_form is None:
        spans, lines = span_form(cone.faces, cone.equalities, tolerances)
        return PolyhedralConvexCone(cone.dimension, cone.face_form, SpanForm(read_only(spans), read_only(lines)))
    if cone.face_form is None:
        polar = convert(dual(cone), tolerances)
        return PolyhedralConvexCone(cone.dimension, FaceForm(polar.spans, polar.lines), cone.span_form)
    return cone


def span_form(faces: Rows, equalities: Rows, tolerances: Tolerances = DEFAULT) -> tuple[Rows, Rows]:
    """f_1..f_k and e_1..e_d of (2-93): span vectors, shape (k, d), and base vectors of A[0], shape (l, d).

    An equality is a pair of opposite face vectors, and bidirectional by Theorem 5.
    """
    always_zero, _ = unit_rows(equalities)
    a, _ = unit_rows(faces)
    a = a[irreducible_rows(a, always_zero, tolerances)]  # Theorem 4
    in_b = balanced_rows(a, always_zero, tolerances)  # Theorem 5
    always_zero = np.vstack([always_zero, a[in_b]])
    a = a[~in_b]
    lineality = _null_space(np.vstack([always_zero, a]), tolerances)  # e_1..e_d, from (2-94)
    found: list[tuple[frozenset[int], Vector]] = []
    for size in range(1, len(a) + 1):
        for chosen in map(frozenset, combinations(range(len(a)), size)):
            if any(smaller <= chosen for smaller, _ in found):  # Theorem 3
                continue
            zero = [index for index in range(len(a)) if index not in chosen]
            base = _null_space(np.vstack([always_zero, a[zero]]), tolerances)  # L[I], from (2-97)
            if len(base) == len(lineality) + 1:
                found.append((chosen, _vector_of_piece(a[sorted(chosen)], base, tolerances)))
    spans = [vector for _, vector in found if vector.any()]
    return np.array(spans).reshape(-1, faces.shape[1]), lineality


def _vector_of_piece(negative: Rows, base: Rows, tolerances: Tolerances) -> Vector:
    """A vector of A[I] out of the base of L[I] (Theorem 2), or the zero vector if A[I] is empty."""
    for b in base:
        products = negative @ b
        if np.all(products < -tolerances.tie):
            return b
        if np.all(products > tolerances.tie):
            return -b
    return np.zeros(negative.shape[1])


def _null_space(rows: Rows, tolerances: Tolerances) -> Rows:
    """Orthonormal base vectors of {x : rows . x = 0}."""
    values, right = singular_directions(rows)
    return right[int(np.sum(values > tolerances.tie)) :]
