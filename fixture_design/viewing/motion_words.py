"""Motions and places in words a machinist can read."""

from __future__ import annotations

from math import ceil, log10

import numpy as np

from fixture_design.arrays import Point, Vector
from fixture_design.contacts.wrench import velocity
from fixture_design.errors import format_length

#: Rotations below this, per unit of size, are translations in words [-].
_STRAIGHT = 1e-9

#: Places are given to this part of the size, or finer [-].
_RESOLUTION = 1e-4
#: Units of places and the sizes from which they are used, in metres.
_UNITS = ((1.0, "m"), (1e-3, "mm"), (1e-6, "um"))


def motion_in_words(motion: Vector, reference: Point, length: float) -> str:
    """A displacement [dx; dtheta] about W's origin as a direction, a turn about a point, or a screw.

    An axis goes through its point nearest to ``reference``, p = r + dtheta X v / |dtheta|^2 with v the velocity of r:
    the point nearest to W's origin says little where the part is far from it.
    """
    v, turn = velocity(motion, reference), motion[len(reference) :]
    size = float(np.linalg.norm(turn))
    if size * length <= _STRAIGHT * max(float(np.linalg.norm(v)), size * length):
        return f"along {direction_in_words(v)}"
    return _turn(v, float(turn[0]), reference, length) if len(turn) == 1 else _screw(v, turn, reference, length)


def _turn(v: Vector, turn: float, reference: Point, length: float) -> str:
    centre = reference + np.array([-v[1], v[0]]) / turn
    return f"turns {'counter-clockwise' if turn > 0 else 'clockwise'} about {place_in_words(centre, length)}"


def _screw(v: Vector, turn: Vector, reference: Point, length: float) -> str:
    axis_point = reference + np.cross(turn, v) / (turn @ turn)
    pitch = float(turn @ v) / float(turn @ turn)
    text = f"turns about {direction_in_words(turn)} through {place_in_words(axis_point, length)}"
    if abs(pitch) > _STRAIGHT * length:
        text += f", advancing {format_length(2 * np.pi * pitch)} a turn"
    return text


def place_in_words(point: Point, length: float) -> str:
    """A point in the unit that suits a part of this size, to 1e-4 of it or finer: "(12.5, 0, -3.125) mm"."""
    unit, name = next((pair for pair in _UNITS if length >= pair[0]), _UNITS[-1])
    decimals = ceil(-log10(_RESOLUTION * length / unit))
    return f"({', '.join(f'{value + 0.0:.15g}' for value in np.round(point / unit, decimals))}) {name}"


def direction_in_words(vector: Vector) -> str:
    """A direction with its largest coordinate 1: "[0, 0.5, 1]"."""
    scaled = vector / np.abs(vector).max()
    return "[" + ", ".join(f"{value + 0.0:.3g}" for value in np.round(scaled, 6)) + "]"
