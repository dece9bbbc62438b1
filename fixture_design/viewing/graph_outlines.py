"""The small drawing of a contact state: outlines of the bodies at one configuration, in the plane or in space."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from fixture_design.assembly import ContactState, ContactStateGraph, rotations
from fixture_design.layout import Pose
from fixture_design.viewing.graph_solids import DrawnBody, drawn

_FIXED, _MOVING = "#d5d0c8", "#1b6ca8"

#: How much an outline covers: in space the fixed bodies are in front of the moving one as well.
_OPACITY, _BEHIND, _IN_FRONT = 0.75, 0.9, 0.25

#: How much more than where the moving body comes is shown [-].
_ROOM = 1.15

#: Where drawings in space are looked at from: along x less than along y, from above.
_EYE = np.array([0.45, -0.75, 0.5])


@dataclass(frozen=True, eq=False)
class Outline:
    """Something that is filled: rings of points, shape (k, 2), in the drawing's units with y down; holes turn back."""

    rings: tuple[np.ndarray, ...]
    color: str
    opacity: float


#: What is drawn of a state, the hindmost first.
Outlines = Callable[[ContactState], Iterator[Outline]]


def outlines_of(graph: ContactStateGraph, width: float, height: float) -> Outlines:
    """How the states of a graph are drawn, each into width times height.

    Raises:
        InputError: bodies in space that cannot be read.
    """
    return _Flat(graph, width, height) if graph.assembly.space == "planar" else _Solid(graph, width, height)


@dataclass(frozen=True, eq=False)
class _Window:
    """What all drawings of a graph show: the corner that is lowest, the scale, and the drawing's height."""

    low: np.ndarray
    scale: float
    height: float

    @classmethod
    def around(cls, points: np.ndarray, width: float, height: float) -> _Window:
        """Where points (n, 2) are, with some room, in the drawing's shape."""
        center = (points.min(axis=0) + points.max(axis=0)) / 2
        unit = float((np.ptp(points, axis=0) / [width, height]).max()) * _ROOM
        return cls(center - unit * np.array([width, height]) / 2, 1 / unit, height)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        seen = (points - self.low) * self.scale
        return np.column_stack([seen[:, 0], self.height - seen[:, 1]])


class _Flat:
    """Polygons."""

    def __init__(self, graph: ContactStateGraph, width: float, height: float) -> None:
        self.assembly = graph.assembly
        self.window = _Window.around(np.vstack([self._moved(state) for state in graph.states]), width, height)

    def __call__(self, state: ContactState) -> Iterator[Outline]:
        for body in self.assembly.fixed:
            vertices = np.asarray(body.polygon)
            placed = vertices if body.pose is None else body.pose.points(vertices)
            yield Outline((self.window(placed),), _FIXED, _OPACITY)
        yield Outline((self.window(self._moved(state)),), _MOVING, _OPACITY)

    def _moved(self, state: ContactState) -> np.ndarray:
        """Corners of the moving body at the sample that is drawn."""
        q, body = state.samples[0], self.assembly.moving
        vertices = np.asarray(body.polygon)
        for pose in filter(None, (body.pose, Pose.from_xy_theta(q[:2], float(q[2])))):
            vertices = pose.points(vertices)
        return vertices


class _Solid:
    """Facets that face the eye, seen from far away; the fixed ones once more, faintly, over the moving body."""

    def __init__(self, graph: ContactStateGraph, width: float, height: float) -> None:
        self.moving = drawn(graph.assembly.moving)
        fixed = [drawn(body) for body in graph.assembly.fixed]
        self.away = _EYE / np.linalg.norm(_EYE)
        right = np.cross([0.0, 0.0, 1.0], self.away)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(self.away, right)])
        size = np.ptp(self.moving.corners, axis=0).max() / 2
        positions = [state.samples[:, :3] for state in graph.states if state.contacts] or [np.zeros((1, 3))]
        flat = np.vstack(positions) @ self.axes.T
        self.window = _Window.around(np.vstack([flat - size, flat + size]), width, height)
        self.fixed = [ring for body in fixed for ring in self._facing(body, np.eye(3), np.zeros(3))]

    def __call__(self, state: ContactState) -> Iterator[Outline]:
        q = state.samples[0]
        turned = rotations.matrices(q[None, 3:])[0]
        yield from (Outline(rings, _FIXED, _BEHIND) for rings in self.fixed)
        yield from (Outline(rings, _MOVING, _OPACITY) for rings in self._facing(self.moving, turned, q[:3]))
        yield from (Outline(rings, _FIXED, _IN_FRONT) for rings in self.fixed)

    def _facing(self, body: DrawnBody, R: np.ndarray, position: np.ndarray) -> list[tuple[np.ndarray, ...]]:
        found = []
        for facet in body.facets:
            if (R @ facet.normal) @ self.away > 0:
                rings = [ring @ R.T + position for ring in facet.rings]
                depth = float(np.vstack(rings).mean(axis=0) @ self.away)
                found.append((depth, tuple(self.window(ring @ self.axes.T) for ring in rings)))
        return [rings for _, rings in sorted(found, key=lambda each: each[0])]
