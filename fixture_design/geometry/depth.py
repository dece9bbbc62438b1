"""How deep points are inside a solid that may be made of several shells."""

from __future__ import annotations

import numpy as np

from fixture_design.geometry.distance import DistanceField
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Directions, PerVertex, Triangles, Vertices


class DepthField:
    """Signed distances to the shells of one solid.

    Drake gives a point the sign of the triangle nearest to it, which for solids that touch or overlap may be one of a
    wall between them. Each solid shell is asked alone; where a shell bounds a cavity, all are asked together.
    """

    def __init__(self, geometry: PartGeometry) -> None:
        self._fields = [geometry.surface] if geometry.is_one_shell else _fields(geometry)

    def at(self, points: Directions) -> PerVertex:
        """Depth of each point, shape (n,) [m]: negative outside; where solids overlap, that in the deepest one."""
        return np.array([max(-field.at(point)[0] for field in self._fields) for point in points])


def _fields(geometry: PartGeometry) -> list[DistanceField]:
    shells = [geometry.triangles[geometry.shell_of_triangle == k] for k in range(geometry.shell_of_triangle.max() + 1)]
    if any(_volume(geometry.vertices, shell) < 0 for shell in shells):
        return [geometry.surface]
    fields = []
    for shell in shells:
        used, triangles = np.unique(shell, return_inverse=True)
        fields.append(DistanceField(geometry.vertices[used], triangles.reshape(-1, 3), geometry.name))
    return fields


def _volume(vertices: Vertices, triangles: Triangles) -> float:
    """Signed volume of a closed shell [m^3]: negative if it bounds a cavity."""
    middle = vertices[triangles.ravel()].mean(axis=0)
    first, second, third = (vertices[triangles[:, corner]] - middle for corner in range(3))
    return float(np.einsum("ij,ij->", first, np.cross(second, third))) / 6
