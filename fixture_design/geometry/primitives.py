"""Boxes, cylinders, spheres and capsules as closed meshes, which remember the curved surfaces that they stand for."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from fixture_design.geometry.piece import SmoothPatch
from fixture_design.geometry.shapes import PerVertex, PolygonVertices, Triangles, Vector3, Vertices
from fixture_design.tolerances import ROUND_OFF

#: Strips around an axis; a multiple of four, so that the outermost points are vertices. 5 degrees each: facets lie
#: within 0.1 % of the radius of a cylinder, and 0.2 % of a sphere.
STRIPS = 72

#: A curved surface: its kind, the first and last point of the profile, and the height of its centre [m].
_Part = tuple[Literal["cylinder", "sphere"], int, int, float]

#: Corners of the unit box, and its triangles, wound outward.
_BOX_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_BOX_TRIANGLES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)


@dataclass(frozen=True, eq=False)
class Primitive:
    """A shape in its own frame: vertices [m], triangles wound outward, rounding [m], and exact curved surfaces."""

    vertices: Vertices
    triangles: Triangles
    rounding: PerVertex
    smooth: tuple[SmoothPatch, ...] = field(default=())


def box(size: Vector3) -> Primitive:
    """A box centred at the origin."""
    corners = _BOX_CORNERS * size
    return Primitive(corners, _BOX_TRIANGLES.copy(), np.abs(corners).max(axis=1) * ROUND_OFF)


def cylinder(radius: float, length: float) -> Primitive:
    """A cylinder around z, centred at the origin."""
    half = length / 2
    return _revolved([[0.0, -half], [radius, -half], [radius, half], [0.0, half]], [("cylinder", 1, 2, 0.0)], radius)


def sphere(radius: float) -> Primitive:
    """A sphere centred at the origin, in rings of latitude."""
    arc = _arc(radius, -90.0, 90.0, 0.0)
    return _revolved(arc, [("sphere", 0, len(arc) - 1, 0.0)], radius)


def capsule(radius: float, length: float) -> Primitive:
    """A cylinder around z, ``length`` long, with a hemisphere at either end: ``length`` + 2 ``radius`` in all."""
    half = length / 2
    low, high = _arc(radius, -90.0, 0.0, -half), _arc(radius, 0.0, 90.0, half)
    equator, last = len(low) - 1, len(low) + len(high) - 1
    parts: list[_Part] = [
        ("sphere", 0, equator, -half),
        ("cylinder", equator, equator + 1, 0.0),
        ("sphere", equator + 1, last, half),
    ]
    return _revolved([*low, *high], parts, radius)


def _arc(radius: float, start_deg: float, end_deg: float, height: float) -> list[list[float]]:
    """Points [r, z] of a meridian, from latitude to latitude; exactly on the axis at the poles."""
    count = round((end_deg - start_deg) * STRIPS / 360)
    angles = np.radians(np.linspace(start_deg, end_deg, count + 1))
    radii = np.where(np.abs(angles) >= np.pi / 2, 0.0, radius * np.cos(angles))
    return np.column_stack([radii, height + radius * np.sin(angles)]).tolist()


def _revolved(profile: list[list[float]], parts: list[_Part], radius: float) -> Primitive:
    """The solid that a profile makes as it turns around z.

    Args:
        profile: points [r, z] from axis to axis, upward along the outside; only the first and the last have r = 0.
        parts: the curved surfaces along it.
        radius: of all of them [m].
    """
    points: PolygonVertices = np.array(profile, dtype=np.float64)
    angles = 2 * np.pi * np.arange(STRIPS) / STRIPS
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    rings = [np.column_stack([r * directions, np.full(STRIPS, z)]) for r, z in points[1:-1]]
    vertices = np.vstack([[0.0, 0.0, points[0, 1]], *rings, [0.0, 0.0, points[-1, 1]]])
    here = np.arange(STRIPS)
    after = np.roll(here, -1)
    first, last = 1, 1 + STRIPS * (len(rings) - 1)
    bands = [np.column_stack([np.zeros_like(here), first + after, first + here])]
    for ring in range(len(rings) - 1):
        low, high = first + ring * STRIPS, first + (ring + 1) * STRIPS
        bands += [
            np.vstack(
                [
                    np.column_stack([low + here, low + after, high + after]),
                    np.column_stack([low + here, high + after, high + here]),
                ]
            )
        ]
    bands.append(np.column_stack([np.full_like(here, len(vertices) - 1), last + here, last + after]))
    starts = np.cumsum([0, *(len(band) for band in bands)])
    smooth = tuple(
        SmoothPatch(
            kind, np.array([0.0, 0.0, z]), np.array([0.0, 0.0, 1.0]), radius, 0.0, np.arange(*starts[[low, up]])
        )
        for kind, low, up, z in parts
    )
    # a sine or cosine is good to one unit in the last place, and so is its product with the radius
    rounding = 2 * ROUND_OFF * np.abs(vertices).max(axis=1)
    return Primitive(vertices, np.vstack(bands).astype(np.int64), rounding, smooth)
