"""The triangles that stand for one face, plane or round: where a line or a point of the true face is on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Indices
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, Vector3

#: Stretches of a line, from low to high [m].
Stretches = list[tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Sheet:
    """Triangles of one face.

    Attributes:
        corners: shape (t, 3, 3) [m].
        reach: how far the true face may be from them [m].  blur: points this far outside are on them [m].
    """

    corners: Corners
    reach: float
    blur: float

    @classmethod
    def of(cls, geometry: PartGeometry, facets: Indices, reach: float) -> Sheet:
        triangles = np.concatenate([geometry.facets[facet].triangles for facet in facets])
        blur = geometry.on_edge
        return cls(geometry.vertices[geometry.triangles[triangles]], reach + blur, blur)

    def stretches(self, point: Vector3, along: Vector3, normal: Vector3) -> Stretches:
        """Where a line is on the face, seen along the normal: lengths from ``point`` along the unit ``along``.

        Args:
            normal: of the true face there, on either side, square to ``along``; triangles that are further from the
                line than the reach, or steeper than 45 degrees to the face, do not count.
        """
        across = np.cross(normal, along)
        away = self.corners - point
        u, w, h = away @ along, away @ across, away @ normal
        areas = np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        level = np.abs(areas @ normal) >= np.sqrt(0.5) * np.linalg.norm(areas, axis=1)
        near = level & (w.min(axis=1) <= self.blur) & (w.max(axis=1) >= -self.blur)
        found = [self._stretch(u[k], w[k], h[k]) for k in np.flatnonzero(near)]
        return joined([stretch for stretch in found if stretch is not None], self.blur)

    def _stretch(self, u: np.ndarray, w: np.ndarray, h: np.ndarray) -> tuple[float, float] | None:
        """Where the line w = 0 crosses one triangle."""
        places = [(float(u[k]), float(h[k])) for k in range(3) if abs(w[k]) <= self.blur]
        for k in range(3):
            low, high = w[k - 1], w[k]
            if low * high < 0 and min(abs(low), abs(high)) > self.blur:
                share = low / (low - high)
                places.append(
                    (float(u[k - 1] + share * (u[k] - u[k - 1])), float(h[k - 1] + share * (h[k] - h[k - 1])))
                )
        if not places or max(abs(height) for _, height in places) > self.reach:
            return None
        return min(place for place, _ in places), max(place for place, _ in places)

    def covers(self, point: Vector3, normal: Vector3) -> bool:
        """Whether a point of the true face is on it, seen along the normal there."""
        along = np.eye(3)[int(np.argmin(np.abs(normal)))]
        along = along - (along @ normal) * normal
        along /= np.linalg.norm(along)
        return any(low - self.blur <= 0 <= high + self.blur for low, high in self.stretches(point, along, normal))


def joined(stretches: Stretches, blur: float) -> Stretches:
    """Stretches in order, those that meet made one."""
    result: Stretches = []
    for low, high in sorted(stretches):
        if result and low <= result[-1][1] + blur:
            result[-1] = (result[-1][0], max(result[-1][1], high))
        else:
            result.append((low, high))
    return result


def common(first: Stretches, second: Stretches) -> Stretches:
    """What lies in both."""
    both = [(max(a, c), min(b, d)) for a, b in first for c, d in second]
    return [(low, high) for low, high in both if low <= high]
