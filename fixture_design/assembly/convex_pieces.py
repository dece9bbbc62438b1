"""A solid cut into convex pieces, by the planes of its facets.

Its convex hull is cut by the plane of any facet that runs through the inside of what is left, until none does: then
each piece is inside the solid or outside. The pieces' interiors are dense in the solid, so that two solids overlap if
and only if two of their pieces do.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from fixture_design.arrays import Mask, Points
from fixture_design.assembly.polytope import Polytope
from fixture_design.errors import UnsupportedError
from fixture_design.tolerances import MERGE_VERTICES

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

#: More pieces than this are refused: every pose is tested against each of them.
MOST_PIECES = 200

#: A facet runs through a piece if more of its area is inside, relative to the squared size [-].
_AREA = 1e-9

#: Points this near to a plane are on it, relative to the size [-].
_NEAR = 10 * MERGE_VERTICES


def convex_pieces(
    points: Points,
    facets: list[tuple[np.ndarray, float, np.ndarray]],
    inside: Callable[[Points], Mask],
) -> tuple[Polytope, ...]:
    """Convex pieces that make the solid.

    Args:
        points: its corners, shape (n, 3) [m].
        facets: of each its outward normal, offset, and border: segments, shape (k, 2, 3), its inside to their left.
        inside: whether points, none of them on a facet, are in the solid.

    Raises:
        UnsupportedError: more than `MOST_PIECES` are needed.
    """
    plane_facets = [_PlaneFacet(*facet) for facet in facets]
    size = float(np.ptp(points, axis=0).max())
    waiting, cells = [Polytope.hull_of(points)], []
    while waiting:
        cell = waiting.pop()
        cutting = next((facet for facet in plane_facets if facet.runs_through(cell, size)), None)
        if cutting is None:
            cells.append(cell)
        else:
            waiting += _halves(cell, cutting.normal, cutting.offset, size)
        if len(waiting) + len(cells) > MOST_PIECES:
            raise UnsupportedError(
                f"the body is not convex, and more than {MOST_PIECES} convex pieces make it", expected="a simpler one"
            )
    kept = inside(np.array([cell.vertices.mean(axis=0) for cell in cells]))
    return tuple(cell for cell, solid in zip(cells, kept, strict=True) if solid)


class _PlaneFacet:
    """A facet with its area in coordinates of its plane."""

    def __init__(self, normal: np.ndarray, offset: float, border: np.ndarray) -> None:
        self.normal, self.offset = normal, offset
        self.basis = np.linalg.svd(normal[None])[2][1:]
        self.area = surrounded(border @ self.basis.T)

    def runs_through(self, cell: Polytope, size: float) -> bool:
        """Whether a piece of the facet is inside the cell."""
        from shapely.geometry import MultiPoint  # noqa: PLC0415 - 30 ms of any start

        heights = cell.vertices @ self.normal - self.offset
        near = _NEAR * size
        if heights.min() > -near or heights.max() < near:
            return False
        section = MultiPoint(_section(cell, heights, near) @ self.basis.T).convex_hull
        return section.intersection(self.area).area > _AREA * size**2


def surrounded(border: np.ndarray) -> BaseGeometry:
    """What segments (k, 2, 2) surround an odd number of times: a polygon, with holes and islands in them."""
    from shapely import polygonize, unary_union  # noqa: PLC0415 - as above
    from shapely.geometry import MultiLineString, Polygon  # noqa: PLC0415 - as above

    # joined first, so that they have vertices wherever they touch
    faces = list(polygonize([unary_union(MultiLineString(list(border)))]).geoms)
    shells = [Polygon(face.exterior) for face in faces]  # type: ignore[attr-defined]
    around = [sum(shell.contains(face.representative_point()) for shell in shells) for face in faces]
    return unary_union([face for face, count in zip(faces, around, strict=True) if count % 2])


def _section(cell: Polytope, heights: np.ndarray, near: float) -> Points:
    """Where a plane cuts a cell's edges, and its vertices in it."""
    a, b = cell.edges.T
    crossing = (np.maximum(heights[a], heights[b]) > near) & (np.minimum(heights[a], heights[b]) < -near)
    a, b = a[crossing], b[crossing]
    share = (heights[a] / (heights[a] - heights[b]))[:, None]
    cuts = cell.vertices[a] * (1 - share) + cell.vertices[b] * share
    return np.vstack([cell.vertices[np.abs(heights) <= near], cuts])


def _halves(cell: Polytope, normal: np.ndarray, offset: float, size: float) -> list[Polytope]:
    heights = cell.vertices @ normal - offset
    section = _section(cell, heights, _NEAR * size)
    sides = heights > _NEAR * size, heights < -_NEAR * size
    return [Polytope.hull_of(np.vstack([cell.vertices[side], section])) for side in sides]
