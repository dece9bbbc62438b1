"""Arrows for vectors, arcs for moments and turns, screws for both at once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fixture_design.contacts import tangents
from fixture_design.viewing.scene.drawn_sizes import THICK
from fixture_design.viewing.scene.scene import Thing
from fixture_design.viewing.scene.shapes import Arrow, Mesh, Points3, Vector3
from fixture_design.viewing.scene.space import Twist

#: Corners of a bent arrow's section, pieces of its length, and how far it goes round [rad].
_AROUND, _PIECES, _SWEEP = 10, 40, 1.5 * np.pi
#: Curves whose ends differ by less are straight [rad].
_STRAIGHT = 1e-6
#: Length and radius of its head, in radii of its shaft.
_HEAD, _HEAD_RADIUS = 7.0, 2.8


def wrench_things(path: str, wrench: Twist, at: Vector3, scale: float, size: float, color: str) -> Iterator[Thing]:
    """A wrench at a point: its force as an arrow that ends there, its moment as an arc around it.

    Args:
        at: where it acts, in W.  scale: metres drawn a newton.  size: half diagonal of the part [m].
    """
    force = wrench.along * scale
    if np.linalg.norm(force) > THICK * size:
        yield Thing(f"{path}/force", Arrow(at - force, at, THICK * size), color)
    moment = wrench.moment_at(at)
    turning = float(np.linalg.norm(moment))
    if turning * scale > (THICK * size) ** 2 and turning > 0:
        yield Thing(f"{path}/moment", bent_arrow(at, moment / turning, 0.22 * size, THICK * size, 0.0), color)


def central_point(wrench: Twist, near: Vector3) -> Vector3:
    """The point of a wrench's central axis that is nearest to a point: r + f X m_r / |f|^2; r itself without force."""
    square = float(wrench.along @ wrench.along)
    if square == 0:
        return near
    return near + np.cross(wrench.along, wrench.moment_at(near)) / square


def bent_arrow(center: Vector3, axis: Vector3, radius: float, thick: float, advance: float) -> Mesh:
    """An arrow around a unit axis, counter-clockwise seen against it; it climbs by ``advance`` [m] on its way."""
    first, second = tangents(axis)
    angles = np.linspace(0.0, _SWEEP, _PIECES)
    line = center + radius * (np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second))
    line = line + np.outer(angles / _SWEEP - 0.5, advance * axis)
    return bent_along(line, thick)


def bent_along(line: Points3, thick: float) -> Mesh:
    """An arrow along a curved line, shape (n, 3): a tube with a cone at its end, as one smooth mesh."""
    steps = np.gradient(line, axis=0)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    left = np.concatenate([np.cumsum(lengths[::-1])[::-1], [0.0]])
    in_head = left <= _HEAD * thick
    radii = np.where(in_head, _HEAD_RADIUS * thick * left / (_HEAD * thick), thick)
    angles = 2 * np.pi * np.arange(_AROUND) / _AROUND
    bend = np.cross(steps[0], steps[-1])
    length = float(np.linalg.norm(bend))
    up = bend / length if length > _STRAIGHT else tangents(steps[0])[0]
    sides = np.cross(up, steps)
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    others = np.cross(steps, sides)
    across = np.cos(angles)[:, None] * sides[:, None] + np.sin(angles)[:, None] * others[:, None]
    rings = line[:, None] + radii[:, None, None] * across
    here, there = np.arange(_AROUND), (np.arange(_AROUND) + 1) % _AROUND
    corners = []
    for k in range(len(line) - 1):
        a, b = k * _AROUND + here, k * _AROUND + there
        corners += [np.column_stack([a, b, b + _AROUND]), np.column_stack([a, b + _AROUND, a + _AROUND])]
    return Mesh(rings.reshape(-1, 3), np.vstack(corners), smooth=True)
