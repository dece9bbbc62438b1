"""Candidate points on the surface of a part: spread evenly, on the grid of a modular plate, or as given.

All lie on the surface to rounding and carry its outward normal, on strips of a round surface that surface's own. The
same seed gives the same points.

    >>> rules = SamplingRules(facets=[3, 4], edge_margin=0.003)        # doctest: +SKIP
    >>> spots = sample_surface(geometry, X_WP, spacing=0.005, rules=rules)
    >>> spots.points.shape, spots.features[0]
    ((212, 3), 'facet 3')
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices, Mask, Point, Points, read_only
from fixture_design.contacts import Provenance
from fixture_design.errors import GeometryError, OffSurfaceError, format_length
from fixture_design.geometry.local import facets_at
from fixture_design.geometry.nearest import touched_triangles
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.piece import area_vectors
from fixture_design.geometry.sampling_rules import SamplingRules, check_spacing, nothing_left
from fixture_design.geometry.segments import crossings
from fixture_design.geometry.shapes import OfTriangle
from fixture_design.geometry.sharp_edges import near_segments, sharp_edges
from fixture_design.geometry.thinning import apart, thinned
from fixture_design.layout import Pose
from fixture_design.tolerances import SURFACE_GAP

#: Darts thrown in one round for each square of the spacing's side [-].
_DARTS = 8

#: Rounds: after these, no spot as large as a third of the spacing is left without a try.
_ROUNDS = 12

#: Points asked for at most: more would be a spacing in the wrong unit.
_MOST_POINTS = 1_000_000


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on a part's surface, in W. Rows of all arrays belong together.

    Attributes:
        points: shape (n, p) [m].  normals: outward, of length 1, shape (n, p).
        facets: index of each point's facet; of a polygon, of its facet's first edge.  features: the facets' names.
        provenance: of each normal.
    """

    points: Points
    normals: Points
    facets: Indices
    features: tuple[str, ...]
    provenance: tuple[Provenance, ...]

    def __len__(self) -> int:
        return len(self.points)

    def __add__(self, more: SurfacePoints) -> SurfacePoints:
        return SurfacePoints(
            np.vstack([self.points, more.points]),
            np.vstack([self.normals, more.normals]),
            np.concatenate([self.facets, more.facets]),
            (*self.features, *more.features),
            (*self.provenance, *more.provenance),
        )


def sample_surface(
    geometry: PartGeometry, X_WP: Pose, spacing: float, rules: SamplingRules | None = None, seed: int = 0
) -> SurfacePoints:
    """Points spread over the surface where the rules let them be, none closer to another than ``spacing`` [m].

    Poisson disks: darts are thrown, by area, until hardly any spot is left. Distances are measured through space;
    points whose facets' normals are opposite (on the two sides of a wall, or of a slot) do not count as close.

    Args:
        X_WP: the part's pose; boxes of the rules and the result are in W. A moved part has moved points.
        seed: another one gives other points.

    Raises:
        GeometryError: a spacing that is not positive, or that would give a million points; a facet that there is not;
            rules that leave nothing, with what each one took away.
    """
    rules = rules or SamplingRules()
    check_spacing(spacing)
    lengths = np.linalg.norm(area_vectors(geometry.vertices, geometry.triangles), axis=1)
    chosen = np.flatnonzero(np.isin(geometry.facet_of_triangle, _allowed(geometry, rules)))
    reach = np.cumsum(lengths[chosen])
    if reach[-1] / 2 > _MOST_POINTS * spacing**2:
        found = f"{format_length(spacing)} on {reach[-1] / 2:.3g} m^2"
        raise GeometryError("`spacing` is too small for this part", found=found, expected="a length in metres")
    darts = int(np.ceil(_DARTS * max(reach[-1] / 2 / spacing**2, 1.0)))
    rng, sieve = np.random.default_rng(seed), _Sieve(geometry, X_WP, rules)
    taken, taken_normals = np.empty((0, 3)), np.empty((0, 3))
    triangles = np.empty(0, dtype=np.int64)
    for _ in range(_ROUNDS):
        # only `random` is drawn: its stream is the same in all versions of numpy
        along, u, v = rng.random((3, darts))
        triangle = chosen[np.minimum(np.searchsorted(reach, along * reach[-1], side="right"), len(chosen) - 1)]
        points = _within(geometry, triangle, u, v)
        normals = _flat_normals(geometry, geometry.facet_of_triangle[triangle])
        free = apart(points, normals, taken, taken_normals, spacing)
        free[free] = sieve.leaves(points[free])
        points, normals, triangle = points[free], normals[free], triangle[free]
        kept = thinned(points, normals, spacing)
        taken, taken_normals = np.vstack([taken, points[kept]]), np.vstack([taken_normals, normals[kept]])
        triangles = np.concatenate([triangles, triangle[kept]])
    return sieve.result(taken, geometry.facet_of_triangle[triangles])


