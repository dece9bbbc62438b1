"""Where on a part fingertips may go: sampled points of its surface, pairs that face each other, and sets that close.

Two points are antipodal if the line between them is in both their friction cones: then two fingers with friction hold
each other through the part. For pads, which must lie flat, the line is the normal of both. Sets of three and more are
found by the machinery of `design`: candidates with the edges of their friction cones, hundreds of sets tested at once.

Source: V.-D. Nguyen, Constructing force-closure grasps, International Journal of Robotics Research 7, 1988.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices, Weights
from fixture_design.cones.kernel import closure_tests
from fixture_design.contacts import Scale
from fixture_design.design.candidates import Candidates
from fixture_design.errors import GeometryError
from fixture_design.geometry import PartGeometry, SamplingRules, SurfacePoints, sample_surface
from fixture_design.geometry.piece import area_vectors
from fixture_design.geometry.segments import crossings
from fixture_design.grasp.library import Spots
from fixture_design.layout import Pose
from fixture_design.tolerances import DEFAULT, FLAT_ENOUGH

#: About so many points are spread over the surface.
POINTS = 400

#: Lines begin this far inside of the part, relative to its half diagonal [-]: clear of the facet that they start at.
_BEHIND = 1e-3

#: How far from sharp edges, relative to the part's half diagonal, tried one after the other [-].
_MARGINS = (0.08, 0.03, 0.0)

#: Sets tried for closure at most.
SETS = 6000


@dataclass(frozen=True, eq=False)
class Region:
    """Two places of the part that face each other: all antipodal pairs between two of its features.

    Attributes:
        features: of both.  pairs: indices of antipodal pairs, shape (n, 2).
        widths: between their points [m].
    """

    features: tuple[str, str]
    pairs: Int[np.ndarray, "n 2"]
    widths: Weights


def spread(geometry: PartGeometry, seed: int) -> SurfacePoints:
    """Points all over a part, in P, away from its edges where there is room for that."""
    lengths = np.linalg.norm(area_vectors(geometry.vertices, geometry.triangles), axis=1)
    spacing = float(np.sqrt(lengths.sum() / 2 / POINTS))
    for margin in _MARGINS:
        rules = SamplingRules(edge_margin=margin * geometry.half_diagonal)
        try:
            found = sample_surface(geometry, Pose.identity(3), spacing, rules, seed)
        except GeometryError:
            if margin == 0:
                raise
            continue
        if len(found) >= POINTS / 10 or margin == 0:
            return found
    raise AssertionError("the last margin is zero")


def opposite(geometry: PartGeometry, points: SurfacePoints) -> tuple[SurfacePoints, Int[np.ndarray, "n 2"]]:
    """The points and those straight behind them, where their normals' lines leave the part; and which belong together.

    Behind a point there may be several, after holes and slots; each is one end of a pair.
    """
    reach = 2.2 * geometry.half_diagonal
    starts = points.points - _BEHIND * geometry.half_diagonal * points.normals
    lines = np.stack([starts, points.points - reach * points.normals], axis=1)
    line, triangle, at = crossings(lines, geometry.vertices[geometry.triangles])
    facets = geometry.facet_of_triangle[triangle]
    behind = lines[line, 0] + at[:, None] * (lines[line, 1] - lines[line, 0])
    normals = _normals(geometry, behind, facets)
    leaves = np.einsum("ij,ij->i", normals, points.normals[line]) < 0
    line, facets, behind, normals = line[leaves], facets[leaves], behind[leaves], normals[leaves]
    both = SurfacePoints(
        np.vstack([points.points, behind]),
        np.vstack([points.normals, normals]),
        np.concatenate([points.facets, facets]),
        (*points.features, *(geometry.facets[facet].name for facet in facets.tolist())),
        (*points.provenance, *(geometry.provenance_of(facet) for facet in facets.tolist())),
    )
    return both, np.column_stack([line, len(points) + np.arange(len(line))])


def _normals(geometry: PartGeometry, points: np.ndarray, facets: Indices) -> Float[np.ndarray, "n 3"]:
    normals = geometry.facet_units[facets].copy()
    for facet in np.unique(facets).tolist():
        surface = geometry.surface_of_facet(facet)
        if surface is not None:
            mine = np.flatnonzero(facets == facet)
            found = surface.shape.directions(points[mine]) * (-1.0 if surface.hollow else 1.0)
            normals[mine[found.any(axis=1)]] = found[found.any(axis=1)]
    return normals


def antipodal(points: SurfacePoints, pairs: Int[np.ndarray, "n 2"], friction: float, flat: bool) -> np.ndarray:
    """Which pairs are antipodal, with some friction; ``flat``: so that pads lie flat on both. Shape (n,)."""
    one, other = pairs.T
    away = points.points[one] - points.points[other]
    width = np.linalg.norm(away, axis=1)
    away = away / np.where(width > 0, width, 1.0)[:, None]
    least = np.cos(FLAT_ENOUGH / 2 if flat else np.arctan(friction))
    first = np.einsum("ij,ij->i", away, points.normals[one])
    second = -np.einsum("ij,ij->i", away, points.normals[other])
    # without friction the line must be the normal, but for rounding
    return (width > 0) & (np.minimum(first, second) >= least - DEFAULT.tie)


def regions_of(geometry: PartGeometry, points: SurfacePoints, pairs: Int[np.ndarray, "n 2"]) -> tuple[Region, ...]:
    """Pairs by the features at their ends, those with most pairs first."""
    names = [feature(geometry, facet) for facet in points.facets.tolist()]
    found: dict[tuple[str, str], list[int]] = {}
    for number, (one, other) in enumerate(pairs.tolist()):
        first, second = sorted((names[one], names[other]))
        found.setdefault((first, second), []).append(number)
    widths = np.linalg.norm(points.points[pairs[:, 0]] - points.points[pairs[:, 1]], axis=1)
    regions = [Region(key, pairs[members], widths[members]) for key, members in found.items()]
    return tuple(sorted(regions, key=lambda region: (-len(region.pairs), region.features)))


def feature(geometry: PartGeometry, facet: int) -> str:
    """The name of a facet, or of the round surface that it stands for."""
    surface = geometry.surface_of_facet(facet)
    return geometry.facets[facet].name if surface is None else surface.name


def closing_sets(
    points: SurfacePoints,
    scale: Scale,
    friction: float,
    count: int,
    reach: tuple[float, float],
    rng: np.random.Generator,
) -> tuple[Int[np.ndarray, "n k"], Weights]:
    """Sets of ``count`` points that close with friction, and by how much, best first.

    Args:
        reach: the least and the largest distance between two of them [m].
    """
    sets = _balanced_sets(points, count, reach, rng)
    if not len(sets):
        return sets, np.zeros(0)
    rows = Candidates.of(points, scale, friction).rows_with_friction
    each = rows.shape[1]
    flat = np.ascontiguousarray(rows.reshape(-1, rows.shape[2]))
    members = (sets[:, :, None] * each + np.arange(each)).reshape(-1)
    tests = closure_tests(flat, np.arange(len(sets) + 1) * (count * each), members)
    closed = np.flatnonzero(tests.closes == 1)
    order = closed[np.argsort(-tests.lower[closed], kind="stable")]
    return sets[order], tests.lower[order]


def _balanced_sets(
    points: SurfacePoints, count: int, reach: tuple[float, float], rng: np.random.Generator
) -> Int[np.ndarray, "n k"]:
    """Random sets whose last point opposes the others as well as any, and whose points are within reach."""
    total = len(points)
    sets = rng.integers(total, size=(SETS, count))
    missing = -points.normals[sets[:, :-1]].sum(axis=1)
    # the last one is drawn from those whose normals are nearest to what is missing
    opposing = missing @ points.normals.T + 0.3 * rng.standard_normal((SETS, total))
    sets[:, -1] = np.argmax(opposing, axis=1)
    away = np.linalg.norm(points.points[sets][:, :, None] - points.points[sets][:, None], axis=3)
    upper = np.triu_indices(count, 1)
    away = away[:, upper[0], upper[1]]
    sets = sets[(away.min(axis=1) >= reach[0]) & (away.max(axis=1) <= reach[1])]
    return np.unique(np.sort(sets, axis=1), axis=0)


def spots_at(points: SurfacePoints, chosen: Sequence[int] | Indices) -> Spots:
    """Some of the points as spots."""
    which = np.asarray(chosen, dtype=np.int64)
    return Spots(points.points[which], points.normals[which])
