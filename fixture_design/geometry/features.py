"""The features of a solid that can touch another: real edges between its facets, and vertices on them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from jaxtyping import Float, Int

from fixture_design.arrays import Indices
from fixture_design.geometry.part import PartGeometry
from fixture_design.geometry.separation import Solid
from fixture_design.geometry.shapes import Corners, Directions
from fixture_design.geometry.straight import straight_edges
from fixture_design.tolerances import ON_EDGE_ROUNDINGS

#: The two end points of each edge.
EdgeEnds = Float[np.ndarray, "_ 2 3"]
#: Their numbers, or two numbers else for each edge.
EdgeVertices = Int[np.ndarray, "e 2"]


@dataclass(frozen=True, eq=False)
class Features:
    """Edges and vertices of one solid; diagonals inside a facet and seams inside a smooth surface are none.

    What takes time is found when first asked for, once.
    """

    geometry: PartGeometry

    @cached_property
    def edge_vertices(self) -> EdgeVertices:
        """The vertex numbers of the edges between facets, those in a line as one."""
        ends, facets = self._edges(seams=False)
        if not self.geometry.is_one_shell:
            # other shells may touch an edge half way: its pieces are told apart
            return ends
        # the vertices of curved surfaces are where they are on purpose
        flat = np.array([facet.provenance.kind == "exact" for facet in self.geometry.facets], dtype=bool)
        plane = flat[facets].all(axis=1)
        # as far off a line as vertices may be, which is nearer than what counts as on an edge
        blur = self.geometry.on_edge / ON_EDGE_ROUNDINGS
        joined = straight_edges(ends[plane], facets[plane], self.geometry.vertices, blur)
        return np.vstack([joined, ends[~plane]])

    @cached_property
    def points(self) -> Directions:
        """The vertices at the ends of these edges, shape (v, 3) [m]."""
        return self.geometry.vertices[np.unique(self.edge_vertices)]

    @cached_property
    def edges(self) -> EdgeEnds:
        """The ends of the edges [m]."""
        return self.geometry.vertices[self.edge_vertices]

    @cached_property
    def all_edges(self) -> EdgeEnds:
        """The ends of all edges of the mesh that are not inside a facet, seams too [m]."""
        return self.geometry.vertices[self._edges(seams=True)[0]]

    @cached_property
    def sharp_points(self) -> Directions:
        """The vertices that are on edges, but on no round surface [m]."""
        return self.geometry.vertices[np.setdiff1d(self._edges(seams=False)[0], self._round_vertices)]

    @cached_property
    def sharp_edges(self) -> EdgeEnds:
        """The edges that are on no round surface [m]."""
        ends, _ = self._edges(seams=False)
        return self.geometry.vertices[ends[~np.isin(ends, self._round_vertices).all(axis=1)]]

    @cached_property
    def corners(self) -> Corners:
        """The corners of the triangles [m]."""
        return self.geometry.vertices[self.geometry.triangles]

    @cached_property
    def solid(self) -> Solid:
        """With the balls around its triangles."""
        return Solid.of(self.geometry)

    @cached_property
    def _round_vertices(self) -> Indices:
        """The vertices of round surfaces."""
        surface = smooth_surface_numbers(self.geometry)[self.geometry.facet_of_triangle]
        return np.unique(self.geometry.triangles[surface >= 0])

    def _edges(self, seams: bool) -> tuple[EdgeVertices, EdgeVertices]:
        """The vertices at the ends of edges between facets, and the two facets of each (of one of its sides)."""
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
        found, first = np.unique(np.sort(ends, axis=1), axis=0, return_index=True)
        facets = np.stack([facet[triangle], facet[across[triangle, side]]], axis=1)
        return found, np.sort(facets, axis=1)[first]


@lru_cache(maxsize=4)
def features_of(geometry: PartGeometry) -> Features:
    """The features of a part, kept from one layout to the next while it is among the last few that were asked for."""
    return Features(geometry)


def smooth_surface_numbers(geometry: PartGeometry) -> Indices:
    """For every facet the number of the round surface that it stands for, -1 for plane ones."""
    numbers = np.full(len(geometry.facets), -1, dtype=np.int64)
    for number, surface in enumerate(geometry.smooth_surfaces):
        facets = [facet for facet in surface.facets.tolist() if geometry.surface_of_facet(facet) is surface]
        numbers[facets] = number
    return numbers
