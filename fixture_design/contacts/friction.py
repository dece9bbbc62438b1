"""Friction cones as spans of edges: exact in the plane, bracketed from inside and outside in space (2-78 to 2-82)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from fixture_design.arrays import Point, Points, cross_products
from fixture_design.contacts.contact import Contact, unit_normal

#: An inner pyramid has its edges on the cone, an outer one its faces around it.
Side = Literal["inner", "outer"]

#: Directions closer than this to the normal do not tell one tangent from another, nor do shorter levers [-].
_ASIDE = 0.01


def friction_edges(
    normal: Point, friction: float, edges: int = 8, side: Side = "inner", first: Point | None = None
) -> Points:
    """Edges n + mu t of the friction cone, with unit normal component: the wrenches they carry replace n's own.

    In the plane these are n^- and n^+ of (2-79), (2-80), and the cone is exact. In space the circle of tangents t is
    cut to ``edges`` directions; the outer pyramid's are longer by 1 / cos(pi / edges): its faces touch the cone.
    Without friction it is the normal alone.

    Args:
        normal: outward normal, shape (p,), any length, not zero.
        friction: mu >= 0.  edges: number of edges in space, >= 3.  side: which bracket, in space.
        first: unit tangent of the first edge, in space; edge k is at the angle 2 pi k / edges from it about the normal.
            By default along the world's axes, see `tangents`; `first_tangents` gives ones that move with the contacts.

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
    second = tangents(unit)[1] if first is None else cross_products(unit, first)
    first = tangents(unit)[0] if first is None else first
    angles = 2 * np.pi * np.arange(edges) / edges
    reach = friction if side == "inner" else friction / np.cos(np.pi / edges)
    return unit + reach * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))


def first_tangents(contacts: Sequence[Contact], centre: Point) -> list[Points]:
    """For every contact in space a unit tangent of each of its normals, as if fixed to the contacts.

    It is the direction, across the normal, to ``centre``; where that lies along the normal, to the first other contact
    that does not; then along the first normal that is another; so that edges, and margins with them, move with the
    layout. Where all that fails everything is on one line, and only then the world's axes choose.

    Returns:
        one array of shape (k, 3) a contact, for its k normals.
    """
    points = np.array([contact.point for contact in contacts])
    directions = [unit_normal(normal) for contact in contacts for normal in contact.normals]
    size = float(np.linalg.norm(points - centre, axis=1).max())
    found = []
    for contact in contacts:
        levers = np.vstack([centre, points]) - contact.point
        lengths = np.linalg.norm(levers, axis=1)
        levers = levers[lengths > _ASIDE * size] / lengths[lengths > _ASIDE * size, None]
        candidates = np.vstack([levers, directions])
        found.append(np.array([_first_across(unit_normal(normal), candidates) for normal in contact.normals]))
    return found


def _first_across(unit: Point, candidates: Points) -> Point:
    """The unit tangent along the first of some unit vectors that is clearly not along the normal."""
    across = candidates - np.outer(candidates @ unit, unit)
    lengths = np.linalg.norm(across, axis=1)
    clear = np.flatnonzero(lengths > _ASIDE)
    if not len(clear):
        return tangents(unit)[0]
    tangent = across[clear[0]] / lengths[clear[0]]
    tangent = tangent - (tangent @ unit) * unit
    return tangent / np.linalg.norm(tangent)


def tangents(unit: Point) -> tuple[Point, Point]:
    """Two unit tangents, orthogonal to each other and to a unit normal in space; exact for normals along an axis."""
    axis = np.zeros(3)
    axis[int(np.argmin(np.abs(unit)))] = 1.0
    first = cross_products(unit, axis)
    first /= np.linalg.norm(first)
    return first, cross_products(unit, first)
