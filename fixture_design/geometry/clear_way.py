"""Whether a part that moves straight away meets anything of its fixture: the swept way of a solid.

Exact for bodies, pads, lines and pins as shapes (`shadows`) and for balls (their distance to the part's edges and
faces); a point is in the way if the part passes over it and all around it. What touches or overlaps by no more than at
the start, and the surface gap, is not in the way. Facets count as they are: what they leave of a round surface is not
seen. The way has no end: out is out of the fixture altogether.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import STANDING, Contact, Role
from fixture_design.geometry.barriers import BallBarrier, Barrier, PointBarrier, SolidBarrier, barriers_of
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.segments import Segments, segment_distances
from fixture_design.geometry.separation import Solid, separation
from fixture_design.geometry.shadows import Faces, Frame, Triples, nearest_meeting, region_above
from fixture_design.geometry.shapes import Vector3
from fixture_design.layout import Layout, Obstacle, Pose

#: Columns around a point that must all be passed over before it is in the way.
_AROUND = 12
#: Columns of a region in which the first meeting is looked for.
_COLUMNS = 64


@dataclass(frozen=True, eq=False)
class Meeting:
    """An obstacle, and whether it is certain to be one: not where its size is assumed, or it is inside at the start."""

    obstacle: Obstacle
    certain: bool


def first_of(meetings: Sequence[Meeting]) -> Meeting | None:
    """The first on the way, of the certain ones if there are any."""
    return min(meetings, key=lambda m: (not m.certain, m.obstacle.after)) if meetings else None


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A spatial part and what stands around it.

    Attributes:
        barriers: in P.  X_WP: of the part.  gap: overlap that is touching [m], > 0.
    """

    geometry: PartGeometry
    barriers: tuple[Barrier, ...]
    X_WP: Pose
    gap: float

    @classmethod
    def of(
        cls, layout: Layout, geometry: PartGeometry, contacts: Sequence[Contact], roles: Sequence[Role] = STANDING
    ) -> Surroundings:
        """See `barriers_of`; a surface gap of zero is what the part's edges are known to."""
        pose = Pose.identity(3) if layout.part is None else layout.part.pose
        gap = max(layout.surface_gap, geometry.on_edge)
        return cls(geometry, barriers_of(layout, geometry, contacts, gap, roles), pose, gap)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(barrier.name for barrier in self.barriers)

    def length(self, direction: Point) -> float:
        """How far the part goes along a unit direction in W until it has left all of the fixture behind [m]."""
        t = self._in_part(direction)
        highest = max((_reach(barrier, t) for barrier in self.barriers), default=-np.inf)
        return max(0.0, highest - float((self.geometry.vertices @ t).min()))

    def meeting(self, direction: Point, any_one: bool = False) -> Meeting | None:
        """What is first in the way along a unit direction in W, a certain one where there is one; None if nothing is.

        Args:
            any_one: the first one found will do, points and balls before bodies.

        Raises:
            GeometryError: the geometry engine has no answer.
        """
        found = self._meetings(direction)
        return next(found, None) if any_one else first_of(list(found))

    def met(self, direction: Point) -> tuple[str, ...]:
        """The names of all that is in the way along a unit direction in W."""
        return tuple(meeting.obstacle.name for meeting in self._meetings(direction))

    def _meetings(self, direction: Point) -> Iterator[Meeting]:
        frame = Frame.along(self._in_part(direction))
        view = _View(frame, frame.seen(self._corners))
        quick_first = sorted(self.barriers, key=lambda barrier: isinstance(barrier, SolidBarrier))
        meetings = (self._with(barrier, view) for barrier in quick_first)
        return (meeting for meeting in meetings if meeting is not None)

    def _with(self, barrier: Barrier, view: _View) -> Meeting | None:
        frame = view.frame
        match barrier:
            case PointBarrier():
                met = self._point(barrier, view)
                certain = barrier.depth <= self.gap
            case BallBarrier():
                met = self._ball(barrier, view)
                certain = barrier.depth <= self.gap
            case SolidBarrier():
                met = self._solid(barrier, view)
                certain = not barrier.assumed
        if met is None:
            return None
        after, seen = met
        point = self.X_WP.points(frame.back(seen)[None])[0]
        return Meeting(Obstacle(barrier.name, after, point, self.X_WP.vectors(frame.axes[2:])[0]), certain)

    def _point(self, barrier: PointBarrier, view: _View) -> tuple[float, Vector3] | None:
        seen, allowed = view.frame.seen(barrier.point), self.gap + barrier.depth
        if barrier.depth > self.gap and not barrier.measured:
            return 0.0, seen
        angles = 2 * np.pi * np.arange(_AROUND) / _AROUND
        columns = seen[:2] + allowed * np.vstack([[0.0, 0.0], np.column_stack([np.cos(angles), np.sin(angles)])])
        lower = view.back.near(seen, allowed)
        column, face = lower.over(columns)
        below = lower.heights(face, columns[column]) < seen[2] - allowed
        if len(np.unique(column[below])) < len(columns):
            return None
        tops = view.ahead.near(seen, allowed)
        _, face = tops.over(seen[None, :2])
        ways = seen[2] - tops.heights(face, np.tile(seen[:2], (len(face), 1)))
        return float(ways[ways >= 0].min(initial=np.inf)) if (ways >= 0).any() else 0.0, seen

    def _ball(self, barrier: BallBarrier, view: _View) -> tuple[float, Vector3] | None:
        """The ball goes the other way: how near its centre comes to the part's edges, or through a face."""
        frame, center = view.frame, view.frame.seen(barrier.center)
        least = barrier.radius - self.gap - barrier.depth
        edges = frame.seen(self._edges)
        near = (edges[:, :, :2].min(axis=1) <= center[:2] + least).all(axis=1)
        near &= (edges[:, :, :2].max(axis=1) >= center[:2] - least).all(axis=1)
        near &= edges[:, :, 2].min(axis=1) <= center[2] + least
        edges = edges[near]
        meetings: list[tuple[float, Vector3]] = []
        if len(edges):
            end = np.array([center[0], center[1], float(edges[:, :, 2].min()) - barrier.radius])
            distances, points = segment_distances(edges, np.broadcast_to(np.array([center, end]), (len(edges), 2, 3)))
            for point in points[distances < least]:
                off = point - center
                rise = float(np.sqrt(max(0.0, barrier.radius**2 - float(off[:2] @ off[:2]))))
                after = max(0.0, -float(off[2]) - rise)
                meetings.append((after, point + np.array([0.0, 0.0, after])))
        ahead = view.ahead.near(center, 0.0)
        column, face = ahead.over(center[None, :2])
        heights = ahead.heights(face, np.tile(center[:2], (len(column), 1)))
        for height in heights[heights < center[2] - least].tolist():
            after = max(0.0, float(center[2] - height) - barrier.radius)
            meetings.append((after, np.array([center[0], center[1], height + after])))
        return min(meetings, key=lambda meeting: meeting[0]) if meetings else None

    def _solid(self, barrier: SolidBarrier, view: _View) -> tuple[float, Vector3] | None:
        import shapely

        seen = view.frame.seen(barrier.corners)
        ahead = Faces.facing(seen, True)
        region = region_above(ahead, view.back, self.gap + 2 * (barrier.depth or 0.0))
        if region is not None and barrier.depth is None and (depth := self._depth(barrier)) > 0:
            region = region_above(ahead, view.back, self.gap + 2 * depth)
        if region is None:
            return None
        outline = shapely.get_coordinates(region)
        inside = shapely.get_coordinates([shapely.point_on_surface(one) for one in shapely.get_parts(region)])
        columns = np.vstack([inside, outline[:: 1 + len(outline) // _COLUMNS]])
        return nearest_meeting(columns, seen, view.corners)

    def _depth(self, barrier: SolidBarrier) -> float:
        """How deep a body is in the part at the start, by facets: those of round surfaces cut into each other."""
        assert barrier.geometry is not None
        if barrier.name not in self._depths:
            there = separation(self._solid_part, Solid.of(barrier.geometry), Pose.identity(3), limit=0.0)
            self._depths[barrier.name] = max(0.0, -there.distance)
        return self._depths[barrier.name]

    @cached_property
    def _depths(self) -> dict[str, float]:
        return {}

    @cached_property
    def _solid_part(self) -> Solid:
        return Solid.of(self.geometry)

    @cached_property
    def _corners(self) -> Triples:
        return self.geometry.vertices[self.geometry.triangles]

    @cached_property
    def _edges(self) -> Segments:
        ends = self.geometry.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        return self.geometry.vertices[np.unique(np.sort(ends, axis=1), axis=0)]

    def _in_part(self, direction: Point) -> Vector3:
        return self.X_WP.inverse().vectors(direction[None])[0]


@dataclass(frozen=True, eq=False)
class _View:
    """The part's triangles along one direction, looked at once for all that may be in the way."""

    frame: Frame
    corners: Triples

    @cached_property
    def back(self) -> Faces:
        return Faces.facing(self.corners, False)

    @cached_property
    def ahead(self) -> Faces:
        return Faces.facing(self.corners, True)


def _reach(barrier: Barrier, t: Vector3) -> float:
    """The height of a barrier's highest point along a direction."""
    match barrier:
        case PointBarrier():
            return float(barrier.point @ t)
        case BallBarrier():
            return float(barrier.center @ t) + barrier.radius
        case SolidBarrier():
            return float((barrier.corners @ t).max())
