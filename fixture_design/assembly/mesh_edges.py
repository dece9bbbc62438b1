"""The true edges of a mesh: where two of its facets meet, in one piece however finely the mesh is cut."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Int

from fixture_design.arrays import Indices, Mask
from fixture_design.errors import UnsupportedError
from fixture_design.tolerances import COPLANAR_ANGLE

if TYPE_CHECKING:
    from fixture_design.geometry import PartGeometry

Two = Int[np.ndarray, "_ 2"]


@dataclass(frozen=True, eq=False)
class MeshEdges:
    """The true edges; an edge is as long as the same two facets meet along it.

    Attributes:
        ends: shape (e, 2), vertices of the mesh; the first facet is to the left from the first to the second, seen from
            outside.
        facets: shape (e, 2).
        convex: shape (e,); the others are concave, or turn by less than `COPLANAR_ANGLE`.
    """

    ends: Two
    facets: Two
    convex: Mask

    @property
    def corners(self) -> Indices:
        """Vertices in which edges end, sorted."""
        return np.unique(self.ends)


def mesh_edges(geometry: PartGeometry) -> MeshEdges:
    """The true edges of a part.

    Raises:
        UnsupportedError: more than two facets meet along an edge.
    """
    owners, across = geometry.facet_of_triangle, geometry.triangle_neighbours
    if (across < 0).any():
        raise UnsupportedError(
            f"more than two facets of {geometry.name!r} meet along an edge", expected="solids that do not touch so"
        )
    chains: dict[tuple[int, int], list[tuple[int, int]]] = defaultdict(list)
    for triangle, side in zip(*np.nonzero(owners[across] != owners[:, None]), strict=True):
        first, second = int(owners[triangle]), int(owners[across[triangle, side]])
        if first < second:
            a, b = geometry.triangles[triangle, side], geometry.triangles[triangle, (side + 1) % 3]
            chains[first, second].append((int(a), int(b)))
    found = [(pair, ends) for pair, sides in sorted(chains.items()) for ends in _joined(sides)]
    facets, ends = np.array([pair for pair, _ in found]), np.array([ends for _, ends in found])
    return MeshEdges(ends, facets, _convex(geometry, ends, facets))


def _joined(sides: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Sides of triangles along one line, all in one sense, as few from end to end as they make."""
    after = dict(sides)
    starts = sorted(after.keys() - set(after.values()))
    found = []
    for start in starts:
        end = start
        while end in after:
            end = after[end]
        found.append((start, end))
    return found


def _convex(geometry: PartGeometry, ends: Two, facets: Two) -> Mask:
    """An edge is convex if the second facet, from the edge on, goes below the plane of the first."""
    normals = geometry.facet_units
    along = geometry.vertices[ends[:, 1]] - geometry.vertices[ends[:, 0]]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    into = np.cross(normals[facets[:, 1]], -along)
    return np.einsum("ij,ij->i", normals[facets[:, 0]], into) < -np.sin(COPLANAR_ANGLE)
