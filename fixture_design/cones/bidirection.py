"""BIDIRECTION: the face vectors that constrain both ways (section 2.8.3, Theorem 5)."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Mask, Rows
from fixture_design.cones.cone import PolyhedralConvexCone, unit_rows
from fixture_design.cones.convert import convert
from fixture_design.cones.kernel import tucker_partition
from fixture_design.tolerances import DEFAULT, Tolerances


def bidirectional(cone: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> Mask:
    """BIDIRECTION(A): for each face vector a_j, whether a_j . r = 0 for every r in A.

    That is so exactly if a_j takes part in a positive balance, sum alpha_i a_i = o with alpha_j > 0 (2-109, 2-111),
    equalities counting in both directions. A zero face vector is bidirectional: its product is always zero.

    Near a tie: balance and span are taken from Tucker's partition, for unit vectors and with numbers up to
    ``tolerances.tie`` as zero. A pair out of line by less than about tie constrains both ways; a value in the undecided
    band is not flagged, unlike CONVERT's, which is only asked here of a cone without a face form (and whose ``certain``
    is lost).

    Returns:
        shape (m,), in the order of ``cone.faces``; all False for faces that leave an interior, empty without faces.
    """
    cone = convert(cone, tolerances) if cone.face_form is None else cone
    return balanced_rows(cone.faces, cone.equalities, tolerances)


def balanced_rows(rows: Rows, equalities: Rows, tolerances: Tolerances = DEFAULT) -> Mask:
    """`bidirectional` on plain arrays: which rows vanish on all of {x : rows . x <= 0, equalities . x = 0}."""
    unit, kept = unit_rows(rows)
    both_ways, _ = unit_rows(equalities)
    partition = tucker_partition(np.vstack([unit, both_ways, -both_ways]), tolerances.tie)
    balanced = np.ones(len(rows), dtype=bool)
    balanced[kept] = partition.balanced[: len(unit)]
    return balanced
