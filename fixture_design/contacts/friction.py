"""Friction cones as spans of edges: exact in the plane, bracketed from inside and outside in space (2-78 to 2-82)."""

from __future__ import annotations

from typing import Literal

import numpy as np

from fixture_design.arrays import Point, Points
from fixture_design.contacts.contact import unit_normal

#: An inner pyramid has its edges on the cone, an outer one its faces around it.
Side = Literal["inner", "outer"]


def friction_edges(normal: Point, friction: float, edges: int = 8, side: Side = "inner") -> Points:
    """Edges n + mu t of the friction cone, with unit normal component: the wrenches they carry replace n's own.

    In the plane these are n^- and n^+ of (2-79), (2-80), and the cone is exact. In space the circle of tangents t is
    cut to ``edges`` directions; the outer pyramid's are longer by 1 / cos(pi / edges): its faces touch the cone.
    Without friction it is the normal alone.

    Args:
        normal: outward normal, shape (p,), any length, not zero.
        friction: mu >= 0.  edges: number of edges in space, >= 3.  side: which bracket, in space.

    Returns:
        shape (k, p): k = 1 without friction, 2 in the plane, ``edges`` in space.

    Source: thesis 2.7 (c).
    """
    unit = unit_normal(normal)
    if friction == 0:
        return unit[None, :]
    if len(unit) == 2:
        tangent = np.array([-unit[1], unit[0]])
        return np.array([unit - friction * tangent, unit + friction * tangent])
    first, second = tangents(unit)
    angles = 2 * np.pi * np.arange(edges) / edges
    reach = friction if side == "inner" else friction / np.cos(np.pi / edges)
    return unit + reach * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))


def tangents(unit: Point) -> tuple[Point, Point]:
    """Two unit tangents, orthogonal to each other and to a unit normal in space; exact for normals along an axis."""
    axis = np.zeros(3)
    axis[int(np.argmin(np.abs(unit)))] = 1.0
    first = np.cross(unit, axis)
    first /= np.linalg.norm(first)
    return first, np.cross(unit, first)
