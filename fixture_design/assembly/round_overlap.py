"""How deep a turned body is in a drilled block: by the true shapes, so that a close fit does not meet facets.

The body P and the block's hull K are convex, and the part of P in K must be within a hole: it is if the points farthest
from the hole's axis are. These are on P's circles, or where P meets the planes in which the hole opens: there P's
section has either a point on a circle, or it meets the rim.
"""

from __future__ import annotations

import numpy as np

from fixture_design.assembly.circles import ALONG, Circles, Cones, crossed, lengths_of
from fixture_design.assembly.drilled_block import DrilledBlock, Hole
from fixture_design.assembly.nearest_places import nearest_angles
from fixture_design.assembly.placement import Placement
from fixture_design.assembly.round_touch import in_hole, lowest

#: Generators along which deep overlaps are looked for; shallow ones are found exactly.
_GENERATORS = 16


def overlap_with(place: Placement, block: DrilledBlock, near: float) -> np.ndarray:
    """How deep the body is in the block [m], shape (n,); negative: how far apart at least.

    Args:
        near: what is no deeper in the block than this counts as outside [m].
    """
    count = len(place.body.radii)
    lowest = [[_lowest(place.circle(k), normal, offset) for k in range(count)]
              for normal, offset in zip(block.normals, block.offsets, strict=True)]  # fmt: skip
    gaps = np.array([np.min([gap for gap, _ in found], axis=0) for found in lowest])
    depth = -gaps.max(axis=0)
    if not block.holes:
        return depth
    points = np.stack([point for found in lowest for _, point in found], axis=1)
    return np.minimum(depth, np.min([_out_of(place, block, hole, points, near) for hole in block.holes], axis=0))


def _lowest(circle: Circles, normal: np.ndarray, offset: float) -> tuple[np.ndarray, np.ndarray]:
    """How far a circle's lowest point is over a plane, and where it is."""
    out, sine = lowest(circle, normal, np.zeros_like(circle.center))
    return circle.center @ normal - offset - circle.radius * sine, circle.center + circle.radius * out


def _out_of(place: Placement, block: DrilledBlock, hole: Hole, points: np.ndarray, near: float) -> np.ndarray:
    """How far what is in the block is out of a hole, shape (n,) [m]."""
    found = [_aside(points, block, hole, near), _walls(place, block, hole, near)]
    for center, axis, _ in hole.rims():
        found.append(_aside(_at_plane(place, center, axis, near), block, hole, near))
        found.append(_rim_inside(place, center, axis, hole.radius, near))
    if hole.blind:
        normal, offset = hole.floor
        floors = [_lowest(place.circle(k), normal, offset)[0] for k in range(len(place.body.radii))]
        found.append(-np.min(floors, axis=0))
    return np.max(found, axis=0)


def _aside(points: np.ndarray, block: DrilledBlock, hole: Hole, near: float) -> np.ndarray:
    """Of points (n, m, 3), those in the block: how far they are from the hole's axis, less its radius, at most."""
    inside = (points @ block.normals.T - block.offsets <= -near * _INSIDE).all(axis=-1)
    across = lengths_of(crossed(points - hole.point, hole.axis)) - hole.radius
    return np.where(inside, across, -hole.radius).max(axis=1)


#: Points on a plane ``near`` below a facet are in the block also after rounding [-].
_INSIDE = 0.5


def _walls(place: Placement, block: DrilledBlock, hole: Hole, near: float) -> np.ndarray:
    """The places of the circles that are farthest from the hole's axis."""
    wall = Cones(
        (hole.point + hole.low * hole.axis)[None], hole.axis[None], hole.radius, (0.0, 1.0), hole.high - hole.low
    )
    points = [touch.point for k in range(len(place.body.radii)) for touch in in_hole(place.circle(k), wall)]
    return _aside(np.stack(points, axis=1), block, hole, near)


def _at_plane(place: Placement, center: np.ndarray, axis: np.ndarray, near: float) -> np.ndarray:
    """Points of the body in a plane ``near`` below an opening: of circles, and of some generators; (n, m, 3)."""
    offset = float(center @ axis) - near
    points = []
    for k in range(len(place.body.radii)):
        circle = place.circle(k)
        u, v = circle.basis
        height = circle.center @ axis - offset
        a, b = circle.radius * (u @ axis), circle.radius * (v @ axis)
        most = np.hypot(a, b)
        meets = (most > ALONG * circle.radius) & (np.abs(height) <= most)
        half = np.arccos(np.clip(-height / np.maximum(most, np.finfo(float).tiny), -1, 1))
        for sign in (-1, 1):
            point = circle.points(np.arctan2(b, a) + sign * half)
            points.append(np.where(meets[:, None], point, np.inf))
    angles = np.broadcast_to(np.arange(_GENERATORS) * 2 * np.pi / _GENERATORS, (len(place.R), _GENERATORS))
    rings = np.stack([place.circle(k).points(angles) for k in range(len(place.body.radii))])
    heights = rings @ axis - offset
    rise = heights[1:] - heights[:-1]
    share = -heights[:-1] / np.where(rise == 0, 1.0, rise)
    crossing = rings[:-1] + share[..., None] * (rings[1:] - rings[:-1])
    crossing = np.where(((share >= 0) & (share <= 1) & (rise != 0))[..., None], crossing, np.inf)
    far = np.concatenate([np.stack(points, axis=1), *crossing], axis=1)
    # what is nowhere in the plane is put far above it
    return np.where(np.isfinite(far), far, center + axis * _ABOVE)


#: A place that is in no block [m].
_ABOVE = 1e6


def _rim_inside(place: Placement, center: np.ndarray, axis: np.ndarray, radius: float, near: float) -> np.ndarray:
    """How deep the rim, moved ``near`` into the block, is in the body."""
    count = len(place.R)
    rim = Circles.around(
        np.repeat((center - near * axis)[None], count, axis=0), np.repeat(axis[None], count, axis=0), radius + near
    )
    points = []
    for k in range(len(place.body.slopes)):
        angles, _ = nearest_angles(rim, place.surface(k), 1.0)
        points.append(rim.points(angles))
    offsets = place.body.offsets(np.concatenate(points, axis=1), place.axis, place.origin)
    return -offsets.max(axis=-1).min(axis=1)
