"""Candidate points along the edges of a planar part."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Points, read_only
from fixture_design.errors import GeometryError, OffSurfaceError, format_length
from fixture_design.geometry.polygon import Polygon
from fixture_design.geometry.sampling import SurfacePoints
from fixture_design.geometry.sampling_rules import SamplingRules, check_spacing, nothing_left
from fixture_design.geometry.thinning import thinned
from fixture_design.layout import Pose
from fixture_design.tolerances import SMOOTH_ANGLE, SURFACE_GAP

#: Points tried on each stretch of one spacing [-].
_TRIES = 10

#: Points tried at most: more would be a spacing in the wrong unit.
_MOST_TRIES = 1_000_000


def sample_polygon(polygon: Polygon, X_WP: Pose, spacing: float, rules: SamplingRules | None = None) -> SurfacePoints:
    """Points along the boundary where the rules let them be, none closer to another than ``spacing`` [m].

    Each edge is walked from its middle outwards, longest edge first: there is no chance in it. Points on opposite sides
    of a thin wall do not count as close.

    Args:
        X_WP: the part's pose in the plane; boxes of the rules and the result are in W.

    Raises:
        GeometryError: a spacing that is not positive; a facet that there is not; rules that leave nothing.
    """
    check_spacing(spacing)
    lengths = np.linalg.norm(polygon.edges, axis=1)
    if lengths.sum() * _TRIES > _MOST_TRIES * spacing:
        found = f"{format_length(spacing)} on {format_length(float(lengths.sum()))}"
        raise GeometryError("`spacing` is too small for this part", found=found, expected="a length in metres")
    steps = np.arange(int(np.ceil(lengths.max() / spacing * _TRIES)) + 1) * spacing / _TRIES
    tried, edges = [], []
    # lengths are rounded for the order, so that it does not hang on the last bit
    for edge in np.lexsort((np.arange(len(lengths)), -np.round(lengths / lengths.max(), 9))).tolist():
        half = steps[steps <= lengths[edge] / 2]
        from_middle = np.concatenate([half, -half[1:]])
        along = np.concatenate([from_middle, [lengths[edge] / 2, -lengths[edge] / 2]]) / lengths[edge]
        tried.append(polygon.vertices[edge] + (0.5 + along)[:, None] * polygon.edges[edge])
        edges.append(np.full(len(along), edge))
    points, owner = np.vstack(tried), np.concatenate(edges)
    left = _left(polygon, X_WP, rules or SamplingRules(), points, owner)
    points, owner = points[left], owner[left]
    kept = thinned(points, _normals(polygon, owner), spacing)
    # along the boundary, as a person would number them
    walked = np.lexsort((np.linalg.norm(points[kept] - polygon.vertices[owner[kept]], axis=1), owner[kept]))
    return _points(polygon, X_WP, points[kept][walked], owner[kept][walked])


def given_polygon_points(
    polygon: Polygon,
    X_WP: Pose,
    points: Points,
    rules: SamplingRules | None = None,
    surface_gap: float = SURFACE_GAP,
) -> SurfacePoints:
    """Points as someone chose them, in W, moved onto the boundary; at an apex, the edge that starts there counts.

    Raises:
        OffSurfaceError: a point that is further from the boundary than ``surface_gap`` [m].
        GeometryError: as `sample_polygon`.
    """
    onto, owner = [], []
    for number, point in enumerate(X_WP.inverse().points(points), start=1):
        distance, p_PC = polygon.nearest(point)
        if not abs(distance) <= surface_gap:
            name = polygon.feature(p_PC)
            raise OffSurfaceError(f"candidate {number}", polygon.name, distance, name, surface_gap)
        onto.append(p_PC)
        owner.append(_edge_at(polygon, p_PC))
    placed, edges = np.array(onto, dtype=np.float64).reshape(-1, 2), np.array(owner, dtype=np.int64)
    left = _left(polygon, X_WP, rules or SamplingRules(), placed, edges)
    return _points(polygon, X_WP, placed[left], edges[left])


def _left(polygon: Polygon, X_WP: Pose, rules: SamplingRules, points: Points, owner: Indices) -> Indices:
    """The points that all rules leave.

    Raises:
        GeometryError: there are none.
    """
    facets = polygon.first_edge[owner] + 1
    allowed = rules.allowed(sorted(set((polygon.first_edge + 1).tolist())), polygon.name)
    sharp = polygon.vertices[_sharp_apices(polygon)]
    away = np.linalg.norm(points[:, None] - sharp[None], axis=2).min(axis=1, initial=np.inf)
    tests = {
        "facets": lambda: np.isin(facets, sorted(allowed)),
        "edge_margin": lambda: away >= rules.edge_margin - polygon.precision,
        **{name: (lambda rule=rule: rule(X_WP.points(points))) for name, rule in rules.boxes().items()},
    }
    left, removed = np.ones(len(points), dtype=bool), {}
    for name, test in tests.items():
        before = int(left.sum())
        left &= test()
        removed[name] = before - int(left.sum())
    if not left.any():
        raise nothing_left(polygon.name, len(points), removed, rules.edge_margin)
    return np.flatnonzero(left)


def _sharp_apices(polygon: Polygon) -> Indices:
    """The vertices that one can feel: not those inside a facet, nor those between the steps of an arc."""
    sharp = []
    for apex in np.flatnonzero(polygon.first_edge == np.arange(len(polygon.first_edge))).tolist():
        before, after = polygon.normal(apex - 1), polygon.normal(apex)
        turn = abs(np.arctan2(before[0] * after[1] - before[1] * after[0], before @ after))
        kinds = {polygon.provenance[int(polygon.first_edge[edge])].kind for edge in (apex - 1, apex)}
        if not (turn < SMOOTH_ANGLE and "approximate" in kinds):
            sharp.append(apex)
    return np.array(sharp, dtype=np.int64)


def _edge_at(polygon: Polygon, p_PC: np.ndarray) -> int:
    away = p_PC - polygon.vertices
    squares = np.einsum("ij,ij->i", polygon.edges, polygon.edges)
    along = np.clip(np.einsum("ij,ij->i", away, polygon.edges) / squares, 0.0, 1.0)
    distances = np.linalg.norm(away - along[:, None] * polygon.edges, axis=1)
    near = distances <= distances.min() + polygon.precision
    # at an apex both edges are near; the one that starts there has gone the shorter way
    return int(np.argmin(np.where(near, along, np.inf)))


def _normals(polygon: Polygon, owner: Indices) -> Points:
    """The unit normal of each edge's facet, in P."""
    facets, place = np.unique(polygon.first_edge[owner], return_inverse=True)
    normals = np.array([polygon.normal(int(facet)) for facet in facets])
    return (normals / np.linalg.norm(normals, axis=1, keepdims=True))[place]


def _points(polygon: Polygon, X_WP: Pose, points: Points, owner: Indices) -> SurfacePoints:
    first = polygon.first_edge[owner]
    return SurfacePoints(
        read_only(X_WP.points(points)),
        read_only(X_WP.vectors(_normals(polygon, owner))),
        first.astype(np.int64),
        tuple(f"facet {edge + 1}" for edge in first.tolist()),
        tuple(polygon.provenance[edge] for edge in first.tolist()),
    )
