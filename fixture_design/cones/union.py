"""Unions of polyhedral convex cones: admissible displacements are one (2-9), their polar is a cone again (2-37).

Near a tie the questions answer as those of one cone do (`membership`): a bool, by the side of ``tolerances.tie`` that
the number lies on, without a word where it lies in the undecided band. An "or" over N cones is as doubtful as any cone
that it turned on. `union_dual` alone tells: its cone is ``certain`` only if every conversion on the way was.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fixture_design.arrays import ArrayLike
from fixture_design.cones.cone import PolyhedralConvexCone, require_same_dimension
from fixture_design.cones.convert import convert_both
from fixture_design.cones.membership import element, interior, nonzero
from fixture_design.cones.polar import convex_sum, dual
from fixture_design.errors import ConeError
from fixture_design.tolerances import DEFAULT, Tolerances


@dataclass(frozen=True, eq=False)
class ConeUnion:
    """A_1 u ... u A_N, N >= 1, in one R^d. Not convex in general; nothing is computed when it is built.

    Raises:
        ConeError: no cone at all (the empty set is not a cone: every cone holds o).
        DimensionError: cones of different dimensions.
    """

    cones: tuple[PolyhedralConvexCone, ...]

    def __post_init__(self) -> None:
        if not self.cones:
            raise ConeError("a union needs at least one cone; the smallest is {o}")
        require_same_dimension(*self.cones)

    @classmethod
    def of(cls, cones: Iterable[PolyhedralConvexCone]) -> ConeUnion:
        return cls(tuple(cones))

    @property
    def dimension(self) -> int:
        return self.cones[0].dimension

    def __iter__(self) -> Iterator[PolyhedralConvexCone]:
        return iter(self.cones)

    def __len__(self) -> int:
        return len(self.cones)


def union_nonzero(union: ConeUnion, tolerances: Tolerances = DEFAULT) -> bool:
    """Whether some A_n holds more than o: the negation of form closure (2-48, Table 1). Near a tie as `nonzero`."""
    return any(nonzero(cone, tolerances) for cone in union)


def union_interior(union: ConeUnion, tolerances: Tolerances = DEFAULT) -> bool:
    """Whether the union has interior: some A_n has, since cones without interior do not fill a ball (2-51).

    Near a tie as `interior`.
    """
    return any(interior(cone, tolerances) for cone in union)


def union_element(vector: ArrayLike, union: ConeUnion, tolerances: Tolerances = DEFAULT) -> bool:
    """Whether the vector is in some A_n. Near a tie as `element`."""
    return any(element(vector, cone, tolerances) for cone in union)


def union_dual(
    union: ConeUnion, tolerances: Tolerances = DEFAULT, max_spans: int | None = None
) -> PolyhedralConvexCone:
    """F = (A_1 u ... u A_N)* = (A_1 + ... + A_N)*  (2-37, 2-58; Table 3): a single cone.

    The span vectors of all A_n together span the sum (2-34); one conversion makes both forms of it, and thus of F,
    irreducible. A single A is its own sum. ``certain`` is False if one of these conversions met a value in the
    undecided band that other tolerances did not settle, or if a cone given was not certain.

    Args:
        max_spans: span vectors of all the cones together that are still converted.

    Raises:
        ConeError: a union with more span vectors.
    """
    if len(union) == 1:
        return dual(convert_both(union.cones[0], tolerances))
    total = convex_sum(*union, tolerances=tolerances)
    if max_spans is not None and len(total.spans) > max_spans:
        raise ConeError(f"the union has {len(total.spans)} span vectors, more than {max_spans}")
    return dual(convert_both(total, tolerances))
