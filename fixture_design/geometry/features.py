"""The features of a solid that can touch another: real edges between its facets, and vertices on them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices
from fixture_design.geometry.broad import Boxes, boxes_of
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.shapes import Corners, Directions

#: The two end points of each edge.
EdgeEnds = Float[np.ndarray, "_ 2 3"]


@dataclass(frozen=True, eq=False)
class Features:
    """Edges and vertices of one solid; diagonals inside a facet and seams inside a smooth surface are none."""

    geometry: PartGeometry

    @cached_property
    def edge_vertices(self) -> Int[np.ndarray, "e 2"]:
        """The vertex numbers of the edges between facets."""
        return self._edges(seams=False)

    @cached_property
    def vertices(self) -> Indices:
        """The numbers of the vertices on these edges."""
        return np.unique(self.edge_vertices)

    @property
    def points(self) -> Directions:
        """The vertices, shape (v, 3) [m]."""
        return self.geometry.vertices[self.vertices]

    @property
    def edges(self) -> EdgeEnds:
        """The ends of the edges [m]."""
        return self.geometry.vertices[self.edge_vertices]

    @property
    def all_edges(self) -> EdgeEnds:
        """The ends of all edges of the mesh that are not inside a facet, seams too [m]."""
        return self.geometry.vertices[self._edges(seams=True)]

    @cached_property
    def _round_vertices(self) -> Indices:
        """The vertices of round surfaces."""
        surface = smooth_surface_numbers(self.geometry)[self.geometry.facet_of_triangle]
        return np.unique(self.geometry.triangles[surface >= 0])

    @property
    def sharp_points(self) -> Directions:
        """The vertices that are on no round surface [m]."""
        return self.geometry.vertices[np.setdiff1d(self.vertices, self._round_vertices)]

    @property
    def sharp_edges(self) -> EdgeEnds:
        """The edges that are on no round surface [m]."""
        return self.edges[~np.isin(self.edge_vertices, self._round_vertices).all(axis=1)]

    @property
    def corners(self) -> Corners:
        """The corners of the triangles [m]."""
        return self.geometry.vertices[self.geometry.triangles]

    @cached_property
    def triangle_boxes(self) -> Boxes:
        return boxes_of(self.corners)

    def _edges(self, seams: bool) -> Int[np.ndarray, "e 2"]:
        geometry = self.geometry
        across = geometry.triangle_neighbours
        facet = geometry.facet_of_triangle
        open_side = across < 0
        border = open_side | (facet[:, None] != facet[across])
        if not seams:
            surface = smooth_surface_numbers(geometry)[facet]
            border &= open_side | (surface[:, None] != surface[across]) | (surface[:, None] < 0)
        triangle, side = np.nonzero(border)
        ends = np.stack([geometry.triangles[triangle, side], geometry.triangles[triangle, (side + 1) % 3]], axis=1)
        return np.unique(np.sort(ends, axis=1), axis=0)


def smooth_surface_numbers(geometry: PartGeometry) -> Indices:
    """For every facet the number of the round surface that it stands for, -1 for plane ones."""
    numbers = np.full(len(geometry.facets), -1, dtype=np.int64)
    for number, surface in enumerate(geometry.smooth_surfaces):
        facets = [facet for facet in surface.facets.tolist() if geometry.surface_of_facet(facet) is surface]
        numbers[facets] = number
    return numbers
