"""Rows of a few equal facets: hexagonal stock, or a shaft in six strips. A mesh cannot say which."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from fixture_design.tolerances import RING_ANGLE, RING_EQUAL, SMOOTH_ANGLE

#: Facets in a row that may be a round surface: three are a bevel on either side of a flat.
_FEWEST = 4


def ring_errors(angles: Sequence[Mapping[int, float]], areas: Sequence[float]) -> dict[int, float]:
    """The facets in such rows, and how far their normals are off if the row is round: half the largest step [rad].

    Facets of a row are equal in area, up to ``RING_EQUAL``, and so are the angles at which each meets the next, between
    ``SMOOTH_ANGLE`` and ``RING_ANGLE``. Four facets in a ring are a pyramid.

    Args:
        angles: for each facet the dihedral angle to each neighbour [rad], positive on convex edges.
        areas: of each facet, in any unit.
    """
    found: dict[int, float] = {}
    for facet in range(len(angles)):
        for neighbour, angle in angles[facet].items():
            steep = SMOOTH_ANGLE <= abs(angle) <= RING_ANGLE
            alike = steep and _equal(areas[neighbour], areas[facet])
            if alike and (row := next(_rows([facet, neighbour], angle, angles, areas), None)):
                widest = max(abs(angles[one][other]) for one, other in pairwise(row))
                uneven = max(areas[member] for member in row) / min(areas[member] for member in row)
                error = min(uneven * widest, RING_ANGLE) / 2
                found |= {member: max(found.get(member, 0.0), error) for member in row}
    return found


def _rows(
    row: list[int], angle: float, angles: Sequence[Mapping[int, float]], areas: Sequence[float]
) -> Iterator[list[int]]:
    """All ways to go on to a row of ``_FEWEST`` equal facets, by neighbours that meet at the same angle."""
    if len(row) == _FEWEST:
        if row[0] not in angles[row[-1]]:
            yield row
        return
    for following, turn in angles[row[-1]].items():
        same_way = turn * angle > 0 and _equal(abs(turn), abs(angle))
        if following not in row and same_way and _equal(areas[following], areas[row[0]]):
            yield from _rows([*row, following], angle, angles, areas)


def _equal(one: float, other: float) -> bool:
    return abs(one - other) <= RING_EQUAL * max(one, other)
