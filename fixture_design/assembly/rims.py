"""How far points in the plane of a facet are beyond its rim: of convex facets, and of any, with holes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float


@runtime_checkable
class Rims(Protocol):
    """The rims of f facets."""

    def of(self, rows: np.ndarray) -> Rims:
        """The rims of some facets, one repeated where it is listed again."""
        ...

    def over(self, points: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How far points (n, m, 3) are beyond rims ``chosen`` (n, m), zero within [m], and unit vectors away."""
        ...

    def beyond(self, points: np.ndarray) -> np.ndarray:
        """How far points (n, a, 3) are beyond every rim, negative within, shape (n, a, f) [m]."""
        ...


@dataclass(frozen=True, eq=False)
class ConvexRims:
    """Rims of convex facets.

    Attributes:
        sides: shape (f, k, 4): unit vectors in the facet's plane, out of it across each side, and offsets; the last
            sides of facets with fewer are repeated. Beyond a corner the distance counts to the line of a side.
    """

    sides: Float[np.ndarray, "_ _ 4"]

    @classmethod
    def around(cls, normals: np.ndarray, borders: Sequence[np.ndarray]) -> ConvexRims:
        """Of facets with these unit normals and borders: segments (k, 2, 3), the inside to their left."""
        rows = []
        for normal, border in zip(normals, borders, strict=True):
            across = np.cross(border[:, 1] - border[:, 0], normal)
            across /= np.linalg.norm(across, axis=1, keepdims=True)
            rows.append(np.column_stack([across, np.einsum("ij,ij->i", across, border[:, 0])]))
        return cls(_padded(rows))

    def of(self, rows: np.ndarray) -> ConvexRims:
        return ConvexRims(self.sides[rows])

    def over(self, points: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sides = self.sides[chosen]
        beyond = np.einsum("nmki,nmi->nmk", sides[..., :3], points) - sides[..., 3]
        worst = beyond.argmax(axis=-1)
        over = np.maximum(np.take_along_axis(beyond, worst[..., None], axis=-1)[..., 0], 0.0)
        sides = np.broadcast_to(sides, (*beyond.shape, 4))
        return over, np.take_along_axis(sides[..., :3], worst[..., None, None], axis=-2)[..., 0, :]

    def beyond(self, points: np.ndarray) -> np.ndarray:
        flat = self.sides.reshape(-1, 4)
        beyond = points @ flat[:, :3].T - flat[:, 3]
        return beyond.reshape(*points.shape[:2], *self.sides.shape[:2]).max(axis=-1)


@dataclass(frozen=True, eq=False)
class PolygonRims:
    """Rims of any plane facets, not convex or with holes.

    Attributes:
        bases: unit vectors in the facets' planes, shape (f, 2, 3).
        starts, ends: of segments in these coordinates, shape (f, k, 2); the last ones of facets with fewer are points,
            which no line crosses.
    """

    bases: Float[np.ndarray, "*_ 2 3"]
    starts: Float[np.ndarray, "*_ _ 2"]
    ends: Float[np.ndarray, "*_ _ 2"]

    @classmethod
    def around(cls, normals: np.ndarray, borders: Sequence[np.ndarray]) -> PolygonRims:
        """Of facets with these unit normals and borders: segments (k, 2, 3)."""
        bases = np.linalg.svd(normals[:, None])[2][:, 1:]
        # the same point has the same coordinates to the last digit, where one segment ends and the next begins
        flat = [(border[:, :, None] * basis).sum(axis=-1) for border, basis in zip(borders, bases, strict=True)]
        ends = _padded([segments[:, 1] for segments in flat])
        starts = _padded([segments[:, 0] for segments in flat])
        repeated = np.arange(starts.shape[1]) >= np.array([[len(border)] for border in borders])
        return cls(bases, np.where(repeated[..., None], ends, starts), ends)

    def of(self, rows: np.ndarray) -> PolygonRims:
        return PolygonRims(self.bases[rows], self.starts[rows], self.ends[rows])

    def over(self, points: np.ndarray, chosen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rims = self.of(chosen)
        away, distance, inside = rims._seen(points)
        flat = away / np.maximum(distance, np.finfo(float).tiny)[..., None]
        return np.where(inside, 0.0, distance), (flat[..., None] * rims.bases).sum(axis=-2)

    def beyond(self, points: np.ndarray) -> np.ndarray:
        flat = np.ascontiguousarray(points.reshape(-1, 3).T)
        found = np.empty((len(self.bases), flat.shape[1]))
        for row, basis, starts, ends in zip(found, self.bases, self.starts, self.ends, strict=True):
            # segments that only fill the table are points
            rim = (starts != ends).any(axis=-1)
            _, distance, inside = _nearest(basis @ flat, starts[rim], ends[rim])
            row[:] = np.where(inside, -distance, distance)
        return found.T.reshape(*points.shape[:2], len(found))

    def _seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """From the nearest point of each rim, how far that is, and whether the rim surrounds the point."""
        place = np.stack([(points * self.bases[..., k, :]).sum(axis=-1) for k in range(2)])
        # segments first, then the two coordinates
        starts, ends = (np.moveaxis(corners, (-2, -1), (0, 1)) for corners in (self.starts, self.ends))
        away, distance, inside = _nearest(place, starts, ends)
        return np.moveaxis(away, 0, -1), distance, inside


def _nearest(place: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """From the nearest point of a rim to points, how far that is, and whether the rim surrounds them.

    Args:
        place: shape (2, ...).  starts, ends: of k segments, shape (k, 2, ...), the same rim for all points or one each.
    """
    x, y = place
    least, away = np.full(x.shape, np.inf), np.zeros(place.shape)
    inside = np.zeros(x.shape, dtype=bool)
    for (x0, y0), (x1, y1) in zip(starts, ends, strict=True):
        u, v = x1 - x0, y1 - y0
        right, up = x - x0, y - y0
        share = np.clip((right * u + up * v) / np.maximum(u * u + v * v, np.finfo(float).tiny), 0.0, 1.0)
        gap = right - share * u, up - share * v
        squared = gap[0] * gap[0] + gap[1] * gap[1]
        nearer = squared < least
        np.copyto(least, squared, where=nearer)
        for kept, own in zip(away, gap, strict=True):
            np.copyto(kept, own, where=nearer)
        # a line along the first axis crosses the rim an odd number of times from inside; ends are compared as they are,
        # so that it crosses one of two segments that meet, or both, or none, but never half of one
        inside ^= ((y < y0) != (y < y1)) & (right < u * up / np.where(v == 0, 1.0, v))
    return away, np.sqrt(least), inside


def _padded(rows: list[np.ndarray]) -> np.ndarray:
    """Rows of different lengths in one array; the last row is repeated."""
    most = max(map(len, rows))
    return np.array([np.concatenate([row, np.repeat(row[-1:], most - len(row), axis=0)]) for row in rows])
