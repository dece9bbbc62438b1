"""Which triangles lie in one plane: facets grow from the largest triangle over neighbours that lie in its plane."""

from __future__ import annotations

from collections import deque

import numpy as np

from fixture_design.geometry.edges import neighbours
from fixture_design.geometry.piece import area_vectors, heights
from fixture_design.geometry.shapes import (
    OfTriangle,
    PerTriangle,
    PerVertex,
    TriangleMask,
    Triangles,
    TriangleVectors,
    Vertices,
)
from fixture_design.tolerances import COPLANAR_ANGLE, MERGE_VERTICES, ON_EDGE_ROUNDINGS


def plane_numbers(vertices: Vertices, triangles: Triangles, rounding: PerVertex) -> tuple[OfTriangle, TriangleMask]:
    """Which facet each triangle is of, shape (t,), numbered from 0 in the order in which they were grown; and slivers.

    A neighbour belongs to the facet if its normal is within ``COPLANAR_ANGLE`` of the seed's and its corners lie in the
    seed's plane as far as that angle allows. A sliver is a triangle whose normal the rounding of its vertices turns by
    more than that: it belongs if its corners lie in the plane up to that rounding and its normal is off by no more than
    the rounding explains; else the first strip of a fillet would be taken for a part of the flat beside it. Comparing
    with the seed, the largest triangle, and not with the triangle next door keeps a finely curved surface from becoming
    one facet.
    """
    areas = area_vectors(vertices, triangles)
    lengths = np.linalg.norm(areas, axis=1)
    units = areas / lengths[:, None]
    noise = plane_noise(vertices, triangles, rounding)
    turn = noise / heights(vertices, triangles)
    sliver = turn > COPLANAR_ANGLE
    grown = _Growth(vertices, triangles, units, noise, np.where(sliver, turn, 0.0))
    # slivers seed last, whatever their area: their own plane is not known
    for seed in np.lexsort((-lengths, sliver)).tolist():
        grown.from_seed(seed)
    return np.array(grown.number, dtype=np.int64), sliver


def plane_noise(vertices: Vertices, triangles: Triangles, rounding: PerVertex) -> PerTriangle:
    """How far rounding may lift a triangle's corners out of their plane, shape (t,) [m]."""
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    return MERGE_VERTICES * size + ON_EDGE_ROUNDINGS * rounding[triangles].max(axis=1)


class _Growth:
    """Facets while they grow. Plain lists and floats: visiting triangles one by one is what numpy is slow at."""

    def __init__(
        self, vertices: Vertices, triangles: Triangles, units: TriangleVectors, noise: PerTriangle, turn: PerTriangle
    ) -> None:
        self.corners = vertices[triangles].tolist()
        self.units = units.tolist()
        self.noise, self.turn = noise.tolist(), turn.tolist()
        self.across = neighbours(triangles, len(vertices)).tolist()
        self.number = [-1] * len(triangles)
        self.count = 0

    def from_seed(self, seed: int) -> None:
        """A new facet from this triangle, unless it already is of one."""
        if self.number[seed] >= 0:
            return
        self.number[seed] = self.count
        waiting = deque([seed])
        while waiting:
            for other in self.across[waiting.popleft()]:
                if other >= 0 and self.number[other] < 0 and self._belongs(other, seed):
                    self.number[other] = self.count
                    waiting.append(other)
        self.count += 1

    def _belongs(self, other: int, seed: int) -> bool:
        (nx, ny, nz), (ox, oy, oz) = self.units[seed], self.corners[seed][0]
        ux, uy, uz = self.units[other]
        if (ux - nx) ** 2 + (uy - ny) ** 2 + (uz - nz) ** 2 > (COPLANAR_ANGLE + self.turn[other]) ** 2:
            return False
        allowed = self.noise[other] + self.noise[seed]
        if not self.turn[other]:
            allowed += COPLANAR_ANGLE * max(abs(x - ox) + abs(y - oy) + abs(z - oz) for x, y, z in self.corners[other])
        return all(abs((x - ox) * nx + (y - oy) * ny + (z - oz) * nz) <= allowed for x, y, z in self.corners[other])
