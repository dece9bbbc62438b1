"""Round bodies as polyhedra, to be drawn: contacts are those of the true shapes."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Points
from fixture_design.assembly.assembly import AssemblyBody
from fixture_design.assembly.body_parts import part_of
from fixture_design.assembly.drilled_block import DrilledBlock, Hole, drilled_block
from fixture_design.assembly.polyhedron import Polyhedron, polyhedron_of
from fixture_design.assembly.polytope import Polytope
from fixture_design.assembly.round_bodies import is_round
from fixture_design.assembly.turned_body import TurnedBody, turned_body
from fixture_design.layout import Pose

#: Strips that are drawn around.
_STRIPS = 36


def facets_of(body: AssemblyBody) -> Polyhedron:
    """A body by plane facets: its own, or some that stand for its round surfaces.

    Raises:
        GeometryError: a mesh that cannot be read.
        UnsupportedError: as `polyhedron_of`.
    """
    part = None if body.box is not None else part_of(body)
    if part is None or not is_round(part):
        return polyhedron_of(body)
    pose = body.pose or Pose.identity(3)
    turned, drilled = turned_body(part, pose), drilled_block(part, pose)
    if isinstance(turned, TurnedBody):
        rings = [_ring(c, turned.axis, r) for c, r in zip(turned.centers, turned.radii.tolist(), strict=True)]
        return Polyhedron.convex(Polytope.hull_of(np.vstack(rings)))
    return _drilled(drilled) if isinstance(drilled, DrilledBlock) else polyhedron_of(body)


def _ring(center: np.ndarray, axis: np.ndarray, radius: float) -> Points:
    """Points around an axis, counter-clockwise seen from where it points."""
    first = np.linalg.svd(axis[None])[2][1]
    angles = np.arange(_STRIPS)[:, None] * 2 * np.pi / _STRIPS
    return center + radius * (np.cos(angles) * first + np.sin(angles) * np.cross(axis, first))


def _drilled(block: DrilledBlock) -> Polyhedron:
    borders = [_segments(block.hull.vertices[ring]) for ring in block.hull.corners]
    normals, offsets = list(block.hull.normals), block.hull.offsets.tolist()
    for hole in block.holes:
        low, high = (_ring(hole.point + h * hole.axis, hole.axis, hole.radius) for h in (hole.low, hole.high))
        for k, (center, axis, _) in enumerate(hole.rims()):
            facet = int(np.argmin(np.abs(block.hull.normals @ center - block.hull.offsets) - block.hull.normals @ axis))
            borders[facet] = np.concatenate([borders[facet], _segments((high[::-1], low)[k])])
        if hole.blind:
            normals.append(hole.axis)
            offsets.append(hole.floor[1])
            borders.append(_segments(low))
        _add_wall(hole, low, high, normals, offsets, borders)
    points = block.hull.vertices
    rings = (False,) * len(borders)
    none = np.zeros((0, 2, 3)), np.zeros((0, 3))
    return Polyhedron(points, *none, np.array(normals), np.array(offsets), tuple(borders), rings, ())


def _add_wall(hole: Hole, low: Points, high: Points, normals: list, offsets: list, borders: list) -> None:
    for k in range(_STRIPS):
        corners = np.array([low[k], high[k], high[(k + 1) % _STRIPS], low[(k + 1) % _STRIPS]])
        inward = np.cross(high[(k + 1) % _STRIPS] - high[k], hole.axis)
        inward /= -np.linalg.norm(inward)
        normals.append(inward)
        offsets.append(float(inward @ low[k]))
        borders.append(_segments(corners))


def _segments(ring: Points) -> np.ndarray:
    return np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
