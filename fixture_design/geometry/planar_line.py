"""A line (or the width of a pad) against a planar part."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point
from fixture_design.contacts import unit_normal
from fixture_design.errors import GeometryError, format_length
from fixture_design.geometry.local import LocalSurface
from fixture_design.geometry.polygon import Polygon
from fixture_design.geometry.tip_touch import TipTouch
from fixture_design.tolerances import ALONG_NORMAL, COPLANAR_ANGLE


def planar_line_touches(
    polygon: Polygon, local: LocalSurface, p_PC: Point, length: float, along: Point, gap: float
) -> tuple[TipTouch, ...]:
    """Where a line and a polygon touch: the ends of where it lies on a side, or the convex apex it lies across.

    Args:
        local: of the boundary at ``p_PC``, the line's centre.  length: [m].  along: in P; projected on a side.

    Raises:
        GeometryError: a curved boundary; ``along`` is the normal; the line cuts into the part.
    """
    direction = unit_normal(along)
    normals = [unit_normal(normal) for clause in local.clauses for normal in clause]
    if len(normals) == 1:
        if local.provenance.kind != "exact":
            problem = f"a line cannot lie flat on {local.feature}, which is part of a curved boundary"
            raise GeometryError(problem, expected="a straight side, or another tip")
        direction = direction - (direction @ normals[0]) * normals[0]
        if np.linalg.norm(direction) < ALONG_NORMAL:
            raise GeometryError("a line cannot have its direction along the normal", expected="`along` the side")
        return _on_side(polygon, local, p_PC, length, unit_normal(direction), local.clauses[0][0], gap)
    slopes = [float(normal @ direction) for normal in normals]
    flush = [abs(slope) * length / 2 <= gap for slope in slopes]
    if local.shape == "convex" and any(flush):
        side = flush.index(True)
        direction = unit_normal(direction - slopes[side] * normals[side])
        return _on_side(polygon, local, p_PC, length, direction, local.clauses[0][side], gap)
    if local.shape == "convex" and slopes[0] * slopes[1] < 0:
        mean = unit_normal(normals[0] + normals[1])
        _check_clear(polygon, local, p_PC, length, direction, mean - (mean @ direction) * direction, gap)
        return (TipTouch(p_PC, local.clauses, local.provenance, local.feature),)
    depth = max(abs(slope) for slope in slopes) * length / 2
    raise GeometryError(
        f"a line at {local.feature} cuts {format_length(round(depth, 9))} into {polygon.name!r}",
        expected="`along` that stays outside, and a centre off reflex apices",
    )


def _on_side(
    polygon: Polygon, local: LocalSurface, p_PC: Point, length: float, direction: Point, normal: Point, gap: float
) -> tuple[TipTouch, ...]:
    """The furthest points of all sides in the line that face the same way."""
    unit = unit_normal(normal)
    _check_clear(polygon, local, p_PC, length, direction, unit, gap)
    starts, ends = polygon.vertices - p_PC, np.roll(polygon.vertices, -1, axis=0) - p_PC
    # sides that count as one turn by up to the angle within which they are merged
    reach = np.maximum(np.abs(starts @ direction), np.abs(ends @ direction))
    off = np.maximum(polygon.precision, np.minimum(gap, COPLANAR_ANGLE * reach))
    in_line = (np.abs(starts @ unit) <= off) & (np.abs(ends @ unit) <= off)
    # counter-clockwise, a side with this outward normal runs along it turned by a right angle
    in_line &= (ends - starts) @ np.array([-unit[1], unit[0]]) > 0
    places = np.sort(np.column_stack([starts[in_line] @ direction, ends[in_line] @ direction]), axis=1)
    places = places[(places[:, 1] > -length / 2) & (places[:, 0] < length / 2)]
    if not len(places):
        raise GeometryError(f"no side lies along a line at {local.feature}", expected="a centre on a straight side")
    low, high = max(float(places[:, 0].min()), -length / 2), min(float(places[:, 1].max()), length / 2)
    return tuple(
        TipTouch(p_PC + place * direction, ((normal,),), local.provenance, local.feature) for place in (low, high)
    )


def _check_clear(
    polygon: Polygon, local: LocalSurface, p_PC: Point, length: float, direction: Point, away: Point, gap: float
) -> None:
    """The line, lifted off by the gap, may not cross the boundary.

    Raises:
        GeometryError: it does, further than the gap from its end.
    """
    lift = unit_normal(away)
    starts = polygon.vertices - (p_PC + gap * lift)
    ends = np.roll(starts, -1, axis=0)
    below, after = starts @ lift, ends @ lift
    crossing = (below > 0) != (after > 0)
    share = below[crossing] / (below - after)[crossing]
    places = (starts[crossing] + share[:, None] * (ends - starts)[crossing]) @ direction
    inner = places[np.abs(places) < length / 2 - gap]
    if len(inner):
        worst = float(inner[np.argmin(np.abs(inner))])
        raise GeometryError(
            f"a line at {local.feature} cuts {format_length(round(length / 2 - abs(worst), 9))} into {polygon.name!r} "
            f"at {np.round(p_PC + worst * direction, 6).tolist()} m (part frame)",
            expected="a place with room for it, or a shorter line",
        )
