"""Solids seen along a direction: what one of them meets when it moves that way, exactly, without a step.

Coordinates are (u, v, h) with h along the direction t: a point of the plane (u, v) is a column. A solid A that moves
along t passes over everything in a column that is above the lowest point of A in it; it is in the way of nothing below.
So A gets out, however far, if and only if in every column that it shares with B

    highest point of B  <=  lowest point of A.

Both are on triangles: those of A that face back along t, those of B that face ahead. Over the overlap of two of these
the heights differ by an affine function, which is largest at a corner of the overlap. Nothing is sampled, whether the
solids are convex or not. Columns count where they are wide enough: a region in which B is above A by more than
``allowed`` and that holds no disc of this radius is grazing, as it is where surfaces slide along each other.

Drake is not asked: it knows distances at a pose, and where surfaces slide these allow no step.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Points, Weights, cross_products
from fixture_design.contacts import tangents
from fixture_design.geometry.shapes import Vector3

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

#: Columns, one a row.
Columns = Float[np.ndarray, "_ 2"]
#: The corners of triangles of any solid.
Triples = Float[np.ndarray, "_ 3 3"]

#: Triangles steeper than this along the direction have no columns: its cosine to their normal [-]. Over a metre their
#: shadow is a nanometre wide.
STEEP = 1e-9
#: Pieces of overlap looked at together, the widest first.
_BATCH = 4000
#: Pieces grow by this part of what is allowed before they are joined, so that no rounding is left between them [-].
_SEAM = 0.01


@dataclass(frozen=True, eq=False)
class Frame:
    """Coordinates (u, v, h) of a direction: ``axes`` has them as rows, shape (3, 3), the last one the direction."""

    axes: Float[np.ndarray, "3 3"]

    @classmethod
    def along(cls, direction: Vector3) -> Frame:
        first, second = tangents(direction)
        return cls(np.array([first, second, direction]))

    def seen(self, points: np.ndarray) -> np.ndarray:
        """Points with any leading shape in these coordinates."""
        return points @ self.axes.T

    def back(self, points: np.ndarray) -> np.ndarray:
        return points @ self.axes


@dataclass(frozen=True, eq=False)
class Faces:
    """Triangles in (u, v, h), shape (n, 3, 3), none steep."""

    corners: Triples

    @classmethod
    def facing(cls, corners: Triples, ahead: bool) -> Faces:
        """Those of some triangles that face ahead along h, or back."""
        normals = cross_products(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        heights = normals[:, 2] if ahead else -normals[:, 2]
        return cls(corners[heights > STEEP * np.linalg.norm(normals, axis=1)])

    def some(self, chosen: np.ndarray) -> Faces:
        return Faces(self.corners[chosen])

    @cached_property
    def lowest(self) -> Points:
        """The least u, v and h of each, shape (n, 3)."""
        first, second, third = np.moveaxis(self.corners, 1, 0)  # faster than a minimum along an axis of three
        return np.minimum(np.minimum(first, second), third)

    @cached_property
    def highest(self) -> Points:
        """The largest u, v and h of each, shape (n, 3)."""
        first, second, third = np.moveaxis(self.corners, 1, 0)
        return np.maximum(np.maximum(first, second), third)

    @property
    def low(self) -> Weights:
        return self.lowest[:, 2]

    @property
    def high(self) -> Weights:
        return self.highest[:, 2]

    def near(self, seen: Vector3, within: float) -> Faces:
        """Those with columns near that of a point."""
        low, high = self.lowest, self.highest
        near = (low[:, 0] <= seen[0] + within) & (low[:, 1] <= seen[1] + within)
        near &= (high[:, 0] >= seen[0] - within) & (high[:, 1] >= seen[1] - within)
        return self.some(near)

    @cached_property
    def slopes(self) -> Columns:
        """How h grows along u and v."""
        normals = cross_products(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        return -normals[:, :2] / normals[:, 2:]

    def heights(self, faces: Indices, columns: Columns) -> Weights:
        """The height of a face over each column, one of each."""
        first = self.corners[faces, 0]
        found = first[:, 2] + np.einsum("ij,ij->i", self.slopes[faces], columns - first[:, :2])
        return np.clip(found, self.low[faces], self.high[faces])

    @cached_property
    def outlines(self) -> np.ndarray:
        import shapely

        return np.array(shapely.polygons(self.corners[:, :, :2]), dtype=object).reshape(-1)

    def over(self, columns: Columns) -> tuple[Indices, Indices]:
        """All pairs of a column and a face that has it."""
        import shapely

        tree = shapely.STRtree(self.outlines)
        column, face = tree.query(shapely.points(columns), predicate="intersects")
        return column, face


def region_above(body: Faces, part: Faces, allowed: float) -> BaseGeometry | None:
    """The columns that have a body's material above the part's, away from their border by ``allowed``; None if none.

    Args:
        body: faces that look ahead.  part: faces that look back.
        allowed: > 0, how much higher and wider than this it must be to count [m].
    """
    import shapely

    pairs = _pairs(body, part, allowed)
    pieces: list[np.ndarray] = []
    while len(pairs[0]):
        batch, pairs = tuple(some[:_BATCH] for some in pairs), tuple(some[_BATCH:] for some in pairs)
        found = _pieces(body, part, batch[0], batch[1], allowed)
        if not len(found):
            continue
        pieces.append(shapely.buffer(found, _SEAM * allowed, join_style="mitre"))
        joined = shapely.union_all(np.concatenate(pieces))
        inner = shapely.buffer(joined, -(1 + _SEAM) * allowed, join_style="mitre")
        if not inner.is_empty:
            return inner
        pieces = [np.array([joined], dtype=object)]
    return None


def _pairs(body: Faces, part: Faces, allowed: float) -> tuple[Indices, Indices]:
    """Pairs of faces that share columns in which the body may be higher by more than allowed; the highest first."""
    import shapely

    nothing = np.zeros(0, dtype=np.int64)
    if not len(body.corners) or not len(part.corners):
        return nothing, nothing
    # what is nowhere high or low enough is most of it
    mine = np.flatnonzero(part.low < body.high.max() - allowed)
    theirs = np.flatnonzero(body.high > part.low.min() + allowed)
    if not len(mine) or not len(theirs):
        return nothing, nothing
    boxes = [shapely.box(*faces.corners[some, :, :2].min(axis=1).T, *faces.corners[some, :, :2].max(axis=1).T)
             for faces, some in ((body, theirs), (part, mine))]  # fmt: skip
    one, other = shapely.STRtree(boxes[1]).query(boxes[0])
    one, other = theirs[one], mine[other]
    above = body.high[one] - part.low[other]
    kept = np.flatnonzero(above > allowed)
    kept = kept[np.argsort(-above[kept], kind="stable")]
    return one[kept], other[kept]


def _pieces(body: Faces, part: Faces, one: Indices, other: Indices, allowed: float) -> np.ndarray:
    """Of each pair's overlap what has the body's face above the part's by more than allowed."""
    import shapely

    shapes = np.array(shapely.intersection(body.outlines[one], part.outlines[other]), dtype=object).reshape(-1)
    flat = shapely.area(shapes) > 0
    shapes, one, other = shapes[flat], one[flat], other[flat]
    columns, owner = shapely.get_coordinates(shapes, return_index=True)
    above = body.heights(one[owner], columns) - part.heights(other[owner], columns)
    most, least = np.full(len(shapes), -np.inf), np.full(len(shapes), np.inf)
    np.maximum.at(most, owner, above)
    np.minimum.at(least, owner, above)
    partly = np.flatnonzero((most > allowed) & (least < allowed))
    whole = shapes[least >= allowed]
    if not len(partly):
        return whole
    first = np.searchsorted(owner, partly)
    slopes = body.slopes[one[partly]] - part.slopes[other[partly]]
    half = _half_planes(columns[first], above[first] - allowed, slopes, 4 * _extent(columns))
    cut = np.array(shapely.intersection(shapes[partly], half), dtype=object).reshape(-1)
    return np.concatenate([whole, cut[shapely.area(cut) > 0]])


