"""A ball against a surface: the normal it has, and whether there is room for it."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import Provenance
from fixture_design.errors import GeometryError, UnsupportedError, format_length
from fixture_design.geometry.local import LocalSurface
from fixture_design.geometry.surface import Surface
from fixture_design.tolerances import MERGE_VERTICES, OFF_SURFACE

#: Steps in which a ball that cuts in is pushed out to find where it has room.
_PUSHES = 20


def ball_normal(surface: Surface, local: LocalSurface, p_PA: Point, p_PC: Point) -> tuple[Point, Provenance]:
    """The one normal at which a ball touches, and its provenance. A ball is smooth, so there is no OR.

    On a facet it is the facet's. On a convex edge it is the direction from the edge to where the ball was asked to be,
    if that is measurably outside; else the mean of the edge's normals, off by up to half the edge's angle.

    Args:
        p_PA: where the element was asked to be, in P [m].  p_PC: the surface point nearest to it.

    Raises:
        GeometryError: in a concave edge, which no ball reaches.
        UnsupportedError: in a corner with convex and concave edges.
    """
    if local.shape == "flat":
        return local.clauses[0][0], local.provenance
    if local.shape == "concave":
        raise GeometryError(f"a ball cannot reach into the concave {local.feature}", expected="a place on a facet")
    if local.shape == "mixed":
        text = f"a ball at {local.feature}, where convex and concave edges meet"
        raise UnsupportedError(text, expected="a point tip")
    away = p_PA - p_PC
    length = float(np.linalg.norm(away))
    mean = np.sum([normal / np.linalg.norm(normal) for normal in local.clauses[0]], axis=0)
    if length > OFF_SURFACE * 2 * surface.half_diagonal and away @ mean > 0:
        # the edge may be off by its rounding, which turns the direction
        turn = float(min(surface.precision / length, np.pi / 2))
        return away / length, Provenance(local.provenance.kind, max(turn, local.provenance.normal_error))
    mean /= np.linalg.norm(mean)
    angles = [np.arccos(np.clip(mean @ n / np.linalg.norm(n), -1.0, 1.0)) for n in local.clauses[0]]
    return mean, Provenance("approximate", float(max(angles)) + local.provenance.normal_error)


def check_room(surface: Surface, local: LocalSurface, p_PC: Point, normal: Point, radius: float, gap: float) -> None:
    """Whether a ball that touches at a point stays out of the rest of the part.

    Raises:
        GeometryError: it cuts in by more than the gap; the message says how deep, where, and where it has room.
    """
    center = p_PC + radius * normal / np.linalg.norm(normal)
    distance, p_PN = surface.nearest(center)
    depth = radius - distance
    if depth <= gap + surface.slack(local):
        return
    room = _room(surface, center, normal, radius, gap)
    where = f"it has room at {np.round(room, 6).tolist()} m (part frame)" if room is not None else "take a smaller ball"
    raise GeometryError(
        f"a ball of radius {format_length(radius)} at {local.feature} cuts {format_length(round(depth, 9))} into "
        f"{surface.feature(p_PN)} of {surface.name!r}; {where}"
    )


def _room(surface: Surface, center: Point, normal: Point, radius: float, gap: float) -> Point | None:
    """A surface point near by at which the ball fits, found by pushing it out of what it cuts; None if none is.

    On the facet with the normal given if that is possible, else on whatever the ball then touches.
    """
    for _ in range(_PUSHES):
        distance, p_PN = surface.nearest(center)
        # beyond half the gap, so that what is proposed also passes after rounding to the digits of the message
        if distance >= radius - gap / 2:
            break
        out = (center - p_PN) * np.copysign(1.0, distance)
        if abs(distance) <= MERGE_VERTICES * surface.half_diagonal:
            return None
        center = center + (radius - distance) * out / np.linalg.norm(out)
    distance, p_PN = surface.nearest(center - radius * normal / np.linalg.norm(normal))
    if abs(distance) > gap:
        distance, p_PN = surface.nearest(center)
    local = surface.local(p_PN)
    if local.shape != "flat":
        return None
    normal = local.clauses[0][0] / np.linalg.norm(local.clauses[0][0])
    fits = surface.nearest(p_PN + radius * normal)[0] >= radius - gap - surface.slack(local)
    return p_PN if fits else None
