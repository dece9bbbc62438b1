"""Where two solids meet: pairs of points, one on each surface, at which contact is to be judged.

The contact set of two polyhedra is made of polygons, segments and points, and its corners are of three kinds: a vertex
of one on a triangle of the other, the same the other way round, and an edge across an edge. What holds inside a polygon
or along a segment with one normal holds if it holds at the corners. Segments on which two edges run along each other
may have alternatives, so they are found as segments.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Mask
from fixture_design.geometry.broad import box_pairs, boxes_of
from fixture_design.geometry.features import EdgeEnds, Features
from fixture_design.geometry.shapes import Corners, Directions
from fixture_design.tolerances import COPLANAR_ANGLE


@dataclass(frozen=True, eq=False)
class PointPairs:
    """n points of the part's surface with the points of the body's that they meet, shape (n, 3) each [m].

    ``beside``: shape (n,), whether they meet only within the gap, the vertex lying beside the triangle it meets.
    """

    part: Directions
    body: Directions
    beside: Mask

    def swapped(self) -> PointPairs:
        return PointPairs(self.body, self.part, self.beside)

    @classmethod
    def joined(cls, *pairs: PointPairs) -> PointPairs:
        return cls(
            np.vstack([p.part for p in pairs]),
            np.vstack([p.body for p in pairs]),
            np.concatenate([p.beside for p in pairs]),
        )


@dataclass(frozen=True, eq=False)
class Segments:
    """n segments of the part's edges with the segments of the body's edges that they run along, shape (n, 2, 3) [m]."""

    part: EdgeEnds
    body: EdgeEnds


def meeting_points(part: Features, body: Features, gap: float) -> PointPairs:
    """All corners of the contact set: pairs no further apart than ``gap`` [m]."""
    blur = max(part.geometry.on_edge, body.geometry.on_edge)
    return PointPairs.joined(
        vertices_on_triangles(part.points, body.corners, gap, blur),
        vertices_on_triangles(body.points, part.corners, gap, blur).swapped(),
        crossing_edges(part.edges, body.edges, gap, blur),
    )


def vertices_on_triangles(points: Directions, corners: Corners, gap: float, blur: float) -> PointPairs:
    """Points within ``gap`` of triangles, with the nearest points of these.

    Args:
        points: shape (n, 3).  corners: shape (t, 3, 3).
        blur: a foot this far outside its triangle counts as on it [m].
    """
    which, triangle = box_pairs((points, points), boxes_of(corners), gap)
    near_points, near_corners = points[which], corners[triangle]
    feet, above = _on_planes(near_points, near_corners, blur)
    feet = np.where(above[:, None], feet, _on_sides(near_points, near_corners))
    near = np.linalg.norm(near_points - feet, axis=1) <= gap
    return PointPairs(near_points[near], feet[near], ~above[near])


def _on_planes(points: Directions, corners: Corners, blur: float) -> tuple[Directions, Mask]:
    """The feet of points on the planes of triangles, and whether they lie in the triangles, shape (n, 3) and (n,)."""
    sides = np.roll(corners, -1, axis=1) - corners
    normals = np.cross(sides[:, 0], sides[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    heights = np.einsum("nj,nj->n", points - corners[:, 0], normals)
    inward = np.cross(normals[:, None], sides)
    inward /= np.linalg.norm(inward, axis=2, keepdims=True)
    within = np.einsum("nkj,nkj->nk", inward, points[:, None] - corners) >= -blur
    return points - heights[:, None] * normals, within.all(axis=1)


def _on_sides(points: Directions, corners: Corners) -> Directions:
    """The nearest points on the sides of triangles, shape (n, 3)."""
    sides = np.roll(corners, -1, axis=1) - corners
    away = points[:, None] - corners
    along = np.einsum("nkj,nkj->nk", away, sides) / np.einsum("nkj,nkj->nk", sides, sides)
    feet = corners + np.clip(along, 0.0, 1.0)[:, :, None] * sides
    nearest = np.linalg.norm(points[:, None] - feet, axis=2).argmin(axis=1)
    return feet[np.arange(len(points)), nearest]


def crossing_edges(first: EdgeEnds, second: EdgeEnds, gap: float, blur: float) -> PointPairs:
    """Where edges that are not parallel cross within ``gap``: the points of each that are nearest to the other [m].

    Crossings at an end of an edge are left out: they are vertices on triangles.
    """
    one, other = box_pairs(boxes_of(first), boxes_of(second), gap)
    start, along = first[one, 0], first[one, 1] - first[one, 0]
    start_2, along_2 = second[other, 0], second[other, 1] - second[other, 0]
    length, length_2 = np.linalg.norm(along, axis=1), np.linalg.norm(along_2, axis=1)
    normals = np.cross(along, along_2)
    sizes = np.einsum("nj,nj->n", normals, normals)
    across = np.sqrt(sizes) > COPLANAR_ANGLE * length * length_2
    sizes = np.where(across, sizes, 1.0)
    between = start_2 - start
    # the common perpendicular: between + u along_2 - t along is parallel to the normal
    t = np.einsum("nj,nj->n", np.cross(between, along_2), normals) / sizes
    u = np.einsum("nj,nj->n", np.cross(between, along), normals) / sizes
    points, points_2 = start + t[:, None] * along, start_2 + u[:, None] * along_2
    inside = (np.abs(t - 0.5) * length < 0.5 * length - blur) & (np.abs(u - 0.5) * length_2 < 0.5 * length_2 - blur)
    kept = across & inside & (np.linalg.norm(points - points_2, axis=1) <= gap)
    return PointPairs(points[kept], points_2[kept], np.zeros(int(kept.sum()), dtype=bool))


def running_edges(part: Features, body: Features, gap: float) -> Segments:
    """Where an edge of the part runs along a parallel edge of the body, within ``gap`` and over more than it [m]."""
    first, second = part.edges, body.edges
    one, other = box_pairs(boxes_of(first), boxes_of(second), gap)
    start, along = first[one, 0], first[one, 1] - first[one, 0]
    length = np.linalg.norm(along, axis=1)
    along = along / length[:, None]
    ends = second[other]
    along_2 = ends[:, 1] - ends[:, 0]
    parallel = np.linalg.norm(np.cross(along, along_2), axis=1) <= COPLANAR_ANGLE * np.linalg.norm(along_2, axis=1)
    places = np.einsum("nkj,nj->nk", ends - start[:, None], along)
    low = np.maximum(places.min(axis=1), 0.0)
    high = np.minimum(places.max(axis=1), length)
    kept = parallel & (high - low > gap)
    start, along, ends, places = start[kept], along[kept], ends[kept], places[kept]
    stretch = np.stack([low[kept], high[kept]], axis=1)
    mine = start[:, None] + stretch[:, :, None] * along[:, None]
    share = (stretch - places[:, :1]) / (places[:, 1:] - places[:, :1])
    theirs = ends[:, :1] + share[:, :, None] * (ends[:, 1:] - ends[:, :1])
    near = (np.linalg.norm(mine - theirs, axis=2) <= gap).all(axis=1)
    return Segments(mine[near], theirs[near])
