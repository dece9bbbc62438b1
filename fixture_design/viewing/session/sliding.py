"""An element slid over the part: straight ahead on every facet and over edges, with its tip turned along."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fixture_design.arrays import Point, read_only
from fixture_design.contacts import unit_normal
from fixture_design.errors import OffSurfaceError, UnsupportedError
from fixture_design.geometry import PartGeometry, Polygon, Slide, slide
from fixture_design.geometry.surface import SolidSurface
from fixture_design.layout import Element, LineTip, PadTip, PinTip, Pose, Tip
from fixture_design.viewing.scene.shapes import Vector3


@dataclass(frozen=True, eq=False)
class Ground:
    """What is slid over: a part where it stands, and how far from it an element may be [m]."""

    geometry: PartGeometry | Polygon
    pose: Pose
    surface_gap: float


def slid(element: Element, ground: Ground, u: float, v: float) -> Element:
    """The element at (u, v) [m] over the surface from where it is, as `geometry.slide` goes.

    u and v are measured along `axes`: on a face square to the world's axes, along two of these. A polygon has u alone,
    along its boundary, counter-clockwise. Pads and lines turn as the surface does.

    Raises:
        OffSurfaceError: the element does not touch the surface.
        UnsupportedError: pins, which stay in their hole.
        GeometryError: see `geometry.slide`.
    """
    if isinstance(element.tip, PinTip):
        raise UnsupportedError(f"element {element.name!r} is a pin, which stays in its hole", expected="another tip")
    if isinstance(ground.geometry, Polygon):
        return _around(element, ground, ground.geometry, u)
    if u == v == 0.0:
        return element
    p_PC = ground.pose.inverse().points(element.at[None])[0]
    first, second = axes(ground, element.at)
    length = float(np.hypot(u, v))
    way = ground.pose.inverse().vectors((u / length * first + v / length * second)[None])[0]
    end = slide(ground.geometry, p_PC, way, length, ground.surface_gap)
    at = read_only(ground.pose.points(end.point[None])[0])
    return replace(element, at=at, tip=_turned(element.tip, _turn(ground, end)))


def axes(ground: Ground, p_W: Point) -> tuple[Vector3, Vector3]:
    """Unit tangents u and v = n X u at a point of a solid's surface, in W: u along the first world axis that can be."""
    assert isinstance(ground.geometry, PartGeometry)
    p_PC = ground.geometry.surface.at(ground.pose.inverse().points(p_W[None])[0])[1]
    normal = ground.pose.vectors(_normal(ground.geometry, p_PC)[None])[0]
    lying = np.eye(3) - np.outer(normal, normal)
    first = lying[int(np.argmax(np.round(np.linalg.norm(lying, axis=1), _SAME)))]
    first = first / np.linalg.norm(first)
    return first, np.cross(normal, first)


#: Decimals in which world axes are told apart by how well they lie in a tangent plane: the first of equals is taken.
_SAME = 6


def _normal(geometry: PartGeometry, p_PC: Vector3) -> Vector3:
    """The mean of the unit normals that meet at a surface point, in P."""
    clauses = SolidSurface(geometry).local(p_PC).clauses
    mean = np.sum([unit_normal(normal) for clause in clauses for normal in clause], axis=0)
    return mean / np.linalg.norm(mean)


def _turn(ground: Ground, end: Slide) -> np.ndarray:
    """The rotation that takes the walker's axes at the start of a slide to those at its end, in W."""
    steps = np.diff(end.path, axis=0)
    taken = np.flatnonzero(np.linalg.norm(steps, axis=1) > 0)
    if not len(taken):
        return np.eye(3)
    first, last = int(taken[0]), int(taken[-1])
    assert isinstance(ground.geometry, PartGeometry)
    frames = [_frame(steps[k], _normal(ground.geometry, end.path[k : k + 2].mean(axis=0))) for k in (first, last)]
    return ground.pose.rotation @ frames[1] @ frames[0].T @ ground.pose.rotation.T


def _frame(direction: Vector3, normal: Vector3) -> np.ndarray:
    """The axes of a walker as columns: ahead, to the left, up."""
    up = normal - (normal @ direction) * direction / (direction @ direction)
    ahead, up = direction / np.linalg.norm(direction), up / np.linalg.norm(up)
    return np.column_stack([ahead, np.cross(up, ahead), up])


def _turned(tip: Tip, turn: np.ndarray) -> Tip:
    return replace(tip, along=read_only(turn @ tip.along)) if isinstance(tip, PadTip | LineTip) else tip


def _around(element: Element, ground: Ground, polygon: Polygon, u: float) -> Element:
    """Along the boundary of a polygon, round and round."""
    distance, foot = polygon.nearest(ground.pose.inverse().points(element.at[None])[0])
    if abs(distance) > ground.surface_gap:
        name = polygon.feature(foot)
        raise OffSurfaceError(element.name, polygon.name, distance, name, ground.surface_gap)
    if u == 0.0:
        return element
    lengths = np.linalg.norm(polygon.edges, axis=1)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    edge = _edge_of(polygon, foot)
    way = (ends[edge] + float(np.linalg.norm(foot - polygon.vertices[edge])) + u) % ends[-1]
    there = min(int(np.searchsorted(ends, way, side="right")) - 1, len(lengths) - 1)
    place = polygon.vertices[there] + (way - ends[there]) / lengths[there] * polygon.edges[there]
    turn = _between(polygon.edges[edge], polygon.edges[there])
    turn = ground.pose.rotation @ turn @ ground.pose.rotation.T
    return replace(element, at=read_only(ground.pose.points(place[None])[0]), tip=_turned(element.tip, turn))


def _edge_of(polygon: Polygon, foot: Point) -> int:
    """The edge that a boundary point is on; at a vertex the one that begins there."""
    away = foot - polygon.vertices
    along = np.clip(np.sum(away * polygon.edges, axis=1) / np.sum(polygon.edges**2, axis=1), 0.0, 1.0)
    off = np.linalg.norm(away - along[:, None] * polygon.edges, axis=1)
    near = np.flatnonzero(off <= polygon.precision)
    return int(near[np.argmin(along[near])]) if len(near) else int(np.argmin(off))


def _between(first: Point, second: Point) -> np.ndarray:
    """The rotation of the plane from one direction to another."""
    a, b = first / np.linalg.norm(first), second / np.linalg.norm(second)
    cos, sin = a @ b, a[0] * b[1] - a[1] * b[0]
    return np.array([[cos, -sin], [sin, cos]])
