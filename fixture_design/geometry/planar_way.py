"""Whether a planar part that moves straight away meets anything: the polygon it sweeps, against tips.

A point is in the way if it is inside the swept polygon by more than the surface gap and more than it is at the start; a
ball likewise by its radius; a pad or line, which in the plane is a stretch of the boundary, if any of it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Point, Points
from fixture_design.contacts import STANDING, Contact, Role, unit_normal
from fixture_design.geometry.clear_way import Meeting, first_of
from fixture_design.geometry.polygon import Polygon
from fixture_design.layout import Element, Layout, LineTip, Obstacle, PadTip, Pose, SphereTip, element_name

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

#: Halvings of the way in which the first meeting is looked for.
_HALVINGS = 50
#: Corners of a quarter of a ball's circle, which are on it.
_CIRCLE = 64
#: Pieces grow by this part of what is allowed before they are joined [-].
_SEAM = 0.01


@dataclass(frozen=True, eq=False)
class PlanarBarrier:
    """A point, a stretch between two points (shape (1, 2) or (2, 2), in P) or, with a radius, a ball [m].

    ``depth``: how far inside the part it is at the start [m]; ``measured``: see `barriers.PointBarrier`.
    """

    name: str
    points: Points
    radius: float
    depth: float
    measured: bool = True


@dataclass(frozen=True, eq=False)
class PlanarSurroundings:
    """A planar part and what stands around it; see `clear_way.Surroundings`."""

    polygon: Polygon
    barriers: tuple[PlanarBarrier, ...]
    X_WP: Pose
    gap: float

    @classmethod
    def of(
        cls, layout: Layout, polygon: Polygon, contacts: Sequence[Contact], roles: Sequence[Role] = STANDING
    ) -> PlanarSurroundings:
        """Elements and contacts given outright that have one of these roles; ``contacts``: all, in W."""
        pose = Pose.identity(2) if layout.part is None else layout.part.pose
        found = []
        for element in layout.elements:
            mine = [contact for contact in contacts if element_name(contact.name) == element.name]
            if element.role in roles and mine:
                found.append(_of_element(element, mine, polygon, pose))
        for contact in layout.contacts:
            if contact.role in roles:
                point = pose.inverse().points(contact.point[None])
                found.append(replace(_barrier(contact.name, point, 0.0, polygon), measured=False))
        return cls(polygon, tuple(found), pose, max(layout.surface_gap, polygon.precision))

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(barrier.name for barrier in self.barriers)

    def length(self, direction: Point) -> float:
        """How far the part goes along a unit direction in W until it has left all of the fixture behind [m]."""
        t = self._in_part(direction)
        highest = max((float((b.points @ t).max()) + b.radius for b in self.barriers), default=-np.inf)
        return max(0.0, highest - float((self.polygon.vertices @ t).min()))

    def meeting(self, direction: Point, any_one: bool = False) -> Meeting | None:
        """What is first in the way along a unit direction in W, or ``any_one``; see `clear_way.Surroundings`."""
        found = self._meetings(direction)
        return next(found, None) if any_one else first_of(list(found))

    def met(self, direction: Point) -> tuple[str, ...]:
        """The names of all that is in the way along a unit direction in W."""
        return tuple(meeting.obstacle.name for meeting in self._meetings(direction))

    def _meetings(self, direction: Point) -> Iterator[Meeting]:
        t = self._in_part(direction)
        meetings = (self._with(barrier, t, direction) for barrier in self.barriers)
        return (meeting for meeting in meetings if meeting is not None)

    def _with(self, barrier: PlanarBarrier, t: Point, direction: Point) -> Meeting | None:
        import shapely

        if barrier.depth > self.gap and not barrier.measured:
            return Meeting(Obstacle(barrier.name, 0.0, self.X_WP.points(barrier.points)[0], direction), False)
        # the last part of the way only passes by
        free, blocked = 0.0, self.length(direction) + 2 * self.polygon.half_diagonal
        if self._overlap(barrier, t, blocked).is_empty:
            return None
        if not self._overlap(barrier, t, 0.0).is_empty:
            blocked = 0.0
        for _ in range(_HALVINGS):
            middle = (free + blocked) / 2
            if self._overlap(barrier, t, middle).is_empty:
                free = middle
            else:
                blocked = middle
        met = shapely.get_coordinates(shapely.point_on_surface(self._overlap(barrier, t, blocked)))
        point = self.X_WP.points(met)[0]
        return Meeting(Obstacle(barrier.name, blocked, point, direction), barrier.depth <= self.gap)

    def _overlap(self, barrier: PlanarBarrier, t: Point, way: float) -> BaseGeometry:
        """What of a barrier is deeper in the swept polygon than it may be."""
        import shapely

        allowed = self.gap + barrier.depth
        # grown a little before they are joined, so that no rounding is left between the pieces
        swept = shapely.union_all(shapely.buffer(self._swept(t, way), _SEAM * allowed, join_style="mitre"))
        inner = swept.buffer(-(1 + _SEAM) * allowed, join_style="mitre")
        shape = shapely.Point(barrier.points[0]) if len(barrier.points) == 1 else shapely.LineString(barrier.points)
        return inner.intersection(shape.buffer(barrier.radius, quad_segs=_CIRCLE) if barrier.radius else shape)

    def _swept(self, t: Point, way: float) -> list[BaseGeometry]:
        """All that the polygon passes over: where it is at both ends, and a parallelogram for each edge."""
        import shapely

        if way == 0.0:
            return [self._shape]
        start, moved = self.polygon.vertices, self.polygon.vertices + way * t
        following = np.roll(np.arange(len(start)), -1)
        sides = [shapely.Polygon(side) for side in np.stack([start, start[following], moved[following], moved], axis=1)]
        # an edge along the way sweeps nothing
        return [self._shape, shapely.Polygon(moved), *(side for side in sides if side.area > 0)]

    @cached_property
    def _shape(self) -> BaseGeometry:
        import shapely

        return shapely.Polygon(self.polygon.vertices)

    def _in_part(self, direction: Point) -> Point:
        return self.X_WP.inverse().vectors(direction[None])[0]


def _of_element(element: Element, contacts: Sequence[Contact], polygon: Polygon, X_WP: Pose) -> PlanarBarrier:
    X_PW, tip = X_WP.inverse(), element.tip
    touched = X_PW.points(np.array([contact.point for contact in contacts]))
    # where normals meet, their mean looks out of the corner
    units = np.array([unit_normal(normal) for normal in contacts[0].normals])
    normal = unit_normal(X_PW.vectors(units).sum(axis=0))
    if isinstance(tip, SphereTip):
        return _barrier(element.name, (touched[0] + tip.radius * normal)[None], tip.radius, polygon)
    if isinstance(tip, PadTip | LineTip):
        at = X_PW.points(np.asarray(element.at, dtype=np.float64)[None])[0]
        middle = at - ((at - touched[0]) @ normal) * normal
        half = (tip.width if isinstance(tip, PadTip) else tip.length) / 2
        along = np.array([-normal[1], normal[0]])
        return _barrier(element.name, np.array([middle - half * along, middle + half * along]), 0.0, polygon)
    return _barrier(element.name, touched[:1], 0.0, polygon)


def _barrier(name: str, points: Points, radius: float, polygon: Polygon) -> PlanarBarrier:
    depth = max(0.0, *(radius - polygon.nearest(point)[0] for point in points))
    return PlanarBarrier(name, points, radius, depth)
