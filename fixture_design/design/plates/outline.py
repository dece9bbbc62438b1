"""The part's outline: a simple polygon, its edges as unit tangents and outward normals, and what it is measured by."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fixture_design.arrays import ArrayLike, Point, Points, Weights, read_only
from fixture_design.errors import GeometryError
from fixture_design.tolerances import FARTHEST, MERGE_VERTICES, PLATE_TIE


@dataclass(frozen=True, eq=False)
class Outline:
    """A simple polygon in the part's frame P; edge k runs from vertex k to the next, counted from 0.

    Attributes:
        vertices: shape (n, 2), counter-clockwise [m]; convex or not.

    Raises:
        GeometryError: fewer than three vertices, not finite or too far, repeated ones, sides that cross or overlap, no
            area, clockwise.
    """

    vertices: Points

    @classmethod
    def of(cls, polygon: ArrayLike) -> Outline:
        """The outline of vertices given as an array or as lists."""
        try:
            vertices = read_only(polygon)
        except (TypeError, ValueError) as error:
            raise GeometryError("a polygon is a list of vertices [x, y]", found=f"{polygon!r:.80}") from error
        return cls(vertices)

    def __post_init__(self) -> None:
        _check(self.vertices)

    @cached_property
    def lengths(self) -> Weights:
        """Of the edges, shape (n,) [m]."""
        return np.linalg.norm(np.roll(self.vertices, -1, axis=0) - self.vertices, axis=1)

    @cached_property
    def tangents(self) -> Points:
        """Unit vectors along the edges, shape (n, 2)."""
        return (np.roll(self.vertices, -1, axis=0) - self.vertices) / self.lengths[:, None]

    @cached_property
    def normals(self) -> Points:
        """Outward unit normals, shape (n, 2)."""
        return np.column_stack([self.tangents[:, 1], -self.tangents[:, 0]])

    @property
    def center(self) -> Point:
        """Of the bounding box, shape (2,) [m]: the reference point of moments."""
        return (self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2

    @cached_property
    def length(self) -> float:
        """Half the diagonal of the bounding box [m]: what moments are divided by."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0))) / 2

    def centered(self) -> Outline:
        """The same around its own centre: coordinates that keep their digits wherever the part's frame is."""
        return Outline(read_only(self.vertices - self.center))

    @property
    def tie(self) -> float:
        """Distances that differ by less are equal [m]."""
        return 2 * self.length * PLATE_TIE


def _check(vertices: np.ndarray) -> None:
    if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
        raise GeometryError("a polygon needs three or more vertices [x, y]", found=f"shape {vertices.shape}")
    if not np.isfinite(vertices).all() or np.abs(vertices).max() > FARTHEST:
        raise GeometryError("a polygon has a vertex that is not finite or too far", expected=f"within {FARTHEST:g} m")
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    if np.linalg.norm(np.roll(vertices, -1, axis=0) - vertices, axis=1).min() <= MERGE_VERTICES * size:
        raise GeometryError("a polygon has a vertex twice in a row")
    import shapely

    shape = shapely.Polygon(vertices)
    if not shape.is_valid:
        raise GeometryError("a polygon is not simple", found=shapely.is_valid_reason(shape))
    if shape.area <= MERGE_VERTICES * size**2:
        raise GeometryError("a polygon has no area", found=f"{shape.area:.3g} m^2")
    if not shape.exterior.is_ccw:
        raise GeometryError("a polygon runs clockwise", expected="counter-clockwise; list its vertices in reverse")
