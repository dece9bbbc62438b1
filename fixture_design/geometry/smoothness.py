"""How far a facet's normal may be off: by the rounding of its vertices, or because it stands for a curved surface.

A tessellated shaft is no set of facets: taken literally, a handful of point contacts on it would look form closed. A
facet counts as a strip of a curved surface if it meets two or more neighbours smoothly (below ``SMOOTH_ANGLE``) and is
not much wider than one of them. A flat between fillets meets them smoothly too, but is wider; chamfers meet their
flats at 45 degrees. The last strip of a surface has one smooth neighbour only: it is judged with that neighbour.

A coarse mesh may have a shaft in six strips, and so does hexagonal stock: nobody can tell. A facet in a row of four or
more equal ones counts as a strip too (`rings`), until the designer says that the part is faceted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fixture_design.contacts import Provenance
from fixture_design.geometry.rings import ring_errors
from fixture_design.tolerances import SLIVER_NOISE, SMOOTH_ANGLE, STRIP_WIDTH_RATIO


@dataclass(frozen=True, eq=False)
class FacetMeasures:
    """What is needed of one facet to judge its normal.

    Attributes:
        width: smallest width [m].  noise: angle by which the rounding of its vertices may turn it [rad].
        angles: dihedral angle to each neighbouring facet [rad], positive on convex edges.
        area: or twice that, or the length of a polygon's edge: to compare facets with each other.
    """

    width: float
    noise: float
    angles: Mapping[int, float]
    area: float


def provenances(measures: Sequence[FacetMeasures], faceted: bool = False) -> tuple[Provenance, ...]:
    """The provenance of each facet's normal; ``faceted``: none stands for a curved surface."""
    if faceted:
        return tuple(Provenance("exact", facet.noise) for facet in measures)
    smooth = [_smooth_neighbours(measures, facet) for facet in range(len(measures))]
    strips = {facet for facet in range(len(measures)) if len(smooth[facet]) >= 2 and _narrow(measures, facet, smooth)}
    ends = {
        facet
        for facet in range(len(measures))
        if len(smooth[facet]) == 1 and strips.intersection(smooth[facet]) and _narrow(measures, facet, smooth)
    }
    curved = strips | ends
    in_ring = ring_errors([facet.angles for facet in measures], [facet.area for facet in measures])
    return tuple(
        _provenance(facet, index in curved)
        if index not in in_ring
        else Provenance("approximate", in_ring[index] + facet.noise)
        for index, facet in enumerate(measures)
    )


def _provenance(facet: FacetMeasures, strip: bool) -> Provenance:
    """Exact up to rounding; of a strip or a sliver (which may be one), off by up to its largest smooth angle."""
    if not strip and facet.noise <= SLIVER_NOISE:
        return Provenance("exact", facet.noise)
    smooth = [abs(angle) for angle in facet.angles.values() if abs(angle) < SMOOTH_ANGLE]
    return Provenance("approximate", max([facet.noise, *smooth]))


def _smooth_neighbours(measures: Sequence[FacetMeasures], facet: int) -> list[int]:
    if measures[facet].noise > SLIVER_NOISE:
        return []
    angles = measures[facet].angles
    return [o for o, angle in angles.items() if abs(angle) < SMOOTH_ANGLE and measures[o].noise <= SLIVER_NOISE]


def _narrow(measures: Sequence[FacetMeasures], facet: int, smooth: Sequence[Sequence[int]]) -> bool:
    """Whether it is not much wider than the widest of its smooth neighbours."""
    return measures[facet].width <= STRIP_WIDTH_RATIO * max(measures[other].width for other in smooth[facet])