def _half_planes(columns: Columns, values: Weights, slopes: Columns, size: float) -> np.ndarray:
    """Where affine functions, given by value and slope at a column each, are positive: squares that reach ``size``."""
    import shapely

    steep = np.linalg.norm(slopes, axis=1, keepdims=True)
    ahead = slopes / steep
    foot = columns - (values[:, None] / steep) * ahead
    aside = np.column_stack([-ahead[:, 1], ahead[:, 0]]) * size
    return np.array(
        shapely.polygons(np.stack([foot - aside, foot + aside, foot + aside + size * ahead,
                                   foot - aside + size * ahead], axis=1)), dtype=object
    ).reshape(-1)  # fmt: skip


def _extent(columns: Columns) -> float:
    return float(np.ptp(columns, axis=0).max())


def nearest_meeting(columns: Columns, body: Triples, part: Triples) -> tuple[float, Vector3]:
    """In which column the part meets the body first when it moves ahead: how far it goes [m], and the point met.

    Args:
        columns: looked at, that have material of the body above some of the part.
        body, part: all their triangles, in (u, v, h).
    """
    ahead, back = Faces.facing(part, True), Faces.facing(body, False)
    tops, bottoms = ahead.over(columns), back.over(columns)
    best, point = np.inf, np.append(columns[0], float(body[:, :, 2].max()))
    for index, column in enumerate(columns):
        faces, others = tops[1][tops[0] == index], bottoms[1][bottoms[0] == index]
        if not len(faces) or not len(others):
            continue
        top = ahead.heights(faces, np.tile(column, (len(faces), 1)))
        bottom = back.heights(others, np.tile(column, (len(others), 1)))
        ways = bottom[:, None] - top[None, :]
        ways = np.where(ways >= 0, ways, np.inf)
        # where no gap is left between the two they overlap from the start
        way = float(ways.min()) if np.isfinite(ways).any() else 0.0
        if way < best:
            met = int(np.argmin(ways.min(axis=1)))
            best, point = way, np.append(column, bottom[met])
    return (best if np.isfinite(best) else 0.0), point