def grid_points(
    geometry: PartGeometry,
    X_WP: Pose,
    origin: Point,
    pitch: float,
    plane: Literal["xy", "yz", "xz"] = "xy",
    rules: SamplingRules | None = None,
) -> SurfacePoints:
    """Where lines through the holes of a modular plate, at right angles to it, meet the surface: from both sides.

    Args:
        origin: one of the holes, in W, shape (3,) [m].  pitch: between holes [m].
        plane: of the plate, by two of W's axes. Walls at right angles to it are met by no line.

    Raises:
        GeometryError: as `sample_surface`.
    """
    rules = rules or SamplingRules()
    check_spacing(pitch, "`pitch` of the grid")
    planes = {"xy": (0, 1, 2), "yz": (1, 2, 0), "xz": (0, 2, 1)}
    across = list(planes[plane][:2])
    up = planes[plane][2]
    low, high = (bound(X_WP.points(geometry.vertices), axis=0) for bound in (np.min, np.max))
    if np.prod((high - low)[across] / pitch) > _MOST_POINTS:
        raise GeometryError("the pitch of the grid is too small for this part", found=format_length(pitch))
    first, last = np.ceil((low - origin) / pitch)[across], np.floor((high - origin) / pitch)[across]
    holes = np.stack(np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(first, last, strict=True))), axis=-1)
    ends = np.empty((holes.size // 2, 2, 3))
    ends[:, :, across] = origin[across] + pitch * holes.reshape(-1, 1, 2)
    ends[:, :, up] = [low[up] - pitch, high[up] + pitch]
    lines = X_WP.inverse().points(ends.reshape(-1, 3)).reshape(-1, 2, 3)
    line, triangle, at = crossings(lines, geometry.vertices[geometry.triangles])
    # sorted, so that a line through an edge, which meets both its triangles, is told from two walls
    order = np.lexsort((triangle, at, line))
    line, triangle, at = line[order], triangle[order], at[order]
    length = (high - low)[up] + 2 * pitch
    again = np.zeros(len(line), dtype=bool)
    again[1:] = (line[1:] == line[:-1]) & (np.diff(at) * length <= geometry.on_edge)
    line, triangle, at = line[~again], triangle[~again], at[~again]
    points = lines[line, 0] + at[:, None] * (lines[line, 1] - lines[line, 0])
    return _kept(geometry, X_WP, rules, points, geometry.facet_of_triangle[triangle])


def given_points(
    geometry: PartGeometry,
    X_WP: Pose,
    points: Points,
    rules: SamplingRules | None = None,
    surface_gap: float = SURFACE_GAP,
) -> SurfacePoints:
    """Points as someone chose them, in W, moved onto the surface; where facets meet, the first of them counts.

    Raises:
        OffSurfaceError: a point that is further from the surface than ``surface_gap`` [m].
        GeometryError: as `sample_surface`; points that are not finite.
    """
    onto, facets = [], []
    for number, point in enumerate(X_WP.inverse().points(points), start=1):
        distance, p_PC = geometry.surface.at(point)
        at = facets_at(geometry, touched_triangles(geometry, p_PC, geometry.on_edge))
        if abs(distance) > surface_gap:
            name = geometry.facets[at[0]].name
            raise OffSurfaceError(f"candidate {number}", geometry.name, distance, name, surface_gap)
        onto.append(p_PC)
        facets.append(int(at[0]))
    placed = np.array(onto, dtype=np.float64).reshape(-1, 3)
    return _kept(geometry, X_WP, rules or SamplingRules(), placed, np.array(facets, dtype=np.int64))


class _Sieve:
    """The rules at work on points in P, and what each of them took away."""

    def __init__(self, geometry: PartGeometry, X_WP: Pose, rules: SamplingRules) -> None:
        self.geometry, self.X_WP, self.margin = geometry, X_WP, rules.edge_margin
        edges = sharp_edges(geometry) if self.margin > 0 else np.empty((0, 2, 3))
        self.rules: dict[str, Callable[[Points], Mask]] = {
            # on the margin itself is allowed, but for rounding
            "edge_margin": lambda p: near_segments(p, edges, self.margin) >= self.margin - geometry.on_edge,
            **{name: (lambda p, rule=rule: rule(X_WP.points(p))) for name, rule in rules.boxes().items()},
        }
        self.removed, self.tried = dict.fromkeys(self.rules, 0), 0

    def leaves(self, points: Points) -> Mask:
        """Which points all rules leave; each is counted for the first rule that takes it."""
        left = np.ones(len(points), dtype=bool)
        self.tried += len(points)
        for name, rule in self.rules.items():
            before = int(left.sum())
            left[left] = rule(points[left])
            self.removed[name] += before - int(left.sum())
        return left

    def result(self, points: Points, facets: OfTriangle) -> SurfacePoints:
        if not len(points):
            raise nothing_left(self.geometry.name, self.tried, self.removed, self.margin)
        return SurfacePoints(
            read_only(self.X_WP.points(points)),
            read_only(self.X_WP.vectors(_normals(self.geometry, points, facets))),
            facets,
            tuple(self.geometry.facets[facet].name for facet in facets.tolist()),
            tuple(self.geometry.provenance_of(facet) for facet in facets.tolist()),
        )


def _kept(
    geometry: PartGeometry, X_WP: Pose, rules: SamplingRules, points: Points, facets: OfTriangle
) -> SurfacePoints:
    """Points chosen by someone else, where the rules leave them."""
    sieve = _Sieve(geometry, X_WP, rules)
    allowed = np.isin(facets, _allowed(geometry, rules))
    sieve.removed = {"facets": int((~allowed).sum()), **sieve.removed}
    left = allowed.copy()
    left[left] = sieve.leaves(points[left])
    sieve.tried = len(points)
    return sieve.result(points[left], facets[left])


def _allowed(geometry: PartGeometry, rules: SamplingRules) -> Indices:
    """Indices of the allowed facets."""
    numbers = rules.allowed(range(1, len(geometry.facets) + 1), geometry.name)
    return np.array(sorted(numbers), dtype=np.int64) - 1


def _within(geometry: PartGeometry, triangles: Indices, u: np.ndarray, v: np.ndarray) -> Points:
    """A point of each triangle, even by area; the two numbers are in [0, 1)."""
    first, second, third = (geometry.vertices[geometry.triangles[triangles, corner]] for corner in range(3))
    beyond = u + v > 1
    u, v = np.where(beyond, 1 - u, u)[:, None], np.where(beyond, 1 - v, v)[:, None]
    return first + u * (second - first) + v * (third - first)


def _normals(geometry: PartGeometry, points: Points, facets: OfTriangle) -> Points:
    """Unit normals at points of facets, in P: of the round surface that a facet stands for, else the facet's own.

    On the axis of a round surface, which has no normal there, the facet's own too.
    """
    normals = _flat_normals(geometry, facets)
    for facet in np.unique(facets).tolist():
        surface = geometry.surface_of_facet(facet)
        if surface is not None:
            on_it = np.flatnonzero(facets == facet)
            round_ones = surface.shape.directions(points[on_it]) * (-1.0 if surface.hollow else 1.0)
            has_one = round_ones.any(axis=1)
            normals[on_it[has_one]] = round_ones[has_one]
    return normals


def _flat_normals(geometry: PartGeometry, facets: OfTriangle) -> Points:
    """The unit normals of facets, in P."""
    normals = np.array([facet.normal for facet in geometry.facets])
    return (normals / np.linalg.norm(normals, axis=1, keepdims=True))[facets]
