"""What the part's surface is like at one of its points: a facet, an edge, an apex, or a place on a curved surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices, Point, Rows, cross_products, read_only
from fixture_design.contacts import Provenance, tangents
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry.nearest import clearance, touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.sets import place_text, sets_by_edges, sets_by_looking, units_of
from fixture_design.geometry.smooth_surface import SmoothSurface
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
        slips: for each normal, clause after clause, the motions about P's origin that move its surface along itself,
            shape (k, 6) or planar (k, 3); empty where they are not known.
    """

    clauses: tuple[tuple[Point, ...], ...]
    feature: str
    provenance: Provenance
    facets: tuple[int, ...] = ()
    slips: tuple[Rows, ...] = ()

    @property
    def shape(self) -> Literal["flat", "convex", "concave", "mixed"]:
        if len(self.clauses) == 1:
            return "flat" if len(self.clauses[0]) == 1 else "convex"
        return "concave" if all(len(clause) == 1 for clause in self.clauses) else "mixed"


def feature_name(geometry: PartGeometry, facets: Indices) -> str:
    """The name of the place where these facets meet; facets of one round surface go by its name."""
    names = []
    for facet in facets.tolist():
        surface = geometry.surface_of_facet(facet)
        names.append(geometry.facets[facet].name if surface is None else surface.name)
    names = list(dict.fromkeys(names))
    kind = {0: "the surface", 1: "", 2: "edge "}.get(len(names), "apex ")
    return kind + " | ".join(names)


def local_surface(
    geometry: PartGeometry, p_PC: Point, within: float | None = None, touched: Indices | None = None
) -> LocalSurface:
    """The logic of the surface at one of its points.

    Facets of one round surface count as that surface, with its normal. Strips of a curved surface that is not known
    count as one facet, with the mean of their normals and the error that this may have.

    Args:
        p_PC: the point, shape (3,) [m]; on a round surface it may be off the facets that stand for it.
        within: triangles this near count as touched [m], by default ``geometry.on_edge``. Corners that are finer than
            can be looked into are looked at again with ten times as much, twice.
        touched: these triangles, where they are known already.

    Raises:
        GeometryError: the point is inside the material, where solids that the part is made of overlap.
        UnsupportedError: the apex of a cone; corners with too many facets, or too fine to be looked at.
    """
    within = within or geometry.on_edge
    p_PF = p_PC
    touched = touched_triangles(geometry, p_PF, within) if touched is None else touched
    if not len(touched):
        p_PF = geometry.surface.at(p_PC)[1]
        touched = touched_triangles(geometry, p_PF, within)
    facets = facets_at(geometry, touched)
    if not len(facets):
        raise GeometryError(
            f"no triangle of {geometry.name!r} is at {place_text(p_PC)}", expected="a point on its surface"
        )
    name = feature_name(geometry, facets)
    patches = [_patch(geometry, members, p_PC, name) for members in _patches(geometry, facets)]
    sets = sets_by_edges(geometry, p_PF, touched, [patch.facets for patch in patches])
    if sets is None:
        if clearance(geometry, p_PF, touched) < _ROOM_TO_LOOK * within:
            if within >= 100 * geometry.on_edge:
                problem = (
                    f"{geometry.name!r}: {name} at {place_text(p_PC)}: facets are too small to see what meets there"
                )
                raise UnsupportedError(problem, expected="a place away from small facets")
            return local_surface(geometry, p_PC, 10 * within)
        sets = _sets_by_looking(geometry, p_PF, touched, patches, name)
    provenance = Provenance.worst([patch.provenance for patch in patches])
    clauses = tuple(tuple(patches[index].normal for index in chosen) for chosen in sets)
    slips = tuple(patches[index].slips for chosen in sets for index in chosen)
    return LocalSurface(clauses, name, provenance, tuple(facets.tolist()), slips)


@dataclass(frozen=True, eq=False)
class _Patch:
    """Facets that count as one there: their normal, how well it is known, and along what their surface moves."""

    facets: list[int]
    normal: Point
    provenance: Provenance
    slips: Rows


def _sets_by_looking(
    geometry: PartGeometry, p_PF: Point, touched: Indices, patches: list[_Patch], name: str
) -> tuple[tuple[int, ...], ...]:
    """Clauses over patches where edges do not settle it: neither convex nor concave throughout, or several solids.

    Every facet is looked at by itself, then counts as its patch.
    """
    owner = [index for index, patch in enumerate(patches) for _ in patch.facets]
    normals = np.array([geometry.facets[facet].normal for patch in patches for facet in patch.facets])
    if len(patches) == 1:
        owner, normals = [0], patches[0].normal[None]
    found = sets_by_looking(geometry, p_PF, touched, units_of(normals), name)
    return tuple(dict.fromkeys(tuple(dict.fromkeys(owner[index] for index in chosen)) for chosen in found))


