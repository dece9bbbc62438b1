"""A straight line as a tip: flat on a facet, along an edge, or across one."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Point, cross_products
from fixture_design.contacts import Provenance, unit_normal
from fixture_design.errors import GeometryError, UnsupportedError, format_length
from fixture_design.geometry.footprint import FlatTriangles, check_clear, footprint
from fixture_design.geometry.local import LocalSurface
from fixture_design.geometry.nearest import triangles_in_box
from fixture_design.geometry.pad import flat_normal
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.sets import place_text
from fixture_design.geometry.smooth_surface import SmoothSurface
from fixture_design.geometry.tip_touch import TipTouch
from fixture_design.layout import LineTip

_WHAT = "a line"


def line_touches(
    geometry: PartGeometry, local: LocalSurface, p_PC: Point, tip: LineTip, along: Point, gap: float
) -> tuple[TipTouch, ...]:
    """Where a line and the part touch.

    * On a facet: the two ends of where they overlap, with the facet's normal: v(x) is affine along the line, so the
      ends imply the rest. The line takes the projection of ``along``.
    * Along a cylinder: the same, with its normal there.
    * Across a convex edge: the crossing point, with the OR of the edge's facets.
    * Along a concave edge: both ends, each with the AND of its facets.
    * Along a convex edge: the true set is no AND of ORs of the ends, since one alternative must serve all along the
      line, or change where the line does. Both ends take the mean normal, which may be off by half the edge's angle:
      within that are both normals at both ends, the same (a set inside the true one) and any (a set around it), so a
      verdict is given only where they agree.

    Along means that the ends lift off by no more than the gap.

    Args:
        local: of the surface at ``p_PC``, the line's centre.  along: in P.  gap: [m].

    Raises:
        GeometryError: a curved surface, a line that cuts into the part, ``along`` is the normal.
        UnsupportedError: a line centred on an apex.
    """
    normals = [normal for clause in local.clauses for normal in clause]
    if len(normals) == 1:
        surface = geometry.surface_of_facet(local.facets[0])
        if surface is not None and surface.kind == "cylinder":
            return _on_cylinder(geometry, surface, local, p_PC, tip, along, gap)
        return _on_facet(geometry, flat_normal(geometry, local, _WHAT), local, p_PC, tip, along, gap)
    if len(normals) > 2:
        raise UnsupportedError(f"this version does not evaluate a line centred on {local.feature}")
    direction = unit_normal(along)
    slopes = [float(unit_normal(normal) @ direction) for normal in normals]
    flush = [abs(slope) * tip.length / 2 <= gap for slope in slopes]
    if all(flush):
        return _along_edge(geometry, normals, local, p_PC, tip, along, gap)
    if local.shape == "convex" and any(flush):
        return _on_facet(geometry, normals[flush.index(True)], local, p_PC, tip, along, gap)
    if local.shape == "convex" and slopes[0] * slopes[1] < 0:
        mean = unit_normal(normals[0]) + unit_normal(normals[1])
        lift = gap * unit_normal(mean - (mean @ direction) * direction)
        _check_free(geometry, f"across {local.feature}", p_PC + lift, direction, tip.length, gap)
        return (TipTouch(p_PC, local.clauses, local.provenance, local.feature),)
    depth = max(abs(slope) for slope in slopes) * tip.length / 2
    raise GeometryError(
        f"{_WHAT} at {local.feature} cuts {format_length(round(depth, 9))} into {geometry.name!r}",
        expected="`along` that stays outside: in a facet, or along or across the edge",
    )


def _on_facet(
    geometry: PartGeometry,
    normal: Point,
    local: LocalSurface,
    p_PC: Point,
    tip: LineTip,
    along: Point,
    gap: float,
) -> tuple[TipTouch, ...]:
    place = footprint(geometry, p_PC, normal, along, (tip.length / 2, 0.0), gap, _WHAT)
    check_clear(geometry, place, gap, _WHAT)
    ends = _ends(place.flat, tip.length / 2, geometry.on_edge)
    return tuple(TipTouch(p_PC + end * place.x, ((normal,),), local.provenance, local.feature) for end in ends)


def _on_cylinder(
    geometry: PartGeometry,
    surface: SmoothSurface,
    local: LocalSurface,
    p_PC: Point,
    tip: LineTip,
    along: Point,
    gap: float,
) -> tuple[TipTouch, ...]:
    """The ends of where the line runs along the cylinder; it takes the direction of the axis."""
    turned = float(np.linalg.norm(cross_products(unit_normal(along), surface.axis))) * tip.length / 2
    if turned > gap:
        raise GeometryError(
            f"{_WHAT} on {surface.name} must run along its axis; its ends are {format_length(round(turned, 9))} off",
            expected=f"along {np.round(surface.axis, 6).tolist()} (part frame)",
        )
    normal = local.clauses[0][0]
    lift = (gap + 2 * surface.sagitta) * unit_normal(normal)
    _check_free(geometry, f"along {surface.name}", p_PC + lift, surface.axis, tip.length, gap)
    triangles = np.concatenate([geometry.facets[facet].triangles for facet in surface.facets])
    corners = geometry.vertices[geometry.triangles[triangles]] - p_PC
    near = (np.abs(corners @ unit_normal(normal)) < surface.radius).all(axis=1)
    flat = corners[near] @ np.column_stack([surface.axis, cross_products(normal, surface.axis)])
    ends = _ends(flat, tip.length / 2, geometry.on_edge)
    return tuple(TipTouch(p_PC + end * surface.axis, ((normal,),), local.provenance, local.feature) for end in ends)


def _along_edge(
    geometry: PartGeometry,
    normals: list[Point],
    local: LocalSurface,
    p_PC: Point,
    tip: LineTip,
    along: Point,
    gap: float,
) -> tuple[TipTouch, ...]:
    """Both facets must be there along the line; the line takes the direction of the edge."""
    edge = cross_products(normals[0], normals[1])
    edge = edge * np.copysign(1.0, edge @ along)
    places = [footprint(geometry, p_PC, normal, edge, (tip.length / 2, 0.0), gap, _WHAT) for normal in normals]
    bounds = np.array([_ends(place.flat, tip.length / 2, geometry.on_edge) for place in places])
    ends = [p_PC + end * places[0].x for end in (bounds[:, 0].max(), bounds[:, 1].min())]
    if local.shape == "concave":
        return tuple(TipTouch(end, local.clauses, local.provenance, local.feature) for end in ends)
    units = [unit_normal(normal) for normal in normals]
    mean = unit_normal(units[0] + units[1])
    off = float(np.arctan2(np.linalg.norm(cross_products(units[0], mean)), units[0] @ mean))
    provenance = Provenance("approximate", off + local.provenance.normal_error)
    return tuple(TipTouch(end, ((mean,),), provenance, local.feature) for end in ends)


def _ends(flat: FlatTriangles, half: float, precision: float) -> tuple[float, float]:
    """From where to where the line y = 0, |x| <= half, lies on triangles given by [x, y].

    Raises:
        GeometryError: they overlap in a point at most.
    """
    near = (flat[:, :, 1].min(axis=1) <= precision) & (flat[:, :, 1].max(axis=1) >= -precision)
    found = [interval for triangle in flat[near] if (interval := _crossed(triangle, precision)) is not None]
    clipped = [(max(low, -half), min(high, half)) for low, high in found if high > -half and low < half]
    low, high = min((low for low, _ in clipped), default=0.0), max((high for _, high in clipped), default=0.0)
    if high - low <= precision:
        raise GeometryError(f"{_WHAT} does not lie on the surface at all", expected="a longer line")
    return low, high


def _crossed(triangle: np.ndarray, precision: float) -> tuple[float, float] | None:
    """The part of the line y = 0 in a triangle, shape (3, 2); corners within ``precision`` of it are on it."""
    y = np.where(np.abs(triangle[:, 1]) <= precision, 0.0, triangle[:, 1])
    places = triangle[y == 0, 0].tolist()
    for first, second in ((0, 1), (1, 2), (2, 0)):
        if y[first] * y[second] < 0:
            share = y[first] / (y[first] - y[second])
            places.append(float(triangle[first, 0] + share * (triangle[second, 0] - triangle[first, 0])))
    return (min(places), max(places)) if len(places) > 1 else None


def _check_free(geometry: PartGeometry, where: str, lifted: Point, direction: Point, length: float, gap: float) -> None:
    """A line, lifted a little off the surface it touches, may not cross the surface further than the gap from its ends.

    Raises:
        GeometryError: it does.
    """
    places = _crossings(geometry, lifted, direction, length / 2)
    inner = places[np.abs(places) < length / 2 - gap]
    if len(inner):
        worst = float(inner[np.argmin(np.abs(inner))])
        depth = length / 2 - abs(worst)
        raise GeometryError(
            f"{_WHAT} {where} cuts {format_length(round(depth, 9))} into {geometry.name!r} at "
            f"{place_text(lifted + worst * direction)} (part frame)",
            expected="a place with room for it, or a shorter line",
        )


def _crossings(geometry: PartGeometry, point: Point, direction: Point, half: float) -> np.ndarray:
    """Where a line through a point crosses triangles, by its own coordinate, from -half to half."""
    reach = np.abs(direction) * half
    corners = geometry.vertices[geometry.triangles[triangles_in_box(geometry, point - reach, point + reach)]] - point
    sides = cross_products(np.roll(corners, -1, axis=1), corners) @ direction
    through = (sides > 0).all(axis=1) | (sides < 0).all(axis=1)
    normals = cross_products(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[through]
    heights = np.einsum("ti,ti->t", normals, corners[through, 0])
    places = heights / (normals @ direction)
    return places[np.abs(places) <= half]
