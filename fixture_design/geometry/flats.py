"""Flats beside round surfaces: facets that met strips smoothly and turn out to be no strips themselves.

Before round surfaces are known, a flat between two fillets looks like one strip of many. A flat is tangent to a fillet
where they meet; a strip is a chord there, turned by half its own angle.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fixture_design.contacts import Provenance
from fixture_design.geometry.facets import Facet
from fixture_design.geometry.shapes import Triangles, Vertices
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.geometry.smoothness import FacetMeasures, provenances
from fixture_design.tolerances import SMOOTH_ANGLE

#: A flat's normal is off the round surface's, where they meet, by at most this part of the dihedral angle [-].
_TANGENT = 0.2


def judged_again(
    facets: Sequence[Facet],
    surface_of: Mapping[int, SmoothSurface],
    doubts: Mapping[int, float],
    vertices: Vertices,
    triangles: Triangles,
) -> dict[int, Provenance]:
    """The provenance of all facets that are not exact: fitted, exact after all, or still approximate.

    Args:
        surface_of: the round surface of each facet that is on one.
        doubts: how far off facets are if they stand for a round surface that they are too coarse to tell [rad].
    """
    rest = {i for i, facet in enumerate(facets) if facet.provenance.kind == "approximate" and i not in surface_of}
    corners = {i: np.unique(triangles[facets[i].triangles]) for i in rest | set(surface_of)}

    def strip_angles(index: int) -> dict[int, float]:
        facet = facets[index]
        unit = facet.normal / np.linalg.norm(facet.normal)
        found = {}
        for other, angle in facet.angles.items():
            surface = surface_of.get(other)
            if surface is not None and abs(angle) < SMOOTH_ANGLE:
                shared = np.intersect1d(corners[index], corners[other], assume_unique=True)
                turned = np.linalg.norm(np.cross(surface.shape.directions(vertices[shared]), unit), axis=1)
                if turned.max(initial=0.0) <= _TANGENT * abs(angle):
                    continue
            found[other] = angle
        return found

    measures = [
        FacetMeasures(
            facet.width,
            facet.noise,
            strip_angles(index) if index in rest else facet.angles,
            float(np.linalg.norm(facet.normal)),
        )
        for index, facet in enumerate(facets)
    ]
    again = provenances(measures)
    found = {index: again[index] for index in rest}
    for index, error in doubts.items():
        found[index] = Provenance("approximate", max(error, again[index].normal_error) + facets[index].noise)
    return found | {index: _of_surface(surface) for index, surface in surface_of.items()}


def _of_surface(surface: SmoothSurface) -> Provenance:
    if surface.is_band:
        return Provenance("approximate", surface.normal_error, surface.axis_error)
    return Provenance("fitted" if surface.normal_error else "exact", surface.normal_error)
