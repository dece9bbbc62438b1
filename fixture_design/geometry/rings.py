"""Closed rings of a few equal facets: hexagonal stock, or a shaft in six strips. A mesh cannot say which."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from fixture_design.tolerances import RING_ANGLE, RING_EQUAL, SMOOTH_ANGLE

#: Facets a turn, fewest and most: four are a box, eleven or more meet smoothly.
_FEWEST, _MOST = 5, 10


def ring_errors(angles: Sequence[Mapping[int, float]], areas: Sequence[float]) -> dict[int, float]:
    """The facets in such rings, and how far their normals are off if the ring is round: half the angle of a step [rad].

    Facets of a ring are equal in area and meet at equal angles, between ``SMOOTH_ANGLE`` and ``RING_ANGLE``.

    Args:
        angles: for each facet the dihedral angle to each neighbour [rad], positive on convex edges.
        areas: of each facet, in any unit.
    """
    found: dict[int, float] = {}
    for facet in range(len(angles)):
        for neighbour, angle in angles[facet].items():
            steep = SMOOTH_ANGLE <= abs(angle) <= RING_ANGLE
            alike = steep and _equal(areas[neighbour], areas[facet])
            if alike and (ring := next(_rings([facet, neighbour], angle, angles, areas), None)):
                found |= {member: max(found.get(member, 0.0), abs(angle) / 2) for member in ring}
    return found


def _rings(
    chain: list[int], angle: float, angles: Sequence[Mapping[int, float]], areas: Sequence[float]
) -> Iterator[list[int]]:
    """All ways to close a chain of equal facets to a ring, by following neighbours that meet at the same angle."""
    for following, turn in angles[chain[-1]].items():
        if abs(turn - angle) > RING_EQUAL * abs(angle):
            continue
        if following == chain[0] and len(chain) >= _FEWEST:
            yield chain
        elif following not in chain and len(chain) < _MOST and _equal(areas[following], areas[chain[0]]):
            yield from _rings([*chain, following], angle, angles, areas)


def _equal(one: float, other: float) -> bool:
    return abs(one - other) <= RING_EQUAL * max(one, other)