def facets_at(geometry: PartGeometry, touched: Indices) -> Indices:
    """The facets of some triangles; slivers, whose normals are noise, only if there is nothing else."""
    facets = sorted(set(geometry.facet_of_triangle[touched].tolist()))
    known = [facet for facet in facets if geometry.facets[facet].noise <= SLIVER_NOISE]
    return np.array(known or facets, dtype=np.int64)


def _patches(geometry: PartGeometry, facets: Indices) -> list[list[int]]:
    """Facets grouped to smooth patches: of one round surface; or smooth neighbours of which one is a strip."""
    patches = [[facet] for facet in facets.tolist()]
    if len(patches) == 1:
        return patches
    surfaces = {facet: geometry.surface_of_facet(facet) for facet in facets.tolist()}
    kinds = {facet: geometry.provenance_of(facet).kind for facet in facets.tolist()}
    for first, second in combinations(facets.tolist(), 2):
        angle = geometry.facets[first].angles.get(second)
        if surfaces[first] is not None or surfaces[second] is not None:
            together = _as_one(surfaces[first], surfaces[second])
        else:
            together = (
                angle is not None and abs(angle) < SMOOTH_ANGLE and "approximate" in (kinds[first], kinds[second])
            )
        if together:
            one, other = (next(patch for patch in patches if facet in patch) for facet in (first, second))
            if one is not other:
                one += other
                patches.remove(other)
    return [sorted(patch) for patch in patches]


def _as_one(one: SmoothSurface | None, other: SmoothSurface | None) -> bool:
    """Whether it is one surface, or two bands of one."""
    if one is None or other is None or one is other:
        return one is other
    return one.is_band and other.is_band and one.name == other.name


def _patch(geometry: PartGeometry, facets: list[int], p_PC: Point, name: str) -> _Patch:
    """Of a round surface its normal; of one facet its own; of strips the normalised mean, off by up to their spread."""
    surface = geometry.surface_of_facet(facets[0])
    if surface is not None:
        others = {id(s): s for s in map(geometry.surface_of_facet, facets) if s is not None}
        if len(others) > 1:
            return _between_bands(geometry, facets, list(others.values()), p_PC)
        return _Patch(facets, surface.normal(p_PC), geometry.provenance_of(facets[0]), surface.slips())
    origins = [geometry.provenance_of(facet) for facet in facets]
    if len(facets) == 1:
        normal = geometry.facets[facets[0]].normal
        slips = plane_slips(normal, p_PC) if origins[0].kind == "exact" else np.zeros((0, 6))
        return _Patch(facets, normal, origins[0], slips)
    units = units_of(np.array([geometry.facets[facet].normal for facet in facets]))
    mean = units.sum(axis=0)
    length = float(np.linalg.norm(mean))
    if length < len(facets) * np.cos(SMOOTH_ANGLE):
        raise UnsupportedError(f"{geometry.name!r}: {name} is the tip of a curved surface, which has no normal there")
    mean /= length
    spread = float(np.arctan2(np.linalg.norm(np.cross(units, mean), axis=1), units @ mean).max())
    kind = "approximate" if any(origin.kind == "approximate" for origin in origins) else "exact"
    error = max(spread, *(origin.normal_error for origin in origins))
    return _Patch(facets, mean, Provenance(kind, error), np.zeros((0, 6)))


def _between_bands(geometry: PartGeometry, facets: list[int], bands: list[SmoothSurface], p_PC: Point) -> _Patch:
    """Where bands of one turned surface meet: the mean of their normals, off by up to their spread and their errors."""
    normals = np.array([band.normal(p_PC) for band in bands])
    mean = normals.sum(axis=0) / np.linalg.norm(normals.sum(axis=0))
    spread = float(np.arctan2(np.linalg.norm(np.cross(normals, mean), axis=1), normals @ mean).max())
    worst = Provenance.worst([geometry.provenance_of(facet) for facet in facets])
    return _Patch(facets, mean, Provenance(worst.kind, worst.normal_error + spread, worst.slip_error), bands[0].slips())


def plane_slips(normal: Point, p_PC: Point) -> Rows:
    """The motions [v; w] that move a plane along itself, one a row: two ways along it, and turning about its normal."""
    rows = _plane_axes(normal.tobytes()).copy()
    rows[2, :3] = cross_products(p_PC, rows[2, 3:])
    return rows


@lru_cache(maxsize=1024)
def _plane_axes(packed: bytes) -> Rows:
    """`plane_slips` at the origin: the same for all points of a plane."""
    normal = np.frombuffer(packed)
    unit = normal / np.linalg.norm(normal)
    rows = np.zeros((3, 6))
    rows[0, :3], rows[1, :3] = tangents(unit)
    rows[2, 3:] = unit
    return read_only(rows)
