"""Fewer cones for one set: Theorem 10 and its check, applied two by two (4.6.2)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fixture_design.arrays import Mask, Rows
from fixture_design.cones import PolyhedralConvexCone, convert_both, convex_sum
from fixture_design.tolerances import DEFAULT, Tolerances


def merged(cones: Sequence[PolyhedralConvexCone], tolerances: Tolerances = DEFAULT) -> tuple[PolyhedralConvexCone, ...]:
    """The same union with fewer cones: contained ones go, and two whose union is their convex sum become that sum.

    The union A u B is A + B if and only if every u_i + v_j of their span vectors is in A or in B (Theorem 10; lines
    count as two span vectors). Merging two by two need not reach the fewest: of three sectors of 120 degrees no two
    unite.

    Args:
        cones: in both forms, irreducible (`convert_both`).
        tolerances: a sum within ``tie`` of a cone is in it.
    """
    kept: list[PolyhedralConvexCone] = []
    for cone in sorted(cones, key=_size, reverse=True):
        _take(cone, kept, tolerances)
    return tuple(kept)


def _take(cone: PolyhedralConvexCone, kept: list[PolyhedralConvexCone], tolerances: Tolerances) -> None:
    """Adds a cone; one that it unites with is taken out, and their sum is added instead."""
    for index, other in enumerate(kept):
        if _inside(_generators(cone), other, tolerances).all():
            return
        if unites(cone, other, tolerances):
            total = convert_both(convex_sum(cone, other), tolerances)
            if _whole(total, (cone, other), tolerances):
                del kept[index]
                _take(total, kept, tolerances)
                return
    kept[:] = [other for other in kept if not _inside(_generators(other), cone, tolerances).all()]
    kept.append(cone)


def unites(first: PolyhedralConvexCone, second: PolyhedralConvexCone, tolerances: Tolerances = DEFAULT) -> bool:
    """(4-41): whether the union of two cones, in both forms, is their convex sum."""
    u, v = _generators(first), _generators(second)
    if not len(u) or not len(v):
        return True
    sums = (u[:, None] + v[None]).reshape(-1, first.dimension)
    return bool((_inside(sums, first, tolerances) | _inside(sums, second, tolerances)).all())


def _generators(cone: PolyhedralConvexCone) -> Rows:
    return np.vstack([cone.spans, cone.lines, -cone.lines])


def _inside(vectors: Rows, cone: PolyhedralConvexCone, tolerances: Tolerances) -> Mask:
    """Which vectors, of length 2 at most, are in a cone with unit faces."""
    within = (vectors @ cone.faces.T <= tolerances.tie).all(axis=1)
    flat = (np.abs(vectors @ cone.equalities.T) <= tolerances.tie).all(axis=1)
    return np.logical_and(within, flat)


def _whole(total: PolyhedralConvexCone, parts: tuple[PolyhedralConvexCone, ...], tolerances: Tolerances) -> bool:
    """Whether a conversion lost nothing."""
    return all(_inside(_generators(part), total, tolerances).all() for part in parts)


def _size(cone: PolyhedralConvexCone) -> int:
    return len(cone.lines) * cone.dimension - len(cone.equalities)
