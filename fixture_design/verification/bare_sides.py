"""Sides of a part that a margin from edges leaves without candidates: those of a thin plate are narrower than it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry, SurfacePoints

#: Fewer candidates than this that face like a facet leave its side bare [-].
_FEW = 4
#: Facets face alike up to this angle [rad].
_ALIKE = 0.35
#: Smaller facets, relative to the share of the surface that a candidate has, are no sides: chamfers, ribs' ends [-].
_SMALL = 0.5


def bare_facets(geometry: PartGeometry, spots: SurfacePoints, spacing: float) -> tuple[int, ...]:
    """The numbers of facets ("facet 3" is 3) of sides with few candidates, and of round surfaces with none; in order.

    Args:
        spots: candidates.  spacing: of them [m].
    """
    vectors = np.array([facet.normal for facet in geometry.facets])
    lengths = np.linalg.norm(vectors, axis=1)
    units, least = vectors / lengths[:, None], _SMALL * spacing**2
    facing = units[spots.facets]
    found = set()
    for surface in geometry.smooth_surfaces:
        large = lengths[surface.facets].sum() / 2 >= least
        if large and not np.isin(spots.facets, surface.facets).any():
            found.update(surface.facets.tolist())
    for facet in np.flatnonzero(lengths / 2 >= least).tolist():
        flat = geometry.surface_of_facet(facet) is None
        if flat and (facing @ units[facet] >= np.cos(_ALIKE)).sum() < _FEW:
            found.add(facet)
    return tuple(facet + 1 for facet in sorted(found))
