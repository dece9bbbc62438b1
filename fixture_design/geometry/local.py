"""What the part's surface is like at one of its points: a facet, an edge, an apex, or a place on a curved surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices, Point
from fixture_design.contacts import Provenance
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry.nearest import clearance, touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.sets import place_text, sets_by_edges, sets_by_looking, units_of
from fixture_design.tolerances import SLIVER_NOISE, SMOOTH_ANGLE

#: Facets must be this many times larger than the blur around a corner, so that looking into it sees the corner [-].
_ROOM_TO_LOOK = 20.0


@dataclass(frozen=True, eq=False)
class LocalSurface:
    """The surface around a point, to first order, in P.

    Attributes:
        clauses: AND over the outer tuple, OR over each inner one; outward normals as the facets have them.
        feature: "facet 3", "edge facet 3 | facet 5" or "apex facet 1 | facet 2 | facet 7".
        provenance: of the normals, the worst of them.
        facets: indices of the facets that meet there; of a polygon, none.
    """

    clauses: tuple[tuple[Point, ...], ...]
    feature: str
    provenance: Provenance
    facets: tuple[int, ...] = ()

    @property
    def shape(self) -> Literal["flat", "convex", "concave", "mixed"]:
        if len(self.clauses) == 1:
            return "flat" if len(self.clauses[0]) == 1 else "convex"
        return "concave" if all(len(clause) == 1 for clause in self.clauses) else "mixed"


def feature_name(geometry: PartGeometry, facets: Indices) -> str:
    """The name of the place where these facets meet."""
    kind = {1: "", 2: "edge "}.get(len(facets), "apex ")
    return kind + " | ".join(geometry.facets[facet].name for facet in facets)


def local_surface(geometry: PartGeometry, p_PC: Point, within: float | None = None) -> LocalSurface:
    """The logic of the surface at one of its points.

    Strips of one curved surface count as one facet, with the mean of their normals and the error that this may have.

    Args:
        p_PC: the point, shape (3,) [m].
        within: triangles this near count as touched [m], by default ``geometry.on_edge``. Corners that are finer than
            can be looked into are looked at again with ten times as much, twice.

    Raises:
        GeometryError: the point is inside the material, where solids that the part is made of overlap.
        UnsupportedError: the apex of a cone; corners with too many facets, or too fine to be looked at.
    """
    within = within or geometry.on_edge
    touched = touched_triangles(geometry, p_PC, within)
    facets = facets_at(geometry, touched)
    if not len(facets):
        raise GeometryError(
            f"no triangle of {geometry.name!r} is at {place_text(p_PC)}", expected="a point on its surface"
        )
    name = feature_name(geometry, facets)
    patches = _patches(geometry, facets)
    normals = [_patch_normal(geometry, patch, name) for patch in patches]
    error = max(geometry.facets[facet].normal_error for facet in facets)
    spread = max(_largest_angle(normal, geometry, patch) for normal, patch in zip(normals, patches, strict=True))
    kinds = {geometry.facets[facet].provenance.kind for facet in facets}
    provenance = Provenance("approximate" if "approximate" in kinds else "exact", max(error, spread))
    sets = sets_by_edges(geometry, touched, patches)
    if sets is None:
        if clearance(geometry, p_PC, touched) < _ROOM_TO_LOOK * within:
            if within >= 100 * geometry.on_edge:
                problem = (
                    f"{geometry.name!r}: {name} at {place_text(p_PC)}: facets are too small to see what meets there"
                )
                raise UnsupportedError(problem, expected="a place away from small facets")
            return local_surface(geometry, p_PC, 10 * within)
        if len(patches) > 1:
            # neither convex nor concave throughout, or of several solids: every facet speaks for itself
            normals = [geometry.facets[facet].normal for facet in facets]
        sets = sets_by_looking(geometry, p_PC, touched, units_of(np.array(normals)), name)
    clauses = tuple(tuple(normals[index] for index in chosen) for chosen in sets)
    return LocalSurface(clauses, name, provenance, tuple(facets.tolist()))


def facets_at(geometry: PartGeometry, touched: Indices) -> Indices:
    """The facets of some triangles; slivers, whose normals are noise, only if there is nothing else."""
    facets = np.unique(geometry.facet_of_triangle[touched])
    known = np.array([geometry.facets[facet].noise <= SLIVER_NOISE for facet in facets], dtype=bool)
    return facets[known] if known.any() else facets


def _patches(geometry: PartGeometry, facets: Indices) -> list[list[int]]:
    """Facets grouped to smooth patches: linked where at least one of two smooth neighbours is a strip."""
    patches = [[int(facet)] for facet in facets]
    for first in facets.tolist():
        for second, angle in geometry.facets[first].angles.items():
            kinds = {geometry.facets[first].provenance.kind, geometry.facets[second].provenance.kind}
            if second in facets and abs(angle) < SMOOTH_ANGLE and "approximate" in kinds:
                one, other = (next(p for p in patches if f in p) for f in (first, second))
                if one is not other:
                    one += other
                    patches.remove(other)
    return [sorted(patch) for patch in patches]


def _patch_normal(geometry: PartGeometry, patch: list[int], name: str) -> Point:
    """The facet's own normal, or the normalised mean of unit normals."""
    if len(patch) == 1:
        return geometry.facets[patch[0]].normal
    mean = units_of(np.array([geometry.facets[facet].normal for facet in patch])).sum(axis=0)
    length = float(np.linalg.norm(mean))
    if length < len(patch) * np.cos(SMOOTH_ANGLE):
        raise UnsupportedError(f"{geometry.name!r}: {name} is the tip of a curved surface, which has no normal there")
    return mean / length


def _largest_angle(normal: Point, geometry: PartGeometry, patch: list[int]) -> float:
    """Between the normal of a patch and those of its facets [rad]."""
    if len(patch) == 1:
        return 0.0
    units = units_of(np.array([geometry.facets[facet].normal for facet in patch]))
    return float(np.arctan2(np.linalg.norm(np.cross(units, normal), axis=1), units @ normal).max())
