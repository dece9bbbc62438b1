"""How far two solids are apart, or how deep one is in the other: true non-convex surfaces, never their hulls.

Two polyhedra are nearest at a vertex of one and a face of the other, or at two edges. The first kind is Drake's signed
distance phi at the vertices, exact to rounding; the second is measured edge by edge among the few triangles that the
balls of `sphere_tree` leave. Drake's distance between two meshes is that of their convex hulls, may be NaN where they
touch, and may not return; it is not asked.

Solids that overlap have a witness: a vertex of one inside the other; a stretch of an edge of one, between its crossings
with the other's surface, inside the other; or, where faces and edges lie in each other, a point just below a triangle
of one that is inside both. The depth given is the largest among these witnesses. It may be less than the largest there
is (on an edge in a convex solid it is at least half of it), so that an overlap is reported as shallower than it is, but
a reported one is always there.

`penetration` asks more than this, once for a body at rest: every place that is deeper than the gap, each judged by the
round surfaces that facets stand for. Here facets count as they are, and one witness is enough, for thousands of poses;
`penetration` comes here for overlaps of which it has no place. How far apart solids are is asked here alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices, cross_products
from fixture_design.geometry.broad import box_pairs, boxes_of
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.segments import Segments, crossings, segment_distances, stretches
from fixture_design.geometry.shapes import Directions, PerPoint, Vector3
from fixture_design.geometry.sphere_tree import SphereTree, sphere_tree
from fixture_design.layout import Pose


@dataclass(frozen=True, eq=False)
class Solid:
    """A part or body with the balls around its triangles."""

    geometry: PartGeometry
    tree: SphereTree

    @classmethod
    def of(cls, geometry: PartGeometry) -> Solid:
        return cls(geometry, sphere_tree(geometry.vertices, geometry.triangles))

    def distances(self, points: Directions) -> PerPoint:
        """Signed distance of points in the solid's own frame, shape (n, 3), negative inside; shape (n,) [m].

        Drake's sign is that of the nearest triangle; where several shells may overlap, a winding number gives it.
        """
        found = self.geometry.surface.distances(points)
        if self.geometry.is_one_shell:
            return found
        return np.where(self.geometry.inside(points), -np.abs(found), np.abs(found))


@dataclass(frozen=True, eq=False)
class Separation:
    """The signed distance of two solids [m], negative where they overlap, and a point where it is, in B's frame.

    The point is None where nothing below the limit was found: then ``distance`` is that limit.
    """

    distance: float
    point: Vector3 | None


def separation(first: Solid, second: Solid, X_BA: Pose, limit: float = np.inf, enough: float = -np.inf) -> Separation:
    """How far apart two solids are.

    Args:
        X_BA: pose of the first one's frame A in the second one's frame B.
        limit: distances above it are not told apart [m]; the lower, the faster.
        enough: stop at the first witness that is deeper than this [m].

    Raises:
        GeometryError: the geometry engine has no answer.
    """
    least = _Least(limit, enough)
    sides = (_Side(first, second, X_BA, X_BA.inverse(), True), _Side(second, first, X_BA.inverse(), X_BA, False))
    remaining = [side.near(least) for side in sides]
    if not least.settled:
        _vertices_and_edges(sides, remaining, least)
    return Separation(least.distance, least.point)


class _Least:
    """The least distance seen so far, and where; points in B."""

    def __init__(self, limit: float, enough: float) -> None:
        self.distance, self.enough = limit, enough
        self.point: Vector3 | None = None

    @property
    def settled(self) -> bool:
        return self.distance < self.enough

    def see(self, distances: PerPoint, points: Directions) -> None:
        if len(distances) and distances.min() < self.distance:
            best = int(np.argmin(distances))
            self.distance, self.point = float(distances[best]), points[best]


@dataclass(frozen=True, eq=False)
class _Side:
    """One of the solids as the other sees it.

    Attributes:
        pose: takes its own coordinates to the other's; ``back`` the reverse.
        moves: whether points for `_Least` must be taken over into the other's frame, which then is B.
    """

    mine: Solid
    other: Solid
    pose: Pose
    back: Pose
    moves: bool

    def near(self, least: _Least) -> Indices:
        """The triangles that may have a point nearer than the least distance, or be crossed by the other's surface."""
        tree, balls = self.mine.tree, np.zeros(1, dtype=np.int64)
        for number, level in enumerate(tree.levels):
            if number:
                balls = tree.children(number - 1, balls)
            if not len(balls):
                break
            phi, radii = self.other.distances(self.pose.points(level.centers[balls])), level.radii[balls]
            best = self.mine.geometry.triangles[tree.some_triangle(number, int(balls[np.argmin(phi)]))]
            self.look(least, self.mine.geometry.vertices[best[:1]])
            if least.settled:
                break
            balls = balls[(phi - radii <= least.distance) | (np.abs(phi) <= radii)]
        return tree.triangles[balls]

    def look(self, least: _Least, points: Directions) -> None:
        """Points of the surface, in its own frame, at their distance from the other solid."""
        over = self.pose.points(points)
        least.see(self.other.distances(over), over if self.moves else points)

    def look_below(self, least: _Least, triangles: Indices) -> None:
        """Points below the middles of triangles that are inside both solids, at the smaller of both depths."""
        corners = self.mine.geometry.vertices[self.mine.geometry.triangles[triangles]]
        normals = cross_products(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
        # a third of the smallest height: |normal| is height times longest side
        points = corners.mean(axis=1) - normals / (3 * longest[:, None])
        over = self.pose.points(points)
        theirs = self.other.distances(over)
        inside = theirs < min(0.0, least.distance)
        depth = np.maximum(theirs[inside], self.mine.distances(points[inside]))
        least.see(depth, (over if self.moves else points)[inside])


def _vertices_and_edges(sides: tuple[_Side, _Side], remaining: list[Indices], least: _Least) -> None:
    """What the remaining triangles have: vertices, edges that cross, places below, edges that pass each other."""
    for side, near in zip(sides, remaining, strict=True):
        used = np.unique(side.mine.geometry.triangles[near])
        side.look(least, side.mine.geometry.vertices[used])
        if least.settled:
            return
    corners = [s.mine.geometry.vertices[s.mine.geometry.triangles[n]] for s, n in zip(sides, remaining, strict=True)]
    edges = [_edges(side.mine.geometry, near) for side, near in zip(sides, remaining, strict=True)]
    for this, that in ((0, 1), (1, 0)):
        theirs = sides[this].back.points(corners[that].reshape(-1, 3)).reshape(-1, 3, 3)
        number, _, at = crossings(edges[this], theirs)
        number, at = stretches(number, at)
        middles = edges[this][number, 0] + at[:, None] * (edges[this][number, 1] - edges[this][number, 0])
        sides[this].look(least, middles)
        if least.settled:
            return
        # only solids whose vertices and edges are all outside or on each other's surface have no other witness
        if least.distance <= sides[this].mine.geometry.on_edge:
            sides[this].look_below(least, remaining[this])
        if least.settled:
            return
    if least.distance > 0:
        moved = sides[0].pose.points(edges[0].reshape(-1, 3)).reshape(-1, 2, 3)
        one, other = box_pairs(boxes_of(moved), boxes_of(edges[1]), least.distance)
        least.see(*segment_distances(moved[one], edges[1][other]))


def _edges(geometry: PartGeometry, triangles: Indices) -> Segments:
    """The edges of some triangles, each once."""
    chosen = geometry.triangles[triangles]
    ends = np.sort(np.stack([chosen, np.roll(chosen, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    count = len(geometry.vertices)
    single = np.unique(ends[:, 0] * count + ends[:, 1])
    return geometry.vertices[np.column_stack([single // count, single % count])]
