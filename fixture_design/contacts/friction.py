"""Friction cones as spans of edges: exact in the plane, bracketed from inside and outside in space (2-78 to 2-82)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from fixture_design.arrays import Indices, Point, Points, cross_products
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
    reach = friction if side == "inner" else friction / np.cos(np.pi / edges)
    return edges_around(unit, tangents(unit)[0] if first is None else first, reach, edges)


def edges_around(units: np.ndarray, firsts: np.ndarray, reach: float | np.ndarray, edges: int) -> np.ndarray:
    """n + mu (cos a t + sin a (n X t)) at equal angles a, shape (..., edges, 3), for many cones of one size or more.

    Args:
        units: unit normals n, and unit tangents t across them, shape (..., 3).  reach: mu, shape (..., 1, 1) or one.
    """
    angles = (2 * np.pi * np.arange(edges) / edges)[:, None]
    first, second = firsts[..., None, :], cross_products(units, firsts)[..., None, :]
    return units[..., None, :] + reach * (np.cos(angles) * first + np.sin(angles) * second)


def first_tangents(contacts: Sequence[Contact], centre: Point) -> list[Points]:
    """For every contact in space a unit tangent of each of its normals, as if fixed to the contacts.

    It is the direction, across the normal, to ``centre``; where that lies along the normal, to the first other contact
    that does not; then along the first normal that is another; so that edges, and margins with them, move with the
    layout. Where all that fails everything is on one line, and only then the world's axes choose.

    Returns:
        one array of shape (k, 3) a contact, for its k normals.
    """
    points = np.array([contact.point for contact in contacts])
    units = unit_normal(np.array([normal for contact in contacts for normal in contact.normals]))
    owners = np.repeat(np.arange(len(contacts)), [len(contact.normals) for contact in contacts])
    found = tangents_towards(points, centre, units, owners)
    return [found[owners == index] for index in range(len(contacts))]


def tangents_towards(points: np.ndarray, centre: np.ndarray, units: np.ndarray, owners: Indices) -> np.ndarray:
    """`first_tangents` of one layout or many, of the same digits.

    Args:
        points: of the contacts, shape (..., c, 3), and ``centre``, shape (..., 3) [m].
        units: unit normals, shape (..., k, 3), and the contact that each belongs to, shape (k,).

    Returns:
        one for each normal, shape (..., k, 3).
    """
    size = _lengths(points - centre[..., None, :]).max(axis=-2)[..., None]
    ends = np.concatenate([centre[..., None, :], points], axis=-2)
    levers = ends[..., None, :, :] - points[..., :, None, :]
    lengths = _lengths(levers)
    levers = levers / np.where(lengths > 0, lengths, 1.0)
    known = lengths[..., 0] > _ASIDE * size
    count = len(owners)
    others = np.broadcast_to(units[..., None, :, :], (*units.shape[:-1], count, 3))
    candidates = np.concatenate([levers[..., owners, :, :], others], axis=-2)
    usable = np.concatenate([known[..., owners, :], np.ones((*units.shape[:-1], count), dtype=bool)], axis=-1)
    across = _across(candidates, units[..., None, :])
    lengths = _lengths(across)[..., 0]
    clear = usable & (lengths > _ASIDE)
    chosen = np.argmax(clear, axis=-1)[..., None]
    taken = np.take_along_axis(across, chosen[..., None], axis=-2)[..., 0, :]
    length = np.take_along_axis(lengths, chosen, axis=-1)
    tangent = _across(taken / np.where(length > 0, length, 1.0), units)
    alone = ~clear.any(axis=-1, keepdims=True)
    tangent = np.where(alone, tangents(units)[0], tangent)
    return tangent / _lengths(tangent)


def _across(vectors: np.ndarray, units: np.ndarray) -> np.ndarray:
    """What is left of vectors off unit normals."""
    return vectors - np.add.reduce(vectors * units, axis=-1, keepdims=True) * units


def _lengths(vectors: np.ndarray) -> np.ndarray:
    """Shape (..., 1)."""
    return np.sqrt(np.add.reduce(vectors * vectors, axis=-1, keepdims=True))


def tangents(unit: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit tangents, orthogonal to each other and to unit normals (..., 3); exact for normals along an axis."""
    axis = np.eye(3)[np.argmin(np.abs(unit), axis=-1)]
    first = cross_products(unit, axis)
    first /= _lengths(first)
    return first, cross_products(unit, first)
