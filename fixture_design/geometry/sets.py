"""Which facets exclude which at a point of a surface: by the sense of the edges there, or by looking into the part."""

from __future__ import annotations

import numpy as np

from fixture_design.arrays import Indices, Point, cross_products
from fixture_design.errors import GeometryError, UnsupportedError
from fixture_design.geometry.corner import MOST_FACETS, clauses_of_corner
from fixture_design.geometry.nearest import clearance
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import DirectionMask, Directions, Normals
from fixture_design.geometry.walls import is_wall
from fixture_design.tolerances import COPLANAR_ANGLE


def sets_by_edges(
    geometry: PartGeometry, p_PF: Point, touched: Indices, patches: list[list[int]]
) -> tuple[tuple[int, ...], ...] | None:
    """Clauses over patches where the sense of the edges through the point settles them; None where it does not.

    All edges convex: one OR. All concave: one AND. It needs one closed shell at the point, on no wall inside another.
    """
    if not geometry.is_one_shell and is_wall(geometry, p_PF, touched) is not False:
        return None
    if len(patches) == 1:
        return ((0,),)
    of_facet = {facet: index for index, patch in enumerate(patches) for facet in patch}
    angles, linked = [], [{index} for index in range(len(patches))]
    for first, second, angle in _edges_between(geometry, touched):
        one, other = of_facet.get(first), of_facet.get(second)
        if one is None or other is None:
            return None
        if one != other:
            angles.append(angle)
            whole = next(group for group in linked if one in group) | next(group for group in linked if other in group)
            linked = [group for group in linked if not group & whole] + [whole]
    if len(linked) > 1 or min(abs(angle) for angle in angles) < COPLANAR_ANGLE:
        return None
    if min(angles) > 0:
        return (tuple(range(len(patches))),)
    return tuple((index,) for index in range(len(patches))) if max(angles) < 0 else None


def _edges_between(geometry: PartGeometry, touched: Indices) -> list[tuple[int, int, float]]:
    """The edges that two touched triangles share: their facets, and the dihedral angle, positive if convex [rad]."""
    across = geometry.triangle_neighbours[touched]
    first, second = geometry.facet_of_triangle[touched][:, None], geometry.facet_of_triangle[np.maximum(across, 0)]
    shared = (across[:, :, None] == touched).any(axis=2) & (first != second)
    row, side = np.nonzero(shared)
    first, second = first[row, 0], second[row, side]
    corners = geometry.triangles[touched[row]]
    along = geometry.vertices[corners[np.arange(len(row)), (side + 1) % 3]]
    along = along - geometry.vertices[corners[np.arange(len(row)), side]]
    units, other_units = geometry.facet_units[first], geometry.facet_units[second]
    cross = cross_products(units, other_units)
    angles = np.arctan2(np.linalg.norm(cross, axis=1), np.einsum("ij,ij->i", units, other_units))
    angles = np.copysign(angles, np.einsum("ij,ij->i", cross, along))
    return list(zip(first.tolist(), second.tolist(), angles.tolist(), strict=True))


def sets_by_looking(
    geometry: PartGeometry, p_PC: Point, touched: Indices, units: Normals, name: str
) -> tuple[tuple[int, ...], ...]:
    """Clauses over facets from looking into the part around the point."""
    where = f"{geometry.name!r}: {name} at {place_text(p_PC)}"
    distinct = _distinct(units)
    if len(distinct) > MOST_FACETS:
        raise UnsupportedError(f"{where}: {len(distinct)} planes meet there", expected=f"at most {MOST_FACETS}")
    reach = 0.5 * min(clearance(geometry, p_PC, touched), geometry.half_diagonal)

    def inside(directions: Directions) -> DirectionMask:
        return geometry.inside(p_PC + reach * directions)

    sets = clauses_of_corner(units[distinct], inside)
    if not sets or () in sets:
        raise GeometryError(f"{where}: the point is inside the part, where solids it is made of touch or overlap")
    return tuple(tuple(int(distinct[index]) for index in chosen) for chosen in sets)


def _distinct(units: Normals) -> Indices:
    """The first of each set of parallel normals: through one point, they are of one plane."""
    same = np.linalg.norm(units[:, None] - units[None], axis=2) < COPLANAR_ANGLE
    return np.flatnonzero(~np.tril(same, -1).any(axis=1))


def units_of(normals: Normals) -> Normals:
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def place_text(p_PC: Point) -> str:
    return f"{np.round(p_PC, 6).tolist()} m"
